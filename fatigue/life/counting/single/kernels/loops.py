"""The loops over samples and reversals: what happens to one point and surface in one chunk of time."""

import importlib.util
from typing import Any

import numpy as np
from numba.extending import overload
from numpy.typing import NDArray

from fatigue.compiled import compiled
from fatigue.life.counting.residue import residue_places
from fatigue.life.counting.single.kernels.power import PowerLaw, add_powers, add_up, raise_to_slope
from fatigue.life.counting.single.kernels.state import PAD, Room, Stage, State

simd: Any = None
if importlib.util.find_spec("fatigue.life.counting.single.kernels.simd"):
    from fatigue.life.counting.single.kernels import simd

Floats = NDArray[np.float64]
Numbers = NDArray[np.floating]

FEW = 64  # reversals that are not worth another pass
_NONE: Any = np.uintp(0)  # unsigned, because compiled code asks of every other index whether it is negative
_ONE: Any = np.uintp(1)


@compiled()
def write_reversals(
    m: Numbers, b: Numbers, side: np.float32, flat: np.float32, samples: int, up: int, room: Room, n: int
) -> tuple[int, int, bool]:
    """Append the reversals among the first samples of a row: ``z = sign s_i`` where ``sign (s_(i+1) - s_i) < 0``.

    ``s = m + side b``; ``sign`` is 1 after a rise and -1 after a fall, so that ``z_i + z_(i+1)`` is a range;
    ``zm = sign m_i`` beside it. ``up`` is the direction before the samples. Returns how many reversals there are now,
    the direction behind them, and whether any step ``|ds| <= flat (1 + |s|)`` is as small as rounding.
    """
    step = room.marks[0]
    small_steps = level_steps = np.int32(0)
    for i in range(samples):  # several loops, because compilers turn simple ones into vector instructions
        s = m[i] + side * b[i]
        ds = (m[i + 1] + side * b[i + 1]) - s
        small_steps |= np.int32((abs(ds) <= flat + flat * abs(s)) & (m[i + 1] != m[i]))
        level_steps |= np.int32(ds == 0)
    for i in range(samples):
        ds = (m[i + 1] + side * b[i + 1]) - (m[i] + side * b[i])
        step[i] = np.int32(ds > 0) - np.int32(ds < 0)
    if level_steps != 0:
        hold_level(room, samples, up)
    n, up = list_reversals(m, b, side, samples, up, room, n)
    return n, up, small_steps != 0


@compiled()
def hold_level(room: Room, steps: int, up: int) -> None:
    """Let level steps go on in the direction before them, at the start ``up``."""
    step = room.marks[0]
    direction = np.int32(2 * up - 1)
    for i in range(steps):
        direction = step[i] if step[i] != 0 else direction
        step[i] = direction


@compiled()
def list_reversals(
    m: Numbers, b: Numbers, side: np.float32, samples: int, up: int, room: Room, n: int
) -> tuple[int, int]:
    """Append the reversals to n others, given the direction of every step, none of them level.

    Returns how many there are now and the direction behind them; the second row of marks has the samples of the new.
    """
    z, zm, step, at = room.numbers[0], room.numbers[1], room.marks[0], room.marks[1]
    before = np.int32(2 * up - 1)
    reversals = _NONE
    for i in range(samples):
        at[reversals] = i
        reversals += np.uintp(step[i] != before)  # adding 0 or 1 is cheaper than a branch nobody can predict
        before = step[i]
    sign = np.float32(2 * up - 1)
    behind = np.uintp(n)
    for k in range(reversals):
        j = np.uintp(at[k])
        z[behind + k] = sign * (m[j] + side * b[j])
        zm[behind + k] = sign * m[j]
        sign = -sign
    return n + int(np.intp(reversals)), int(before > 0)


