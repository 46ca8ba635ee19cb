"""Weld lines of one mesh written as points in space, and their register under the names that other meshes give."""
