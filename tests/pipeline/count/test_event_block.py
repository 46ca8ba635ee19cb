"""One event on one block against slow versions: superposition, covariances, spectra, shear."""

import numba
import numpy as np
import pytest
import scipy.signal
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.curves import catalogue, damage_law
from fatigue.life.records.history import ModalHistory
from fatigue.life.rule import CycleRule, ratio_factor
from fatigue.pipeline.mission.event_load import HowCounted, prepare_event
from fatigue.pipeline.solve.modal_stress import ModalStress
from fatigue.spectrum.methods import dirlik_damage_rate, tovo_benasciutti_damage_rate
from fatigue.spectrum.moments import segment_spectra
from tests.one_event import NO_RAW_ENDS, assess_event_block, numbers_of

LAW = damage_law(catalogue()["master-aluminium"], "mean-2sigma", "none", 1e7)
ALUMINIUM = CycleRule(LAW, uses_bending_ratio=True)
STEP = 0.004
DAMAGES = "count.damage", "count.damage_same_ratio", "estimate.dirlik", "estimate.tb", "damage_shear"
RATIOS = "estimate.bending_ratio", "shear_ratio", "estimate.irregularity", "estimate.peaks_per_s", "count.kurtosis"


def record(seed=0, samples=3000, modes=4):
    """Correlated noise with a large mean, as gravity leaves it."""
    rng = np.random.default_rng(seed)
    q = scipy.signal.lfilter(np.ones(5) / 5, 1.0, rng.standard_normal((modes, samples)), axis=1)
    q[1:2] += 0.5 * q[0]
    return ModalHistory("e", np.arange(modes), q + rng.normal(0.0, 100.0, (modes, 1)), STEP, 0.0)


def modal_stress(seed=1, stations=3, modes=4, rule=ALUMINIUM):
    """Random stress."""
    rng = np.random.default_rng(seed)
    S = rng.normal(0.0, 10.0, (4, stations, modes))
    return ModalStress(*S, size=np.full(stations, 1.5), rule=rule, **NO_RAW_ENDS)


def load(history, residue="repeat", stress_factor=1.0, segment_s=1.0):
    """Prepare an event with its spectrum."""
    return prepare_event(history, HowCounted(residue, stress_factor), segment_spectra(history, segment_s, 100.0), 40.0)


def test_statistics_are_those_of_the_recovered_stress():
    """Mean, bending ratio, shear ratio from the covariance of q equal those of the recovered histories."""
    history, S = record(), modal_stress()
    found = assess_event_block(S, load(history))
    m, b = S.membrane @ history.q, S.bending @ history.q
    tau_m, tau_b = S.in_plane_shear @ history.q, S.twist_shear @ history.q
    for face, sign in ((0, 1.0), (1, -1.0)):
        stress, shear = m + sign * b, tau_m + sign * tau_b
        assert found.estimate.mean[:, face] == pytest.approx(stress.mean(axis=1), rel=1e-9)
        assert found.shear_ratio[:, face] == pytest.approx(shear.std(axis=1) / stress.std(axis=1), rel=1e-9)
        assert found.estimate.bending_ratio[:, face] == pytest.approx(
            b.std(axis=1) / (m.std(axis=1) + b.std(axis=1)), rel=1e-9
        )
        centred = stress - stress.mean(axis=1, keepdims=True)
        assert found.count.kurtosis[:, face] == pytest.approx(
            (centred**4).mean(axis=1) / (centred**2).mean(axis=1) ** 2, rel=1e-6
        )


