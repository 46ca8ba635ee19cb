"""The table of columns of solid welds: what is read, and every mistake in it with its words."""

import numpy as np
import pandas as pd
import pytest

from fatigue.errors import DataError
from fatigue.readers.neutral.body.columns import read_columns
from fatigue.readers.neutral.body.mesh import Mesh
from fatigue.weld.line import WeldLine, stacked

ORDERS, HEIGHTS = [10, 20, 30], [-4.0, 0.0, 4.0]


def lines(**changes):
    """Two welds of three stations, 8 mm thick; the first one is of solids."""
    found = []
    for i, weld in enumerate(["solid", "shell"]):
        columns = {
            "order": np.array(ORDERS),
            "node": 100 * i + np.array([13, 23, 33]),
            "xyz": np.array([[x, 50.0 * i, 0.0] for x in (0.0, 10, 25)]),
            "thickness": np.full(3, 8.0),
            "normal": np.tile([0.0, 0, 2], (3, 1)),
            "outward": np.tile([0.0, 1, 0], (3, 1)),
            "edge_mid": np.zeros(3, dtype=bool),
        }
        columns |= changes if i == 0 else {}
        found.append(WeldLine(weld=weld, part=1, closed=False, end_length=None, **columns))
    return stacked(found)


def table():
    """Columns of three nodes, in the order of the file from the last station to the first."""
    rows = [("solid", ORDERS[i], 10 * (i + 1) + k + 1) for i in (2, 1, 0) for k in (1, 0, 2)]
    return pd.DataFrame(rows, columns=["weld", "order", "node"])


def mesh():
    """Positions of the nodes of the columns."""
    node = np.array([10 * (i + 1) + k + 1 for i in range(3) for k in range(3)])
    xyz = np.array([[x, 0.0, z] for x in (0.0, 10, 25) for z in HEIGHTS])
    none = np.zeros(0, dtype=np.int64)
    return Mesh(node, xyz, none, np.zeros((0, 8), dtype=np.int64), none, np.zeros(0))


def read(folder, rows, of=None, nodes="mesh", strict=False):
    """Read a table as a file."""
    path = folder / "weld_columns.csv"
    rows.to_csv(path, index=False)
    return read_columns(path, lines() if of is None else of, mesh() if nodes == "mesh" else nodes, strict=strict)


def problem(folder, rows, **more):
    """Code, place, words and remedy of the only mistake of a table."""
    with pytest.raises(DataError) as caught:
        read(folder, rows, **more)
    (found,) = caught.value.problems
    return found.code, found.where, found.what, found.remedy


def with_positions(rows):
    """Add the positions to the table itself."""
    place = dict(zip(mesh().node.tolist(), mesh().xyz.tolist(), strict=True))
    xyz = np.array([place[node] for node in rows["node"]])
    return rows.assign(x_mm=xyz[:, 0], y_mm=xyz[:, 1], z_mm=xyz[:, 2])


def test_columns_are_found_whatever_the_order_of_the_rows(tmp_path):
    """Rows of the last station first; the weld of shells has no rows and no columns."""
    welds, warnings = read(tmp_path, table())
    assert list(welds) == ["solid"]
    assert not warnings
    assert welds["solid"].station.tolist() == [13, 23, 33]
    assert sorted(welds["solid"].columns.of(1).tolist()) == [21, 22, 23]
    assert welds["solid"].columns.begin.tolist() == [0, 3, 6, 9]


def test_positions_may_stand_in_the_table(tmp_path):
    """Without the nodes of the case, and with them where both agree."""
    for nodes in (None, "mesh"):
        welds, _ = read(tmp_path, with_positions(table()), nodes=nodes)
        assert np.ptp(welds["solid"].columns.xyz[:, 2]) == 8.0


def test_no_positions_at_all(tmp_path):
    """Neither table says where the nodes are."""
    code, where, _, remedy = problem(tmp_path, table(), nodes=None)
    assert (code, where) == ("no_positions", "weld_columns.csv")
    assert "[body] nodes" in remedy


def test_one_of_three_coordinates(tmp_path):
    """Two coordinates are no position."""
    code, where, *_ = problem(tmp_path, with_positions(table()).drop(columns="z_mm"))
    assert (code, where) == ("missing_column", "weld_columns.csv: column z_mm")


def test_a_node_elsewhere_than_in_the_table_of_nodes(tmp_path):
    """The two tables are of two meshes."""
    rows = with_positions(table())
    rows.loc[4, "x_mm"] += 0.5
    code, where, what, _ = problem(tmp_path, rows)
    assert (code, where) == ("moved_node", "weld_columns.csv: column x_mm, row 5")
    assert "0.5 mm away" in what


@pytest.mark.parametrize(
    ("column", "value", "code", "words"),
    [
        ("weld", "seam", "unknown_id", "'seam' is not one of the welds"),
        ("order", 25, "unknown_id", "weld solid has no station of order 25"),
        ("node", 999, "unknown_node", "node 999 has no position"),
        ("node", 21, "duplicate", "weld solid, node 21 repeats row"),
    ],
)
def test_a_wrong_cell(tmp_path, column, value, code, words):
    """One cell of one row is wrong: row 8, a node of the first station."""
    rows = table()
    rows.loc[7, column] = value
    found = problem(tmp_path, rows)
    assert found[0] == code
    assert "row 8" in found[1]
    assert words in found[2]


def test_a_station_without_column(tmp_path):
    """A weld is of solids along all its length."""
    code, where, what, _ = problem(tmp_path, table()[lambda rows: rows["order"] != 20])
    assert (code, where) == ("no_column", "weld_columns.csv: weld solid")
    assert "the station of order 20 has no column" in what


