"""Dominant frequency over time in a band, and the stretches of strong vibration of one frequency.

Short-time spectra of 2 s, one every 0.25 s, give a **ridge**: the frequency of the largest density in the band. A slice
is **hot** where the rms in the band is a multiple of that of the whole record and most of the power lies at the ridge;
four such slices in a row make a stretch. This is how unstable hunting shows in the lateral acceleration of a bogie.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy import signal

from fatigue.quotient import quotient
from fatigue.vibration.band_pass import band_passed
from fatigue.vibration.decimated import decimated
from fatigue.vibration.levelled import levelled

WINDOW_S = 2.0
HOP_S = 0.25
PADDING = 4  # transform over window: the spectrum is drawn four times finer than it resolves
RIDGE_HZ = 0.5  # half width of the ridge
FEWEST_HOT = 4  # slices in a row: 2.75 s of signal
SHORTEST_S = WINDOW_S + (FEWEST_HOT - 1) * HOP_S + WINDOW_S  # a stretch, and as much beside it
SLICES_AT_ONCE = 1024  # their spectra take 7 MB at 200 Hz
ROUNDING = 1e-11  # rms below this share of the largest value is rounding, not vibration
ABOVE_NYQUIST, SHORT = "above_nyquist", "short"


@dataclass(frozen=True, slots=True, eq=False)
class Track:
    """Vibration in a band over time; arrays are (slices,), NaN where nothing vibrates.

    Attributes
    ----------
    time : centre of each slice, from the first sample of the record [s]
    frequency : of the largest density in the band [Hz]
    share : power within 0.5 Hz of it over the power in the band
    rms : in the band [unit of the record]
    duration : of the record [s]
    """

    time: NDArray[np.float64]
    frequency: NDArray[np.float64]
    share: NDArray[np.float64]
    rms: NDArray[np.float64]
    duration: float

    @property
    def median_rms(self) -> float:
        """Median of the rms of the slices: what is usual in the record."""
        return float(np.median(self.rms))

    @property
    def edges(self) -> NDArray[np.float64]:
        """Where one slice gives way to the next [s], (slices + 1,): halfway between centres, and both ends."""
        between = (self.time[1:] + self.time[:-1]) / 2
        return np.concatenate([[0.0], between, [self.duration]])


@dataclass(frozen=True, slots=True)
class Stretch:
    """Slices in a row that are all hot or all not; stretches tile the record.

    Attributes
    ----------
    start_s, end_s : from the first sample of the record [s]
    frequency : median of the ridge [Hz]; NaN where nothing vibrates
    share : median of the share of the ridge
    rms : in the band, root of the mean square of the slices [unit of the record]
    peak : largest absolute value in the band [unit of the record]
    hot : whether its slices are hot
    """

    start_s: float
    end_s: float
    frequency: float
    share: float
    rms: float
    peak: float
    hot: bool


def cannot_be_tracked(samples: int, step: float, band_hz: tuple[float, float]) -> str | None:
    """Why a record has no track: ``short`` of 4.75 s, or its band reaches ``above_nyquist``; None where it has one."""
    if band_hz[1] * step > 0.5 * (1 + 1e-9):
        return ABOVE_NYQUIST
    return SHORT if samples * step < SHORTEST_S * (1 - 1e-9) else None


def track(values: NDArray[np.float64], step: float, band_hz: tuple[float, float]) -> Track:
    """Ridge, share and rms in a band for every slice of 2 s that lies within the record.

    ``values`` is (n,), with a constant time step ``step`` [s]; ``band_hz`` holds the two edges [Hz]. Each slice has the
    straight line through its own samples taken off, so drifts do not count. The frequency is that of the parabola
    through the logarithms of the largest density and its neighbours. Raises ``ValueError`` where ``cannot_be_tracked``
    gives a reason.

    >>> t = np.arange(4000) / 200
    >>> float(track(np.sin(2 * np.pi * 7.8 * t), 1 / 200, (4.0, 12.0)).frequency.mean().round(3))
    7.8
    """
    reason = cannot_be_tracked(values.size, step, band_hz)
    if reason is not None:
        raise ValueError(f"the record cannot be tracked: {reason}")
    duration = values.size * step
    slow, step = decimated(values - np.mean(values), step, band_hz[1])
    size = round(WINDOW_S / step)
    window = np.asarray(signal.windows.hann(size, sym=False))
    f = np.fft.rfftfreq(PADDING * size, step).astype(np.float64)
    starts = np.rint(np.arange(int((slow.size - size) * step / HOP_S + 1e-9) + 1) * HOP_S / step).astype(np.int64)
    windows = np.lib.stride_tricks.sliding_window_view(slow, size)
    found = []
    for chunk in np.split(starts, range(SLICES_AT_ONCE, starts.size, SLICES_AT_ONCE)):
        transform = np.abs(np.fft.rfft(window * levelled(windows[chunk]), PADDING * size))
        found.append(_ridge(f, transform**2 * (2 * step / np.sum(window**2)), band_hz))
    frequency, share, rms = np.concatenate(found, axis=1)
    still = rms <= ROUNDING * np.max(np.abs(values))
    frequency[still], share[still], rms[still] = np.nan, np.nan, 0.0
    return Track((starts + size / 2) * step, frequency, share, rms, duration)


def hot_slices(track: Track, hot_factor: float, hot_share: float, reference_rms: float) -> NDArray[np.bool_]:
    """Which slices belong to a hot stretch, (slices,).

    Their rms is above ``hot_factor * reference_rms`` and their share above ``hot_share``, four or more in a row.
    """
    loud = (track.rms > hot_factor * reference_rms) & (np.nan_to_num(track.share) > hot_share)
    hot = np.zeros(loud.size, dtype=np.bool_)
    for start, end in _runs(loud):
        hot[start:end] = loud[start] and end - start >= FEWEST_HOT
    return hot


def stretches(
    values: NDArray[np.float64], step: float, band_hz: tuple[float, float], track: Track, hot: NDArray[np.bool_]
) -> list[Stretch]:
    """Stretches that are hot and not hot by turns, from the first sample of a record to its last.

    A slice stands for the time from halfway to the slice before it to halfway to the next one, not for its window of
    2 s: a slice whose window is half filled by a burst is centred at its start, so this is where stretches begin and
    end, a third of a second early and late for a burst of some ten times what surrounds it. The first and the last
    slice reach to the ends of the record. The peak is that of ``band_passed``, which fades the ends of the record.
    """
    edges, found = track.edges, []
    inside = np.abs(band_passed(values, step, band_hz))
    for start, end in _runs(hot):
        samples = slice(round(edges[start] / step), max(round(edges[end] / step), 1))
        vibrates = track.rms[start:end] > 0
        found.append(
            Stretch(
                start_s=float(edges[start]),
                end_s=float(edges[end]),
                frequency=_median(track.frequency[start:end][vibrates]),
                share=_median(track.share[start:end][vibrates]),
                rms=float(np.sqrt(np.mean(track.rms[start:end] ** 2))),
                peak=float(np.max(inside[samples])) if vibrates.any() else 0.0,
                hot=bool(hot[start]),
            )
        )
    return found


def _ridge(f: NDArray[np.float64], density: NDArray[np.float64], band_hz: tuple[float, float]) -> NDArray[np.float64]:
    """Frequency, share and rms, (3, slices), of densities (slices, f)."""
    low, high = band_hz
    spacing = f[1]
    in_band = _covered(f, low, high, spacing)
    power = density @ in_band
    looked_at = np.flatnonzero((f >= low - spacing / 2) & (f <= high + spacing / 2))
    top = looked_at[np.argmax(density[:, looked_at], axis=1)]
    top = np.clip(top, 1, f.size - 2)  # with a neighbour on both sides
    row, tiny = np.arange(top.size), np.finfo(np.float64).tiny
    before, at, after = (np.log(np.maximum(density[row, top + side], tiny)) for side in (-1, 0, 1))
    bend = before - 2 * at + after
    offset = np.divide(before - after, 2 * bend, out=np.zeros_like(bend), where=bend < 0)
    ridge = np.clip(f[top] + spacing * np.clip(offset, -0.5, 0.5), low, high)
    at_ridge = _covered(f, ridge[:, np.newaxis] - RIDGE_HZ, ridge[:, np.newaxis] + RIDGE_HZ, spacing)
    share = quotient(np.sum(np.minimum(at_ridge, in_band) * density, axis=1), power)
    return np.stack([ridge, share, np.sqrt(power * spacing)])


def _covered(
    f: NDArray[np.float64], low: NDArray[np.float64] | float, high: NDArray[np.float64] | float, spacing: float
) -> NDArray[np.float64]:
    """Part of the bin at each frequency that lies between two edges, which need not fall on a bin."""
    reach = np.minimum(high, f + spacing / 2) - np.maximum(low, f - spacing / 2)
    return np.asarray(np.clip(reach / spacing, 0.0, 1.0))


def _runs(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Start and end of each run of equal flags."""
    changes = np.flatnonzero(flags[1:] != flags[:-1]) + 1
    ends = [0, *changes.tolist(), flags.size]
    return list(pairwise(ends))


def _median(values: NDArray[np.float64]) -> float:
    return float(np.median(values)) if values.size else float("nan")
