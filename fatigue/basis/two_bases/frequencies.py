"""Which normal modes of two bases are the same mode of the body, by the stress they make at the welds."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from fatigue.basis.finding import Finding
from fatigue.basis.loaded.shapes import elastic
from fatigue.readers.neutral.body.modes import Modes
from fatigue.shown import few

Floats = NDArray[np.float64]

HEADING = "Two bases: frequencies of the same modes"
SAME = 1e-6  # of a frequency
ALIKE = 0.8  # squared cosine from which two modes are taken for one; unlike ones stay below a half
BY_STRESS = (
    "Modes are matched by their stress at the welds. Interface modes depend on what a reduction keeps and have no "
    "partners."
)
NO_POINTS = "the cases share no point of a weld"


@dataclass(frozen=True, slots=True)
class ModesRow:
    """One normal mode of the first case; see the columns of ``bases_modes``."""

    mode: int
    frequency_hz: float
    other_mode: int | None
    other_frequency_hz: float
    frequency_ratio: float
    likeness: float
    reason: str


def corresponding_modes(modes: tuple[Modes, Modes], stress: tuple[Floats, Floats]) -> Finding:
    """Normal modes of two bases matched one to one, so that their likeness is the greatest in all.

    ``stress`` (p, c) are the modal stresses of both at the points they share, modes first. Interface modes depend on
    what a reduction keeps and are not matched.
    """
    first, second = (np.flatnonzero(elastic(one) & (np.array(one.kind) == "normal")) for one in modes)
    shared = len(stress[0])
    if not shared or not first.size or not second.size:
        note = NO_POINTS if not shared else "a case has no normal modes"
        return Finding("bases_modes", HEADING, notes=(f"No modes are compared: {note}.",))
    likeness = modal_likeness(stress[0][:, first], stress[1][:, second])
    mine, theirs = linear_sum_assignment(likeness, maximize=True)
    partner = dict(zip(mine.tolist(), theirs.tolist(), strict=True))
    rows = tuple(_row(modes, first, second, i, partner.get(i), likeness) for i in range(len(first)))
    taken = {row.other_mode for row in rows}
    alone = [int(mode) for mode in modes[1].mode[second] if int(mode) not in taken]
    notes = [BY_STRESS]
    notes += [f"Normal modes of the other case without a partner: {few(alone)}."] if alone else []
    return Finding("bases_modes", HEADING, tuple(_said(rows)), rows, tuple(notes))


def modal_likeness(first: Floats, second: Floats) -> Floats:
    """Squared cosine between all columns of two matrices (p, a) and (p, b): (a, b), 0 where a column is 0 (MAC)."""
    product = (first.T @ second) ** 2
    size = np.outer((first**2).sum(axis=0), (second**2).sum(axis=0))
    return np.minimum(np.divide(product, size, out=np.zeros_like(product), where=size > 0.0), 1.0)


def _row(
    modes: tuple[Modes, Modes],
    first: NDArray[np.intp],
    second: NDArray[np.intp],
    i: int,
    j: int | None,
    likeness: Floats,
) -> ModesRow:
    mode, hz = int(modes[0].mode[first[i]]), float(modes[0].frequency[first[i]])
    if j is None or likeness[i, j] < ALIKE:
        best = float(likeness[i].max())
        reason = f"no mode is left that is alike from {ALIKE:g} on"
        return ModesRow(mode, hz, None, np.nan, np.nan, best, reason)
    other_hz = float(modes[1].frequency[second[j]])
    return ModesRow(mode, hz, int(modes[1].mode[second[j]]), other_hz, other_hz / hz, float(likeness[i, j]), "")


def _said(rows: Sequence[ModesRow]) -> Iterator[str]:
    known = [row for row in rows if row.other_mode is not None]
    if not known:
        yield f"None of the {len(rows)} normal modes has a partner in the other case."
        return
    of_all = f"{len(known)} of {len(rows)} normal modes have a partner in the other case"
    most = max(known, key=lambda row: abs(float(np.log(row.frequency_ratio))))
    if abs(most.frequency_ratio - 1.0) < SAME:
        yield f"{of_all}, all at the same frequency."
        return
    yield (
        f"{of_all}; most differs mode {most.mode}, "
        f"{most.frequency_hz:.4g} Hz, which has {most.frequency_ratio:.4g} times its frequency there."
    )