@compiled()
def close_pass(room: Room, n: int, cycles: int, flat: np.float32) -> tuple[int, int, bool]:
    """Take out every closed range at once: ``S = z_i + z_(i+1)`` where ``z_(i+2) >= z_i`` and ``z_(i+1) < z_(i-1)``.

    This is the four-point rule: such a range is smaller than the one before and not larger than the one after. None
    begins at the start. ``dm = zm_i + zm_(i+1)`` goes with it. Returns how many reversals are left, how many cycles
    there are now, and whether rounding may have decided, ``|z_(i+2) - z_i| <= flat (1 + |z_i|)``.
    """
    z, zm, S, dm = room.numbers[0], room.numbers[1], room.numbers[2], room.numbers[3]
    z[n] = z[n + 1] = -np.inf
    close_calls = np.int32(0)
    for i in range(n):
        close_calls |= np.int32((abs(z[i + 2] - z[i]) <= flat + flat * abs(z[i])) & (zm[i + 2] != zm[i]))
    kept, closed = _NONE, np.uintp(cycles)
    before, taken = _ONE, _NONE  # whether the range before is not larger, and whether it has been taken
    for i in range(n):
        after = np.uintp(z[i + 2] >= z[i])
        was_taken, taken = taken, after & (_ONE ^ before)
        S[closed] = z[i] + z[i + 1]
        dm[closed] = zm[i] + zm[i + 1]
        closed += taken
        z[kept], zm[kept] = z[i], zm[i]
        kept += _ONE ^ (taken | was_taken)
        before = after
    return int(np.intp(kept)), int(np.intp(closed)), close_calls != 0


def find_reversals(*args: Any) -> Any:
    """Call ``write_reversals``, in vector instructions where they are."""
    return write_reversals(*args)


def close_ranges(*args: Any) -> Any:
    """Call ``close_pass``, in vector instructions where they are."""
    return close_pass(*args)


@overload(find_reversals, strict=False)
def _find_reversals(m: Any, b: Any, side: Any, flat: Any, samples: Any, up: Any, room: Any, n: Any) -> Any:
    step = simd.write_reversals if simd and simd.lanes(m) else write_reversals
    return lambda m, b, side, flat, samples, up, room, n: step(m, b, side, flat, samples, up, room, n)  # noqa: PLW0108


@overload(close_ranges, strict=False)
def _close_ranges(room: Any, n: Any, cycles: Any, flat: Any) -> Any:
    step = simd.close_pass if simd and simd.lanes(room.types[0]) else close_pass
    return lambda room, n, cycles, flat: step(room, n, cycles, flat)  # noqa: PLW0108


@compiled()
def rotate_to_maximum(room: Room, n: int, first_peak: int) -> int:
    """Begin the cyclic list at its first largest peak and close it; returns its length."""
    z, zm, path, path_m = room.numbers[0], room.numbers[1], room.numbers[4], room.numbers[5]
    first = first_peak
    for i in range(first_peak + 2, n, 2):
        first = i if z[i] > z[first] else first
    for i in range(n + 1):
        from_there = first + i if first + i < n else first + i - n  # a remainder would take longer
        path[i], path_m[i] = z[from_there], zm[from_there]
    for i in range(n + 1):
        z[i], zm[i] = path[i], path_m[i]
    return n + 1


@compiled()
def close_on_stack(room: Room, n: int, recurs: bool, cycles: int, flat: np.float32) -> tuple[int, int, bool]:
    """Close ``S = z_(top-2) + z_(top-1)`` where ``z_top >= z_(top-2)``, as ``reversals.close_cycles`` does.

    Returns how many full and half cycles there are, and whether rounding may have decided.
    """
    z, zm, S, dm = room.numbers[0], room.numbers[1], room.numbers[2], room.numbers[3]
    half_S, half_dm = room.numbers[4], room.numbers[5]
    halves = 0
    base = 0
    top = -1
    close_call = False
    for k in range(n):
        top += 1
        z[top], zm[top] = z[k], zm[k]
        while top - base >= 2:
            close_call |= abs(z[top] - z[top - 2]) <= flat + flat * abs(z[top]) and zm[top] != zm[top - 2]
            if z[top] < z[top - 2]:
                break
            if top - base == 2 and not recurs:
                half_S[halves], half_dm[halves] = z[base] + z[base + 1], zm[base] + zm[base + 1]
                halves += 1
                base += 1
            else:
                S[cycles], dm[cycles] = z[top - 2] + z[top - 1], zm[top - 2] + zm[top - 1]
                cycles += 1
                z[top - 2], zm[top - 2] = z[top], zm[top]
                top -= 2
    for k in range(base, top):
        half_S[halves], half_dm[halves] = z[k] + z[k + 1], zm[k] + zm[k + 1]
        halves += 1
    return cycles, halves, close_call


@compiled()
def extremes(room: Room, n: int, first_peak: int) -> tuple[float, float]:
    """Largest and smallest stress, ``max z`` of peaks and ``-max z`` of valleys: closing cycles leaves one of both."""
    z = room.numbers[0]
    largest, smallest = -np.inf, -np.inf
    for i in range(n):
        if (i - first_peak) % 2 == 0:
            largest = max(largest, z[i])
        else:
            smallest = max(smallest, z[i])
    return largest, -smallest


