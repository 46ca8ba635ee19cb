"""Forward with a result in memory: what each number rests on, which bounds are enough, and the verdict of a weld."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from fatigue.decide.whatif.change import Change, Mission
from fatigue.decide.whatif.curves import Curves, OneCurve
from fatigue.decide.whatif.forward import BASES, forward
from fatigue.decide.whatif.stored import Stored
from fatigue.decide.whatif.verdicts import weld_table
from fatigue.life.bounds.histogram import Enclosed
from fatigue.life.curves import catalogue, damage_law
from fatigue.life.rule import CycleRule
from fatigue.pipeline.solve.rated.rated_curves import RatedCurve

PER_PASS = 1e-7 * np.array([[3.0, 1.0], [2.0, 2.0], [0.1, 0.2], [0.0, 0.0], [0.5, 0.1], [4.0, 9.0]])
WEIGHTS = np.array([0.4, 0.2])
WELD = np.array([0, 0, 0, 0, 1, 1], dtype=np.int32)
FACTORS = {  # loads_oracles.json, B2_whatif.exact_life_factors_aluminium
    "mean": 4.41175761744262,
    "mean-1sigma": 2.100426037401719,
    "mean-3sigma": 0.4760979307026653,
}


def rated(survival="mean-2sigma", thickness_rule="actual", name="master-aluminium"):
    """A straight master curve at a level."""
    curve = catalogue()[name]
    return RatedCurve(curve, survival, CycleRule(damage_law(curve, survival, "none", 1e7), True), thickness_rule)


def of_curves(before=None, after=None, limit=1.0):
    """The same curve for both welds."""
    before = before or rated()
    return Curves((OneCurve(before, after or before, 1.0, limit),), {"A": 0, "B": 0})


@pytest.fixture
def stored():
    """Two welds of four points and two; the last point of each is a face without a toe."""
    damage = PER_PASS @ WEIGHTS
    of_welds = pd.DataFrame(
        {
            "weld": ["A", "B"],
            "fulfilled": [True, True],
            "utilisation": [0.14, 0.02],
            "life_km": 1.0 / damage[[0, 4]],
            "load_factor": [1.5, 2.0],
            "worst_part": [1, 1],
            "worst_order": [1, 1],
            "worst_surface": ["top", "top"],
        }
    )
    return Stored(
        folder=Path(),
        record={"rules": {"screening": {"share_of_limit": 0.0}}},
        names=("a", "b"),
        welds=("A", "B"),
        weld=WELD,
        toe=np.array([True, True, True, True, True, False]),
        counted=np.ones(6, dtype=bool),
        damage_per_km=damage,
        per_pass=PER_PASS,
        thickness=np.full(6, 4.0),
        attachment=np.full(6, np.inf),
        of_welds=of_welds,
    )


def change(weights=WEIGHTS, factors=(1.0, 1.0), target=1e6, recount=()):
    """A change of two events without loops."""
    before = Mission(WEIGHTS, 1e6, 1e5, 1.0)
    after = Mission(np.asarray(weights), target, 1e5, 1.0)
    return Change(("a", "b"), (), before, after, np.asarray(factors), recount)


def none(kind):
    """Ranges that nothing may ask for."""
    raise AssertionError(kind)


def bases(found):
    """Words of the basis of every point."""
    return [BASES[i] for i in found.basis]


def test_shares_are_sums_and_loads_are_powers(stored):
    """Other weights are a product, a factor on one event its power: 1.1 on steel and aluminium as in the oracles."""
    weights = np.array([0.1, 0.9])
    found = forward(stored, change(weights), of_curves(), none)
    np.testing.assert_allclose(found.damage.value, PER_PASS @ weights, rtol=1e-15)
    assert bases(found) == ["exact"] * 6
    for name, life in (("master-aluminium", 0.708977791891509), ("master-steel", 0.7420709488996504)):
        found = forward(stored, change(factors=(1.1, 1.1)), of_curves(rated(name=name)), none)
        np.testing.assert_allclose(stored.damage_per_km[:3] / found.damage.value[:3], life, rtol=1e-9)


@pytest.mark.parametrize(("level", "life"), FACTORS.items())
def test_survival_is_the_factor_of_the_specification(stored, level, life):
    """Lives at a level over those at mean - 2 sigma."""
    found = forward(stored, change(), of_curves(after=rated(level)), none)
    np.testing.assert_allclose(stored.damage_per_km[:3] / found.damage.value[:3], life, rtol=1e-9)


def test_asme_thickness_is_the_factor_of_the_specification(stored):
    """A plate of 4 mm taken for one of 16 mm."""
    found = forward(stored, change(), of_curves(after=rated(thickness_rule="asme")), none)
    np.testing.assert_allclose(stored.damage_per_km[:3] / found.damage.value[:3], 0.3290097417321619, rtol=1e-9)


def test_a_screened_point_keeps_a_bound_until_it_reaches_what_decides(stored):
    """Below a tenth of the limit and the worst counted point it is a bound with no low, above it has no number."""
    some = replace(stored, counted=np.array([True, True, False, False, True, True]))
    found = forward(some, change(), of_curves(), none)
    assert bases(found) == ["exact", "exact", "bound", "bound", "exact", "exact"]
    assert found.damage.low[2] == 0.0
    assert found.damage.value[2] == found.damage.high[2] == stored.damage_per_km[2]
    found = forward(some, change(target=2e7), of_curves(), none)
    assert bases(found)[2] == "recount"
    assert np.isnan(found.damage.value[2])
    worst = replace(stored, counted=np.array([False, True, True, True, True, True]))
    assert bases(forward(worst, change(target=1e5), of_curves(), none))[0] == "recount"
    assert bases(forward(worst, change(target=1e5, weights=(0.1, 0.9)), of_curves(), none))[0] == "bound"


def test_a_reason_to_count_again_leaves_no_number(stored):
    """Whatever the points are."""
    found = forward(stored, change(recount=("residue",)), of_curves(), none)
    assert bases(found) == ["recount"] * 6
    assert all(np.isnan(part).all() for part in found.damage)


def test_damage_that_is_not_the_sum_of_its_events_is_kept_or_counted_again(stored):
    """Where something else decides about a point, only what leaves its damage alone is exact."""
    other = replace(stored, damage_per_km=stored.damage_per_km * np.array([2.0, 1.0, 1.0, 1.0, 1.0, 1.0]))
    found = forward(other, change(target=2e6), of_curves(), none)
    assert bases(found) == ["exact"] * 6
    assert found.damage.value[0] == other.damage_per_km[0]
    assert bases(forward(other, change((0.1, 0.1)), of_curves(), none))[0] == "recount"
    found = forward(stored, change((0.1, 0.1)), of_curves(), none, decided_by_shear=True)
    assert bases(found) == ["recount"] * 5 + ["exact"]


def table(stored, found, target=1e6):
    """Table of the welds, by name."""
    keys = pd.DataFrame({"part": 1, "node": range(6), "order": [1, 2, 3, 4, 1, 2], "surface": "top"})
    factors = Enclosed(*np.full((3, 6), 2.0))
    return weld_table(stored, change(target=target), ["x", "x"], found, factors, keys).set_index("weld")


def test_the_verdict_of_a_weld_has_a_proof_or_is_none(stored):
    """A sure miss, a band across the limit, a point without number; faces without a toe never govern."""
    found = forward(stored, change(), of_curves(), none)
    welds = table(stored, found)
    assert welds["verdict"].tolist() == ["meets", "meets"]
    np.testing.assert_allclose(welds.loc["A", "utilisation"], PER_PASS[0] @ WEIGHTS * 1e6)
    np.testing.assert_allclose(welds.loc["B", "utilisation"], PER_PASS[4] @ WEIGHTS * 1e6)
    assert not welds["worst_moved"].any()
    welds = table(stored, found, target=1e7)
    assert welds.loc["A", "verdict"] == "misses"
    assert welds.loc["A", "flips"]
    found.damage.high[1] = 2e-6
    open_ = table(stored, found)
    assert open_.loc["A", "verdict"] == "not_proven"
    assert open_.loc["A", "utilisation_high"] == 2.0
    assert open_.loc["A", "life_km_low"] == 5e5
    found.basis[2] = BASES.index("recount")
    for part in found.damage:
        part[2] = np.nan
    left = table(stored, found)
    assert left.loc["A", ["verdict", "basis", "points_to_recount"]].tolist() == ["not_proven", "recount", 1]
    assert np.isnan(left.loc["A", "life_km_low"])


def test_a_check_that_fails_is_no_flip(stored):
    """A weld whose toe meets its target and whose check does not is not proven, before and after."""
    failing = replace(stored, of_welds=stored.of_welds.assign(fulfilled=[True, False]))
    welds = table(failing, forward(failing, change(), of_curves(), none))
    assert welds.loc["B", "verdict_before"] == "misses"
    assert welds.loc["B", "verdict"] == "not_proven"
    assert not welds.loc["B", "flips"]
