"""A T joint with modes, as an FE run delivers it: bulk data with displacement frames, and grid point forces."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from fatigue.readers.foreign.fe.results import FeResults
from tests.shell_fe import ShellModel, grid, joined

FRAMES = {3: np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])}
"""Displacement frame of some grids: axes in rows."""


@dataclass(frozen=True)
class Tee:
    """The model, its modes and its grid point forces in NASTRAN's convention (on the node, in displacement frames)."""

    model: ShellModel
    frequency: np.ndarray
    shape: np.ndarray  # (m, n, 6), basic
    element_force: np.ndarray  # (m, e, 4, 6) on the element, basic
    turned: np.ndarray  # grids with displacement frame 3
    results: FeResults


@cache
def tee(modes: int = 5) -> Tee:
    """A base plate of 120 x 80 x 8 mm, fixed at two edges, with an upright of 60 x 40 x 6 mm along its middle."""
    base = grid(np.linspace(0, 120, 13), np.linspace(0, 80, 9))
    xz, quads = grid(np.linspace(30, 90, 7), np.linspace(0, 40, 5))
    upright = np.column_stack([xz[:, 0], np.full(len(xz), 40.0), xz[:, 1]]), quads
    xyz, quads = joined(base, upright)
    thickness = np.where(np.arange(len(quads)) < len(base[1]), 8.0, 6.0)
    model = ShellModel(xyz, quads, thickness)
    fixed = np.zeros((len(xyz), 6), bool)
    fixed[(xyz[:, 0] < 1) | (xyz[:, 0] > 119)] = True
    frequency, shape = model.modes(modes, fixed)
    force = np.stack([model.element_forces(u) for u in shape])
    turned = np.flatnonzero((xyz[:, 1] == 40) & (xyz[:, 0] > 50) & (xyz[:, 0] < 90)) + 1
    return Tee(model, frequency, shape, force, turned, _results(model, frequency, shape, force, turned))


def _local(values: np.ndarray, ids: np.ndarray, turned: np.ndarray) -> np.ndarray:
    """Components in the displacement frames."""
    out = values.copy()
    rows = np.isin(ids, turned)
    for part in (slice(0, 3), slice(3, 6)):
        out[:, rows, part] = out[:, rows, part] @ FRAMES[3].T
    return out


def turned_frames(values: np.ndarray, ids: np.ndarray) -> np.ndarray:
    """Components, (m, r, 6), in the displacement frames of the T joint's grids."""
    return _local(values, ids, tee().turned)


def _results(model, frequency, shape, force, turned) -> FeResults:
    elements, m = len(model.quads), len(frequency)
    ids = np.arange(1, len(model.xyz) + 1)
    node = (model.quads + 1).ravel()
    element = np.repeat(np.arange(1, elements + 1), 4)
    on_node = -force.reshape(m, -1, 6)
    total = np.stack([[np.bincount(node - 1, f[:, c], len(ids)) for c in range(6)] for f in on_node]).transpose(0, 2, 1)
    all_node = np.concatenate([node, ids])
    return FeResults(
        source="tee",
        solver="TEST",
        analysis="modal",
        mode=np.arange(1, m + 1),
        frequency=frequency,
        modal_mass=np.ones(m),
        node=all_node,
        element=np.concatenate([element, np.zeros(len(ids), np.int64)]),
        kind=np.array(["QUAD4"] * len(node) + ["*TOTALS*"] * len(ids)),
        force=_local(np.concatenate([on_node, total], axis=1), all_node, turned),
        shape_node=ids,
        shape=_local(shape, ids, turned),
    )


def bulk(tee_model: Tee, extra: str = "") -> str:
    """Bulk data of the model; some grids have the rectangular displacement frame 3."""
    lines = [
        "SOL 103",
        "CEND",
        "SET 7 = 1 THRU 3",
        "BEGIN BULK",
        "CORD2R,3,,0.,0.,0.,0.,0.,1.",
        ",0.,1.,0.",
        "PSHELL,1,1,8.,1,,1",
        "PSHELL,2,1,6.,1,,1",
    ]
    for k, (x, y, z) in enumerate(tee_model.model.xyz.tolist(), start=1):
        lines.append(f"GRID,{k},,{x:.6f},{y:.6f},{z:.6f},{3 if k in tee_model.turned else ''}")
    for k, (corners, t) in enumerate(
        zip(tee_model.model.quads.tolist(), tee_model.model.thickness, strict=True), start=1
    ):
        lines.append(f"CQUAD4,{k},{1 if t == 8 else 2}," + ",".join(str(c + 1) for c in corners))
    return "\n".join([*lines, extra, "ENDDATA", ""])
