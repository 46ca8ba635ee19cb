"""The frequency-domain estimate and whether it may be trusted."""
