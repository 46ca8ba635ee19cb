"""Stress beside a weld and in parent metal: extrapolated to the toe, and on planes across the plate."""
