"""Constants beside the samples on the whole path: what the mean of q changes in the tables, and what keeps its bits."""

from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess as assess_and_report
from fatigue.case import load_case
from fatigue.diagnose import diagnose
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
