"""Runs, side by side: histories from the source, a case of each run, its assessment, and the numbers it came to."""
