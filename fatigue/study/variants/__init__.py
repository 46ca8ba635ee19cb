"""Variants of a study: what is varied, who produces the histories, what comes out of each, and how it scatters."""
