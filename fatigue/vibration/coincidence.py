"""Does hunting meet a mode of equipment: dynamic amplification, how close they are, and what two records say of it."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy import signal
from scipy.interpolate import CubicSpline

from fatigue.quotient import quotient
from fatigue.vibration.decimated import decimated
from fatigue.vibration.levelled import levelled

Flag = Literal["red", "amber", "green"]
CLOSE_HZ = 1.0  # the ridge of hunting is half as wide to either side, and its frequency wanders as much
AMPLIFIED = 1.5
SEGMENT_S = 2.0
BAND_HZ = 0.5  # to either side of the frequency of hunting
LINES = 9  # at which the coherence is read in the band
FEWEST_AVERAGES = 4.0  # with three, records that have nothing to do with each other reach 0.78 in one of twenty cases
CHANCE = 0.05
ROUNDING = 1e-11  # of the largest value


@dataclass(frozen=True, slots=True)
class Coherence:
    """How far two records vibrate together round one frequency.

    Attributes
    ----------
    value : mean coherence in the band [-]
    phase_deg : by how much the second is behind the first at the middle of the band, above -180 to 180 [deg]
    averages : independent segments the estimate rests on
    significant : value that unrelated records stay below in 95 of 100 cases, at any one frequency
    """

    value: float
    phase_deg: float
    averages: float
    significant: float


def amplification(f_hunt: float, frequency: float, damping_ratio: float) -> float:
    """Absolute vibration of a piece of equipment over that of its base, |(1 + 2i z r) / (1 - r^2 + 2i z r)|, r = f/f_e.

    Frequencies in Hz. The closed form of an oscillator whose base vibrates, spring and damper between the two.

    >>> [round(amplification(9.2, f_e, 0.05), 2) for f_e in (9.2, 12.0, 14.0, 15.0)]
    [10.05, 2.39, 1.75, 1.6]
    """
    return abs(_transmission(f_hunt, frequency, damping_ratio))


def oscillator_phase(f_hunt: float, frequency: float, damping_ratio: float) -> float:
    """By how much a mode is behind its base [deg], 0 to 180: near 90 where hunting meets a lightly damped mode.

    >>> [round(oscillator_phase(9.2, f_e, 0.05)) for f_e in (6.0, 9.2, 14.0)]
    [165, 84, 3]
    """
    return float(-np.degrees(np.angle(_transmission(f_hunt, frequency, damping_ratio))))


def flag(f_hunt: float, frequency: float, damping_ratio: float) -> Flag:
    """Whether hunting is close to a mode: red within ``max(1 Hz, 2 z f_e)``, amber where it amplifies by above 1.5."""
    if abs(f_hunt - frequency) < max(CLOSE_HZ, 2 * damping_ratio * frequency):
        return "red"
    return "amber" if amplification(f_hunt, frequency, damping_ratio) > AMPLIFIED else "green"


def common_grid(
    first: tuple[NDArray[np.float64], float, float], second: tuple[NDArray[np.float64], float, float], upper_hz: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], float, float]:
    """Two records on one grid of times: the first, the second, step [s] and start [s]; empty where they do not overlap.

    A record is its values (n,), step [s] and time of the first sample [s]. Both are thinned as far as ``upper_hz``
    allows, and a cubic spline puts the slower one, or both where they start between each other's samples, on the finer
    grid.
    """
    thinned = [(*decimated(values, step, upper_hz), start) for values, step, start in (first, second)]
    step = min(s for _, s, _ in thinned)
    start = max(t for _, _, t in thinned)
    end = min(t + (v.size - 1) * s for v, s, t in thinned)
    samples = int((end - start) / step + 1e-6) + 1 if end > start else 0
    times = np.asarray(start + np.arange(samples) * step, np.float64)
    on_grid = [_at(times, values, s, t) for values, s, t in thinned]
    return on_grid[0], on_grid[1], step, start


def coherence(
    first: NDArray[np.float64],
    second: NDArray[np.float64],
    step: float,
    f_hunt: float,
    spans: list[tuple[float, float]],
) -> Coherence | None:
    """Coherence within 0.5 Hz of ``f_hunt``, and the phase at it; None where fewer than four segments can be averaged.

    The records are (n,), on one grid of times. ``spans`` are the times [s] from the first sample that count. Segments
    of 2 s that overlap by half, each within one span, under a Hann window, as in Welch's method (1967); two in a row
    share (1/6)^2 of their information. ``1 - 0.05**(1/(n - 1))`` is what the coherence of independent Gaussian records
    stays below in 95 of 100 cases with n averages (Carter, Knapp and Nuttall, 1973). A silent record has NaN.
    """
    size = round(SEGMENT_S / step)
    starts = [
        begin
        for start, end in spans
        for begin in range(round(start / step), min(round(end / step), first.size) - size + 1, max(size // 2, 1))
    ]
    neighbours = sum(b - a < size for a, b in pairwise(starts))
    averages = len(starts) ** 2 / (len(starts) + 2 * neighbours / 36) if starts else 0.0
    if len(starts) < FEWEST_AVERAGES:
        return None
    line = f_hunt + np.linspace(-BAND_HZ, BAND_HZ, LINES)
    window = signal.windows.hann(size, sym=False)
    fourier = window[:, np.newaxis] * np.exp(-2j * np.pi * line * step * np.arange(size)[:, np.newaxis])
    x, y = (_moving(record, starts, size) @ fourier for record in (first, second))
    cross = np.sum(np.conj(x) * y, axis=0)
    squared = quotient(np.abs(cross) ** 2, np.sum(np.abs(x) ** 2, axis=0) * np.sum(np.abs(y) ** 2, axis=0))
    value = float(np.mean(squared))
    behind = float(-np.degrees(np.angle(cross[LINES // 2]))) if np.isfinite(value) else float("nan")
    return Coherence(
        value=value,
        phase_deg=180.0 if behind == -180.0 else behind,
        averages=averages,
        significant=1 - CHANCE ** (1 / (averages - 1)),
    )


def _transmission(f_hunt: float, frequency: float, damping_ratio: float) -> complex:
    r = f_hunt / frequency
    damping = 2j * damping_ratio * r
    return (1 + damping) / (1 - r**2 + damping)


def _moving(record: NDArray[np.float64], starts: list[int], size: int) -> NDArray[np.float64]:
    """Segments (segments, size) less the straight line through each; zeros where only rounding is left of one."""
    segments = np.stack([record[begin : begin + size] for begin in starts])
    moving = levelled(segments)
    return np.where(np.abs(moving) > ROUNDING * np.max(np.abs(segments)), moving, 0.0)


def _at(times: NDArray[np.float64], values: NDArray[np.float64], step: float, start: float) -> NDArray[np.float64]:
    """Values of a record at other times: its samples where the times are its own, else those of a cubic spline."""
    if times.size == 0:
        return times
    first = (times[0] - start) / step
    spacing = (times[1] - times[0]) / step if times.size > 1 else 1.0
    if abs(first - round(first)) < 1e-6 and abs(spacing - 1) * times.size < 1e-3:
        return values[round(first) : round(first) + times.size]
    return np.asarray(CubicSpline(start + np.arange(values.size) * step, values)(times))
