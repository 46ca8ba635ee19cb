"""Constants beside the samples on the whole path: what the mean of q changes in the tables, and what keeps its bits."""

import json
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess as assess_and_report
from fatigue.case import load_case
from fatigue.check import check_case
from fatigue.diagnose import diagnose
from fatigue.errors import FatigueError, Problem
from tests.small_case import BENDING, MEMBRANE, SmallCase, sine_only, small_case

assess = partial(assess_and_report, report=False)
LEVELS = {
    "nodes": ["mean_stress_MPa", "R_largest_cycle", "damage_factor_if_mean_stress"],
    "damage": ["mean_stress_MPa"],
    "cycles": ["mean_MPa"],
    "structural_stress": [],
}


def run(case: SmallCase, folder: Path, **options: object) -> dict[str, pd.DataFrame]:
    """Write, load and assess a case; give the tables as data frames."""
    case.counting = {"upsample": 1} | case.counting
    assess(load_case(case.write(folder / "case")), folder / "result", **options)
    return {name: pd.read_parquet(folder / "result" / f"{name}.parquet") for name in LEVELS}


def in_tension(seconds: float = 12.0) -> SmallCase:
    """The small case in tension by the means of its coordinates, with a yield stress."""
    case = small_case(seconds)
    case.curve |= {"yield_MPa": 100.0}
    for name, level in (("sine", 60.0), ("noise", 35.0), ("load", 10.0)):
        case.histories[name]["q_1"] += level
    return case


def without_means(case: SmallCase, events: tuple[str, ...]) -> SmallCase:
    """The same with the means of the kept samples taken from some records, by hand."""
    first = {event["history"]: round(float(event.get("start_s", 0.0)) / 0.005) for event in case.events}
    for name in events:
        table = case.histories[name]
        for column in ("q_1", "q_2", "q_7"):
            table[column] -= table[column].iloc[first[name] :].mean()
    return case


@pytest.mark.parametrize("share", [0.0, 0.1])
def test_ranges_keep_their_bits(tmp_path: Path, share: float) -> None:
    """Whether means are kept or removed: every table is the same but for the columns of levels."""
    kept = run(in_tension(), tmp_path / "kept", share=share)
    case = in_tension()
    case.counting = {"mean_of_q": "remove"}
    removed = run(case, tmp_path / "removed", share=share)
    for name, levels in LEVELS.items():
        pd.testing.assert_frame_equal(removed[name].drop(columns=levels), kept[name].drop(columns=levels), rtol=0.0)
        for column in levels:
            assert not np.allclose(removed[name][column], kept[name][column], equal_nan=True), column


@pytest.mark.parametrize("mean_stress", ["none", "asme"])
@pytest.mark.parametrize("extension", ["none", "haibach"])
def test_removed_by_the_program_and_by_hand(tmp_path: Path, mean_stress: str, extension: str) -> None:
    """Tables of a case whose means are removed against those of records without means, f_M and load factor included."""

    def case() -> SmallCase:
        made = in_tension()
        made.curve |= {"mean_stress": mean_stress, "extension": extension}
        return made

    own = case()
    own.counting = {"mean_of_q": "remove"}
    found, expected = run(own, tmp_path / "a"), run(without_means(case(), ("sine", "noise", "load")), tmp_path / "b")
    for name in LEVELS:
        pd.testing.assert_frame_equal(found[name], expected[name], rtol=1e-9, atol=1e-8)


def test_an_event_has_its_own_rule(tmp_path: Path) -> None:
    """Removed in all events but the one that keeps it; the other way round likewise."""
    case = in_tension()
    case.counting = {"mean_of_q": "remove"}
    case.events[0]["mean_of_q"] = "keep"
    found = run(case, tmp_path / "a")["damage"]
    expected = run(without_means(in_tension(), ("noise", "load")), tmp_path / "b")["damage"]
    np.testing.assert_allclose(found.mean_stress_MPa, expected.mean_stress_MPa, rtol=1e-9, atol=1e-9)
    by_event = found.groupby("event")["mean_stress_MPa"].apply(lambda mean: np.abs(mean).max())
    assert by_event["sine"] == pytest.approx(60.0 * (MEMBRANE + BENDING))
    assert by_event["noise"] < 1e-9


