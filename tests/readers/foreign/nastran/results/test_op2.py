"""OP2 files of real solvers, of every word size and byte order, and with every damage that can be thought of."""

import random
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.convert.audit.audit import audit
from fatigue.readers.foreign.nastran.deck.bdf import read_bdf
from fatigue.readers.foreign.nastran.results.op2 import read_op2
from fatigue.readers.foreign.nastran.results.op2_records import read_records
from tests.readers.op2_files import ROW, one_mode, read_back
from tests.readers.op2_writer import Op2Writer, modal_op2
from tests.readers.tee_model import bulk, tee

NASTRAN = Path("data/nastran")


def written(path, blocks, name="OGPFB1", **header):
    """A file with one forces table of (identification, data) blocks made by ``blocks(writer)``."""
    writer = Op2Writer(**header)
    writer.table(name, blocks(writer))
    path.write_bytes(writer.close())
    return path


def test_modes_of_a_real_file():
    """SOL 103 with an element zoo: 3 modes, 166 rows each; the first row is that of solid element 1 at grid 1."""
    found = read_op2(NASTRAN / "modes_elements.op2")
    assert (found.analysis, found.mode.tolist(), found.force.shape) == ("modal", [1, 2, 3], (3, 166, 6))
    assert (found.node[0], found.element[0], found.kind[0]) == (1, 1, "HEXA")
    assert found.modal_mass.tolist() == [1.0, 1.0, 1.0]
    assert found.shape.shape == (3, 39, 6)
    assert found.of_element.sum() == 122


def test_static_subcase_of_a_real_file():
    """A static run of 14 616 rows in three chunks; the subcase stands for the mode."""
    found = read_op2(NASTRAN / "wingbox_stitched_together-000.op2")
    assert (found.analysis, found.mode.tolist(), found.force.shape) == ("static", [1], (1, 14616, 6))
    assert found.solver == "NX2022.1"


@pytest.mark.parametrize(("word", "order"), [(4, "<"), (4, ">"), (8, "<"), (8, ">")])
def test_word_sizes_and_byte_orders(tmp_path, word, order):
    """All four layouts give the rows that were written."""
    wanted = tee().results
    path = tmp_path / "tee.op2"
    path.write_bytes(modal_op2(wanted, word, order))
    found = read_op2(path)
    for name in ("mode", "node", "element", "kind"):
        assert np.array_equal(getattr(found, name), getattr(wanted, name))
    precision = np.finfo(np.float32 if word == 4 else np.float64).eps
    assert np.allclose(found.force, wanted.force, rtol=precision, atol=0)
    assert np.allclose(found.frequency, wanted.frequency, rtol=1e-6 if word == 4 else 1e-12)


def test_real_file_in_other_layouts(tmp_path):
    """The records of a real file, rewritten big-endian and with 64-bit words, give bit-equal rows."""
    wanted = read_op2(NASTRAN / "modes_elements.op2")
    for word, order in ((4, ">"), (8, "<")):
        path = tmp_path / "again.op2"
        path.write_bytes(modal_op2(wanted, word, order))
        found = read_op2(path)
        assert np.array_equal(found.force, wanted.force)
        assert np.array_equal(found.shape, wanted.shape)


@pytest.mark.parametrize(
    ("approach", "code", "mode", "words", "label", "code_found", "words_found"),
    [
        (5, 19, 0, 10, "", "wrong_analysis", "frequency response"),
        (9, 19, 1, 10, "", "wrong_analysis", "complex eigenvalues"),
        (2, 1019, 1, 10, "", "complex_forces", "complex"),
        (2, 19, 1, 16, "", "complex_forces", "complex"),
        (2, 19, 1, 10, "SUPERELEMENT 30", "superelement", "superelement: 30"),
        (2, 18, 1, 10, "", "op2_table_damaged", "table code 18"),
        (2, 19, 0, 10, "", "op2_table_damaged", "mode 0 is impossible"),
        (8, 19, 3, 10, "", "wrong_analysis", "buckling.*SOL 103"),
        (7, 19, 0, 10, "", "wrong_analysis", "pre-buckling.*SOL 103"),
    ],
)
def test_other_results_are_refused(tmp_path, approach, code, mode, words, label, code_found, words_found):
    """Complex, superelement and other than modal or static results are refused with what was found."""
    path = written(
        tmp_path / "a.op2",
        lambda w: [w.identification(approach, code, mode, words, label=label), w.forces([ROW])],
    )
    with pytest.raises(DataError, match=words_found) as caught:
        read_op2(path)
    assert caught.value.problems[0].code == code_found


