"""Numbers that are solved for, put back into the case: what comes out is what they promise."""

import copy
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.report.result import read_result
from fatigue.report.variants import assumptions_of, variants
from tests.small_case import SmallCase, small_case

KEY = ["weld", "part", "order", "surface"]
OWN = """
[curves.own]
slopes = [3.0, 5.0]
knees_cycles = [2e6]
range_at_2e6_MPa = 90.0
applies = "structural"
source = "test"
thickness_reference_mm = 5.0
thickness_exponent = 0.2
[curves.own-dS]
slopes = [3.0, 9.0]
knees_cycles = [1e5, 1e8]
range_at_2e6_MPa = 70.0
applies = "dS"
source = "test"
log10_scatter = 0.2
"""


def case_of(
    *,
    curve: dict[str, object] | None = None,
    target_km: float = 1e4,
    dead_load: float = 0.0,
    residue: str = "repeat",
    events: Callable[[list[dict[str, object]]], list[dict[str, object]]] = lambda events: events,
) -> SmallCase:
    """The small case, short, in tension by a dead load, its events changed, the noise with a factor of its own."""
    case = small_case(seconds=3.0)
    case.curve |= curve or {}
    case.extra = OWN
    case.counting = {"residue": residue}
    case.mission["target_km"] = target_km
    for history in case.histories.values():
        history["q_1"] += dead_load
    case.events[1]["stress_factor"] = 1.3
    case.events = events(case.events)
    return case


ASME = {"mean_stress": "asme", "yield_MPa": 250.0}
SCALES = {
    "straight": case_of(),
    "half": case_of(residue="half"),
    "by number alone": case_of(events=lambda events: [events[2]], target_km=3e8),
    "a tiny target": case_of(target_km=1e-12),
    "f_M far away": case_of(curve=ASME | {"yield_MPa": 1e5}, dead_load=60.0),
}
SMOOTH = {
    "haibach": case_of(curve={"extension": "haibach"}, target_km=1e6),
    "a knee before the reference cycles": case_of(
        curve={"name": "own-straight", "extension": "haibach", "knee_cycles": 1e6}, target_km=1e6
    ),
    "two slopes": case_of(curve={"name": "own"}, target_km=1e5),
    "two slopes, by number alone": case_of(
        curve={"name": "own"}, target_km=3e8, events=lambda events: [events[2] | {"residue": "repeat"}]
    ),
}
SMOOTH[
    "a knee before the reference cycles"
].extra += '[curves.own-straight]\nslopes = [5.0]\nrange_at_2e6_MPa = 60.0\napplies = "structural"\nsource = "test"\n'
JUMPS = {
    "cut-off": case_of(curve={"extension": "cutoff"}, target_km=1e6),
    "cut-off, nothing damages": case_of(curve={"extension": "cutoff", "knee_cycles": 10.0}),
    "two slopes in dS and a cut-off": case_of(curve={"name": "own-dS", "survival": "mean-1sigma"}, target_km=1e6),
    "f_M begins above": case_of(curve=ASME, dead_load=60.0, target_km=300.0),
    "f_M is there": case_of(curve=ASME | {"yield_MPa": 100.0}, dead_load=60.0, target_km=1e4),
    "f_M, half, by number too": case_of(curve=ASME, dead_load=90.0, target_km=50.0, residue="half"),
    "f_M and haibach": case_of(curve=ASME | {"extension": "haibach"}, dead_load=90.0, target_km=300.0),
    "f_M and cut-off": case_of(curve=ASME | {"extension": "cutoff"}, dead_load=90.0, target_km=300.0),
    "f_M ends": case_of(curve=ASME | {"yield_MPa": 30.0}, dead_load=45.0, target_km=1e3),
}


def assessed(case: SmallCase, folder: Path, share: float = 0.0) -> tuple[pd.DataFrame, pd.Series]:
    """Points, and the load factor of every weld."""
    path = case.write(folder / "case")
    assess(path, folder / "result", threads=1, share=share, proves_worst=False, report=False)
    nodes = pd.read_parquet(folder / "result" / "nodes.parquet").set_index(KEY)
    return nodes, pd.read_parquet(folder / "result" / "welds.parquet").set_index("weld")["load_factor"]


def scaled(case: SmallCase, factor: float) -> SmallCase:
    """The case with a factor on all stresses of every event."""
    case = copy.deepcopy(case)
    for event in case.events:
        event["stress_factor"] = float(event.get("stress_factor", 1.0)) * float(factor)
    return case


def largest(nodes: pd.DataFrame, weld: str) -> float:
    """Largest utilisation of the toe points of a weld."""
    return float(nodes.loc[nodes.toe].loc[weld, "utilisation"].max())


@pytest.mark.parametrize("case", SCALES.values(), ids=SCALES.keys())
def test_a_load_factor_uses_up_the_limit_where_damage_scales(case, tmp_path):
    """Utilisation 1 within 1e-6 when the load factor is put back into every event."""
    _, factors = assessed(case, tmp_path / "once")
    again, ones = assessed(scaled(case, factors["A"]), tmp_path / "again")
    assert largest(again, "A") == pytest.approx(1.0, abs=1e-6)
    assert ones["A"] == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("case", SMOOTH.values(), ids=SMOOTH.keys())
