"""The loops of `rainflow_fast`: what happens to one point and surface in one chunk of time."""

import importlib.util
from typing import Any, NamedTuple

import numpy as np
from numba.extending import overload
from numpy.typing import NDArray

from fatigue.life.rainflow import compiled
from fatigue.life.rainflow_power import PowerLaw, add_powers, add_steps, add_up, extremes_in_lanes, raise_to_slope

simd: Any = None
if importlib.util.find_spec("fatigue.life.rainflow_simd"):
    from fatigue.life import rainflow_simd as simd

Floats = NDArray[np.float64]
Numbers = NDArray[np.floating]  # single precision, or double where a point is counted again

PAD = 32  # room behind a row for vector instructions that read and write more than they keep
FEW = 64  # reversals that are not worth another pass


class State(NamedTuple):
    """What the counter knows of each point and surface (n, 2) between two chunks, and what it has summed up.

    ``mean`` is that of the normalised stress, 0 in single precision. ``start`` are membrane and bending of the first
    sample. ``first_up`` and ``up`` are the directions of the first step and of the last one, -1 before there is any;
    ``plateau_m`` is the membrane stress before the first step. The first ``waiting`` of the reversals ``z``, ``m`` have
    not closed a cycle. The sums are those of `BlockCount` for normalised stress. ``doubtful``: rounding may have
    decided; ``crowded``: there was no room for all that waits.
    """

    wanted: NDArray[np.bool_]
    mean: Numbers
    start: Numbers
    plateau_m: Numbers
    first_up: NDArray[np.int64]
    up: NDArray[np.int64]
    waiting: NDArray[np.int64]
    z: Numbers
    m: Numbers
    doubtful: NDArray[np.bool_]
    crowded: NDArray[np.bool_]
    cycles: Floats
    power_sum: Floats
    damage: Floats
    largest: Floats
    second: Floats
    fourth: Floats
    maximum: Floats
    minimum: Floats


class Stage(NamedTuple):
    """Where in the record a chunk is, whether the record recurs, and up to what difference rounding may decide."""

    begins: bool
    ends: bool
    recurs: bool
    flat: np.float32


class Room(NamedTuple):
    """Work space of one row: signed reversals, and the ranges of full and of half cycles with their membrane part."""

    z: Numbers
    m: Numbers
    S: Numbers
    dm: Numbers
    half_S: Numbers  # noqa: N815
    half_dm: Numbers
    step: NDArray[np.int8]
    at: NDArray[np.int32]


def fresh_state(wanted: NDArray[np.bool_], residue: int, precision: type[np.floating]) -> State:
    """Nothing counted yet."""
    shape = wanted.shape
    kinds = {
        "wanted": (shape, np.bool_),
        "mean": (shape, precision),
        "start": (shape, precision),
        "plateau_m": (shape, precision),
        "first_up": (shape, np.int64),
        "up": (shape, np.int64),
        "waiting": (shape, np.int64),
        "z": ((*shape, residue), precision),
        "m": ((*shape, residue), precision),
        "doubtful": (shape, np.bool_),
        "crowded": (shape, np.bool_),
    }
    state = State._make(np.zeros(*kinds.get(name, (shape, np.float64))) for name in State._fields)
    state.wanted[:] = wanted
    state.up[:] = state.first_up[:] = -1
    return state


def room_for(width: int, residue: int, precision: type[np.floating]) -> Room:
    """Work space for the samples of a chunk and the reversals that waited for it."""
    kinds = (precision,) * 6 + (np.int8, np.int32)
    return Room._make(np.empty(width + residue + PAD, kind) for kind in kinds)


@compiled()
def write_reversals(
    m: Numbers, b: Numbers, side: np.float32, flat: np.float32, samples: int, up: int, room: Room, n: int
) -> tuple[int, int, bool]:
    """Append the reversals among the first samples of a row; ``up`` is the direction before them.

    Returns how many reversals there are now, the direction behind them, and whether any step is as small as rounding.
    """
    z, zm, step, at = room.z, room.m, room.step, room.at
    small_steps = 0
    for i in range(samples):
        ds = (m[i + 1] + side * b[i + 1]) - (m[i] + side * b[i])
        step[i] = int(ds > 0) - int(ds < 0)
    for i in range(samples):
        ds = (m[i + 1] + side * b[i + 1]) - (m[i] + side * b[i])
        doubt = flat + flat * abs(m[i] + side * b[i])
        small_steps += int(abs(ds) <= doubt) & int(m[i + 1] != m[i])
    reversals = 0
    direction = 2 * up - 1
    for i in range(samples):
        at[reversals] = i
        reversals += int(step[i] * direction < 0)  # adding 0 or 1 is cheaper than a branch nobody can predict
        direction = step[i] if step[i] != 0 else direction
    sign = np.float32(2 * up - 1)
    for k in range(reversals):
        i = at[k]
        z[n + k] = sign * (m[i] + side * b[i])
        zm[n + k] = sign * m[i]
        sign = -sign
    return n + reversals, int(direction > 0), small_steps > 0


