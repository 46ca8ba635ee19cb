"""S-N curves of European codes as a user gives them: cycles, knees and cut-offs as codes and tools print them."""

import math
from pathlib import Path

import numpy as np
import pytest

from fatigue.case import load_case
from fatigue.life.curves import DamageLaw, damage_law
from fatigue.life.rule import cycle_damage
from fatigue.pipeline.solve.rated.known_curves import curves_of_case
from tests.small_case import small_case

CURVES = {  # slopes, knees, range at 2e6, quantity
    "en1993-90": ([3.0, 5.0], [5e6, 1e8], 90.0, "normal"),
    "en1993-shear-80": ([5.0], [1e8], 80.0, "shear"),
    "iiw-36": ([3.0, 5.0], [1e7], 36.0, "normal"),
    "iiw-100": ([3.0, 5.0], [1e7], 100.0, "normal"),
    "iiw-100-constant": ([3.0, 22.0], [1e7], 100.0, "normal"),
    "iiw-shear-80": ([5.0], [1e8], 80.0, "shear"),
    "iiw-shear-80-goes-on": ([5.0], [], 80.0, "shear"),
    "en1999-3.4": ([3.4, 5.4], [5e6, 1e8], 40.0, "normal"),
    "en1999-4.3": ([4.3, 6.3], [5e6, 1e8], 40.0, "normal"),
    "dnv-b1": ([4.0, 5.0], [1e7], (10**15.117 / 2e6) ** 0.25, "normal"),
    "dnv-c-sea": ([3.0, 5.0], [1e6], (10**16.320 / 2e6) ** 0.2, "normal"),
}
N_OF_RANGE = [
    ("en1993-90", 120.0, 843750.0),
    ("en1993-90", 90.0, 2e6),
    ("en1993-90", 66.0, 5119523.32516),
    ("en1993-90", 50.0, 20516306.6678),
    ("en1993-90", 36.5, 98965741.1596),
    ("en1993-90", 36.0, math.inf),
    ("iiw-36", 40.0, 1458000.0),
    ("iiw-36", 20.0, 12924463.3184),
    ("iiw-36", 10.0, 413582826.19),
    ("en1993-shear-80", 80.0, 2e6),
    ("en1993-shear-80", 40.0, 64e6),
    ("en1993-shear-80", 36.6, 99787123.4946),
    ("en1993-shear-80", 36.5, math.inf),
    ("iiw-shear-80-goes-on", 36.5, 2e6 * (80.0 / 36.5) ** 5),
    ("iiw-100", 40.0, 66795935.0),
]


@pytest.fixture(scope="module")
def laws(tmp_path_factory: pytest.TempPathFactory) -> dict[str, DamageLaw]:
    """The damage of every curve, read from a case as a user writes it."""
    case, folder = small_case(), Path(tmp_path_factory.mktemp("curves"))
    case.extra = "\n".join(
        f'[curves."{name}"]\nslopes = {slopes}\nknees_cycles = {knees}\nrange_at_2e6_MPa = {at_2e6!r}\n'
        f'applies = "structural"\nquantity = "{quantity}"\nsource = "as the code has it"\n'
        for name, (slopes, knees, at_2e6, quantity) in CURVES.items()
    )
    known = curves_of_case(load_case(case.write(folder)))
    assert all(known[name].quantity == quantity for name, (_, _, _, quantity) in CURVES.items())
    return {name: damage_law(known[name], None, "none", 1e7) for name in CURVES}


@pytest.mark.parametrize(("curve", "S", "N"), N_OF_RANGE)
def test_cycles_of_a_range(laws: dict[str, DamageLaw], curve: str, S: float, N: float) -> None:
    """EN 1993-1-9 category 90 and shear 80, IIW FAT 36, 100 and shear 80; below a cut-off no number of cycles."""
    d = float(cycle_damage(np.array([S]), laws[curve])[0])
    assert (1.0 / d if d > 0.0 else math.inf) == pytest.approx(N, rel=2e-8)


@pytest.mark.parametrize(
    ("curve", "at_2e6", "knees", "cutoff"),
    [
        ("en1993-90", 90.0, [0.736806299728], 0.40471316447),
        ("en1993-shear-80", 80.0, [], 0.457305051927),
        ("iiw-shear-80", 80.0, [], 0.457305051927),
        ("iiw-100", 100.0, [0.584803547643], 0.0),
        ("iiw-100-constant", 100.0, [0.584803547643], 0.0),
        ("en1999-3.4", 40.0, [0.763763361477], 0.763763361477 * 0.574207048608),
        ("en1999-4.3", 40.0, [0.80808270512], 0.80808270512 * 0.621566074392),
    ],
)
def test_knees_and_cut_offs_over_the_class(
    laws: dict[str, DamageLaw], curve: str, at_2e6: float, knees: list[float], cutoff: float
) -> None:
    """From slopes and cycles alone: .7368 and .5493 of EN 1993, .4573 in shear, m1 and m1 + 2 of EN 1999."""
    np.testing.assert_allclose(laws[curve].knees, at_2e6 * np.array(knees), rtol=1e-11)
    assert laws[curve].cutoff == pytest.approx(at_2e6 * cutoff, rel=1e-11)


def test_public_worked_numbers(laws: dict[str, DamageLaw]) -> None:
    """EC3 category 90 (feaweld), FAT 100 with two slopes, DNV B1 and C (qats)."""
    category = cycle_damage(np.array([120.0]), laws["en1993-90"])
    assert 2e6 * category[0] == pytest.approx(2.37037037037, rel=1e-11)
    of_three = cycle_damage(np.array([100.0, 60.0, 40.0]), laws["iiw-100"])
    assert of_three @ [1e5, 1e6, 1e6] == pytest.approx(0.172970971, rel=1e-8)
    b1, c = laws["dnv-b1"], laws["dnv-c-sea"]
    assert b1.log_constants[1] / math.log(10.0) == pytest.approx(17.146, abs=5e-4)
    assert b1.knees[0] == pytest.approx(106.97, abs=5e-3)
    assert c.log_constants[0] / math.log(10.0) == pytest.approx(12.192, abs=5e-4)
    assert math.exp((c.log_constants[1] - math.log(1e7)) / 5.0) == pytest.approx(73.11, abs=5e-3)
