"""Rows of all modes: those of elements must be the same, the others may come and go."""

import random
from dataclasses import replace

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.convert.audit.audit import audit
from fatigue.readers.foreign.fe.force_rows import common_rows
from fatigue.readers.foreign.fe.results import ForceBlock, names_element, names_total
from fatigue.readers.foreign.nastran.deck.bdf import read_bdf
from fatigue.readers.foreign.nastran.results.op2 import read_op2
from tests.readers.tee_model import bulk, tee
from tests.readers.unit_loads import SUBCASES, unit_load_op2, unit_loads


def block(rows, subcase=1, mode=0):
    """A block of rows (node, element, kind, first force component)."""
    node, element, kind, force = zip(*rows, strict=True)
    values = np.zeros((len(rows), 6))
    values[:, 0] = force
    return ForceBlock(
        f"subcase {subcase}", subcase, mode, np.array(node), np.array(element), np.array(kind, np.str_), values
    )


PLATE = [(1, 7, "QUAD4", 1.0), (2, 7, "QUAD4", 2.0), (2, 8, "TRIA3", 3.0)]


def by_row(rows, k):
    """First force component of each row that a mode has."""
    return {
        (int(n), int(e), str(kind)): float(f)
        for n, e, kind, f in zip(rows.node, rows.element, rows.kind, rows.force[k, :, 0], strict=True)
        if np.isfinite(f)
    }


@pytest.mark.parametrize(
    ("names", "is_element", "is_total"),
    [
        (["QUAD4", "TRIA3", "HEXA", "BUSH1D", "RBE2", "QUAD144", ""], True, False),
        (["APP-LOAD", "F-OF-SPC", "F-OF-MPC", "F-OF-NEW", "THERMAL", "INERTIA", "CONTACT"], False, False),
        (["*TOTALS*", "TOTALS", "*TOTAL*"], False, True),
    ],
)
def test_names(names, is_element, is_total):
    """Names of elements are words; those of loads, reactions and totals are not."""
    kind = np.array(names)
    assert (names_element(kind) == is_element).all()
    assert (names_total(kind) == is_total).all()


def test_equal_rows_keep_the_order_of_the_file():
    """Blocks with the same rows are stacked as they are; ids left over from elements are dropped where they differ."""
    rows = [(2, 8, "TRIA3", 3.0), (1, 99, "APP-LOAD", 5.0), (1, 7, "QUAD4", 1.0), (1, 98, "*TOTALS*", 6.0)]
    found = common_rows([block(rows), block(rows, 2)])
    assert found.node.tolist() == [2, 1, 1, 1]
    assert found.element.tolist() == [8, 99, 7, 98]
    assert found.force[1, :, 0].tolist() == [3.0, 5.0, 1.0, 6.0]
    other = [(n, 55 if kind == "APP-LOAD" else e, kind, f) for n, e, kind, f in rows]
    assert common_rows([block(rows), block(other, 2)]).element.tolist() == [8, 0, 7, 0]


def test_rows_that_are_no_elements_differ():
    """Loads, reactions and totals of some subcases only, with other ids, twice at a grid, or alone."""
    first = block([*PLATE, (1, 5, "APP-LOAD", 10.0), (1, 6, "APP-LOAD", 11.0), (1, 0, "*TOTALS*", 0.5)])
    second = block([(2, 3, "F-OF-MPC", 20.0), *PLATE[::-1], (2, 0, "APP-LOAD", 21.0), (1, 9, "APP-LOAD", 22.0)], 2)
    third = block(PLATE, 3)
    found = common_rows([first, second, third])
    assert found.node[:3].tolist() == [1, 2, 2]
    plate = {(n, e, kind): f for n, e, kind, f in PLATE}
    assert by_row(found, 1) == plate | {
        (2, 0, "F-OF-MPC"): 20.0,
        (2, 0, "APP-LOAD"): 21.0,
        (1, 0, "APP-LOAD"): 22.0,
    }
    assert by_row(found, 2) == plate
    loads = found.force[0, (found.node == 1) & (found.kind == "APP-LOAD"), 0]
    assert loads.tolist() == [10.0, 11.0]
    assert (found.element[3:] == 0).all()


