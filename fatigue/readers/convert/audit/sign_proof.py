"""The sign of grid point forces: on the element (K u) or on the node (-K u), proven by work or by applied loads."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.convert.audit.row import AuditRow
from fatigue.readers.convert.audit.shell_rows import plate_rows, whole_rows
from fatigue.readers.foreign.fe.model import FeModel
from fatigue.readers.foreign.fe.results import REQUEST, FeResults
from fatigue.readers.neutral.body.modes import LOWEST_HZ
from fatigue.readers.neutral.forces.convention import Convention

WORK_TOLERANCE = 2e-3
_CLEAR = 1e-4
"""Of the size of its terms: a smaller work may be their round-off."""
_ONE_SIGN = 0.8
"""Share of the works of all elements that must be left when they are added with their signs."""


class SignProof(NamedTuple):
    """What decides the sign: the number, the convention it proves (None: nothing), and the number in words.

    ``contradiction``: why forces and shapes cannot come from one run, empty if nothing says so; ``odd``: elements
    that do work of the other sign, in words, empty if there are none.
    """

    value: float | None
    convention: Convention | None
    finding: str
    contradiction: str = ""
    odd: str = ""


class _Works(NamedTuple):
    """Work of each mode's shape on the forces of each element, (m, e), and the size of its terms; elements, (e,)."""

    work: NDArray[np.float64]
    terms: NDArray[np.float64]
    element: NDArray[np.int64]

    def of_elements(self, elements: NDArray[np.int64]) -> "_Works":
        """Return the works of some elements."""
        some = np.isin(self.element, elements)
        return _Works(self.work[:, some], self.terms[:, some], self.element[some])

    def have_both_signs(self) -> NDArray[np.bool_]:
        """Modes whose works have clearly both signs, (m,)."""
        size = np.abs(self.work).sum(axis=1)
        is_clear = size > _CLEAR * self.terms.sum(axis=1)
        return np.asarray(is_clear & (np.abs(self.work.sum(axis=1)) <= _ONE_SIGN * size))


def sign_row(results: FeResults, model: FeModel, stated: Convention | None) -> tuple[AuditRow, Convention | None]:
    """Row on the sign, proven beside stated; and the convention that holds, None if nothing decides it."""
    value, found, finding, contradiction, odd = prove_sign(
        results, whole_rows(results, model), plate_rows(results, model)
    )
    if found is None:
        remedy = "State the sign convention; prove it with the one-element tension patch" if stated is None else REQUEST
        return AuditRow("sign", "amber", value, f"{finding}: the sign is not proven", remedy), stated
    if stated is not None and found != stated:
        remedy = f"State {found}, or give the mode shapes of the same run"
        return AuditRow("sign", "red", value, f"{finding}: forces {found}, but {stated} is stated", remedy), found
    if contradiction:
        remedy = "Give forces and mode shapes of one run"
        return AuditRow("sign", "red", value, f"{finding}: {contradiction}", remedy), found
    if odd:
        remedy = "Look at these elements: damaged forces look so, those under a strong preload may"
        return AuditRow("sign", "amber", value, f"{finding}: forces {found}; {odd}", remedy), found
    return AuditRow("sign", "green", value, f"{finding}: forces {found}"), found


def prove_sign(results: FeResults, whole: NDArray[np.bool_], shells: NDArray[np.bool_]) -> SignProof:
    """Proof of the sign convention from the work of the shapes, or else from loads and reactions.

    ``whole``: (r,) rows of elements that have forces at all their nodes, as far as known; only their work is a strain
    energy. ``shells``: the rows among them that the mesh proves to be whole; they alone can contradict.
    """
    if results.shape_node.size:
        proof = _by_work(results, whole, shells)
        if proof.convention is not None or results.analysis == "modal":
            return proof
    proof = _by_loads(results)
    if results.analysis == "modal":
        proof = proof._replace(finding=f"the file has no mode shapes; {proof.finding}")
    return proof


def _element_works(results: FeResults, whole: NDArray[np.bool_]) -> _Works:
    """Work of each mode's shape on the forces of each element that has all its rows."""
    rows = np.flatnonzero(whole)
    at = np.minimum(np.searchsorted(results.shape_node, results.node[rows]), results.shape_node.size - 1)
    has_shape = results.shape_node[at] == results.node[rows]
    rows, at = rows[has_shape], at[has_shape]
    elements, element = np.unique(results.element[rows], return_inverse=True)
    work, terms = (np.empty((results.mode.size, elements.size)) for _ in range(2))
    for k in range(results.mode.size):
        product = results.force[k, rows].astype(np.float64) * results.shape[k, at]
        work[k] = np.bincount(element, product.sum(axis=1), elements.size)
        terms[k] = np.bincount(element, np.abs(product).sum(axis=1), elements.size)
    return _Works(work, terms, elements)


