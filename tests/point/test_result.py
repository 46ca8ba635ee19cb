"""A result in a notebook: what is there at first sight, tables read when asked for, inputs read once and watched."""

import gc
import os
import shutil

import numpy as np
import pandas as pd
import plotly.graph_objects as go
import pytest
from scipy.signal import welch

import fatigue
from fatigue.errors import CaseError, DataError
from fatigue.point import result as module
from fatigue.point.drawn import FIGURES
from fatigue.report.wording import life, number
from tests.older_result import without_hashes
from tests.point.cases import plain, result_of
from tests.small_case import STEP


@pytest.fixture(scope="module")
def opened(small_result):
    """The small result."""
    return fatigue.open_result(str(small_result))


def test_what_is_seen_first(opened, small_result):
    """Title, target, verdict, welds worst first, events, warnings, tables."""
    assert (opened.title, opened.target_km, opened.folder) == ("small case", 1e6, small_result)
    assert opened.record["title"] == "small case"
    welds = opened.welds
    assert welds["utilisation"].is_monotonic_decreasing
    assert opened.fulfilled == bool(welds["fulfilled"].all())
    assert opened.events["event"].tolist() == ["sine", "noise", "load and unload"]
    assert list(opened.warnings.columns) == ["code", "where", "what", "remedy", "count"]
    assert opened.tables[:5] == ["nodes", "damage", "cycles", "structural_stress", "welds"]
    assert repr(opened) == f"Result({str(small_result)!r}): small case"


def test_a_notebook_shows_verdict_and_worst_welds(opened):
    """As a table of HTML in which names are no markup."""
    html = opened._repr_html_()
    assert html.startswith("<h4>small case</h4><p>")
    assert html.count("<tr>") == 1 + len(opened.welds)
    assert ("miss the target of" in html) == (not opened.fulfilled)
    first, second = opened.welds["weld"]
    assert 0 < html.index(f">{first}<") < html.index(f">{second}<")
    assert f">{number(opened.welds['utilisation'].iloc[0])}<" in html
    assert f">{life(opened.welds['life_km'].iloc[0])}<" in html


def test_names_are_no_markup_in_a_notebook(tmp_path):
    """Neither titles nor welds."""
    case = plain(2.0)
    for table in ("welds", "weld_nodes", "nodal_forces"):
        setattr(case, table, getattr(case, table).replace({"weld": {"A": "<b>A&B</b>"}}))
    path = case.write(tmp_path / "case")
    path.write_text(path.read_text().replace("small case", "<script>x</script>"))
    html = fatigue.open_result(result_of(path, tmp_path / "result"))._repr_html_()
    assert "<script>" not in html
    assert "&lt;b&gt;A&amp;B&lt;/b&gt;" in html


def test_tables_are_those_of_the_folder(opened, small_result):
    """Whole, some columns, one weld, the worst points."""
    nodes = pd.read_parquet(small_result / "nodes.parquet")
    pd.testing.assert_frame_equal(opened.nodes, nodes)
    pd.testing.assert_frame_equal(opened.table("damage"), pd.read_parquet(small_result / "damage.parquet"))
    pd.testing.assert_frame_equal(opened.table("nodes", ["life_km", "weld"]), nodes[["life_km", "weld"]])
    of_b = nodes[nodes["weld"] == "B"].reset_index(drop=True)
    pd.testing.assert_frame_equal(opened.table("nodes", weld="B"), of_b)
    pd.testing.assert_frame_equal(opened.table("nodes", "life_km", weld="B"), of_b[["life_km"]])
    toes = nodes[nodes["toe"]].sort_values("utilisation", ascending=False, kind="stable")
    pd.testing.assert_frame_equal(opened.worst(4), toes.head(4).reset_index(drop=True), check_dtype=False)
    assert set(opened.worst(3, weld="B")["weld"]) == {"B"}


def test_what_a_column_means(opened):
    """Of every table that a result may have, and of a history."""
    nodes = opened.columns("nodes").set_index("column")
    assert list(nodes.index) == list(opened.nodes.columns)
    assert tuple(nodes.loc["life_km"]) == ("km", nodes.loc["life_km", "meaning"])
    history = opened.columns("history")["column"].tolist()
    assert history[: len(opened.history("A", 3).columns)] == list(opened.history("A", 3).columns)
    with pytest.raises(DataError, match=r"there is no table 'node' of a result\. Name 'nodes'"):
        opened.columns("node")