def test_the_stress_factor_is_on_the_constant_too(tmp_path: Path) -> None:
    """Twice all stresses of an event: twice the mean, the same R; the load factor on all of them gives 1 again."""
    case = sine_only()
    case.curve |= {"yield_MPa": 100.0, "mean_stress": "asme"}
    case.histories["sine"]["q_1"] += 70.0
    once = run(case, tmp_path / "once")["nodes"]
    case.events[0]["stress_factor"] = 2.0
    twice = run(case, tmp_path / "twice")["nodes"]
    np.testing.assert_allclose(twice.mean_stress_MPa, 2.0 * once.mean_stress_MPa, rtol=1e-12)
    np.testing.assert_allclose(twice.R_largest_cycle, once.R_largest_cycle, rtol=1e-12)
    case.events[0]["stress_factor"] = float(once.load_factor.min())
    again = run(case, tmp_path / "again")["nodes"]
    assert again.utilisation.max() == pytest.approx(1.0, rel=1e-6)


def test_the_mean_is_that_of_the_kept_samples(tmp_path: Path) -> None:
    """Of a single pass that is upsampled the fine samples have another mean, which is not what is removed."""
    case = sine_only()
    case.events[0]["residue"] = "half"
    t = case.histories["sine"]["time_s"]
    case.histories["sine"]["q_1"] = 40.0 + 30.0 * np.sin(1.3 * t) + 5.0 * t
    case.counting = {"upsample": 4, "mean_of_q": "remove"}
    found = run(case, tmp_path)
    np.testing.assert_allclose(found["nodes"].mean_stress_MPa, 0.0, atol=1e-9)
    of_samples = case.histories["sine"]["q_1"].mean() * (MEMBRANE + BENDING)
    worst = found["cycles"].query("weld == 'A'")
    kept = run(case_keeping(case), tmp_path / "kept")["cycles"].query("weld == 'A'")
    np.testing.assert_allclose(kept.mean_MPa - worst.mean_MPa, of_samples, rtol=1e-9)


def case_keeping(case: SmallCase) -> SmallCase:
    """The same case with its means kept."""
    case.counting = {"upsample": 4}
    return case


def test_diagnosis_counts_with_the_constant(tmp_path: Path) -> None:
    """Damage shared out under f_M is that of the result, and slopes are those of samples without their means."""

    def case() -> SmallCase:
        made = in_tension()
        made.curve |= {"mean_stress": "asme", "yield_MPa": 40.0}
        return made

    own, events = case(), ("noise", "load")
    own.counting = {"mean_of_q": "remove"}
    own.events[0]["mean_of_q"] = "keep"
    run(own, tmp_path / "a")
    run(without_means(case(), events), tmp_path / "b")
    diagnose(tmp_path / "a" / "result")
    diagnose(tmp_path / "b" / "result")
    for name in ("attribution", "track", "levers"):
        path = tmp_path / "a" / "result" / f"{name}.parquet"
        found, expected = pd.read_parquet(path), pd.read_parquet(tmp_path / "b" / "result" / f"{name}.parquet")
        pd.testing.assert_frame_equal(found, expected, rtol=1e-8, atol=1e-12)


GRAVITY_MPA = 50.0  # at a unit of the gravity load, of the shape of mode 1


def with_gravity(case: SmallCase, folder: Path, given: str = "constant = 1.0", unit: str = "g") -> SmallCase:
    """The case with a gravity load in tension, its forces in a file of the folder; ``given`` in every event."""
    forces = case.nodal_forces[case.nodal_forces["mode"] == 1].drop(columns="mode")
    loads = ["fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"]
    folder.mkdir(parents=True, exist_ok=True)
    forces.assign(unit_load="gravity", **{name: GRAVITY_MPA * forces[name] for name in loads}).to_csv(
        folder / "gravity.csv", index=False
    )
    case.extra += f'[[body.unit_load]]\nname = "gravity"\nunit = "{unit}"\nrole = "gravity"\n'
    case.extra += 'when_missing = "zero"\nnodal_forces = "gravity.csv"\n'
    if given:
        case.extra += f'[[mission.unit_load]]\nname = "gravity"\nunit = "{unit}"\n{given}\n'
    return case


def holding_gravity(events: tuple[str, ...] = ("sine", "noise", "load"), times: float = 1.0) -> SmallCase:
    """The small case with the dead load in the mean of q of some events; that of the others has none."""
    case = without_means(small_case(), ("sine", "noise", "load"))
    for name in events:
        case.histories[name]["q_1"] += times * GRAVITY_MPA
    return case


