"""Weld lines given by points in space: the mesh edges along them, and names that survive another mesh."""
