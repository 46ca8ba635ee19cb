"""A history as a file: the same numbers in every format, units and meaning, and everything that is refused."""

import json
import shutil

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest
from scipy.io import loadmat

from fatigue.errors import CaseError, DataError
from fatigue.point import written as story
from fatigue.point.formats import FORMATS
from fatigue.point.written import write_history
from fatigue.results.dictionary.decided.history import AT_VERTICES, HISTORY
from tests.point.cases import SEQUENCES, largest_ranges, plain, ranges_of, result_of


def in_mat(path) -> pd.DataFrame:
    """Table of a MAT file."""
    events = np.atleast_1d(loadmat(path, simplify_cells=True)["history"])
    columns = [c.name for c in (*HISTORY, *AT_VERTICES) if c.name == "event" or c.name in events[0]]
    return pd.concat([pd.DataFrame({name: one[name] for name in columns}) for one in events], ignore_index=True)


READERS = {".csv": pd.read_csv, ".parquet": pd.read_parquet, ".mat": in_mat}


@pytest.mark.parametrize("name", ["unit loads at vertices", "loop", "half"])
def test_every_format_has_the_same_numbers(results, tmp_path, name):
    """To the last bit, read by pandas and as MATLAB reads it; ranges are those of the assessment."""
    tables = []
    for ending in FORMATS:
        path = tmp_path / f"history{ending}"
        said = write_history(results(name), "A", path, order=3)
        tables.append(READERS[ending](path))
        assert len(tables[-1]) == said.samples
        assert list(tables[-1].columns) == list(said.columns)
        assert [path.name for path in tmp_path.iterdir() if path.name.startswith(".")] == []
    for other in tables[1:]:
        pd.testing.assert_frame_equal(other, tables[0], check_exact=True, check_dtype=False)
    expected = largest_ranges(results(name), ("A", 1, 3)).drop(index=SEQUENCES, errors="ignore")
    np.testing.assert_allclose(ranges_of(tables[0]).loc[expected.index], expected[["top", "bottom"]], rtol=1e-12)


def test_what_is_said_of_every_event(results, tmp_path):
    """Extremes of what is counted, factors, constants, instants."""
    said = write_history(results("unit loads"), "A", tmp_path / "a.csv", order=3)
    table = pd.read_csv(tmp_path / "a.csv")
    assert [event.event for event in said.events] == ["sine", "noise", "load and unload", "stand"]
    for event in said.events:
        own = table[table["event"] == event.event]
        assert (event.samples, event.start_s, event.end_s) == (len(own), own["time_s"].min(), own["time_s"].max())
        for face in ("top", "bottom"):
            stress = own[f"structural_{face}_MPa"]
            assert getattr(event, f"min_{face}_MPa") == pytest.approx(stress.min(), abs=1e-12)
            assert getattr(event, f"max_{face}_MPa") == pytest.approx(stress.max(), abs=1e-12)
            assert getattr(event, f"range_{face}_MPa") == pytest.approx(np.ptp(stress), abs=1e-12)
    assert [event.is_static for event in said.events] == [False, False, False, True]
    assert [event.residue for event in said.events] == ["repeat", "repeat", "half", "half"]
    assert [event.stress_factor for event in said.events] == [1.0, 1.3, 1.0, 1.0]
    _, noise, passing, stand = said.events
    push = pd.read_parquet(results("unit loads") / "structural_stress.parquet").query(
        "weld == 'A' and order == 3 and unit_load == 'push'"
    )
    membrane, bending = push["membrane_MPa"].item(), push["bending_MPa"].item()
    removed = {
        name: by_hand_mean(results("unit loads"), name, start) for name, start in (("noise", 1.0), ("load", 0.0))
    }
    assert noise.constant_top_MPa == pytest.approx(1.3 * (5.0 * (membrane + bending) - removed["noise"][0]), rel=1e-9)
    assert passing.constant_bottom_MPa == pytest.approx(-2.0 * (membrane - bending) - removed["load"][1], rel=1e-9)
    assert stand.constant_top_MPa == 0.0


