"""Shell stresses of OP2 files: every kind of shell, word size and byte order; what are no stresses is refused."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.fe.shell_stress import StressBlock
from fatigue.readers.foreign.nastran.results.op2_stresses import read_op2_stresses
from tests.readers.op2_writer import MSC_2014, OPTISTRUCT, PLAIN, Op2Writer

ALL = np.arange(1, 10_000)
STRIP = Path("tests/data/nastran/mystran")
KINDS = (("QUAD4", 0), ("TRIA3", 0), ("QUAD4", 4), ("QUAD8", 4), ("QUADR", 4), ("QUADR", 0), ("TRIAR", 0), ("TRIA6", 3),
         ("TRIAR", 3))  # fmt: skip


def block(kind="QUAD4", corners=4, mode=1, subcase=1, first=1, count=3, eigenvalue=400.0):
    """A block of random stresses."""
    rng = np.random.default_rng(first + 10 * mode)
    element = first + np.arange(count)
    node = np.zeros((count, 1 + corners), np.int64)
    node[:, 1:] = 10 * element[:, None] + np.arange(corners)
    fibre = np.broadcast_to([-2.0, 2.0], (count, 1 + corners, 2)).copy()
    stress = rng.normal(size=(count, 1 + corners, 2, 3))
    return StressBlock("", subcase, mode, eigenvalue if mode else np.nan, kind, element, node, fibre, stress)


def written(path, blocks, word=8, order="<", dialect=PLAIN, name="OES1X1", **head):
    """A file of one table."""
    writer = Op2Writer(word, order, dialect=dialect)
    writer.stress_table(blocks, name, **head)
    path.write_bytes(writer.close())
    return path


@pytest.mark.parametrize(("word", "order"), [(4, "<"), (4, ">"), (8, "<"), (8, ">")])
@pytest.mark.parametrize("dialect", [PLAIN, MSC_2014, OPTISTRUCT])
@pytest.mark.parametrize("stress", [0, 1, 4, 5])
def test_every_kind_in_every_layout(tmp_path, word, order, dialect, stress):
    """Von Mises or maximum shear beside the stresses makes no difference, nor does the bit of fibres."""
    wanted = [block(*kind, mode=m, first=100 * k + 1) for m in (1, 2) for k, kind in enumerate(KINDS)]
    found = read_op2_stresses(written(tmp_path / "a.op2", wanted, word, order, dialect, stress=stress), ALL)
    assert len(found.blocks) == len(wanted)
    for ours, theirs in zip(found.blocks, wanted, strict=True):
        assert (ours.kind, ours.mode, ours.subcase, ours.eigenvalue) == (theirs.kind, theirs.mode, 1, 400.0)
        assert np.array_equal(ours.element, theirs.element)
        assert np.array_equal(ours.node, theirs.node)
        precision = np.finfo(np.float32 if word == 4 else np.float64).eps
        assert np.allclose(ours.stress, theirs.stress, rtol=precision, atol=0)
        assert np.allclose(ours.fibre, theirs.fibre, rtol=precision)


def test_only_what_is_wanted_is_kept(tmp_path):
    """Elements by their ids, of all modes; a block without one of them is left out."""
    path = written(tmp_path / "a.op2", [block(), block("TRIA3", 0, first=50)])
    found = read_op2_stresses(path, np.array([2, 999]))
    assert [(b.kind, b.element.tolist()) for b in found.blocks] == [("QUAD4", [2])]


@pytest.mark.parametrize("name", ["OES1", "OES1X", "OES1X1"])
def test_names_of_the_table(tmp_path, name):
    """All names that solvers give it."""
    assert read_op2_stresses(written(tmp_path / "a.op2", [block()], name=name), ALL).blocks


@pytest.mark.parametrize(
    ("head", "code", "words"),
    [
        ({"stress": 17}, "material_system", "PARAM,OMID,NO"),
        ({"stress": 11}, "strains", "holds strains"),
        ({"stress": 15}, "strains", "Request STRESS"),
        ({"form": 2}, "complex_stresses", "complex or sorted"),
        ({"code": 1005}, "complex_stresses", "SORT2"),
        ({"approach": 6}, "wrong_analysis", "transient response"),
        ({"approach": 8}, "wrong_analysis", "buckling"),
        ({"label": " " * 128 + "SUPERELEMENT 7".ljust(128)}, "superelement", "superelement 7"),
    ],
)
def test_what_is_no_real_stress_in_element_axes(tmp_path, head, code, words):
    """It is not used, and why is kept for whoever needs it."""
    found = read_op2_stresses(written(tmp_path / "a.op2", [block()], **head), ALL)
    assert not found.blocks
    (problem,) = found.problems
    assert problem.code == code
    assert words in str(problem)


def test_tables_of_strains_are_not_read(tmp_path):
    """A file that has strains only has no stresses, and its tables are named."""
    with pytest.raises(DataError, match=r"no stresses of these shells.*tables found: OSTR1X"):
        read_op2_stresses(written(tmp_path / "a.op2", [block()], name="OSTR1X", stress=15), ALL)


def test_layered_shells_are_told_from_others():
    """The zoo has both: plies of a PCOMP are no stress of a face."""
    found = read_op2_stresses(Path("data/nastran/modes_elements.op2"), ALL)
    assert {b.kind for b in found.blocks} == {"QUAD4", "TRIA3", "QUAD8", "TRIA6"}
    assert set(found.unread) == {*range(16, 22), 23, 24, 25}
    assert "layered" in found.unread[16]


def test_modes_of_mystran():
    """It calls the stresses of modes static; displacements and forces beside them tell the modes."""
    found = read_op2_stresses(STRIP / "strip_modes.op2", ALL)
    assert sorted({(b.subcase, b.mode) for b in found.blocks}) == [(1, 1), (1, 2)]
    static = read_op2_stresses(STRIP / "strip_static.op2", ALL)
    assert sorted({(b.subcase, b.mode) for b in static.blocks}) == [(1, 0), (2, 0), (3, 0)]


def test_stresses_are_those_of_the_printed_output():
    """Element 1 of the strip in tension, as MYSTRAN prints it: 19.97 MPa along y of the element, 0.769 shear."""
    blocks = read_op2_stresses(STRIP / "strip_static.op2", ALL).blocks
    first = next(b for b in blocks if b.subcase == 1 and b.kind == "QUAD4")
    assert first.stress[0, 0, 0] == pytest.approx([0.03, 19.97, 0.769], abs=5e-3)


def test_damage_is_told(tmp_path):
    """A row of another length, an element that is none, a corner without grid."""
    for change, words in (
        ({"words": 88}, "88 words in a row of element type 144, not 87"),
        ({"words": 0}, "0 words in a row"),
    ):
        with pytest.raises(DataError, match=words):
            read_op2_stresses(written(tmp_path / "a.op2", [block()], **change), ALL)
    bare = block()
    bare.node[1, 2] = -4
    with pytest.raises(DataError, match="belongs to no grid"):
        read_op2_stresses(written(tmp_path / "b.op2", [bare]), ALL)
    with pytest.raises(DataError, match="is no element"):
        read_op2_stresses(written(tmp_path / "c.op2", [replace(block(), element=np.array([1, 0, -3]))]), ALL)


def test_two_runs_in_one_file(tmp_path):
    """Which of them is meant is not known."""
    writer = Op2Writer(8)
    writer.stress_table([block()])
    writer.marker(0)
    writer.header()
    writer.stress_table([block()])
    (tmp_path / "a.op2").write_bytes(writer.close())
    with pytest.raises(DataError, match="several runs with stresses"):
        read_op2_stresses(tmp_path / "a.op2", ALL)
