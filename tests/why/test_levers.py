"""What a mode buys that is 10 % smaller, at one point under a sine: counted again in closed form."""

import numpy as np
import pytest

from fatigue.why.attribute import Attribution, Bins, attribute_event
from fatigue.why.levers import SMALLER, best_levers
from tests.why.one_point import MODES, PLAN, SLOPE, point, sine_load


def test_the_mode_that_makes_the_damage_is_the_best_lever():
    """Stress 60 - 20 of two modes: 54 - 20 is worth (40 / 34)^k, 60 - 18 costs (40 / 42)^k."""
    points, load = point(60.0, -20.0), sine_load()
    event = attribute_event(points, load, PLAN.passes[0], MODES, Bins(np.array([3.0, 8.0]), 0.5))
    found = best_levers(Attribution(points, (event,)), [load], PLAN, np.array([0]))
    life = 1.0 / event.damage[0]
    assert found.mode.tolist() == [[0, 1]]
    assert found.exponent[0] == pytest.approx([-1.5 * SLOPE, 0.5 * SLOPE], rel=1e-9)
    assert found.life_estimated[0] == pytest.approx(life * SMALLER ** found.exponent[0], rel=1e-12)
    assert found.life_counted[0] == pytest.approx([life * (40 / 34) ** SLOPE, life * (40 / 42) ** SLOPE], rel=1e-9)
