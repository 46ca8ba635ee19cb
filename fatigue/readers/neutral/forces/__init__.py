"""Modal nodal forces in the neutral format: read, checked, and handed out group of welds by group of welds.

``by_group`` hands out the rows of a group as a table, from a ``source``: the file where it is (``in_place``) or a
``sorted_copy``. ``nodal_forces`` reads such a table: ``placement`` finds the station and the mode of every row,
``mistakes`` says what is wrong with the rows, ``convention`` gives sign and scale. ``regular_check`` is a quick check
of a whole file; ``element_forces`` reads the raw form.
"""