def by_hand_mean(folder, name, start_s):
    """Mean stress of the modes over the kept samples at both faces [MPa]."""
    q = pd.read_csv(folder.parent / "case" / f"{name}.csv")
    q = q[q["time_s"] > start_s - 0.0025].mean()
    by_mode = (
        pd.read_parquet(folder / "structural_stress.parquet").query("weld == 'A' and order == 3").set_index("mode")
    )
    m, b = (sum(by_mode.loc[k, f"{part}_MPa"] * q[f"q_{k}"] for k in (1, 2)) for part in ("membrane", "bending"))
    return m + b, m - b


def test_parquet_says_unit_and_meaning(results, tmp_path):
    """Of every column in its field, of the whole in the metadata of the file."""
    write_history(results("vertex"), "A", tmp_path / "a.parquet", node=104)
    schema = pq.read_schema(tmp_path / "a.parquet")
    for column, field in zip((*HISTORY, *AT_VERTICES), schema, strict=True):
        assert field.name == column.name
        assert field.metadata == {b"unit": column.unit.encode(), b"description": column.meaning.encode()}
    said = {key.decode(): value.decode() for key, value in schema.metadata.items() if key != b"ARROW:schema"}
    record = json.loads((results("vertex") / "provenance.json").read_text())
    assert said["result"] == record["result"]
    assert {key: said[key] for key in ("table", "title", "weld", "part", "order", "node", "instants", "reversals")} == {
        "table": "history", "title": "small case", "weld": "A", "part": "1", "order": "5", "node": "104",
        "instants": "counted", "reversals": "vertex",
    }  # fmt: skip
    assert [event["event"] for event in json.loads(said["events"])] == ["sine", "noise", "load and unload"]


def test_mat_is_a_struct_for_each_event(results, tmp_path):
    """Columns (t, 1) with what is said of the event; the point, units and meanings beside them."""
    write_history(results("unit loads"), "A", tmp_path / "a.mat", order=3)
    found = loadmat(tmp_path / "a.mat")
    assert found["history"].shape == (1, 4) or found["history"].shape == (4, 1)
    one = found["history"].ravel()[1]
    assert one["event"].item() == "noise"
    assert one["stress_factor"].item() == 1.3
    assert one["time_s"].shape == one["structural_top_MPa"].shape == (one["samples"].item(), 1)
    assert found["point"]["weld"].item().item() == "A"
    assert found["units"]["bending_MPa"].item().item() == "MPa"
    assert "top face" in found["meaning"]["bending_MPa"].item().item()


def test_names_that_are_no_plain_words(tmp_path):
    """Quotes, commas, formulas, letters of any script, nothing longer than MATLAB takes: in all three formats."""
    case = plain(2.0)
    names = ["=cmd|' /C calc'!A0", 'Überführung, "naß"', "x" * 90]
    for event, name in zip(case.events, names, strict=True):
        event["name"] = name.replace("\\", "\\\\").replace('"', '\\"')
    folder = result_of(case.write(tmp_path / "case"), tmp_path / "result")
    for ending, read in READERS.items():
        write_history(folder, "A", tmp_path / f"a{ending}")
        found = list(dict.fromkeys(read(tmp_path / f"a{ending}")["event"]))
        assert found == ([f"'{names[0]}", *names[1:]] if ending == ".csv" else names), ending


def test_samples_of_the_file(results, tmp_path):
    """One of four where the record was upsampled four times, which is said."""
    every = write_history(results("upsampled"), "A", tmp_path / "a.csv")
    few = write_history(results("upsampled"), "A", tmp_path / "b.csv", instants="file")
    assert [event.upsample for event in every.events[:2]] == [4, 4]
    assert [event.upsample for event in few.events] == [1, 1, 1]
    assert [event.samples for event in every.events[:2]] == [4 * event.samples for event in few.events[:2]]
    assert "samples of the file" in few.as_text()
    refined = write_history(results("finer load"), "A", tmp_path / "c.csv", instants="file", event="noise")
    assert [event.upsample for event in refined.events] == [1]


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("a.xlsx", r"a history is not written as '.xlsx'. End it in .csv, which Excel opens, or in .parquet or .mat"),
        ("a.json", r"a history is not written as '.json'. End it in .csv, .parquet or .mat"),
        ("a", r"the name of the file has no ending. End it in .csv, .parquet or .mat"),
    ],
)
def test_other_formats_are_refused(small_result, tmp_path, name, words):
    """With those that there are."""
    with pytest.raises(CaseError) as refused:
        write_history(small_result, "A", tmp_path / name)
    assert words in str(refused.value)
    assert not (tmp_path / name).exists()


