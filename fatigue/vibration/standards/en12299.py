"""Mean comfort by EN 12299: accelerations weighed by Wb or Wd, rms of blocks of 5 s, 95th percentile over 5 min."""

from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from fatigue.vibration.standards.comfort_data import comfort_data
from fatigue.vibration.standards.mirrored import Floats, filtered, spread

Weighting: TypeAlias = Literal["Wb", "Wd"]

BAND_HZ = (0.4, 100.0)  # edges of the two Butterworth filters that limit the band
WEIGHTING: dict[str, Weighting] = {"x": "Wd", "y": "Wd", "z": "Wb"}
Q1 = 0.707
_TRANSITION = {"Wb": (16.0, 0.63), "Wd": (2.0, 0.63)}  # f3 = f4 [Hz] and Q2
_STEP_HZ, _STEP_Q, _STEP_GAIN = (2.5, 4.0), (0.8, 0.8), 0.4  # f5 and f6, Q3 and Q4, K, of Wb alone


def response(frequency: Floats, weighting: Weighting) -> NDArray[np.complex128]:
    """Complex response H(2 pi i f) of a weighting at frequencies (n,) [Hz].

    Band limit of second order at 0.4 and 100 Hz, transition from acceleration to velocity, and for Wb the upward step.

    >>> abs(response(np.array([1.0, 2.0, 8.0]), "Wd")).round(3).tolist()
    [1.011, 0.89, 0.253]
    """
    s = np.asarray(2j * np.pi * np.asarray(frequency, np.float64), np.complex128)
    w1, w2 = (2 * np.pi * f for f in BAND_HZ)
    f4, q2 = _TRANSITION[weighting]
    w3 = w4 = 2 * np.pi * f4
    h: NDArray[np.complex128] = s**2 / (s**2 + s * w1 / Q1 + w1**2) * w2**2 / (s**2 + s * w2 / Q1 + w2**2)
    h = h * (s * w4**2 / w3 + w4**2) / (s**2 + s * w4 / q2 + w4**2)
    if weighting == "Wb":
        w5, w6 = (2 * np.pi * f for f in _STEP_HZ)
        q3, q4 = _STEP_Q
        h = h * _STEP_GAIN * (s**2 / w5**2 + s / (q3 * w5) + 1) / (s**2 / w6**2 + s / (q4 * w6) + 1)
    return h


def block_rms(values: Floats, step: float, weighting: Weighting) -> Floats:
    """Rms (k,) [m/s2] of the blocks of 5 s of a weighed acceleration (n,); empty if it is shorter than a block.

    The analytic response is applied to the whole record in the frequency domain, without its phase, which no rms over
    5 s sees: no transform of the filter is warped by the sampling rate. Samples behind the last whole block are left
    out.
    """
    samples = round(comfort_data()["en12299"]["block_s"] / step)
    if samples < 1 or values.size < samples:
        return np.array([])
    weighed = filtered(values, step, lambda frequency: np.abs(response(frequency, weighting)))
    whole = weighed[: values.size // samples * samples].reshape(-1, samples)
    return np.asarray(np.sqrt((whole**2).mean(axis=1)), np.float64)


def section_percentiles(blocks: Floats) -> Floats:
    """95th percentiles (s,) of the block rms (k,) over sections of 5 min, of all blocks where they are fewer.

    Sections are spread evenly over the record and overlap where it is no multiple of 5 min.
    """
    data = comfort_data()["en12299"]
    per_section = min(round(data["section_s"] / data["block_s"]), blocks.size)
    sections = spread(blocks.size, per_section, per_section)
    return np.array([np.percentile(blocks[k : k + per_section], data["percentile"]) for k in sections])


def mean_comfort(x: Floats, y: Floats, z: Floats) -> Floats:
    """N_MV (s,) of the percentiles of the three directions [m/s2]: ``6 sqrt(x^2 + y^2 + z^2)``.

    >>> mean_comfort(np.array([0.1]), np.array([0.2]), np.array([0.2])).round(12).tolist()
    [1.8]
    """
    return np.asarray(comfort_data()["en12299"]["factor"] * np.sqrt(x**2 + y**2 + z**2), np.float64)
