"""Welds of solid meshes: columns of nodes through the plate."""