def refused(case: SmallCase, folder: Path) -> list[Problem]:
    """Problems with which a case is refused: by check and by assess, which leaves no table, alike."""
    path = case.write(folder / "case")
    with pytest.raises(FatigueError) as checked:
        check_case(path)
    with pytest.raises(FatigueError) as assessed:
        assess(load_case(path), folder / "result")
    assert checked.value.problems == assessed.value.problems
    assert checked.value.exit_code == 3
    assert not list((folder / "result").glob("*.parquet"))
    return list(checked.value.problems)


def test_a_constant_is_a_column_of_constants(tmp_path: Path) -> None:
    """Given as a constant or as samples that never change: the same tables, and the same diagnosis, under f_M."""
    found = []
    for name in ("constant", "column"):
        case = with_gravity(without_means(in_tension(), ("sine", "noise", "load")), tmp_path / name / "case", "")
        case.curve |= {"mean_stress": "asme", "yield_MPa": 60.0}
        if name == "constant":
            case.extra += '[[mission.unit_load]]\nname = "gravity"\nunit = "g"\nconstant = 2.0\n'
        else:
            for table in case.histories.values():
                table["u_gravity"] = 2.0
        tables = run(case, tmp_path / name)
        diagnose(tmp_path / name / "result")
        tables |= {
            table: pd.read_parquet(tmp_path / name / "result" / f"{table}.parquet")
            for table in ("attribution", "track", "levers")
        }
        found.append(tables)
    constant, column = found
    assert (constant["nodes"].damage_factor_if_mean_stress == 1.0).any()
    for name in constant:
        pd.testing.assert_frame_equal(constant[name], column[name], rtol=1e-7, atol=1e-10)
    case = with_gravity(without_means(in_tension(), ("sine", "noise", "load")), tmp_path / "none" / "case", "")
    case.curve |= {"mean_stress": "asme", "yield_MPa": 60.0}
    without = run(case, tmp_path / "none")
    assert (constant["nodes"].damage_per_km > 1.2 * without["nodes"].damage_per_km).any()


def test_the_dead_load_is_there_twice(tmp_path: Path) -> None:
    """In the mean of q and as a constant: refused by check and assess; with the mean removed it is there once."""
    twice = refused(with_gravity(holding_gravity(), tmp_path / "a" / "case"), tmp_path / "a")
    assert [(problem.code, problem.count) for problem in twice] == [("gravity_twice", 3)]
    assert "gravity = 1" in twice[0].what
    case = with_gravity(holding_gravity(), tmp_path / "b" / "case")
    case.counting = {"mean_of_q": "remove"}
    found = run(case, tmp_path / "b")["damage"]
    once = run(with_gravity(holding_gravity(()), tmp_path / "c" / "case"), tmp_path / "c")["damage"]
    np.testing.assert_allclose(found.mean_stress_MPa, once.mean_stress_MPa, rtol=1e-9, atol=1e-9)
    top = found[(found.event == "sine") & (found.surface == "top")]
    np.testing.assert_allclose(top.mean_stress_MPa, GRAVITY_MPA * (MEMBRANE + BENDING), rtol=1e-9)


@pytest.mark.parametrize(
    ("times", "given", "unit", "codes"),
    [
        (0.0, "constant = 1.0", "g", []),
        (1.0, "", "g", []),
        (9.81, "", "g", ["gravity_units"]),
        (9.81, "constant = 9.81", "m/s2", ["gravity_twice"]),
        (-1.0, "constant = 1.0", "g", ["gravity_reversed"]),
        (1e-3, "constant = 1.0", "g", []),
    ],
)
def test_what_a_case_says_of_its_dead_load(
    tmp_path: Path, times: float, given: str, unit: str, codes: list[str]
) -> None:
    """Absent or contained with nothing on top is silent; another factor is a warning, twice an error."""
    case = with_gravity(holding_gravity(times=times), tmp_path / "case", given, unit)
    path = case.write(tmp_path / "case")
    try:
        warnings = check_case(path).warnings
    except FatigueError as error:
        warnings = error.problems
    assert [w.code for w in warnings if w.code.startswith("gravity")] == codes


