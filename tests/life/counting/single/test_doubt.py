"""A surface of which single precision cannot tell what is larger: the loops that ask double precision."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from fatigue.life.counting.single.kernels.doubt import Exact, close_inner, rise, write_steps
from fatigue.life.counting.single.kernels.loops import close_pass
from fatigue.life.counting.single.kernels.state import Room, room_for

Floats = NDArray[np.float64]

FLAT = np.float32(1e-6)
NEVER = np.float32(-1.0)
TOP, BOTTOM = (0, 0), (0, 1)
NOTHING_KNOWN = Exact(np.zeros((1, 2)), np.zeros((1, 2)), np.zeros((2, 1)))


def room_with(s: Floats, samples: NDArray[np.integer]) -> Room:
    """Work space with the reversals s, a peak first, at samples, and a membrane stress that is different at each."""
    room = room_for(len(s), 0, np.float64)
    sign = (-1.0) ** np.arange(len(s))
    room.numbers[0, : len(s)] = sign * s
    room.numbers[1, : len(s)] = sign * np.arange(len(s))
    room.marks[1, : len(s)] = samples
    return room


def exact_of(m: Floats, b: Floats) -> Exact:
    """Shapes and coordinates of one row whose membrane and bending stress are these."""
    return Exact(np.array([[1.0, 0.0]]), np.array([[0.0, 1.0]]), np.stack([m, b]))


def reversals(rng: np.random.Generator, n: int, *, ties: bool) -> Floats:
    """Draw peaks and valleys in turn."""
    steps = rng.integers(1, 5, n).astype(float) if ties else rng.exponential(size=n)
    return np.cumsum(steps * -((-1.0) ** np.arange(n)))


@settings(deadline=None, max_examples=200)
@given(st.integers(0, 10**6), st.integers(0, 60), st.booleans())
def test_what_passes_close_is_closed_on_a_stack(seed: int, n: int, ties: bool) -> None:
    """The same cycles with the same membrane parts, the same reversals left, also where ranges are equal."""
    s = reversals(np.random.default_rng(seed), n, ties=ties)
    on_stack, in_passes = (room_with(s, np.zeros(n, int)) for _ in range(2))
    left, cycles, known = close_inner(on_stack, n, 1.0, TOP, NEVER, NOTHING_KNOWN)
    before, many, closed = n + 1, n, 0
    while many < before:
        before = many
        many, closed, _ = close_pass(in_passes, many, closed, NEVER)
    assert (left, cycles, known) == (many, closed, True)
    for row in (0, 1):
        np.testing.assert_array_equal(on_stack.numbers[row, :left], in_passes.numbers[row, :left])
    a, b = (np.array(sorted(zip(*room.numbers[2:4, :cycles], strict=True))) for room in (on_stack, in_passes))
    np.testing.assert_array_equal(a, b)


@pytest.mark.parametrize("at", [TOP, BOTTOM])
@pytest.mark.parametrize("seed", range(20))
def test_ranges_close_as_double_precision_says(seed: int, at: tuple[int, int]) -> None:
    """Reversals off by rounding, peaks or valleys first: which ranges close is what the exact stress has."""
    rng, n = np.random.default_rng(seed), 40
    sign = 1.0 if seed % 2 else -1.0
    s = sign * (reversals(rng, n, ties=True) + 1e-9 * rng.normal(size=n))
    m = rng.normal(size=n)
    single = s + 1e-8 * rng.normal(size=n)
    blurred, clear = (room_with(sign * x, np.arange(1, n + 1)) for x in (single, s))
    found = close_inner(blurred, n, sign, at, FLAT, exact_of(m, (s - m) * (1 - 2 * at[1])))
    expected = close_inner(clear, n, sign, at, NEVER, NOTHING_KNOWN)
    assert found == expected
    np.testing.assert_array_equal(blurred.numbers[1, : found[0]], clear.numbers[1, : found[0]])
    np.testing.assert_array_equal(blurred.numbers[3, : found[1]], clear.numbers[3, : found[1]])


@pytest.mark.parametrize(
    ("samples", "known"),
    [([1, 2, 3, 4, 5, 6], True), ([0, 2, 0, 4, 0, 0], True), ([0, 0, 3, 4, 5, 6], False), ([1, 2, 3, 0, 5, 6], False)],
    ids=["all", "those of the tie", "the first one is not", "the second one is not"],
)
def test_what_other_chunks_know_is_not_known(samples: list[int], known: bool) -> None:
    """Two equal valleys, the second and the fourth reversal: both must be samples of the chunk."""
    s = np.array([9.0, 1.0, 5.0, 1.0, 8.0, 0.0])
    assert close_inner(room_with(s, np.array(samples)), 6, 1.0, TOP, FLAT, exact_of(s, np.zeros(6)))[2] == known


def steps_of(m: Floats, b: Floats, exact: Exact, at: tuple[int, int] = TOP) -> tuple[list[int], bool]:
    """Direction of every step, and whether they are known."""
    room = room_for(len(m), 0, np.float32)
    known = write_steps(m.astype(np.float32), b.astype(np.float32), len(m) - 1, at, FLAT, exact, room)
    return room.marks[0, : len(m) - 1].tolist(), known


@pytest.mark.parametrize("at", [TOP, BOTTOM])
def test_steps_as_small_as_rounding_go_where_double_precision_says(at: tuple[int, int]) -> None:
    """Up, nowhere and down, one after the other, on both surfaces."""
    s = np.array([0.0, 1.0, 1.0 + 1e-9, 1.0 + 1e-9, 1.0 - 1e-9, 2.0, 1.0])
    m = np.linspace(0.0, 5.0, 7)
    b = (s - m) * (1 - 2 * at[1])
    in_chunk = exact_of(np.append(m[1:], 0.0), np.append(b[1:], 0.0))  # sample 0 is the one before the chunk
    directions, known = steps_of(m, b, in_chunk, at)
    assert known
    assert directions[1] == 1
    assert directions[3:] == [-1, 1, -1]
    assert directions[2] == np.sign(rise(in_chunk, at, 2, 3))


@pytest.mark.parametrize("place", [0, 3])
def test_steps_from_the_sample_before_and_behind_the_record_are_not_known(place: int) -> None:
    """Their stress in double precision is not at hand."""
    s = np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    s[place + 1] = s[place]
    m = np.arange(5.0)
    _, known = steps_of(m, s - m, exact_of(m[1:4], (s - m)[1:4]))
    assert not known


def test_a_rise_is_that_of_double_precision() -> None:
    """1e-12 of the stress, at both surfaces of several rows."""
    rng = np.random.default_rng(0)
    membrane, bending = rng.normal(size=(2, 5, 4))
    q = np.repeat(rng.normal(size=(4, 20)), 2, axis=1) * (1 + 1e-12 * rng.normal(size=(4, 40)))
    exact = Exact(membrane, bending, q)
    for row in range(5):
        for face, side in enumerate((1.0, -1.0)):
            s = membrane[row] @ q + side * (bending[row] @ q)
            found = [rise(exact, (row, face), i, i + 1) for i in range(1, 40)]
            np.testing.assert_allclose(found, np.diff(s), rtol=0, atol=1e-14 * np.abs(s).max())
