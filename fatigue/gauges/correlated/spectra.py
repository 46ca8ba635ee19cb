"""Power spectral density of records with gaps, and coherence of two that are aligned: segments between the gaps."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.gauges.correlated.sides import Strain
from fatigue.gauges.measured.alignment import Alignment
from fatigue.gauges.measured.flags import runs

Floats = NDArray[np.float64]
Lines = NDArray[np.complex128]

FEWEST_SEGMENTS = 4  # of a coherence that says anything: of one segment it is 1


def segment_samples(records: Sequence[Strain], rate_hz: float, segment_s: float) -> int:
    """Samples of a spectral segment: as long as asked, but no longer than the shortest record."""
    return max(2, min(round(segment_s * rate_hz), *(len(record.x) for record in records)))


def frequencies(rate_hz: float, length: int) -> Floats:
    """Frequencies (f,) of segments of so many samples [Hz]."""
    return np.asarray(np.fft.rfftfreq(length, 1.0 / rate_hz), dtype=np.float64)


def density(records: Sequence[Strain], rate_hz: float, length: int) -> Floats:
    """One-sided density (f,) [ue^2/Hz] by Welch: Hann, half overlap, mean of each segment removed.

    Segments that nothing is cut out of are averaged; where there are none, all of them.
    """
    lines = np.concatenate([_lines(record.x, length) for record in records])
    whole = np.concatenate([_whole(record, length) for record in records])
    power = np.abs(lines[whole] if whole.any() else lines) ** 2
    sides = np.full(length // 2 + 1, 2.0)
    sides[0] = 1.0
    if length % 2 == 0:
        sides[-1] = 1.0
    return np.asarray(power.mean(axis=0) * sides / (rate_hz * (_hann(length) ** 2).sum()))


def coherence_band(
    measured: Strain, simulated: Strain, at: Alignment, rate_hz: float, length: int, band_hz: tuple[float, float]
) -> float:
    """Share of the measured power in the band that follows the simulation linearly; NaN of too few segments.

    The coherence of the two, the measured one moved back by whole samples, weighted with its density. Segments that
    something is cut out of are left out.
    """
    shift, samples = at.shift, min(len(measured.x), len(simulated.x))
    moved = slice(max(0, shift), samples + min(0, shift))
    m = Strain(measured.x[moved], tuple(runs(measured.kept[moved])))
    if len(m.x) < max(length, 4):
        return np.nan
    of_m = _lines(m.x, length)
    of_s = _lines(simulated.x[max(0, -shift) : samples - max(0, shift)], length)
    whole = _whole(m, length)
    if np.count_nonzero(whole) < FEWEST_SEGMENTS:
        return np.nan
    of_m, of_s = of_m[whole], of_s[whole]
    power_m, power_s = ((np.abs(one) ** 2).mean(axis=0) for one in (of_m, of_s))
    cross = np.abs((of_m.conj() * of_s).mean(axis=0)) ** 2
    f = frequencies(rate_hz, length)
    used = (f >= band_hz[0]) & (f < band_hz[1]) & (power_m > 0.0) & (power_s > 0.0)
    return float((cross[used] / power_s[used]).sum() / power_m[used].sum()) if used.any() else np.nan


def _lines(x: Floats, length: int) -> Lines:
    """Transforms (s, f) of the segments of samples (t,)."""
    segments = np.lib.stride_tricks.sliding_window_view(x, length)[:: max(1, length // 2)]
    return np.asarray(np.fft.rfft(_hann(length) * (segments - segments.mean(axis=1, keepdims=True)), axis=1))


def _whole(record: Strain, length: int) -> NDArray[np.bool_]:
    """Whether each segment (s,) has nothing cut out of it."""
    return np.asarray(np.lib.stride_tricks.sliding_window_view(record.kept, length)[:: max(1, length // 2)].all(axis=1))


def _hann(length: int) -> Floats:
    return np.asarray(0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(length) / length))
