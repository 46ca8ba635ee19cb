"""Sequences from the case to the tables: rows that add up, load factors that meet the target, bounds that hold."""

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import Assessment, assess
from fatigue.diagnose import diagnose
from fatigue.errors import CaseError
from tests.small_case import SmallCase, small_case

LOOP = '[[mission.sequence]]\norder = ["sine", "load", "laden", "unload"]\nper_1000_km = 1.5\n'
POINT = ["weld", "part", "order", "surface"]


def empty_and_laden(**curve: Any) -> SmallCase:
    """A sine of an empty vehicle, noise of a laden one 60 units higher, and the two ways between them."""
    case = small_case()
    t = case.histories["sine"]["time_s"]
    case.histories["laden"] = case.histories["noise"].assign(q_1=60.0 + case.histories["noise"]["q_1"])
    case.histories["load"] = pd.DataFrame({"time_s": [0.0, 1.0], "q_1": [0.0, 60.0], "q_2": 0.0, "q_7": 0.0})
    case.histories["unload"] = case.histories["load"].assign(q_1=[60.0, 0.0])
    del case.histories["noise"]
    case.histories["sine"] = case.histories["sine"].assign(q_2=np.sin(7.0 * t))
    case.counting = {"upsample": 1}
    case.curve |= curve
    case.events = [
        {"name": "sine", "history": "sine", "speed_km_h": 180.0, "share": 0.75},
        {"name": "load", "history": "load", "per_1000_km": 1.5},
        {"name": "laden", "history": "laden", "speed_km_h": 360.0, "share": 0.25, "start_s": 1.0},
        {"name": "unload", "history": "unload", "per_1000_km": 2.0},
    ]
    return case


def assessed(case: SmallCase, folder: Path, **options: Any) -> tuple[Assessment, dict[str, pd.DataFrame]]:
    """The result of a case and its tables."""
    found = assess(case.write(folder / "case"), folder / "out", threads=1, report=False, **options)
    return found, {name: pd.read_parquet(folder / "out" / f"{name}.parquet") for name in ("nodes", "damage", "cycles")}


def weights(case: SmallCase) -> pd.Series:
    """Passes per km of the events, and runs per km of the loop."""
    of_events = {"sine": 0.75 / (12.0 * 0.05), "laden": 0.25 / (11.0 * 0.1), "load": 1.5e-3, "unload": 2e-3}
    return pd.Series(of_events | {"(sequence 1)": 1.5e-3})


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> dict[str, pd.DataFrame]:
    """The loop on a straight curve."""
    case = empty_and_laden()
    case.extra = LOOP
    return assessed(case, tmp_path_factory.mktemp("loop"))[1]


def test_rows_of_damage_add_up_to_those_of_the_points(result: dict[str, pd.DataFrame]) -> None:
    """Every event by its passes, the loop by its runs; the part of the loops stands beside."""
    nodes, damage = result["nodes"].set_index(POINT), result["damage"]
    damage = damage.assign(weighted=damage["damage_per_pass"] * damage["event"].map(weights(empty_and_laden())))
    total = damage.groupby(POINT)["weighted"].sum()
    assert total.to_numpy() == pytest.approx(nodes["damage_per_km"].reindex(total.index).to_numpy(), rel=1e-12)
    loop = damage[damage["event"] == "(sequence 1)"].set_index(POINT)
    assert loop["weighted"].to_numpy() == pytest.approx(nodes["damage_per_km_transitions"].to_numpy(), rel=1e-12)
    assert loop["damage_per_km"].isna().all()
    assert (loop["damage_per_pass"] > 0.0).all()
    assert nodes["damage_per_km_transitions_bound"].isna().all()
    assert nodes["damage_factor_if_shear"].isna().all()


def test_rows_of_cycles_add_up_to_the_row_of_the_loop(result: dict[str, pd.DataFrame]) -> None:
    """Cycles across events count, those they replace are taken off, with the events of both reversals."""
    cycles = result["cycles"]
    rows = cycles[cycles["event"] == "(sequence 1)"]
    by_point = rows.groupby(POINT)[["damage", "count"]].sum()
    damage = result["damage"][result["damage"]["event"] == "(sequence 1)"].set_index(POINT).loc[by_point.index]
    assert by_point["damage"].to_numpy() == pytest.approx(damage["damage_per_pass"].to_numpy(), rel=1e-9)
    assert by_point["count"].to_numpy() == pytest.approx(damage["cycles_per_pass"].to_numpy(), abs=1e-9)
    assert set(rows["count"]) == {1.0, -1.0, -0.5}
    across = rows[rows["start_event"] != rows["end_event"]]
    assert (across["count"] == 1.0).all()
    assert across.loc[across["range_MPa"].idxmax(), ["start_event", "end_event"]].isin(["sine", "laden"]).all()
    assert cycles.loc[cycles["event"] != "(sequence 1)", ["start_event", "end_event"]].isna().all(axis=None)
    largest = result["nodes"].set_index(POINT).loc[by_point.index, "max_range_MPa"]
    assert rows.groupby(POINT)["range_MPa"].max().to_numpy() == pytest.approx(largest.to_numpy(), rel=1e-12)


