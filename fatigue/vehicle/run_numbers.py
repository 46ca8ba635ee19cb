"""What a ride comes to in single numbers: hunting, bogie, alarm, equipment, comfort, mounts.

A number that cannot be had is NaN, and its reason stands beside it. Bands, filters and segments are those of the
definition of the reference trailer.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import signal, stats

from fatigue.life.counting.rainflow import rainflow
from fatigue.vehicle.run import Ride
from fatigue.vibration.alarm import PERIODS, count_alarms
from fatigue.vibration.standards.sperling import Direction, wz_of_density

Floats = NDArray[np.float64]

ACCELERATION, DENSITY = "m/s2", "(m/s2)2/Hz"
SEGMENT_S = 4.096  # of spectra: 4096 samples at 1 ms, Hann, 50 % overlap
HUNTING_HZ = (4.0, 12.0)
PAPER_HZ = (7.0, 8.0)  # where the source paper sees the resonant peak of bogies on worn wheels
BOGIE_HZ = (0.5, 10.0)  # of the alarm of a bogie
ALARM_M_S2, ALARM_CYCLES = 8.0, 6
LOW_PASS_HZ = 40.0  # to which the vehicle is valid
COMFORT_HZ = (0.5, 40.0)
COMFORT: tuple[tuple[str, Direction], ...] = (("floor_mid_z", "z"), ("floor_bog_z", "z"), ("floor_mid_y", "y"))
WORN = 0.9  # of the flag of an axle, from which a sample is taken for one of a worn section
SECOND_AXLE = 1
DAMAGE_EXPONENT = 3


class RunNumber(NamedTuple):
    """One number of a ride; NaN where it cannot be had, for the ``reason``."""

    value: float
    unit: str
    reason: str = ""


def run_numbers(of: Ride) -> dict[str, RunNumber]:
    """Numbers of a ride by name.

    ``f_hunt``: peak of the spectrum of ``bog_y`` between 4 and 12 Hz. ``bogie_psd_7_8``: mean density there between 7
    and 8 Hz. ``bogie_y_rms``, ``bogie_y_peak_band`` behind the filter of the alarm, ``bogie_alarms`` and
    ``bogie_alarm_cycles``: alarms and most cycles in a row at 8 m/s2. ``conv_y_*``, ``roof_mid_y_rms`` below 40 Hz.
    ``Wz_*``: Sperling's index in the filter form. ``*_rms_worn``: only where the second axle runs on worn contact.
    ``wheelset_y_peak``: largest displacement over the track. Of what the car body recovers ``*_rms`` and
    ``*_sum_n_r3``, the sum of n r^3 over rainflow ranges.
    """
    step, bogie = of.step_s, _channel(of, "bog_y")
    in_band = _in_alarm_band(bogie, step)
    numbers = {
        "f_hunt": _number(_up_to(HUNTING_HZ[1], bogie, step), "Hz", lambda a: _hunting(a, step)),
        "bogie_psd_7_8": _number(_up_to(PAPER_HZ[1], bogie, step), DENSITY, lambda a: _mean_density(a, step)),
        "bogie_y_rms": _number(bogie, ACCELERATION, _std),
        "bogie_y_rms_worn": _number(bogie, ACCELERATION, lambda a: _rms_worn(a, of)),
        "bogie_y_peak_band": _number(in_band, ACCELERATION, _largest),
        "bogie_alarms": _number(in_band, "", lambda a: count_alarms(a, step, ALARM_M_S2, ALARM_CYCLES).times.size),
        "bogie_alarm_cycles": _number(in_band, "", lambda a: count_alarms(a, step, ALARM_M_S2, 1).longest_run),
    }
    converter, roof = (_low_passed(_channel(of, name), step) for name in ("conv_y", "roof_mid_y"))
    numbers |= {
        "conv_y_rms": _number(converter, ACCELERATION, _std),
        "conv_y_rms_worn": _number(converter, ACCELERATION, lambda a: _rms_worn(a, of)),
        "conv_y_peak": _number(converter, ACCELERATION, _largest),
        "conv_y_kurtosis": _number(converter, "", lambda a: float(stats.kurtosis(a, fisher=False))),
        "roof_mid_y_rms": _number(roof, ACCELERATION, _std),
    }
    for name, direction in COMFORT:
        felt = _up_to(COMFORT_HZ[1], _channel(of, name), step)
        numbers[f"Wz_{name}"] = _number(felt, "", _comfort_of(direction, step))
    numbers["wheelset_y_peak"] = RunNumber(1000.0 * float(np.abs(of.wheelsets_m).max()), "mm")
    for name in of.recovered or ("mount_mx",):
        moment = of.recovered.get(name, f"the car body does not recover {name}")
        numbers[f"{name}_rms"] = _number(moment, "N m", _std)
        numbers[f"{name}_sum_n_r3"] = _number(moment, "N3 m3", sum_n_r)
    return numbers


def sum_n_r(values: Floats, exponent: float = DAMAGE_EXPONENT) -> float:
    """Sum of n r^m over the rainflow ranges of a record (n,), what does not close counted as half cycles.

    >>> sum_n_r(np.array([-2.0, 1, -3, 5, -1, 3, -4, 4, -2]), 1.0)
    23.0
    """
    cycles = rainflow(values, "half")
    return float(cycles.count @ cycles.range**exponent)


def density(values: Floats, step_s: float) -> tuple[Floats, Floats]:
    """Frequencies [Hz] and one-sided density of a record (Welch: segments of 4.096 s, Hann, half overlap)."""
    hz, G = signal.welch(values, 1.0 / step_s, nperseg=min(round(SEGMENT_S / step_s), values.size))
    return hz, G


class Peak(NamedTuple):
    """Highest line [Hz] of a density in a band, the vertex [Hz] of the log-parabola round it, and is it a peak."""

    line_hz: float
    vertex_hz: float
    is_peak: bool


def peak(hz: Floats, G: Floats, band_hz: tuple[float, float]) -> Peak:
    """Peak of a density (n,) in a band; none where its highest line there is lower than a neighbour outside it."""
    inside = np.flatnonzero((hz >= band_hz[0]) & (hz <= band_hz[1]))
    at = int(inside[np.argmax(G[inside])])
    below, top, above = np.log(G[at - 1 : at + 2])
    shift = 0.5 * (below - above) / (below - 2.0 * top + above)
    return Peak(float(hz[at]), float(hz[at] + shift * (hz[1] - hz[0])), bool(top >= max(below, above)))


Found = float | str  # a number, or why there is none


def _number(record: Floats | str, unit: str, of: Callable[[Floats], Found]) -> RunNumber:
    """A number of a record, or why it cannot be had; a record that is not there has its reason instead."""
    found = record if isinstance(record, str) else of(record)
    return RunNumber(np.nan, unit, found) if isinstance(found, str) else RunNumber(float(found), unit)


def _channel(of: Ride, name: str) -> Floats | str:
    """A channel of a ride that lasts long enough for a segment of a spectrum, or why there is none."""
    duration = len(of.time_s) * of.step_s
    if duration < SEGMENT_S:
        return f"{duration:.3g} s of the ride are kept, and its spectra need {SEGMENT_S:g} s"
    record = of.channels.get(name)
    if record is None:
        return f"the car body has no point for {name}"
    return record if np.ptp(record) > 0.0 else f"{name} does not move"


def _up_to(hz: float, record: Floats | str, step_s: float) -> Floats | str:
    """A record that holds frequencies up to one [Hz], or why it does not."""
    return f"steps of {step_s:g} s hold nothing up to {hz:g} Hz" if step_s * hz >= 0.5 else record


def _low_passed(record: Floats | str, step_s: float) -> Floats | str:
    """A record below 40 Hz, without delay (Butterworth of order 4, forward and backward)."""
    held = _up_to(LOW_PASS_HZ, record, step_s)
    if isinstance(held, str):
        return held
    return np.asarray(signal.sosfiltfilt(signal.butter(4, LOW_PASS_HZ, fs=1.0 / step_s, output="sos"), held))


def _hunting(record: Floats, step_s: float) -> Found:
    """Frequency of hunting [Hz]: the peak of the spectrum, if there is one."""
    low, high = HUNTING_HZ
    found = peak(*density(record, step_s), HUNTING_HZ)
    if found.is_peak:
        return found.vertex_hz
    return (
        f"the bogie has no peak between {low:g} and {high:g} Hz: its spectrum is highest at the edge, "
        f"{found.line_hz:.3g} Hz (log-parabola: {found.vertex_hz:.4g} Hz)"
    )


def _mean_density(record: Floats, step_s: float) -> float:
    hz, G = density(record, step_s)
    return float(G[(hz >= PAPER_HZ[0]) & (hz <= PAPER_HZ[1])].mean())


def _in_alarm_band(record: Floats | str, step_s: float) -> Floats | str:
    """A record through the band of the alarm, without delay (Butterworth of order 4, forward and backward).

    A ride is cut out of a longer one. Its ends are mirrored: turned over, as ``sosfiltfilt`` does by default, a sine
    that is cut swings to twice its amplitude there; faded, as in ``band_passed``, the first and last second are lost.
    """
    held = _up_to(BOGIE_HZ[1], record, step_s)
    if isinstance(held, str):
        return held
    sos = signal.butter(4, BOGIE_HZ, "bandpass", fs=1.0 / step_s, output="sos")
    beside = min(round(PERIODS / (BOGIE_HZ[0] * step_s)), held.size - 1)
    return np.asarray(signal.sosfiltfilt(sos, held, padtype="even", padlen=beside))


def _rms_worn(record: Floats, of: Ride) -> Found:
    """Root mean square where the second axle runs on worn contact."""
    worn = of.worn[SECOND_AXLE] > WORN
    return float(np.sqrt(np.mean(record[worn] ** 2))) if worn.any() else "the contact of this ride is nowhere worn"


def _comfort_of(direction: Direction, step_s: float) -> Callable[[Floats], float]:
    return lambda record: wz_of_density(*density(record, step_s), direction, COMFORT_HZ)


def _std(record: Floats) -> float:
    return float(np.std(record))


def _largest(record: Floats) -> float:
    return float(np.abs(record).max())
