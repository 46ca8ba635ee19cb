"""Free interface: modes of the free body, and what they lack of the static answer to each load that may enter."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.flexbody.condensation.inertia_relief import FreeBody
from fatigue.flexbody.condensation.lowest import DENSE, all_modes, lowest, wanted_of
from fatigue.flexbody.structure import Structure

Floats = NDArray[np.float64]


def shared_load(
    structure: Structure, nodes: Sequence[int], direction: int, weight: Sequence[float] | None = None
) -> Floats:
    """Column (n,) of a unit force or moment that some nodes share, evenly or by ``weight`` (they then sum up to 1).

    ``direction`` is 0, 1, 2 for a force along x, y, z and 3, 4, 5 for a moment about them. The motion that does work
    with it is the mean of the nodes: ``F' X``.

    Raises
    ------
    ValueError : a node has no such degree of freedom
    """
    share = np.full(len(nodes), 1.0) if weight is None else np.asarray(weight, dtype=np.float64)
    share = share / share.sum()
    F = np.zeros(len(structure.node))
    for node, part in zip(nodes, share, strict=True):
        row = np.flatnonzero((structure.node == node) & (structure.direction == direction))
        if not row.size:
            raise ValueError(f"node {node} has no degree of freedom along direction {direction}")
        F[row[0]] += part
    return F


def free_modes_of(body: FreeBody, upto_hz: float | None = None, count: int | None = None) -> tuple[Floats, Floats]:
    """Frequencies (k,) [Hz], ascending, and shapes (n, k) with unit modal mass of a free body, no rigid motion in them.

    Modes up to a frequency, or so many; with neither, all of them, which takes a dense matrix.
    """
    K, M, free = body.structure.K, body.structure.M, body.free
    if K.shape[0] <= DENSE or (upto_hz is None and (count is None or 2 * count > K.shape[0])):
        lever = (body.rigid.T @ M)[:, free]
        of_elastic = M[free][:, free].toarray() - lever.T @ lever  # mass of shapes less their rigid motion
        frequency, held = wanted_of(*all_modes(K[free][:, free].toarray(), of_elastic), upto_hz, count)
        shapes = np.zeros((K.shape[0], len(frequency)))
        shapes[free] = held
        return frequency, shapes - body.rigid @ (body.rigid.T @ (M @ shapes))
    return lowest(K, M, body.answer, upto_hz, count, rigid=body.rigid.shape[1])


def free_interface(body: FreeBody, loads: Floats, upto_hz: float | None = None, count: int | None = None) -> Floats:
    """T (n, r + k + c) = [X_r, Phi_k, X_res]: rigid motions, free modes, residual attachment modes of the ``loads``.

    ``X_res = X_a - Phi_k diag(1/w_k^2) Phi_k' F`` with X_a the inertia-relief answer to the columns F (n, c): what the
    modes leave of the static answer. Exact for static loads of these patterns, whatever the cut.

    Source: Craig and Chang 1977; MacNeal 1971; Rubin 1975.
    """
    frequency, Phi = free_modes_of(body, upto_hz, count)
    w2 = (2.0 * np.pi * frequency) ** 2
    return np.hstack([body.rigid, Phi, body.answer(loads) - (Phi / w2) @ (Phi.T @ loads)])