def test_dirlik_is_that_of_welchs_spectrum_of_the_equivalent_stress():
    """Damage by matrices equals damage from the Welch PSD of the recovered stress times its one factor."""
    history, S = record(), modal_stress()
    found = assess_event_block(S, load(history))
    factor = 1.5 / ratio_factor(found.estimate.bending_ratio[0, 0])
    equivalent = factor * (S.membrane[0] + S.bending[0]) @ history.q
    n = round(1.0 / STEP)
    f, G = scipy.signal.welch(equivalent, 1 / STEP, "hann", n, n // 2, detrend="constant")
    kept = f <= 100.0
    moments, whole = (
        np.array([[np.trapezoid(f[some] ** p * G[some], f[some])] for p in (0, 1, 2, 4)]) for some in (kept, f >= 0.0)
    )
    expected = dirlik_damage_rate(moments, LAW)[0] * history.duration
    assert found.estimate.dirlik[0, 0] == pytest.approx(expected, rel=1e-10)
    assert found.estimate.tb_whole[0, 0] == pytest.approx(
        tovo_benasciutti_damage_rate(whole, LAW)[0] * history.duration, rel=1e-10
    )
    assert found.estimate.outside_share[0, 0] == pytest.approx(1 - moments[0, 0] / whole[0, 0], rel=1e-10)
    assert found.estimate.peaks_per_s[0, 0] == pytest.approx(np.sqrt(whole[3, 0] / whole[2, 0]), rel=1e-10)
    assert found.estimate.samples_per_peak[0, 0] == pytest.approx(
        1 / STEP / found.estimate.peaks_per_s[0, 0], rel=1e-12
    )


@settings(deadline=None, max_examples=15)
@given(factor=st.floats(0.3, 3.0), seed=st.integers(0, 100))
def test_stress_factor_scales_every_damage_with_its_power(factor, seed):
    """All four damages of a straight law scale with factor^k; ratios and rates stay."""
    k = LAW.slopes[0]
    S = modal_stress(seed, rule=CycleRule(LAW, uses_bending_ratio=True, yield_MPa=200.0))
    plain = numbers_of(assess_event_block(S, load(record(seed, 800), segment_s=0.5)))
    scaled = numbers_of(assess_event_block(S, load(record(seed, 800), stress_factor=factor, segment_s=0.5)))
    for name in (
        "count.damage",
        "count.damage_same_ratio",
        "estimate.dirlik",
        "estimate.tb",
        "damage_shear",
        "count.power_sum",
    ):
        assert scaled[name] == pytest.approx(factor**k * plain[name], rel=1e-9)
    for name in (
        "estimate.bending_ratio",
        "shear_ratio",
        "estimate.irregularity",
        "estimate.peaks_per_s",
        "count.kurtosis",
    ):
        assert scaled[name] == pytest.approx(plain[name], rel=1e-9)


def test_a_block_is_its_stations():
    """No station depends on another: cut anywhere, the bytes are the same up to the rounding of the product."""
    history, S = record(), modal_stress(stations=5)
    whole = assess_event_block(S, load(history))
    one = ModalStress(
        *(getattr(S, n)[2:3] for n in ("membrane", "bending", "in_plane_shear", "twist_shear", "size")),
        rule=S.rule,
        **NO_RAW_ENDS,
    )
    alone = assess_event_block(one, load(history))
    assert alone.count.damage[0] == pytest.approx(whole.count.damage[2], rel=1e-12)
    assert alone.estimate.dirlik[0] == pytest.approx(whole.estimate.dirlik[2], rel=1e-12)


def test_one_ratio_is_exact_for_one_mode():
    """A single mode has one bending ratio in every cycle, so both counts agree."""
    history = record(modes=1)
    found = assess_event_block(modal_stress(modes=1), load(history))
    assert found.count.damage_same_ratio == pytest.approx(found.count.damage, rel=1e-12)


def test_without_shear_stress_shear_changes_nothing():
    """No shear stress: ratio 0, damage unchanged."""
    S = modal_stress()
    none = ModalStress(S.membrane, S.bending, 0 * S.membrane, 0 * S.membrane, S.size, S.rule, **NO_RAW_ENDS)
    found = assess_event_block(none, load(record()))
    assert (found.shear_ratio == 0.0).all()
    assert found.damage_shear == pytest.approx(found.count.damage, rel=1e-12)


def test_a_constant_record_does_nothing():
    """No variation: no damage in either domain, no NaN in a damage, no ratio made up."""
    rest = np.random.default_rng(5).normal(0.0, 100.0, (4, 1))
    history = ModalHistory("e", np.arange(4), np.tile(rest, 600), STEP, 0.0)
    found = assess_event_block(modal_stress(), load(history))
    for name in (
        "count.damage",
        "count.damage_same_ratio",
        "estimate.dirlik",
        "estimate.tb",
        "damage_shear",
        "count.cycles",
        "count.max_range",
    ):
        assert (numbers_of(found)[name] == 0.0).all(), name
    for name in (
        "estimate.bending_ratio",
        "shear_ratio",
        "estimate.irregularity",
        "estimate.peaks_per_s",
        "count.kurtosis",
    ):
        assert np.isnan(numbers_of(found)[name]).all(), name
    assert (found.verdict == 0).all()


def test_a_record_without_spectrum_has_no_estimate():
    """Shorter than a segment: NaN, not zero."""
    history = record(samples=50)
    found = assess_event_block(modal_stress(), prepare_event(history, HowCounted("half"), None, None))
    assert np.isnan(found.estimate.dirlik).all()
    assert np.isnan(found.estimate.peaks_per_s).all()
    assert (found.count.damage > 0.0).all()


def test_plain_structural_curves_do_not_use_the_bending_ratio():
    """With a FAT class the factor I(r) is 1 in both domains."""
    law = damage_law(catalogue()["iiw-aluminium-40"], None, "none", 1e7)
    S = modal_stress(rule=CycleRule(law, uses_bending_ratio=False))
    found = assess_event_block(S, load(record()))
    assert found.count.damage == pytest.approx(found.count.damage_same_ratio, rel=1e-12)
    assert found.count.max_equivalent_range == pytest.approx(1.5 * found.count.max_range, rel=1e-12)
    assert found.count.histogram.shape[:2] == (3, 2)
    assert found.count.histogram[..., 0].sum(axis=-1) == pytest.approx(found.count.cycles, rel=1e-12)


@pytest.mark.skipif(numba.config.DISABLE_JIT, reason="the kernel of large jobs exists in compiled form only")
@pytest.mark.parametrize("residue", ["repeat", "half"])
def test_the_kernel_of_large_jobs_gives_the_same_block(residue):
    """Single precision with its doubts recounted: every field within the 1e-6 that results promise."""
    history = record(samples=6000)
    S = modal_stress(stations=40, rule=CycleRule(LAW, uses_bending_ratio=True, yield_MPa=300.0))
    spectra = segment_spectra(history, 1.0, 100.0)
    double, single = (
        numbers_of(
            assess_event_block(S, prepare_event(history, HowCounted(residue, 1.2, single=single), spectra, 40.0))
        )
        for single in (False, True)
    )
    for name, expected in double.items():
        ill = name == "count.r_largest"  # min / max of the largest cycle is ill-conditioned
        assert single[name] == pytest.approx(expected, rel=1e-5 if ill else 1e-6, abs=1e-5 if ill else 0.0, nan_ok=True)
