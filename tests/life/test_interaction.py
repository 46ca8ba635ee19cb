"""The factor on all stresses at which two damage sums together meet a limit."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.curves import damage_law, user_curve
from fatigue.life.interaction import combined_factor
from fatigue.life.rule import cycle_damage

part = st.floats(0.0, 3.0)


@given(part, part)
def test_the_sum_meets_the_limit_at_the_factor(u_normal, u_shear):
    """Damage sums of one slope each scale with their powers, and add up to the limit at the factor."""
    (f,) = combined_factor(np.array([u_normal]), 3.0, np.array([u_shear]), 5.0)
    if not np.isfinite(f):
        assert max(u_normal, u_shear) < 1e-300
        return
    assert (f * u_normal) ** 3 + (f * u_shear) ** 5 == pytest.approx(1.0, rel=1e-9)


def test_without_stress_there_is_no_limit():
    """Nothing damages at any load; with one of the two the factor is that of it."""
    found = combined_factor(np.array([0.0, 0.5, 0.0]), 3.0, np.array([0.0, 0.0, 0.25]), 5.0)
    np.testing.assert_allclose(found, [np.inf, 2.0, 4.0])


def test_what_fails_without_end_has_no_factor():
    """A utilisation beyond all bounds leaves a factor of 0."""
    assert combined_factor(np.array([np.inf]), 3.0, np.array([0.1]), 5.0)[0] == 0.0


NORMAL = damage_law(user_curve("n", (3.0, 5.0), (5e6, 1e8), 36.0, "structural", "test"), None, "none", 1e7)
SHEAR = damage_law(user_curve("t", (5.0,), (1e8,), 28.0, "structural", "test"), None, "none", 1e7)


@settings(deadline=None)
@given(
    st.lists(st.floats(1.0, 80.0), min_size=1, max_size=6),
    st.lists(st.floats(1.0, 60.0), min_size=1, max_size=6),
    st.floats(1e4, 1e7),
)
def test_on_curves_with_knees_the_factor_is_never_too_large(normal, shear, n):
    """Below the factor both damage sums together stay within the limit, at every load."""

    def damage(ranges, law, f):
        return n * cycle_damage(np.outer(f, ranges), law).sum(axis=1)

    factors = np.geomspace(1e-3, 1e3, 4001)
    u = []
    for ranges, law in ((normal, NORMAL), (shear, SHEAR)):
        within = damage(ranges, law, factors) <= 1.0
        u.append(1.0 / factors[within.argmin() - 1])  # the last factor that is known to be within
    (f,) = combined_factor(np.array([u[0]]), 3.0, np.array([u[1]]), 5.0)
    below = f * (1 - 1e-9) * np.linspace(0.3, 1.0, 50)
    assert (damage(normal, NORMAL, below) + damage(shear, SHEAR, below) <= 1.0 + 1e-9).all()
