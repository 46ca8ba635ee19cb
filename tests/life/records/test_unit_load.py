"""A unit load between its samples: published numbers, exactness for band-limited records, steps, coverage."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.records.history import ModalHistory, upsampled
from fatigue.life.records.unit_load import LoadRecord, UniformGrid, trigonometric_interpolant


def record(values, start=0.0, step=1.0, interpolation="fourier", periodic=False) -> LoadRecord:
    """A load record."""
    return LoadRecord(np.asarray(values), UniformGrid(start, step, len(values)), interpolation, periodic)


def test_fourier_interpolation_of_a_period():
    """Band-limited record of 32 samples on a grid four times finer: the formula itself (A1 fourier_repeat)."""

    def formula(i):
        return 0.7 + np.sin(2 * np.pi * 3 * i / 32) + 0.4 * np.cos(2 * np.pi * 7 * i / 32)

    fine = record(formula(np.arange(32)), periodic=True).at(UniformGrid(0.0, 0.25, 128))
    expected = [1.22334810052857, 1.299488858599557, 1.3331961911075707, 1.3128667650648735, 1.5427144082165296]
    np.testing.assert_allclose(fine[[1, 2, 3, 5, 50]], expected, rtol=1e-12)
    assert fine[127] == pytest.approx(0.9298871516178443, rel=1e-12)
    assert fine.max() == pytest.approx(2.0779608609650806, rel=1e-12)


def test_fourier_interpolation_of_a_mirrored_record():
    """Single passes (A1 fourier_half)."""
    ramp = record([0.0, 1.0]).at(UniformGrid(0.0, 0.25, 5))
    np.testing.assert_allclose(ramp, [0.0, 0.14644660940672627, 0.5, 0.8535533905932737, 1.0], atol=1e-15)
    four = record([0.0, 1.0, 0.5, 2.0]).at(UniformGrid(0.0, 0.5, 7))
    expected = [0.0, 0.48365396477444733, 1.0, 0.6666666666666666, 0.5, 1.349679368558886, 2.0]
    np.testing.assert_allclose(four, expected, atol=1e-14)


@settings(deadline=None, max_examples=40)
@given(samples=st.integers(2, 40), factor=st.sampled_from([2, 4, 8]), repeats=st.booleans(), seed=st.integers(0, 99))
def test_it_is_what_upsampling_makes(samples, factor, repeats, seed):
    """On a grid a whole number of times finer a load is what upsampling makes of a mode."""
    values = np.random.default_rng(seed).normal(size=samples)
    grid = UniformGrid(3.0, 0.1, samples)
    load = record(values, 3.0, 0.1, periodic=repeats)
    history = ModalHistory("e", np.array([1]), values[np.newaxis], 0.1, 3.0)
    fine = upsampled(history, factor, "repeat" if repeats else "half")
    found = load.at(grid.finer(factor, repeats=repeats))
    np.testing.assert_allclose(found, np.asarray(fine.q)[0], atol=1e-12 * np.abs(values).max())


@settings(deadline=None, max_examples=40)
@given(samples=st.integers(4, 50), rate=st.floats(0.05, 1.0), first=st.floats(0.0, 3.0), seed=st.integers(0, 99))
def test_it_is_exact_for_band_limited_records(samples, rate, first, seed):
    """On any grid, of a period of any length."""
    rng = np.random.default_rng(seed)
    line = np.arange(1, (samples - 1) // 2 + 1)
    size, phase = rng.normal(size=line.size), rng.uniform(0.0, 6.0, line.size)

    def formula(place):
        return 0.3 + np.cos(2 * np.pi * line * place[:, np.newaxis] / samples + phase) @ size

    found = trigonometric_interpolant(formula(np.arange(samples, dtype=float)), first, rate, 70)
    np.testing.assert_allclose(found, formula(first + rate * np.arange(70)), atol=1e-11)


def test_the_same_instants_are_taken_as_they_are():
    """Bit for bit, within a thousandth of a step; beyond it they are interpolated."""
    values = np.random.default_rng(1).normal(size=50).astype(np.float32)
    load = record(values, start=-2.0, step=0.1)
    found = load.at(UniformGrid(0.0, 0.1, 20))
    assert found.dtype == np.float32
    np.testing.assert_array_equal(found, values[20:40])
    np.testing.assert_array_equal(load.at(UniformGrid(0.00009, 0.1, 20)), values[20:40])
    assert load.same_instants(UniformGrid(0.0002, 0.1, 20)) is None
    assert load.same_instants(UniformGrid(0.0, 0.1, 40)) is None  # it does not last so long
    assert load.same_instants(UniformGrid(0.0, 0.10001, 20)) is None


def test_linear_interpolation_invents_nothing():
    """A door: between its samples nothing is outside them, and the sampled values are kept."""
    door = record([0.0, 0.0, 1.0, 1.0, 0.0], interpolation="linear")
    found = door.at(UniformGrid(0.0, 0.25, 17))
    assert (found.min(), found.max()) == (0.0, 1.0)
    np.testing.assert_array_equal(found[::4], door.values)
    assert door.overshoot(found) == 0.0
    smooth = record(door.values)
    assert smooth.overshoot(smooth.at(UniformGrid(0.0, 0.25, 17))) > 0.05


def test_linear_interpolation_of_a_period_closes():
    """Between the last sample and the first of the next pass."""
    found = record([1.0, 0.0, 3.0], interpolation="linear", periodic=True).at(UniformGrid(0.0, 0.5, 6))
    np.testing.assert_allclose(found, [1.0, 0.5, 0.0, 1.5, 3.0, 2.0])


@pytest.mark.parametrize(
    ("start", "step", "samples", "periodic"),
    [(0.0, 0.5, 20, True), (0.0, 0.0999, 100, False), (0.001, 0.5, 20, False), (0.0, 0.5, 21, False)],
)
def test_what_is_one_period(start, step, samples, periodic):
    """First instant and duration are those of the kept record, both within a thousandth of the load's step."""
    kept = UniformGrid(0.0, 0.1, 100)
    load = record(np.zeros(samples), start, step)
    assert load.within(kept, repeats=True).periodic == periodic
    assert not load.within(kept, repeats=False).periodic


@pytest.mark.parametrize(
    ("start", "samples", "covers"), [(0.0, 101, True), (0.25, 100, True), (0.3, 101, False), (0.0, 100, False)]
)
def test_coverage(start, samples, covers):
    """Within half a step at both ends; nothing is extrapolated."""
    assert record(np.zeros(samples), start, 0.5).covers(UniformGrid(0.0, 0.25, 201)) == covers


@pytest.mark.parametrize(("step", "factor"), [(0.1, 1), (0.0999, 2), (0.09995, 1), (0.05, 2), (0.03, 4), (0.2, 1)])
def test_refinement(step, factor):
    """The smallest power of 2 whose step is not above that of the load."""
    assert record(np.zeros(9), step=step).refinement(0.1) == factor
