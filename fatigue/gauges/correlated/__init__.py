"""Measured strain beside the simulated one: numbers, verdicts and their page."""
