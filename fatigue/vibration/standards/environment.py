"""Vibration of equipment beside a table of limits: what the table holds, and what a record shows of it.

The table is data with an edition and a status. A comparison says where a record lies; it certifies nothing.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fatigue.vibration.standards.mirrored import Floats, mean_square

LINES_OF_A_BAND = 5.0  # bandwidth times duration from which the density in a third octave is looked at (10 lines)
PEAK_OF_RMS = 3.0  # three times the rms of long life: what a Gaussian test is clipped at


@dataclass(frozen=True, slots=True)
class DensityShape:
    """Spectral density over frequency, relative to its level, and the band that a mass leaves of it.

    Attributes
    ----------
    edges_hz : (k + 1,) edges of its pieces [Hz]
    exponents : (k,) power of frequency in each piece; the density is 1 at the start of its flat piece
    light_kg, light_hz, heavy_kg, heavy_hz : masses and bands of the rule of mass
    """

    edges_hz: tuple[float, ...]
    exponents: tuple[float, ...]
    light_kg: float
    light_hz: tuple[float, float]
    heavy_kg: float
    heavy_hz: tuple[float, float]

    def band(self, mass_kg: float | None) -> tuple[float, float]:
        """Edges f1 and f2 [Hz] for equipment of a mass [kg]; that of a light piece where the mass is not given."""
        if mass_kg is None or mass_kg <= self.light_kg:
            return self.light_hz
        factor = max(1.0, self.heavy_kg / mass_kg)
        return self.heavy_hz[0] * factor, self.heavy_hz[1] * factor

    def integral(self, low: float, high: float) -> float:
        """Integral of the shape [Hz] between two frequencies [Hz]; nothing lies outside its edges."""
        total, start = 0.0, self._starts()
        for k, p in enumerate(self.exponents):
            a, b = max(low, self.edges_hz[k]), min(high, self.edges_hz[k + 1])
            if a < b:
                scale = start[k] / self.edges_hz[k] ** p
                total += scale * (np.log(b / a) if p == -1 else (b ** (p + 1) - a ** (p + 1)) / (p + 1))
        return float(total)

    def _starts(self) -> list[float]:
        """Density at the start of each piece: continuous, and 1 in its highest piece."""
        values = [1.0]
        for k, p in enumerate(self.exponents):
            values.append(values[-1] * (self.edges_hz[k + 1] / self.edges_hz[k]) ** p)
        return [value / max(values) for value in values]


@dataclass(frozen=True, slots=True)
class VibrationClass:
    """Limits of one category and class; what the table does not hold is left out of its mappings from direction.

    Attributes
    ----------
    name, what : as in ``1A``, and what it is for
    functional_rms, long_life_rms, shock : by direction x, y, z [m/s2]
    functional_asd : level of the spectral density by direction [(m/s2)^2/Hz]
    shape : of the density; None: not in the table
    """

    name: str
    what: str
    functional_rms: Mapping[str, float]
    functional_asd: Mapping[str, float]
    long_life_rms: Mapping[str, float]
    shock: Mapping[str, float]
    shape: DensityShape | None


@dataclass(frozen=True, slots=True)
class VibrationTable:
    """Table of limits with its edition, its status and its source."""

    edition: str
    status: str
    source: str
    classes: Mapping[str, VibrationClass]


def band_rms(values: Floats, step: float, band: tuple[float, float]) -> float:
    """Rms [m/s2] of an acceleration (n,) between two frequencies [Hz]; NaN above half the sampling rate.

    >>> t = np.arange(4000) / 400
    >>> round(band_rms(3.0 + np.sqrt(2) * np.sin(2 * np.pi * 10 * t), 1 / 400, (2.0, 60.0)), 2)
    1.0
    """
    return float(np.sqrt(mean_square(values, step, np.array(band))[0]))


def third_octaves(low: float, high: float) -> Floats:
    """Centres (k,) [Hz] of the third octaves (base ten) that lie inside a band [Hz], at least by half of their octaves.

    >>> third_octaves(2.0, 10.0).round(2).tolist()
    [2.0, 2.51, 3.16, 3.98, 5.01, 6.31, 7.94, 10.0]
    """
    centres = 10 ** (np.arange(np.floor(10 * np.log10(low)), np.ceil(10 * np.log10(high)) + 1) / 10)
    inside = np.log10(np.minimum(centres * 10**0.05, high)) - np.log10(np.maximum(centres / 10**0.05, low))
    return np.asarray(centres[inside >= 0.05 - 2e-3], np.float64)  # 2 Hz stands for 10^0.3


def density_ratios(
    values: Floats, step: float, shape: DensityShape, level: float, band: tuple[float, float]
) -> tuple[Floats, Floats, Floats]:
    """Third octaves of a band, and the mean density of a record there over that of the table.

    Returns
    -------
    centres (k,) [Hz], ratios (k,) [-] and those centres that the record is too short for (j,) [Hz]

    The density is that of the whole record, and the third octaves average it: ten lines of it at least.
    """
    centres = third_octaves(*band)
    lower, upper = np.maximum(centres / 10**0.05, band[0]), np.minimum(centres * 10**0.05, band[1])
    resolved = (upper - lower) * values.size * step >= LINES_OF_A_BAND
    measured = mean_square(values, step, np.append(lower, upper[-1:]))
    of_table = level * np.array([shape.integral(a, b) for a, b in zip(lower, upper, strict=True)])
    ratios = np.divide(measured, of_table, out=np.full(centres.size, np.nan), where=of_table > 0)
    return centres[resolved], ratios[resolved], centres[~resolved]
