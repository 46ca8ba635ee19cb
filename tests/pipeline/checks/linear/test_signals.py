"""Linear stresses of some points are counted over the mission as the stress at a toe is."""

import numpy as np
import pytest

from fatigue.case import load_case
from fatigue.life.curves import damage_law, user_curve
from fatigue.life.rule import CycleRule
from fatigue.pipeline.checks.linear.signals import Signals, counted_mission
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.run.work import ScreeningOptions, open_work
from fatigue.pipeline.solve.body import read_body
from fatigue.pipeline.solve.weld_groups import one_group
from tests.small_case import small_case

KNEE = CycleRule(damage_law(user_curve("c", (3.0, 5.0), (5e6,), 30.0, "throat", "test"), None, "none", 1e7), False)


@pytest.fixture(scope="module")
def counted(tmp_path_factory):
    """The work of a small case, its model and its result."""
    folder = tmp_path_factory.mktemp("signals")
    body = read_body(load_case(small_case().write(folder)), strict=False)
    plan, _ = mission_plan(body)
    work = open_work(one_group(body, folder), plan, ScreeningOptions(0.0), folder, threads=1)
    return work, *work.group(0)


def test_signals_of_a_toe_have_its_mission(counted):
    """Membrane and bending of a weld, counted as signals, have damage, load factor and range of the assessment."""
    work, model, result = counted
    stress, rated = model.stations.treated, model.curve_of_weld[0]
    signals = Signals(stress.membrane, stress.bending, rated.size(model.stations.thickness), rated.rule)
    found = counted_mission(signals, work.loads, work.plan, "these welds")
    for name in ("damage_per_km", "life_km", "utilisation", "load_factor", "max_range", "governing"):
        assert np.array_equal(getattr(found, name), getattr(result.mission, name)), name


def test_two_stresses_of_a_pair_do_not_touch_each_other(counted):
    """A stress has the same mission beside any other one, on a curve with a knee too, whose rows are cut."""
    work, model, _ = counted
    membrane, bending = (
        np.tile(part, (40, 1)) for part in (model.stations.treated.membrane, model.stations.treated.bending)
    )
    size = np.ones(len(membrane))
    both = counted_mission(Signals.of_pairs(membrane, bending, size, KNEE), work.loads, work.plan, "these welds")
    turned = counted_mission(Signals.of_pairs(bending, membrane, size, KNEE), work.loads, work.plan, "these welds")
    for name in ("damage_per_km", "load_factor", "max_range"):
        np.testing.assert_allclose(getattr(both, name), getattr(turned, name)[:, ::-1], rtol=1e-9)
    alone = counted_mission(Signals.of_pairs(membrane[:1], membrane[:1], size[:1], KNEE), work.loads, work.plan, "one")
    np.testing.assert_allclose(alone.damage_per_km[0, 0], both.damage_per_km[0, 0], rtol=1e-9)
