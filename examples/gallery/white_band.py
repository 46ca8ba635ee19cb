"""Dirlik's damage of band-limited white stress, 0 to 1 Hz, beside the narrow-band bound, over the slope."""

from pathlib import Path

import numpy as np

from examples.gallery.drawing import draw
from fatigue.spectrum.methods import dirlik_over_narrow_band, spectral_shape

MOMENTS = np.array([[1.0], [1 / 2], [1 / 3], [1 / 5]])  # orders 0, 1, 2, 4 of variance 1


def number() -> float:
    """Dirlik over narrow band at k = 3: 1.73862875 / 2.17080376 [-]."""
    return float(dirlik_over_narrow_band(spectral_shape(MOMENTS), 3.0)[0])


def picture(path: Path) -> None:
    """The ratio over the slope of the S-N curve."""
    k = np.linspace(3, 8, 51)
    ratio = [float(dirlik_over_narrow_band(spectral_shape(MOMENTS), slope)[0]) for slope in k]
    draw(path, {"Dirlik / narrow band": (k, ratio)}, "slope k [-]", "ratio [-]")
