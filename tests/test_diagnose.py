"""The diagnosis of a result: what adds up, what a second assessment confirms, what it says, and what it refuses."""

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import fatigue.why.points
from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.diagnose import diagnose
from fatigue.errors import CaseError, DataError
from fatigue.pipeline.mission.events import event_load
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.solve.model import read_model
from fatigue.results import json_ready, read_provenance
from fatigue.spectrum.bands import third_octaves
from fatigue.why.attribute import Attribution, Bins, attribute_event
from fatigue.why.findings import Diagnosis
from fatigue.why.points import points_of
from tests.conftest import EXAMPLE
from tests.older_result import without_hashes
from tests.small_case import SmallCase, sine_only, small_case

POINT = ["weld", "part", "order", "surface"]
TABLES = ("attribution", "track", "diagnosis", "levers")


@dataclass
class Diagnosed:
    """A result folder after its diagnosis, with its tables."""

    folder: Path
    summary: Diagnosis
    tables: dict[str, pd.DataFrame]

    def __getattr__(self, name: str) -> pd.DataFrame:
        """Give a table by its name."""
        return self.tables[name]


def run(case: SmallCase, folder: Path, **options: object) -> Diagnosed:
    """Assess and diagnose a case; read all tables."""
    assess(load_case(case.write(folder / "case")), folder / "result", threads=1, report=False)
    summary = diagnose(folder / "result", **options)
    names = (*TABLES, "nodes", "damage")
    return Diagnosed(
        folder / "result", summary, {name: pd.read_parquet(folder / "result" / f"{name}.parquet") for name in names}
    )


def lives(case: SmallCase, folder: Path) -> pd.Series:
    """Assess a case; life of every point by its key."""
    assess(load_case(case.write(folder / "case")), folder / "result", threads=1, report=False)
    return pd.read_parquet(folder / "result" / "nodes.parquet").set_index(POINT)["life_km"]


def scaled(factor: float, *modes: int) -> SmallCase:
    """Scale some modes of all events of the small case."""
    case = small_case()
    for history in case.histories.values():
        for mode in modes:
            history[f"q_{mode}"] *= factor
    return case


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Diagnosed:
    """Diagnosis of the small case: a sine, noise, and an event of two samples counted by number."""
    return run(small_case(), tmp_path_factory.mktemp("diagnosed"))


def case_with(name: str) -> SmallCase:
    """Vary the rules of the small case."""
    case = small_case(seconds=6.0)
    if name == "knee":
        case.curve |= {"extension": "haibach", "knee_cycles": 1e6}
    if name == "mean stress":
        case.curve |= {"mean_stress": "asme", "yield_MPa": 80.0}
        for history in case.histories.values():
            history["q_1"] += 40.0
    if name == "upsampled, factored, single pass":
        case.counting |= {"upsample": 2, "residue": "half"}
        case.events[1] |= {"stress_factor": 1.3}
    if name == "structural stress curve":
        case.curve |= {"name": "mine"}
        case.extra = (
            "[curves.mine]\nslopes = [3.0, 5.0]\nknees_cycles = [1e7]\nrange_at_2e6_MPa = 40.0\n"
            'applies = "structural"\nsource = "a test"\nthickness_reference_mm = 5.0\nthickness_exponent = 0.2'
        )
    return case


RULES = ("knee", "mean stress", "upsampled, factored, single pass", "structural stress curve")


@pytest.mark.parametrize("name", RULES)
def test_every_table_adds_up_to_the_damage_of_the_result(name, tmp_path):
    """Events, modes, bands and places each sum to damage_per_km of every point, whatever the rules."""
    found = run(case_with(name), tmp_path)
    expected = found.nodes.set_index(POINT)["damage_per_km"].sort_index()
    for kind in ("event", "mode", "band"):
        rows = found.attribution[found.attribution.kind == kind]
        assert rows.groupby(POINT)["damage_per_km"].sum().to_numpy() == pytest.approx(expected.to_numpy(), rel=1e-9)
        assert rows.groupby(POINT)["share"].sum().to_numpy() == pytest.approx(1.0, rel=1e-9)
    assert found.track.groupby(POINT)["damage_per_km"].sum().to_numpy() == pytest.approx(expected.to_numpy(), rel=1e-9)