def test_springs_may_have_several_rows_at_a_grid():
    """A spring between two directions of one grid has two rows there, in the order of the file; a plate has one."""
    rows = [*PLATE, (4, 9, "ELAS2", 5.0), (4, 9, "ELAS2", -6.0)]
    found = common_rows([block(rows), block([*rows[3:], *PLATE, (1, 0, "APP-LOAD", 1.0)], 2)])
    assert found.force[:, 3:5, 0].tolist() == [[5.0, -6.0]] * 2
    with pytest.raises(DataError, match="element 7 node 1 the first"):
        common_rows([block([*PLATE, PLATE[0]])])


def test_any_order_and_any_loads():
    """Random blocks: every row of every block is found again, elements in the order of the first block."""
    rng = random.Random(3)
    for _ in range(100):
        plate = [(n, e, "QUAD4", 0.0) for e in range(1, 6) for n in rng.sample(range(1, 20), 4)]
        blocks, wanted = [], []
        for subcase in range(1, 5):
            rows = [(n, e, kind, rng.uniform(1, 2)) for n, e, kind, _ in rng.sample(plate, len(plate))]
            other = {
                (rng.randrange(1, 20), rng.choice(["APP-LOAD", "F-OF-SPC", "*TOTALS*"]))
                for _ in range(rng.randrange(9))
            }
            rows += [(n, rng.randrange(9), kind, rng.uniform(1, 2)) for n, kind in other]
            rng.shuffle(rows)
            blocks.append(block(rows, subcase))
            wanted.append({(n, e if kind == "QUAD4" else 0, kind): f for n, e, kind, f in rows})
        found = common_rows(blocks)
        assert [by_row(found, k) for k in range(4)] == wanted
        is_plate = blocks[0].of_element
        assert np.array_equal(found.element[: is_plate.sum()], blocks[0].element[is_plate])


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        (PLATE[:2], r"its 2 element rows are not those of subcase 1 \(3 rows\): element 8 at grid 2 has no row here"),
        ([*PLATE, (3, 8, "TRIA3", 0.0)], "element 8 at grid 3 has a row only here"),
        ([*PLATE[:2], (3, 8, "TRIA3", 0.0)], "element 8 at grid 2 has no row here"),
        ([(1, 7, "QUAD4", 1.0), (2, 7, "QUAD4", 2.0), (2, 8, "QUAD4", 3.0)], "element 8 is named QUAD4, and TRIA3 in"),
        ([*PLATE, PLATE[0]], "some are given twice"),
        ([(1, 0, "APP-LOAD", 1.0)], "its 0 element rows"),
        ([*PLATE, (1, 0, "*TOTALS*", 1.0), (1, 0, "*TOTALS*", 1.0)], "grid 1 has two totals"),
        ([*PLATE, (1, 0, "APP-LOAD", np.nan)], "no number of sensible size"),
        ([*PLATE, (0, 0, "APP-LOAD", 1.0)], "impossible ids"),
    ],
)
def test_rows_that_must_agree(rows, words):
    """Elements that have forces in one subcase only, names that change, totals given twice."""
    with pytest.raises(DataError, match=words):
        common_rows([block(PLATE), block(rows, 2)])


def test_unit_load_subcases(tmp_path):
    """Static subcases with loads, reactions and totals of their own: the sign is proven, and no light is red."""
    path = tmp_path / "loads.op2"
    (tmp_path / "tee.bdf").write_text(bulk(tee()))
    model = read_bdf(tmp_path / "tee.bdf")
    for shapes in (True, False):
        path.write_bytes(unit_load_op2(shapes=shapes, load_sets=(1, 2, 7)).close())
        found = read_op2(path)
        assert (found.analysis, found.mode.tolist()) == ("static", list(SUBCASES))
        assert np.isnan(found.frequency).all()
        count = 4 * len(tee().model.quads)
        for k, case in enumerate(unit_loads()):
            assert np.array_equal(found.force[k, :count], [row[3] for row in case.rows[:count]])
        rows = {row.check: row for row in audit(found, model).rows}
        assert rows["sign"].finding.endswith("forces on_node")
        assert {row.light for row in rows.values()} == {"green"}
        spoilt = found.force.copy()
        spoilt[2, 40, 1] *= 1.1
        total = {row.check: row for row in audit(replace(found, force=spoilt), model).rows}
        assert total["grid totals"].light == "red"
