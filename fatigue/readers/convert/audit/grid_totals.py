"""The total that a file states for every grid: a checksum over all its numbers, where it is one.

MSC Nastran and its kin state the sum of all rows of the grid: loads, reactions and the forces of the elements on it,
which in a mode leaves the inertia force. MYSTRAN writes the forces on the elements and states loads and reactions less
these, and in a mode less the inertia force too, for which it writes no row: its totals of modes vanish, and no sum
of rows can be compared with them.

Totals of static cases vanish, and so do those that contain the inertia force: where they do not, the solver's own
forces are out of balance.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.convert.audit.row import AuditRow
from fatigue.readers.foreign.fe.results import FeResults
from fatigue.readers.neutral.forces.convention import Convention

TOLERANCE = 1e-3
"""Of the largest row of the grid, or a thousandth of the mode's largest."""

_VANISHING = 1e-6
_ROUND_OFF = 1e-6


@dataclass(frozen=True, slots=True)
class TotalsCheck:
    """How well the rows of the grids explain their totals, and whether totals vanish that have to.

    Attributes
    ----------
    residual, grid, mode : largest difference, relative to the largest row of its grid, and where it is
    rule : how the rows give the totals, in words
    is_checksum : whether the totals can be expected to follow from the rows at all
    rest, rest_grid, rest_mode : largest total that equilibrium does not allow, relative likewise, and where it is
    """

    residual: float
    grid: int
    mode: int
    rule: str
    is_checksum: bool
    rest: float
    rest_grid: int
    rest_mode: int

    @property
    def is_met(self) -> bool:
        """Whether all totals follow from their rows."""
        return self.residual <= TOLERANCE

    @property
    def is_in_balance(self) -> bool:
        """Whether all totals vanish that have to."""
        return self.rest <= TOLERANCE


@dataclass(slots=True)
class _Tally:
    """Misses of one rule over all grids and modes."""

    sign: float
    rule: str
    misses: int = 0
    worst: float = 0.0
    grid: int = 0
    mode: int = 0


class _Total(NamedTuple):
    """Largest total of a mode relative to its grid's rows, where it is, and the mode's largest row."""

    size: float
    grid: int
    mode: int
    scale: float


def totals_row(results: FeResults, convention: Convention | None) -> AuditRow:
    """Row on the totals that the file states: where they follow from the rows, a checksum over every number."""
    found = check_totals(results, convention)
    if found is None:
        return AuditRow(
            "grid totals",
            "amber",
            None,
            "the file states no totals to check the rows against",
            "Rely on the element balance",
        )
    value = found.residual
    if not found.is_in_balance and (found.is_met or not found.is_checksum):
        return AuditRow(
            "grid totals",
            "red" if convention == "on_element" else "amber",
            found.rest,
            f"the solver states a rest of {found.rest:.2g} of the largest row at grid {found.rest_grid} in "
            f"{results.called(found.rest_mode)}: its forces on the elements do not balance loads and reactions",
            "Look for elements that write no forces, inertia relief, modes that have not converged, reduced degrees of "
            "freedom; in MYSTRAN for plates with offsets (ZOFFS), whose forces it recovers wrongly",
        )
    if found.is_met:
        return AuditRow(
            "grid totals", "green", value, f"the rows of every grid {found.rule} its total within {value:.2g}"
        )
    if not found.is_checksum:
        return AuditRow(
            "grid totals",
            "amber",
            None,
            "the totals contain inertia forces that the file has no rows for (as MYSTRAN's): they are no check",
            "Rely on the element balance",
        )
    return AuditRow(
        "grid totals",
        "red",
        value,
        f"the rows of grid {found.grid} in {results.called(found.mode)} miss their stated total by {value:.2g} of the "
        "largest row",
        "Copy the file again or repeat the run: a number is damaged, or rows are missing",
    )


