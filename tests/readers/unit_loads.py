"""Unit-load subcases of the T joint, the static modes of its interfaces, as a solver writes them."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from tests.readers.op2_writer import PLAIN, Op2Writer
from tests.readers.tee_model import tee, turned_frames

SUBCASES = (21, 22, 23)


@dataclass(frozen=True)
class UnitLoad:
    """Displacements (n, 6) under a unit load, basic; force rows (node, element, name, six values) as in the file."""

    displacement: np.ndarray
    rows: list
    shape: list


@cache
def unit_loads():
    """Three unit loads at the upright's edge: each has its own APP-LOAD row, the third no reaction at some supports."""
    case = tee()
    xyz = case.model.xyz
    fixed = np.zeros((len(xyz), 6), bool)
    fixed[(xyz[:, 0] < 1) | (xyz[:, 0] > 119)] = True
    grids = np.arange(1, len(xyz) + 1)
    at = [int(np.flatnonzero((xyz == place).all(axis=1))[0]) for place in ([30, 40, 40], [60, 40, 40], [90, 40, 40])]
    found = []
    for k, (grid, direction) in enumerate(zip(at, (0, 1, 2), strict=True)):
        load = np.zeros((len(xyz), 6))
        load[grid, direction] = 1.0
        u = case.model.solve(load, fixed)
        force = -case.model.element_forces(u).reshape(1, -1, 6)
        node = (case.model.quads + 1).ravel()
        total = np.stack([np.bincount(node - 1, force[0, :, c], len(xyz)) for c in range(6)], axis=1)
        local = turned_frames(force, node)[0]
        rows = [
            (int(n), int(e), "QUAD4", f.tolist())
            for n, e, f in zip(node, np.repeat(np.arange(1, len(case.model.quads) + 1), 4), local, strict=True)
        ]
        # Solvers leave the id of the element before in rows that are no element's.
        rows.append((grid + 1, 100 + k, "APP-LOAD", turned_frames(load[None], grids)[0, grid].tolist()))
        held = np.flatnonzero(fixed[:, 0])
        for n in held if k < 2 else held[:-1]:
            rows.append((int(n) + 1, 50 + k, "F-OF-SPC", (-total[n]).tolist()))
        rows += [(int(n), 7 * k, "*TOTALS*", [0.0] * 6) for n in grids if k < 2 or n != held[-1] + 1]
        shape = turned_frames(u[None], grids)[0].tolist()
        found.append(UnitLoad(u, rows, [*zip(grids.tolist(), shape, strict=True)]))
    return tuple(found)


def unit_load_op2(writer=None, shapes=True, load_sets=(0, 0, 0), subcases=SUBCASES):
    """An OP2 file, or more tables of one begun, with a table of each kind for every subcase, as some solvers write."""
    writer = writer or Op2Writer(8, dialect=PLAIN)
    for subcase, load_set, case in zip(subcases, load_sets, unit_loads(), strict=True):
        if shapes:
            head = writer.identification(1, 1, load_set, 8, subcase=subcase)
            writer.table("OUGV1", [head, writer.shape(case.shape)])
        head = writer.identification(1, 19, load_set, 10, subcase=subcase, device=2)
        writer.table("OGPFB1", [head, writer.forces(case.rows)])
    return writer
