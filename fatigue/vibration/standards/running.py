"""Running behaviour by accelerations, in the manner of EN 14363: percentiles and rms of sections, sliding rms."""

import tomllib
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from fatigue.vibration.dominant import Spectrum, dominant_hz
from fatigue.vibration.standards.mirrored import Floats, band_pass, filtered, lines, spread


@cache
def running_data() -> Mapping[str, Any]:
    """Tables of ``running.toml``: bands, lengths and recalled limits, with source, edition and status."""
    return tomllib.loads(Path(__file__).with_name("running.toml").read_text("utf-8"))


def edition() -> str:
    """Where the limits are from, in one line.

    >>> edition()
    'EN 14363, edition not seen; recalled'
    """
    data = running_data()
    return f"{data['source']}, {data['edition']}; {data['status']}"


def section_length(speed_km_h: float) -> float:
    """Length [m] of a section at a speed [km/h].

    >>> section_length(350.0), section_length(220.0)
    (500.0, 250.0)
    """
    data = running_data()["section"]
    return float(data["fast_m"] if speed_km_h > data["fast_above_km_h"] else data["slow_m"])


def bogie_limits(mass_t: float) -> tuple[float, float]:
    """Limits [m/s2] of sliding rms and peak of a bogie of a mass [t]: ``(12 - m/5) / 2`` and ``12 - m/5``; NaN below 0.

    >>> [round(limit, 3) for limit in bogie_limits(6.8)]
    [5.32, 10.64]
    """
    data = running_data()["bogie"]
    peak = data["peak_limit_m_s2"] - data["peak_limit_m_s2_per_t"] * mass_t
    return (peak / 2, peak) if peak > 0 else (np.nan, np.nan)


def body_band(values: Floats, step: float) -> Floats:
    """Acceleration (n,) between 0.4 and 10 Hz: Butterworth of fourth order, without phase."""
    return filtered(values, step, band_pass(*running_data()["body"]["band_hz"]))


def sections(values: Floats, length: int) -> tuple[Floats, Floats]:
    """Largest percentile and rms (k,) [m/s2] of sections of a number of samples; empty if a record (n,) is shorter.

    The percentile is the larger one of 99.85 % and, taken from zero downwards, 0.15 %. Sections are spread evenly over
    the record and overlap where it is no multiple of their length.
    """
    largest, rms = [], []
    for first in spread(values.size, length, length):
        section = values[first : first + length]
        low, high = np.percentile(section, running_data()["body"]["percentiles"])
        largest.append(max(-low, high))
        rms.append(np.sqrt(np.mean(section**2)))
    return np.array(largest), np.array(rms)


def instability_frequency(values: Floats, step: float, band: tuple[float, float]) -> float:
    """Dominant frequency f0 [Hz] of an acceleration (n,) in a band, as of ``dominant_hz``; NaN if nothing is there.

    >>> round(instability_frequency(np.sin(2 * np.pi * 7.3 * np.arange(4000) / 200), 1 / 200, (4.0, 12.0)), 2)
    7.3
    """
    frequency, power = (of_lines[1:] for of_lines in lines(values, step))
    inside = (frequency >= band[0]) & (frequency <= band[1])
    return float(dominant_hz(Spectrum(frequency, np.where(inside, power, 0.0))))


def sliding_rms(values: Floats, window: int, hop: int) -> Floats:
    """Rms (k,) of a record (n,) over windows of samples, ``hop`` apart; empty if it is shorter than one.

    >>> sliding_rms(np.array([3.0, 4.0, 3.0, 4.0, 0.0]), 2, 1).round(3).tolist()
    [3.536, 3.536, 3.536, 2.828]
    """
    if window < 1 or values.size < window:
        return np.array([])
    squares = np.append(0.0, np.cumsum(values**2))
    first = np.arange(0, values.size - window + 1, max(1, hop))
    return np.asarray(np.sqrt(np.maximum(squares[first + window] - squares[first], 0.0) / window), np.float64)