def check_totals(results: FeResults, convention: Convention | None) -> TotalsCheck | None:
    """Comparison of the totals of every grid with its rows, by the rule that explains them best; None without totals.

    Parameters
    ----------
    convention : sign of the element rows, where it is known
    """
    is_total = results.of_total
    if not is_total.any():
        return None
    of_element = results.of_element
    kinds = [np.flatnonzero(rows) for rows in (~of_element & ~is_total, of_element, is_total)]
    grids, at = np.unique(results.node, return_inverse=True)
    added = _Tally(1.0, "add up to")
    subtracted = _Tally(-1.0, "give, loads less forces on elements,")
    largest_totals: list[_Total] = []
    for mode, force in zip(results.mode.tolist(), results.force, strict=True):
        is_here = ~np.isnan(force[:, 0])  # a row that is no element's may belong to other modes
        stated = np.bincount(at[is_total & is_here], minlength=grids.size) > 0
        of_mode = float(np.abs(force[is_here]).max(initial=0.0))
        for part in (slice(0, 3), slice(3, 6)):
            values = np.where(is_here[:, None], force[:, part], 0.0).astype(np.float64)
            loads, elements, totals = (_sums(values[rows], at[rows], grids.size) for rows in kinds)
            size = np.abs(values).max(axis=1, initial=0.0)
            largest = np.zeros(grids.size)
            np.maximum.at(largest, at, size)
            scale = np.maximum(largest, TOLERANCE * size.max(initial=0.0))
            is_more = stated & (np.abs(totals).max(axis=1) > _ROUND_OFF * of_mode)  # moments may be round-off only
            rest = _relative(totals, scale, is_more)
            k = int(rest.argmax())
            largest_totals.append(_Total(float(rest[k]), int(grids[k]), mode, of_mode))
            for tally in (added, subtracted):
                residual = _relative(loads + tally.sign * elements - totals, scale, stated)
                tally.misses += int((residual > TOLERANCE).sum())
                if residual.max() > tally.worst:
                    k = int(residual.argmax())
                    tally.worst, tally.grid, tally.mode = float(residual[k]), int(grids[k]), mode
    order = (subtracted, added) if convention == "on_element" else (added, subtracted)
    best = min(order, key=lambda tally: tally.misses)
    vanish = max(total.size for total in largest_totals) <= _VANISHING
    hides_inertia = results.analysis == "modal" and (convention == "on_element" or vanish)
    rest_of = _forbidden(largest_totals, results, hides_inertia)
    is_checksum = best.misses == 0 or not hides_inertia
    where = (rest_of.size, rest_of.grid, rest_of.mode)
    return TotalsCheck(best.worst, best.grid, best.mode, best.rule, is_checksum, *where)


def _forbidden(totals: list[_Total], results: FeResults, hides_inertia: bool) -> _Total:
    """Largest total that has to vanish: of static cases, and of modes where it contains the inertia force.

    Rigid modes, whose forces are round-off, tell nothing.
    """
    static = set(results.mode.tolist() if results.analysis == "static" else results.static_modes)
    of_modes = [total for total in totals if total.mode not in static]
    floor = _ROUND_OFF * max((total.scale for total in of_modes), default=0.0)
    kept = [total for total in totals if total.mode in static]
    if hides_inertia:
        kept += [total for total in of_modes if total.scale > floor]
    return max(kept, default=_Total(0.0, 0, 0, 0.0))


def _sums(values: NDArray[np.float64], at: NDArray[np.int64], size: int) -> NDArray[np.float64]:
    """Sums of the rows of every grid, (grids, 3)."""
    return np.stack([np.bincount(at, values[:, c], size) for c in range(3)], axis=1)


def _relative(
    values: NDArray[np.float64], scale: NDArray[np.float64], stated: NDArray[np.bool_]
) -> NDArray[np.float64]:
    """Largest component of every grid relative to its scale, 0 where no total is stated."""
    size = np.abs(values).max(axis=1)
    return np.asarray(np.divide(size, scale, out=np.zeros(scale.size), where=scale > 0) * stated)
