"""Two tones beat: the largest cycle is the sum of both ranges, however seldom they meet."""

from pathlib import Path

import numpy as np

from examples.gallery.drawing import draw
from fatigue import rainflow

T = np.linspace(0, 10, 10_001)
SIGNAL = np.sin(2 * np.pi * 5.0 * T) + 0.8 * np.sin(2 * np.pi * 5.3 * T)


def number() -> float:
    """Largest range over twice the sum of the amplitudes [-]."""
    return float(np.max(rainflow(SIGNAL, "repeat").range) / (2 * 1.8))


def picture(path: Path) -> None:
    """The record."""
    draw(path, {"stress": (T[::10], SIGNAL[::10])}, "time [s]", "stress [-]")
