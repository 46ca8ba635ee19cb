"""How cycles are found: from the samples of a signal to its reversals, and from these to cycles.

Plain loops over one signal in float64: ``turning_points`` finds the reversals, ``close_cycles`` pairs them.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


class Buffers(NamedTuple):
    """Work space for one signal: its reversals, and its cycles by their places in the signal and their weights."""

    step: NDArray[np.int8]
    reversal: Indices
    start: Indices
    end: Indices
    weight: Floats


def buffers_for(samples: int) -> Buffers:
    """Room for the reversals of a signal whose first sample is repeated at its end."""
    reversal, start, end = (np.empty(samples + 2, np.intp) for _ in range(3))
    return Buffers(np.empty(samples + 1, np.int8), reversal, start, end, np.empty(samples + 1))


@compiled()
def unroll(s: Floats, path: Floats) -> int:
    """Write a recurring block (t,) into ``path`` (t + 1,) from its largest sample to the next time it occurs.

    In between every cycle closes. Of a plateau, also one across the end of the block, the last sample is taken, as at
    every reversal. Returns the index of that sample.
    """
    t = s.size
    first = 0
    for i in range(1, t):
        first = i if s[i] > s[first] else first
    for _ in range(t):
        following = (first + 1) % t
        if s[following] != s[first]:
            break
        first = following
    for i in range(t - first):  # loops: a slice that is assigned compiles the text of its refusal too
        path[i] = s[first + i]
    for i in range(first + 1):
        path[t - first + i] = s[i]
    return first


@compiled()
def turning_points(s: Floats, step: NDArray[np.int8], reversal: Indices) -> int:
    """Write the sample indices of the reversals of s (t,) into ``reversal`` (t + 1,) and return how many there are.

    The first and the last sample are reversals; a plateau turns at its last sample; a constant signal has none.
    """
    for i in range(1, s.size):
        step[i] = int(s[i] > s[i - 1]) - int(s[i] < s[i - 1])
    reversal[0] = 0
    n = 1
    direction = 0
    for i in range(1, s.size):
        reversal[n] = i - 1
        n += int(step[i] * direction < 0)  # adding 0 or 1 is cheaper than a branch nobody can predict
        direction = step[i] if step[i] != 0 else direction
    reversal[n] = s.size - 1
    return n + 1 if direction != 0 else 0


@compiled()
def close_cycles(
    s: Floats,
    reversals: int,
    recurs: bool,
    reversal: Indices,
    start: Indices,
    end: Indices,
    weight: Floats,
) -> int:
    """Pair the reversals into cycles, in the order in which they close, and return how many (ASTM E1049-85, 5.4.4).

    The latest range ``X = |s_top - s_(top-1)|`` closes the range ``Y = |s_(top-1) - s_(top-2)|`` before it if X >= Y.
    A Y that contains the starting point is a half cycle, unless the block recurs; what is left at the end is half
    cycles. The open reversals are a stack at the front of ``reversal``.
    """
    cycles = 0
    base = 0
    top = -1
    for k in range(reversals):
        top += 1
        reversal[top] = reversal[k]
        while top - base >= 2:
            X = abs(s[reversal[top]] - s[reversal[top - 1]])
            Y = abs(s[reversal[top - 1]] - s[reversal[top - 2]])
            if X < Y:
                break
            start[cycles], end[cycles] = reversal[top - 2], reversal[top - 1]
            if top - base == 2 and not recurs:
                weight[cycles] = 0.5
                base += 1
            else:
                weight[cycles] = 1.0
                reversal[top - 2] = reversal[top]
                top -= 2
            cycles += 1
    for k in range(base, top):
        start[cycles], end[cycles], weight[cycles] = reversal[k], reversal[k + 1], 0.5
        cycles += 1
    return cycles


@compiled()
def close_open(s: Floats, waiting: int, reversals: int, recurs: bool, buffers: Buffers) -> tuple[int, int]:
    """Close what closes whatever is still to come: the first ``waiting`` of the reversals are open ones.

    A single pass follows ``reversals.close_cycles``: a range that contains the starting point is a half cycle. In a
    block that recurs such a range waits, as does one that is not smaller than the range before it. Returns how many
    cycles there are, and how many reversals are left, by their places in ``buffers.reversal``.
    """
    reversal, start, end, weight = buffers.reversal, buffers.start, buffers.end, buffers.weight
    cycles = 0
    base = 0
    top = waiting - 1
    for k in range(reversals):
        reversal[k] = k
    for k in range(waiting, reversals):
        top += 1
        reversal[top] = k
        while top - base >= 2:
            X = abs(s[reversal[top]] - s[reversal[top - 1]])
            Y = abs(s[reversal[top - 1]] - s[reversal[top - 2]])
            if X < Y or (recurs and (top == 2 or abs(s[reversal[top - 2]] - s[reversal[top - 3]]) <= Y)):
                break
            start[cycles], end[cycles] = reversal[top - 2], reversal[top - 1]
            if top - base == 2:
                weight[cycles] = 0.5
                base += 1
            else:
                weight[cycles] = 1.0
                reversal[top - 2] = reversal[top]
                top -= 2
            cycles += 1
    for k in range(base, top + 1):
        reversal[k - base] = reversal[k]
    return cycles, top + 1 - base


@compiled()
def find_cycles(
    signals: Floats,
    recurs: bool,
    path: Floats,
    step: NDArray[np.int8],
    reversal: Indices,
    start: Indices,
    end: Indices,
    weight: Floats,
    number: Indices,
) -> int:
    """Write the cycles of signals (n, t), one after the other, and return how many there are.

    ``number`` (n,) gets those of each, ``start``, ``end`` and ``weight`` have room for n (t + 1) of them; ``path``,
    ``step`` and ``reversal`` are work space.
    """
    found, t = 0, signals.shape[1]
    for row in range(signals.shape[0]):
        first, last = 0, t
        if recurs and t > 0:
            first, last = unroll(signals[row], path), t + 1
        else:
            for i in range(t):
                path[i] = signals[row, i]
        reversals = turning_points(path[:last], step, reversal)
        cycles = close_cycles(path, reversals, recurs, reversal, start[found:], end[found:], weight[found:])
        for c in range(found, found + cycles):
            start[c], end[c] = (start[c] + first) % t, (end[c] + first) % t
        number[row] = cycles
        found += cycles
    return found


class Found(NamedTuple):
    """Cycles of some signals, one signal after the other, each in the order in which its cycles close.

    ``start`` and ``end`` (c,) are the samples of their reversals, ``weight`` (c,) is 1 or 0.5; ``number`` (n,) says how
    many each signal has.
    """

    start: Indices
    end: Indices
    weight: Floats
    number: Indices


def cycles_of(signals: Floats, *, recurs: bool) -> Found:
    """Cycles of signals (n, t)."""
    n, t = signals.shape
    room = n * (t + 1)
    start, end, number = np.empty(room, np.intp), np.empty(room, np.intp), np.empty(n, np.intp)
    path, step, reversal, weight = np.empty(t + 1), np.empty(t + 1, np.int8), np.empty(t + 2, np.intp), np.empty(room)
    found = find_cycles(signals, recurs, path, step, reversal, start, end, weight, number)
    return Found(start[:found], end[:found], weight[:found], number)