@compiled()
def close_pass(room: Room, n: int, cycles: int, flat: np.float32) -> tuple[int, int, bool]:
    """Take out every range smaller than the one before and not larger than the one after; none begins at the start.

    Returns how many reversals are left, how many cycles there are now, and whether rounding may have decided.
    """
    z, zm, S, dm = room.z, room.m, room.S, room.dm
    z[n] = z[n + 1] = -np.inf
    close_calls = 0
    for i in range(n):
        doubt = flat + flat * abs(z[i])
        close_calls += int(abs(z[i + 2] - z[i]) <= doubt) & int(zm[i + 2] != zm[i])
    kept = 0
    before = 1  # whether the range before is not larger
    taken = 0
    for i in range(n):
        after = int(z[i + 2] >= z[i])
        was_taken, taken = taken, after & (1 - before)
        S[cycles] = z[i] + z[i + 1]
        dm[cycles] = zm[i] + zm[i + 1]
        cycles += taken
        z[kept], zm[kept] = z[i], zm[i]
        kept += 1 - (taken | was_taken)
        before = after
    return kept, cycles, close_calls > 0


def find_reversals(*args: Any) -> Any:
    """Call `write_reversals`, in vector instructions where they are."""
    return write_reversals(*args)


def close_ranges(*args: Any) -> Any:
    """Call `close_pass`, in vector instructions where they are."""
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
    z, zm, path, path_m = room.z, room.m, room.half_S, room.half_dm
    first = first_peak
    for i in range(first_peak + 2, n, 2):
        first = i if z[i] > z[first] else first
    for i in range(n + 1):
        path[i], path_m[i] = z[(first + i) % n], zm[(first + i) % n]
    for i in range(n + 1):
        z[i], zm[i] = path[i], path_m[i]
    return n + 1


@compiled()
def close_on_stack(room: Room, n: int, recurs: bool, cycles: int, flat: np.float32) -> tuple[int, int, bool]:
    """Do what `rainflow.close_cycles` does, on signed reversals.

    Returns how many full and half cycles there are, and whether rounding may have decided.
    """
    z, zm, S, dm, half_S, half_dm = room.z, room.m, room.S, room.dm, room.half_S, room.half_dm
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
def extremes(z: Numbers, n: int, first_peak: int) -> tuple[float, float]:
    """Largest and smallest stress: closing cycles never takes the last one of either out."""
    largest, smallest = -np.inf, -np.inf
    for i in range(n):
        if (i - first_peak) % 2 == 0:
            largest = max(largest, z[i])
        else:
            smallest = max(smallest, z[i])
    return largest, -smallest


@compiled()
def add_cycles(power: Numbers, damage: Numbers, n: int, count: float, at: tuple[int, int], state: State) -> None:
    """Add the first n cycles, counting ``count`` each, to the sums."""
    power_sum, damage_sum, largest = add_up(power, damage, n)
    state.cycles[at] += count * n
    state.power_sum[at] += count * power_sum
    state.damage[at] += count * damage_sum
    state.largest[at] = max(state.largest[at], largest)


@compiled()
def begin_side(m: Numbers, b: Numbers, side: np.float32, steps: int, at: tuple[int, int], state: State) -> None:
    """Look for the first step of the record."""
    for i in range(steps):
        s, following = m[i] + side * b[i], m[i + 1] + side * b[i + 1]
        if s != following:
            state.up[at] = state.first_up[at] = int(following > s)
            state.plateau_m[at] = m[i]
            return