def test_a_file_in_the_way(tmp_path):
    """Is left as it is, and overwritten if asked; inputs and files of the result never are, nor is a folder."""
    folder = result_of(plain(2.0).write(tmp_path / "case"), tmp_path / "result")
    mine = tmp_path / "mine.csv"
    mine.write_text("mine")
    with pytest.raises(DataError, match=r"mine.csv: is there already. Give another file with -o, or --force to overwr"):
        write_history(folder, "A", mine)
    assert mine.read_text() == "mine"
    assert write_history(folder, "A", mine, force=True).samples == len(pd.read_csv(mine))
    sine = tmp_path / "case" / "sine.csv"
    before = sine.read_bytes()
    for path, words in (
        (sine, "is an input of this result"),
        (folder / "nodes.parquet", "is the place of a file of the result"),
        (folder / "signals.parquet", "is the place of a file of the result"),
    ):
        with pytest.raises(DataError, match=words):
            write_history(folder, "A", path, force=True)
    assert sine.read_bytes() == before
    (tmp_path / "folder.csv").mkdir()
    with pytest.raises(DataError, match="is a folder, not a file"):
        write_history(folder, "A", tmp_path / "folder.csv", force=True)
    with pytest.raises(DataError):  # a file where a folder would be
        write_history(folder, "A", mine / "a.csv")
    assert write_history(folder, "A", tmp_path / "new" / "a.csv").file.exists()


def test_nothing_is_left_of_what_fails(results, tmp_path):
    """Neither a part of the file nor a folder that was made for it."""
    with pytest.raises(DataError, match="no event"):
        write_history(results("plain"), "A", tmp_path / "new" / "a.csv", event="x")
    assert list(tmp_path.iterdir()) == []


def test_more_rows_than_excel_opens(small_result, tmp_path, monkeypatch):
    """Is a warning for CSV, with what to do; a MAT file is refused before it is too much for memory."""
    monkeypatch.setattr(story, "EXCEL_ROWS", 100)
    said = write_history(small_result, "A", tmp_path / "a.csv")
    (warning,) = said.warnings
    assert warning.code == "excel_rows"
    assert f"has {said.samples} rows, and Excel opens the first 100 of them. Write one event" in str(warning)
    assert not write_history(small_result, "A", tmp_path / "a.parquet").warnings
    monkeypatch.setattr(story, "MOST_IN_MAT", 100)
    with pytest.raises(DataError, match=r"and 100 at most go into a MAT file\. Write \.parquet, which MATLAB reads"):
        write_history(small_result, "A", tmp_path / "a.mat")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"order": 2.5}, "order: 2.5 is no order. Give a whole number, as in nodes.parquet"),
        ({"node": True}, "node: True is no node"),
        ({"part": "1"}, "part: '1' is no part"),
        ({"instants": "all"}, "instants: 'all' are no instants of a history. Say 'counted' or 'file'"),
    ],
)
def test_arguments_that_make_no_sense(small_result, tmp_path, arguments, words):
    """In one line each."""
    with pytest.raises(CaseError) as refused:
        write_history(small_result, "A", tmp_path / "a.csv", **arguments)
    assert words in str(refused.value)


def test_a_table_of_another_result_is_refused(small_result, tmp_path):
    """Before a point is looked for in it."""
    folder = shutil.copytree(small_result, tmp_path / "result")
    nodes = pd.read_parquet(folder / "nodes.parquet")
    nodes.assign(order=nodes["order"] + 1).to_parquet(folder / "nodes.parquet")
    with pytest.raises(DataError, match=r"nodes\.parquet"):
        write_history(folder, "A", tmp_path / "a.csv")
