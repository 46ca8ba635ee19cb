"""Half cycles of a path: published closed forms, a slow counter, rainflow, and what must not change them."""

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.errors import CaseError, DataError, NumericalError
from fatigue.life.counting.rainflow import rainflow
from fatigue.life.path.count import PathCycles, count_path, count_path_in_space
from tests import naive_path

ORACLES = json.loads((Path(__file__).parents[2] / "data" / "path_oracles.json").read_text(encoding="utf-8"))
SEQUENCES = [*ORACLES["path_sequences"], *ORACLES["path_sequences_3d"]]
RESIDUES = ("half", "repeat")

coordinates = st.one_of(
    st.integers(-3, 3).map(float), st.floats(-50.0, 50.0, width=32).map(lambda x: round(float(x), 3))
)
paths = st.lists(st.tuples(coordinates, coordinates), min_size=2, max_size=14).map(np.array)
straight = st.lists(st.integers(-9, 9), min_size=2, max_size=25)


def in_block(cycles: PathCycles, first: int, samples: int, residue: str) -> np.ndarray:
    """Half cycles as a table, of a recurring block counted from where it is begun, by beginning and falling range."""
    start, end = cycles.start.copy(), cycles.end.copy()
    if residue == "repeat":
        start, end = (start - first) % samples, (end - first) % samples
        end = np.where(end <= start, end + samples, end)
    return in_order(np.stack([start, end, cycles.range, cycles.length, cycles.moment], axis=1))


def in_order(halves: object) -> np.ndarray:
    """The same table for all, by beginning and falling range; what is equal but for rounding keeps its order by g."""
    table = np.asarray(halves, dtype=float).reshape(-1, 5)
    rounded = table.round(7)
    return table[np.lexsort((rounded[:, 4], -rounded[:, 2], rounded[:, 0]))]


def assert_same(found: np.ndarray, known: np.ndarray) -> None:
    """Two tables of half cycles agree as the source of the numbers asks: 1e-8 of the largest, g to 1e-6."""
    assert found.shape == known.shape
    for column in range(4):
        largest = max(1.0, np.abs(known[:, column]).max(initial=0.0))
        np.testing.assert_allclose(found[:, column], known[:, column], rtol=0, atol=1e-8 * largest)
    np.testing.assert_allclose(found[:, 4], known[:, 4], rtol=0, atol=1e-6)


def assert_naive(points: np.ndarray, residue: str) -> None:
    """The counter finds what the slow one finds."""
    halves, first = naive_path.half_cycles(points, residue)
    assert_same(in_block(count_path_in_space(points, residue), first, len(points), residue), in_order(halves))


@pytest.mark.parametrize("residue", RESIDUES)
@pytest.mark.parametrize("sequence", SEQUENCES, ids=[one["name"] for one in SEQUENCES])
def test_known_sequences(sequence, residue):
    """Both counters find every half cycle of 22 known paths."""
    points, known = np.array(sequence["points"], dtype=float), in_order(sequence[residue])
    halves, first = naive_path.half_cycles(points, residue)
    assert_same(in_order(halves), known)
    if residue == "repeat":
        assert first == sequence["repeat_start"]
    assert_same(in_block(count_path_in_space(points, residue), first, len(points), residue), known)


def line(random: np.random.Generator, n: int) -> np.ndarray:
    """On one line, with ties."""
    return np.outer(random.integers(-5, 6, n), random.integers(-2, 3, 2)).astype(float)


def corners(random: np.random.Generator, n: int) -> np.ndarray:
    """A bow-tie or a square, turned, over and over."""
    four = np.array([[-1, -1], [1, 1], [1, -1], [-1, 1]], dtype=float)[random.permutation(4)]
    c, s = np.cos(random.uniform(0, 7)), np.sin(random.uniform(0, 7))
    return np.resize(four, (n, 2)) @ np.array([[c, -s], [s, c]])


def spiral(random: np.random.Generator, n: int) -> np.ndarray:
    """Inwards or outwards, round or flat, in large steps."""
    k = np.arange(n)
    turn, radius = k * random.choice([np.pi / 2, np.pi / 3, 0.9]), np.exp(random.uniform(-0.2, 0.2) * k)
    return (radius * np.array([np.cos(turn), random.uniform(0.3, 1.0) * np.sin(turn)])).T


KINDS = (
    lambda random, n: random.integers(-3, 4, (n, 2)).astype(float),
    lambda random, n: np.repeat(random.integers(-3, 4, (n, 2)), random.integers(1, 4, n), axis=0)[:n].astype(float),
    line,
    corners,
    spiral,
    lambda random, n: random.normal(size=(n, 2)),
    lambda random, n: np.cumsum(random.integers(-1, 2, (n, 2)), axis=0).astype(float),
    lambda random, n: random.integers(-2, 3, (n, 3)).astype(float),
)


def random_path(random: np.random.Generator, kind: int, n: int) -> np.ndarray:
    """A path with ties, of plateaus and repeated points, on a line, crossing itself, spiralling, noisy, or in space."""
    return KINDS[kind](random, n)


