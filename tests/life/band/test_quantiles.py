"""Lives at a survival against the specification: S-N scatter alone, all parts together, and with knees."""

import numpy as np
import pytest
from scipy.special import ndtr, ndtri

from fatigue.life.band.knees import log_life_factors
from fatigue.life.band.quantiles import STRENGTHS, SURVIVALS, combined_sigma, life_of_strengths, lognormal_life
from fatigue.life.band.strength import strength_scatter
from fatigue.life.curves import catalogue, damage_law, user_curve
from fatigue.life.rule import cycle_damage

ALUMINIUM = strength_scatter(catalogue()["master-aluminium"], "mean-2sigma")
ON_MEAN_MINUS_2SIGMA = {  # B5_band.quantile_life_factors_on_mean_minus_2sigma_life
    0.5: 4.41175761744262,
    0.9: 1.7043552130521327,
    0.9772498680518208: 1.0,
    0.99: 0.7849033454605941,
}
COMBINED_KM = {  # B5_band.combined
    0.5: 10000000.0,
    0.9: 3418825.5114662275,
    0.977: 1880355.7224244704,
    0.99: 1425167.6761626233,
}


def of_user(slopes=(3.0, 5.0), knees=(1e7,)):
    """Of user."""
    return user_curve("mine", slopes, knees, 100.0, "structural", "own tests", log10_scatter=0.2)


def test_scatter_of_the_curves_is_that_of_the_specification():
    """Scatter of the curves is that of the specification."""
    steel = strength_scatter(catalogue()["master-steel"], "mean-2sigma")
    assert ALUMINIUM.sigma_ln / np.log(10.0) == pytest.approx(0.3223058221131365, rel=1e-12)  # sigma_log10_N
    assert steel.sigma_ln / np.log(10.0) == pytest.approx(0.2460982085803678, rel=1e-12)
    assert strength_scatter(of_user(), "mean").sigma_ln == pytest.approx(0.2 * np.log(10.0), rel=1e-12)
    assert strength_scatter(catalogue()["iiw-steel-90"], "as tabulated") is None


@pytest.mark.parametrize(("survival", "z"), [("mean", 0.0), ("mean-1sigma", -1.0), ("mean-3sigma", -3.0)])
def test_a_curve_knows_the_strength_it_is_used_at(survival, z):
    """A curve knows the strength it is used at."""
    assert strength_scatter(of_user(), survival).used_at == pytest.approx(z, abs=1e-12)
    assert strength_scatter(catalogue()["master-steel"], survival).used_at == pytest.approx(z, abs=1e-4)


@pytest.mark.parametrize("survival", ON_MEAN_MINUS_2SIGMA)
def test_with_the_scatter_of_the_curve_alone_the_headline_life_is_that_of_97_725_percent(survival):
    """With the scatter of the curve alone the headline life is that of 97 725 percent."""
    median = float(ALUMINIUM.range_factor(np.array(0.0)) ** ALUMINIUM.slope)
    found = lognormal_life(median, ALUMINIUM.sigma_ln, survival)
    assert found == pytest.approx(ON_MEAN_MINUS_2SIGMA[survival], rel=1e-9)
    assert SURVIVALS["p97_7"] == pytest.approx(0.9772498680518208, rel=1e-12)


@pytest.mark.parametrize("survival", COMBINED_KM)
def test_all_parts_together_are_those_of_the_specification(survival):
    """All parts together are those of the specification."""
    sigma = combined_sigma(np.sqrt(np.log1p(0.25**2)), ALUMINIUM.sigma_ln, 0.3)
    assert sigma == pytest.approx(0.8374910908440345, rel=1e-9)
    assert lognormal_life(1e7, sigma, survival) == pytest.approx(COMBINED_KM[survival], rel=1e-9)


@pytest.mark.parametrize("other", [0.0, 0.1, 0.7])
@pytest.mark.parametrize("survival", [0.5, 0.9, 0.9772498680518208, 0.99])
def test_on_one_slope_the_integral_over_strengths_is_the_lognormal_life(other, survival):
    """On one slope the integral over strengths is the lognormal life."""
    sigma = ALUMINIUM.sigma_ln
    found = life_of_strengths(np.log(1e7) + sigma * STRENGTHS, other, survival)
    assert found == pytest.approx(lognormal_life(1e7, combined_sigma(sigma, other), survival), rel=1e-9)


def spectrum(rng, law, cycles=4000):
    """Ranges about the knee of a law, each a class of its own."""
    x = np.sort(float(law.knees[0] if len(law.knees) else law.cutoff) * rng.lognormal(0.0, 0.5, cycles))
    n = rng.uniform(0.5, 2.0, cycles)
    return n, x, n * x ** law.slopes[0]


