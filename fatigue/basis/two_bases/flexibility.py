"""The local flexibility of two bases at the loaded points that both know."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from fatigue.basis.finding import Finding
from fatigue.basis.loaded.flexibility import indices
from fatigue.basis.loaded.shapes import NO_SHAPES, Key, Loaded, unit_of

HEADING = "Two bases: local flexibility at loaded points"
AGREE = 1e-3  # of the static solution that both cases give


@dataclass(frozen=True, slots=True)
class BothFlexibilityRow:
    """One direction of one loaded point in both cases; see the columns of ``bases_flexibility``."""

    point: str
    direction: str
    unit: str
    index: float
    other_index: float
    ratio: float
    static: float
    reason: str


def flexibilities(first: Loaded, second: Loaded) -> Finding:
    """Flexibility index of both bases in every direction that either case gives."""
    lacks = [name for name, one in (("the first", first), ("the other", second)) if one.shapes is None]
    if lacks:
        note = f"Local flexibility is not compared: {NO_SHAPES}, {' and '.join(lacks)} case."
        return Finding("bases_flexibility", HEADING, notes=(note,))
    keys = first.keys + [key for key in second.keys if key not in first.keys]
    rows = tuple(_row(first, second, key) for key in keys)
    notes = tuple(_notes(first, second, keys))
    return Finding("bases_flexibility", HEADING, tuple(_said(rows)), rows, notes, second.warnings)


def _row(first: Loaded, second: Loaded, key: Key) -> BothFlexibilityRow:
    index, _, reason = indices(first, key)
    other_index, _, of_other = indices(second, key)
    reason = reason and f"first case: {reason}"
    of_other = of_other and f"other case: {of_other}"
    static = first.static_of(key)
    static = second.static_of(key) if np.isnan(static) else static
    ratio = other_index / index if index > 0.0 else np.nan
    return BothFlexibilityRow(*key, unit_of(key[1]), index, other_index, ratio, static, reason or of_other)


def _notes(first: Loaded, second: Loaded, keys: Sequence[Key]) -> Iterator[str]:
    """Doubt about two static solutions of one body."""
    both = [(key, first.static_of(key), second.static_of(key)) for key in keys]
    differing = [key for key, a, b in both if abs(a - b) > AGREE * a]
    if differing:
        point, direction = differing[0]
        yield (
            f"The static solutions of the cases differ in {len(differing)} directions, first at {point} {direction}: "
            "they are of two bodies, or of two sets of supports. That of the first case is shown."
        )


def _said(rows: Sequence[BothFlexibilityRow]) -> Iterator[str]:
    known = [row for row in rows if not np.isnan(row.ratio)]
    if not known:
        return
    low, high = min(known, key=lambda row: row.ratio), max(known, key=lambda row: row.ratio)
    yield (
        f"The other basis has {low.ratio:.3g} ({low.point} {low.direction}) to {high.ratio:.3g} ({high.point} "
        f"{high.direction}) times the local flexibility of the first; the softer one is nearer to the body."
    )
