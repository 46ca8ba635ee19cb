"""From passes to kilometres, by hand."""

from collections.abc import Iterator

import numpy as np

from fatigue.life.curves import catalogue, damage_law
from fatigue.life.mission import Pass, life_km, load_factor, mission_sum, range_at_2e6, straight_load_factor
from fatigue.verify.check import Check

PLAIN = "arithmetic"


def mission_checks() -> Iterator[Check]:
    """Checks of the mission sum, life, load factors and the equivalent range."""
    passes = (
        Pass("run", samples=1000, length=2.5, share=1.0, per_1000_km=None),
        Pass("load", samples=2, length=None, share=None, per_1000_km=4.0),
    )
    damage = mission_sum(np.array([[2e-7], [5e-6]]), passes)
    case = "2e-7 a pass of 2.5 km, 5e-6 a loading, 4 in 1000 km"
    yield _mission(case, "damage per km", "1/km", 1e-7, float(damage[0]))
    yield _mission(case, "life at a damage limit of 0.5", "km", 5e6, float(life_km(damage, 0.5)[0]))
    yield _mission(case, "life without damage", "1/km", 0.0, float(1 / life_km(np.zeros(1), 0.5)[0]))
    factor = float(straight_load_factor(np.array([8.0]), 3.0)[0])
    yield _mission("utilisation 8, slope 3", "load factor", "-", 0.5, factor)
    found = float(range_at_2e6(np.array([4.0 * 30.0**3]), 3.0, 5e5)[0])
    yield _mission("4 cycles of 30 MPa a km, 5e5 km, k = 3", "range at 2e6 cycles", "MPa", 30.0, found)

    law = damage_law(catalogue()["en1993-hotspot-100"], None, "none", 1e7)
    above, below = 2.0 * float(law.knees[0]), float(law.knees[0]) / 1.25
    for case, x, n in (("above the knee", above, 5e6 / 2**3), ("below the knee", below, 5e6 * 1.25**5)):
        count = np.array([[2.0]])
        found = float(load_factor(count, count * (x / 1.1) ** 3, law, target_km=n / 2, damage_limit=1.0)[0])
        yield _mission(f"slopes 3 and 5, range 1/1.1 of the allowed one {case}", "load factor", "-", 1.1, found)


def _mission(case: str, quantity: str, unit: str, expected: float, found: float) -> Check:
    return Check("mission", case, quantity, unit, expected, found, 1e-9, PLAIN)