def test_events_match_the_damage_table(small):
    """Damage of one event per km of the mission = passes per km x damage per pass of the result."""
    record = json.loads((small.folder / "provenance.json").read_text())
    passes = {event["event"]: event["passes_per_km"] for event in record["mission"]["events"]}
    rows = small.attribution[small.attribution.kind == "event"].set_index([*POINT, "event"])["damage_per_km"]
    assessed = small.damage.set_index([*POINT, "event"])["damage_per_pass"]
    expected = assessed * assessed.index.get_level_values("event").map(passes)
    assert rows.sort_index().to_numpy() == pytest.approx(expected.sort_index().to_numpy(), rel=1e-9)


def test_sine_of_one_mode_belongs_to_its_mode_band_and_every_metre(tmp_path):
    """5 Hz in mode 1: all damage in mode 1 and in the band around 5 Hz, spread evenly over the track."""
    case = sine_only()
    case.modes["damping_ratio"] = 0.02
    found = run(case, tmp_path)
    rows = found.attribution[(found.attribution.share - 1.0).abs() < 1e-6]
    assert set(rows["kind"]) == {"event", "mode", "band"}
    assert set(rows["mode"].dropna()) == {1}
    assert rows["low_hz"].dropna().to_numpy() == pytest.approx(4.4668, rel=1e-4)
    of_mode = found.attribution[found.attribution["mode"] == 1]
    assert of_mode["resonant_share"].to_numpy() == pytest.approx(1.0, abs=1e-6)
    slope = 1.0 / 0.27712
    assert of_mode["life_exponent"].to_numpy() == pytest.approx(-slope, rel=1e-9)
    assert found.track["intensity"].to_numpy() == pytest.approx(1.0, abs=0.05)
    assert (found.levers[found.levers["rank"] == 1]["mode"] == 1).all()
    assert found.levers["gain_km"].max() == pytest.approx(
        found.levers["life_km"].iloc[0] * (0.9**-slope - 1.0), rel=1e-6
    )
    assert "damping" not in found.summary.as_text()


@pytest.mark.parametrize("mode", [1, 7])
def test_life_exponents_against_a_second_assessment(small, mode, tmp_path):
    """Life with one mode a little larger and smaller, by the whole pipeline, against the exponent of that mode.

    The step is small because damage is not continuous: where two peaks tie, the instants of a cycle change, and with
    them its bending ratio.
    """
    step = 1e-6
    above, below = (lives(scaled(1.0 + sign * step, mode), tmp_path / f"{sign}").sort_index() for sign in (1, -1))
    rows = small.attribution[small.attribution["mode"] == mode]
    exponent = rows.groupby(POINT)["life_exponent"].sum()
    expected = (np.log(above) - np.log(below)) / (np.log(1.0 + step) - np.log(1.0 - step))
    assert exponent.to_numpy() == pytest.approx(expected.to_numpy(), abs=1e-6)


def test_load_and_event_exponents_against_a_second_assessment(small, tmp_path):
    """All stresses 1 % larger by a stress factor; one event 1 % more often."""
    before = small.nodes.set_index(POINT)["life_km"].sort_index()
    heavier, oftener = small_case(), small_case()
    for event in heavier.events:
        event["stress_factor"] = 1.01
    oftener.events[2]["per_1000_km"] = 2.02
    kinds = small.attribution.groupby(["kind", *POINT])["life_exponent"].sum()
    after = lives(heavier, tmp_path / "heavier").sort_index()
    assert np.log(after / before).to_numpy() / np.log(1.01) == pytest.approx(kinds["load"].to_numpy(), rel=1e-9)
    after = lives(oftener, tmp_path / "oftener").sort_index()
    rows = small.attribution.query("kind == 'event' and event == 'load and unload'").set_index(POINT).sort_index()
    assert np.log(after / before).to_numpy() / np.log(1.01) == pytest.approx(rows["life_exponent"].to_numpy(), abs=1e-4)