def test_one_point(opened, small_result):
    """By order, by node, at a face; by default the worst of the weld."""
    nodes = pd.read_parquet(small_result / "nodes.parquet")
    row = opened.point("A", 3, surface="bottom")
    expected = nodes.query("weld == 'A' and order == 3 and surface == 'bottom'").iloc[0]
    assert row["life_km"] == expected["life_km"]
    assert opened.point("A", node=102, surface="bottom")["life_km"] == row["life_km"]
    worst = opened.welds.set_index("weld").loc["A"]
    assert opened.point("A")["life_km"] == worst["life_km"]


def test_histories_and_cycles(opened, small_result):
    """Of any point, with the columns of the command and of the table; one event or all."""
    history = opened.history("A", 3)
    assert history["event"].unique().tolist() == ["sine", "noise", "load and unload"]
    damage = pd.read_parquet(small_result / "damage.parquet").query("weld == 'A' and order == 3 and surface == 'top'")
    ranges = history.groupby("event", sort=False)["structural_top_MPa"].agg(lambda s: s.max() - s.min())
    assert ranges.to_numpy() == pytest.approx(damage["max_range_MPa"].to_numpy(), rel=1e-12)
    assert len(opened.history("A", 3, event="sine")) == (history["event"] == "sine").sum()
    cycles = opened.cycles("A", 3, surface="top")
    summed = cycles.groupby("event", sort=False)["damage"].sum()
    assert summed.to_numpy() == pytest.approx(damage["damage_per_pass"].to_numpy(), rel=1e-10)
    assert set(opened.cycles("A", 3, event="noise")["event"]) == {"noise"}
    assert list(cycles.columns) == list(pd.read_parquet(small_result / "cycles.parquet").columns)


@pytest.mark.parametrize("name", FIGURES)
def test_every_figure(opened, name):
    """Of the worst weld and its worst point by default, of others where they are named."""
    assert isinstance(opened.figure(name), go.Figure)
    assert len(opened.figure(name, "B", order=2, surface="top").data) > 0


def test_figures_of_one_event(opened):
    """A history is of the event that is named, else of the one with the most damage."""
    times = [opened.figure("history", "A", 3, event=event).data[0].x[-1] for event in ("sine", "noise")]
    assert times == pytest.approx([11.98, 11.98], abs=0.03)
    drawn = {trace.name for trace in opened.figure("exceedance", "A", event="noise").data}
    assert drawn == {"mission", "noise"}


def test_a_spectrum_is_that_of_the_history(opened):
    """As scipy has it; modes are marked, events are named; a record shorter than a segment has none."""
    drawn = opened.figure("spectrum", "A", 3, surface="top")
    noise = next(trace for trace in drawn.data if trace.name == "noise")
    stress = opened.history("A", 3, event="noise")["structural_top_MPa"].to_numpy()
    frequency, density = welch(stress, 1.0 / STEP, nperseg=round(1.0 / STEP))
    shown = len(noise.x) + 1
    np.testing.assert_allclose(noise.x, frequency[1:shown], rtol=1e-6)
    np.testing.assert_allclose(noise.y, density[1:shown], rtol=1e-4)
    assert any("mode 1, 5 Hz" in note.text for note in drawn.layout.annotations)
    with pytest.raises(DataError, match=r"no record is as long as a segment of a spectrum\. Shorten segment_s"):
        opened.figure("spectrum", "A", event="load and unload")


@pytest.mark.parametrize(
    ("do", "error", "words"),
    [
        (lambda r: r.figure("picture"), CaseError, "there is no figure 'picture'. Name one of lives, weld, history"),
        (lambda r: r.figure("weld", "C"), DataError, "the result has no weld 'C'. Name one of 'A', 'B'"),
        (lambda r: r.figure("sn", "A", 99), DataError, "weld 'A': has no order 99"),
        (lambda r: r.figure("history", "A", event="x"), DataError, "the mission has no event 'x'"),
        (lambda r: r.table("node"), DataError, "there is no table 'node' of a result. Name one of nodes"),
        (lambda r: r.table("nodes", ["life"]), DataError, "the table has no column 'life'. Name 'life_km'"),
        (lambda r: r.table("nodes", ["life"], weld="A"), DataError, "the table has no column 'life'"),
        (lambda r: r.table("nodes", weld="C"), DataError, "the result has no weld 'C'"),
        (lambda r: r.table("attribution"), DataError, "no such result table"),
        (lambda r: r.worst(3, weld="C"), DataError, "the result has no weld 'C'"),
        (lambda r: r.worst(0), CaseError, "top: 0 is no number of points. Give a whole number from 1 on"),
        (lambda r: r.history("A", 3.5), CaseError, "order: 3.5 is no order. Give a whole number"),
        (lambda r: r.history("A", 3, instants="all"), CaseError, "'all' are no instants of a history"),
        (lambda r: r.cycles("A", 3, surface="side"), DataError, "there is no face 'side'"),
    ],
)
def test_mistakes_in_one_line(opened, do, error, words):
    """In the words of the program."""
    with pytest.raises(error) as refused:
        do(opened)
    assert words in str(refused.value)
    assert "\n" not in str(refused.value)


