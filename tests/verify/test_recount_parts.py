"""The parts of the recount against libraries and published values of their own."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.signal import resample, welch

from fatigue.verify.recount.anew.curve import curve_named
from fatigue.verify.recount.anew.cycles import count_cycles
from fatigue.verify.recount.anew.record import SpectrumRules, finer, welch_moments
from fatigue.verify.recount.anew.spectral import dirlik, tovo_benasciutti


def spectrum_of(sequence, *, recurs):
    """Sum the counts by range."""
    s = np.array(sequence, dtype=float)
    cycles = count_cycles(s, recurs=recurs)
    found = {}
    for i, j, n in zip(cycles.start, cycles.end, cycles.count, strict=True):
        found[abs(s[j] - s[i])] = found.get(abs(s[j] - s[i]), 0.0) + n
    return found


@pytest.mark.parametrize(
    ("sequence", "half", "repeat"),
    [
        ([-2, 1, -3, 5, -1, 3, -4, 4, -2], {3: 0.5, 4: 1.5, 6: 0.5, 8: 1, 9: 0.5}, {3: 1, 4: 1, 7: 1, 9: 1}),
        ([2, 5, 3, 7], {2: 1, 5: 0.5}, {2: 1, 5: 1}),
        ([0, 1], {1: 0.5}, {1: 1}),
        ([1, 0, 0], {1: 0.5}, {1: 1}),
        ([3, 3, 3], {}, {}),
        ([0, 1, 2, 3], {3: 0.5}, {3: 1}),
        ([2, 0, 2, 0, 2], {2: 2}, {2: 2}),
    ],
)
def test_cycles(sequence, half, repeat):
    """ASTM E1049-85 figure 6, residues, two samples, plateaus, ties and a constant."""
    assert spectrum_of(sequence, recurs=False) == half
    assert spectrum_of(sequence, recurs=True) == repeat


def test_a_cycle_may_run_across_the_end_of_a_block():
    """Reversals of a block that recurs are indices of the block itself, one cycle from the largest to the smallest."""
    cycles = count_cycles(np.array([1.0, 0.0, 3.0, 2.0]), recurs=True)
    assert (cycles.start.tolist(), cycles.end.tolist(), cycles.count.tolist()) == ([2], [1], [1.0])


@pytest.mark.parametrize("samples", [64, 65])
@pytest.mark.parametrize("factor", [2, 4])
def test_finer_records_pass_through_the_samples(samples, factor):
    """The periodic interpolation is that of scipy; the mirrored one is even about both ends."""
    q = np.random.default_rng(3).standard_normal((2, samples))
    np.testing.assert_allclose(finer(q, factor, recurs=True), resample(q, samples * factor, axis=1), atol=1e-12)
    single = finer(q, factor, recurs=False)
    assert single.shape == (2, (samples - 1) * factor + 1)
    np.testing.assert_allclose(single[:, ::factor], q, atol=1e-12)
    mirrored = finer(q[:, ::-1], factor, recurs=False)
    np.testing.assert_allclose(single, mirrored[:, ::-1], atol=1e-12)


@pytest.mark.parametrize("segment", [100, 101])
def test_moments_are_those_of_welch(segment):
    """Density of scipy.signal.welch, integrated by the trapezoid rule."""
    stress = np.random.default_rng(5).standard_normal(1000) + 40.0
    f, density = welch(stress, fs=50.0, window="hann", nperseg=segment, noverlap=segment // 2, detrend="constant")
    used = f <= 20.0 + 1e-9
    expected = [np.trapezoid(f[used] ** p * density[used], f[used]) for p in (0, 1, 2, 4)]
    found = welch_moments(stress, 0.02, SpectrumRules(segment / 50, 20.0))
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_a_record_below_one_segment_has_no_moments():
    """Neither a short record nor a segment of fewer than four samples gives a spectrum."""
    assert welch_moments(np.arange(10.0), 0.1, SpectrumRules(1.1, 5.0)) is None
    assert welch_moments(np.arange(10.0), 0.5, SpectrumRules(1.0, 1.0)) is None


def test_master_curve_values():
    """Steel, dS of 157.57788: the three published lives, and the thickness limits of ASME."""
    for level, cycles in (("mean", 3.79386e6), ("mean-2sigma", 1.22148e6), ("mean-3sigma", 6.93101e5)):
        case = {"curve": {"name": "master-steel", "survival": level, "thickness_rule": "asme"}}
        curve = curve_named("master-steel", case, {})
        assert 1 / curve.damage(np.array([157.57788]))[0] == pytest.approx(cycles, rel=5e-6)
        assert curve.size_factor(20.0) == pytest.approx(1 / 0.513904, rel=1e-6)
        assert curve.size_factor(3.0) == curve.size_factor(16.0)


def test_mean_damage_is_the_integral_over_the_density():
    """Closed form in incomplete gamma functions against quadrature, on three slopes with a cut-off."""
    own = {
        "slopes": [3.0, 4.0, 5.0],
        "knees_cycles": [1e5, 1e6, 1e7],
        "range_at_2e6_MPa": 40.0,
        "applies": "structural",
    }
    curve = curve_named("own", {"curve": {"name": "own"}, "curves": {"own": own}}, {})
    for scale, shape in ((10.0, 2.0), (60.0, 2.0), (30.0, 1.0), (3.0, 1.0)):

        def density(x, scale=scale, shape=shape):
            return shape / scale * (x / scale) ** (shape - 1) * np.exp(-((x / scale) ** shape))

        edges = [*sorted({*curve.knees, curve.cutoff}), 2000.0]
        expected = sum(
            quad(lambda x, d=density: d(x) * curve.damage(np.array([x]))[0], a, b, epsabs=0, epsrel=1e-11, limit=200)[0]
            for a, b in pairwise(edges)
        )
        assert curve.mean_damage(scale, shape) == pytest.approx(expected, rel=1e-8)
    assert curve.mean_damage(0.0, 2.0) == 0.0


def test_spectral_methods():
    """Flat band from 10 to 40 Hz: the published Dirlik value; no stress, no damage; a sine is narrow band."""
    moments = np.array([30.0 * (40.0 ** (p + 1) - 10.0 ** (p + 1)) / (p + 1) for p in (0, 1, 2, 4)])
    own = {"slopes": [3.0], "range_at_2e6_MPa": (2**3 * 2.5e11 / 2e6) ** (1 / 3), "applies": "structural"}
    curve = curve_named("own", {"curve": {"name": "own"}, "curves": {"own": own}}, {})
    assert dirlik(moments, curve) == pytest.approx(9.88375446e-6, rel=1e-8)
    assert dirlik(np.zeros(4), curve) == tovo_benasciutti(np.zeros(4), curve) == 0.0
    narrow = dirlik(np.ones(4), curve)
    assert narrow == tovo_benasciutti(np.ones(4), curve) == curve.mean_damage(np.sqrt(8.0), 2.0)
