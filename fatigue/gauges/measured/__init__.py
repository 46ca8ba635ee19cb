"""Measured channels: samples flagged, cut, calibrated, band-limited, brought to another rate and aligned."""
