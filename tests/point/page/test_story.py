"""Any point on demand: what was counted again is what the result says, whatever the event, the face or the bound."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.diagnose import diagnose
from fatigue.errors import CaseError, DataError
from fatigue.point.page.story import point
from fatigue.report.wording import number
from fatigue.results import json_ready
from tests.point.cases import CASES, result_of
from tests.report.reading import Page, values
from tests.shear_at_toe import shear_at_toe
from tests.small_case import small_case

KEY = ["weld", "part", "order", "surface"]


def stored(folder: Path, table: str = "nodes") -> pd.DataFrame:
    """A table of a result."""
    return pd.read_parquet(folder / f"{table}.parquet")


def row_of(folder: Path, weld: str, order: int, surface: str, part: int = 1) -> pd.Series:
    """Row of a point in the table of nodes."""
    return stored(folder).set_index(KEY).loc[weld, part, order, surface]


@pytest.mark.parametrize("name", [name for name in CASES if name != "half"])
def test_the_result_is_met_again(results, name):
    """Every number of the row, every event, the cycles one by one and the shares: to rounding, on either face."""
    folder = results(name)
    nodes = stored(folder)
    for row in nodes.iloc[[5, len(nodes) - 2]].itertuples():
        found = point(folder, row.weld, order=row.order, part=row.part, surface=row.surface)
        assert max(check.difference for check in found.checks) < 1e-9, found.checks
        assert len(found.checks) == 6
        assert found.counted["damage_per_km"] == pytest.approx(row.damage_per_km, rel=1e-12)
        assert found.counted["max_range_MPa"] == pytest.approx(row.max_range_MPa, rel=1e-12)
        assert found.events["share"].sum() == pytest.approx(1.0)


def test_every_point_has_a_band(tmp_path):
    """Where the result has one the same; where it has none, as without histograms, counted now."""
    path = small_case(seconds=24.0).write(tmp_path / "case")
    for histogram in ("all", "none"):
        assess(path, tmp_path / histogram, threads=1, report=False, histogram=histogram)
    with_band, without = (point(tmp_path / name, "A", order=5, surface="bottom") for name in ("all", "none"))
    assert with_band.checks[-1].what == "band.parquet, both ends of the band of load"
    assert with_band.agrees
    row = stored(tmp_path / "all", "band").set_index(KEY).loc["A", 1, 5, "bottom"]
    for found in (with_band, without):
        assert found.band.low_km == pytest.approx(row["life_km_load_low"], rel=1e-9)
        assert found.band.lives_km["life_km_p90"] == pytest.approx(row["life_km_p90"], rel=1e-9)
        assert found.band.reason == ""
        assert pd.isna(row["band_reason"])
        assert any(name == "Life, 90 % band of load" for name, _ in found.facts)
    assert not (tmp_path / "none" / "band.parquet").exists()


def test_cycles_are_those_of_the_result(results):
    """At the worst point of a weld the most damaging cycles are rows of ``cycles.parquet``."""
    folder = results("plain")
    found = point(folder, "A")
    cycles = stored(folder, "cycles")
    own = cycles[(cycles[["weld", "order", "surface"]] == [found.weld, found.order, found.surface]).all(axis=1)]
    assert found.cycle_count == len(own)
    joined = found.cycles.merge(own, on=["event", "start_s", "end_s"], suffixes=("", "_stored"))
    assert len(joined) == len(found.cycles) > 5
    assert joined["range_MPa"].to_numpy() == pytest.approx(joined["range_MPa_stored"].to_numpy())
    assert found.cycles["share"].is_monotonic_decreasing


def test_a_difference_is_told(results):
    """A result that says something else than what is counted is not passed over."""
    found = point(results("plain"), "A")
    assert "agrees with the result" in found.as_text()
    off = replace(found, checks=(replace(found.checks[0], difference=0.25), *found.checks[1:]))
    assert not off.agrees
    assert "DIFFERS from the result" in off.as_text()
    assert "2.5e-01" in off.as_text()
    assert off.as_record()["checks"][0]["agrees"] is False


def test_the_record_of_any_event(results, tmp_path):
    """Shown instead of that of the governing event, and said so; numbers and shares stay."""
    folder = results("plain")
    usual = point(folder, "A", order=3)
    other = "noise" if usual.stored["governing_event"] == "sine" else "sine"
    found = point(folder, "A", order=3, event=other, output=tmp_path / "page.html")
    assert f"Shown is the record of {other}" in found.notes[0]
    assert f"{usual.stored['governing_event']} governs" in found.notes[0]
    assert f"Stress in event {other}, and close by" in (tmp_path / "page.html").read_text(encoding="utf-8")
    assert json_ready(found.counted) == json_ready(usual.counted)
    loop = point(results("loop"), "A", event="laden")
    assert any("cycles across events, which have no record" in note for note in loop.notes) == (
        loop.stored["governing_event"] == "(sequence 1)"
    )


def test_a_face_without_toe_is_said(results):
    """Weld B has its toe on the top face: its bottom face has numbers and no verdict."""
    folder = results("plain")
    found = point(folder, "B", order=3, surface="bottom")
    assert "carries no weld toe" in found.notes[0]
    assert "no verdict without a weld toe" in found.as_text()
    assert found.stored["damage_per_km"] == row_of(folder, "B", 3, "bottom")["damage_per_km"] > 0.0
    by_itself = point(folder, "B", order=3)
    assert by_itself.surface == "top"
    assert "toe" not in by_itself.notes[0]


def test_the_face_that_decides_is_the_default(results):
    """Of two faces with a toe the more utilised."""
    folder = results("plain")
    used = stored(folder).set_index(KEY)["utilisation"]
    worse = "top" if used["A", 1, 3, "top"] > used["A", 1, 3, "bottom"] else "bottom"
    assert point(folder, "A", order=3).surface == worse


def test_parts_that_share_an_order(results):
    """At a corner the part is asked for, and each part has its own numbers."""
    folder = results("corner")
    with pytest.raises(DataError, match="Give the part: 1, 2"):
        point(folder, "A", order=4)
    both = [point(folder, "A", order=4, part=part, surface="top") for part in (1, 2)]
    assert [found.stored["damage_per_km"] for found in both] == [
        row_of(folder, "A", 4, "top", part)["damage_per_km"] for part in (1, 2)
    ]
    assert any("corner" in note for note in both[0].notes)


@pytest.fixture(scope="module")
def screened(tmp_path_factory):
    """A result in which bounds settled points, and the same case with all points counted."""
    folder = tmp_path_factory.mktemp("screened")
    case = small_case(seconds=6.0, pairs=4)
    case.nodal_forces.loc[case.nodal_forces["weld"].isin(["A1", "B2"]), "fx_N":"mz_Nmm"] *= 0.3
    case.mission["target_km"] = 1e2
    path = case.write(folder / "case")
    assess(path, folder / "screened", share=0.3, proves_worst=False, threads=1, report=False)
    return folder / "screened", result_of(path, folder / "counted")


def test_a_screened_point_is_counted_now(screened, tmp_path):
    """Its numbers are those of a job without screening; the bound stands beside, and is above them."""
    folder, counted = screened
    bounded = stored(folder)
    bounded = bounded[bounded["screened"] != ""]
    assert len(bounded)
    row = bounded.iloc[len(bounded) // 2]
    found = point(folder, row["weld"], order=row["order"], surface=row["surface"], output=tmp_path / "page.html")
    truth = row_of(counted, row["weld"], row["order"], row["surface"])
    assert found.agrees
    assert found.checks[0].what == "damage counted now, above the bound of the result"
    for name in ("damage_per_km", "life_km", "load_factor", "max_range_MPa", "mean_stress_MPa", "dirlik_ratio"):
        assert found.counted[name] == pytest.approx(truth[name], rel=1e-9), name
    assert found.counted["governing_event"] == truth["governing_event"]
    assert found.stored["damage_per_km"] == row["damage_per_km"] >= truth["damage_per_km"]
    said = " ".join(found.notes)
    assert "did not count this point" in said
    assert row["screened"] in said
    assert f"the bound is {number(row['damage_per_km'] / truth['damage_per_km'])} times as much" in said
    page = Page((tmp_path / "page.html").read_text(encoding="utf-8"))
    mark = page.figures["along"]["data"][-1]
    assert mark["name"] == f"this point, {row['surface']} face"
    assert values(mark["y"])[0] == pytest.approx(min(truth["life_km"], 1e12))
    assert page.tables["numbers"][0][1:3] == ["bound in the result", "counted now"]
    numbers = {cells[0]: cells for cells in page.tables["numbers"]}
    assert numbers["damage_per_km"][1:3] == [number(row["damage_per_km"]), number(truth["damage_per_km"])]
    assert numbers["multiaxial_bound"][2] == "–"


def test_nothing_damages(tmp_path):
    """A body at rest: no finding, no cycle, and nothing of it fails."""
    case = small_case(seconds=6.0)
    for name in case.histories:
        case.histories[name] = case.histories[name].assign(q_1=3.0, q_2=0.0, q_7=0.0)
    folder = result_of(case.write(tmp_path / "case"), tmp_path / "result")
    found = point(folder, "A", order=2, output=tmp_path / "rest.html")
    assert found.finding is None
    assert found.agrees
    assert "Nothing damages this point" in found.as_text()
    assert json_ready(found.as_record())["counted"]["life_km"] is None
    page = Page((tmp_path / "rest.html").read_text(encoding="utf-8"))
    assert set(page.figures) == {"along", "history"}
    assert "Its stress does not vary" in page.words
    assert " nan" not in page.words.lower()


def test_an_undamaged_point_below_a_cut_off_has_its_figures(tmp_path):
    """Stress, ranges and spectrum are there, of the event with the largest range; shares are of the variance."""
    case = small_case(seconds=6.0)
    case.curve |= {"extension": "cutoff", "knee_cycles": 1e4}
    folder = result_of(case.write(tmp_path / "case"), tmp_path / "result")
    found = point(folder, "A", order=2, output=tmp_path / "quiet.html")
    assert found.stored["damage_per_km"] == 0.0
    assert "Nothing damages this point; shown is the record of noise" in found.notes[0]
    page = (tmp_path / "quiet.html").read_text(encoding="utf-8")
    for figure in ("along", "history", "matrix", "exceedance", "sn", "modes", "psd"):
        assert f'id="json-{figure}"' in page
    assert "Shares are those in the variance" in page
    assert "undefined" not in page.split("<main", 1)[1].split("</main>")[0]


def test_shear_that_decides_is_said(tmp_path):
    """The numbers of the result are the worse of both; what was counted is compared with the events."""
    folder = result_of(shear_at_toe('method = "range"\nalpha = 1.0').write(tmp_path / "case"), tmp_path / "result")
    found = point(folder, "T", order=1, surface="top")
    assert found.agrees
    assert "The case has shear decide (method range)" in " ".join(found.notes)
    assert found.stored["utilisation"] > found.counted["utilisation"]


def test_records_on_disk_give_the_same_point(results, monkeypatch):
    """Records that are too long to be held, and cycles that are too many to be listed."""
    folder = results("plain")
    held = point(folder, "A", order=3)
    monkeypatch.setattr("fatigue.pipeline.mission.events.HELD_BYTES", 0.0)
    monkeypatch.setattr("fatigue.pipeline.tables.cycles._SAMPLES_AT_ONCE", 1)
    monkeypatch.setattr("fatigue.report.inputs.is_long", lambda path: True)
    monkeypatch.setattr("fatigue.point.page.gathered.MOST_ROWS", 50)
    spooled = point(folder, "A", order=3)
    assert spooled.agrees
    assert spooled.cycle_count == held.cycle_count
    assert spooled.counted["damage_per_km"] == pytest.approx(held.counted["damage_per_km"], rel=1e-12)
    assert spooled.cycles["range_MPa"].iloc[0] == pytest.approx(held.cycles["range_MPa"].iloc[0])
    assert spooled.finding.modes[0].share == pytest.approx(held.finding.modes[0].share, rel=1e-9)


def test_the_result_stays_as_it_is(results):
    """Nothing is written into its folder, and nothing is left beside the page."""
    folder = results("plain")
    before = {path.name: path.stat().st_mtime_ns for path in [folder, *folder.iterdir()]}
    page = folder.parent / "out" / "page.html"
    point(folder, "A")
    point(folder, "A", output=page)
    assert {path.name: path.stat().st_mtime_ns for path in [folder, *folder.iterdir()]} == before
    assert [path.name for path in page.parent.iterdir()] == ["page.html"]


def test_the_same_page_every_time(results, tmp_path):
    """Byte by byte, whatever the number of threads."""
    for name, threads in (("one", 1), ("two", 2)):
        point(results("upsampled"), "B", output=tmp_path / f"{name}.html", threads=threads)
    assert (tmp_path / "one.html").read_bytes() == (tmp_path / "two.html").read_bytes()


def test_record_for_machines(results):
    """All of it is JSON, with the keys that the docs name."""
    record = json.loads(json.dumps(json_ready(point(results("loop"), "A").as_record()), allow_nan=False))
    assert record["agrees"] is True
    assert {"stored", "counted", "events", "worst_cycles", "finding", "frequency_domain", "checks"} <= set(record)
    assert "(sequence 1)" in [event["event"] for event in record["events"]]
    assert sum(event["share"] for event in record["events"]) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("asked", "error", "words"),
    [
        ({"weld": "a"}, DataError, "no weld 'a'. Name 'A'"),
        ({"order": 99}, DataError, "has no order 99. Take one of its orders: 1, 2"),
        ({"node": 1}, DataError, "has no node 1"),
        ({"surface": "left"}, DataError, "there is no face 'left'"),
        ({"event": "sine 2"}, DataError, "the mission has no event 'sine 2'. Name 'sine'"),
        ({"order": 2.5}, CaseError, "order: 2.5 is no order. Give a whole number"),
        ({"threads": 0}, CaseError, "threads: 0 is no number of threads"),
        ({"output": "page.pdf"}, CaseError, "Write .html, and print it from any browser"),
        ({"output": "page"}, CaseError, "has a name without ending. End it in .html for the page or in .png"),
        ({"output": 3}, CaseError, "int is no path"),
        ({"case_file": "nowhere.toml"}, DataError, "nowhere.toml"),
    ],
)
def test_mistakes(results, asked, error, words):
    """One line with place and remedy."""
    with pytest.raises(error) as told:
        point(results("plain"), **({"weld": "A"} | asked))
    assert words in str(told.value)


def test_files_in_the_way(results, tmp_path):
    """A file that is there, a folder, an input and the report of the result are not written over."""
    folder = results("plain")
    page = tmp_path / "page.html"
    page.write_text("mine")
    with pytest.raises(DataError, match="is there already"):
        point(folder, "A", output=page)
    assert page.read_text() == "mine"
    point(folder, "A", output=page, force=True)
    assert page.stat().st_size > 1e6
    (tmp_path / "folder.html").mkdir()
    with pytest.raises(DataError, match="is a folder, not a file"):
        point(folder, "A", output=tmp_path / "folder.html", force=True)
    with pytest.raises(DataError, match="is the place of a file of the result"):
        point(folder, "A", output=folder / "report.html", force=True)


def test_inputs_that_changed_are_refused(tmp_path):
    """A history that is another one now."""
    folder = result_of(small_case(seconds=6.0).write(tmp_path / "case"), tmp_path / "result")
    with (tmp_path / "case" / "noise.csv").open("a") as file:
        file.write("\n")
    with pytest.raises(DataError, match=r"noise\.csv.*changed since"):
        point(folder, "A")


def test_a_table_that_was_edited_is_refused(tmp_path):
    """The numbers of a point are not compared with those of somebody else."""
    folder = result_of(small_case(seconds=6.0).write(tmp_path / "case"), tmp_path / "result")
    for name in ("band", "nodes"):
        stored(folder, name).head(3).to_parquet(folder / f"{name}.parquet")
        with pytest.raises(DataError, match=rf"{name}\.parquet"):
            point(folder, "A")


def test_without_a_browser_a_picture_is_refused_before_the_work(results, tmp_path, monkeypatch):
    """One line that offers the page; nothing is counted and nothing written."""
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("FATIGUE_BROWSER", raising=False)
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setattr("fatigue.point.page.story.reopened", None)
    with pytest.raises(DataError, match=r"PNG: no Chromium.*or write the page as HTML: give -o a name that ends"):
        point(results("plain"), "A", output=tmp_path / "picture.png")
    assert not list(tmp_path.iterdir())


def test_shares_are_those_of_the_diagnosis(tmp_path):
    """With bands, bins and damping of the diagnosis in the folder, at a point that is not the worst of its weld."""
    folder = result_of(small_case(seconds=6.0).write(tmp_path / "case"), tmp_path / "result")
    diagnose(folder, edges_hz=[4.0, 9.0, 30.0], bin_km=0.07, damping=0.03)
    found = point(folder, "A", order=2, surface="bottom")
    assert found.checks[-1].what == "shares of the damage, in the diagnosis of the result"
    assert found.checks[-1].difference < 1e-12
    table = stored(folder, "attribution").set_index(KEY).loc["A", 1, 2, "bottom"]
    modes = table[table["kind"] == "mode"].groupby("mode")["share"].sum()
    assert {mode.mode: mode.share for mode in found.finding.modes} == pytest.approx(
        {mode.mode: modes[mode.mode] for mode in found.finding.modes}
    )
    assert {band.low_hz for band in found.finding.bands} <= {0.0, 4.0, 9.0, 30.0}
    reasons = stored(folder, "diagnosis").set_index(KEY).loc["A", 1, 2, "bottom"]
    assert [(event, verdict) for event, verdict, _ in found.verdicts] == list(
        zip(reasons["event"], reasons["verdict"], strict=True)
    )
    worst = point(folder, "A")
    levers = stored(folder, "levers").set_index("weld").loc["A"]
    assert [lever.life_km_counted for lever in worst.finding.levers] == pytest.approx(
        levers["life_km_counted"].tolist()
    )
    assert np.isfinite(levers["life_km_counted"]).all()
