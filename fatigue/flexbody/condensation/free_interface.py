"""Free interface: modes of the free body, and what they lack of the static answer to each load that may enter."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.flexbody.factor import NAMES, FreeBody
from fatigue.flexbody.modes import free_modes
from fatigue.flexbody.structure import Structure

Floats = NDArray[np.float64]

NOTHING_LEFT = 1e-10  # of the flexibility under a load: the modes have all of it, and what is left is rounding


def free_interface(body: FreeBody, loads: Floats, *, upto_hz: float | None = None, count: int | None = None) -> Floats:
    """T (n, 6 + k + c) = [X_r, Phi_k, X_res]: rigid motions, free modes, residual attachment modes of the ``loads``.

    ``X_res = X_a - Phi_k diag(1/w_k^2) Phi_k' F``, with X_a the inertia-relief answer to the columns F (n, c): what the
    modes leave of the static answer. Exact for static loads of these columns, whatever the cut. Each X_res is
    orthogonal to the modes, which come out of the reduced body as they are; one that is only rounding is 0.

    Parameters
    ----------
    loads : (n, c) a unit force or moment in each column, at one row or shared by several nodes (``shared_load``)
    upto_hz, count : one of both; modes of the free body up to a frequency, or so many

    Source: Craig and Chang, AIAA 18th Structures Conference (1977); MacNeal 1971; Rubin 1975.
    """
    normal = free_modes(body, upto_hz=upto_hz, count=count)
    Phi, w2 = normal.shapes, (2.0 * np.pi * normal.frequency) ** 2
    X_a = body.elastic(loads)
    X_res = X_a - (Phi / w2) @ (Phi.T @ loads)
    flexibility, left = np.einsum("ij,ij->j", loads, X_a), np.einsum("ij,ij->j", loads, X_res)
    X_res[:, left <= NOTHING_LEFT * flexibility] = 0.0
    return np.hstack([body.rigid, Phi, X_res])


def shared_load(
    structure: Structure, nodes: Sequence[int], direction: int, share: Sequence[float] | None = None
) -> Floats:
    """Column (n,) of a unit force or moment that some nodes share, evenly or in proportion to ``share``.

    ``direction`` is 0, 1, 2 for a force along x, y, z, and 3, 4, 5 for a moment about them. What moves with it, in the
    sense of work, is the mean of the nodes by the same shares: ``F' X``.

    Raises
    ------
    ValueError : no nodes, or one that has no such degree of freedom
    """
    weight = np.ones(len(nodes)) if share is None else np.asarray(share, dtype=np.float64)
    if not len(nodes) or not weight.sum() > 0.0:
        raise ValueError("a load needs a node that bears it")
    F = np.zeros(len(structure.node))
    of_direction = np.flatnonzero(structure.direction == direction)
    for node, part in zip(nodes, weight / weight.sum(), strict=True):
        row = of_direction[structure.node[of_direction] == node]
        if not row.size:
            raise ValueError(f"node {node} has no degree of freedom {NAMES[direction]}")
        F[row[0]] += part
    return F
