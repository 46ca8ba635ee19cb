"""At which frequency a record moves most, and how much of it lies in a band: from one spectrum of the whole record.

The ends are tapered, because excitations are looked at: what a second derivative leaves at the ends of a record must
not count. Over time, ``tracking`` has the frequency of every two seconds.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.quotient import quotient

Floats = NDArray[np.float64]

TAPER = 0.05  # of the record, at each end
WIDTH_HZ = 0.5  # of the band that is sought


class Spectrum(NamedTuple):
    """Variance of records, line by line: ``hz`` (n,) without 0 Hz, ``variance`` (..., n)."""

    hz: Floats
    variance: Floats


def spectrum(x: NDArray[np.floating], step: float) -> Spectrum:
    """Variances of records (..., t) about their means, tapered by 5 % at each end.

    The lines add up to the variance, as far as the ends are like the rest.

    >>> t = 0.01 * np.arange(1000)
    >>> float(spectrum(3.0 * np.sin(2 * np.pi * 5.0 * t), 0.01).variance.sum().round(2))
    4.5
    """
    samples = x.shape[-1]
    taper = _taper(samples)
    centred = x - (x @ taper / taper.sum())[..., None]
    power = np.abs(np.fft.rfft(centred * taper)) ** 2 / (samples * np.sum(taper**2))
    power[..., 1 : (samples + 1) // 2] *= 2.0  # of +f and -f
    return Spectrum(np.asarray(np.fft.rfftfreq(samples, step)[1:], np.float64), power[..., 1:])


def dominant_hz(of: Spectrum) -> Floats:
    """Dominant frequency of records (...,) [Hz]: the centre of what lies around the strongest line of the half hertz.

    It is the half hertz that holds most of the variance; where that is fewer than three lines, three lines. NaN for a
    record that does not move, or has no line.

    >>> t = 0.01 * np.arange(3000)
    >>> x = np.sin(2 * np.pi * 9.23 * t) + 0.5 * np.sin(2 * np.pi * 1.1 * t)
    >>> float(dominant_hz(spectrum(x, 0.01)).round(2))
    9.23
    """
    lines = len(of.hz)
    if lines == 0:
        return np.full(of.variance.shape[:-1], np.nan)
    half = max(1, round(0.5 * WIDTH_HZ / of.hz[0]))
    width = min(lines, 2 * half + 1)
    below = np.cumsum(of.variance, axis=-1)
    held = below[..., width - 1 :] - below[..., : lines - width + 1] + of.variance[..., : lines - width + 1]
    band = held.argmax(axis=-1)[..., None] + np.arange(width)
    strongest = np.take_along_axis(band, np.take_along_axis(of.variance, band, -1).argmax(-1)[..., None], -1)
    around = strongest + np.arange(-half, half + 1)
    inside = (around >= 0) & (around < lines)
    around = np.clip(around, 0, lines - 1)
    weight = np.take_along_axis(of.variance, around, -1) * inside
    return quotient((weight * of.hz[around]).sum(axis=-1), weight.sum(axis=-1))


def share_between(of: Spectrum, low_hz: Floats | float, high_hz: Floats | float) -> Floats:
    """Share of the variance of each record (...,) between two frequencies [-]; NaN for one that does not move.

    >>> t = 0.01 * np.arange(3000)
    >>> x = np.sin(2 * np.pi * 9.0 * t) + 0.5 * np.sin(2 * np.pi * 1.0 * t)
    >>> float(share_between(spectrum(x, 0.01), 8.5, 9.5).round(3))
    0.8
    """
    inside = (of.hz >= np.asarray(low_hz)[..., None]) & (of.hz <= np.asarray(high_hz)[..., None])
    return quotient((of.variance * inside).sum(axis=-1), of.variance.sum(axis=-1))


def _taper(samples: int) -> Floats:
    """One in the middle, half a cosine down to almost zero at either end."""
    width = max(1, round(TAPER * samples))
    rise = 0.5 - 0.5 * np.cos(np.pi * (np.arange(width) + 0.5) / width)
    taper = np.ones(samples)
    taper[:width] *= rise
    taper[samples - width :] *= rise[::-1]
    return taper
