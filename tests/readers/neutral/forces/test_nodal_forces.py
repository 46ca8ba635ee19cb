"""Modal nodal forces: every row finds its place, sign and scale are applied once, every gap is told."""

from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.errors import DataError
from fatigue.readers.neutral.body.modes import read_modes
from fatigue.readers.neutral.body.welds import read_welds
from fatigue.readers.neutral.forces import nodal_forces as module
from fatigue.readers.neutral.forces import placement
from fatigue.readers.neutral.forces.convention import COMPONENTS
from fatigue.readers.neutral.forces.element_forces import read_element_forces, read_weld_elements
from fatigue.readers.neutral.forces.nodal_forces import check_nodal_forces, open_nodal_forces, read_nodal_forces
from fatigue.weld.element_forces import side_forces
from tests.readers.neutral_tables import (
    WELD_NODES,
    changed,
    nodal_forces,
    picked,
    read_weld_nodes,
    small_body,
    without,
    write,
)

SUFFIXES = pytest.mark.parametrize("suffix", [".csv", ".parquet"])
FORCES = nodal_forces()
ROWS = len(FORCES["node"])


def read_forces(path, lines, *rest, strict):
    """Open and read a table of nodal forces; those of each line apart."""
    forces, warnings = read_nodal_forces(open_nodal_forces(path), lines, *rest, strict=strict)
    return np.split(forces, lines.begin[1:-1]), warnings


@pytest.fixture(scope="module")
def body(tmp_path_factory):
    """Modes and lines of the small body."""
    return small_body(tmp_path_factory.mktemp("body"))


def expected(lines, modes) -> list[np.ndarray]:
    """Forces of the small body by their own rule."""
    return [
        (1000.0 * line.node[:, None, None] + 10.0 * modes.mode[:, None] + np.arange(6)).astype(np.float64)
        for line in lines
    ]


def refusal_of(path, body, ignore_modes=()) -> str:
    """Message of the refusal."""
    modes, lines = body
    with pytest.raises(DataError) as refusal:
        read_forces(path, lines, modes, "on_element", ignore_modes, strict=False)
    with pytest.raises(DataError) as checked:
        check_nodal_forces(open_nodal_forces(path), lines, modes, ignore_modes, strict=False)
    assert str(checked.value) == str(refusal.value)
    return str(refusal.value)


@SUFFIXES
def test_nodal_forces(tmp_path, body, suffix):
    """Nodes in the order of the line, modes in ascending order, components as in the header."""
    modes, lines = body
    read, warnings = read_forces(write(tmp_path / f"f{suffix}", FORCES), lines, modes, "on_element", (), strict=True)
    assert warnings == []
    assert [force.dtype for force in read] == [np.float64] * 2
    for force, wanted in zip(read, expected(lines, modes), strict=True):
        np.testing.assert_array_equal(force, wanted)


def test_sign_and_scale(tmp_path):
    """on_node forces change sign; each mode has its own scale; nothing else changes."""
    modes, lines = small_body(tmp_path, scale=[2.0, -3.0, 1.0])
    read, _ = read_forces(write(tmp_path / "f.csv", FORCES), lines, modes, "on_node", (), strict=True)
    factor = -np.array([-3.0, 2.0, 1.0])[:, None]  # modes 3, 7, 12
    for force, wanted in zip(read, expected(lines, modes), strict=True):
        np.testing.assert_array_equal(force, wanted * factor)


@pytest.mark.parametrize(("double", "dtype"), [((), np.float32), (("mz_Nmm",), np.float64)])
def test_precision_of_the_file_is_kept(tmp_path, body, double, dtype):
    """Single precision stays single unless one component is stored in double precision."""
    modes, lines = body
    types = {name: pa.float64() if name in double else pa.float32() for name in COMPONENTS}
    read, _ = read_forces(write(tmp_path / "f.parquet", FORCES, types), lines, modes, "on_node", (), strict=True)
    assert {force.dtype for force in read} == {np.dtype(dtype)}
    np.testing.assert_array_equal(read[0], -expected(lines, modes)[0])


@settings(deadline=None, max_examples=25)
@given(
    rows=st.permutations(range(1, ROWS + 1)),
    names=st.permutations(list(FORCES)),
    suffix=st.sampled_from([".csv", ".parquet"]),
)
def test_any_row_and_column_order(tmp_path_factory, body, rows, names, suffix):
    """What was written comes back whatever the order of rows and columns."""
    modes, lines = body
    shuffled = picked(FORCES, rows)
    path = write(tmp_path_factory.mktemp("f") / f"f{suffix}", {name: shuffled[name] for name in names})
    read, _ = read_forces(path, lines, modes, "on_element", (), strict=True)
    for force, wanted in zip(read, expected(lines, modes), strict=True):
        np.testing.assert_array_equal(force, wanted)