@compiled()
def add_cycles(room: Room, row: int, n: int, count: float, law: PowerLaw, total: Any) -> None:
    """Add ``count sum S^k`` and ``count sum S^k I(r)^(-k/m)`` of n cycles, S in a row of the work space, dm behind."""
    S, dm = room.numbers[row], room.numbers[row + 1]
    raise_to_slope(S, dm, n, law)
    power_sum, damage_sum, largest = add_up(S, dm, n)
    total.cycles += count * n
    total.power_sum += count * power_sum
    total.damage += count * damage_sum
    total.largest = max(total.largest, largest)


@compiled()
def first_step(m: Numbers, b: Numbers, side: np.float32, steps: int) -> int:
    """Find the first step that is not level; ``steps`` if there is none."""
    i = 0
    while i < steps and m[i] + side * b[i] == m[i + 1] + side * b[i + 1]:
        i += 1
    return i


@compiled()
def begin_side(up: bool, plateau_m: float, at: tuple[int, int], recurs: bool, state: State) -> None:
    """Begin with the direction of the first step and the membrane stress before it; a single pass turns there."""
    known = state.sides[at]
    known.up = known.first_up = int(up)
    known.plateau_m = plateau_m
    if not recurs:
        side, sign = np.float32(1 - 2 * at[1]), np.float32(1 - 2 * known.first_up)
        first_m, first_b = state.ends[at[0], 0, 0], state.ends[at[0], 0, 1]
        state.waiting[at[0], at[1], 0, 0] = sign * (first_m + side * first_b)
        state.waiting[at[0], at[1], 1, 0] = sign * first_m
        known.waiting = 1


@compiled()
def resume(state: State, at: tuple[int, int], room: Room) -> int:
    """Take up the reversals that wait; returns how many."""
    n = int(state.sides[at].waiting)
    z, zm = room.numbers[0], room.numbers[1]
    waiting, waiting_m = state.waiting[at[0], at[1], 0], state.waiting[at[0], at[1], 1]
    for i in range(n):
        z[i], zm[i] = waiting[i], waiting_m[i]
    return n


@compiled()
def suspend(state: State, at: tuple[int, int], n: int, room: Room) -> None:
    """Let n reversals wait, if there is room for them."""
    known = state.sides[at]
    z, zm = room.numbers[0], room.numbers[1]
    waiting, waiting_m = state.waiting[at[0], at[1], 0], state.waiting[at[0], at[1], 1]
    known.crowded |= n > waiting.size
    known.waiting = 0 if known.crowded else n
    for i in range(known.waiting):
        waiting[i], waiting_m[i] = z[i], zm[i]


@compiled()
def append_last(m: Numbers, b: Numbers, i: int, side: np.float32, recurs: bool, known: Any, room: Room, n: int) -> int:
    """Append the last sample i, or the first plateau of a record that recurs; returns how many reversals there are."""
    if recurs and known.up == known.first_up:
        return n
    z, zm = room.numbers[0], room.numbers[1]
    sign = np.float32(2 * known.up - 1)
    z[n] = sign * (m[i] + side * b[i])
    zm[n] = sign * (known.plateau_m if recurs else m[i])
    return n + 1


@compiled()
def keep_residue(at: tuple[int, int], n: int, recurs: bool, state: State, room: Room) -> None:
    """Keep the residue of a record that ends; n reversals wait, without the end of the record.

    It turns at its first and its last sample, where another pass comes before or behind it.
    """
    known = state.sides[at]
    side = np.float32(1 - 2 * at[1])
    z, zm, s, m, place = room.numbers[0], room.numbers[1], room.numbers[4], room.numbers[5], room.marks[0]
    m[0], m[n + 1] = state.ends[at[0], 0, 0], state.ends[at[0], 1, 0]
    s[0] = state.ends[at[0], 0, 0] + side * state.ends[at[0], 0, 1]
    s[n + 1] = state.ends[at[0], 1, 0] + side * state.ends[at[0], 1, 1]
    sign = np.float32(1 if (known.first_up == 1) == recurs else -1)  # a block that recurs begins behind its first step
    for i in range(n):
        s[1 + i], m[1 + i] = sign * z[i], sign * zm[i]
        sign = -sign
    known.kept = residue_places(s, n + 2, place)
    known.crowded |= known.kept > state.residue.shape[3]
    if not known.crowded:
        for k in range(known.kept):
            state.residue[at[0], at[1], 0, k], state.residue[at[0], at[1], 1, k] = s[place[k]], m[place[k]]


