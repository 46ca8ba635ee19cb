"""The local flexibility of the basis at loaded points, held against a static solution of the body."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from fatigue.basis.finding import Finding
from fatigue.basis.loaded.shapes import NO_SHAPES, NO_STATIC, Key, Loaded, told, unit_of
from fatigue.errors import Problem
from fatigue.flexbody.flexibility import flexibility_of_modes

HEADING = "Local flexibility at loaded points"
ENOUGH = 0.95
SOURCE = (
    "computed on one car body with normal modes up to 15, 30 and 60 Hz: 0.95 to 1.00 at points whose interface modes "
    "are kept, 0.11 to 0.90 at points without; no standard"
)
OF_FREE_BODY = (
    "The static solution of a free body is that with inertia relief and without its rigid motion; one with supports is "
    "another number, and the ratio says nothing."
)
ABOVE = 1.02  # a basis is never softer than its body (Rayleigh and Ritz); 2 % for the digits of two files


@dataclass(frozen=True, slots=True)
class FlexibilityRow:
    """One direction of one loaded point; see the columns of ``flexibility``."""

    point: str
    direction: str
    unit: str
    static: float
    index: float
    ratio: float
    normal_share: float
    interface_share: float
    enough: bool | None
    reason: str


def flexibility(loaded: Loaded) -> Finding:
    """The flexibility index of every direction that the case gives shapes or a static solution of."""
    rows = tuple(_row(loaded, key) for key in loaded.keys)
    notes = [f"No flexibility index: {NO_SHAPES}."] if loaded.shapes is None else []
    notes += [] if loaded.static else [f"No ratio: {NO_STATIC}."]
    if rows:
        notes += [
            OF_FREE_BODY,
            f"Enough is a ratio from {ENOUGH:g} on ({SOURCE}).",
        ]
    warnings = (*loaded.warnings, *_too_soft(rows, loaded.static_file))
    return Finding("flexibility", HEADING, tuple(_said(rows)), rows, tuple(notes), warnings)


def indices(loaded: Loaded, key: Key) -> tuple[float, float, str]:
    """Flexibility index of a direction, the part of its interface modes, and why they are empty."""
    shape = loaded.shape(key)
    if shape is None:
        return np.nan, np.nan, NO_SHAPES if loaded.shapes is None else "the file of shapes does not have it"
    if reason := loaded.missing(shape):
        return np.nan, np.nan, reason
    modes, used = loaded.modes, loaded.elastic
    of_modes = flexibility_of_modes(shape[None], modes.modal_mass[used], modes.frequency[used])[0]
    return float(of_modes.sum()), float(of_modes[loaded.of_interface].sum()), ""


def _row(loaded: Loaded, key: Key) -> FlexibilityRow:
    static = loaded.static_of(key)
    index, of_interface, reason = indices(loaded, key)
    ratio = index / static
    if not reason and np.isnan(static):
        reason = NO_STATIC if not loaded.static else "the file of the static solution does not have it"
    of_index = of_interface / index if index > 0.0 else np.nan
    enough = None if np.isnan(ratio) else bool(ratio >= ENOUGH)
    return FlexibilityRow(*key, unit_of(key[1]), static, index, ratio, 1.0 - of_index, of_index, enough, reason)


def _said(rows: Sequence[FlexibilityRow]) -> Iterator[str]:
    known = [row for row in rows if row.enough is not None]
    if not known:
        return
    worst = min(known, key=lambda row: row.ratio)
    short = [row for row in known if not row.enough]
    if not short:
        yield (
            f"The basis has the local flexibility of the body in all {len(known)} directions; the least is "
            f"{worst.ratio:.3g} of it, at {worst.point} {worst.direction}."
        )
        return
    keys = [(row.point, row.direction) for row in sorted(short, key=lambda row: row.ratio)]
    yield (
        f"The basis is too stiff in {len(short)} of {len(known)} directions, most at {worst.point} {worst.direction}, "
        f"where it has {worst.ratio:.3g} of the flexibility of the body: {told(keys)}. Local forces that enter there "
        "are lost to the same extent; residual or constraint modes of these directions bring them back."
    )


def _too_soft(rows: Sequence[FlexibilityRow], file: str) -> Iterator[Problem]:
    """Warning about indices that no basis of this body can have."""
    soft = [row for row in rows if row.ratio > ABOVE]
    if soft:
        worst = max(soft, key=lambda row: row.ratio)
        what = f"the modes alone have {worst.ratio:.4g} times the flexibility of the static solution at {worst.point} "
        what += f"{worst.direction}, and no basis is softer than its body (limit {ABOVE:g}, of Rayleigh and Ritz)"
        remedy = "Check units (mm, N, t), the modal masses behind the shapes, and that the solution has inertia relief"
        yield Problem("soft_basis", file, what, remedy, len(soft))
