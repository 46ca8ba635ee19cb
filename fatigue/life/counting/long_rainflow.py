"""Every cycle of a long record, piece by piece, as ``rainflow`` lists them: same cycles, same order.

The stress comes in chunks of time. Of a block that recurs the largest sample is found first; counting begins there,
goes to the end of the record and on from its first sample. Between two chunks only the reversals wait that are open,
with their membrane and bending stress, so that memory does not grow with the record. Where reversals are read at their
vertices the chunks are moved as they come (``long_vertices``), with one sample held back for its neighbour.
"""

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled
from fatigue.life.counting.long_vertices import moved
from fatigue.life.records.history import Residue

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
Chunks = Callable[[], Iterator[tuple[Floats, ...]]]  # membrane and bending stress, and shifts where there are any

FEWEST = 1 << 16  # cycles of a piece, but for the last one


class Piece(NamedTuple):
    """Some cycles: sample indices (c, 2) of start and end, stresses there (c, 2) [MPa], and weight (c,), 1 or 0.5.

    ``shift`` (c, 2) is how far from the samples they were read [steps].
    """

    at: Indices
    stress: Floats
    membrane: Floats
    bending: Floats
    weight: Floats
    shift: Floats


class _Open(NamedTuple):
    """Reversals that are open, a stack: structural, membrane, bending stress and shift (r, 4); sample indices (r,)."""

    values: Floats
    at: Indices


class _Now(NamedTuple):
    """Where counting stands.

    ``places`` (3,) are bottom and top of the stack, and the direction of the last step, 0 before there is any;
    ``last`` (4,) are the stresses and the shift of the last sample, ``last_at`` (1,) is its index.
    """

    places: Indices
    last: Floats
    last_at: Indices


def long_cycles(chunks: Chunks, side: float, residue: Residue, *, vertex: bool = False) -> Iterator[Piece]:
    """Cycles of ``membrane + side * bending``; ``chunks()`` gives both (t,), chunk of time after chunk, anew.

    With ``vertex`` each reversal is read at its vertex.
    """
    recurs = residue == "repeat"
    chunks = moved(chunks, side, recurs=recurs) if vertex else chunks
    first = _largest_sample(chunks, side) if recurs else 0
    stack = _Open(np.empty((64, 4)), np.empty(64, np.int64))
    now = _Now(np.array([0, -1, 0]), np.empty(4), np.full(1, -1))
    held: list[Piece] = []
    for begin, membrane, bending, *shifts in _turned(chunks, first, again=recurs):
        stress = membrane + side * bending
        shift = shifts[0] if shifts else np.zeros(len(stress))
        depth = int(now.places[1] - now.places[0]) + 1
        stack = _with_room(stack, depth + len(stress) + 2)
        found = _room_for(depth + len(stress) + 2)
        held.append(_some(found, take_samples(stress, membrane, bending, shift, begin, stack, now, recurs, found)))
        if sum(len(piece.weight) for piece in held) >= FEWEST:
            yield _joined(held)
            held = []
    found = _room_for(int(now.places[1] - now.places[0]) + 3)
    stack = _with_room(stack, int(now.places[1]) + 3)
    held.append(_some(found, close_rest(stack, now, recurs, found)))
    yield _joined(held)


def _turned(chunks: Chunks, first: int, *, again: bool) -> Iterator[tuple[Any, ...]]:
    """Chunks, with the index of their first sample, from a sample to the end and on to that sample, ``again``."""
    begin = 0
    for chunk in chunks():
        skipped = min(max(0, first - begin), len(chunk[0]))
        if skipped < len(chunk[0]):
            yield begin + skipped, *(part[skipped:] for part in chunk)
        begin += len(chunk[0])
    if not again:
        return
    begin = 0
    for chunk in chunks():
        some = min(len(chunk[0]), first + 1 - begin)
        if some <= 0:
            return
        yield begin, *(part[:some] for part in chunk)
        begin += len(chunk[0])


def _largest_sample(chunks: Chunks, side: float) -> int:
    """Index of the first largest sample, of a plateau the last one of it."""
    largest, at, begin = -np.inf, 0, 0
    for membrane, bending, *_ in chunks():
        largest, at = find_largest(membrane + side * bending, begin, largest, at)
        begin += len(membrane)
    return int(at)


