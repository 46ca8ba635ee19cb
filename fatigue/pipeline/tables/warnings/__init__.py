"""Warnings that only all welds together give, and how often each of them is told."""