def test_residual_structure_is_read(tmp_path):
    """A label SUPERELEMENT 0 is the residual structure, which is fine."""
    path = written(
        tmp_path / "a.op2",
        lambda w: [w.identification(2, 19, 1, 10, label="SUPERELEMENT 0"), w.forces([ROW])],
    )
    assert read_op2(path).mode.tolist() == [1]


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ([ROW, ROW], "given twice, element 1 node 1"),
        ([ROW, (2, 1, "TRIA3", [0.0] * 6)], "named QUAD4 and TRIA3"),
        ([(1, 1, "QUAD4", [np.nan, *[0.0] * 5])], "no number"),
        ([(1, -1, "QUAD4", [0.0] * 6), ROW], "impossible ids"),
        ([(1, 1, "QU\x01D4", [0.0] * 6)], "a row is named"),
        ([(1, 0, "*TOTALS*", [0.0] * 6)], "no force row of an element"),
        ([], "no force row of an element"),
    ],
)
def test_impossible_rows_are_refused(tmp_path, rows, words):
    """Duplicate, misnamed, unnumbered and missing rows."""
    path = written(tmp_path / "a.op2", lambda w: [w.identification(2, 19, 1, 10), w.forces(rows)])
    with pytest.raises(DataError, match=words):
        read_op2(path)


def test_blocks_must_agree(tmp_path):
    """A mode given twice, modes with different rows, and two modal subcases are refused; a subcase can be chosen."""

    def blocks(*heads):
        return lambda w: [part for head, rows in heads for part in (w.identification(2, 19, **head), w.forces(rows))]

    one = {"mode": 1, "words": 10}
    other = (9, 2, "QUAD4", [0.0] * 6)
    with pytest.raises(DataError, match="more than once"):
        read_op2(written(tmp_path / "a.op2", blocks((one, [ROW]), (one, [ROW]))))
    with pytest.raises(DataError, match="are not those of"):
        read_op2(written(tmp_path / "a.op2", blocks((one, [ROW]), ({**one, "mode": 2}, [ROW, other]))))
    path = written(tmp_path / "a.op2", blocks((one, [ROW]), ({**one, "subcase": 4}, [other])))
    with pytest.raises(DataError, match=r"several subcases: \[1, 4\]"):
        read_op2(path)
    assert read_op2(path, subcase=4).element.tolist() == [2]
    with pytest.raises(DataError, match=r"Name one of \[1, 4\]"):
        read_op2(path, subcase=3)


def test_static_subcases_beside_modes_are_left_out(tmp_path):
    """A file with a static preload and modes gives the modes, and says so."""
    path = written(
        tmp_path / "a.op2",
        lambda w: [
            w.identification(1, 19, 0, 10, subcase=1),
            w.forces([ROW]),
            w.identification(2, 19, 5, 10, subcase=2),
            w.forces([ROW]),
        ],
    )
    found = read_op2(path)
    assert (found.mode.tolist(), found.warnings[0].code) == ([5], "static_left_out")


def test_missing_forces_name_the_tables(tmp_path):
    """Without OGPFB1 the tables found are listed with what to request; OGPFB2 is told apart."""
    path = written(tmp_path / "a.op2", lambda w: [w.ints(1)], name="OUGV9")
    with pytest.raises(DataError, match=r"tables found: OUGV9.*GPFORCE"):
        read_op2(path)
    path = written(tmp_path / "a.op2", lambda w: [w.ints(1)], name="OGPFB2")
    with pytest.raises(DataError, match="SORT1"):
        read_op2(path)


def test_modes_without_forces_are_told(tmp_path):
    """A mode in the summary only is a warning, a mode with forces only a refusal."""
    case = tee().results
    path = tmp_path / "tee.op2"

    def cut(results, **kept):
        whole = modal_op2(results)
        part = Op2Writer()
        lama = b"".join(part.ints(m, m) + part.reals(1.0, 1.0, 0.159155, 1.0, 1.0) for m in kept["modes"])
        part.table("LAMA", [part.identification(2, 6, 0, 7), lama])
        at = whole.index(b"OUGV1   ") - 16
        path.write_bytes(part.data + whole[at:])
        return read_op2(path)

    assert cut(case, modes=range(1, 8)).warnings[0].code == "modes_without_forces"
    with pytest.raises(DataError, match="mode 5 has forces and is not in the eigenvalue summary"):
        cut(case, modes=range(1, 5))


