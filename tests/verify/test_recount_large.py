"""The recount of a result that is too large for all of its welds: what it chooses and what it finds all the same."""

import json
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from fatigue.errors import DataError
from fatigue.results import json_ready, schema
from fatigue.verify.recount import Recount, recount
from fatigue.verify.recount import folder as story
from fatigue.verify.recount.inputs import tables
from tests.older_result import without_hashes
from tests.verify.test_recount import assessed, differing, edit
from tests.verify.tiny_case import TinyCase

WELDS = ("seam", "curved", "ring", "angle", "square", "short")
ORDERED = ("nodes", "damage", "structural_stress", "cycles")


@pytest.fixture(scope="module")
def result(tmp_path_factory) -> Path:
    """Result of six welds."""
    return assessed(
        tmp_path_factory.mktemp("six"), TinyCase(samples=120, spectrum="segment_s = 0.3", counting="upsample = 1")
    )


@pytest.fixture
def copy(tmp_path, result) -> Path:
    """Copy the result and its inputs, to be spoiled."""
    shutil.copytree(result.parent, tmp_path / "six")
    return without_hashes(tmp_path / "six" / "result")


def utilisation(folder: Path) -> pd.Series:
    """Utilisation of every weld, greatest first."""
    return pd.read_parquet(folder / "welds.parquet").set_index("weld")["utilisation"].sort_values(ascending=False)


def test_fewer_welds_where_all_would_take_long(result):
    """Half of the welds are the worst, half are drawn; the choice is said, and the same the next time."""
    samples = sum(e["samples"] for e in json.loads((result / "provenance.json").read_text())["mission"]["events"])
    found = recount(result, sample=0, most_samples=4 * samples)
    assert found.passed, found.as_text()
    assert found.points == 4 + 1  # one of these welds has half cycles, at another point than its worst one
    assert found.choice.startswith("the worst points of 4 of 6 welds, 2 with the shortest lives and 2 drawn")
    assert f"  recounted: {found.choice}" in found.as_text().splitlines()
    record = json.loads(json.dumps(json_ready(found.as_record())))
    assert record["choice"] == found.choice
    of_welds = [column for column in found.columns if column.table == "welds" and column.unit != "rows"]
    assert {column.compared for column in of_welds} == {4}
    again = recount(result, sample=0, most_samples=4 * samples)
    assert json_ready(again.as_record()) == record


def test_the_worst_welds_are_always_recounted(copy):
    """A spoiled value at the worst point of the weld with the shortest life is found, whatever is drawn."""
    worst = utilisation(copy).index[0]

    def spoiled(frame: pd.DataFrame) -> pd.DataFrame:
        of_weld = frame[frame["toe"] & (frame["weld"] == worst)]
        frame.loc[of_weld["utilisation"].idxmax(), "shear_ratio"] *= 1.01
        return frame

    edit(copy, "nodes", spoiled)
    for seed in (1, 2, 3):
        assert differing(recount(copy, sample=0, seed=seed, most_samples=1)) == {"nodes.shear_ratio"}


def test_a_weld_whose_other_point_is_drawn_has_its_worst_recounted(result):
    """The row of a weld can be compared only where its worst point was recounted."""
    found = recount(result, sample=1000, most_samples=1)
    assert found.points == found.points_in_all
    assert found.passed, found.as_text()


def test_all_points_may_be_asked_for(result):
    """Nothing is left out then, however long it takes."""
    found = recount(result, sample=None, most_samples=1)
    assert (found.points, found.choice) == (found.points_in_all, "")


