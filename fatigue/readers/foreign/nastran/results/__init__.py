"""NASTRAN results: OP2, HDF5, punch."""