def test_thickness_exponents_against_a_second_assessment(small, tmp_path):
    """Slightly thicker plates under the same line loads: stress and thickness rule together."""
    thicker, step = small_case(), 1e-6
    thicker.weld_nodes["thickness_mm"] *= 1.0 + step
    after = lives(thicker, tmp_path).sort_index()
    before = small.nodes.set_index(POINT)["life_km"].sort_index()
    kinds = small.attribution.groupby(["kind", *POINT])["life_exponent"].sum()
    expected = kinds["thickness"].to_numpy() + kinds["thickness_rule"].to_numpy()
    assert np.log(after / before).to_numpy() / np.log1p(step) == pytest.approx(expected, abs=1e-4)


def test_levers_are_counted_again_exactly(small, tmp_path):
    """The life counted with the best mode 10 % smaller is that of an assessment of such records."""
    best = small.levers[(small.levers["rank"] == 1) & (small.levers.weld == "A")].iloc[0]
    after = lives(scaled(0.9, int(best["mode"])), tmp_path)
    assert best["life_km_counted"] == pytest.approx(after[tuple(best[POINT])], rel=1e-9)
    assert best["life_km_estimated"] == pytest.approx(best["life_km_counted"], rel=0.05)
    assert best["gain_km"] == pytest.approx(best["life_km_counted"] - best["life_km"])
    ranked = small.levers[small.levers.weld == "A"].sort_values("rank")["life_km_counted"]
    assert ranked.is_monotonic_decreasing


def test_places_have_kilometres_or_at_least_instants(small):
    """Bins of 100 m by default, in km of the kept record; an event counted by number has file time only."""
    noise = small.track[(small.track.event == "noise") & (small.track.order == 1) & (small.track.weld == "A")]
    noise = noise[noise.surface == "top"]
    assert noise["start_km"].to_numpy() == pytest.approx(0.1 * np.arange(11))
    assert noise["end_km"].iloc[-1] == pytest.approx(1.1)  # 11 s kept at 360 km/h
    assert noise["start_s"].iloc[0] == pytest.approx(1.0)
    assert noise["share"].sum() == pytest.approx(1.0)
    assert (noise["share"] / noise["intensity"]).to_numpy() == pytest.approx(1.0 / 11.0)
    number = small.track[small.track.event == "load and unload"]
    assert number["start_km"].isna().all()
    assert set(number["start_s"]) == {0.0, 1.0}


def test_what_cannot_be_had_is_said(small):
    """No damping, no spectrum, no distance: each is a sentence, and the short event is one band from 0 Hz up."""
    notes = " ".join(small.summary.notes)
    assert "no mode has a damping ratio" in notes
    assert "'load and unload': the record is shorter than one spectral segment" in notes
    assert "'load and unload' is counted by number" in notes
    assert small.attribution["resonant_share"].isna().all()
    bands = small.attribution[(small.attribution.kind == "band") & (small.attribution.event == "load and unload")]
    assert (bands["low_hz"] == 0.0).all()
    assert bands["high_hz"].isna().all()
    verdicts = small.diagnosis[small.diagnosis.event == "load and unload"]
    assert set(verdicts["verdict"]) == {"not_assessed"}
    assert verdicts["reason"].str.contains("shorter than one spectral segment").all()