SPOILED = {
    ("nodes", "damage_per_km"): {"nodes, all rows.damage_per_km"},
    ("nodes", "life_km"): {"nodes, all rows.life_km"},
    ("nodes", "life_km_dirlik"): {"nodes, all rows.life_km_dirlik"},
    ("nodes", "dirlik_ratio"): {"nodes, all rows.dirlik_ratio"},
    ("nodes", "max_range_MPa"): {"nodes, all rows.max_range_MPa"},
    ("nodes", "bending_ratio"): {"nodes, all rows.bending_ratio"},
    ("damage", "damage_tb_per_km"): {"damage, all rows.damage_tb_per_km"},
    ("damage", "damage_tb_per_pass"): {"damage, all rows.damage_tb_per_km", "nodes, all rows.life_km_tb"},
    ("damage", "damage_tb_whole_per_pass"): {"damage, all rows.damage_tb_whole_per_km"},
    ("cycles", "damage"): {"cycles, all rows.damage"},
    ("welds", "load_factor"): {"welds, all rows.load_factor"},
    ("welds", "governing_event"): {"welds, all rows.governing_event"},
}


@pytest.mark.parametrize("spoiled", SPOILED, ids=".".join)
def test_a_spoiled_value_of_a_point_that_is_not_recounted_is_found(copy, spoiled):
    """What follows from other rows is checked for all rows, and the place is named."""
    table, column = spoiled
    recounted = recount(copy, sample=0, most_samples=1)
    assert recounted.points == 2
    untouched = utilisation(copy).index[-1]

    def change(frame: pd.DataFrame) -> pd.DataFrame:
        rows = frame.index[(frame["weld"] == untouched) & (frame[column].notna() if table != "welds" else True)]
        frame.loc[rows[0], column] = "smooth or rough" if column == "governing_event" else frame[column][rows[0]] * 1.01
        return frame

    drawn = {c.where for c in recounted.columns if c.table == "welds"}
    assert not any(untouched in where for where in drawn)
    edit(copy, table, change)
    found = recount(copy, sample=0, most_samples=1)
    assert differing(found) == SPOILED[spoiled]
    assert all(f"weld {untouched}" in column.where for column in found.columns if not column.passed)


def test_a_weld_that_names_a_point_that_is_not_its_worst_is_found(copy):
    """No counted point at a toe has a higher utilisation than the weld."""
    untouched = utilisation(copy).index[-1]

    def change(frame: pd.DataFrame) -> pd.DataFrame:
        row = frame.index[frame["weld"] == untouched][0]
        frame.loc[row, "worst_order"] = 10 if frame.loc[row, "worst_order"] != 10 else 20
        return frame

    edit(copy, "welds", change)
    assert "welds, all rows.utilisation" in differing(recount(copy, sample=0, most_samples=1))


# ---------------------------------------------------------------------------------------------------------- pieces


def test_pieces_find_what_the_whole_finds(result, monkeypatch):
    """Weld by weld and point by point, inputs read a few rows at a time: the very same checks."""
    whole = recount(result, sample=6)
    for name in ("FORCES_AT_ONCE", "SAMPLES_AT_ONCE", "STRESS_ROWS_AT_ONCE"):
        monkeypatch.setattr(story, name, 1)
    monkeypatch.setattr(tables, "_ROWS_AT_ONCE", 5)
    pieces = recount(result, sample=6)

    def by_name(found: Recount) -> dict[tuple[str, str], object]:  # tables stand in the order in which they are met
        return {(column["table"], column["column"]): column for column in found.as_record()["columns"]}

    assert len(pieces.columns) == len(whole.columns)
    for name, column in by_name(whole).items():
        assert json_ready(by_name(pieces)[name]) == json_ready(column)


@pytest.mark.parametrize("most_samples", [1, 10**9])
def test_rows_may_stand_in_any_order(copy, most_samples):
    """A table that somebody has sorted otherwise still agrees."""
    for seed, table in enumerate(ORDERED):
        edit(copy, table, lambda frame, seed=seed: frame.sample(frac=1.0, random_state=seed))
    found = recount(copy, sample=3, most_samples=most_samples)
    assert found.passed, found.as_text()


