"""The smallest strength from which all larger ones meet the target: oracles of thickness, jumps, knees."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.decide.backsolve.by_strength import SCAN
from fatigue.decide.backsolve.root import log_steps, smallest_around, smallest_that_meets
from fatigue.life.rule import SIZE_EXPONENT, bending_ratio, ratio_factor

K = 3.6085450346420327


def of_plate(membrane, bending, side):
    """Damage of one cycle at a face, over that at the thickness as it is, against factors on the thickness."""

    def damage(x):
        m, b = membrane / x, bending / x**2
        return (np.abs(m + side * b) * x**SIZE_EXPONENT / ratio_factor(bending_ratio(m, b))) ** K

    return lambda x: damage(x) / damage(np.ones_like(x))


@pytest.mark.parametrize(
    ("exponent", "factor"),
    [
        (2.8066461380549144, 1.386069120192849),
        (6.415191172696947, 1.153535298393162),
        (K, 1.2890718813617963),
    ],
)
def test_straight(exponent, factor):
    """Oracles [B3 straight]: membrane, bending, and membrane below 16 mm under asme, at a utilisation of 2.5."""
    found = smallest_that_meets(lambda x: 2.5 * x**-exponent, SCAN, 1)
    assert found.x[0] == pytest.approx(factor, rel=1e-8)
    assert found.utilisation[0] == pytest.approx(1.0, abs=1e-6)
    assert not found.not_monotonic[0]
    assert not found.jumps[0]


def test_mixed():
    """Oracles [B3 mixed]: membrane 20, bending 10 at 4 mm and a utilisation of 3; the bottom needs more than twice."""
    of = [of_plate(np.full(1, 20.0), np.full(1, 10.0), side) for side in (1.0, -1.0)]
    top, bottom = (smallest_that_meets(lambda x, one=one: 3.0 * one(x), SCAN, 1) for one in of)
    assert 4.0 * top.x[0] == pytest.approx(5.312856552421842, rel=1e-8)
    assert np.isinf(bottom.x[0])
    further = smallest_that_meets(lambda x: 3.0 * of[1](x), log_steps(0.5, 4.0, 49), 1)
    assert 4.0 * further.x[0] == pytest.approx(11.315306932936673, rel=1e-8)


def test_not_monotonic():
    """Oracles [B3 mixed.not_monotonic]: bottom, membrane 20, bending 18 at 4 mm: 5 mm is 22 times worse."""
    of = of_plate(np.full(1, 20.0), np.full(1, 18.0), -1.0)
    t = np.array([2.5, 3, 4, 4.5, 5, 6, 8, 10])
    ratio = [761.2211441766941, 26.86713483552419, 1.0, 8.819774785418991, 22.212148876356498, 48.61492852542983]
    ratio += [69.10924252471186, 64.21385946076545]
    np.testing.assert_allclose([float(of(np.array([x]))[0]) for x in t / 4.0], ratio, rtol=1e-9)
    found = smallest_that_meets(lambda x: 0.5 * of(x), SCAN, 1)
    assert found.not_monotonic[0]
    assert np.isinf(found.x[0])  # 4 mm meet the target, 8 mm do not
    found = smallest_that_meets(lambda x: of(x) / 100.0, SCAN, 1)
    assert found.not_monotonic[0]
    assert found.x[0] < 1.0
    assert float(of(found.x)[0]) / 100.0 == pytest.approx(1.0, abs=1e-6)


def test_all_or_nothing_meets():
    """0 where every strength that is looked at does, infinite where the largest does not, several curves at once."""
    found = smallest_that_meets(lambda x: np.array([0.01, 50.0, 2.0]) / x**3, SCAN, 3)
    assert found.x.tolist()[:2] == [0.0, np.inf]
    assert found.x[2] == pytest.approx(2.0 ** (1.0 / 3.0), rel=1e-7)
    assert np.isnan(found.utilisation[:2]).all()


def test_jump():
    """At a cut-off the target may be passed without being met: the side that meets it is the answer."""
    found = smallest_that_meets(lambda x: np.where(x < 1.1, 3.0 / x, 0.5 / x), SCAN, 1)
    assert found.jumps[0]
    assert found.x[0] == pytest.approx(1.1, rel=1e-12)
    assert found.utilisation[0] < 1.0


@given(st.floats(0.3, 3.0), st.floats(1.0, 8.0), st.floats(1.0, 8.0), st.floats(0.05, 20.0))
def test_knees(knee, k1, k2, u):
    """On two slopes the root is a root, wherever the knee is."""

    def utilisation(x):
        return u * np.where(x < knee, x**-k1, knee ** (k2 - k1) * x**-k2)

    found = smallest_that_meets(utilisation, log_steps(0.125, 8.0, 33), 1)
    if 0.0 < found.x[0] < np.inf:
        assert float(utilisation(found.x)[0]) == pytest.approx(1.0, abs=1e-6)
        assert not found.jumps[0]
    else:
        assert found.x[0] == (0.0 if float(utilisation(np.array([0.125]))[0]) <= 1.0 else np.inf)


def test_far_from_the_guess():
    """The scan moves to where the answer is, either way; where nothing damages nothing is asked for."""
    wanted = np.array([1.0, 1e4, 1e-4, 30.0])
    found = smallest_around(lambda x: (wanted / x) ** 5, np.ones(4), 33)
    np.testing.assert_allclose(found.x, wanted, rtol=1e-9)
    np.testing.assert_allclose(found.utilisation, 1.0, atol=1e-9)
    assert smallest_around(np.zeros_like, np.ones(2), 33).x.tolist() == [0.0, 0.0]
    assert np.isinf(smallest_around(lambda x: np.full_like(x, 2.0), np.ones(1), 33).x[0])
