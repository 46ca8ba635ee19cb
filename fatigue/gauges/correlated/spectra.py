"""Power spectral density of records with gaps, and coherence of two that are aligned."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.signal import coherence

from fatigue.gauges.correlated.sides import Strain
from fatigue.gauges.measured.alignment import Alignment

Floats = NDArray[np.float64]

FEWEST_SEGMENTS = 4  # of a coherence that says anything: of one segment it is 1


def segment_samples(records: Sequence[Strain], rate_hz: float, segment_s: float) -> int:
    """Samples of a spectral segment: as long as asked, but no longer than the shortest record."""
    return min(round(segment_s * rate_hz), *(len(record.x) for record in records))


def density(records: Sequence[Strain], rate_hz: float, length: int) -> tuple[Floats, Floats]:
    """Frequencies (f,) [Hz] and one-sided density (f,) [ue^2/Hz]: Welch, Hann, half overlap, mean of a segment removed.

    Segments that nothing is cut out of are averaged; where there are none, all of them.
    """
    window = 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(length) / length)
    sums: dict[bool, list[Floats]] = {True: [], False: []}
    for record in records:
        kept = record.kept
        for first in range(0, len(record.x) - length + 1, max(1, length // 2)):
            x = record.x[first : first + length]
            power = np.abs(np.fft.rfft(window * (x - x.mean()))) ** 2
            sums[bool(kept[first : first + length].all())].append(power)
    chosen = sums[True] or sums[False]
    scale = np.full(length // 2 + 1, 2.0)
    scale[0] = 1.0
    if length % 2 == 0:
        scale[-1] = 1.0
    mean = np.mean(chosen, axis=0) * scale / (rate_hz * (window @ window))
    return np.asarray(np.fft.rfftfreq(length, 1.0 / rate_hz), dtype=np.float64), np.asarray(mean)


def coherence_band(
    measured: Floats, simulated: Floats, at: Alignment, rate_hz: float, length: int, band_hz: tuple[float, float]
) -> float:
    """Share of the measured power in the band that follows the simulation linearly; NaN of too short records.

    The coherence of the two (t,), the measured one moved back by whole samples, weighted with its density.
    """
    shift, samples = at.shift, min(len(measured), len(simulated))
    m = measured[max(0, shift) : samples + min(0, shift)]
    s = simulated[max(0, -shift) : samples - max(0, shift)]
    if length < 4 or len(m) < (FEWEST_SEGMENTS + 1) * length / 2:
        return np.nan
    f, gamma2 = coherence(m, s, fs=rate_hz, nperseg=length)
    _, power = density((Strain(m, ((0, len(m) - 1),)),), rate_hz, length)
    inside = (f >= band_hz[0]) & (f < band_hz[1]) & np.isfinite(gamma2)
    return float(gamma2[inside] @ power[inside] / power[inside].sum()) if power[inside].any() else np.nan
