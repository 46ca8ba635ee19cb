"""Weld fatigue life, in km, of a flexible rail-vehicle body."""

__version__ = "0.1.0"
