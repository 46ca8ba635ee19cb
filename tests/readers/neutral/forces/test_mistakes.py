"""What is said of rows of forces that are too many, too few, or somewhere else."""

import pytest

from fatigue.errors import DataError
from fatigue.readers.neutral.body.modes import read_modes
from fatigue.readers.neutral.body.welds import read_welds
from fatigue.readers.neutral.forces.mistakes import refuse_misplaced
from fatigue.readers.neutral.forces.placement import RowKeys, slots
from fatigue.readers.neutral.tables import Table, open_table
from tests.readers.neutral_tables import MODES, WELD_NODES, WELDS, nodal_forces, read_weld_nodes, write


@pytest.fixture
def looked_at(tmp_path):
    """Look at rows of the small body: the table, with its warnings."""
    welds, _ = read_welds(write(tmp_path / "w.csv", WELDS), None, strict=True)
    lines, _ = read_weld_nodes(write(tmp_path / "n.csv", WELD_NODES), welds, strict=True)
    modes, _ = read_modes(write(tmp_path / "m.csv", MODES), (), strict=True)

    def look(rows, ignore_modes=()) -> Table:
        columns = {name: [row[k] for row in rows] for k, name in enumerate(("weld", "node", "mode"))}
        table = open_table(write(tmp_path / "f.csv", columns), texts=("weld",))
        keys = RowKeys(*table.groups("weld"), table.integers("node"), table.integers("mode"))
        refuse_misplaced(table, keys, slots(keys, lines, modes), lines, modes, ignore_modes)
        return table

    return look


@pytest.fixture
def rows() -> list[tuple]:
    """Every weld, node and mode once."""
    forces = nodal_forces()
    return list(zip(forces["weld"], forces["node"], forces["mode"], strict=True))


def test_all_rows_once(looked_at, rows):
    """Nothing is said."""
    assert looked_at(rows[::-1]).warnings == []


def test_a_missing_row(looked_at, rows):
    """The first of each line is named, with how many are missing."""
    with pytest.raises(DataError) as refusal:
        looked_at([row for row in rows if row not in (("seam", 12, 7), ("seam", 13, 3), ("ring", 24, 12))])
    assert [problem.where for problem in refusal.value.problems] == [
        "f.csv: weld seam, node 12, mode 7",
        "f.csv: weld ring, node 24, mode 12",
    ]
    assert "2 of the weld's 9 pairs" in refusal.value.problems[0].what


def test_a_repeated_row(looked_at, rows):
    """It is named, although every slot is filled."""
    with pytest.raises(DataError, match=r"f\.csv.*seam.*11.*7"):
        looked_at([*rows, rows[0]])


def test_a_node_off_the_line(looked_at, rows):
    """A warning, with how many rows are not used."""
    (warning,) = looked_at([*rows, ("seam", 99, 3), ("seam", 99, 7)]).warnings
    assert warning.code == "extra_node"
    assert warning.what == "node 99 is not on the line of weld seam; 2 rows of such nodes are not used"


def test_an_unknown_mode(looked_at, rows):
    """Refused unless it is ignored."""
    with pytest.raises(DataError, match=r"modes 8 are not in the table of modes"):
        looked_at([*rows, ("seam", 11, 8)])
    assert looked_at([*rows, ("seam", 11, 8)], (8,)).warnings == []