@pytest.mark.parametrize("values", [(4.0, 1.0, 0.16, 1.0, 1.0), (1.0, 1.0, 9.9, 1.0, 1.0), (1.0, 1.0, 0.16, -1.0, 1.0)])
def test_eigenvalues_must_agree_with_themselves(tmp_path, values):
    """Eigenvalue, circular frequency and frequency of a mode are one number; a mass is not negative."""
    path = written(
        tmp_path / "a.op2", lambda w: [w.identification(2, 6, 0, 7), w.ints(1, 1) + w.reals(*values)], "LAMA"
    )
    with pytest.raises(DataError, match=r"contradict|impossible"):
        read_op2(path)


@pytest.mark.parametrize(
    ("name", "blocks"),
    [
        ("OGPFB1", lambda w: [w.identification(2, 19, 1, 10)]),
        ("OGPFB1", lambda w: [w.ints(*range(20)), w.forces([ROW])]),
        ("OGPFB1", lambda w: [w.identification(2, 19, 1, 10), w.ints(1, 2, 3)]),
        ("OGPFB1", lambda w: [w.identification(2, 19, 1, 10), w.forces([(0, *ROW[1:])])]),
        ("OUGV1", lambda w: [w.identification(2, 7, 1, 14), w.shape([(1, [0.0] * 6)])]),
        ("OUGV1", lambda w: [w.identification(2, 7, 1, 8), w.shape([(1, [np.inf] * 6)])]),
        ("OUGV1", lambda w: [w.identification(2, 7, 1, 8), w.shape([(1, [0.0] * 6)] * 2)]),
        ("LAMA", lambda w: [w.identification(2, 6, 0, 7), w.ints(1, 2, 3)]),
    ],
)
def test_tables_that_contradict_themselves(tmp_path, name, blocks):
    """Half blocks, short identifications, broken rows, no grid, complex or doubled shapes."""
    with pytest.raises(DataError, match=f"table {name}"):
        read_op2(written(tmp_path / "a.op2", blocks, name))


def test_partial_mode_shapes_are_dropped(tmp_path):
    """Shapes that do not cover all modes are of no use to the audit and left out."""
    results = replace(tee().results, shape_node=np.empty(0, np.int64), shape=np.empty((5, 0, 6)))
    path = tmp_path / "tee.op2"
    path.write_bytes(modal_op2(results))
    assert read_op2(path).shape_node.size == 0


@pytest.mark.parametrize("content", [b"", b"GRID,1", b"\x04\0\0\0", b"\x04\0\0\0\x03\0\0\0\x04\0\0\0"])
def test_what_is_no_op2_file(tmp_path, content):
    """Empty, foreign and beheaded files."""
    path = tmp_path / "a.op2"
    path.write_bytes(content)
    with pytest.raises(DataError):
        read_op2(path)


def test_missing_file(tmp_path):
    """A missing file is named."""
    with pytest.raises(DataError, match=r"none\.op2"):
        read_op2(tmp_path / "none.op2")


def test_header_variants(tmp_path):
    """Files without tape header (PARAM,POST,-2) and without last zero are whole; trailing bytes are not."""
    writer = Op2Writer(header=False)
    writer.table("OGPFB1", [writer.identification(2, 19, 1, 10), writer.forces([ROW])])
    path = tmp_path / "a.op2"
    path.write_bytes(writer.data)
    assert read_op2(path).solver == ""
    path.write_bytes(writer.close() + b"\0" * 12)
    with pytest.raises(DataError, match="12 bytes follow the end mark"):
        read_op2(path)


def test_matrix_tables_are_stepped_over(tmp_path):
    """A matrix, whose numbers are wider than a word, may stand beside the forces."""
    writer = Op2Writer()
    for value in (2,):
        writer.marker(value)
    writer.record(writer.text("KAA", 2))
    for value in (-1, 7):
        writer.marker(value)
    writer.record(writer.ints(101, 1, 1, 6, 2, 2, 1))
    for value in (-2, 1, 0, 2):
        writer.marker(value)
    writer.record(writer.text("KAA", 2))
    for value in (-3, 1, 1, 2):
        writer.marker(value)
    writer.record(writer.ints(1, 0, 0))
    for value in (-4, 1, 0, 0):
        writer.marker(value)
    writer.table("OGPFB1", [writer.identification(2, 19, 1, 10), writer.forces([ROW])])
    path = tmp_path / "a.op2"
    path.write_bytes(writer.close())
    assert [table.name for table in read_records(path).tables] == ["KAA", "OGPFB1"]
    assert read_op2(path).node.tolist() == [1]


