"""Sperling's index Wz of one acceleration in its two forms, which do not agree above 10 Hz.

The filter form weighs the record as a whole. The line form weighs spectral lines of blocks; its value falls with the
length of a block, by T^-0.05 where the vibration is broadband, and stays where it is a sine.
"""

from collections.abc import Mapping
from typing import Any, Literal, TypeAlias

import numpy as np
from scipy import fft

from fatigue.vibration.standards.comfort_data import comfort_data
from fatigue.vibration.standards.mirrored import Floats, lines, spread

Direction: TypeAlias = Literal["y", "z"]
Band: TypeAlias = tuple[float, float]

EXPONENT = 6.67  # of the filter form: Wz = (sum)^(1/6.67)
COMFORT_FACTOR: Mapping[str, float] = {"z": 0.588, "y": 0.737}
EDGE = 0.005  # how far beyond the band the filter form looks, so that a sine at an edge of it counts whole
EXACTLY = 1e-9  # a frequency at an end of the band lies in it, however it was rounded
HANN_CUBES = 1.25  # sum of the cubes of what a Hann window makes of a line: 1 and two neighbours of 1/2


def comfort_weight(frequency: Floats, direction: Direction) -> Floats:
    """Weighting B(f) of the filter form for accelerations in cm/s2 (Sperling and Betzhold).

    >>> comfort_weight(np.array([1.0, 5.4, 20.0]), "z").round(4).tolist()
    [0.4891, 0.812, 0.214]
    """
    f = np.asarray(frequency, np.float64)
    above = 1.911 * f**2 + (0.25 * f**2) ** 2
    below = (1 - 0.277 * f**2) ** 2 + (1.563 * f - 0.0368 * f**3) ** 2
    return np.asarray(COMFORT_FACTOR[direction] * np.sqrt(above / below), np.float64)


def ride_quality_weight(frequency: Floats) -> Floats:
    """Weighting of the ride quality of the vehicle, one for both directions; recalled, see ``comfort.toml``."""
    f = np.asarray(frequency, np.float64)
    above = ((1 - 0.056 * f**2) ** 2 + (0.645 * f) ** 2) * 3.55 * f**2
    below = ((1 - 0.252 * f**2) ** 2 + (1.547 * f - 0.00444 * f**3) ** 2) * (1 + 3.55 * f**2)
    return np.asarray(1.14 * np.sqrt(above / below), np.float64)


def wz_filter(values: Floats, step: float, direction: Direction, band: Band, *, of_vehicle: bool = False) -> float:
    """Wz of a record (n,) [m/s2] in the filter form: ``(2e4 integral of B^2 G df)^(1/6.67)``, 4.42 a_w^0.3.

    G is the one-sided density of the whole record without its mean, so that the length of the record does not matter.
    ``of_vehicle`` takes the weighting of the ride quality.

    >>> t = np.arange(12000) / 200
    >>> round(wz_filter(0.5 * np.sin(2 * np.pi * 5.4 * t), 1 / 200, "z", (0.5, 40.0)), 3)
    3.036
    """
    frequency, mean_square = lines(values - values.mean(), step)
    inside = (frequency >= band[0] * (1 - EDGE)) & (frequency <= band[1] * (1 + EDGE)) & (frequency > 0)
    weight = ride_quality_weight(frequency[inside]) if of_vehicle else comfort_weight(frequency[inside], direction)
    return float((2e4 * (weight**2 @ mean_square[inside])) ** (1 / EXPONENT))


def wz_of_density(frequency: Floats, density: Floats, direction: Direction, band: Band) -> float:
    """Wz of a one-sided density G (n,) [(m/s2)2/Hz] in the filter form, ``(2e4 integral of B^2 G df)^(1/6.67)``.

    The integral is that of the trapezoidal rule over the frequencies (n,) [Hz] in the band, its ends included.

    A sine of 0.5 m/s2 at 5.4 Hz, as a line of 0.01 Hz:

    >>> f = np.arange(5001) / 100
    >>> round(wz_of_density(f, np.where(f == 5.4, 0.5**2 / 2 / 0.01, 0.0), "z", (0.5, 40.0)), 3)
    3.036
    """
    inside = (frequency >= band[0] * (1 - EXACTLY)) & (frequency <= band[1] * (1 + EXACTLY))
    f = frequency[inside]
    weighted = comfort_weight(f, direction) ** 2 * density[inside]
    return float((2e4 * np.trapezoid(weighted, f)) ** (1 / EXPONENT))


def line_weight(frequency: Floats, direction: Direction) -> Floats:
    """Weighting F(f) of the line form, in pieces of f^2, f^-2 and 1; recalled, see ``comfort.toml``.

    >>> line_weight(np.array([5.4, 10.0, 36.0]), "z").round(3).tolist()
    [9.477, 4.0, 1.0]
    """
    data: dict[str, Any] = comfort_data()["sperling_line"][direction]
    piece = np.searchsorted(data["edges_hz"], frequency)
    return np.asarray(np.array(data["factors"])[piece] * frequency ** np.array(data["exponents"])[piece], np.float64)


def wz_lines(values: Floats, step: float, direction: Direction, band: Band, block_s: float) -> Floats:
    """Wz (k,) of the blocks of a record (n,) [m/s2] in the line form of GB 5599; empty if it is shorter than a block.

    ``W = (sum of W_i^10)^0.1`` over the lines in the band, ``W_i = 3.57 (A_i^3 F / f)^0.1`` with amplitudes A_i [m/s2].
    Blocks overlap by half or a little more, so that they end with the record.

    A bare transform would lose up to 6 % of a sine between two lines. A Hann window shares a line with its neighbours;
    the sum of cubes is 1.25 times that of the line and is divided by it. A sine on a line keeps its value, one between
    two lines loses 0.14 % at most. Broadband vibration reads 3.9 % higher than by a bare transform, at any length of
    a block. The band ends one line further out, where the window takes what lies at its edge.
    """
    samples = round(block_s / step)
    window = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(samples) / max(samples, 1))
    frequency = np.arange(samples // 2 + 1) / (samples * step) if samples else np.array([])
    width = 1 / (samples * step) if samples else 0.0
    reach = width * (1 + 1e-9)
    inside = (frequency >= band[0] - reach) & (frequency <= band[1] + reach) & (frequency > 0)
    inside &= frequency < 0.5 / step  # the last line of an even number of samples has no phase
    weight = line_weight(frequency[inside], direction) / frequency[inside] / HANN_CUBES
    factor = comfort_data()["sperling_line"]["factor"]
    indices = []
    for first in spread(values.size, samples, samples // 2):
        block = values[first : first + samples]
        block = block - window @ block / window.sum()
        amplitude = 2 * np.abs(fft.rfft(block * window)[inside]) / window.sum()
        indices.append(factor * float(weight @ amplitude**3) ** 0.1)
    return np.array(indices)