def _by_work(results: FeResults, whole: NDArray[np.bool_], shells: NDArray[np.bool_]) -> SignProof:
    """Work of each mode shape on its own forces, over omega^2 m: -1 for forces on nodes, +1 on elements.

    Without generalised masses work over omega^2 gives them, and its sign is the proof. Without a frequency, the signs
    of the elements' own works decide: a strain energy is never negative. Rigid modes, whatever frequency round-off
    gives them, have element works of either sign and prove nothing; above the lowest elastic mode there are none.
    """
    works = _element_works(results, whole)
    work, size = works.work.sum(axis=1), np.abs(works.work).sum(axis=1)
    if not size.any():
        return SignProof(None, None, "the mode shapes do no work on the forces")
    known = np.isfinite(results.modal_mass)
    elastic = np.nan_to_num((2 * np.pi * results.frequency) ** 2 * np.where(known, results.modal_mass, 1.0))
    is_clear = np.abs(work) > _ONE_SIGN * size
    sure = works.of_elements(results.element[shells])
    usable = (results.frequency > LOWEST_HZ) & (elastic > 0) & is_clear
    if usable.any():
        proof = _by_energy(work[usable] / elastic[usable], bool(known[usable].all()))
        static = is_clear & np.isin(results.mode, results.static_modes)
        other = static & (np.sign(work) != np.sign(proof.value or 0.0))
        if other.any():
            finding = (
                f"{proof.finding}; the forces of {results.called(int(results.mode[other][0]))} have the other sign"
            )
            return SignProof(proof.value, None, finding)
        of_another = sure.have_both_signs() & (results.frequency >= results.frequency[usable].min())
        if of_another.any():
            found = f"in mode {results.mode[of_another][0]} the elements do work of both signs, as if its shape were "
            return proof._replace(contradiction=proof.contradiction or f"{found}that of another mode")
        return proof._replace(odd=_odd_elements(results.mode, sure, usable, np.sign(proof.value or 0.0)))
    balance_of_signs = float(work.sum() / size.sum())
    given = "static subcases" if results.analysis == "static" else "no elastic mode has a frequency"
    if results.analysis == "modal" and (results.frequency > LOWEST_HZ).any():
        given = "in no mode with a frequency have the works of the elements one sign"
    text = f"{given}; work of the elements is {abs(balance_of_signs):.1%} of one sign"
    if abs(balance_of_signs) < _ONE_SIGN:
        return SignProof(balance_of_signs, None, text)
    convention: Convention = "on_node" if balance_of_signs < 0 else "on_element"
    odd = _odd_elements(results.mode, sure, is_clear, np.sign(balance_of_signs))
    return SignProof(balance_of_signs, convention, text, odd=odd)


def _odd_elements(mode: NDArray[np.int64], works: _Works, usable: NDArray[np.bool_], sign: float) -> str:
    """Elements whose work is clearly negative, in words; the work of a stiffness never is."""
    is_odd = usable[:, None] & (sign * works.work < -_CLEAR * works.terms)
    if not is_odd.any():
        return ""
    k, e = np.argwhere(is_odd)[0]
    count = int(is_odd.any(axis=0).sum())
    return (
        f"{count} of {works.element.size} elements do work of the other sign, element {works.element[e]} in mode "
        f"{mode[k]} the first"
    )


def _by_energy(ratio: NDArray[np.float64], has_mass: bool) -> SignProof:
    """Proof by work over omega^2 times the generalised mass; without masses its size tells nothing."""
    worst = float(ratio[np.argmax(np.abs(ratio))])
    over = "omega^2 m" if has_mass else "omega^2, the generalised mass,"
    text = f"work over {over} from {ratio.min():.5g} to {ratio.max():.5g} in {ratio.size} modes"
    if ratio.min() < 0 < ratio.max():
        return SignProof(worst, None, text)
    if has_mass and abs(worst) < 1 - WORK_TOLERANCE:
        text += " (the forces cover a part of the model)"
    too_much = "more work than the mode has energy" if has_mass and abs(worst) > 1 + WORK_TOLERANCE else ""
    return SignProof(worst, "on_node" if worst < 0 else "on_element", text, too_much)


def _by_loads(results: FeResults) -> SignProof:
    """Element rows plus loads and reactions vanish for forces on nodes; they are equal for forces on elements.

    In a mode that holds, too, where a support keeps the inertia from moving.
    """
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
