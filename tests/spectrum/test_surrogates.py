"""Gaussian surrogates and the split of Dirlik over rainflow."""

import numpy as np
import pytest

from fatigue.life.counting.rainflow import rainflow
from fatigue.life.records.history import ModalHistory
from fatigue.spectrum.methods import dirlik_damage_rate
from fatigue.spectrum.moments import moment_matrices, point_moments, segment_spectra
from fatigue.spectrum.surrogates import explained_share, gaussian_surrogate, ratio_split
from tests.naive_spectrum import straight_law
from tests.synthetic_records import RATE, curves, hermite, sine, speed_steps, stationary

K = 3.6


def history(q):
    """Make a record of some modes."""
    q = np.atleast_2d(q)
    return ModalHistory("event", np.arange(len(q)) + 1, q, 1 / RATE, 2.0)


def damage_rate(record):
    """Count every coordinate as the stress of one point."""
    counted = [rainflow(x, "repeat") for x in record.q]
    return np.array([np.sum(c.count * c.range**K) for c in counted]) / record.duration


def split_of(q, **options):
    """Split the ratio of every coordinate and return it with the ratio itself."""
    record = history(q)
    moments = point_moments(np.eye(len(record.q)), moment_matrices(segment_spectra(record, 4.0, 200.0)))
    dirlik, counted = dirlik_damage_rate(moments, straight_law(K)), damage_rate(record)
    split = ratio_split(record, damage_rate, dirlik_rate=dirlik, rainflow_rate=counted, segment_s=4.0, **options)
    return split, dirlik / counted


def test_surrogates_keep_all_cross_spectra():
    """Mean over surrogates of the moment matrices, real and imaginary correlations in them: those of the record."""
    rng = np.random.default_rng(0)
    samples = 8 * 2048
    a, b = stationary(rng, samples), stationary(rng, samples)
    record = history(np.stack([a, b, 2 * np.roll(a, 7) - b]))
    modal_stress = rng.normal(size=(6, 3))
    wanted = moment_matrices(segment_spectra(record, 4.0, 80.0), (0, 1, 2))
    found = np.mean(
        [
            moment_matrices(segment_spectra(gaussian_surrogate(record, 4.0, rng), 4.0, 80.0), (0, 1, 2)).matrix
            for _ in range(40)
        ],
        axis=0,
    )
    ratio = np.einsum("ni,pij,nj->pn", modal_stress, found, modal_stress) / point_moments(modal_stress, wanted)
    np.testing.assert_allclose(ratio, 1.0, atol=0.15)
    np.testing.assert_allclose(np.mean(ratio), 1.0, atol=0.03)


def test_surrogates_are_gaussian_and_stationary():
    """A record of kurtosis 5 that is modulated besides has surrogates of kurtosis 3."""
    rng = np.random.default_rng(1)
    record = history(hermite(rng, 64 * 512) * np.repeat([0.5, 1.5], 32 * 512))
    surrogates = np.stack([gaussian_surrogate(record, 4.0, rng).q[0] for _ in range(20)])
    kurtosis = np.mean(surrogates**4) / np.mean(surrogates**2) ** 2
    assert kurtosis == pytest.approx(3.0, abs=0.15)
    halves = np.mean(surrogates.reshape(20, 2, -1) ** 2, axis=(0, 2))
    assert halves[0] == pytest.approx(halves[1], rel=0.15)


def test_a_surrogate_is_as_long_as_the_record_but_not_endless():
    """Same grid, same modes; a very long record gets surrogates of 16 segments, from 64 of its segments."""
    rng = np.random.default_rng(2)
    short = gaussian_surrogate(history(rng.normal(size=(2, 29 * 512 + 1))), 4.0, rng)
    assert short.q.shape == (2, 29 * 512 + 1)
    assert (short.step, short.start) == (1 / RATE, 2.0)
    noise = rng.normal(size=300 * 512)
    long = gaussian_surrogate(history(noise), 4.0, rng)
    assert long.q.shape == (1, 64 * 512)
    assert long.q.std() == pytest.approx(1.0, rel=0.05)


