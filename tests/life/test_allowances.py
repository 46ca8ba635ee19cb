"""What stands between a stress range and its curve: thickness, bending, stress ratio, against printed tables."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.errors import CaseError
from fatigue.life.allowances import (
    RATIO_LEVELS,
    Allowances,
    StressRatio,
    bending_allowance,
    bending_thickness,
    effective_thickness,
    log_bending_allowance_slope,
    stress_ratio_factor,
    stress_ratio_factors,
    stress_ratio_slopes,
)
from fatigue.life.curves import damage_law, user_curve
from fatigue.life.rule import CycleRule, size_factor

LAW = damage_law(user_curve("own", (3.0,), (), 90.0, "structural", "test"), None, "none", 1e7)
LOW = [(-2.0, 1.6), (-1.0, 1.6), (-0.5, 1.4), (0.0, 1.2), (0.5, 1.0), (0.8, 1.0)]
MEDIUM = [(-2.0, 1.3), (-1.0, 1.3), (-0.5, 1.1), (-0.25, 1.0), (0.0, 1.0)]
STRESS = st.floats(-500.0, 500.0)


@pytest.mark.parametrize(
    ("kind", "R", "f"), [("iiw_low", R, f) for R, f in LOW] + [("iiw_medium", R, f) for R, f in MEDIUM]
)
def test_factors_of_the_stress_ratio(kind: StressRatio, R: float, f: float) -> None:
    """IIW 2016: low residual stress 1.6 to 1, medium 1.3 to 1, R of the cycle."""
    low, high = (R * 100.0, 100.0) if abs(R) <= 1.0 else (-100.0, -100.0 / R)
    assert stress_ratio_factor(low, high, RATIO_LEVELS[kind]) == pytest.approx(f, rel=1e-14)
    found = CycleRule(LAW, False, stress_ratio=kind).mean_stress_factor(np.array([low]), np.array([high]))
    assert found[0] == pytest.approx(f, rel=1e-14)


@pytest.mark.parametrize("maximum", [0.0, -1e-300, -50.0])
def test_a_cycle_in_compression_has_the_factor_of_alternating_stress(maximum: float) -> None:
    """A largest stress of 0 divides nothing, and R = max / min is not taken for min / max."""
    for level, f in ((1.2, 1.6), (0.9, 1.3)):
        assert stress_ratio_factor(-80.0, maximum, level) == pytest.approx(f)
        assert stress_ratio_factors(np.array([-80.0]), np.array([maximum]), level)[0] == pytest.approx(f)


@given(a=STRESS, b=STRESS, scale=st.floats(1e-3, 1e3), level=st.sampled_from([1.2, 0.9]))
def test_the_factor_of_the_stress_ratio_knows_no_scale(a: float, b: float, scale: float, level: float) -> None:
    """It is one for arrays and numbers, from 1 to its value at R = -1, so that bounds may leave it out."""
    low, high = min(a, b), max(a, b)
    f = stress_ratio_factor(low, high, level)
    assert 1.0 <= f <= level + 0.4
    assert stress_ratio_factors(np.array([low]), np.array([high]), level)[0] == pytest.approx(f, rel=1e-14)
    if abs(low + high) > 1e-9:
        assert stress_ratio_factor(scale * low, scale * high, level) == pytest.approx(f, rel=1e-9)


@given(high=st.floats(1.0, 300.0), R=st.floats(-0.99, 0.6), level=st.sampled_from([1.2, 0.9]))
def test_slopes_of_the_stress_ratio_are_its_derivatives(high: float, R: float, level: float) -> None:
    """Central differences of ln(S / f), on and off the plateaus, away from their ends."""
    if min(abs(R - end) for end in (0.5, -0.25, -1.0)) < 1e-3:
        return

    def log_x(S: float, maximum: float) -> float:
        return float(np.log(S / stress_ratio_factor(maximum - S, maximum, level)))

    S, h = high * (1.0 - R), 1e-6
    by_range, by_peak = (x[0] for x in stress_ratio_slopes(np.array([high - S]), np.array([high]), level))
    assert by_range == pytest.approx((log_x(S * np.exp(h), high) - log_x(S * np.exp(-h), high)) / (2 * h), abs=1e-7)
    step = h * high
    assert by_peak == pytest.approx((log_x(S, high + step) - log_x(S, high - step)) / (2 * step), abs=1e-7)
    assert by_range + by_peak * high == pytest.approx(1.0)  # a scale of all stresses is one of x


@pytest.mark.parametrize(("t", "omega", "f"), [(25.0, 0.0, 1.0), (25.0, 1.0, 1.18), (50.0, 0.5, 0.898251643483)])
def test_allowance_for_bending(t: float, omega: float, f: float) -> None:
    """BS 7608: (25 / t)^0.25 (1 + 0.18 Omega^1.4) divides the range."""
    of = Allowances(bending_factor="bs7608", bending_reference=25.0, bending_exponent=0.25)
    of_range = bending_thickness(np.array([t]), of)[0] / bending_allowance(omega)
    assert 1.0 / of_range == pytest.approx(f, rel=1e-11)
    rule = CycleRule(LAW, False, bending_factor="bs7608")
    assert rule.ratio_factor(np.array([omega]))[0] == bending_allowance(omega)
    assert rule.depends_on_bending


def test_the_allowance_for_bending_rises_from_one() -> None:
    """Smallest in pure membrane, as bounds take it; its slope is the derivative."""
    r = np.linspace(0.0, 1.0, 201)
    assert (np.diff(bending_allowance(r)) > 0.0).all()
    of_slope = np.gradient(np.log(bending_allowance(r)), r)
    np.testing.assert_allclose(log_bending_allowance_slope(r[5:-5]), of_slope[5:-5], rtol=2e-3)


@pytest.mark.parametrize(
    ("t", "n", "strength"), [(16.0, 0.3, 1.0), (50.0, 0.3, 0.812252396356), (50.0, 0.1, 0.933032991537)]
)
def test_thickness_above_the_reference_alone(t: float, n: float, strength: float) -> None:
    """(25 / t)^n on the strength, its inverse on the range."""
    curve = user_curve("own", (3.0,), (), 90.0, "structural", "test", thickness_reference=25.0, thickness_exponent=n)
    assert 1.0 / size_factor(np.array([t]), curve, "actual")[0] == pytest.approx(strength, rel=1e-11)


def test_effective_thickness_of_an_attachment() -> None:
    """L / 2 up to L / t = 2, which is t; t beyond."""
    t, L = np.array([10.0, 10.0, 10.0]), np.array([8.0, 20.0, 50.0])
    assert effective_thickness(t, L).tolist() == [4.0, 10.0, 10.0]


@pytest.mark.parametrize(
    "twice",
    [
        {"uses_bending_ratio": True, "yield_MPa": 250.0, "mean_stress": True, "stress_ratio": "iiw_low"},
        {"uses_bending_ratio": True, "yield_MPa": 250.0, "stress_ratio": "iiw_medium"},
        {"uses_bending_ratio": True, "bending_factor": "bs7608"},
    ],
)
def test_what_is_allowed_for_twice_is_refused(twice: dict[str, object]) -> None:
    """f_M beside f(R), I(r) beside the allowance for bending."""
    with pytest.raises(CaseError, match="both allow for"):
        CycleRule(LAW, **twice)