def _with_room(stack: _Open, reversals: int) -> _Open:
    """Stack with room for more reversals."""
    more = max(0, reversals - len(stack.at))
    if not more:
        return stack
    return _Open(np.pad(stack.values, ((0, more), (0, 0))), np.pad(stack.at, (0, more)))


def _room_for(cycles: int) -> Piece:
    pair = (cycles, 2)
    s, m, b, shift = (np.empty(pair) for _ in range(4))
    return Piece(np.empty(pair, np.int64), s, m, b, np.empty(cycles), shift)


def _some(found: Piece, cycles: int) -> Piece:
    return Piece._make(array[:cycles].copy() for array in found)


def _joined(pieces: list[Piece]) -> Piece:
    return Piece._make(np.concatenate(arrays) for arrays in zip(*pieces, strict=True))


@compiled()
def find_largest(s: Floats, begin: int, largest: float, at: int) -> tuple[float, int]:
    """Largest sample so far and its index, of its first plateau the last one, from what was known before a chunk."""
    for i in range(s.size):
        if s[i] > largest or (s[i] == largest and at == begin + i - 1):
            largest, at = s[i], begin + i
    return largest, at


@compiled()
def close_last(stack: _Open, now: _Now, recurs: bool, cycles: int, found: Piece) -> int:
    """Append the last sample to the open reversals and close what it closes, as ``reversals.close_cycles`` does."""
    values, at, places = stack.values, stack.at, now.places
    places[1] += 1
    values[places[1]], at[places[1]] = now.last, now.last_at[0]
    while places[1] - places[0] >= 2:
        top = places[1]
        X = abs(values[top, 0] - values[top - 1, 0])
        Y = abs(values[top - 1, 0] - values[top - 2, 0])
        if X < Y:
            break
        put_cycle(stack, top - 2, cycles, found)
        if top - places[0] == 2 and not recurs:
            found.weight[cycles] = 0.5
            places[0] += 1
        else:
            found.weight[cycles] = 1.0
            values[top - 2], at[top - 2] = values[top], at[top]
            places[1] -= 2
        cycles += 1
    return cycles


@compiled()
def put_cycle(stack: _Open, k: int, cycle: int, found: Piece) -> None:
    """Write the cycle between an open reversal and the one above it."""
    for j in range(2):
        found.at[cycle, j] = stack.at[k + j]
        found.stress[cycle, j] = stack.values[k + j, 0]
        found.membrane[cycle, j] = stack.values[k + j, 1]
        found.bending[cycle, j] = stack.values[k + j, 2]
        found.shift[cycle, j] = stack.values[k + j, 3]


@compiled()
def take_samples(
    s: Floats, m: Floats, b: Floats, shift: Floats, begin: int, stack: _Open, now: _Now, recurs: bool, found: Piece
) -> int:
    """Count some more samples, of which the first has the index ``begin``, and return how many cycles closed."""
    places, last = now.places, now.last
    for k in range(places[0], places[1] + 1):  # to the front of the stack
        stack.values[k - places[0]], stack.at[k - places[0]] = stack.values[k], stack.at[k]
    places[1] -= places[0]
    places[0] = 0
    cycles = 0
    for i in range(s.size):
        if now.last_at[0] >= 0:
            step = int(s[i] > last[0]) - int(s[i] < last[0])
            if step * places[2] < 0:
                cycles = close_last(stack, now, recurs, cycles, found)
            places[2] = step if step != 0 else places[2]
        last[0], last[1], last[2], last[3] = s[i], m[i], b[i], shift[i]
        now.last_at[0] = begin + i
        if places[1] < 0:  # the first sample is a reversal
            close_last(stack, now, recurs, 0, found)
    return cycles


@compiled()
def close_rest(stack: _Open, now: _Now, recurs: bool, found: Piece) -> int:
    """Count the end of the record and return how many cycles closed; a constant one has none."""
    if now.places[2] == 0:
        return 0
    cycles = close_last(stack, now, recurs, 0, found)
    for k in range(now.places[0], now.places[1]):
        put_cycle(stack, k, cycles, found)
        found.weight[cycles] = 0.5
        cycles += 1
    return cycles
