"""The sign of grid point forces: on the element (K u) or on the node (-K u), proven by work or by applied loads."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.fe_results import FeResults
from fatigue.readers.forces import Convention

LOWEST_HZ = 1e-3
"""Below it a frequency is the round-off of a rigid mode."""


class SignProof(NamedTuple):
    """What decides the sign: the number, the convention it proves (None: nothing), and the number in words."""

    value: float | None
    convention: Convention | None
    finding: str


def prove_sign(results: FeResults) -> SignProof:
    """Find the sign convention from the work of mode shapes, or from the loads of static subcases."""
    if results.shape_node.size:
        proof = _by_work(results)
        if proof.convention is not None or results.analysis == "modal":
            return proof
    if results.analysis == "static":
        return _by_loads(results)
    return SignProof(None, None, "the file has no mode shapes")


def _by_work(results: FeResults) -> SignProof:
    """Work of each mode shape on its own forces, over omega^2 m: -1 for forces on nodes, +1 on elements.

    Without a frequency and a generalised mass, the signs of the elements' own works decide: a strain energy is never
    negative.
    """
    rows = np.flatnonzero(results.of_element)
    at = np.minimum(np.searchsorted(results.shape_node, results.node[rows]), results.shape_node.size - 1)
    known = results.shape_node[at] == results.node[rows]
    rows, at = rows[known], at[known]
    work = np.einsum(
        "mri,mri->mr", results.force[:, rows].astype(np.float64), results.shape[:, at].astype(np.float64), optimize=True
    )
    elastic = np.nan_to_num((2 * np.pi * results.frequency) ** 2 * results.modal_mass)
    usable = (results.frequency > LOWEST_HZ) & (elastic > 0)
    if usable.any():
        ratio = work[usable].sum(axis=1) / elastic[usable]
        k = int(np.argmax(np.abs(ratio)))
        text = f"work over omega^2 m from {ratio.min():.5g} to {ratio.max():.5g} in {usable.sum()} modes"
        if (ratio < 0).all() or (ratio > 0).all():
            if abs(ratio[k]) < 1 - 2e-3:
                text += " (the forces cover a part of the model)"
            return SignProof(float(ratio[k]), "on_node" if ratio[k] < 0 else "on_element", text)
        return SignProof(float(ratio[k]), None, text)
    _, element = np.unique(results.element[rows], return_inverse=True)
    each = np.stack([np.bincount(element, w) for w in work])
    total = np.abs(each).sum()
    if total == 0:
        return SignProof(None, None, "the mode shapes do no work on the forces")
    balance_of_signs = float(each.sum() / total)
    lack = "frequency" if not (results.frequency > LOWEST_HZ).any() else "generalised mass"
    given = "static subcases" if results.analysis == "static" else f"no mode has a {lack}"
    text = f"{given}; work of the elements is {abs(balance_of_signs):.1%} of one sign"
    if abs(balance_of_signs) < 0.8:
        return SignProof(balance_of_signs, None, text)
    return SignProof(balance_of_signs, "on_node" if balance_of_signs < 0 else "on_element", text)


def _by_loads(results: FeResults) -> SignProof:
    """Element rows plus loads and reactions vanish for forces on nodes; they are equal for forces on elements."""
    is_load = ~results.of_element & ~results.of_total
    if not is_load.any():
        return SignProof(None, None, "no applied loads or reactions in the file")
    grids, at = np.unique(results.node, return_inverse=True)

    def sums(rows: NDArray[np.bool_]) -> NDArray[np.float64]:
        force = np.nan_to_num(results.force[:, rows, :3].astype(np.float64))  # NaN: not a row of this subcase
        out = np.zeros((results.mode.size, grids.size, 3))
        for total, each in zip(out, force, strict=True):
            np.add.at(total, at[rows], each)
        return out

    internal, external = sums(results.of_element), sums(is_load)
    scale = float(np.abs(external).max())
    if scale == 0:
        return SignProof(None, None, "all applied loads and reactions are zero")
    correlation = -float((internal * external).sum() / (external * external).sum())
    finding = f"element forces are {-correlation:+.5f} times the loads and reactions at their grids"
    if abs(abs(correlation) - 1) > 0.1:
        return SignProof(correlation, None, finding)
    return SignProof(-correlation, "on_node" if correlation > 0 else "on_element", finding)
