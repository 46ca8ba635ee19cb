"""The text that our scripts write in other solvers: mesh, modes, shapes, element nodal forces in blocks of numbers."""