def scaled(case: SmallCase, factor: float) -> SmallCase:
    """The same case with all coordinates times a factor."""
    for name, table in case.histories.items():
        case.histories[name] = table.assign(**{q: factor * table[q] for q in ("q_1", "q_2", "q_7")})
    return case


CURVES: dict[str, dict[str, Any]] = {
    "straight": {},
    "haibach": {"extension": "haibach"},
    "cutoff": {"extension": "cutoff", "knee_cycles": 5e6},
    "mean stress": {"mean_stress": "asme", "yield_MPa": 150.0},
    "all": {"extension": "haibach", "mean_stress": "asme", "yield_MPa": 150.0},
}


@pytest.mark.parametrize("curve", CURVES)
def test_load_factor_put_back_meets_the_target(curve: str, tmp_path: Path) -> None:
    """On straight curves and on those with knees, also where the loop makes most of the damage."""

    def made() -> SmallCase:
        case = empty_and_laden(**CURVES[curve])
        case.extra = LOOP.replace("1.5", "200")
        for event in case.events[1::2]:
            event["per_1000_km"] = 200.0
        return case

    nodes = assessed(made(), tmp_path / "as it is")[1]["nodes"]
    worst = nodes.loc[nodes["utilisation"].idxmax()]

    def utilisation(factor: float, name: str) -> float:
        again = assessed(scaled(made(), factor), tmp_path / name)[1]["nodes"]
        return float(again.loc[worst.name, "utilisation"])

    at_factor = utilisation(worst["load_factor"], "scaled")
    if curve in ("straight", "haibach"):
        assert at_factor == pytest.approx(1.0, abs=1e-6)
    else:  # a cut-off and the onset of f_M are jumps: the factor is the last one that meets the target
        assert at_factor <= 1.0 < utilisation(1.0005 * worst["load_factor"], "a little more")
    assert worst["damage_per_km_transitions"] > 0.01 * worst["damage_per_km"]


@pytest.mark.parametrize("curve", CURVES)
def test_bounds_of_screened_points_hold(curve: str, tmp_path: Path) -> None:
    """Counted in full no point exceeds what screening says of it, the cycles across events included."""
    case = scaled(empty_and_laden(**CURVES[curve]), 0.05)
    case.extra = LOOP
    exact = assessed(case, tmp_path / "exact", share=0.0)[1]["nodes"]
    bounded = assessed(case, tmp_path / "screened", share=1.0, proves_worst=False)[1]["nodes"]
    at = bounded["screened"].fillna("") != ""
    assert (bounded["damage_per_km"] >= exact["damage_per_km"] * (1.0 - 1e-9)).all()
    assert (bounded["max_range_MPa"] >= exact["max_range_MPa"] * (1.0 - 1e-9)).all()
    assert (bounded["load_factor"] <= exact["load_factor"] * (1.0 + 1e-9)).all()
    assert bounded.loc[~at, "damage_per_km"].to_numpy() == pytest.approx(exact.loc[~at, "damage_per_km"].to_numpy())
    assert at.sum() > 10


def test_unknown_order_is_a_bound_beside_the_damage(tmp_path: Path) -> None:
    """Stints in place of a sequence: nothing is added, and what is stated is no less than what the loop adds."""
    case = empty_and_laden()
    case.extra = LOOP
    loop = assessed(case, tmp_path / "loop")[1]["nodes"]
    case.extra = ""
    for event in case.events:
        event["stints_per_1000_km"] = 1.5
    _, tables = assessed(case, tmp_path / "stints")
    nodes = tables["nodes"]
    assert nodes["damage_per_km_transitions"].isna().all()
    assert (nodes["damage_per_km_transitions_bound"] >= loop["damage_per_km_transitions"]).all()
    alone = loop["damage_per_km"] - loop["damage_per_km_transitions"]
    assert nodes["damage_per_km"].to_numpy() == pytest.approx(alone.to_numpy(), rel=1e-12)
    assert set(tables["damage"]["event"]) == {"sine", "load", "laden", "unload"}


def test_more_stints_than_passes_are_refused(tmp_path: Path) -> None:
    """Each event that is in the loops too often is named, with what is needed and what is there."""
    case = empty_and_laden()
    case.extra = LOOP.replace("1.5", "1.8")
    with pytest.raises(CaseError) as error:
        assess(case.write(tmp_path / "case"), tmp_path / "out")
    (problem,) = error.value.problems
    assert problem.code == "sequence_needs_more_passes"
    assert "'load' in 1000 km, and it is passed 1.5 times" in problem.what
    case.extra = LOOP + LOOP.replace('"load", ', "")
    with pytest.raises(CaseError) as error:  # entries of two loops add
        assess(case.write(tmp_path / "case"), tmp_path / "out")
    assert [p.where for p in error.value.problems] == ["case.toml: mission.sequence[1] and mission.sequence[2]"]
    assert "3 stints of the event 'unload'" in error.value.problems[0].what


