"""Stresses at read-outs, mode by mode, from the blocks of a file."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.convert.stresses.weights import Available, Terms
from fatigue.readers.foreign.fe.model import FeModel
from fatigue.readers.foreign.fe.shell_stress import CENTRE, REQUEST, StressBlock

Floats = NDArray[np.float64]


def at_faces(block: StressBlock, model: FeModel) -> Floats:
    """Stress at the two faces of every element and point of a block, (e, p, 2, 3): first where its normal points.

    Stress is linear through the thickness, so that fibres of any distances give that of the faces. Of a section that is
    no plain plate the outer fibres are taken as they are.

    Raises
    ------
    DataError : both fibres at one distance, as curvatures have
    """
    mesh = model.mesh
    at = np.minimum(np.searchsorted(mesh.element, block.element), mesh.element.size - 1)
    low, high = block.fibre[..., 0].astype(np.float64), block.fibre[..., 1].astype(np.float64)
    same = low == high
    if same.any():
        element = block.element[same.any(axis=1)][0]
        what = (
            f"both fibres of element {element} are at {low[same][0]:g}: a mean and a curvature are no stresses of faces"
        )
        raise DataError(
            Problem("curvature", block.where, what, "Request STRESS with Z1 and Z2 of the PSHELL left blank")
        )
    pid, thickness = mesh.pid[at], mesh.thickness[at]
    is_plain = np.isfinite(thickness) & ~np.isin(pid, list(model.unconfirmed_sections))
    is_plain &= ~np.isin(block.element, list(model.unconfirmed_elements))
    half = np.where(is_plain, thickness, 0.0)[:, None] / 2
    face = (
        np.where(is_plain[:, None], half, np.maximum(low, high)),
        np.where(is_plain[:, None], -half, np.minimum(low, high)),
    )
    stress = block.stress.astype(np.float64)
    slope = (stress[:, :, 1] - stress[:, :, 0]) / (high - low)[..., None]
    return np.stack([stress[:, :, 0] + slope * (z - low)[..., None] for z in face], axis=2)


def at_read_outs(terms: Terms, blocks: Sequence[StressBlock], model: FeModel, count: int) -> Floats:
    """Stress (count, 2, 3) at the top and the bottom of every read-out in one mode.

    Raises
    ------
    DataError : an element without stresses
    """
    found = np.zeros((count, 2, 3))
    is_given = np.zeros(terms.element.size, np.bool_)
    for block in blocks:
        order = np.argsort(block.element, kind="stable")
        at = order[np.minimum(np.searchsorted(block.element, terms.element, sorter=order), order.size - 1)]
        hit = (block.element[at] == terms.element) & ~is_given
        same = block.node[at] == terms.node[:, None]
        hit &= same.any(axis=1)
        if not hit.any():
            continue
        faces = at_faces(block, model)[at[hit], same[hit].argmax(axis=1)]
        faces = np.where((terms.top[hit] > 0)[:, None, None], faces, faces[:, ::-1])
        np.add.at(found, terms.read_out[hit], np.einsum("nij,nfj->nfi", terms.turn[hit], faces))
        is_given |= hit
    if not is_given.all():
        k = int(is_given.argmin())
        node = f" at node {terms.node[k]}" if terms.node[k] != CENTRE else ""
        where = blocks[0].where if blocks else "stresses"
        what = f"element {terms.element[k]} has no stress{node}"
        raise DataError(Problem("no_stress_of_element", where, what, REQUEST))
    return found


def available(blocks: Sequence[StressBlock]) -> Available:
    """Ids of the elements that have stresses, and of those that have them at their corners."""
    corners = frozenset(int(e) for block in blocks if block.has_corners for e in block.element)
    return Available(corners | {int(e) for block in blocks for e in block.element}, corners)