@compiled()
def close_all(room: Room, n: int, flat: np.float32) -> tuple[int, int, bool]:
    """Close ranges as long as it is worth a pass.

    Returns how many reversals are left, how many cycles there are, and whether rounding may have decided.
    """
    cycles, before, doubtful = 0, 2 * n, False
    while n > FEW and before - n > before // 8 and not doubtful:
        before = n
        n, cycles, doubtful = close_ranges(room, n, cycles, flat)
    return n, cycles, doubtful


@compiled()
def finish(known: Any, n: int, cycles: int, stage: Stage, law: PowerLaw, room: Room) -> int:
    """Close the last n reversals of the record; returns how many full cycles there are then."""
    first_peak = 1 - known.first_up if stage.recurs else known.first_up
    known.maximum, known.minimum = extremes(room, n, first_peak)
    if stage.recurs:
        n = rotate_to_maximum(room, n, first_peak)
    cycles, halves, close_call = close_on_stack(room, n, stage.recurs, cycles, stage.flat)
    known.doubtful |= close_call
    add_cycles(room, 4, halves, 0.5, law, known)
    return cycles


@compiled()
def count_side(
    m: Numbers, b: Numbers, steps: int, at: tuple[int, int], stage: Stage, law: PowerLaw, state: State, room: Room
) -> bool:
    """Count one surface of one point over the steps of a chunk.

    Returns whether it has done so: not if rounding may have decided something, then nothing is changed.
    """
    known = state.sides[at]
    side = np.float32(1 - 2 * at[1])
    up_before, waiting_before = known.up, known.waiting
    if up_before < 0:
        i = first_step(m, b, side, steps)
        if i == steps:  # level so far
            if stage.ends and state.residue.shape[3] > 0:
                keep_residue(at, 0, stage.recurs, state, room)
            return True
        begin_side(m[i + 1] + side * b[i + 1] > m[i] + side * b[i], m[i], at, stage.recurs, state)
    n = resume(state, at, room)
    n, known.up, doubtful = find_reversals(m, b, side, stage.flat, steps, known.up, room, n)
    cycles = 0
    if not doubtful:
        if stage.ends and state.residue.shape[3] > 0:
            keep_residue(at, n, stage.recurs, state, room)
        if stage.ends:
            n = append_last(m, b, steps, side, stage.recurs, known, room, n)
        n, cycles, doubtful = close_all(room, n, stage.flat)
    if doubtful:
        known.up, known.waiting = up_before, waiting_before
        return False
    if stage.ends:
        cycles = finish(known, n, cycles, stage, law, room)
    else:
        suspend(state, at, n, room)
    add_cycles(room, 2, cycles, 1.0, law, known)
    return True


@compiled()
def count_chunk(
    stress: Numbers, samples: int, stage: Stage, law: PowerLaw, state: State, room: Room, doubts: NDArray[np.int64]
) -> int:
    """Count the steps to the columns 1 to ``samples`` of a block, its membrane rows above its bending rows.

    Surfaces on which rounding may have decided are left to ``kernels.doubt.count_chunk_exactly``: returns how many
    there are in ``doubts`` (2 n, 2), row and face of each.
    """
    points = stress.shape[0] // 2
    found = 0
    for row in range(points):
        m, b = stress[row], stress[points + row]
        for k in range(2):
            part = stress[row + k * points]
            if stage.begins:
                state.ends[row, 0, k] = state.ends[row, 1, k] = part[1]
            part[0] = state.ends[row, 1, k]
            state.ends[row, 1, k] = part[samples]
            if stage.ends and stage.recurs:  # and the step from the last sample to the first one
                part[samples + 1] = state.ends[row, 0, k]
        steps = samples + int(stage.ends and stage.recurs)
        for i in range(steps + 1, steps + PAD):
            m[i], b[i] = m[steps], b[steps]  # level, so that nothing turns here
        add_powers(m[1 : samples + 1], b[1 : samples + 1], state.sides[row, 0], state.sides[row, 1])
        for surface in range(2):
            at = (row, surface)
            known = state.sides[at]
            if known.wanted and not known.doubtful and not count_side(m, b, steps, at, stage, law, state, room):
                doubts[found, 0], doubts[found, 1] = at
                found += 1
    return found
