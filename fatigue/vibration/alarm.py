"""The alarm of a bogie: cycles in a row whose acceleration reaches a threshold, as units on board count them."""

from dataclasses import dataclass
from itertools import groupby
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy import signal

from fatigue.vibration.band_pass import ORDER, band_passed

Filter = Literal["offline", "on_board"]
SAMPLES_PER_PERIOD = 20  # at the upper edge of the band: a peak between samples is then read 1.2 % low at most
PERIODS = 2.0  # of the lower edge of the band that a record must last: the filter settles in about one


@dataclass(frozen=True, slots=True, eq=False)
class AlarmCount:
    """What an alarm would have made of a record.

    Attributes
    ----------
    times : when the alarm goes off: the peak that fills a run of enough cycles, from the first sample [s]
    peak : largest peak of a half cycle [unit of the record]
    longest_run : most cycles in a row that reach the threshold; a half cycle counts half
    """

    times: NDArray[np.float64]
    peak: float
    longest_run: float


def cannot_be_filtered(
    samples: int, step: float, band_hz: tuple[float, float]
) -> Literal["above_nyquist", "short"] | None:
    """Why a record cannot be put through the band of an alarm; None where it can.

    ``above_nyquist``: the sampling rate is not above twice the upper edge. ``short``: less than two periods of the
    lower edge.
    """
    if band_hz[1] * step >= 0.5 * (1 - 1e-9):
        return "above_nyquist"
    return "short" if samples * step * band_hz[0] < PERIODS * (1 - 1e-9) else None


def filtered(
    values: NDArray[np.float64], step: float, band_hz: tuple[float, float], how: Filter
) -> tuple[NDArray[np.float64], float]:
    """Samples and step [s] of a record behind a Butterworth band-pass filter of the order 4.

    ``offline`` runs it forward and backward, see ``band_passed``: nothing is delayed, the first and last second fade.
    ``on_board`` runs it forward only, as a unit does while the train runs: peaks come later and lower at the edges of
    the band. It starts as if the first value had stood there for long. Records with few samples per period are made
    finer after the filter, as their peaks lie between samples. Raises ``ValueError`` where ``cannot_be_filtered`` gives
    a reason.
    """
    reason = cannot_be_filtered(values.size, step, band_hz)
    if reason is not None:
        raise ValueError(f"the record cannot be filtered: {reason}")
    if how == "offline":
        inside = band_passed(values, step, band_hz)
    else:
        sos = signal.butter(ORDER, band_hz, "bandpass", fs=1 / step, output="sos")
        inside = np.asarray(signal.sosfilt(sos, values, zi=signal.sosfilt_zi(sos) * values[0])[0])
    finer = int(np.ceil(SAMPLES_PER_PERIOD * band_hz[1] * step - 1e-9))
    if finer < 2:
        return inside, step
    return np.asarray(signal.resample_poly(inside, finer, 1, padtype="line")), step / finer


def passed(frequency: float, step: float, band_hz: tuple[float, float], how: Filter) -> float:
    """Share of its amplitude that vibration of one frequency [Hz] keeps behind the filter of an alarm.

    >>> [round(passed(9.0, 0.005, (0.5, 10.0), how), 2) for how in ("offline", "on_board")]
    [0.72, 0.85]
    """
    sos = signal.butter(ORDER, band_hz, "bandpass", fs=1 / step, output="sos")
    _, response = signal.sosfreqz(sos, [2 * np.pi * frequency * step])
    gain = float(abs(response[0]))
    return gain**2 if how == "offline" else gain


def count_alarms(values: NDArray[np.float64], step: float, threshold: float, cycles: int) -> AlarmCount:
    """Alarms of a record that is filtered already: runs of ``2 * cycles`` half cycles whose peaks reach ``threshold``.

    A half cycle lies between two zero crossings. A run that is longer is still one alarm; it ends with the first half
    cycle that stays below.

    >>> t = np.arange(1000) / 1000
    >>> count_alarms(8.1 * np.sin(2 * np.pi * 8 * t), 0.001, threshold=8.0, cycles=6).times.round(3)
    array([0.716])
    """
    if values.size == 0:
        return AlarmCount(np.empty(0), 0.0, 0.0)
    positive = values > 0
    starts = np.concatenate([[0], np.flatnonzero(positive[1:] != positive[:-1]) + 1])
    size = np.abs(values)
    peaks = np.maximum.reduceat(size, starts)
    times, longest, at = [], 0, 0
    for reaches, group in groupby((peaks >= threshold).tolist()):
        run = sum(1 for _ in group)
        if reaches:
            longest = max(longest, run)
            if run >= 2 * cycles:
                filled = at + 2 * cycles - 1
                end = starts[filled + 1] if filled + 1 < starts.size else values.size
                times.append((starts[filled] + int(np.argmax(size[starts[filled] : end] >= threshold))) * step)
        at += run
    return AlarmCount(np.asarray(times, np.float64), float(np.max(peaks)), longest / 2)
