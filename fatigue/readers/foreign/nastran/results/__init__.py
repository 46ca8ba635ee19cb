"""NASTRAN results: OP2 by its records and its blocks, HDF5, punch; ``analysis`` tells which solutions are modes."""