@pytest.fixture(scope="module")
def diagnosed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, pd.DataFrame]:
    """The loop with a large share of the damage, diagnosed."""
    folder = tmp_path_factory.mktemp("diagnosed")
    case = empty_and_laden()
    case.extra = LOOP.replace("1.5", "200")
    for event in case.events[1::2]:
        event["per_1000_km"] = 200.0
    tables = assessed(case, folder)[1]
    found = diagnose(folder / "out")
    assert "cycles across events" in found.as_text()
    assert all(finding.sequence_share > 0.0 for finding in found.findings)
    return tables | {name: pd.read_parquet(folder / "out" / f"{name}.parquet") for name in ("attribution", "levers")}


def test_damage_of_a_loop_is_owed_to_modes_like_that_of_an_event(diagnosed: dict[str, pd.DataFrame]) -> None:
    """Events and loop add up to the damage of each point, the modes to the loop; damage goes with load^k."""
    attribution, nodes = diagnosed["attribution"], diagnosed["nodes"].set_index(POINT)
    whole = attribution[attribution["kind"].isin(["event", "sequence"])]
    total = whole.groupby(POINT)["damage_per_km"].sum()
    assert total.to_numpy() == pytest.approx(nodes["damage_per_km"].reindex(total.index).to_numpy(), rel=1e-9)
    loop = attribution[attribution["event"] == "(sequence 1)"]
    of_loop = loop[loop["kind"] == "sequence"].set_index(POINT)["damage_per_km"]
    for kind in ("mode", "band"):
        parts = loop[loop["kind"] == kind].groupby(POINT)["damage_per_km"].sum()
        assert parts.reindex(of_loop.index).to_numpy() == pytest.approx(of_loop.to_numpy(), rel=1e-9)
    exponents = attribution[attribution["kind"] == "load"].groupby(POINT)["life_exponent"].sum()
    assert exponents.to_numpy() == pytest.approx(-3.60855, rel=1e-3)
    of_modes = attribution[attribution["kind"] == "mode"].groupby(POINT)["life_exponent"].sum()
    assert of_modes.to_numpy() == pytest.approx(exponents.reindex(of_modes.index).to_numpy(), rel=1e-6)


def test_levers_count_the_loop_again(diagnosed: dict[str, pd.DataFrame]) -> None:
    """What a tenth less of the first mode buys, by its exponent and counted again, agree within the curvature."""
    levers = diagnosed["levers"]
    first = levers[levers["rank"] == 1]
    assert first["life_km_counted"].to_numpy() == pytest.approx(first["life_km_estimated"].to_numpy(), rel=0.03)


def test_unknown_order_that_matters_is_one_warning(tmp_path: Path) -> None:
    """It names the events, the worst welds and what to do; below 5 % of the damage nothing is said."""
    case = empty_and_laden()
    for event, stints in zip(case.events, (100.0, 1.5, 100.0, 1.5), strict=True):
        event["stints_per_1000_km"] = stints
    case.events[0]["share"], case.events[2]["share"] = 0.1, 0.9
    loud, _ = assessed(case, tmp_path / "loud")
    (warning,) = [problem for problem in loud.warnings if problem.code == "transitions_matter"]
    assert "the order of 4 events (sine, load, laden and 1 more) is not known" in warning.what
    assert warning.what.count("node") == 2
    for event in case.events:
        event["stints_per_1000_km"] = 1e-3
    quiet, _ = assessed(case, tmp_path / "quiet")
    assert "transitions_matter" not in {problem.code for problem in quiet.warnings}


def test_single_precision_and_long_records_join_alike(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same loop counted by every counter: transitions agree to what single precision leaves of a residue."""
    case = empty_and_laden()
    case.extra = LOOP
    nodes = assessed(case, tmp_path / "rows")[1]["nodes"]
    monkeypatch.setattr("fatigue.life.counting.count.LONGEST_ROW", 100)
    in_chunks = assessed(case, tmp_path / "chunks")[1]["nodes"]
    monkeypatch.setattr("fatigue.pipeline.mission.precision.SINGLE_FROM", 1.0)
    single = assessed(case, tmp_path / "single", share=0.0)[1]["nodes"]
    for other, tolerance in ((in_chunks, 1e-11), (single, 2e-6)):
        for name in ("damage_per_km_transitions", "damage_per_km", "max_range_MPa"):
            assert other[name].to_numpy() == pytest.approx(nodes[name].to_numpy(), rel=tolerance)


def test_workers_and_an_interrupted_run_give_the_same_bytes(tmp_path: Path) -> None:
    """Loops travel with the arrays of a group: through orders, and through what an interrupted run left."""
    case = small_case(pairs=8)
    case.counting = {"upsample": 1}
    case.extra = '[[mission.sequence]]\norder = ["sine", "noise"]\nper_1000_km = 3.0\n'
    path = case.write(tmp_path / "case")
    assess(path, tmp_path / "threads", threads=2, report=False)
    with ThreadPoolExecutor(2) as workers:
        assess(path, tmp_path / "orders", executor=workers, report=False)
    for name in ("nodes", "damage", "cycles", "welds"):
        files = [tmp_path / folder / f"{name}.parquet" for folder in ("threads", "orders")]
        assert files[0].read_bytes() == files[1].read_bytes()
