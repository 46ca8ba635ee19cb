"""The record of one event in all its coordinates: modes, and unit loads from their own files where they have any.

``load_file`` reads the history of one unit load, ``event_record`` puts all coordinates on one grid.
"""
