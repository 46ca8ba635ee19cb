"""Loads on the elements beside welds: their own share of an applied load is no part of the forces K u that files hold.

A grid point force balance states applied loads by grid (APP-LOAD), summed over the elements there, and the forces of
elements as K_e u_e. The cut beside a weld needs K_e u_e - f_e, with f_e the element's share of the load at its grids:
without it the line force of a plate under pressure is off by l / 2L, for elements of length l beside a field of length
L. The share is estimated here by area, among the elements that are loaded at all their grids; it is not subtracted.
Cuts of solids are not looked at.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.convert.weld_lines import FoundWelds
from fatigue.readers.foreign.fe.model import FeModel
from fatigue.readers.foreign.fe.results import FeResults
from fatigue.weld.mesh import NONE, ShellMesh

LIMIT = 0.01
"""Share of the forces beside a weld that its own load may have: 1 % of the stress is 4 % of the life."""

_APPLIED = "APP-LOAD"
_NOTHING = 1e-9  # of the largest applied force


def loads_at_welds(results: FeResults, model: FeModel, found: FoundWelds) -> list[Problem]:
    """Warning about unit loads on the elements beside welds, with the weld that they matter to most."""
    shares = [
        (share, name, weld)
        for k, name in _unit_loads(results)
        for weld, share in _shares(_applied(results, k, model.mesh), results, k, model.mesh, found)
        if share > LIMIT
    ]
    if not shares:
        return []
    worst, name, weld = max(shares)
    what = f"unit load {name} acts on the elements beside weld {weld}: their own load is about {worst:.1%} of the "
    what += f"forces there (told above {LIMIT:.0%}), and forces K u lack it"
    if len(shares) > 1:
        what += f"; so do those at {len({weld for _, _, weld in shares})} welds under "
        what += f"{len({name for _, name, _ in shares})} loads"
    remedy = "Refine the mesh beside the weld (the error is half an element over the length of the loaded field), or "
    remedy += "give K u - f_e with elements_carry_load = true"
    return [Problem("load_on_elements", results.source, what, remedy, len(shares))]


def _unit_loads(results: FeResults) -> Sequence[tuple[int, str]]:
    """Place and name of every unit load."""
    return [(k, results.unit_loads[m]) for k, m in enumerate(results.mode.tolist()) if m in results.unit_loads]


def _applied(results: FeResults, k: int, mesh: ShellMesh) -> NDArray[np.float64]:
    """Size of the applied force at every node of the mesh, (n,)."""
    rows = np.flatnonzero((results.kind == _APPLIED) & np.isin(results.node, mesh.node))
    at = np.searchsorted(mesh.node, results.node[rows])
    size = np.linalg.norm(np.nan_to_num(results.force[k, rows, :3].astype(np.float64)), axis=1)
    return np.bincount(at, size, mesh.node.size).astype(np.float64)


def _shares(
    applied: NDArray[np.float64], results: FeResults, k: int, mesh: ShellMesh, found: FoundWelds
) -> Sequence[tuple[str, float]]:
    """Own load of the elements beside every weld, over their forces at it."""
    around = np.concatenate([mesh.corner, mesh.mid], axis=1)
    is_node = around != NONE
    is_loaded = ((applied[around] > _NOTHING * applied.max(initial=0.0)) | ~is_node).all(axis=1)
    if not is_loaded.any():
        return []
    area = np.where(is_loaded, _areas(mesh), 0.0)
    total = np.bincount(around[is_node], np.broadcast_to(area[:, None], around.shape)[is_node], mesh.node.size)
    own_rows = np.flatnonzero(results.of_element)
    own_rows = own_rows[np.argsort(results.element[own_rows], kind="stable")]
    element = results.element[own_rows]
    shares = []
    for row, cut in found.assessed():
        if cut.columns:
            continue
        beside = np.searchsorted(mesh.element, np.sort(cut.elements))
        if not is_loaded[beside].any():
            continue
        line = np.searchsorted(mesh.node, cut.line.node)
        here = np.isin(around[beside], line) & is_node[beside]
        side = np.bincount(around[beside][here], np.broadcast_to(area[beside, None], here.shape)[here], total.size)
        load = np.divide(applied * side, total, out=np.zeros(total.size), where=total > 0)[line].sum()
        first, last = (np.searchsorted(element, mesh.element[beside], side=end) for end in ("left", "right"))
        rows = own_rows[np.concatenate([np.arange(a, b) for a, b in zip(first, last, strict=True)])]
        rows = rows[np.isin(results.node[rows], cut.line.node)]
        node, at = np.unique(results.node[rows], return_inverse=True)
        force = np.zeros((node.size, 3))
        np.add.at(force, at, results.force[k, rows, :3].astype(np.float64))
        size = float(np.linalg.norm(force, axis=1).sum())
        shares.append((row.weld, float(load / size) if size > 0 else np.inf))
    return shares


def _areas(mesh: ShellMesh) -> NDArray[np.float64]:
    """Area of every element between its corners, (e,) [mm^2]."""
    a, b, c, d = (mesh.xyz[mesh.corner[:, k]] for k in range(4))
    is_triangle = (mesh.corner[:, 3] == NONE)[:, None]
    vector = np.where(is_triangle, np.cross(b - a, c - a), np.cross(c - a, d - b))
    return np.asarray(0.5 * np.linalg.norm(vector, axis=1))
