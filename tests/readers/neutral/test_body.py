"""Modes, welds, weld lines and mesh: what the files say arrives, and what they say wrong is told."""

from pathlib import Path

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.neutral.body import Weld, read_mesh, read_modes, read_welds
from tests.readers.neutral_tables import MODES, WELD_NODES, WELDS, changed, picked, read_weld_nodes, without, write

NODES = {"node": [3, 1, 2, 4], "x_mm": [1.0, 0.0, 1.0, 0.0], "y_mm": [1.0, 0.0, 0.0, 1.0], "z_mm": [0.0] * 4}
ELEMENTS = {"element": [9, 8], "n1": [1, 1], "n2": [2, 2], "n3": [3, 3], "n4": [4, None], "pid": [5, None]}

SUFFIXES = pytest.mark.parametrize("suffix", [".csv", ".parquet"])


def refusal_of(read, *arguments) -> str:
    """Message of the refusal."""
    with pytest.raises(DataError) as refusal:
        read(*arguments, strict=False)
    return str(refusal.value)


@SUFFIXES
def test_modes_are_sorted_by_id(tmp_path, suffix):
    """Modes come in ascending order with their values and the documented defaults."""
    modes, warnings = read_modes(write(tmp_path / f"m{suffix}", MODES), (), strict=True)
    assert modes.mode.tolist() == [3, 7, 12]
    assert modes.frequency.tolist() == [8.0, 12.5, 90.0]
    assert modes.kind == ("normal", "normal", "interface")
    assert np.isnan(modes.damping_ratio).all()
    assert modes.modal_mass.tolist() == [1.0, 1.0, 1.0]
    assert modes.scale.tolist() == [1.0, 1.0, 1.0]
    assert warnings == []


@SUFFIXES
def test_optional_columns_of_modes(tmp_path, suffix):
    """Empty cells take the defaults, others their values."""
    extra = {"damping_ratio": [0.02, None, 0.0], "modal_mass": [None, 2.0, 1.0], "scale": [-2.0, None, 0.5]}
    modes, _ = read_modes(write(tmp_path / f"m{suffix}", MODES | extra), (), strict=True)
    np.testing.assert_array_equal(modes.damping_ratio, [np.nan, 0.02, 0.0])
    assert modes.modal_mass.tolist() == [2.0, 1.0, 1.0]
    assert modes.scale.tolist() == [1.0, -2.0, 0.5]


def test_ignored_modes_are_left_out(tmp_path):
    """Ignored modes disappear; ids that no table has may be listed."""
    modes, _ = read_modes(write(tmp_path / "m.csv", MODES), (3, 99), strict=True)
    assert modes.mode.tolist() == [7, 12]
    message = refusal_of(read_modes, tmp_path / "m.csv", (3, 7, 12))
    assert message == "m.csv: ignore_modes leaves no mode. Take modes out of ignore_modes."


@pytest.mark.parametrize("modes", [without(MODES, "kind"), changed(MODES, "kind", 3, "rigid")])
def test_no_interface_mode_is_a_warning(tmp_path, modes):
    """Without interface modes local welds lose their force, so the user is told."""
    _, warnings = read_modes(write(tmp_path / "m.csv", modes), (), strict=True)
    assert [warning.code for warning in warnings] == ["no_interface_mode"]
    assert str(warnings[0]).startswith(
        "m.csv: column kind: none of the 3 modes is an interface mode, so welds near local"
    )


