"""Proven upper bounds of the damage, for points that need no counting."""
