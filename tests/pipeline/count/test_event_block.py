"""One event on one block against slow versions: superposition, covariances, spectra, shear."""

from dataclasses import fields

import numba
import numpy as np
import pytest
import scipy.signal
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.curves import catalogue, damage_law
from fatigue.life.records.history import ModalHistory
from fatigue.life.rule import CycleRule, ratio_factor
from fatigue.pipeline.mission.event_load import prepare_event
from fatigue.pipeline.solve.modal_stress import Shapes
from fatigue.spectrum.methods import dirlik_damage_rate
from fatigue.spectrum.moments import segment_spectra
from tests.one_event import assess_event_block

LAW = damage_law(catalogue()["master-aluminium"], "mean-2sigma", "none", 1e7)
ALUMINIUM = CycleRule(LAW, uses_bending_ratio=True)
STEP = 0.004


def record(seed=0, samples=3000, modes=4):
    """Correlated noise with a large mean, as gravity leaves it."""
    rng = np.random.default_rng(seed)
    q = scipy.signal.lfilter(np.ones(5) / 5, 1.0, rng.standard_normal((modes, samples)), axis=1)
    q[1:2] += 0.5 * q[0]
    return ModalHistory("e", np.arange(modes), q + rng.normal(0.0, 100.0, (modes, 1)), STEP, 0.0)


def shapes(seed=1, stations=3, modes=4, rule=ALUMINIUM):
    """Random stress shapes."""
    rng = np.random.default_rng(seed)
    S = rng.normal(0.0, 10.0, (4, stations, modes))
    return Shapes(*S, size=np.full(stations, 1.5), rule=rule)


def load(history, residue="repeat", stress_factor=1.0, segment_s=1.0):
    """Prepare an event with its spectrum."""
    return prepare_event(history, residue, stress_factor, 1, segment_spectra(history, segment_s, 100.0), 40.0)


def test_statistics_are_those_of_the_recovered_stress():
    """Mean, bending ratio, shear ratio from the covariance of q equal those of the recovered histories."""
    history, S = record(), shapes()
    found = assess_event_block(S, load(history))
    m, b = S.membrane @ history.q, S.bending @ history.q
    tau_m, tau_b = S.in_plane_shear @ history.q, S.twist_shear @ history.q
    for face, sign in ((0, 1.0), (1, -1.0)):
        stress, shear = m + sign * b, tau_m + sign * tau_b
        assert found.mean[:, face] == pytest.approx(stress.mean(axis=1), rel=1e-9)
        assert found.shear_ratio[:, face] == pytest.approx(shear.std(axis=1) / stress.std(axis=1), rel=1e-9)
        assert found.bending_ratio[:, face] == pytest.approx(b.std(axis=1) / (m.std(axis=1) + b.std(axis=1)), rel=1e-9)
        centred = stress - stress.mean(axis=1, keepdims=True)
        assert found.kurtosis[:, face] == pytest.approx(
            (centred**4).mean(axis=1) / (centred**2).mean(axis=1) ** 2, rel=1e-6
        )


