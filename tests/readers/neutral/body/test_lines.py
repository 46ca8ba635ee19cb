"""Weld lines: what the file says arrives, and what it says wrong is told."""

import numpy as np
import pytest

from fatigue.readers.neutral.body.welds import read_welds
from tests.readers.neutral_tables import WELD_NODES, WELDS, changed, picked, read_weld_nodes, refusal_of, without, write

SUFFIXES = pytest.mark.parametrize("suffix", [".csv", ".parquet"])


@pytest.fixture
def welds(tmp_path):
    """The welds of the small body."""
    return read_welds(write(tmp_path / "w.csv", WELDS), {"master-steel"}, strict=True)[0]


@SUFFIXES
def test_lines_are_sorted_by_order(tmp_path, welds, suffix):
    """Rows in any order give the lines in the order of the welds, their nodes sorted by ``order``."""
    path = write(tmp_path / f"n{suffix}", picked(WELD_NODES, [5, 2, 7, 3, 1, 6, 4]))
    (seam, ring), warnings = read_weld_nodes(path, welds, strict=True)
    assert warnings == []
    assert (seam.weld, seam.part, seam.closed, seam.end_length) == ("seam", 1, False, 5.0)
    assert (ring.weld, ring.part, ring.closed, ring.end_length) == ("ring", 1, True, None)
    assert seam.node.tolist() == [11, 12, 13]
    assert seam.order.tolist() == [1, 2, 3]
    assert ring.node.tolist() == [21, 22, 23, 24]
    np.testing.assert_array_equal(seam.xyz, [[0, 0, 0], [10, 0, 0], [20, 0, 0]])
    np.testing.assert_array_equal(seam.thickness, [8, 8, 8])
    np.testing.assert_array_equal(seam.normal, [[0, 0, 1]] * 3)
    np.testing.assert_array_equal(ring.outward, [[-1, 0, 0], [0, -1, 0], [1, 0, 0], [0, 1, 0]])
    assert not seam.edge_mid.any()


def test_edge_mid(tmp_path, welds):
    """A parabolic edge is marked by its mid-side node."""
    columns = WELD_NODES | {"edge_mid": [False, True, False, None, None, None, None]}
    (seam, ring), _ = read_weld_nodes(write(tmp_path / "n.csv", columns), welds, strict=True)
    assert seam.edge_mid.tolist() == [False, True, False]
    assert not ring.edge_mid.any()


@SUFFIXES
@pytest.mark.parametrize("name", list(WELD_NODES))
def test_missing_column_of_weld_nodes(tmp_path, welds, suffix, name):
    """Each required column is asked for."""
    message = refusal_of(read_weld_nodes, write(tmp_path / f"n{suffix}", without(WELD_NODES, name)), welds)
    assert message.startswith(f"n{suffix}: column {name}: the column is missing. Add it; the columns are ")


@SUFFIXES
@pytest.mark.parametrize("name", [name for name in WELD_NODES if name not in ("weld", "order", "node")])
@pytest.mark.parametrize(
    ("value", "what"),
    [
        (None, "the value is missing or NaN. Give a number."),
        (float("nan"), "the value is missing or NaN. Give a number."),
        (float("inf"), "inf is not finite. Give a finite number."),
        ("ten", "'ten' is not a number. Give a number."),
    ],
)
def test_bad_number_in_weld_nodes(tmp_path, welds, suffix, name, value, what):
    """Each number of a weld node has to be one."""
    path = write(tmp_path / f"n{suffix}", changed(WELD_NODES, name, 6, value))
    assert refusal_of(read_weld_nodes, path, welds) == f"n{suffix}: column {name}, row 6: {what}"


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        (changed(WELD_NODES, "weld", 2, None), "column weld, row 2: the text is missing. Give a text."),
        (changed(WELD_NODES, "weld", 2, "sea"), "column weld, row 2: 'sea' is not one of the welds. Write 'seam'."),
        (changed(WELD_NODES, "order", 2, 1), "column weld, order, row 2: weld seam, order 1 repeats row 1. Keep one"),
        (changed(WELD_NODES, "node", 7, 21), "column weld, node, row 7: weld ring, node 21 repeats row 4. Keep one of"),
        (changed(WELD_NODES, "node", 7, 2.5), "column node, row 7: 2.5 is not a whole number. Give a whole number."),
        (
            changed(WELD_NODES, "thickness_mm", 7, 0.0),
            "column thickness_mm, row 7: 0 is not above 0. Give more than 0.",
        ),
        (picked(WELD_NODES, [1, 2, 3]), "column weld: weld 'ring' has no nodes. Add its nodes."),
        (
            WELD_NODES | {"edge_mid": ["no"] * 7},
            "column edge_mid, row 1: no is not a flag (and 6 more rows). Give true or",
        ),
    ],
)
def test_bad_weld_nodes(tmp_path, welds, columns, message):
    """Keys and ids of the weld nodes are checked against each other and against the welds."""
    path = write(tmp_path / "n.csv", columns)
    assert refusal_of(read_weld_nodes, path, welds).startswith(f"n.csv: {message}")


def test_unfit_lines_are_refused_together(tmp_path, welds):
    """The geometry of every line is checked, with the file and the weld in the message."""
    columns = changed(changed(WELD_NODES, "normal_z", 1, 0.0), "normal_z", 4, 0.0)
    message = refusal_of(read_weld_nodes, write(tmp_path / "n.csv", columns), welds)
    assert "n.csv: weld seam" in message
    assert "n.csv: weld ring" in message


def test_doubts_about_lines_are_warnings(tmp_path, welds):
    """A line that is fit but crooked is read with a warning."""
    path = write(tmp_path / "n.csv", changed(WELD_NODES, "x_mm", 2, 19.9))
    lines, warnings = read_weld_nodes(path, welds, strict=True)
    assert len(lines) == 2
    assert [(warning.code, "n.csv: weld seam" in warning.where) for warning in warnings] == [("short_edge", True)]