@compiled()
def count_side(
    m: Numbers, b: Numbers, steps: int, at: tuple[int, int], stage: Stage, law: PowerLaw, state: State, room: Room
) -> None:
    """Count one surface of one point over the steps of a chunk."""
    side = np.float32(1 - 2 * at[1])
    z, zm = room.z, room.m
    n = state.waiting[at]
    for i in range(n):
        z[i], zm[i] = state.z[at][i], state.m[at][i]
    if state.up[at] < 0:
        begin_side(m, b, side, steps, at, state)
        if state.up[at] < 0:
            return
        if not stage.recurs:  # a single pass turns at its first sample
            sign = np.float32(1 - 2 * state.first_up[at])
            z[0], zm[0] = sign * (state.start[at[0], 0] + side * state.start[at[0], 1]), sign * state.start[at[0], 0]
            n = 1
    first_up = state.first_up[at]
    n, up, doubtful = find_reversals(m, b, side, stage.flat, steps, state.up[at], room, n)
    state.up[at] = up
    if stage.ends and not (stage.recurs and up == first_up):  # a block that recurs turns where its first plateau ends
        sign = np.float32(2 * up - 1)
        z[n] = sign * (m[steps] + side * b[steps])
        zm[n] = sign * (state.plateau_m[at] if stage.recurs else m[steps])
        n += 1

    cycles, before = 0, 2 * n
    while n > FEW and before - n > before // 8:
        before = n
        n, cycles, close_call = close_ranges(room, n, cycles, stage.flat)
        doubtful |= close_call
    if stage.ends:
        first_peak = 1 - first_up if stage.recurs else first_up
        state.maximum[at], state.minimum[at] = extremes(z, n, first_peak)
        if stage.recurs:
            n = rotate_to_maximum(room, n, first_peak)
        cycles, halves, close_call = close_on_stack(room, n, stage.recurs, cycles, stage.flat)
        doubtful |= close_call
        raise_to_slope(room.half_S, room.half_dm, halves, law)
        add_cycles(room.half_S, room.half_dm, halves, 0.5, at, state)
    elif n <= state.z.shape[2]:
        for i in range(n):
            state.z[at][i], state.m[at][i] = z[i], zm[i]
        state.waiting[at] = n
    else:
        state.crowded[at] = True
        state.waiting[at] = 0
    raise_to_slope(room.S, room.dm, cycles, law)
    add_cycles(room.S, room.dm, cycles, 1.0, at, state)
    state.doubtful[at] |= doubtful


@compiled()
def count_chunk(stress: Numbers, samples: int, stage: Stage, law: PowerLaw, state: State, room: Room) -> None:
    """Count the steps between the first samples + 1 columns of a block, its membrane rows above its bending rows."""
    points = stress.shape[0] // 2
    for row in range(points):
        m, b = stress[row], stress[points + row]
        if stage.begins:
            m[0], b[0] = m[1], b[1]
            state.start[row, 0], state.start[row, 1] = m[1], b[1]
        steps = samples
        if stage.ends and stage.recurs:  # and the step from the last sample to the first one
            steps += 1
            m[steps], b[steps] = state.start[row, 0], state.start[row, 1]
        for i in range(steps + 1, steps + PAD):
            m[i], b[i] = m[steps], b[steps]  # level, so that nothing turns here
        for surface in range(2):
            if state.wanted[row, surface]:
                second, fourth = add_powers(
                    m[1 : samples + 1], b[1 : samples + 1], np.float32(1 - 2 * surface), state.mean[row, surface]
                )
                state.second[row, surface] += second
                state.fourth[row, surface] += fourth
                count_side(m, b, steps, (row, surface), stage, law, state, room)
        m[0], b[0] = m[samples], b[samples]


@compiled()
def extend(stress: Numbers, columns: int, begins: bool, extent: Floats) -> None:
    """Add the steps between the first columns of a block to ``extent`` (n, 2, 5): 3 variations, maximum, minimum.

    Column 0 is the last sample of the chunk before; the first chunk begins at column 1.
    """
    points = stress.shape[0] // 2
    high, low = np.empty(64, stress.dtype), np.empty(64, stress.dtype)
    for row in range(points):
        m, b = stress[row, int(begins) : columns], stress[points + row, int(begins) : columns]
        for surface in range(2):
            side = np.float32(1 - 2 * surface)
            high[:] = -np.inf
            low[:] = np.inf
            extremes_in_lanes(m, b, side, high, low)
            found = extent[row, surface]
            first, second, third = add_steps(m, b, side)
            found[0] += first
            found[1] += second
            found[2] += third
            found[3] = max(found[3], high.max())
            found[4] = min(found[4], low.min())
        stress[row, 0], stress[points + row, 0] = stress[row, columns - 1], stress[points + row, columns - 1]
