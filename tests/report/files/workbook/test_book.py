"""The workbook, opened again: verdict, rows by utilisation, colours, numbers of the tables, formulas as texts."""

import builtins

import numpy as np
import pandas as pd
import pytest

from fatigue.errors import DataError
from fatigue.report.files.workbook.book import write_xlsx
from fatigue.report.files.workbook.sheet import heading, leading
from fatigue.report.hot_spots.of_result import HOT_SPOTS, hot_spots
from fatigue.results import NODES, TABLES, WELDS
from tests.report.tiny_result import Recipe, write_result

openpyxl = pytest.importorskip("openpyxl")
pytest.importorskip("xlsxwriter")


@pytest.fixture(scope="module")
def book(result_folder):
    """Workbook of a result that misses its target, opened."""
    return openpyxl.load_workbook(write_xlsx(result_folder))


def head(column):
    """Header of a column."""
    words, unit = heading(column)
    return f"{words}\n[{unit}]" if unit else words


def read(book, name, columns):
    """A sheet as a table with the names of the columns."""
    rows = [list(row) for row in book[name].iter_rows(values_only=True)]
    assert rows[0] == [head(column) for column in columns]
    return pd.DataFrame(rows[1:], columns=[column.name for column in columns])


def test_the_cover_says_the_verdict(book, result_folder):
    """First of all: the target, who misses it, the worst point, the hash; and what each sheet holds."""
    assert book.sheetnames[:4] == ["verdict", "hot spots", "welds", "nodes"]
    said = {row[0]: row[1] for row in book["verdict"].iter_rows(values_only=True)}
    worst = pd.read_parquet(result_folder / "welds.parquet").sort_values("utilisation").iloc[-1]
    assert book["verdict"]["A1"].value == "Trailer car"
    assert "✕ Target not fulfilled" in said
    assert said["welds that miss it"] == "1 of 2"
    assert said["worst point"].startswith(f"{worst['weld']}, node {worst['worst_node']}, {worst['worst_surface']} face")
    assert said["identity"] == "DRAFT, not identified"
    assert set(book.sheetnames[1:]) <= set(said)


def test_a_target_that_is_met_is_said_so(tmp_path):
    """And an infinite life is no number."""
    book = openpyxl.load_workbook(write_xlsx(write_result(tmp_path, Recipe(level=0.0, stations=2))))
    said = {row[0]: row[1] for row in book["verdict"].iter_rows(values_only=True)}
    assert "✓ Target fulfilled" in said
    assert said["shortest life"] == "> 1e12 km, > 1e6 years"
    assert book["hot spots"].max_row == 1
    cells = {cell for row in book["nodes"].iter_rows(values_only=True) for cell in row}
    assert "> 1e+12" in cells
    assert not {"nan", "inf", "NaN"} & {cell for cell in cells if isinstance(cell, str)}


def test_who_answers_stands_on_the_cover(tmp_path):
    """As it was issued last, where the record knows it."""
    from fatigue.report.files.workbook.cover import _identity  # noqa: PLC0415

    issued = [{"report": {"document": "A"}}, {"report": {"document": "B", "author": "C. D."}}]
    assert dict(_identity({"identity": issued, "case_text": ""})) == {"document": "B", "author": "C. D."}
    given = {"case_text": '[report]\ndocument = "E"\n'}
    assert dict(_identity(given)) == {"document": "E"}


@pytest.mark.parametrize(("name", "columns"), [("nodes", NODES), ("welds", WELDS)])
def test_numbers_are_those_of_the_table_by_utilisation(book, result_folder, name, columns):
    """Every number of every column to the 16 digits of the format, the worst row first."""
    found = read(book, name, leading(columns))
    expected = pd.read_parquet(result_folder / f"{name}.parquet")
    expected = expected.iloc[np.argsort(-expected["utilisation"].to_numpy(), kind="stable")].reset_index(drop=True)
    assert found["weld"].tolist() == expected["weld"].tolist()
    assert (np.diff(found["utilisation"].astype(float)) <= 0.0).all()
    for column in columns:
        if column.type in ("float", "int"):
            numbers = pd.to_numeric(found[column.name], errors="coerce").to_numpy(dtype=float)
            np.testing.assert_allclose(
                numbers, expected[column.name].to_numpy(dtype=float), rtol=1e-15, err_msg=column.name
            )