@SUFFIXES
@pytest.mark.parametrize(
    ("columns", "message"),
    [
        (without(MODES, "mode"), "column mode: the column is missing. Add it; the columns are frequency_hz, kind."),
        (changed(MODES, "mode", 2, 7), "column mode, row 2: mode 7 repeats row 1. Keep one of the rows."),
        (changed(MODES, "mode", 2, 3.5), "column mode, row 2: 3.5 is not a whole number. Give a whole number."),
        (changed(MODES, "frequency_hz", 3, -1.0), "column frequency_hz, row 3: -1 is below 0. Give at least 0."),
        (changed(MODES, "frequency_hz", 3, None), "column frequency_hz, row 3: the value is missing or NaN. Give a"),
        (
            changed(MODES, "frequency_hz", 3, float("inf")),
            "column frequency_hz, row 3: inf is not finite. Give a finite",
        ),
        (changed(MODES, "frequency_hz", 1, "f"), "column frequency_hz, row 1: 'f' is not a number. Give a number."),
        (
            changed(MODES, "kind", 3, "residual"),
            "column kind, row 3: 'residual' is not one of normal, interface, rigid. Give one of normal, interface,",
        ),
        (
            MODES | {"scale": [1.0, 0.0, 1.0]},
            "column scale, row 2: 0 takes the mode out. List the mode under ignore_modes",
        ),
        (MODES | {"modal_mass": [1.0, 0.0, 1.0]}, "column modal_mass, row 2: 0 is not above 0. Give more than 0."),
        (MODES | {"damping_ratio": [0.1, 0.1, -0.1]}, "column damping_ratio, row 3: -0.1 is below 0. Give at least 0."),
    ],
)
def test_bad_modes(tmp_path, suffix, columns, message):
    """Every mistake in the modes names file, column, row and value."""
    path = write(tmp_path / f"m{suffix}", columns)
    assert refusal_of(read_modes, path, ()).startswith(f"m{suffix}: {message}")


@SUFFIXES
def test_welds(tmp_path, suffix):
    """Welds come in the order of the file; what is empty takes its default."""
    welds, warnings = read_welds(write(tmp_path / f"w{suffix}", WELDS), {"master-steel"}, strict=True)
    assert welds == (
        Weld("seam", closed=False, surface="top", curve=None, end_length=5.0, description="a straight seam"),
        Weld("ring", closed=True, surface="both", curve="master-steel", end_length=None, description=""),
    )
    assert warnings == []


def test_welds_by_name_only(tmp_path):
    """Nothing but the name is needed."""
    welds, _ = read_welds(write(tmp_path / "w.csv", {"weld": ["b", "a"]}), (), strict=True)
    assert welds == tuple(Weld(name, False, "both", None, None, "") for name in "ba")


@SUFFIXES
@pytest.mark.parametrize(
    ("columns", "message"),
    [
        (without(WELDS, "weld"), "column weld: the column is missing. Add it; the columns are closed, surface, curve,"),
        (changed(WELDS, "weld", 2, "seam"), "column weld, row 2: weld seam repeats row 1. Keep one of the rows."),
        (changed(WELDS, "weld", 2, None), "column weld, row 2: the text is missing. Give a text."),
        (changed(WELDS, "closed", 1, "maybe"), "column closed, row 1: maybe is not a flag. Give true or false."),
        (
            changed(WELDS, "surface", 2, "above"),
            "column surface, row 2: 'above' is not one of top, bottom, both. Give one of top, bottom, both.",
        ),
        (changed(WELDS, "end_length_mm", 2, -1.0), "column end_length_mm, row 2: -1 is below 0. Give at least 0."),
        (
            changed(WELDS, "curve", 2, "master-steal"),
            "column curve, row 2: 'master-steal' is not one of the curves. Write 'master-steel'.",
        ),
        (
            changed(WELDS, "curve", 2, "x"),
            "column curve, row 2: 'x' is not one of the curves. Add it to the curves or remove its rows.",
        ),
    ],
)
def test_bad_welds(tmp_path, suffix, columns, message):
    """Every mistake in the welds names file, column, row and value."""
    path = write(tmp_path / f"w{suffix}", columns)
    assert refusal_of(read_welds, path, {"master-steel"}).startswith(f"w{suffix}: {message}")


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


@SUFFIXES
def test_mesh(tmp_path, suffix):
    """Nodes and elements come sorted by id; corners that an element lacks are 0."""
    nodes, elements = write(tmp_path / f"n{suffix}", NODES), write(tmp_path / f"e{suffix}", ELEMENTS)
    mesh, warnings = read_mesh(nodes, elements, strict=True)
    assert warnings == []
    assert mesh.node.tolist() == [1, 2, 3, 4]
    assert mesh.xyz.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    assert mesh.element.tolist() == [8, 9]
    assert mesh.corners.tolist() == [[1, 2, 3, 0, 0, 0, 0, 0], [1, 2, 3, 4, 0, 0, 0, 0]]
    assert mesh.pid.tolist() == [0, 5]
    assert np.isnan(mesh.thickness).all()


