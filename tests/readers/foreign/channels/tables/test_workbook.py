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


NUMBERS = TABLE[1:]
ABOVE = {
    "numbers of modes for names": [["time", 3, 8]],
    "numbers of modes, no names": [["Mode", 3, 8], ["time [s]", "", ""]],
    "frequencies below names": [["time", "q_3", "q_8"], ["Frequency [Hz]", 8.125, 9.25]],
    "frequencies above names": [["Frequency [Hz]", 8.125, 9.25], ["time", "q_3", "q_8"]],
    "a heading over several columns": [["", "Flexible body", ""], ["time", "q_3", "q_8"]],
    "a block of parameters": [["mass", 12, 3], ["speed", 350, 7], ["n", 3, 4], [], ["time", "q_3", "q_8"]],
    "a single parameter": [["Run", 7], ["Line", "north"], ["time", "q_3", "q_8"]],
    "two lines in a cell": [["time\n[s]", "q_3", "q_8"]],
}


@pytest.mark.parametrize("above", ABOVE.values(), ids=ABOVE)
def test_what_stands_above_the_numbers(tmp_path, above):
    """Modes and frequencies are used, whatever else is there is not taken for samples."""
    history = read_coordinates(write(tmp_path / "run.xlsx", q=[*above, *NUMBERS]), None, None)
    assert history.mode.tolist() == [3, 8]
    np.testing.assert_allclose(history.time, T, rtol=1e-15)
    np.testing.assert_allclose(history.q, Q.T, rtol=1e-15)
    if any(row[:1] == ["Frequency [Hz]"] for row in above):
        assert history.frequency.tolist() == [8.125, 9.25]


def test_a_row_of_numbers_that_nobody_explains_is_refused(tmp_path):
    """It may be factors."""
    rows = [["time", "q_3", "q_8"], ["Factor", 1.5, 2.0], *NUMBERS]
    assert "'Factor'" in refused(write(tmp_path / "run.xlsx", q=rows)).what


def test_a_sheet_of_numbers_alone(tmp_path):
    """The first column is time, if it rises evenly; the others have no mode."""
    history = read_coordinates(write(tmp_path / "run.xlsx", q=NUMBERS), None, None)
    assert history.mode.tolist() == [0, 0]
    np.testing.assert_allclose(history.time, T, rtol=1e-15)
    assert refused(write(tmp_path / "b.xlsx", q=[row[1:] for row in NUMBERS])).code == "no_time"


@pytest.mark.parametrize("text", ["{}", "{} ", "1,5"])
def test_a_column_of_numbers_as_text_is_not_lost(tmp_path, text):
    """As a table of another decimal sign becomes."""
    rows = [TABLE[0], *([t, text.format(a), b] for t, a, b in NUMBERS)]
    problem = refused(write(tmp_path / "run.xlsx", q=rows))
    assert problem.code == "not_a_number"
    assert "sheet 'q', cell B2" in problem.where


def test_a_column_of_remarks_is_left_out(tmp_path):
    """And told."""
    rows = [[*TABLE[0], "remark"], *([*row, "door opens" if k == 4 else None] for k, row in enumerate(NUMBERS))]
    history = read_coordinates(write(tmp_path / "run.xlsx", q=rows), None, None)
    assert history.mode.tolist() == [3, 8]
    assert "sheet 'q', column D" in history.warnings[0].where


def test_a_first_sample_that_is_missing_hides_no_column(tmp_path):
    """The column is one of numbers all the same."""
    rows = [list(row) for row in TABLE]
    rows[1][1] = None
    problem = refused(write(tmp_path / "run.xlsx", q=rows))
    assert problem.code == "not_a_number"
    assert "sample 1" in problem.where


def test_hidden_sheets_are_left_out(tmp_path):
    """They hold what nobody looks at; it is told."""
    path = tmp_path / "run.xlsx"
    with xlsxwriter.Workbook(path) as book:
        for name, factor in (("seen", 1), ("old", 2)):
            sheet = book.add_worksheet(name)
            for r, row in enumerate([TABLE[0], *(np.array(NUMBERS) * factor).tolist()]):
                sheet.write_row(r, 0, row)
        sheet.hide()
    history = read_coordinates(path, None, None)
    np.testing.assert_allclose(history.q, Q.T, rtol=1e-15)
    assert "hidden sheets are left out: 'old'" in history.warnings[0].what


@pytest.mark.parametrize("name", ["run.xls", "run.csv", "run.dat"])
def test_the_name_of_the_file_says_nothing(tmp_path, name):
    """A workbook is told by its content."""
    write(tmp_path / "run.xlsx", q=TABLE).rename(tmp_path / name)
    assert read_coordinates(tmp_path / name, None, None).mode.tolist() == [3, 8]


def test_a_stray_cell_at_the_end_of_a_sheet(tmp_path):
    """It would have all empty cells before it filled; one not far away does no harm."""
    for place, row, column in (("near", 300_000, 5), ("far", 1_048_575, 16_383)):
        path = tmp_path / f"{place}.xlsx"
        with xlsxwriter.Workbook(path) as book:
            sheet = book.add_worksheet("q")
            for r, cells in enumerate(TABLE):
                sheet.write_row(r, 0, cells)
            sheet.write(row, column, "x")
    assert read_coordinates(tmp_path / "near.xlsx", None, None).mode.tolist() == [3, 8]
    assert "row 1048576 and column XFD" in refused(tmp_path / "far.xlsx").what


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