@SUFFIXES
@pytest.mark.parametrize("slow", ["node", "mode"])
@pytest.mark.parametrize("ignored", [False, True])
def test_a_regular_table_needs_no_search(tmp_path, body, monkeypatch, suffix, slow, ignored):
    """Node by node or mode by mode, nodes and modes in any order, ignored modes among them: same forces."""
    modes, lines = body
    monkeypatch.setattr(module, "slots", None)
    nodes, ids = [5, 2, 1, 7, 4, 3, 6], [12, 3, 7] + [40] * ignored
    keys = [(n, m) for n in nodes for m in ids] if slow == "node" else [(n, m) for m in ids for n in nodes]
    columns = {
        "weld": [WELD_NODES["weld"][n - 1] for n, _ in keys],
        "node": [WELD_NODES["node"][n - 1] for n, _ in keys],
        "mode": [m for _, m in keys],
    }
    for i, name in enumerate(COMPONENTS):
        columns[name] = [1000.0 * WELD_NODES["node"][n - 1] + 10.0 * m + i for n, m in keys]
    path = write(tmp_path / f"f{suffix}", columns)
    read, warnings = read_forces(path, lines, modes, "on_element", (40,), strict=True)
    assert warnings == []
    for force, wanted in zip(read, expected(lines, modes), strict=True):
        np.testing.assert_array_equal(force, wanted)


def test_lookup_in_blocks(tmp_path, body, monkeypatch):
    """Rows are looked up in blocks; where they are cut does not matter."""
    modes, lines = body
    monkeypatch.setattr(placement, "BLOCK", 4)
    read, _ = read_forces(write(tmp_path / "f.csv", FORCES), lines, modes, "on_element", (), strict=True)
    for force, wanted in zip(read, expected(lines, modes), strict=True):
        np.testing.assert_array_equal(force, wanted)


def test_ignored_modes(tmp_path):
    """Rows of ignored modes may be present or not."""
    modes, lines = small_body(tmp_path, ignore_modes=(7, 40))
    of_seven = [row for row in range(1, ROWS + 1) if FORCES["mode"][row - 1] == 7]
    absent = picked(FORCES, [row for row in range(1, ROWS + 1) if row not in of_seven])
    for columns in (FORCES, absent, changed(FORCES, "mode", of_seven[0], 40)):
        read, warnings = read_forces(
            write(tmp_path / "f.csv", columns), lines, modes, "on_element", (7, 40), strict=True
        )
        assert warnings == []
        for force, wanted in zip(read, expected(lines, modes), strict=True):
            np.testing.assert_array_equal(force, wanted)


def test_a_node_may_belong_to_several_welds(tmp_path):
    """Forces are looked up by weld and node, not by node alone."""
    shared = changed(WELD_NODES, "node", 4, 11)
    modes, _ = small_body(tmp_path)
    welds, _ = read_welds(tmp_path / "w.csv", {"master-steel"}, strict=True)
    lines, _ = read_weld_nodes(write(tmp_path / "n.csv", shared), welds, strict=True)
    columns = dict(FORCES)
    columns["node"] = [11 if node == 21 else node for node in FORCES["node"]]
    read, _ = read_forces(write(tmp_path / "f.csv", columns), lines, modes, "on_element", (), strict=True)
    np.testing.assert_array_equal(read[0][0, :, 0], 11_000 + 10 * modes.mode)
    np.testing.assert_array_equal(read[1][0, :, 0], 21_000 + 10 * modes.mode)


def test_extra_nodes_are_a_warning(tmp_path, body):
    """Rows of nodes that are not on the line are skipped and told."""
    modes, lines = body
    columns = {name: values + [values[-1]] * 2 for name, values in FORCES.items()}
    columns = changed(changed(columns, "node", ROWS + 1, 99), "node", ROWS + 2, 11)  # 11 is on the other weld
    read, warnings = read_forces(write(tmp_path / "f.csv", columns), lines, modes, "on_element", (), strict=True)
    (warning,) = warnings
    assert warning.where == f"f.csv: column node, row {ROWS + 1}"
    assert warning.what == "node 99 is not on the line of weld ring; 2 rows of such nodes are not used"
    assert warning.remedy == "Remove them, or add the nodes to the weld's line"
    np.testing.assert_array_equal(read[1], expected(lines, modes)[1])


@SUFFIXES
@pytest.mark.parametrize("name", list(FORCES))
def test_missing_column(tmp_path, body, suffix, name):
    """Each column is asked for."""
    message = refusal_of(write(tmp_path / f"f{suffix}", without(FORCES, name)), body)
    assert message.startswith(f"f{suffix}: column {name}: the column is missing. Add it; the columns are ")