def test_verdicts_of_sine_and_noise(small):
    """The sine is harmonic, as every number says; ratios are those of the result."""
    sine = small.diagnosis[small.diagnosis.event == "sine"]
    assert set(sine["verdict"]) == {"harmonic"}
    assert sine["line_share"].to_numpy() == pytest.approx(1.0, abs=0.01)
    merged = small.diagnosis.merge(small.damage, on=[*POINT, "event"], suffixes=("", "_assessed"))
    ratio = merged["damage_dirlik_per_pass"] / merged["damage_same_ratio_per_pass"]
    assert merged["dirlik_ratio"].to_numpy() == pytest.approx(ratio.to_numpy(), nan_ok=True)
    split = small.diagnosis.dropna(subset="formula_error")
    assert len(split) == 2  # the worst point of each weld, in its governing event
    assert (split["formula_error"] * split["process_error"]).to_numpy() == pytest.approx(split["dirlik_ratio"])


def test_summary_names_event_modes_bands_lever_and_verdict(small):
    """Text and record tell the same for the worst point of every weld, worst first."""
    record = json_ready(small.summary.as_record())
    text = small.summary.as_text()
    assert json.dumps(record)
    shortest = small.nodes[small.nodes.toe].groupby("weld")["life_km"].min().sort_values()
    assert [finding["weld"] for finding in record["findings"]] == list(shortest.index)
    assert [finding["life_km"] for finding in record["findings"]] == pytest.approx(list(shortest))
    for finding in record["findings"]:
        best = small.levers[(small.levers.weld == finding["weld"]) & (small.levers["rank"] == 1)].iloc[0]
        assert finding["levers"][0]["mode"] == best["mode"]
        assert finding["modes"][0]["share"] >= best["share"]
    for word in ("event ", "bands ", "modes ", "place ", "lever ", "Dirlik ", "all 28 points", "Not available"):
        assert word in text


def test_too_many_points_leave_the_worst_and_those_above_a_share(tmp_path, monkeypatch):
    """Where all points would take long the table says of every point why it is there."""
    monkeypatch.setattr(fatigue.why.points, "MOST_SAMPLES", 0)
    monkeypatch.setattr("fatigue.pipeline.solve.weld_groups.SMALLEST_GROUP", 7)  # one weld at a time
    found = run(small_case(seconds=6.0), tmp_path, share_of_limit=0.5)
    toe = found.nodes[found.nodes.toe].set_index(POINT)
    chosen = found.attribution.drop_duplicates(POINT).set_index(POINT)["chosen"]
    worst = toe.groupby("weld")["utilisation"].idxmax()
    assert (chosen[list(worst)] == "worst of its weld").all()
    others = chosen.drop(list(worst))
    assert set(others) <= {"above 0.5 of the limit"}
    assert set(others.index) == set(toe.index[toe["utilisation"] >= 0.5]) - set(worst)
    assert f"{len(chosen)} of 28" in found.summary.points


def test_too_many_worst_points_leave_those_with_the_shortest_lives(tmp_path, monkeypatch):
    """Of welds, then of the others above the share, as many as samples or memory allow."""
    case = small_case(seconds=6.0)
    found = run(case, tmp_path / "all")
    samples = sum(len(history) for history in case.histories.values()) - 200  # the start of one is cut
    monkeypatch.setattr(fatigue.why.points, "MOST_SAMPLES", 0)
    toe = found.nodes[found.nodes.toe].set_index(POINT)["utilisation"]
    worst = toe[toe.groupby("weld").idxmax()].sort_values(ascending=False)
    others = toe.drop(worst.index).sort_values(ascending=False, kind="stable")
    for most, expected in ((1, [worst.index[0]]), (5, [*worst.index, *others.index[:3]])):
        monkeypatch.setattr(fatigue.why.points, "MOST_SAMPLES_OF_WORST", most * samples)
        summary = diagnose(found.folder, share_of_limit=0.0)
        rows = pd.read_parquet(found.folder / "attribution.parquet").drop_duplicates(POINT).set_index(POINT)
        assert set(rows.index) == set(expected)
        assert summary.points.endswith("more would take long")
        assert len(summary.findings) == min(most, 2)
        assert summary.findings[0].weld == worst.index[0][0]
    monkeypatch.setattr(fatigue.why.points, "MOST_NUMBERS", 1)
    assert "the worst points of the 1 of 2 welds" in diagnose(found.folder).points


