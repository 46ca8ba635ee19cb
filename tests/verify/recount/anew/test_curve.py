"""The curves of the recount against published lives and quadrature."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from fatigue.life.curves import damage_law, user_curve
from fatigue.life.rule import cycle_damage
from fatigue.verify.recount.anew.curve import curve_named


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


@settings(deadline=None, max_examples=60)
@given(
    slopes=st.lists(st.floats(2.0, 9.0), min_size=1, max_size=3),
    start=st.floats(1e3, 1e9),
    strength=st.floats(5.0, 200.0),
    scatter=st.none() | st.floats(0.05, 0.4),
    extension=st.sampled_from(["none", "haibach", "cutoff"]),
    knee_cycles=st.floats(1e3, 1e9),
)
def test_damage_is_that_of_the_assessment(slopes, start, strength, scatter, extension, knee_cycles):
    """Two ways along one curve, wherever 2e6 cycles, its knees and the knee of its extension lie."""
    knees = [start * 10.0**j for j in range(len(slopes) - 1)]
    extension = "none" if knees else extension
    own = {"slopes": slopes, "knees_cycles": knees, "range_at_2e6_MPa": strength, "applies": "structural"}
    own |= {} if scatter is None else {"log10_scatter": scatter}
    asked = {"name": "own", "extension": extension, "knee_cycles": knee_cycles}
    curve = curve_named("own", {"curve": asked, "curves": {"own": own}}, {})
    given_curve = user_curve("own", tuple(slopes), tuple(knees), strength, "structural", "test", scatter)
    law = damage_law(given_curve, None, extension, knee_cycles)
    x = np.geomspace(0.1, 3000.0, 200)
    x = x[np.abs(x / (law.cutoff or 1.0) - 1.0) > 1e-9]  # at a cut-off rounding decides
    np.testing.assert_allclose(curve.damage(x), cycle_damage(x, law), rtol=1e-9)
