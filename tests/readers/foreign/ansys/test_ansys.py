"""The text of the ANSYS macro and archives (.cdb), read and converted."""

import re

import numpy as np
import pyarrow.parquet as pq
import pytest

from fatigue.errors import DataError
from fatigue.example import request_text
from fatigue.readers.convert.convert import convert
from fatigue.readers.convert.options import ConvertOptions
from fatigue.readers.foreign.read import read_forces, read_model, recognise
from tests.readers.foreign.ansys.macro_writer import archive, macro_text, tee_archive, tee_text
from tests.readers.op2_writer import modal_op2
from tests.readers.tee_model import bulk, tee

SQUARE = [[0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0], [0, 0, 5], [10, 0, 5], [10, 10, 5], [0, 10, 5]]


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Text and archive of the T joint."""
    folder = tmp_path_factory.mktemp("ansys")
    (folder / "tee.txt").write_text(tee_text(tee()))
    (folder / "tee.cdb").write_text(tee_archive(tee()))
    return folder


def test_forces_shapes_and_frequencies_come_back(files):
    """Joined by element and node, whatever their order in the results."""
    case, found = tee(), read_forces(files / "tee.txt", None)
    assert recognise(files / "tee.txt").key == "ansys"
    np.testing.assert_allclose(found.frequency, case.frequency, rtol=1e-12)
    np.testing.assert_allclose(found.shape, case.shape, rtol=1e-11, atol=1e-15)
    order = np.lexsort((found.node, found.element))
    own = np.lexsort(((case.model.quads + 1).ravel(), np.repeat(np.arange(len(case.model.quads)), 4)))
    np.testing.assert_allclose(found.force[:, order], -case.element_force.reshape(5, -1, 6)[:, own], rtol=1e-11)
    assert set(found.kind.tolist()) == {"QUAD4"}


def test_the_archive_comes_back(files):
    """Places, corners, thicknesses and the component as a node set."""
    case, model = tee(), read_model(files / "tee.cdb")
    assert recognise(files / "tee.cdb").key == "cdb"
    np.testing.assert_allclose(model.mesh.xyz, case.model.xyz, atol=1e-10)
    np.testing.assert_array_equal(model.mesh.corner, case.model.quads)
    np.testing.assert_array_equal(model.mesh.thickness, case.model.thickness)
    assert not model.unconfirmed_sections
    assert model.node_sets[1].tolist() == [1, 2, 3, 4, 5, 9]


def test_the_whole_way_gives_what_nastran_gives(files, tmp_path):
    """The same welds and forces as from OP2 and deck; no check is red."""
    case = tee()
    (tmp_path / "tee.bdf").write_text(bulk(case))
    (tmp_path / "tee.op2").write_bytes(modal_op2(case.results, word=8))
    time = np.arange(200) / 100
    rows = [f"{t:.9g}," + ",".join(f"{np.sin((k + 1) * t):.9g}" for k in range(5)) for t in time]
    (tmp_path / "q.csv").write_text("\n".join(["time," + ",".join(f"q_{k}" for k in range(1, 6)), *rows]) + "\n")
    pairs = {
        "nastran": (tmp_path / "tee.op2", tmp_path / "tee.bdf"),
        "ansys": (files / "tee.txt", files / "tee.cdb"),
    }
    done = {
        name: convert(
            ConvertOptions(
                out=tmp_path / name,
                forces=forces,
                mesh=mesh,
                coordinates=(tmp_path / "q.csv",),
                interface_modes=(5,),
            )
        )
        for name, (forces, mesh) in pairs.items()
    }
    assert [row.line for row in done["ansys"].welds] == [row.line for row in done["nastran"].welds]
    assert "red" not in {row.light for row in done["ansys"].audit.rows}
    keys = ["mode", "element", "node"]
    ours, theirs = (
        pq.read_table(tmp_path / n / "element_forces.parquet").to_pandas().sort_values(keys).reset_index(drop=True)
        for n in ("ansys", "nastran")
    )
    assert ours[keys].equals(theirs[keys])
    columns = [name for name in ours if name not in keys]
    scale = np.abs(theirs[columns].to_numpy()).max()
    np.testing.assert_allclose(ours[columns], theirs[columns], atol=1e-6 * scale)


def model_of(tmp_path, *args, **kwargs):
    """Model of a written archive."""
    (tmp_path / "a.cdb").write_text(archive(*args, **kwargs))
    return read_model(tmp_path / "a.cdb")


def test_degenerate_elements_are_what_their_corners_make(tmp_path):
    """A shell with its third corner twice is a triangle; a brick a prism or a tetrahedron."""
    rows = [
        (1, 1, 1, 7, [1, 2, 3, 3]),
        (2, 1, 1, 8, [1, 2, 3, 3, 5, 6, 7, 7]),
        (2, 1, 1, 9, [1, 2, 3, 3, 5, 5, 5, 5]),
        (2, 1, 1, 10, [1, 2, 3, 4, 5, 6, 7, 8]),
    ]
    model = model_of(tmp_path, SQUARE, rows, {1: 181, 2: 185}, ["SECTYPE,1,SHELL", "SECDATA,4.0,1"])
    assert model.mesh.corner.tolist() == [[0, 1, 2, -1]]
    assert model.solids.corners.tolist() == [6, 4, 8]
    assert model.solids.corner[0].tolist() == [0, 1, 2, 4, 5, 6, -1, -1]


def test_midside_nodes_of_a_brick_are_turned(tmp_path):
    """ANSYS lists those of the top before those between; the mesh has them between."""
    corner = np.array(SQUARE, float)
    ends = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
    xyz = np.vstack([corner, [(corner[a] + corner[b]) / 2 for a, b in ends]])
    model = model_of(tmp_path, xyz, [(1, 1, 1, 1, list(range(1, 21)))], {1: 186}, [])
    solids = model.solids
    bottom, between, top = np.split(solids.xyz[solids.mid[0]][:, 2], 3)
    assert (set(bottom), set(between), set(top)) == ({0.0}, {2.5}, {5.0})


def test_offsets_layers_and_real_constants(tmp_path):
    """Nodes on the top have the mid-surface below; layers and thickness that varies want a confirmation."""
    data = ["SECTYPE,1,SHELL", "SECOFFSET,TOP", "SECDATA,4.0,1", "SECTYPE,2,SHELL", "SECDATA,1.0,1", "SECDATA,2.0,1"]
    data += ["RLBLOCK,       1,       3,       6,       7", "(2i8,6g16.9)", "(7g16.9)"]
    data += ["       3       4" + "".join(f"{t:16.9G}" for t in (5.0, 5.0, 7.0, 7.0))]
    rows = [(1, 1, 1, 1, [1, 2, 3, 4]), (1, 1, 2, 2, [5, 6, 7, 8]), (2, 3, 1, 3, [1, 2, 6, 5])]
    model = model_of(tmp_path, SQUARE, rows, {1: 181, 2: 63}, data)
    assert model.mesh.thickness.tolist() == [4.0, 3.0, 5.0]
    assert model.mesh.offset.tolist() == [-2.0, 0.0, 0.0]
    assert sorted(model.unconfirmed_sections.values()) == [
        "real constants 3 give a thickness that varies",
        "section 2 has 2 layers",
    ]


@pytest.mark.parametrize(
    ("change", "code", "said"),
    [
        (lambda t: t[: t.index("N,R5.3")], "cut", "ends within NBLOCK"),
        (lambda t: t[: t.index("        -1")], "cut", "ends within EBLOCK"),
        (lambda t: t.replace("(3i9,6e21.13e3)", "3i9"), "archive_damaged", "format in brackets"),
        (lambda t: t.replace("(19i10)", "(0i10)"), "archive_damaged", "is not read"),
        (lambda t: t.replace("ET,        1,181", "ET,        2,181"), "no_type", "element type 1 is not defined"),
        (lambda t: t.replace("1.2000000000000E+002", "********************", 1), "archive_damaged", "did not fit"),
        (lambda t: t.replace("N,R5.3", "\nN,R5.3"), "archive_damaged", "a node of 3 whole numbers"),
        (lambda t: t[: t.index("EBLOCK")], "no_mesh", "no elements"),
        (lambda t: t.replace("EBLOCK", "EN,1,1,2,3,4\nEBLOCK"), "unblocked", "EN stands outside"),
    ],
)
def test_a_damaged_archive_is_refused(files, tmp_path, change, code, said):
    """In one line with its place."""
    (tmp_path / "bad.cdb").write_text(change((files / "tee.cdb").read_text()))
    with pytest.raises(DataError) as caught:
        read_model(tmp_path / "bad.cdb")
    assert caught.value.problems[0].code == code
    assert said in caught.value.problems[0].what


@pytest.mark.parametrize(
    ("change", "code", "said"),
    [
        (lambda t: t.replace("export 1", "export 2", 1), "other_version", "version 2"),
        (lambda t: t.replace("*end\n", ""), "cut", "without *end"),
        (lambda t: t.replace("    181.", "    abc.", 1), "export_damaged", "no element routine"),
        (lambda t: t.replace("*mode 3 1", "*mode 3 2", 1), "export_damaged", "no number"),
        (lambda t: t.replace("E-00", "*****", 1), "export_damaged", "no number"),
        (lambda t: re.sub(r"(shape.*\n.*)\S{20}\n", r"\1NaN\n", t, count=1), "export_damaged", "'NaN' is no number"),
        (lambda t: t.replace("0.1000000000000E+001", "-1.", 1), "export_damaged", "-1 is no modal mass"),
    ],
)
def test_a_damaged_text_is_refused(files, tmp_path, change, code, said):
    """In one line with its place."""
    (tmp_path / "bad.txt").write_text(change((files / "tee.txt").read_text()))
    with pytest.raises(DataError) as caught:
        read_forces(tmp_path / "bad.txt", None)
    assert caught.value.problems[0].code == code
    assert said in caught.value.problems[0].what


def test_a_triangle_has_three_rows_of_its_kind(tmp_path):
    """A degenerate shell is a triangle in the forces, too."""
    rows = [(1, 1), (1, 2), (1, 3)]
    text = macro_text({181: [(1, [1, 2, 3, 3])]}, [(1, 9.0, [1, 2, 3], np.ones((3, 6)), rows, np.ones((3, 6)))])
    (tmp_path / "t.txt").write_text(text)
    assert read_forces(tmp_path / "t.txt", None).kind.tolist() == ["TRIA3"] * 3


def test_the_macro_writes_the_blocks_that_are_read():
    """Every head of a block in the macro is one that the writer of the tests has; static forces in global axes."""
    macro = request_text("ansys")
    assert set(re.findall(r"'\*(\w+)", macro)) == {"elements", "mode", "shape", "forces", "end"}
    assert "\nFORCE,STATIC\nRSYS,0\n" in macro
