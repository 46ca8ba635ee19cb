"""The second computation, by other code, in the order of the first one.

``joined`` and ``line`` solve one weld line, ``body`` gives them the lines and forces of a case; ``record`` reads an
event, ``cycles`` counts it, ``curve`` turns cycles into damage, ``spectral`` estimates the same damage from the
spectrum; ``point`` puts these together for one pass of an event, ``across_events`` for several in a row, and
``mission`` weights them. ``unit_load`` and ``interpolant`` put loads on the instants of an event, ``vertex`` moves
reversals off them.
"""
