"""Matrices of NASTRAN and its relatives: DMIG bulk data, with the grids of their rows."""