@SUFFIXES
@pytest.mark.parametrize("name", COMPONENTS)
@pytest.mark.parametrize(
    ("value", "what"),
    [
        (None, "the value is missing or NaN. Give a number."),
        (float("nan"), "the value is missing or NaN. Give a number."),
        (float("inf"), "inf is not finite. Give a finite number."),
    ],
)
def test_bad_component(tmp_path, body, suffix, name, value, what):
    """Each component is a finite number."""
    message = refusal_of(write(tmp_path / f"f{suffix}", changed(FORCES, name, 8, value)), body)
    assert message == f"f{suffix}: column {name}, row 8: {what}"


def test_text_in_several_components(tmp_path, body):
    """Mistakes in several columns are told together."""
    columns = changed(changed(FORCES, "fx_N", 2, "a"), "mz_Nmm", 3, "b")
    assert refusal_of(write(tmp_path / "f.csv", columns), body) == (
        "f.csv: column fx_N, row 2: 'a' is not a number. Give a number.\n"
        "f.csv: column mz_Nmm, row 3: 'b' is not a number. Give a number."
    )


@SUFFIXES
@pytest.mark.parametrize(
    ("columns", "message"),
    [
        (
            changed(FORCES, "weld", 2, "seem"),
            "column weld, row 2: 'seem' is not one of the welds. Write 'seam'.",
        ),
        (changed(FORCES, "weld", 2, None), "column weld, row 2: the text is missing. Give a text."),
        (changed(FORCES, "node", 2, None), "column node, row 2: the value is missing or NaN. Give a number."),
        (changed(FORCES, "mode", 2, 1.5), "column mode, row 2: 1.5 is not a whole number. Give a whole number."),
        (
            changed(changed(FORCES, "mode", 2, 4), "mode", 4, 99),
            "column mode, row 2: modes 4, 99 are not in the table of modes (and 1 more row). Add them there or to",
        ),
        (
            picked(FORCES, [row for row in range(1, ROWS + 1) if row not in (5, 6, 20)]),
            "weld seam, node 12, mode 3: no forces are given (2 of the weld's 9 pairs of node and mode are missing).",
        ),
        (
            picked(FORCES, [*range(1, ROWS + 1), 4]),
            f"column weld, node, mode, row {ROWS + 1}: weld seam, node 12, mode 7 repeats row 4. Keep one of the rows.",
        ),
    ],
)
def test_bad_keys(tmp_path, body, suffix, columns, message):
    """Unknown, missing and repeated (weld, node, mode) are told with their ids."""
    assert refusal_of(write(tmp_path / f"f{suffix}", columns), body).startswith(f"f{suffix}: {message}")


def test_gaps_of_every_weld_are_told(tmp_path, body):
    """One message per weld with gaps."""
    rows = [row for row in range(1, ROWS + 1) if row not in (5, 20)]
    assert refusal_of(write(tmp_path / "f.csv", picked(FORCES, rows)), body).count("no forces are given") == 2


def test_a_mode_beyond_those_known(tmp_path, body):
    """Ids below and above all known ones are unknown, not confused with a neighbour."""
    columns = changed(changed(FORCES, "mode", 1, -5), "mode", 2, 10**12)
    assert "modes -5, 1000000000000 are not in the table" in refusal_of(write(tmp_path / "f.csv", columns), body)


def test_element_forces_of_the_car_body_sum_to_its_nodal_forces():
    """Both forms of the shipped car body say the same, to single precision."""
    folder, tests = Path("data/carbody"), Path("tests/data")
    modes, _ = read_modes(folder / "modes.csv", (), strict=True)
    welds, _ = read_welds(folder / "welds.csv", (), strict=True)
    lines, _ = read_weld_nodes(folder / "weld_nodes.csv", welds, strict=True)
    summed, _ = read_forces(folder / "nodal_forces.parquet", lines, modes, "on_element", (), strict=True)
    single, _ = read_element_forces(tests / "carbody_element_forces.parquet", modes, "on_element", (), strict=True)
    wanted = [weld for weld in welds if weld.name.startswith(("W1", "W2_hanger1"))]
    elements, _ = read_weld_elements(tests / "carbody_weld_elements.csv", wanted, strict=True)
    assert len(elements) == 5
    for line, force in zip(lines, summed, strict=True):
        if line.weld in elements:
            (by_element,) = side_forces((line,), elements[line.weld], single, modes.mode, line.weld)
            scale = np.abs(force).max(axis=(0, 1))
            assert np.max(np.abs(by_element - force) / scale) < 1e-5
