"""The second computation, by other code, in the order of the first one.

``joined`` and ``line`` solve one weld line, ``body`` gives them the lines and forces of a case; ``record`` reads an
event, ``cycles`` counts it, ``curve`` turns cycles into damage, ``spectral`` estimates the same damage from the
spectrum; ``point`` puts these together for one point: one pass of every event, then the mission.
"""
