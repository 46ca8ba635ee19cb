"""Element forces and the elements of the assessed sides: ids, sign and scale, and what is wrong with either table."""

import numpy as np
import pyarrow as pa
import pytest

from fatigue.errors import DataError
from fatigue.readers.neutral.body.welds import Weld
from fatigue.readers.neutral.forces.convention import COMPONENTS
from fatigue.readers.neutral.forces.element_forces import read_element_forces, read_weld_elements
from tests.readers.neutral_tables import changed, small_body, without, write

SUFFIXES = pytest.mark.parametrize("suffix", [".csv", ".parquet"])
ELEMENT_FORCES = {
    "mode": [3, 3, 7, 7, 12, 12],
    "node": [11, 12, 11, 12, 11, 12],
    "element": [5] * 6,
} | {name: [float(10 * row + i) for row in range(6)] for i, name in enumerate(COMPONENTS)}


@pytest.fixture(scope="module")
def body(tmp_path_factory):
    """Modes and lines of the small body."""
    return small_body(tmp_path_factory.mktemp("body"))


@SUFFIXES
def test_element_forces(tmp_path, suffix):
    """Rows keep their ids; sign and scale are those of their mode; ignored modes are left out."""
    modes, _ = small_body(tmp_path, ignore_modes=(12,), scale=[2.0, 1.0, 1.0])
    path = write(tmp_path / f"e{suffix}", ELEMENT_FORCES)
    read, warnings = read_element_forces(path, modes, "on_node", (12,), strict=True)
    assert warnings == []
    assert read.mode.tolist() == [3, 3, 7, 7]
    assert read.node.tolist() == [11, 12, 11, 12]
    assert read.element.tolist() == [5] * 4
    factor = np.array([-1.0, -1.0, -2.0, -2.0])[:, None]
    np.testing.assert_array_equal(read.force, factor * (10.0 * np.arange(4)[:, None] + np.arange(6)))


def test_element_forces_in_single_precision(tmp_path, body):
    """Single precision stays single."""
    path = write(tmp_path / "e.parquet", ELEMENT_FORCES, dict.fromkeys(COMPONENTS, pa.float32()))
    assert read_element_forces(path, body[0], "on_element", (), strict=True)[0].force.dtype == np.float32


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        (
            without(ELEMENT_FORCES, "element"),
            "column element: the column is missing. Add it; the columns are mode, node,",
        ),
        (changed(ELEMENT_FORCES, "mode", 4, 8), "column mode, row 4: modes 8 are not in the table of modes. Add them"),
        (
            changed(ELEMENT_FORCES, "node", 4, 11),
            "column mode, node, element, row 4: mode 7, node 11, element 5 repeats row 3. Keep one of the rows.",
        ),
        (
            changed(ELEMENT_FORCES, "mx_Nmm", 4, None),
            "column mx_Nmm, row 4: the value is missing or NaN. Give a number.",
        ),
    ],
)
def test_bad_element_forces(tmp_path, body, columns, message):
    """Ids and values of the raw form are checked alike."""
    with pytest.raises(DataError) as refusal:
        read_element_forces(write(tmp_path / "e.csv", columns), body[0], "on_element", (), strict=False)
    assert str(refusal.value).startswith(f"e.csv: {message}")


WELD_LIST = tuple(Weld(name, False, "both", None, None, "") for name in ("seam", "ring"))


@SUFFIXES
def test_weld_elements(tmp_path, suffix):
    """The elements of each weld, ascending; an element may serve two welds."""
    path = write(tmp_path / f"e{suffix}", {"weld": ["ring", "seam", "ring"], "element": [9, 4, 4]})
    read, _ = read_weld_elements(path, WELD_LIST, strict=True)
    assert {name: elements.tolist() for name, elements in read.items()} == {"ring": [4, 9], "seam": [4]}


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        ({"weld": ["seam"], "element": [1]}, "column weld: weld 'ring' has no elements. Add its elements."),
        (
            {"weld": ["seam", "ring", "rig"], "element": [1, 2, 3]},
            "column weld, row 3: 'rig' is not one of the welds. Write 'ring'.",
        ),
        (
            {"weld": ["seam", "ring", "seam"], "element": [1, 2, 1]},
            "column weld, element, row 3: weld seam, element 1 repeats row 1. Keep one of the rows.",
        ),
        ({"weld": ["seam"]}, "column element: the column is missing. Add it; the columns are weld."),
    ],
)
def test_bad_weld_elements(tmp_path, columns, message):
    """Every weld has elements, each of them once."""
    with pytest.raises(DataError) as refusal:
        read_weld_elements(write(tmp_path / "e.csv", columns), WELD_LIST, strict=False)
    assert str(refusal.value) == f"e.csv: {message}"
