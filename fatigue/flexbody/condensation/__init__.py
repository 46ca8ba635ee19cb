"""Bases that reduce a body to few coordinates: Guyan, Kuhar, Craig-Bampton, free interface with residual attachment."""
