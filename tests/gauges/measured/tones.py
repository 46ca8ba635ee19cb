"""Signals of the numbers of measured_data: sums of tones, and what is injected into them (measured_oracles, recipe)."""

import numpy as np

TONES = ((40, 1.7, 0), (25, 6.3, 0.5), (10, 11.9, 1.0))  # ue, Hz, rad


def tones(t):
    """Sum of the tones at some instants (t,) [ue]."""
    return sum(a * np.sin(2 * np.pi * f * t + phase) for a, f, phase in TONES)


def flagged_tones():
    """60 s at 250 Hz with spikes, a gap, two runs of equal samples and four clipped ones (oracle ``flags``)."""
    x = tones(np.arange(15000) / 250.0)
    x[3000] += 400.0
    x[3500] -= 60.0
    x[5000:5003] = np.nan
    x[7000:7020] = x[7000]
    x[9000:9006] = x[9000]
    x[12000:12004] = 500.0
    return x
