"""The same mistake in many columns is told once, with its columns."""

import pytest

from fatigue.errors import DataError, Problem
from fatigue.readers.neutral.same_columns import ONE_BY_ONE, column_list, told_once
from fatigue.readers.neutral.tables import open_table


def column_problem(name, rest="", what="the unit is m"):
    """Make a problem of one column."""
    return Problem("unit", f"q.csv: column {name}{rest}", what, "Convert")


def test_neighbours_are_a_span():
    """Names that only count on are written as their first and last; of many places the first are named."""
    assert column_list([f"q_{i}" for i in range(1, 53)]) == "q_1 to q_52"
    assert column_list(["q_1", "q_2", "q_5", "fx_N"]) == "q_1, q_2, q_5, fx_N"
    assert column_list([f"q_{3 * i}" for i in range(20)]).endswith("q_21 and 12 more")
    assert column_list(["q_-3", "q_-2", "q_-1", "q_08", "q_9"]) == "q_-3 to q_-1, q_08, q_9"


def test_few_columns_are_told_one_by_one():
    """Up to a handful stand alone; one more and they are one problem with a count."""
    few = [column_problem(f"q_{i}") for i in range(ONE_BY_ONE)]
    assert told_once(few) == few
    (one,) = told_once([*few, column_problem("q_9")])
    assert one.where == "q.csv: 6 columns, q_0 to q_4, q_9"
    assert one.count == 6


def test_what_differs_stays_apart():
    """Other findings, other files and other codes are no repetition; their order is that of their first."""
    some = [column_problem(f"q_{i}", what=f"the unit is {'m' if i % 2 else 'cm'}") for i in range(8)]
    assert [(p.what, p.count) for p in told_once(some, 1)] == [("the unit is cm", 4), ("the unit is m", 4)]


def test_rows_that_differ():
    """The first row is named where the same is wrong in different rows, all of them where it is one row."""
    rows = [column_problem(f"q_{i}", f", row {i + 1}") for i in range(7)]
    assert told_once(rows)[0].where == "q.csv: 7 columns, q_0 to q_6 (the first: q_0, row 1)"
    same = [column_problem(f"q_{i}", ", row of units") for i in range(7)]
    assert told_once(same)[0].where == "q.csv: 7 columns, q_0 to q_6, row of units"


@pytest.mark.parametrize("count", [2, 52])
def test_a_wrong_unit_in_a_row_of_units(tmp_path, count):
    """All coordinates in m are one line, however many they are."""
    names = ["time_s", *(f"q_{i}" for i in range(1, count + 1))]
    lines = [",".join(names), ",".join(["s", *["m"] * count]), *(",".join(["1"] * len(names)) for _ in range(3))]
    (tmp_path / "q.csv").write_text("\n".join(lines))
    with pytest.raises(DataError) as refusal:
        open_table(tmp_path / "q.csv")
    (problem,) = refusal.value.problems
    assert problem.count == count
    assert f"{count} columns, q_1" in problem.where
    assert "the unit is m, and the column is one of mm" in problem.what


def test_the_same_cell_missing_in_many_columns(tmp_path):
    """A row without values is one mistake."""
    names = [f"q_{i}" for i in range(30)]
    (tmp_path / "q.csv").write_text("\n".join([",".join(names), ",".join("1" * 30), "1" + "," * 29]))
    table = open_table(tmp_path / "q.csv")
    for name in names:
        table.numbers(name)
    with pytest.raises(DataError) as refusal:
        table.refuse()
    assert [problem.where for problem in refusal.value.problems] == ["q.csv: 29 columns, q_1 to q_29, row 2"]