def test_all_hot_spots_are_in_it(book, result_folder):
    """Those of the view, with extent and worst point."""
    found = read(book, "hot spots", HOT_SPOTS)
    nodes, welds = (pd.read_parquet(result_folder / f"{name}.parquet") for name in ("nodes", "welds"))
    expected = hot_spots(nodes, welds).table
    for column in HOT_SPOTS:
        if column.type in ("float", "int"):
            np.testing.assert_allclose(
                found[column.name].astype(float), expected[column.name].astype(float), rtol=1e-15
            )
    assert found["weld"].tolist() == expected["weld"].tolist()


def test_utilisation_has_a_colour_from_three_quarters(book):
    """Red above 1, amber from 0.75, a missed target red; in every sheet that has the column."""
    for name, columns in (("hot spots", HOT_SPOTS), ("welds", leading(WELDS)), ("nodes", leading(NODES))):
        names = [column.name for column in columns]
        rules = {}
        for area in book[name].conditional_formatting:
            column = openpyxl.utils.cell.range_boundaries(str(area.sqref))[0] - 1
            rules[names[column]] = [(rule.operator, rule.formula) for rule in area.rules if rule.type == "cellIs"]
        assert rules["utilisation"] == [("greaterThan", ["1"]), ("greaterThanOrEqual", ["0.75"])]
        assert rules["fulfilled"] == [("equal", ["FALSE"])]


def test_headers_stay_and_columns_filter(book):
    """The first row is frozen and carries the filter over all rows."""
    for name in ("hot spots", "welds", "nodes"):
        assert book[name].freeze_panes == "B2"
        assert book[name].auto_filter.ref == book[name].dimensions


@pytest.mark.parametrize("table", sorted(TABLES))
def test_headers_have_their_unit_once_and_are_unlike_each_other(table):
    """No unit in the words that stands behind them, and no two columns of a table with one header."""
    heads = [heading(column) for column in TABLES[table]]
    assert len(set(heads)) == len(heads)
    assert not [(words, unit) for words, unit in heads if unit and unit in words.split()]
    assert not [words for words, unit in heads if unit == "years" and "years" in words]
    assert all(words for words, _ in heads)


def test_every_column_is_explained(book):
    """Sheet, header, name in the tables, unit and meaning."""
    rows = list(book["columns"].iter_rows(values_only=True))
    assert [row[2] for row in rows if row[0] == "nodes"] == [column.name for column in leading(NODES)]
    assert ("hot spots", "from", "from_mm", "mm") in [row[:4] for row in rows]


def test_formulas_stay_texts(tmp_path):
    """No name becomes a formula or a link."""
    names = ("=1+1", "@SUM(A1)", "+cmd|' /C calc'!A0", "https://example.org", "-2")
    book = openpyxl.load_workbook(write_xlsx(write_result(tmp_path, Recipe(welds=names, stations=2, title="=1+1"))))
    for sheet in book:
        cells = [cell for row in sheet.iter_rows() for cell in row]
        assert not [cell for cell in cells if cell.data_type == "f" or cell.hyperlink]
    assert set(names) <= {cell.value for cell in book["welds"]["A"]}


def test_the_same_result_gives_the_same_workbook(result_folder):
    """No clock in the workbook."""
    assert write_xlsx(result_folder).read_bytes() == write_xlsx(result_folder).read_bytes()


def test_without_the_extra_the_message_names_it(result_folder, monkeypatch):
    """How to install it, and that CSV needs nothing."""
    real = builtins.__import__

    def missing(name, *args, **kwargs):
        if name == "xlsxwriter":
            raise ImportError(name)
        return real(name, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", missing)
    with pytest.raises(DataError, match=r'pip install "xlsxwriter>=[\d.]+", or write CSV'):
        write_xlsx(result_folder)


def test_too_many_points_for_a_sheet(result_folder, monkeypatch):
    """The limit of the format is told before anything is written."""
    monkeypatch.setattr("fatigue.report.files.workbook.book._MOST_ROWS", 10)
    with pytest.raises(DataError, match="do not fit into a sheet of 10 rows"):
        write_xlsx(result_folder)
