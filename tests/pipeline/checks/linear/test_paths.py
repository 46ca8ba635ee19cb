"""Throats counted as a path: against rainflow where the path is straight, the load factor, and what is refused."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.assess import assess
from fatigue.errors import DataError
from fatigue.life.curves import damage_law, user_curve
from fatigue.life.rule import cycle_damage
from fatigue.pipeline.checks.linear.counted import counted_each
from fatigue.pipeline.checks.linear.paths import counted_paths, largest_factor
from tests.pipeline.checks.linear.test_directions import KNEE, ONE, PARTS, PLAIN, SUMS, event, plan_of
from tests.small_case import sine_only, small_case
from tests.throat_case import HEAD, row, with_throats

PATH_HEAD = HEAD + ",combination"


@pytest.mark.parametrize("rule", [PLAIN, KNEE])
@pytest.mark.parametrize("residue", ["repeat", "half"])
def test_a_straight_path_is_rainflow(rule, residue):
    """Two stresses in proportion have the mission of their resultant, load factor and governing event among it."""
    rng = np.random.default_rng(4)
    signal = rng.normal(0.0, 25.0, (2, 90))
    loads = [event(f"event {i}", [0.6 * s, -0.8 * s], residue, stress_factor=1.0 + i) for i, s in enumerate(signal)]
    plan, size = plan_of(0.5, 2.0), np.array([1.1])
    found = counted_paths(PARTS, size, rule, loads, plan, "x")
    (expected,) = counted_each([np.array([[0.6, -0.8]])], size, rule, loads, plan, "x")
    assert found["governing_event"].tolist() == expected["governing_event"].tolist()
    for name in ("range_max_MPa", "damage_per_km", "damage_sum", "damage_limit"):
        np.testing.assert_allclose(found[name], expected[name], rtol=1e-9, err_msg=name)
    np.testing.assert_allclose(found["utilisation_stress"], expected["utilisation_stress"], rtol=3e-4)


def test_a_path_is_as_bad_as_its_worst_direction_or_worse():
    """Of random records none has a path that does less damage than the critical direction does."""
    rng = np.random.default_rng(9)
    for _ in range(12):
        load, plan = event("event 0", rng.normal(0.0, 30.0, (2, 60)).cumsum(axis=1)), plan_of(1.0)
        of_path = counted_paths(PARTS, ONE, PLAIN, [load], plan, "x")["damage_per_km"][0]
        directions = counted_each([sums[None] for sums in SUMS], ONE, PLAIN, [load], plan, "x")
        assert of_path >= 0.999 * max(one["damage_per_km"][0] for one in directions)


def test_a_force_that_turns_has_two_halves_of_its_diameter():
    """A circle of radius 10 is two half cycles of 20."""
    turn = 2.0 * np.pi * np.arange(720) / 720.0
    load = event("event 0", [10.0 * np.cos(turn), 10.0 * np.sin(turn)])
    found = counted_paths(PARTS, ONE, PLAIN, [load], plan_of(3.0), "x")
    assert found["range_max_MPa"][0] == pytest.approx(20.0)
    assert found["damage_per_km"][0] == pytest.approx(3.0 * float(cycle_damage(np.array(20.0), PLAIN.law)), rel=1e-4)


def test_a_point_at_rest_has_nothing():
    """Without stress there is no damage, no governing event and no utilisation."""
    found = counted_paths(0.0 * PARTS, ONE, KNEE, [event("event 0", np.ones((2, 9)))], plan_of(1.0), "x")
    nothing = [float(found[name][0]) for name in ("range_max_MPa", "damage_per_km", "utilisation_stress")]
    assert (nothing, found["governing_event"].tolist()) == ([0.0, 0.0, 0.0], [""])


@given(
    st.lists(st.floats(0.1, 1e3), min_size=1, max_size=6),
    st.floats(1.0, 1e9),
    st.sampled_from([((3.0,), ()), ((3.0, 5.0), (5e6,)), ((3.0, 5.0), (5e6, 1e8)), ((5.0,), (1e8,))]),
)
@settings(max_examples=60, deadline=None)
def test_the_factor_is_the_largest_that_keeps_the_limit(x, cycles, curve):
    """Just below the factor the sum keeps its limit, just above it does not."""
    law = damage_law(user_curve("c", *curve, 40.0, "throat", "test"), None, "none", 1e7)
    ranges, n = np.array(x), np.full(len(x), cycles)
    factor = largest_factor(ranges, n, law, 0.5)
    below, above = (float((n * cycle_damage(f * factor * ranges, law)).sum()) for f in (1 - 1e-9, 1 + 1e-9))
    assert below <= 0.5 * (1.0 + 1e-6)
    assert above > 0.5 * (1.0 - 1e-6)


def test_the_table_asks_for_a_path(tmp_path):
    """A weld in tension has the same path as direction; its row names no direction."""
    case = sine_only()
    rows = [row("A", "both") + ",path", row("B", "bottom") + ","]
    path = with_throats(case, tmp_path / "case", rows, head=PATH_HEAD)
    assess(path, tmp_path / "out", threads=1, report=False)
    perp = pd.read_parquet(tmp_path / "out" / "checks.parquet").query("check == 'throat_perp'").set_index("weld")
    assert set(perp.component["A"]) == {"path of sigma_perp, tau_perp"}
    assert perp.direction_deg["A"].isna().all()
    assert perp.direction_deg["B"].notna().all()
    other = with_throats(sine_only(), tmp_path / "other", [row("A", "both"), row("B", "bottom")])
    assess(other, tmp_path / "direction", threads=1, report=False)
    same = pd.read_parquet(tmp_path / "direction" / "checks.parquet").query("check == 'throat_perp'").set_index("weld")
    np.testing.assert_allclose(perp.damage_per_km["A"], same.damage_per_km["A"], rtol=1e-4)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ("sequence", "cycles across events are part of the mission"),
        ("vertex", "reversals = 'vertex' reads stress beyond them"),
        ("stress_ratio", "curve 'throat' has mean_stress = 'iiw_low'"),
    ],
)
def test_what_a_path_cannot_have_is_refused(tmp_path, change, message):
    """Cycles across events, vertices and stress ratios have no place on a path; the refusal names the weld."""
    case, extra = small_case(), ""
    if change == "sequence":
        extra = '[[mission.sequence]]\norder = ["sine", "noise"]\nper_1000_km = 1.5\n'
    if change == "vertex":
        case.counting["reversals"] = "vertex"
    path = with_throats(case, tmp_path, [row("A", "both") + ",path"], extra, head=PATH_HEAD)
    if change == "stress_ratio":
        path.write_text(path.read_text().replace("[curves.throat]\n", '[curves.throat]\nmean_stress = "iiw_low"\n'))
    with pytest.raises(DataError) as refusal:
        assess(path, tmp_path / "out", report=False)
    assert str(refusal.value).startswith("weld_throats.csv: weld A: combination: a ")
    assert message in str(refusal.value)