def test_pieces_of_points_write_the_same_tables(tmp_path, monkeypatch):
    """Some points at a time: the same rows in the same order."""
    found = run(small_case(seconds=6.0), tmp_path)
    monkeypatch.setattr("fatigue.why.rows.POINTS_AT_ONCE", 5)
    diagnose(found.folder)
    for name in TABLES:
        pd.testing.assert_frame_equal(pd.read_parquet(found.folder / f"{name}.parquet"), found.tables[name])


def test_records_on_disk_give_the_same_diagnosis(tmp_path, monkeypatch):
    """Records that are too long to be held together are read again and again."""
    found = run(small_case(seconds=6.0), tmp_path)
    monkeypatch.setattr("fatigue.pipeline.mission.events.HELD_BYTES", 0.0)
    diagnose(found.folder)
    for name in TABLES:
        pd.testing.assert_frame_equal(
            pd.read_parquet(found.folder / f"{name}.parquet"), found.tables[name], rtol=1e-9, atol=1e-12
        )
    assert not [path.name for path in found.folder.iterdir() if path.name.startswith(".")]


def test_nothing_damages(tmp_path):
    """A body at rest has no finding and no lever, and every share is 0."""
    case = sine_only()
    case.histories["sine"]["q_1"] = 3.0
    found = run(case, tmp_path)
    assert found.summary.findings == ()
    assert len(found.levers) == 0
    assert (found.attribution["share"].dropna() == 0.0).all()
    assert (found.track["share"] == 0.0).all()
    assert set(found.diagnosis["verdict"]) == {"not_assessed"}


def test_one_event_too_short_for_bands(tmp_path):
    """Nothing but a manoeuvre of two samples: no bands in the summary, an instant for a place."""
    case = small_case()
    case.histories = {"load": case.histories["load"]}
    case.events = case.events[2:]
    case.curve |= {"extension": "cutoff"}
    text = run(case, tmp_path).summary.as_text()
    assert "not available: no record is long enough" in text
    assert "most at 0.0 s" in text
    assert "cut-off" in text


def test_progress_and_second_run_gives_the_same_bytes(tmp_path):
    """A diagnosis can be repeated; it reports every event, leaves no scratch, and gives the same bytes."""
    found = run(sine_only(), tmp_path)
    before = {name: (found.folder / f"{name}.parquet").read_bytes() for name in TABLES}
    seen = []
    diagnose(found.folder, bin_km=0.1, progress=lambda label, done, total: seen.append((label, done, total)))
    assert seen == [("diagnosis", 0, 1), ("diagnosis", 1, 1)]
    assert before == {name: (found.folder / f"{name}.parquet").read_bytes() for name in TABLES}
    assert not [path.name for path in found.folder.iterdir() if path.name.startswith(".")]


def test_own_bands_and_bins(tmp_path):
    """Edges and bins as asked."""
    found = run(sine_only(), tmp_path, edges_hz=[4.0, 6.0], bin_km=0.25)
    bands = found.attribution[found.attribution.kind == "band"].drop_duplicates(["low_hz"])
    assert bands["low_hz"].tolist() == [0.0, 4.0, 6.0]
    assert found.track["end_km"].unique() == pytest.approx([0.25, 0.5, 0.6])


def test_refuses_a_folder_without_result(tmp_path):
    """Nothing to diagnose."""
    with pytest.raises(DataError, match="no finished result"):
        diagnose(tmp_path)


def test_refuses_bands_and_bins_that_make_no_sense(tmp_path):
    """Edges that do not ascend would lose damage; a bin needs a length. Both are said at once."""
    with pytest.raises(CaseError, match=r"does not ascend(.|\n)*-1 km is not a length"):
        diagnose(tmp_path, edges_hz=[5.0, 5.0], bin_km=-1.0)


