"""The search for load factors, on laws of utilisation that are known in closed form."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.curves import DamageLaw
from fatigue.life.load_factor import CLOSE, load_factor_of_counts


def law_of(*slopes: float) -> DamageLaw:
    """A law of which only the slopes matter here."""
    return DamageLaw(np.array(slopes), np.zeros(len(slopes)), np.ones(len(slopes) - 1), 0.0)


def found(utilisation, low: float, width: float, law: DamageLaw, *, jumps: bool) -> float:
    """Load factor of one face; nothing is asked of the other one."""

    def utilisation_at(rows, first, step, factors):
        assert first[0, 1] == 0.0
        f = first[:, :, None] * np.exp(step[:, :, None] * np.arange(factors))
        values = np.zeros(f.shape)
        values[0, 0] = np.vectorize(utilisation)(f[0, 0])
        return values

    both = load_factor_of_counts(utilisation_at, np.array([[low, np.nan]]), np.full((1, 2), width), law, jumps=jumps)
    assert np.isnan(both[0, 1])
    return float(both[0, 0])


@settings(deadline=None, max_examples=40)
@given(k=st.floats(2.0, 20.0), factor=st.floats(1e-3, 1e3), low=st.floats(1e-3, 1e3), width=st.floats(0.01, 5.0))
def test_one_slope_is_found_from_anywhere(k, factor, low, width):
    """f^k, whatever the first guess; with jumps allowed, on the side that meets the target."""
    assert found(lambda f: (f / factor) ** k, low, width, law_of(k), jumps=False) == pytest.approx(factor, rel=1e-9)
    safe = found(lambda f: (f / factor) ** k, low, width, law_of(k), jumps=True)
    assert factor * (1.0 - 1e-8) <= safe <= factor


@pytest.mark.parametrize("kink", [0.7, 1.0, 1.00005, 1.3])
def test_two_slopes(kink):
    """Slope 5 below a kink, 3 above: interpolated within far less than a thousandth of the utilisation."""

    def utilisation(f):
        return (f / kink) ** (3.0 if f > kink else 5.0) * kink**4

    factor = found(utilisation, 0.9, 0.3, law_of(3.0, 5.0), jumps=False)
    assert utilisation(factor) == pytest.approx(1.0, abs=2e-4)


@pytest.mark.parametrize("jump", [0.31, 1.234567, 80.0])
def test_a_jump_across_the_limit(jump):
    """Half used up before, twice after: the last factor before it, to within the last step."""
    factor = found(lambda f: 0.5 if f < jump else 2.0, 1.0, 0.1, law_of(3.0), jumps=True)
    assert jump * (1.0 - CLOSE) <= factor < jump


def test_nothing_reaches_the_limit():
    """Beyond all factors it is infinite; and 0 where every load is too much."""
    assert found(lambda f: 0.5, 1.0, 0.1, law_of(3.0), jumps=True) == np.inf
    assert found(lambda f: 2.0, 1.0, 0.1, law_of(3.0), jumps=True) == 0.0