def test_short_random_paths():
    """The counter agrees with the slow one on 2000 short paths of all kinds."""
    random = np.random.default_rng(19)
    for k in range(2000):
        assert_naive(random_path(random, k % 8, int(random.integers(2, 9))), RESIDUES[k // 8 % 2])


@pytest.mark.slow
def test_many_random_paths():
    """The counter agrees with the slow one on 10 000 paths of all kinds."""
    random = np.random.default_rng(1)
    for k in range(10_000):
        assert_naive(random_path(random, k % 8, int(random.integers(2, 20))), RESIDUES[k // 8 % 2])


def test_paths_of_many_blocks():
    """Hulls of blocks find what all pairs find, on paths of several blocks with ties, plateaus and repeated points."""
    random = np.random.default_rng(2)
    for k in range(48):
        assert_naive(random_path(random, k % 8, int(random.integers(40, 160))), RESIDUES[k // 8 % 2])


@pytest.mark.parametrize("known", ORACLES["harmonic"], ids=lambda one: f"{one['a']}-{one['b']}-{one['delta_deg']}")
def test_harmonic_paths(known):
    """X = a sin, Y = b sin(+ delta): an ellipse of two half cycles with the known range, path factor and moment."""
    turn = np.arange(7200) * 2.0 * np.pi / 7200
    X, Y = known["a"] * np.sin(turn), known["b"] * np.sin(turn + np.deg2rad(known["delta_deg"]))
    found = count_path(X, Y, 1.0, "repeat")
    large = found.range > 1e-3
    assert large.sum() == 2
    np.testing.assert_allclose(found.range[large], known["range"], rtol=1e-6)
    np.testing.assert_allclose(found.factor[large], known["length_over_range"], rtol=1e-4)
    np.testing.assert_allclose(found.moment[large], known["g"], atol=1e-3)


def test_shear_counts_with_the_root_of_beta():
    """Of shear alone the range is sqrt(beta) times the range of the shear."""
    np.testing.assert_allclose(count_path([0.0, 0.0], [0.0, 10.0], 3.0, "half").range, [10.0 * np.sqrt(3.0)])


@settings(deadline=None)
@given(straight, st.sampled_from(RESIDUES), st.sampled_from([(1.0, 0.0), (3.0, 4.0), (-2.0, 1.0)]))
def test_a_straight_path_is_rainflow(signal, residue, direction):
    """Along a straight line the half cycles are those of rainflow counting, a whole cycle being two of them."""
    cycles = rainflow(signal, residue)
    halves = np.repeat(cycles.range, np.rint(2.0 * cycles.count).astype(int)) * np.hypot(*direction)
    found = count_path_in_space(np.outer(signal, direction), residue)
    np.testing.assert_allclose(np.sort(found.range), np.sort(halves), rtol=1e-9)
    np.testing.assert_allclose(found.length, found.range, rtol=1e-9)
    np.testing.assert_allclose(found.moment, 0.0, atol=1e-9)


@settings(deadline=None)
@given(paths, st.sampled_from(RESIDUES))
def test_real_parts_are_the_path(points, residue):
    """The lengths of all half cycles add up to the length of the path: no jump over an excursion is counted."""
    closed = np.concatenate([points, points[:1]]) if residue == "repeat" else points
    path = np.hypot(*np.diff(closed, axis=0).T).sum()
    found = count_path_in_space(points, residue)
    np.testing.assert_allclose(found.length.sum(), path, rtol=1e-7, atol=1e-9)
    assert (found.length >= found.range * (1.0 - 1e-9)).all()
    diameter = np.hypot(*(points[:, None] - points[None]).reshape(-1, 2).T).max()
    np.testing.assert_allclose(found.range.max(initial=0.0), diameter, rtol=1e-9)


@settings(deadline=None)
@given(
    paths.map(np.rint),
    st.sampled_from(RESIDUES),
    st.floats(0.0, 6.3),
    st.sampled_from([1.0, -1.0]),
    st.sampled_from([1e-200, 1.0, 7.3, 1e150]),
)
def test_moved_turned_mirrored_scaled(points, residue, angle, mirror, scale):
    """Translation, rotation, reflection and scaling of the plane change nothing but the scale; ties stay ties."""
    turned = points * [mirror, 1.0] @ np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    before, after = (count_path_in_space(p, residue) for p in (points, scale * np.add(turned, [3.0, -5.0])))
    tables = [np.stack([c.start, c.end, c.range, c.length, c.moment], axis=1) for c in (before, after)]
    tables[1][:, 2:4] /= scale
    for table in tables:
        table[:, :2] = np.where(table[:, :2] > len(points) - 1e-6, 0.0, table[:, :2])
    np.testing.assert_allclose(in_order(tables[1]), in_order(tables[0]), atol=2e-5)


@settings(deadline=None)
@given(paths.map(np.rint), st.sampled_from(RESIDUES), st.data())
def test_inserted_points_change_nothing(points, residue, data):
    """Points repeated or put between their neighbours on the path change neither ranges, lengths nor moments."""
    k = data.draw(st.integers(0, len(points) - 2))
    more = points[k] + data.draw(st.sampled_from([0.0, 0.25, 0.5])) * (points[k + 1] - points[k])
    longer = np.insert(points, k + 1, more, axis=0)
    before, after = (
        np.stack([c.range, c.length, c.moment], axis=1)
        for c in (count_path_in_space(p, residue) for p in (points, longer))
    )
    order_before, order_after = (np.lexsort(table.round(6).T) for table in (before, after))
    np.testing.assert_allclose(after[order_after], before[order_before], atol=1e-6)


@settings(deadline=None)
@given(paths, st.integers(1, 13))
def test_a_recurring_path_begins_anywhere(points, shift):
    """A block that recurs has the same half cycles wherever it is begun, if one pair is the most distant one."""
    squares = ((points[:, None] - points[None]) ** 2).sum(axis=-1)
    if np.count_nonzero(np.triu(squares >= squares.max() * (1.0 - 1e-8))) != 1:
        return
    before, after = (count_path_in_space(p, "repeat") for p in (points, np.roll(points, -shift, axis=0)))
    for one in ("range", "length", "moment"):
        np.testing.assert_allclose(np.sort(getattr(after, one)), np.sort(getattr(before, one)), rtol=1e-7, atol=1e-7)


def test_ties_in_rounding_noise():
    """Of three equal turns of a rectangle, turned by any angle, the first corners in time are the most distant pair."""
    corners = np.resize([[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [0.0, 1.0]], (13, 2))
    for angle in np.linspace(0.0, 3.0, 7):
        turned = corners @ np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        found = count_path_in_space(turned, "half")
        assert found.start.tolist() == [0, 2, 4, 6, 8, 10]
        assert found.end.tolist() == [2, 4, 6, 8, 10, 12]


def test_a_plateau_is_met_at_its_first_sample():
    """Ends on a plateau are its first sample, where rainflow takes the last; the ranges are the same."""
    found = count_path([0.0, 0.0, 5.0, 5.0, 5.0, 1.0], np.zeros(6), 3.0, "half")
    assert (found.start.tolist(), found.end.tolist()) == ([0.0, 2.0], [2.0, 5.0])
    np.testing.assert_allclose(found.range, rainflow([0, 0, 5, 5, 5, 1], "half").range)


def test_noise_lowers_factor_and_moment_and_leaves_the_range():
    """0.1 % white noise on a circle of 3600 samples: the range stays, path factor and moment come out too low."""
    turn, random = np.arange(3600) * 2.0 * np.pi / 3600, np.random.default_rng(3)
    x, y = (f(turn) + 1e-3 * random.normal(size=3600) for f in (np.cos, np.sin))
    found = count_path(x, y, 1.0, "half")
    top = int(found.range.argmax())
    assert found.range[top] == pytest.approx(2.0, rel=5e-3)
    assert found.factor[top] == pytest.approx(1.41, abs=0.05)
    assert found.moment[top] == pytest.approx(0.6, abs=0.1)


@pytest.mark.parametrize("residue", RESIDUES)
def test_long_awkward_records(residue):
    """Long records that die away, grow, rise all the time or rest are counted without nesting, each sample once."""
    k = np.arange(40_000.0)
    dying = np.exp(-k / 8000.0) * np.array([np.cos(0.31 * k), np.sin(0.11 * k)])
    for x, y in (dying, dying[:, ::-1], (k, k**2 / 4e4), (np.repeat(dying[0, ::400], 400), np.zeros(40_000))):
        found = count_path(x, y, 1.0, residue)
        closed = [np.append(a, a[0]) if residue == "repeat" else a for a in (x, y)]
        assert found.length.sum() == pytest.approx(np.hypot(*np.diff(closed)).sum(), rel=1e-6)


@pytest.mark.parametrize("residue", RESIDUES)
@pytest.mark.parametrize("signal", [[], [3.0], [3.0, 3.0, 3.0]], ids=["nothing", "one sample", "constant"])
def test_what_never_moves_has_no_half_cycles(signal, residue):
    """No sample, one, and a constant path have no half cycles."""
    assert count_path(signal, signal, 3.0, residue).range.size == 0


def test_refusals():
    """NaN, infinite samples, records of two lengths and an unknown residue are refused."""
    for bad in (np.nan, np.inf):
        with pytest.raises(NumericalError, match="NaN or infinite"):
            count_path([0.0, bad], [0.0, 1.0], 3.0, "half")
        with pytest.raises(NumericalError, match="NaN or infinite"):
            count_path_in_space([[0.0, bad], [0.0, 1.0]], "half")
    with pytest.raises(NumericalError, match="exceeds what double precision"):
        count_path_in_space([[-1e308, 0.0], [1e308, 1.0]], "half")
    with pytest.raises(DataError, match="normal stress has 2 samples, shear stress 3"):
        count_path([0.0, 1.0], [0.0, 1.0, 2.0], 3.0, "half")
    with pytest.raises(CaseError, match="'halve' is no way"):
        count_path([0.0, 1.0], [0.0, 1.0], 3.0, "halve")  # type: ignore[arg-type]