@pytest.mark.parametrize("curve", [of_user(), of_user((3.0, 5.0), (5e6, 1e8)), of_user((5.0,), (1e8,))])
@pytest.mark.parametrize("survival", ["mean", "mean-1sigma", "mean-2sigma", "mean-3sigma"])
def test_with_knees_every_strength_is_the_law_of_its_survival_level(curve, survival):
    """With knees every strength is the law of its survival level."""
    law, of = damage_law(curve, survival, "none", 1e7), strength_scatter(curve, survival)
    n, x, powers = spectrum(np.random.default_rng(2), law)
    at = np.array([0.0, -1.0, -2.0, -3.0])
    found = log_life_factors(n, powers, law, of.range_factor(at))
    own = (n * cycle_damage(x, law)).sum()
    for factor, level in zip(found, ("mean", "mean-1sigma", "mean-2sigma", "mean-3sigma"), strict=True):
        other = (n * cycle_damage(x, damage_law(curve, level, "none", 1e7))).sum()
        assert np.exp(factor) == pytest.approx(own / other, rel=1e-9)


def test_on_one_slope_the_histogram_gives_the_power_of_the_factor():
    """On one slope the histogram gives the power of the factor."""
    law = damage_law(catalogue()["master-aluminium"], "mean-2sigma", "none", 1e7)
    n, x = np.array([3.0, 1.0]), np.array([20.0, 50.0])
    found = log_life_factors(n, n * x ** law.slopes[0], law, np.array([0.5, 1.0, 2.0]))
    assert found == pytest.approx(law.slopes[0] * np.log([0.5, 1.0, 2.0]), rel=1e-12, abs=1e-12)


def test_lives_with_a_knee_are_those_of_many_draws():
    """Lives with a knee are those of many draws."""
    curve = of_user()
    law, of = damage_law(curve, "mean-2sigma", "none", 1e7), strength_scatter(curve, "mean-2sigma")
    n, _, powers = spectrum(np.random.default_rng(3), law)
    log_life = np.log(1e6) + log_life_factors(n, powers, law, of.range_factor(STRENGTHS))
    rng = np.random.default_rng(4)
    drawn = np.interp(rng.standard_normal(400_000), STRENGTHS, log_life) + 0.3 * rng.standard_normal(400_000)
    for survival in (0.5, 0.9, 0.99):
        assert np.log(life_of_strengths(log_life, 0.3, survival)) == pytest.approx(
            np.quantile(drawn, 1.0 - survival), abs=0.01
        )
    assert life_of_strengths(log_life, 0.0, float(ndtr(2.0))) == pytest.approx(1e6, rel=1e-9)


def test_a_curve_that_no_cycle_damages_at_some_strength_lets_these_live_for_ever():
    """A curve that no cycle damages at some strength lets these live for ever."""
    law = damage_law(of_user((5.0,), (1e8,)), "mean-2sigma", "none", 1e7)
    x = np.array([1.05 * law.cutoff])
    of = strength_scatter(of_user((5.0,), (1e8,)), "mean-2sigma")
    log_life = np.log(1e6) + log_life_factors(np.ones(1), x**5.0, law, of.range_factor(STRENGTHS))
    assert np.isinf(life_of_strengths(log_life, 0.0, 0.5))
    assert np.isinf(life_of_strengths(log_life, 0.2, 0.5))
    last = STRENGTHS[np.isfinite(log_life)][-1]
    assert life_of_strengths(log_life, 0.2, 1.0 - float(ndtr(last - 0.5))) < np.inf
    assert -2.0 < last < float(-ndtri(0.9))


def test_a_cut_off_inside_the_highest_class_leaves_the_headline_life():
    """A cut-off inside the highest class leaves the headline life."""
    curve = of_user((5.0,), (1e8,))
    law, of = damage_law(curve, "mean-2sigma", "none", 1e7), strength_scatter(curve, "mean-2sigma")
    x = law.cutoff * np.array([0.985, 0.985, 1.005])  # only the last one damages, and their mean would not
    assert np.mean(x**5.0) ** 0.2 < law.cutoff
    log_life = np.log(1e6) + log_life_factors(
        np.array([3.0]), np.array([np.sum(x**5.0)]), law, of.range_factor(STRENGTHS)
    )
    assert life_of_strengths(log_life, 0.0, float(ndtr(2.0))) == pytest.approx(1e6, rel=1e-6)
    assert life_of_strengths(log_life, 0.0, 0.99) < 1e6
    assert life_of_strengths(log_life, 0.3, 0.99) < 1e6