def test_refuses_changed_and_missing_inputs(tmp_path):
    """Records that changed or went since the assessment would explain another result."""
    assess(load_case(sine_only().write(tmp_path / "case")), tmp_path / "result", report=False)
    with (tmp_path / "case" / "sine.csv").open("a") as file:
        file.write("\n")
    (tmp_path / "case" / "modes.csv").unlink()
    with pytest.raises(DataError, match=r"modes\.csv: is not there any more(.|\n)*sine\.csv: has changed since"):
        diagnose(tmp_path / "result")


def test_finds_the_case_elsewhere_or_says_so(tmp_path):
    """The case is where the result says, or where the caller says."""
    path = sine_only().write(tmp_path / "case")
    assess(load_case(path), tmp_path / "result", report=False)
    (tmp_path / "case").rename(tmp_path / "moved")
    with pytest.raises(DataError, match="not there any more"):
        diagnose(tmp_path / "result")
    assert diagnose(tmp_path / "result", case_file=tmp_path / "moved" / "case.toml").findings


def test_refuses_other_points(tmp_path):
    """A table of nodes that does not belong to the case."""
    assess(load_case(sine_only().write(tmp_path / "case")), tmp_path / "result", report=False)
    path = tmp_path / "result" / "nodes.parquet"
    pd.read_parquet(path).iloc[2:].to_parquet(path)
    without_hashes(tmp_path / "result")
    with pytest.raises(DataError, match="has other points than the case from row 1 on"):
        diagnose(tmp_path / "result")


@pytest.mark.parametrize("table", ["nodes", "damage"])
def test_refuses_rows_too_many(tmp_path, table):
    """A table that goes on behind the last point."""
    assess(load_case(sine_only().write(tmp_path / "case")), tmp_path / "result", report=False)
    path = tmp_path / "result" / f"{table}.parquet"
    frame = pd.read_parquet(path)
    pd.concat([frame, frame[:1]]).to_parquet(path)
    without_hashes(tmp_path / "result")
    with pytest.raises(DataError, match=rf"{table}\.parquet: has {len(frame) + 1} .* Run the assessment again"):
        diagnose(tmp_path / "result")


@pytest.mark.slow
def test_what_the_example_says_at_a_hanger_and_at_the_roof_bracket(example_result):
    """Worn wheels at 9.2 Hz on a seventh of the track break the hangers, broad-band running the roof bracket."""
    model = read_model(load_case(EXAMPLE / "case.toml"), strict=False)
    nodes = pd.read_parquet(example_result / "nodes.parquet")
    worst = nodes[nodes.toe].groupby("weld")["utilisation"].idxmax()
    rows = worst[["W2_hanger3_att", "W1_roof_bracket_att"]].to_numpy()
    points = points_of(model, rows // 2, rows % 2, np.array(["worst", "worst"], dtype=object))
    plan, _ = mission_plan(model.body)
    factors = read_provenance(example_result)["rules"]["upsampled"]
    loads = [event_load(model.body, event, factors[event.name]) for event in model.case.mission.event]
    found = Attribution(
        points,
        tuple(
            attribute_event(points, load, one, model.modes, Bins(third_octaves(), 0.1))
            for load, one in zip(loads, plan.passes, strict=True)
        ),
    )
    assert found.damage == pytest.approx(nodes["damage_per_km"].to_numpy()[rows], rel=1e-12)
    hanger, bracket = found.event_share
    assert hanger[1] > 0.9  # worn 350, a tenth of the mileage
    assert bracket[0] > 0.6  # sound 350, seven tenths of it
    edges, band = found.events[0].edges_hz, found.band_share
    hunting = int(np.searchsorted(edges, 9.2)) - 1
    assert band[0, hunting] > 0.9
    assert band[1].max() < 0.25
    assert model.modes.kind[int(found.mode_share[0].argmax())] == "interface"
    assert found.mode_share.sum(axis=1) == pytest.approx(1.0, rel=1e-11)