def damaged(data, rng):
    """Flip bits, cut, delete, insert or overwrite somewhere."""
    out = bytearray(data)
    at = rng.randrange(len(out))
    match rng.randrange(5):
        case 0:
            for _ in range(rng.choice([1, 1, 3, 20])):
                out[rng.randrange(len(out))] ^= 1 << rng.randrange(8)
        case 1:
            del out[at:]
        case 2:
            del out[at : at + rng.choice([1, 4, 8, 40])]
        case 3:
            out[at:at] = bytes(rng.randrange(256) for _ in range(rng.choice([1, 4, 8])))
        case _:
            out[at : at + 4] = bytes(rng.choice([0, 127, 128, 255]) for _ in range(4))
    return bytes(out)


@pytest.mark.parametrize(("word", "order"), [(4, "<"), (8, "<"), (4, ">")])
def test_damaged_files_are_refused_or_told_by_the_audit(tmp_path, word, order):
    """A refusal, a red light, or an error below 1e-3 of the mode's largest force; never a crash."""
    case = tee()
    bdf = tmp_path / "tee.bdf"
    bdf.write_text(bulk(case))
    model = read_bdf(bdf)
    path = tmp_path / "tee.op2"
    data = modal_op2(case.results, word, order)
    rng = random.Random(word)
    path.write_bytes(data)
    whole = read_op2(path)
    outcomes = {"refused": 0, "red": 0, "harmless": 0}
    for _ in range(150):
        path.write_bytes(damaged(data, rng))
        try:
            found = read_op2(path)
        except DataError:
            outcomes["refused"] += 1
            continue
        if audit(found, model).red:
            outcomes["red"] += 1
            continue
        outcomes["harmless"] += 1
        assert np.array_equal(found.element, whole.element)
        error = np.abs(found.force - whole.force) / np.abs(whole.force).max(axis=(1, 2), keepdims=True)
        assert error.max() < 1e-3
    assert min(outcomes.values()) > 0


@pytest.mark.parametrize(("device", "key_device"), [(1, 2), (2, 1), (0, 1), (5, 0), (4, 9)])
def test_device_codes_need_not_agree(tmp_path, device, key_device):
    """The grid is a tenth of the key, whatever the device in the key and in the identification, in shapes likewise."""

    def tables(writer):
        head = writer.identification(2, 7, 1, 8, device=device, eigenvalue=100.0)
        writer.table("OUGV1", [head, writer.shape([(17, [1.0] * 6)], key_device)])
        head = writer.identification(2, 19, 1, 10, device=device)
        writer.table("OGPFB1", [head, writer.forces([(17, *ROW[1:])], key_device)])

    found = read_back(tmp_path / "a.op2", tables)
    assert (found.node.tolist(), found.shape_node.tolist()) == ([17], [17])


def test_word_5_of_a_static_subcase_is_a_load_set(tmp_path):
    """A static subcase whose word 5 is not zero, in forces and displacements, is static all the same."""

    def tables(writer):
        for subcase, load_set in ((1, 40), (2, 40)):
            head = writer.identification(1, 1, load_set, 8, subcase=subcase)
            writer.table("OUGV1", [head, writer.shape([(1, [1.0] * 6)])])
            head = writer.identification(1, 19, load_set, 10, subcase=subcase)
            writer.table("OGPFB1", [head, writer.forces([ROW])])

    found = read_back(tmp_path / "a.op2", tables)
    assert (found.analysis, found.mode.tolist(), found.shape.shape) == ("static", [1, 2], (2, 1, 6))


def test_several_force_tables(tmp_path):
    """Modes spread over several tables are one run, in the order of the file."""
    tables = [lambda w, m=m: one_mode(w, mode=m) for m in (4, 2, 9)]
    assert read_back(tmp_path / "a.op2", *tables).mode.tolist() == [4, 2, 9]


def test_rigid_modes_in_the_summary(tmp_path):
    """Negative eigenvalues count by their size, also where the summary states 0 Hz for them."""

    def tables(w):
        lama = w.ints(1, 1) + w.reals(-1e-4, 0.0, 0.0, 1.0, -1e-4)
        lama += w.ints(2, 2) + w.reals(-1e-4, -1e-2, -1e-2 / (2 * np.pi), 1.0, -1e-4)
        w.table("LAMA", [w.identification(2, 6, 0, 7), lama])
        one_mode(w, mode=1)
        one_mode(w, mode=2)

    assert read_back(tmp_path / "a.op2", tables).frequency == pytest.approx([1e-2 / (2 * np.pi)] * 2)
