"""How much longer a plate in bending lives than one in membrane stress of the same structural stress range: I(r)."""

from pathlib import Path

import numpy as np

from examples.gallery.drawing import draw
from fatigue.life.rule import ratio_factor


def number() -> float:
    """Equivalent range of pure bending over that of pure membrane stress [-]."""
    return float(ratio_factor(np.array(0.0)) / ratio_factor(np.array(1.0)))


def picture(path: Path) -> None:
    """I(r)^(1/m) over the bending ratio."""
    r = np.linspace(0, 1, 101)
    draw(path, {"I(r)^(1/m)": (r, ratio_factor(r))}, "bending ratio r [-]", "I(r)^(1/m) [-]")
