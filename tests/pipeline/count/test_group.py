"""A group of welds: the results of its stations come back in their places, and as plain arrays."""

from dataclasses import fields

import numpy as np
import pytest

from fatigue.case import load_case
from fatigue.pipeline.count.result import GroupResult, arrays_of
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.run.work import ScreeningOptions, open_work
from fatigue.pipeline.solve.body import read_body
from fatigue.pipeline.solve.weld_groups import one_group
from tests.small_case import small_case

CURVES = "master-aluminium", "master-steel"


def result_with(curves, folder):
    """Model and result of four welds with these curves, every point counted."""
    case = small_case(pairs=2)
    case.welds = case.welds.assign(curve=curves)
    body = read_body(load_case(case.write(folder)), strict=False)
    plan, _ = mission_plan(body)
    work = open_work(one_group(body, folder), plan, ScreeningOptions(0.0), folder, threads=1)
    return work.group(0)


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Welds of two curves by turns, and the same with either curve on all of them."""
    turns = [CURVES[i % 2] for i in range(4)]
    every = [[curve] * 4 for curve in CURVES]
    return [result_with(curves, tmp_path_factory.mktemp("group")) for curves in (turns, *every)]


def test_stations_of_several_curves_come_back_in_their_places(results):
    """Each weld has the result that it has where all welds have its curve."""
    (model, mixed), *plain = results
    for weld in range(4):
        rows = model.stations.weld == weld
        alone = plain[weld % 2][1]
        assert np.array_equal(mixed.event_columns[:, :, rows], alone.event_columns[:, :, rows], equal_nan=True)
        assert np.array_equal(mixed.of_mission[:, rows], alone.of_mission[:, rows], equal_nan=True)
        for name in ("governing", "verdict", "tier"):
            assert np.array_equal(getattr(mixed, name)[rows], getattr(alone, name)[rows])
        assert np.array_equal(mixed.verdicts[:, rows], alone.verdicts[:, rows])
    assert not np.array_equal(plain[0][1].of_mission, plain[1][1].of_mission, equal_nan=True)


def test_events_and_mission_are_the_arrays_by_name(results):
    """What belongs together in one pass, and in the mission, does so in the views."""
    _, result = results[0]
    damage, same_ratio, largest, largest_dS = (
        result.of_events(name)
        for name in ("damage_per_pass", "damage_same_ratio_per_pass", "max_range_MPa", "max_equivalent_range_dS")
    )
    assert len(damage) == 3
    assert (damage > 0.0).any(axis=(1, 2)).all()
    assert (same_ratio[damage > 0.0] > 0.0).all()
    assert (largest_dS[damage == 0.0] == 0.0).all()
    mission = result.mission
    damages = mission.damage_per_km > 0.0
    assert mission.life_km[damages] == pytest.approx(1.0 / mission.damage_per_km[damages], rel=1e-15)
    assert mission.utilisation == pytest.approx(1e6 * mission.damage_per_km, rel=1e-15)
    assert np.array_equal(mission.max_range, largest.max(axis=0))


def test_a_result_is_its_arrays(results):
    """Made again from what is stored or sent, nothing left out."""
    _, result = results[0]
    again = GroupResult(**arrays_of(result))
    for field in fields(GroupResult):
        assert getattr(again, field.name) is getattr(result, field.name)