def test_a_row_from_elsewhere_is_named(copy):
    """A key that is not in the case stands in the text as it is in the table."""
    edit(copy, "damage", lambda frame: frame.assign(event=["??", *frame["event"][1:]]))
    found = recount(copy)
    (wrong,) = (column for column in found.columns if not column.passed)
    assert (wrong.table, wrong.difference, wrong.found, wrong.expected) == (
        "damage",
        2.0,
        wrong.compared,
        wrong.compared,
    )
    edit(copy, "damage", lambda frame: pd.concat([frame.assign(event=["rough", *frame["event"][1:]]), frame[:1]]))
    (wrong,) = (column for column in recount(copy).columns if not column.passed)
    assert wrong.where.endswith("'??')")


def test_cycles_of_a_point_that_is_not_there_are_found(copy):
    """They belong to no point of the case."""
    edit(copy, "cycles", lambda frame: frame.assign(weld=["nowhere", *frame["weld"][1:]]))
    (wrong,) = (column for column in recount(copy).columns if not column.passed)
    assert (wrong.table, wrong.difference, wrong.where) == ("cycles", 1.0, "not in the case: row 1")


@pytest.mark.parametrize("table", ["nodes", "damage", "structural_stress", "cycles", "welds"])
def test_missing_and_damaged_tables_are_named(copy, table):
    """A table that is gone, cut short or without a column is refused by its name with a remedy."""
    path = copy / f"{table}.parquet"
    whole, frame = path.read_bytes(), pq.read_table(path)
    path.write_bytes(whole[:-30])
    with pytest.raises(DataError, match=rf"{table}\.parquet: the table cannot be read .*Run the assessment again"):
        recount(copy)
    path.unlink()
    with pytest.raises(DataError, match=rf"{table}\.parquet: no such result table"):
        recount(copy)
    pq.write_table(frame.drop_columns("weld"), path)
    with pytest.raises(DataError, match=rf"{table}\.parquet: the table cannot be read \(.*weld.*\)"):
        recount(copy)


# ---------------------------------------------------------------------------------------------------- input tables


@pytest.mark.parametrize("suffix", ["csv", "parquet", "coded parquet"])
def test_rows_of_some_welds_are_those_of_the_whole_table(tmp_path, suffix, monkeypatch):
    """Whatever the row groups, the order of rows, and blanks about names and headings."""
    monkeypatch.setattr(tables, "_ROWS_AT_ONCE", 7)
    rng = np.random.default_rng(3)
    names = np.array(["A", " A", "A ", "B1", "B10 ", "B2", "  C"])[rng.integers(0, 7, 200)]
    frame = pd.DataFrame({"weld ": names, "node": np.arange(200), " x_mm": np.round(rng.normal(size=200), 3)})
    path = tmp_path / f"t.{suffix.rpartition(' ')[2]}"
    if suffix == "csv":
        frame.to_csv(path, index=False)
    else:
        coded = frame.astype({"weld ": "category"}) if "coded" in suffix else frame
        pq.write_table(pa.Table.from_pandas(coded, preserve_index=False), path, row_group_size=11)
    whole = tables.read_frame(path)
    pd.testing.assert_frame_equal(pd.concat(tables.read_pieces(path), ignore_index=True), whole, check_dtype=False)
    for welds in (["A"], ["B1", "C"], ["B10"], ["nowhere"]):
        found = tables.read_rows_where(path, "weld", welds)
        expected = whole[whole["weld"].isin(welds)].reset_index(drop=True)
        pd.testing.assert_frame_equal(found, expected, check_dtype=bool(len(expected)))
    nodes = tables.read_rows_where(path, "node", [199, 4])
    assert nodes["node"].tolist() == [4, 199]
    assert list(next(tables.read_pieces(path, ("node",)))) == ["node"]


def test_schema_is_kept(copy):
    """The edits of these tests write what the program writes."""
    edit(copy, "nodes", lambda frame: frame)
    assert pq.read_schema(copy / "nodes.parquet").equals(schema("nodes"))