def test_a_column_of_one_node(tmp_path):
    """A shell in the table of columns."""
    code, _, what, _ = problem(tmp_path, table()[lambda rows: ~rows["node"].isin([21, 22])])
    assert code == "short_column"
    assert "the column at order 20 is one node, 23" in what


def test_the_node_of_the_station_is_another_column_s(tmp_path):
    """weld_nodes and weld_columns are numbered by two meshes."""
    code, _, what, _ = problem(tmp_path, table(), of=lines(node=np.array([13, 33, 23])))
    assert code == "foreign_column"
    assert "node 33 of weld_nodes is not in the column at order 20 (and 1 more)" in what


def test_coordinates_of_the_toe_instead_of_the_middle(tmp_path):
    """The moment would be about the surface: refused, with what to do."""
    at = lines().xyz[:3] + np.array([0, 0, 4.0])
    code, where, what, remedy = problem(tmp_path, table(), of=lines(xyz=at))
    assert (code, where) == ("column_off_middle", "weld_columns.csv: weld solid, order 10")
    assert "are at a surface, 4 mm from the middle" in what
    assert "middle between the outer nodes" in remedy


def test_coordinates_a_little_off_the_middle(tmp_path):
    """Rounded coordinates are a doubt, not a mistake."""
    _, warnings = read(tmp_path, table(), of=lines(xyz=lines().xyz[:3] + np.array([0, 0, 0.3])))
    assert [warning.code for warning in warnings] == ["column_off_middle"]


@pytest.mark.parametrize(
    ("thickness", "words"), [(0.008, "Give positions and thickness both in mm"), (12.0, "from surface to surface")]
)
def test_another_thickness_than_the_columns_reach(tmp_path, thickness, words):
    """Metres for millimetres, and a layer that is not listed."""
    code, _, what, remedy = problem(tmp_path, table(), of=lines(thickness=np.full(3, thickness)))
    assert code == "column_thickness"
    assert "8 mm apart along the normal" in what
    assert words in remedy


def test_a_thickness_a_little_off_is_a_doubt(tmp_path):
    """3 % more than the outer nodes are apart."""
    _, warnings = read(tmp_path, table(), of=lines(thickness=np.full(3, 8.24)))
    assert [warning.code for warning in warnings] == ["column_thickness"]


@pytest.mark.parametrize(("degrees", "refused"), [(3.0, None), (8.0, False), (30.0, True)])
def test_a_leaning_column(tmp_path, degrees, refused):
    """Up to 5 degrees is no matter, beyond 20 the column is not of this plate."""
    a = np.radians(degrees)
    of = lines(normal=np.tile([0.0, np.sin(a), np.cos(a)], (3, 1)), thickness=np.full(3, 8.0 * np.cos(a)))
    if refused:
        code, _, what, _ = problem(tmp_path, table(), of=of)
        assert code == "leaning_column"
        assert "leans by 30 degrees" in what
    else:
        _, warnings = read(tmp_path, table(), of=of)
        assert [warning.code for warning in warnings] == ([] if refused is None else ["leaning_column"])


@pytest.mark.parametrize(("aside", "refused"), [(0.1, None), (0.8, False), (4.0, True)])
def test_a_bent_column(tmp_path, aside, refused):
    """A node off the line through the outer ones: of another column, where it is far off."""
    nodes = mesh()
    nodes.xyz[4, 0] += aside  # node 22, the middle one of the second column
    if refused:
        code, where, what, _ = problem(tmp_path, table(), nodes=nodes)
        assert (code, where) == ("bent_column", "weld_columns.csv: weld solid, order 20")
        assert "4 mm off the line" in what
    else:
        _, warnings = read(tmp_path, table(), nodes=nodes)
        assert [warning.code for warning in warnings] == ([] if refused is None else ["bent_column"])


def test_a_column_that_lacks_a_node_is_told(tmp_path):
    """Its force would be missing, and the outer nodes alone do not show it."""
    _, warnings = read(tmp_path, table()[lambda rows: rows["node"] != 22])
    (found,) = warnings
    assert found.code == "uneven_columns"
    assert "the column at order 20 has 2 nodes, others have 3" in found.what


def test_corner_columns_without_their_mid_side_nodes_are_told(tmp_path):
    """A parabolic brick has a node between two layers at its corners, and none above its mid-side nodes."""
    of = lines(edge_mid=np.array([False, True, False]))
    _, warnings = read(tmp_path, table()[lambda rows: rows["node"] != 22], of=of)
    assert not warnings
    _, warnings = read(tmp_path, table()[lambda rows: ~rows["node"].isin([12, 22, 32])], of=of)
    (found,) = warnings
    assert found.code == "uneven_columns"
    assert "List the mid-side nodes between layers at corner stations too: 3 nodes" in found.remedy


def test_a_station_at_the_bottom_node_is_told(tmp_path):
    """The normal is turned, or top and bottom are confused."""
    _, warnings = read(tmp_path, table(), of=lines(normal=np.tile([0.0, 0, -1], (3, 1))))
    (found,) = warnings
    assert found.code == "not_top_node"
    assert "node 13 of weld_nodes is not at the top, where the normal points to: node 11 is (and 2 more)" in found.what


def test_an_unknown_column_is_a_mistake_where_strict(tmp_path):
    """As in every table."""
    rows = table().assign(layer=1)
    _, warnings = read(tmp_path, rows)
    assert [warning.code for warning in warnings] == ["unknown_column"]
    assert problem(tmp_path, rows, strict=True)[0] == "unknown_column"