def test_a_load_factor_uses_up_the_limit_on_a_curve_with_a_knee(case, tmp_path):
    """Utilisation 1 within 1e-3."""
    _, factors = assessed(case, tmp_path / "once")
    again, _ = assessed(scaled(case, factors["A"]), tmp_path / "again")
    assert largest(again, "A") == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize("case", JUMPS.values(), ids=JUMPS.keys())
def test_a_load_factor_is_the_largest_one_where_damage_jumps(case, tmp_path):
    """At the load factor the target is met, a thousandth above it is not: at a cut-off, and where f_M begins."""
    _, factors = assessed(case, tmp_path / "once")
    at, _ = assessed(scaled(case, factors["A"]), tmp_path / "at")
    above, _ = assessed(scaled(case, 1.001 * factors["A"]), tmp_path / "above")
    assert largest(at, "A") <= 1.0 < largest(above, "A")


@pytest.mark.parametrize("name", ["straight", "haibach", "cut-off", "f_M begins above"])
def test_load_factors_of_bounds_are_bounds(name, tmp_path):
    """Screened points have a factor, never above the counted one."""
    case = copy.deepcopy((SCALES | SMOOTH | JUMPS)[name])
    case.mission["target_km"] /= 1e5
    exact, _ = assessed(case, tmp_path / "exact")
    screened, _ = assessed(case, tmp_path / "screened", share=1.0)
    bounds = screened.load_factor[screened.screened != ""]
    assert len(bounds) > 3
    assert (bounds <= exact.load_factor[bounds.index]).all()
    assert (bounds >= 1.0).all()
    counted = screened.load_factor[screened.screened == ""]
    np.testing.assert_allclose(counted, exact.load_factor[counted.index], rtol=1e-12)


YIELD = {"yield_MPa": 150.0}
CHOICES = [  # of the table of a weld: assumption, choice, and what it is in the case
    ("survival", "mean", {"survival": "mean"}),
    ("survival", "mean-3sigma", {"survival": "mean-3sigma"}),
    ("below the knee", "Haibach at 3e+05 cycles", {"extension": "haibach"}),
    ("below the knee", "cut-off at 3e+05 cycles", {"extension": "cutoff"}),
    ("thickness in dS", "ASME, at least 16 mm", {"thickness_rule": "asme"}),
    ("mean stress", "ASME factor for high mean stress", {"mean_stress": "asme"}),
]


@pytest.fixture(scope="module")
def as_it_is(tmp_path_factory) -> tuple[SmallCase, pd.DataFrame, pd.DataFrame]:
    """A case with a dead load, its points, and the table of assumptions of the worst point of weld A."""
    case = case_of(curve=YIELD | {"knee_cycles": 3e5}, dead_load=45.0)
    folder = tmp_path_factory.mktemp("as-it-is")
    nodes, _ = assessed(case, folder)
    result = read_result(folder / "result", 2, 100)
    used = assumptions_of(result.record, "master-aluminium")
    return case, nodes, variants(result.worst("A"), result.cycles("A"), result.passes_per_km, used)


@pytest.mark.parametrize(("assumption", "choice", "change"), CHOICES, ids=[choice for _, choice, _ in CHOICES])
def test_a_life_under_another_assumption_is_that_of_another_run(as_it_is, tmp_path, assumption, choice, change):
    """What the report says of survival, knee, thickness rule and mean stress is what the case with them gives."""
    case, nodes, table = as_it_is
    said = table[(table.assumption == assumption) & (table.choice == choice)].damage_factor.item()
    other = copy.deepcopy(case)
    other.curve |= change
    again, _ = assessed(other, tmp_path)
    assert said == pytest.approx(largest(again, "A") / largest(nodes, "A"), rel=1e-9)
    assert said != pytest.approx(1.0, rel=1e-3)


def test_ends_and_limit_are_those_of_another_run(tmp_path):
    """Life without end treatment is that of a weld whose ends are not treated; twice the limit is twice the life."""
    case = case_of(curve={"extension": "haibach"})
    ends = case.nodal_forces.node.isin([100, 106, 200, 206])
    case.nodal_forces.loc[ends, ["fx_N", "fy_N", "fz_N"]] *= 1.4
    nodes, _ = assessed(case, tmp_path / "treated")
    raw, doubled = copy.deepcopy(case), copy.deepcopy(case)
    raw.welds["end_length_mm"] = 0.0
    doubled.mission["damage_limit"] = 2.0
    untreated, _ = assessed(raw, tmp_path / "raw")
    np.testing.assert_allclose(nodes.life_km_raw_end, untreated.life_km, rtol=1e-9)
    assert (nodes.life_km_raw_end / nodes.life_km).min() < 0.9
    twice, _ = assessed(doubled, tmp_path / "doubled")
    np.testing.assert_allclose(twice.life_km, 2.0 * nodes.life_km, rtol=1e-12)
