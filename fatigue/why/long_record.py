"""Damage under a long record shared out with no more of it in memory than some chunks of time.

What a point owes is the same as of a short record: the vectors of ``fatigue.life.attribution`` are laid on the samples
in a file, cycle after cycle as they close, transformed there, and multiplied with the transformed coordinates of the
modes chunk by chunk.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple, TypeGuard

import numpy as np
from numpy.typing import NDArray

from fatigue.life.attribution import CycleCredit, cycle_credit
from fatigue.life.counting.long_rainflow import Piece, long_cycles
from fatigue.life.records.history import LONG_NUMBERS, LONGEST_TRANSFORM, Residue, stress_record
from fatigue.life.records.long_transform import AT_ONCE
from fatigue.life.records.spool import CHUNK, Samples, Spool, create_spool, time_slices
from fatigue.life.rule import CycleRule
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.readers.neutral.body.modes import Modes
from fatigue.spectrum.long_bands import long_band_slices, long_coefficients
from fatigue.why.points import Points

Floats = NDArray[np.float64]

STRESS_AT_ONCE = 4_000_000  # samples of the points that are shared out together
COUNTED_AT_ONCE = 16 * CHUNK  # samples
_SIGNS = np.array([-1.0, 1.0])  # at the start and at the end of a cycle


class Row(NamedTuple):
    """Row of a point in a record of stresses: membrane above bending; side, factor of the thickness, rule, offset."""

    first: int
    side: float
    size: float
    rule: CycleRule
    offset: float


class PointSums(NamedTuple):
    """What the cycles of a point add up to, as in ``fatigue.why.attribute.EventAttribution``, in one pass."""

    damage: float
    top_cycle: float
    load_slope: float
    thickness_slope: float
    by_offset: float
    place: Floats


def is_long(q: Samples) -> TypeGuard[Spool]:
    """Whether modal coordinates are on disk, and too many to be held in memory in double precision."""
    modes, samples = q.shape
    return isinstance(q, Spool) and (samples > LONGEST_TRANSFORM or modes * samples > LONG_NUMBERS)


def long_blocks(
    points: Points, load: EventLoad, q: Spool, modes: Modes, edges_hz: Floats, place_s: Floats
) -> Iterator[dict[str, Floats]]:
    """Some points after the other: what ``fatigue.why.attribute`` makes of them in one pass of the event.

    Raises
    ------
    DataError : the disk is full
    """
    m, samples = q.shape
    step, residue = load.counted.step, load.residue
    bands = long_band_slices(samples, step, residue, edges_hz)
    half_width = 2.0 * modes.damping_ratio * modes.frequency
    resonance = [
        long_band_slices(samples, step, residue, [f - width, f + width])[1] if np.isfinite(width) else None
        for f, width in zip(modes.frequency, half_width, strict=True)
    ]
    resonance += [None] * (m - len(resonance))  # unit loads
    double = np.dtype(np.float64)
    Q = create_spool(q.path.with_name("coefficients"), q.shape, double)
    _transform(q, Q, residue)
    for first in range(0, len(points), max(1, STRESS_AT_ONCE // samples)):
        some = points.of(slice(first, first + max(1, STRESS_AT_ONCE // samples)))
        p = len(some)
        modal_m, modal_b = load.stress_factor * some.membrane, load.stress_factor * some.bending
        stress = stress_record(np.stack([modal_m, modal_b], axis=1).reshape(2 * p, m), q)
        laid = create_spool(q.path.with_name("laid"), (3 * p, samples), double)
        modal_s = modal_m + some.side[:, None] * modal_b
        of_points = zip(some.side, some.size, some.rule, modal_s @ load.offset, strict=True)
        rows = [Row(2 * i, *of) for i, of in enumerate(of_points)]
        sums = [lay_damage(stress, row, load, laid, 3 * i, place_s) for i, row in enumerate(rows)]
        _transform(laid, laid, residue)
        products, resonant = _products(laid, Q, bands, resonance)
        owed = modal_s[:, :, None] * products[0::3]
        slope = modal_m[:, :, None] * products[1::3] + modal_b[:, :, None] * products[2::3]
        by_offset = np.array([of.by_offset for of in sums])[:, None] * load.offset
        slope[:, :, 0] += modal_s * by_offset  # what is constant has the frequency 0
        constant = by_offset * (modal_m + 2.0 * some.side[:, None] * modal_b)
        load_slope = np.array([of.load_slope for of in sums])
        yield {
            "damage": np.array([of.damage for of in sums]),
            "top_cycle": np.array([of.top_cycle for of in sums]),
            "load_slope": load_slope,
            "thickness_slope": np.array([of.thickness_slope for of in sums]) - constant.sum(axis=1),
            "rule_slope": load_slope * some.size_exponent,
            "mode": owed.sum(axis=2),
            "mode_slope": slope.sum(axis=2),
            "resonant": modal_s * resonant,
            "band": owed.sum(axis=1),
            "band_slope": slope.sum(axis=1),
            "place": np.stack([of.place for of in sums]),
        }
    for name in ("coefficients", "laid", "stress"):
        q.path.with_name(name).unlink(missing_ok=True)


def long_damage(stress: Samples, row: Row, residue: Residue, *, vertex: bool) -> float:
    """Miner sum of one point in one pass."""
    return float(sum(of.damage.sum() for _, of in _credits(stress, row, residue, vertex=vertex)))


def _credits(stress: Samples, row: Row, residue: Residue, *, vertex: bool) -> Iterator[tuple[Piece, CycleCredit]]:
    """Cycles of one point, some at a time, and their damage."""

    def chunks() -> Iterator[tuple[Floats, Floats]]:
        for first in range(0, stress.shape[1], COUNTED_AT_ONCE):
            membrane, bending = stress[row.first : row.first + 2, first : first + COUNTED_AT_ONCE]
            yield membrane, bending

    for piece in long_cycles(chunks, row.side, residue, vertex=vertex):
        own = row.side, row.size, row.rule, row.offset
        yield piece, cycle_credit(piece.membrane.T, piece.bending.T, piece.weight, *own)


def lay_damage(stress: Samples, row: Row, load: EventLoad, laid: Spool, first: int, place_s: Floats) -> PointSums:
    """Lay the damage of a point on three rows of samples: share, derivatives by membrane and by bending stress."""
    damage = top_cycle = load_slope = thickness_slope = by_offset = 0.0
    place = np.zeros(len(place_s) - 1)
    for piece, of in _credits(stress, row, load.residue, vertex=load.vertex):
        by_stress = of.by_range[:, None] * _SIGNS
        by_stress[np.arange(len(by_stress)), of.peak_at_end.astype(np.intp)] += of.by_peak
        by_membrane, by_bending = by_stress, row.side * by_stress
        if of.by_ratio is not None:
            by_membrane = by_membrane - of.by_ratio[0][:, None] * _SIGNS
            by_bending = by_bending + of.by_ratio[1][:, None] * _SIGNS
        laying = np.stack([(of.share[:, None] * _SIGNS).ravel(), by_membrane.ravel(), by_bending.ravel()])
        _add_reversals(laid, slice(first, first + 3), piece, laying, vertex=load.vertex)
        time = load.counted.start + load.counted.step * piece.at.ravel()
        bins = np.clip(np.searchsorted(place_s, time, side="right") - 1, 0, len(place) - 1)
        place += np.bincount(bins, np.repeat(0.5 * of.damage, 2), len(place))
        damage += float(of.damage.sum())
        top_cycle = max(top_cycle, float(of.damage.max(initial=0.0)))
        load_slope += float(of.slope.sum())
        by_offset += float(of.by_peak.sum())
        thickness_slope -= float(np.sum(by_membrane * piece.membrane) + 2.0 * np.sum(by_bending * piece.bending))
    return PointSums(damage, top_cycle, load_slope, thickness_slope, by_offset, place)


def _add_reversals(laid: Spool, rows: slice, piece: Piece, values: Floats, *, vertex: bool) -> None:
    """Add values (n, 2 c) at the two reversals of each cycle, those at vertices to the samples they are read from."""
    at, p = piece.at.ravel(), piece.shift.ravel()
    if not vertex:
        _add(laid, rows, at, values)
        return
    for away, part in ((-1, 0.5 * p * (p - 1.0)), (0, 1.0 - p**2), (1, 0.5 * p * (p + 1.0))):
        _add(laid, rows, (at + away) % laid.shape[1], values * part)  # ends that have no neighbour do not move


def _add(laid: Spool, rows: slice, at: NDArray[np.int64], values: Floats) -> None:
    """Add values (n, v) to some rows at the samples ``at`` (v,), chunk by chunk."""
    order = np.argsort(at, kind="stable")
    at, values = at[order], values[:, order]
    chunk = at // CHUNK
    for a, b in pairwise([*np.flatnonzero(np.diff(chunk, prepend=-1)), len(at)]):
        first = int(chunk[a]) * CHUNK
        samples = slice(first, min(first + CHUNK, laid.shape[1]))
        width = samples.stop - first
        more = np.stack([np.bincount(at[a:b] - first, value, width) for value in values[:, a:b]])
        laid[rows, samples] = laid[rows, samples] + more


def _transform(rows: Spool, into: Spool, residue: Residue) -> None:
    """Write the coefficients of all rows; they may take the place of the rows."""
    samples = rows.shape[1]
    for first in range(0, rows.shape[0], 2):
        pair = slice(first, first + 2)
        scratch = into.path.with_name(f"{into.path.name}-transform")
        with long_coefficients(lambda a, b, pair=pair: rows[pair, a:b], samples, residue, scratch) as found:  # type: ignore[misc]
            for begin in range(0, samples, AT_ONCE):
                end = min(begin + AT_ONCE, samples)
                into[pair, begin:end] = found(begin, end)


def _products(
    laid: Spool, Q: Spool, bands: Sequence[slice], resonance: Sequence[slice | None]
) -> tuple[Floats, Floats]:
    """Products of all rows with all modes, band by band, (n, m, b), and of the shares with each mode in resonance.

    The latter are (p, m) of every third row; NaN for a mode without damping.
    """
    n, m = laid.shape[0], Q.shape[0]
    products = np.zeros((n, m, len(bands)))
    resonant = np.where([own is None for own in resonance], np.nan, np.zeros((n // 3, m)))
    for part in time_slices((n + m, Q.shape[1])):
        x, y = laid[:, part], Q[:, part]
        for b, band in enumerate(bands):
            inner = _within(band, part)
            products[:, :, b] += x[:, inner] @ y[:, inner].T
        for k, own in enumerate(resonance):
            if own is not None:
                inner = _within(own, part)
                resonant[:, k] += x[::3, inner] @ y[k, inner]
    return products, resonant


def _within(band: slice, part: slice) -> slice:
    """Places of a band in a part that begins at ``part.start``, those that lie in it."""
    length = part.stop - part.start
    return slice(*(min(max(place - part.start, 0), length) for place in (band.start, band.stop)))
