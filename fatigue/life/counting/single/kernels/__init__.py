"""The compiled loops of the counter in single precision."""