def test_the_split_is_exact_and_reproducible():
    """A times B is the ratio to the last digits, and the same seed gives the same split."""
    q = np.stack([stationary(np.random.default_rng(s), 29 * 512) for s in (3, 4)])
    split, ratio = split_of(q)
    np.testing.assert_allclose(split.formula * split.process, ratio, rtol=1e-12)
    again, _ = split_of(q)
    other, _ = split_of(q, seed=7)
    np.testing.assert_array_equal(split.formula, again.formula)
    assert np.all(split.formula != other.formula)


@pytest.mark.parametrize(
    ("kind", "formula", "process"),
    [
        (stationary, 1.07, 1.00),
        (speed_steps, 1.07, 0.74),
        (sine(0.9), 1.05, 1.42),
        (curves, 1.2, 0.8),
    ],
)
def test_split_of_known_records(kind, formula, process):
    """Formula error and process error of records made to have them; the curves hide one behind the other."""
    q = np.stack([kind(np.random.default_rng(seed), 205 * 512) for seed in range(3)])
    split, _ = split_of(q)
    assert np.mean(split.formula) == pytest.approx(formula, rel=0.1)
    assert np.mean(split.process) == pytest.approx(process, rel=0.12)
    assert np.all(split.standard_error < 0.2)


def test_explained_share():
    """A modulation that adds a factor of 1.3 explains a process error of 1/1.3 wholly, one of 0.5 in part."""
    split, _ = split_of(stationary(np.random.default_rng(5), 29 * 512))
    exact = type(split)(split.formula, np.array([1 / 1.3]), split.standard_error)
    assert explained_share(exact, np.array([1.3]))[0] == pytest.approx(1.0)
    part = type(split)(split.formula, np.array([0.5]), split.standard_error)
    assert explained_share(part, np.array([1.3]))[0] == pytest.approx(np.log(1.3) / np.log(2))


def test_no_damage_no_split():
    """A point that is never damaged has no ratio to split, and says so with NaN or infinity, not with a warning."""
    record = history(stationary(np.random.default_rng(6), 29 * 512))
    zero = np.zeros(1)
    split = ratio_split(record, lambda _: zero, dirlik_rate=zero, rainflow_rate=zero, segment_s=4.0, surrogates=2)
    assert np.isnan(split.formula[0])
    assert np.isnan(split.process[0])


def test_a_surrogate_has_no_mean():
    """Gravity a thousand times the motion, a trend, a slow wave: none of it moves a surrogate off zero."""
    rng = np.random.default_rng(8)
    q = rng.normal(size=(3, 29 * 512)) + np.array([[1000.0], [-5.0], [0.0]])
    q[1] += np.linspace(0.0, 20.0, q.shape[1])
    surrogate = gaussian_surrogate(history(q), 4.0, rng).q
    assert surrogate.std(axis=1).min() > 0.5
    np.testing.assert_allclose(surrogate.mean(axis=1), 0.0, atol=1e-12)
    assert surrogate[0].std() == pytest.approx(1.0, rel=0.1)


def test_the_scatter_of_the_split_is_that_of_the_mean():
    """Rates of 1 and 3 per second: mean 2, deviation sqrt 2, so an error of ln A of 1 / 2 from two surrogates."""
    rates = iter([np.array([1.0]), np.array([3.0])])
    record = history(stationary(np.random.default_rng(6), 29 * 512))
    two = {"dirlik_rate": np.array([4.0]), "rainflow_rate": np.array([0.5]), "segment_s": 4.0, "surrogates": 2}
    split = ratio_split(record, lambda _: next(rates), **two)
    assert (split.formula[0], split.process[0]) == (2.0, 4.0)
    assert split.standard_error[0] == pytest.approx(0.5, rel=1e-12)
