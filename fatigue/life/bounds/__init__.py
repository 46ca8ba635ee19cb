"""Proven bounds of the damage: of points that need no counting, and of stored ranges on another curve."""
