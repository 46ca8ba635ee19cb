"""Excel workbooks: sheets with names, perhaps units, and columns of numbers."""

import datetime

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.read import read_channels, read_coordinates, recognise

xlsxwriter = pytest.importorskip("xlsxwriter", reason="the package xlsxwriter is not installed")
pytest.importorskip("python_calamine", reason="the package python_calamine is not installed")

T = 2.0 + 0.01 * np.arange(60)
Q = np.random.default_rng(4).standard_normal((60, 2))
TABLE = [["time [s]", "q_3", "q_8"], *np.column_stack([T, Q]).tolist()]


def write(path, **sheets):
    """Write rows of cells, sheet by sheet."""
    with xlsxwriter.Workbook(path, {"default_date_format": "yyyy-mm-dd"}) as book:
        for name, rows in sheets.items():
            sheet = book.add_worksheet(name)
            for r, row in enumerate(rows):
                for c, cell in enumerate(row):
                    if cell is not None:
                        sheet.write(r, c, cell)
    return path


def refused(path):
    """The refusal of a workbook."""
    with pytest.raises(DataError) as caught:
        read_coordinates(path, None, None)
    return caught.value.problems[0]


def test_a_sheet_of_names_and_numbers(tmp_path):
    """Values to the digits that Excel keeps, the start of time kept."""
    path = write(tmp_path / "run.xlsx", q=TABLE)
    history = read_coordinates(path, None, None)
    assert recognise(path).key == "xlsx"
    assert history.mode.tolist() == [3, 8]
    np.testing.assert_allclose(history.time, T, rtol=1e-15)
    np.testing.assert_allclose(history.q, Q.T, rtol=1e-15)  # 16 digits in the file


def test_titles_empty_rows_and_units_above(tmp_path):
    """As post-processors paste them, with an empty column in front."""
    rows = [["Run 7 of the car"], [], ["", "Time", "q_3", "q_8"], ["", "ms", "mm", "mm"]]
    rows += [["", 1e3 * t, a, b] for t, (a, b) in zip(T, Q, strict=True)]
    history = read_coordinates(write(tmp_path / "run.xlsx", q=rows), None, None)
    assert history.unit == ("mm", "mm")
    np.testing.assert_allclose(history.time, T, rtol=1e-15)
    np.testing.assert_allclose(history.q, Q.T, rtol=1e-15)  # 16 digits in the file


def test_sheets_are_groups(tmp_path):
    """Notes are none; other time bases are named where both have coordinates."""
    other = [["time", "q_9"], *zip((T[::2]).tolist(), Q[::2, 0].tolist(), strict=True)]
    path = write(tmp_path / "run.xlsx", notes=[["nothing", "here"]], fast=TABLE, slow=other)
    assert [group.name for group in read_channels(path)] == ["fast", "slow"]
    with pytest.raises(DataError, match="group 'slow'"):
        read_coordinates(path, None, None)


@pytest.mark.parametrize(
    ("cell", "code", "said"),
    [
        ("1,5", "not_a_number", "cell B32: '1,5' stands among the numbers"),
        (datetime.datetime(2026, 3, 4, 5, 6), "date_column", "cell B32: 2026-03-04"),
        (True, "not_a_number", "cell B32: True"),
    ],
)
def test_what_is_no_number_is_refused_by_its_cell(tmp_path, cell, code, said):
    """Text that looks like a number, dates, truth."""
    rows = [list(row) for row in TABLE]
    rows[31][1] = cell
    problem = refused(write(tmp_path / "run.xlsx", q=rows))
    assert problem.code == code
    assert said in str(problem)


def test_an_empty_cell_is_a_missing_sample(tmp_path):
    """Refused by column and sample."""
    rows = [list(row) for row in TABLE]
    rows[31][2] = None
    problem = refused(write(tmp_path / "run.xlsx", q=rows))
    assert problem.code == "not_a_number"
    assert "sample 31" in problem.where
    assert "'q_8'" in problem.what


def test_without_time_or_numbers_it_is_refused(tmp_path):
    """With what is missing."""
    assert refused(write(tmp_path / "a.xlsx", q=[["a", "q_1"], [1.0, 2.0], [3.0, 4.0]])).code == "no_time"
    assert refused(write(tmp_path / "b.xlsx", q=[["a", "b"], ["c", "d"]])).code == "no_channels"


@pytest.mark.parametrize("share", [0.2, 0.6, 0.95])
def test_a_workbook_that_is_cut_is_refused(tmp_path, share):
    """In one line."""
    path = write(tmp_path / "run.xlsx", q=TABLE)
    whole = path.read_bytes()
    path.write_bytes(whole[: int(share * len(whole))])
    assert refused(path).code in ("workbook_damaged", "foreign_format")