def test_what_is_no_result(small_result, tmp_path):
    """A file of one, an empty folder, something that is no path."""
    with pytest.raises(DataError, match=r"is a file, not the folder of a result\. Give the folder it is in"):
        fatigue.open_result(small_result / "nodes.parquet")
    with pytest.raises(DataError, match="no finished result in this folder"):
        fatigue.open_result(tmp_path)
    with pytest.raises(CaseError, match="folder: int is no path"):
        fatigue.open_result(3)


def test_opening_reads_no_table_but_the_welds(small_result, tmp_path, monkeypatch):
    """Others are hashed when they are asked for: a changed one is refused then, and only then."""
    folder = shutil.copytree(small_result, tmp_path / "result")
    content = bytearray((folder / "cycles.parquet").read_bytes())
    content[len(content) // 2] ^= 1
    (folder / "cycles.parquet").write_bytes(content)
    result = fatigue.open_result(folder)
    assert len(result.nodes)
    assert result._repr_html_()
    with pytest.raises(DataError, match=r"cycles\.parquet: was changed since it was written"):
        result.table("cycles")


def test_inputs_are_read_once_and_watched(tmp_path, monkeypatch):
    """A second history reads no forces again, and a touched file is looked at anew: refused if it has changed."""
    folder = result_of(plain(2.0).write(tmp_path / "case"), tmp_path / "result")
    result, reads = fatigue.open_result(folder), []
    original = module.reopened
    monkeypatch.setattr(module, "reopened", lambda *given: reads.append(1) or original(*given))
    first = result.history("A", 2)
    result.cycles("B")
    assert len(reads) == 1
    sine = tmp_path / "case" / "sine.csv"
    os.utime(sine, ns=(1, 1))
    pd.testing.assert_frame_equal(result.history("A", 2), first)
    assert len(reads) == 2
    sine.write_text(sine.read_text() + "\n")
    with pytest.raises(DataError, match=r"sine\.csv"):
        result.history("A", 2)
    assert result.nodes.shape[0] == 28
    scratch = result._held.scratch
    assert scratch.is_dir()
    del result
    gc.collect()
    assert not scratch.exists()


def test_the_case_may_be_elsewhere(tmp_path):
    """Then it is named when the result is opened."""
    folder = result_of(plain(2.0).write(tmp_path / "case"), tmp_path / "result")
    moved = shutil.move(tmp_path / "case", tmp_path / "elsewhere")
    with pytest.raises(DataError, match="Name the case file with --case CASE"):
        fatigue.open_result(folder).history("A")
    assert len(fatigue.open_result(folder, case_file=f"{moved}/case.toml").history("A", event="load and unload")) == 2


def test_a_point_that_nothing_moves(tmp_path):
    """Has no cycles to be drawn."""
    case = plain(2.0)
    case.nodal_forces.loc[case.nodal_forces["weld"] == "B", ["fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"]] = 0
    result = fatigue.open_result(result_of(case.write(tmp_path / "case"), tmp_path / "result"))
    for name in ("history", "spectrum", "rainflow", "exceedance", "sn"):
        with pytest.raises(DataError, match="nothing changes its stress, so it has no cycles to be drawn"):
            result.figure(name, "B")
    assert result.history("B")["structural_top_MPa"].abs().max() == 0.0
    assert len(result.cycles("B")) == 0


def test_a_result_of_an_older_version(small_result, tmp_path):
    """Opens, and has its points."""
    folder = without_hashes(shutil.copytree(small_result, tmp_path / "result"))
    case = small_result.parent / "case" / "case.toml"
    assert len(fatigue.open_result(folder, case_file=case).history("A", 3)) > 0


def test_a_result_that_was_replaced(tmp_path):
    """What was opened before says that its tables are of another result; opened anew it is the new one."""
    case = plain(2.0)
    folder = result_of(case.write(tmp_path / "case"), tmp_path / "result")
    result = fatigue.open_result(folder)
    assert len(result.history("A", 2, event="sine"))
    case.events[1]["stress_factor"] = 2.0
    result_of(case.write(tmp_path / "case"), tmp_path / "result")
    for ask in (lambda: result.nodes, lambda: result.history("A", 2), lambda: result.figure("sn", "A")):
        with pytest.raises(DataError, match=r"nodes\.parquet"):
            ask()
    assert fatigue.open_result(folder).events["stress_factor"].tolist() == [1.0, 2.0, 1.0]