def test_mesh_without_elements(tmp_path):
    """Nodes alone serve the balance check."""
    mesh, _ = read_mesh(write(tmp_path / "n.csv", NODES), None, strict=True)
    assert mesh.node.size == 4
    assert mesh.element.size == 0
    assert mesh.corners.shape == (0, 8)


@pytest.mark.parametrize(
    ("nodes", "elements", "message"),
    [
        (
            changed(NODES, "node", 2, 3),
            ELEMENTS,
            "n.csv: column node, row 2: node 3 repeats row 1. Keep one of the rows.",
        ),
        (changed(NODES, "x_mm", 2, None), ELEMENTS, "n.csv: column x_mm, row 2: the value is missing or NaN. Give a"),
        (
            without(NODES, "z_mm"),
            ELEMENTS,
            "n.csv: column z_mm: the column is missing. Add it; the columns are node, x",
        ),
        (
            NODES,
            without(ELEMENTS, "n3"),
            "e.csv: column n3: the column is missing. Add it; the columns are element, n1",
        ),
        (
            NODES,
            changed(ELEMENTS, "element", 2, 9),
            "e.csv: column element, row 2: element 9 repeats row 1. Keep one of",
        ),
        (
            NODES,
            changed(ELEMENTS, "n4", 1, 77),
            "e.csv: column n4, row 1: node 77 is not in n.csv. Add the node there.",
        ),
        (NODES, changed(ELEMENTS, "n1", 2, 0), "e.csv: column n1, row 2: node 0 is not in n.csv. Add the node there."),
        (
            NODES,
            changed(ELEMENTS, "n2", 2, None),
            "e.csv: column n2, row 2: the value is missing or NaN. Give a number.",
        ),
        (
            NODES,
            ELEMENTS | {"thickness_mm": [1.0, 0.0]},
            "e.csv: column thickness_mm, row 2: 0 is not above 0. Give more",
        ),
    ],
)
def test_bad_mesh(tmp_path, nodes, elements, message):
    """Ids of the mesh are unique and known."""
    found = refusal_of(read_mesh, write(tmp_path / "n.csv", nodes), write(tmp_path / "e.csv", elements))
    assert found.startswith(message)


@pytest.mark.parametrize("read", [lambda p, s: read_modes(p, (), strict=s), lambda p, s: read_welds(p, (), strict=s)])
def test_unknown_columns(tmp_path, read):
    """An unknown column is a warning, and an error where strict."""
    columns = {"mode": [1], "frequency_hz": [2.0], "kind": ["interface"], "weld": ["a"], "colour": ["red"]}
    path: Path = write(tmp_path / "t.csv", columns)
    _, warnings = read(path, False)
    assert "t.csv: column colour: the column is unknown and not read. Remove it." in map(str, warnings)
    with pytest.raises(DataError, match="column colour: the column is unknown"):
        read(path, True)


def test_shipped_body():
    """The shipped car body reads without a single warning."""
    folder = Path("data/carbody")
    modes, doubts = read_modes(folder / "modes.csv", (), strict=True)
    welds, more = read_welds(folder / "welds.csv", (), strict=True)
    lines, still_more = read_weld_nodes(folder / "weld_nodes.csv", welds, strict=True)
    mesh, last = read_mesh(folder / "nodes.parquet", folder / "elements.parquet", strict=True)
    assert doubts + more + still_more + last == []
    assert (modes.mode.size, modes.kind.count("interface"), len(welds)) == (52, 22, 14)
    assert (mesh.node.size, mesh.element.size) == (15734, 15492)
    assert [weld.name for weld in welds if weld.closed] == ["W4_roof_stub_loop"]
    at = np.searchsorted(mesh.node, np.concatenate([line.node for line in lines]))
    np.testing.assert_allclose(np.concatenate([line.xyz for line in lines]), mesh.xyz[at], atol=1e-3)
