"""Reduce a finite element body: mesh or matrices and interface nodes to a neutral folder of modes and weld forces."""
