"""The worst point of every weld for every unit, against a loop over all of them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.decide.fleet import units
from fatigue.decide.fleet.units import damage_of_units, life_in_years, worst_of_welds


@given(st.integers(0, 2**32 - 1), st.sampled_from([1, 7, 4_000_000]))
def test_worst_points(seed, at_once):
    """First of equals, faces without toe left out, bounds told; however many points are looked at at a time."""
    rng = np.random.default_rng(seed)
    weld = np.repeat(np.arange(3), rng.integers(1, 5, 3))
    damage = rng.integers(0, 4, (len(weld), 2)) / 4.0
    bound, toe = rng.random(damage.shape) < 0.3, rng.random(len(weld)) < 0.8
    toe[np.searchsorted(weld, np.arange(3))] = True
    distance = rng.integers(0, 3, (4, 2)).astype(float)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(units, "AT_ONCE", at_once)
        found = worst_of_welds(damage, bound, toe, weld, distance)
    for w in range(3):
        for u in range(4):
            own = [i for i in range(len(weld)) if weld[i] == w and toe[i]]
            total = {i: float(damage[i] @ distance[u]) for i in own}
            rests = {i: bool((bound[i] & (distance[u] > 0)).any()) for i in own}
            worst = max(own, key=lambda i: (total[i], -i))
            assert found.point[w, u] == worst
            assert found.damage[w, u] == total[worst]
            assert found.is_bound[w, u] == rests[worst]
            assert found.counted[w, u] == max([total[i] for i in own if not rests[i]], default=0.0)


def test_rounding_of_what_cancels():
    """What a sequence takes away to the last digit leaves nothing, not less than nothing."""
    damage = np.array([[0.3, -0.1]])
    total = damage_of_units(damage, np.array([[0.1, 0.3 * (1.0 + 1e-15)]]))
    assert total[0, 0] == 0.0
    assert damage_of_units(damage, np.array([[0.1, 0.4]]))[0, 0] < 0.0


def test_life_without_damage():
    """Infinite where nothing damages."""
    found = life_in_years(np.array([[0.0, 0.5]]), np.array([[1.0, 0.25]]))
    assert found.tolist() == [[np.inf, 0.5]]
