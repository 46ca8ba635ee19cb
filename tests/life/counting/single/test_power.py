"""S^k and I(r)^(-k/m) of many ranges in single precision, and their sums, against the formulas in double precision."""

import math

import numpy as np
import pytest
from numba import njit

from fatigue.life.counting.single.kernels.power import (
    _EXP2,
    _LOG2,
    DEPTH,
    LANES,
    SUMMED,
    add_powers,
    add_up,
    polynomial,
    power_law,
    raise_to_slope,
)
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
    tolerance = 1e-7 * (2.0 + 0.8 * k)  # eps of single precision times what k log2 S is rounded by
    np.testing.assert_allclose(S, exact, rtol=tolerance)
    np.testing.assert_allclose(membrane, exact * I**-k, rtol=tolerance)


def test_series_are_as_good_as_their_numbers():
    """Every coefficient counts: in double precision both series miss their function by a rounding error of single."""
    t, x = np.linspace(math.sqrt(0.5) - 1.0, math.sqrt(2.0) - 1.0, 1000), np.linspace(-0.5, 0.5, 1000)
    np.testing.assert_allclose(np.polyval(np.array(_LOG2, dtype=float), t) * t, np.log2(1.0 + t), rtol=1e-7)
    np.testing.assert_allclose(np.polyval(np.array(_EXP2, dtype=float), x), np.exp2(x), rtol=1e-7)
    law = power_law(3.13, True)
    r = np.linspace(0.0, 1.0, 1000)
    np.testing.assert_allclose(
        np.polyval(np.array(law.ratio_power, dtype=float), r - 0.5), ratio_factor(r) ** -3.13, rtol=1e-7
    )
    assert np.float64(law.head) + np.float64(law.tail) == pytest.approx(3.13, rel=1e-10)
    assert (np.float64(law.head) * 2**8) % 1.0 == 0.0


@pytest.mark.parametrize("degree", [2, 4, 6, 10])
def test_polynomials_of_even_degree(degree):
    """Horner's rule in even and odd powers gives what Horner's rule gives."""
    rng = np.random.default_rng(degree)
    c, x = rng.normal(size=degree + 1).astype(np.float32), np.float32(0.37)
    assert polynomial(tuple(c), x) == pytest.approx(np.polyval(c.astype(float), 0.37), rel=1e-6)


def test_ranges_of_nothing_and_of_too_little():
    """A range of 0, and one whose power leaves single precision, have the smallest power there is."""
    S = np.zeros(LANES, dtype=np.float32)
    S[1:4] = 1e-30, 1e-20, 1.0
    dm = S.copy()
    raise_to_slope(S, dm, 4, power_law(5.0, True))
    assert (S[:3] < 1e-37).all()
    assert S[3] == pytest.approx(1.0, rel=1e-6)
    assert dm[3] == pytest.approx(1.0 / ratio_factor(np.zeros(())) ** 5, rel=1e-6)


@pytest.mark.parametrize("n", [0, 1, LANES + 3, SUMMED, 2 * SUMMED + 5])
def test_second_and_fourth_powers_of_both_faces(n):
    """``x = m + b - mean`` at the top, ``m - b - mean`` at the bottom, added to what is there already."""
    m, b = np.random.default_rng(n).normal(size=(2, n)).astype(np.float32)
    totals = np.rec.array([(0.25, 7.0, 8.0), (-0.5, 1.0, 2.0)], dtype=[(x, "f8") for x in ("mean", "second", "fourth")])
    top, bottom = totals[:1].copy(), totals[1:].copy()
    _add_powers(m, b, top, bottom)
    of_faces = (m + b - 0.25).astype(float), (m - b + 0.5).astype(float)
    for found, x, before in zip((top[0], bottom[0]), of_faces, totals, strict=True):
        assert found.second - before.second == pytest.approx(np.sum(x**2), rel=1e-6, abs=1e-12)
        assert found.fourth - before.fourth == pytest.approx(np.sum(x**4), rel=1e-6, abs=1e-12)


@njit
def _add_powers(m, b, top, bottom):
    """Hand records to ``add_powers`` as compiled code does."""
    add_powers(m, b, top[0], bottom[0])
