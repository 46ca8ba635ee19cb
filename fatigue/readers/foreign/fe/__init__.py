"""One FE run, the same for every solver and file format: its model, its forces and its mode shapes.

``results`` and ``model`` are what readers give; ``assembly`` makes one run of the blocks of a file, ``force_rows`` one
set of rows of all modes.
"""
