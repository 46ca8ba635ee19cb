"""What a knee does to small ranges: the damage of a cycle on the aluminium master curve, with and without Haibach's."""

from pathlib import Path

import numpy as np

from examples.gallery.drawing import draw
from fatigue import catalogue
from fatigue.life.curves import damage_law
from fatigue.life.rule import cycle_damage

CURVE = catalogue()["master-aluminium"]
PLAIN = damage_law(CURVE, "mean-2sigma", "none", 1e7)
HAIBACH = damage_law(CURVE, "mean-2sigma", "haibach", 1e7)


def number() -> float:
    """Share of its damage that a cycle of half the range at the knee keeps: 0.5^(k - 1) [-]."""
    half = np.array([0.5 * CURVE.reference_range["mean-2sigma"] * 1e7 ** (-1 / CURVE.slopes[0])])
    return float(cycle_damage(half, HAIBACH)[0] / cycle_damage(half, PLAIN)[0])


def picture(path: Path) -> None:
    """Damage of a cycle over its equivalent range."""
    x = np.geomspace(5, 100, 80)
    laws = {"no knee": PLAIN, "Haibach": HAIBACH}
    lines = {name: (np.log10(x), np.log10(cycle_damage(x, law))) for name, law in laws.items()}
    draw(path, lines, "log10 equivalent range", "log10 damage")
