"""S^k and I(r)^(-k/m) of many ranges in single precision, and their sums, against the formulas in double precision."""

import math

import numpy as np
import pytest

from fatigue.life.counting.single.kernels.power import DEPTH, LANES, add_up, power_law, raise_to_slope
from fatigue.life.rule import bending_ratio, ratio_factor


@pytest.mark.parametrize("precision", [np.float32, np.float64])
@pytest.mark.parametrize("n", [0, 1, LANES - 1, LANES * DEPTH, LANES * DEPTH + LANES + 1, 1000])
def test_sums_are_those_of_the_first_numbers(n, precision):
    """Whole lanes and what is left of them; what lies behind does not count."""
    power, damage = np.random.default_rng(n).lognormal(size=(2, 1024)).astype(precision)
    power_sum, damage_sum, largest = add_up(power, damage, n)
    assert power_sum == pytest.approx(math.fsum(power[:n].tolist()), rel=1e-14)
    assert damage_sum == pytest.approx(math.fsum(damage[:n].tolist()), rel=1e-14)
    assert largest == damage[:n].max(initial=0.0)


@pytest.mark.parametrize("uses_bending_ratio", [True, False])
@pytest.mark.parametrize("k", [3.0, 3.13, 5.0, 12.0])
def test_powers_are_those_of_the_master_equation(k, uses_bending_ratio):
    """Ranges over two powers of ten, bending with and against the membrane stress."""
    rng = np.random.default_rng(5)
    dm, db = rng.normal(size=(2, 256)) * 10 ** rng.uniform(-1, 1, 256)
    dm, db = dm * np.sign(dm + db), db * np.sign(dm + db)  # so that S is the sum
    S = (dm + db).astype(np.float32)
    membrane = dm.astype(np.float32)
    exact = S.astype(np.float64) ** k
    r = bending_ratio(membrane.astype(np.float64), S.astype(np.float64) - membrane)
    I = ratio_factor(r) if uses_bending_ratio else np.ones_like(r)  # noqa: E741 - the symbol of the standard
    raise_to_slope(S, membrane, S.size, power_law(k, uses_bending_ratio))
    np.testing.assert_allclose(S, exact, rtol=3e-6)
    np.testing.assert_allclose(membrane, exact * I**-k, rtol=3e-6)
