"""Proof that stresses stand in the axes they are taken to stand in: they do the work that nodal forces do.

For any constant strain of the mid-surface, and for any constant curvature, the nodal forces of an element do the work
that the stresses in it do (principle of virtual work; exact for every element that passes the patch test). So the mean
membrane stress of an element of area A and thickness t is ``sum(f x + x f) / (2 A t)``, and the bending stress at the
face to which its normal points is ``-6 / (A t^2)`` times the work of its nodal forces on the deflection of a unit
curvature: in the axes of the element, whatever the solver wrote beside them.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.convert.audit.row import AuditRow, Light
from fatigue.readers.convert.audit.shell_rows import elastic_modes, shell_rows
from fatigue.readers.convert.stresses.axes import element_axes
from fatigue.readers.convert.stresses.evaluate import at_faces
from fatigue.readers.foreign.fe.model import FeModel, to_basic
from fatigue.readers.foreign.fe.results import FeResults
from fatigue.readers.foreign.fe.shell_stress import StressBlock
from fatigue.weld.mesh import NONE, centroids

Floats = NDArray[np.float64]
CHECK = "shell stresses"
MEMBRANE_GREEN, MEMBRANE_RED = 0.01, 0.05
BENDING_GREEN, BENDING_RED = 0.1, 0.3
"""Relative differences: of membrane stress 1e-7 in files of MSC, NX and MYSTRAN; of bending stress up to 0.04 where an
element is not exact in constant bending (MIN4T). Axes of another rule differ by 0.05 and more on a distorted mesh."""
_LEAST_SHARE = 1e-2  # of the whole stress: of less than that, a difference is round-off
REMEDY = "Request stresses in element axes (PARAM,OMID,NO) of the same run as the forces, homogeneous shells, REAL"


class _Pairs(NamedTuple):
    """Membrane and bending stress of elements, (m, e, 2, 3) each: of the stress tables, and of the nodal forces."""

    stated: Floats
    proven: Floats
    is_parabolic: NDArray[np.bool_]


def stress_row(results: FeResults, model: FeModel, blocks: Sequence[Sequence[StressBlock]], sign: float) -> AuditRow:
    """Row on the stresses of the modes of ``results``, in the file's own units, against their nodal forces.

    ``blocks`` are those of every mode; ``sign`` turns the forces into those on the elements.
    """
    pairs = _pairs(results, model, blocks, sign)
    if not pairs.is_parabolic.size:
        finding = (
            "no shell has both stresses and grid point forces at all its nodes; the stresses are taken to be in the "
        )
        return AuditRow(
            CHECK, "amber", None, finding + "axes of the elements", "Request GPFORCE for some of the shells"
        )
    linear = _worst(pairs, ~pairs.is_parabolic)
    parabolic = _worst(pairs, pairs.is_parabolic)
    lights = [_light(linear[0], MEMBRANE_GREEN, MEMBRANE_RED), _light(linear[1], BENDING_GREEN, BENDING_RED)]
    lights += [_light(value, BENDING_GREEN, BENDING_RED) for value in parabolic]  # their centre is not their mean
    light: Light = max(lights, key=("green", "amber", "red").index)
    worst = np.fmax(linear, parabolic)
    many = f"{pairs.is_parabolic.size} shells"
    finding = f"stresses of {many} differ from those that their grid point forces do work on by {worst[0]:.2g} of the "
    finding += f"membrane and {worst[1]:.2g} of the bending stress"
    return AuditRow(CHECK, light, float(worst.max()), finding, "" if light == "green" else REMEDY)


def _light(value: float, green: float, red: float) -> Light:
    """Light of a relative difference; NaN, where nothing was compared, is green."""
    return "red" if value > red else "amber" if value > green else "green"


def _worst(pairs: _Pairs, which: NDArray[np.bool_]) -> Floats:
    """Largest relative difference of any mode over the elements chosen, of membrane and of bending stress, (2,)."""
    if not which.any():
        return np.full(2, np.nan)
    difference = np.linalg.norm((pairs.stated - pairs.proven)[:, which], axis=(1, 3))
    size = np.linalg.norm(pairs.proven[:, which], axis=(1, 3))
    size = np.maximum(size, _LEAST_SHARE * np.linalg.norm(size, axis=1)[:, None])
    return np.asarray(np.max(np.where(size > 0, difference / np.where(size > 0, size, 1.0), difference > 0), axis=0))


def _pairs(results: FeResults, model: FeModel, blocks: Sequence[Sequence[StressBlock]], sign: float) -> _Pairs:
    """Stresses at the centres of plain shells that have forces at all their nodes, both ways."""
    mesh, modes = model.mesh, np.flatnonzero(elastic_modes(results))
    axes, centre = element_axes(mesh), centroids(mesh)
    rows = np.flatnonzero(shell_rows(results, model))
    order = rows[np.argsort(results.element[rows], kind="stable")]
    ids, first = np.unique(results.element[order], return_index=True)
    own_rows = dict(zip(ids.tolist(), np.split(order, first[1:]), strict=True))
    plain = np.isfinite(mesh.thickness) & ~np.isin(mesh.pid, list(model.unconfirmed_sections))
    plain &= ~np.isin(mesh.element, list(model.unconfirmed_elements))
    stated: dict[int, list[Floats]] = {}
    for k in modes.tolist():
        for block in blocks[k]:
            faces = at_faces(block, model)[:, 0]  # at the centres
            both = np.stack([faces[:, 0] + faces[:, 1], faces[:, 0] - faces[:, 1]], axis=1) / 2
            for element, one in zip(block.element.tolist(), both, strict=True):
                stated.setdefault(element, []).append(one)
    used = [e for e in sorted(own_rows) if len(stated.get(e, ())) == modes.size]
    at = np.searchsorted(mesh.element, np.array(used, np.int64))
    at = at[plain[at]] if at.size else at
    force = sign * to_basic(results.force[modes], results.node, model).astype(np.float64)
    proven = np.array([_by_work(model, axes[i], centre[i], force, results, own_rows, i) for i in at.tolist()])
    own = np.array([stated[int(mesh.element[i])] for i in at.tolist()])
    shape = (modes.size, at.size, 2, 3)
    return _Pairs(
        np.moveaxis(own, 0, 1).reshape(shape) if at.size else np.zeros(shape),
        np.moveaxis(proven, 0, 1).reshape(shape) if at.size else np.zeros(shape),
        np.asarray((mesh.mid[at] != NONE).any(axis=1)),
    )


def _by_work(
    model: FeModel,
    axes: Floats,
    centre: Floats,
    force: Floats,
    results: FeResults,
    own_rows: dict[int, NDArray[np.int64]],
    i: int,
) -> Floats:
    """Membrane and bending stress (m, 2, 3) of one element by the work of its nodal forces."""
    mesh = model.mesh
    rows = own_rows[int(mesh.element[i])]
    f, m = force[:, rows, :3] @ axes.T, force[:, rows, 3:] @ axes.T
    m = m - np.cross(mesh.offset[i] * np.array([0.0, 0.0, 1.0]), f)  # about the mid-surface
    place = (mesh.xyz[np.searchsorted(mesh.node, results.node[rows])] - centre) @ axes.T
    x, y, t = place[:, 0], place[:, 1], float(mesh.thickness[i])
    around = mesh.xyz[mesh.corner[i]]
    diagonals = (around[2] - around[0], around[3] - around[1] if mesh.corner[i, 3] != NONE else around[1] - around[0])
    area = np.linalg.norm(np.cross(*diagonals)) / 2
    membrane = np.stack([f[..., 0] @ x, f[..., 1] @ y, (f[..., 1] @ x + f[..., 0] @ y) / 2], axis=-1) / (area * t)
    bending = np.stack(
        [
            f[..., 2] @ (x * x / 2) - m[..., 1] @ x,
            f[..., 2] @ (y * y / 2) + m[..., 0] @ y,
            (f[..., 2] @ (x * y) + m[..., 0] @ x - m[..., 1] @ y) / 2,
        ],
        axis=-1,
    )
    return np.stack([membrane, -6.0 * bending / (area * t * t)], axis=1)