def test_a_sequence_with_and_without_the_dead_load(tmp_path: Path) -> None:
    """In the q of one event and not in that of the other: a false cycle, refused; not where a constant evens it out."""
    sequence = '[[mission.sequence]]\norder = ["sine", "noise"]\nper_1000_km = 1.0\n'
    case = with_gravity(holding_gravity(("sine",)), tmp_path / "a" / "case", "")
    case.extra += sequence
    (problem,) = refused(case, tmp_path / "a")
    assert problem.code == "gravity_differs"
    assert problem.where == "case.toml: mission.sequence[1].order"
    even = with_gravity(holding_gravity(("sine",)), tmp_path / "b" / "case", "")
    even.extra += sequence
    path = even.write(tmp_path / "b" / "case")
    given = '[[mission.event.unit_load]]\nname = "gravity"\nunit = "g"\nconstant = 1.0\n'
    text = path.read_text(encoding="utf-8").replace(
        '[[mission.event]]\nname = "load', f'{given}[[mission.event]]\nname = "load'
    )
    path.write_text(text, encoding="utf-8")
    assert [one.verdict for one in check_case(path).gravity] == ["contained", "absent", "absent"]


def test_verdicts_are_recorded_and_shown(tmp_path: Path) -> None:
    """In the provenance, on the page, in check for people and for machines."""
    case = with_gravity(holding_gravity(("sine",)), tmp_path / "case")
    case.counting = {"mean_of_q": "remove", "upsample": 1}
    path = case.write(tmp_path / "case")
    assess_and_report(load_case(path), tmp_path / "result")
    recorded = json.loads((tmp_path / "result" / "provenance.json").read_text(encoding="utf-8"))["gravity"]
    assert [one["verdict"] for one in recorded] == ["contained", "absent", "absent"]
    assert recorded[0]["beta"] == pytest.approx(1.0, rel=1e-6)
    assert recorded[0]["cos"] == pytest.approx(1.0, rel=1e-6)
    checked = check_case(path)
    assert checked.as_record()["gravity"] == recorded
    assert (
        "dead load        in the mean of q, which is removed, 1 given (beta 1, cosine 1): 'sine'" in checked.as_text()
    )
    page = (tmp_path / "result" / "report.html").read_text(encoding="utf-8")
    assert "<h3>Dead load</h3>" in page
    assert "removed in all events" in page
    plain = check_case(small_case().write(tmp_path / "plain"))
    assert (plain.gravity, "dead load" in plain.as_text()) == ((), False)


@pytest.mark.parametrize("extension", ["none", "haibach"])
def test_bounds_and_load_factors_know_the_constant(tmp_path: Path, extension: str) -> None:
    """In tension by gravity alone: no bound is below the count, and load factors put back give utilisation 1."""

    def case(folder: str) -> SmallCase:
        made = with_gravity(in_tension(), tmp_path / folder / "case", "constant = 1.1")
        made.counting = {"mean_of_q": "remove"}
        made.curve |= {"mean_stress": "asme", "yield_MPa": 140.0, "extension": extension}
        made.mission["damage_limit"] = 5e3
        return made

    counted = run(case("counted"), tmp_path / "counted", share=0.0)["nodes"]
    without = case("plain")
    without.curve |= {"mean_stress": "none"}
    assert (counted.utilisation > 1.1 * run(without, tmp_path / "plain", share=0.0)["nodes"].utilisation).any()
    screened = run(case("screened"), tmp_path / "screened", share=1.0, proves_worst=False)["nodes"]
    bounded = screened.screened != ""
    assert bounded.any()
    assert (screened.utilisation >= counted.utilisation * (1.0 - 1e-9)).all()
    assert (screened.load_factor[bounded] <= counted.load_factor[bounded] * (1.0 + 1e-9)).all()
    at = counted.utilisation.idxmax()
    again = case("again")
    for event in again.events:
        event["stress_factor"] = float(counted.load_factor[at])
    found = run(again, tmp_path / "again", share=0.0)["nodes"].utilisation[at]
    assert found <= 1.0 + 1e-6
    for event in again.events:
        event["stress_factor"] = float(counted.load_factor[at]) * (1.0 + 2e-4)
    (tmp_path / "again" / "result").rename(tmp_path / "at the factor")
    assert run(again, tmp_path / "again", share=0.0)["nodes"].utilisation[at] > 1.0
