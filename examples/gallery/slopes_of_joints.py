"""Published tests of aluminium butt joints beside the slope of the master curve."""

from pathlib import Path

import numpy as np

from examples.gallery.drawing import draw
from fatigue import catalogue

RANGES, CYCLES = np.array([104.0, 89.0, 74.0]), np.array([549_300.0, 880_500.0, 1_540_100.0])


def number() -> float:
    """Slope k of the tests by least squares of log N over log S [-]."""
    return float(-np.polyfit(np.log(RANGES), np.log(CYCLES), 1)[0])


def picture(path: Path) -> None:
    """Tests, and the slope of the curve through the one in the middle."""
    k = catalogue()["master-aluminium"].slopes[0]
    curve = CYCLES[1] * (RANGES / RANGES[1]) ** -k
    lines = {"tests": (np.log10(CYCLES), np.log10(RANGES)), f"slope {k:.2f}": (np.log10(curve), np.log10(RANGES))}
    draw(path, lines, "log10 cycles", "log10 range [MPa]")
