"""How many independent directions the interface modes of a body give to each point where forces enter it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.basis.finding import Finding
from fatigue.basis.loaded.shapes import NO_SHAPES, Floats, Loaded
from fatigue.flexbody.flexibility import NOT_MOVED, Spanned, spanned
from fatigue.shown import few

HEADING = "Interface modes at loaded points"
ALL = "(all points)"
RIGID_MOTIONS = 6  # of the interface as a whole: a free body carries them as rigid motion, not as modes
RIGID_APART = (
    "up to six combinations are missing: the rigid motions of the loaded points, which constraint modes hold and a "
    "free body carries apart; with attachment modes none would be missing"
)
NOTICEABLE = 0.3  # of a unit vector: directions that make up a lost combination


@dataclass(frozen=True, slots=True)
class InterfaceRow:
    """One loaded point, or all of them together; see the columns of ``interface``."""

    point: str
    directions: int
    given: str
    interface_modes: int | None
    independent: int | None
    complete: bool | None
    lost: str
    reason: str


def interface(loaded: Loaded) -> Finding:
    """Interface modes of every loaded point, and of all points together."""
    if loaded.shapes is None:
        return Finding("interface", HEADING, notes=(f"No interface modes per loaded point: {NO_SHAPES}.",))
    rows = tuple(_rows(loaded))
    notes = [
        "Loads of several points share the modes: a point that is complete alone may not be together with the others.",
    ]
    notes += [RIGID_APART] if any(row.reason == RIGID_APART for row in rows) else []
    return Finding("interface", HEADING, tuple(_said(rows, loaded)), rows, tuple(notes))


def _rows(loaded: Loaded) -> Iterator[InterfaceRow]:
    assert loaded.shapes is not None
    shapes = loaded.shapes
    for point in shapes.points:
        rows = np.flatnonzero(np.array(shapes.point) == point)
        yield _row(loaded, point, rows)
    if len(shapes.points) > 1:
        yield _row(loaded, ALL, np.arange(len(shapes.point)))


def _row(loaded: Loaded, point: str, rows: NDArray[np.intp]) -> InterfaceRow:
    """Some rows of the file of shapes."""
    assert loaded.shapes is not None
    names = [
        direction if point != ALL else f"{name} {direction}"
        for name, direction in ((loaded.shapes.point[i], loaded.shapes.direction[i]) for i in rows.tolist())
    ]
    given = " ".join(names) if point != ALL else f"{len(names)} directions of {len(loaded.shapes.points)} points"
    shape = loaded.shapes.value[rows][:, loaded.elastic]
    if reasons := [reason for row in shape if (reason := loaded.missing(row))]:
        return InterfaceRow(point, len(rows), given, None, None, None, "", reasons[0])
    in_root_of_flexibility = shape / _root_of_stiffness(loaded)
    of_all = np.linalg.norm(in_root_of_flexibility, axis=1)
    of_interface = in_root_of_flexibility[:, loaded.of_interface]
    moving = int((np.abs(of_interface) > NOT_MOVED * of_all[:, None]).any(axis=0).sum())
    found = spanned(of_interface, of_all)
    complete = found.rank >= len(rows)
    if point == ALL and max(1, len(rows) - RIGID_MOTIONS) <= found.rank < len(rows):
        return InterfaceRow(point, len(rows), given, moving, found.rank, None, "", RIGID_APART)
    lost = "" if complete else _lost(found, names, few_only=point == ALL)
    return InterfaceRow(point, len(rows), given, moving, found.rank, complete, lost, "")


def _root_of_stiffness(loaded: Loaded) -> Floats:
    """w_i sqrt(m_i) of the elastic modes (e,), which takes the normalisation out of a shape."""
    used = loaded.elastic
    return np.asarray(2.0 * np.pi * loaded.modes.frequency[used] * np.sqrt(loaded.modes.modal_mass[used]))


def _lost(found: Spanned, names: Sequence[str], *, few_only: bool) -> str:
    """What no interface mode follows, in words."""
    still = [names[i] for i in np.flatnonzero(found.not_moved).tolist()]
    combined = [
        " with ".join(names[i] for i in np.flatnonzero(np.abs(vector) > NOTICEABLE).tolist())
        or names[int(np.abs(vector).argmax())]
        for vector in found.lost
    ]
    every = [*still, *dict.fromkeys(combined)]
    return few(every) if few_only else ", ".join(every)


def _said(rows: Sequence[InterfaceRow], loaded: Loaded) -> Iterator[str]:
    if not loaded.of_interface.any():
        yield "The basis has no interface modes: the loaded points have the local flexibility of normal modes alone."
        return
    known = [row for row in rows if row.complete is not None and row.point != ALL]
    short = [row for row in known if not row.complete]
    if known and not short:
        yield f"The interface modes follow every given direction of each of the {len(known)} loaded points."
    if short:
        each = few([f"{row.point} ({row.independent} of {row.directions}, not {row.lost})" for row in short])
        yield (
            f"{len(short)} of {len(known)} loaded points have fewer independent interface modes than loaded directions "
            f"and lose local force: {each}."
        )
    for row in rows:
        if row.point == ALL and row.complete is False:
            yield (
                f"All points together have {row.independent} independent interface motions for {row.directions} loaded "
                "directions: forces at several points share modes, and what is left of them is not local."
            )
