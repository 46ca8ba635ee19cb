"""A T joint of bricks with modes, as an FE run delivers it: bulk data with displacement frames, grid point forces."""

from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import csc_array

from fatigue.readers.foreign.fe.results import FeResults
from tests.readers.tee_model import FRAMES
from tests.solid_fe import SolidModel
from tests.solid_meshes import Solids, deck, tee

DENSITY = 7.85e-9


@dataclass(frozen=True)
class SolidTee:
    """The mesh, its model, mass-normalised modes, and forces as NASTRAN writes them (on the node, in CD frames)."""

    solids: Solids
    parabolic: bool
    model: SolidModel
    frequency: np.ndarray
    shape: np.ndarray  # (m, n, 3), basic
    force: np.ndarray  # (m, e, k, 3) on the element, basic
    turned: np.ndarray  # grids with displacement frame 3
    results: FeResults


@cache
def solid_tee(parabolic: bool = False, modes: int = 4) -> SolidTee:
    """The T joint of ``solid_meshes``, held at one edge of its base plate."""
    solids = tee(z=(0.0, 4.0, 10.0))
    grids, elements = solids.parts(parabolic)
    xyz = np.array([grids[n] for n in range(1, len(grids) + 1)])
    bricks = np.array([[*s.corners, *s.mids] for s in elements]) - 1
    model = SolidModel(xyz, bricks)
    dofs = model.dofs()
    row, column = np.broadcast_arrays(dofs[:, :, None], dofs[:, None, :])
    K = csc_array((model.stiffness.ravel(), (row.ravel(), column.ravel())), shape=(xyz.size, xyz.size)).toarray()
    mass = np.repeat(np.full(len(xyz), DENSITY * np.ptp(xyz, axis=0).prod() / len(xyz)), 3)
    free = np.flatnonzero(np.repeat(xyz[:, 1] > 0, 3))
    square, vector = eigh(K[np.ix_(free, free)], np.diag(mass[free]), subset_by_index=(0, modes - 1))
    shape = np.zeros((modes, xyz.size))
    shape[:, free] = vector.T
    shape = shape.reshape(modes, -1, 3)
    force = np.stack([model.element_forces(u) for u in shape])
    frequency = np.sqrt(square) / 2 / np.pi
    turned = np.flatnonzero((xyz[:, 1] == 27) & (xyz[:, 2] <= 10)) + 1
    return SolidTee(
        solids, parabolic, model, frequency, shape, force, turned, _results(model, frequency, shape, force, turned)
    )


def _results(model, frequency, shape, force, turned) -> FeResults:
    modes, ids = len(frequency), np.arange(1, len(model.xyz) + 1)
    node = (model.bricks + 1).ravel()
    element = np.repeat(np.arange(1, len(model.bricks) + 1), model.bricks.shape[1])
    on_node = -force.reshape(modes, -1, 3)
    total = np.stack([[np.bincount(node - 1, f[:, c], ids.size) for c in range(3)] for f in on_node]).transpose(0, 2, 1)
    return FeResults(
        source="solid tee",
        solver="TEST",
        analysis="modal",
        mode=np.arange(1, modes + 1),
        frequency=frequency,
        modal_mass=np.ones(modes),
        node=np.concatenate([node, ids]),
        element=np.concatenate([element, np.zeros(ids.size, np.int64)]),
        kind=np.array(["HEXA"] * node.size + ["*TOTALS*"] * ids.size),
        force=_six(np.concatenate([on_node, total], axis=1), np.concatenate([node, ids]), turned),
        shape_node=ids,
        shape=_six(shape, ids, turned),
    )


def _six(values: np.ndarray, ids: np.ndarray, turned: np.ndarray) -> np.ndarray:
    """Six components in the displacement frames, no moments."""
    out = np.zeros((*values.shape[:2], 6))
    out[..., :3] = values
    rows = np.isin(ids, turned)
    out[:, rows, :3] = out[:, rows, :3] @ FRAMES[3].T
    return out


def solid_bulk(case: SolidTee) -> str:
    """Bulk data of the model; some grids have the rectangular displacement frame 3."""
    lines = deck(case.solids, case.parabolic, extra="CORD2R,3,,0.,0.,0.,0.,0.,1.\n,0.,1.,0.").split("\n")
    turned = {str(n) for n in case.turned.tolist()}
    framed = (f"{line},3" if line.startswith("GRID,") and line.split(",")[1] in turned else line for line in lines)
    return "\n".join(framed)