def test_dirlik_is_that_of_welchs_spectrum_of_the_equivalent_stress():
    """Damage by matrices equals damage from the Welch PSD of the recovered stress times its one factor."""
    history, S = record(), shapes()
    found = assess_event_block(S, load(history))
    factor = 1.5 / ratio_factor(found.bending_ratio[0, 0])
    equivalent = factor * (S.membrane[0] + S.bending[0]) @ history.q
    n = round(1.0 / STEP)
    f, G = scipy.signal.welch(equivalent, 1 / STEP, "hann", n, n // 2, detrend="constant")
    kept = f <= 100.0
    moments = np.array([[np.trapezoid(f[kept] ** p * G[kept], f[kept])] for p in (0, 1, 2, 4)])
    expected = dirlik_damage_rate(moments, LAW)[0] * history.duration
    assert found.damage_dirlik[0, 0] == pytest.approx(expected, rel=1e-10)
    assert found.peaks_per_s[0, 0] == pytest.approx(np.sqrt(moments[3, 0] / moments[2, 0]), rel=1e-10)
    assert found.samples_per_peak[0, 0] == pytest.approx(1 / STEP / found.peaks_per_s[0, 0], rel=1e-12)


@settings(deadline=None, max_examples=15)
@given(factor=st.floats(0.3, 3.0), seed=st.integers(0, 100))
def test_stress_factor_scales_every_damage_with_its_power(factor, seed):
    """All four damages of a straight law scale with factor^k; ratios and rates stay."""
    k = LAW.slopes[0]
    S = shapes(seed, rule=CycleRule(LAW, uses_bending_ratio=True, yield_MPa=200.0))
    plain = assess_event_block(S, load(record(seed, 800), segment_s=0.5))
    scaled = assess_event_block(S, load(record(seed, 800), stress_factor=factor, segment_s=0.5))
    for name in ("damage", "damage_same_ratio", "damage_dirlik", "damage_tb", "damage_shear", "power_sum"):
        assert getattr(scaled, name) == pytest.approx(factor**k * getattr(plain, name), rel=1e-9)
    for name in ("bending_ratio", "shear_ratio", "irregularity", "peaks_per_s", "kurtosis"):
        assert getattr(scaled, name) == pytest.approx(getattr(plain, name), rel=1e-9)


def test_a_block_is_its_stations():
    """No station depends on another: cut anywhere, the bytes are the same up to the rounding of the product."""
    history, S = record(), shapes(stations=5)
    whole = assess_event_block(S, load(history))
    one = Shapes(
        *(getattr(S, n)[2:3] for n in ("membrane", "bending", "in_plane_shear", "twist_shear", "size")),
        rule=S.rule,
    )
    alone = assess_event_block(one, load(history))
    assert alone.damage[0] == pytest.approx(whole.damage[2], rel=1e-12)
    assert alone.damage_dirlik[0] == pytest.approx(whole.damage_dirlik[2], rel=1e-12)


def test_one_ratio_is_exact_for_one_mode():
    """A single mode has one bending ratio in every cycle, so both counts agree."""
    history = record(modes=1)
    found = assess_event_block(shapes(modes=1), load(history))
    assert found.damage_same_ratio == pytest.approx(found.damage, rel=1e-12)


def test_without_shear_shapes_shear_changes_nothing():
    """No shear stress: ratio 0, damage unchanged."""
    S = shapes()
    none = Shapes(S.membrane, S.bending, 0 * S.membrane, 0 * S.membrane, S.size, S.rule)
    found = assess_event_block(none, load(record()))
    assert (found.shear_ratio == 0.0).all()
    assert found.damage_shear == pytest.approx(found.damage, rel=1e-12)


def test_a_constant_record_does_nothing():
    """No variation: no damage in either domain, no NaN in a damage, no ratio made up."""
    rest = np.random.default_rng(5).normal(0.0, 100.0, (4, 1))
    history = ModalHistory("e", np.arange(4), np.tile(rest, 600), STEP, 0.0)
    found = assess_event_block(shapes(), load(history))
    for name in ("damage", "damage_same_ratio", "damage_dirlik", "damage_tb", "damage_shear", "cycles", "max_range"):
        assert (getattr(found, name) == 0.0).all(), name
    for name in ("bending_ratio", "shear_ratio", "irregularity", "peaks_per_s", "kurtosis"):
        assert np.isnan(getattr(found, name)).all(), name
    assert (found.verdict == 0).all()


def test_a_record_without_spectrum_has_no_estimate():
    """Shorter than a segment: NaN, not zero."""
    history = record(samples=50)
    found = assess_event_block(shapes(), prepare_event(history, "half", 1.0, 1, None, None))
    assert np.isnan(found.damage_dirlik).all()
    assert np.isnan(found.peaks_per_s).all()
    assert (found.damage > 0.0).all()


def test_plain_structural_curves_do_not_use_the_bending_ratio():
    """With a FAT class the factor I(r) is 1 in both domains."""
    law = damage_law(catalogue()["iiw-aluminium-40"], None, "none", 1e7)
    S = shapes(rule=CycleRule(law, uses_bending_ratio=False))
    found = assess_event_block(S, load(record()))
    assert found.damage == pytest.approx(found.damage_same_ratio, rel=1e-12)
    assert found.max_equivalent_range == pytest.approx(1.5 * found.max_range, rel=1e-12)
    assert found.histogram.shape[:2] == (3, 2)
    assert found.histogram[..., 0].sum(axis=-1) == pytest.approx(found.cycles, rel=1e-12)


@pytest.mark.skipif(numba.config.DISABLE_JIT, reason="the kernel of large jobs exists in compiled form only")
@pytest.mark.parametrize("residue", ["repeat", "half"])
def test_the_kernel_of_large_jobs_gives_the_same_block(residue):
    """Single precision with its doubts recounted: every field within the 1e-6 that results promise."""
    history = record(samples=6000)
    S = shapes(stations=40, rule=CycleRule(LAW, uses_bending_ratio=True, yield_MPa=300.0))
    spectra = segment_spectra(history, 1.0, 100.0)
    double, single = (
        assess_event_block(S, prepare_event(history, residue, 1.2, 1, spectra, 40.0, single=single))
        for single in (False, True)
    )
    for field in fields(double):
        a, b = getattr(double, field.name), getattr(single, field.name)
        tolerance = 1e-5 if field.name == "r_largest" else 1e-6  # min / max of the largest cycle is ill-conditioned
        assert b == pytest.approx(a, rel=tolerance, abs=tolerance if field.name == "r_largest" else 0.0, nan_ok=True)
