"""The mission over the events of a station: damage, life, the event that governs, and what is not available."""

from dataclasses import fields, replace

import numpy as np
import pytest

from fatigue.life.counting.block import BlockCount
from fatigue.life.curves import catalogue, damage_law
from fatigue.life.mission import Pass, Plan
from fatigue.pipeline.count.estimate import Estimate
from fatigue.pipeline.count.event_block import EventBlock
from fatigue.pipeline.count.mission_block import mission_block

LAW = damage_law(catalogue()["master-aluminium"], None, "none", 1e7)
PLAN = Plan((Pass("a", 100, 2.0, 0.5, None), Pass("b", 100, 4.0, 0.5, None)), 1e6, 1e5, 0.5)


def event(**values):
    """An event of one station, 0 unless said; values are (top, bottom), their names those of its parts as well."""
    numbers = {name: np.array([value], dtype=float) for name, value in values.items()}

    def part(kind, **others):
        names = {f.name for f in fields(kind)} - set(others)
        return kind(**{name: numbers.pop(name, np.zeros((1, 2))) for name in names}, **others)

    block = EventBlock(
        estimate=part(Estimate, moments=np.zeros((4, 1, 2))),
        count=part(BlockCount, histogram=np.zeros((1, 2, 0, 2)), mean=np.zeros((1, 2))),
        damage_shear=numbers.pop("damage_shear", np.zeros((1, 2))),
        shear_ratio=numbers.pop("shear_ratio", np.zeros((1, 2))),
        damage_raw_end=numbers.pop("damage_raw_end", np.zeros((1, 2))),
        verdict=np.zeros((1, 2), dtype=np.int8),
    )
    assert not numbers
    return block


def test_mission_of_two_events():
    """Damage per km, life with the damage limit, and the event with the larger share."""
    found = mission_block([event(damage=(2e-6, 0.0)), event(damage=(8e-6, 0.0))], PLAN, LAW)
    assert found.damage_per_km[0].tolist() == pytest.approx([0.5 * 1e-6 + 0.5 * 2e-6, 0.0])
    assert found.life_km[0].tolist() == pytest.approx([0.5 / 1.5e-6, np.inf])
    assert found.utilisation[0].tolist() == pytest.approx([3.0, 0.0])
    assert found.governing[0].tolist() == [1, -1]
    assert np.isinf(found.load_factor[0, 1])


def test_quantities_of_the_governing_event_and_of_the_largest_cycle():
    """Mean stress, ratio and shear belong to the governing event; R to the largest cycle of all events."""
    a = event(damage=(9.0, 9.0), mean=(1.0, 2.0), bending_ratio=(0.1, 0.1), max_range=(5.0, 50.0), r_largest=(0.1, 0.2))
    b = event(damage=(1.0, 1.0), mean=(3.0, 4.0), bending_ratio=(0.3, 0.3), max_range=(7.0, 7.0), r_largest=(0.5, 0.6))
    found = mission_block([a, b], PLAN, LAW)
    assert found.mean_stress[0].tolist() == [1.0, 2.0]
    assert found.bending_ratio[0].tolist() == [0.1, 0.1]
    assert found.max_range[0].tolist() == [7.0, 50.0]
    assert found.r_largest[0].tolist() == [0.5, 0.2]


def test_events_without_spectrum_stay_out_of_the_comparison():
    """Both sides of the ratio are summed over the same events; with none there is no estimate."""
    a = event(damage=(4.0, 4.0), damage_same_ratio=(4.0, 4.0), dirlik=(6.0, 6.0), tb=(5.0, 5.0))
    nothing = np.full((1, 2), np.nan)
    b = replace(a, estimate=replace(a.estimate, dirlik=nothing, tb=nothing))
    found = mission_block([a, b], PLAN, LAW)
    assert found.dirlik_ratio[0, 0] == pytest.approx(1.5)
    assert found.life_km_dirlik[0, 0] == pytest.approx(0.5 / (6.0 * 0.25))
    assert found.life_km_same_ratio[0, 0] == pytest.approx(0.5 / (4.0 * 0.25))
    none = mission_block([b, b], PLAN, LAW)
    assert np.isnan(none.life_km_dirlik).all()
    assert np.isnan(none.dirlik_ratio).all()


def test_factors_are_ratios_of_mission_sums():
    """Mean-stress and shear factors weigh the events as the mission does."""
    a = event(damage=(4.0, 4.0), damage_shear=(8.0, 4.0), damage_mean_stress=(4.0, 4.0))
    b = event(damage=(4.0, 4.0), damage_shear=(4.0, 4.0), damage_mean_stress=(12.0, 4.0))
    found = mission_block([a, b], PLAN, LAW)
    assert found.factor_if_shear[0].tolist() == pytest.approx([(8 * 0.25 + 4 * 0.125) / (4 * 0.375), 1.0])
    assert found.factor_if_mean_stress[0].tolist() == pytest.approx([(4 * 0.25 + 12 * 0.125) / (4 * 0.375), 1.0])


def test_load_factor_with_a_knee_comes_from_the_histogram():
    """On a law with a knee the stored spectrum decides, not the first slope."""
    law = damage_law(catalogue()["master-aluminium"], None, "cutoff", 1e7)
    histogram = np.zeros((1, 2, 512, 2))
    x = law.cutoff * 0.5
    bin_of = int(64 * (np.log10(x) + 3))
    histogram[..., bin_of, 0] = 1e3
    histogram[..., bin_of, 1] = 1e3 * x ** law.slopes[0]
    found = mission_block([replace(event(), count=replace(event().count, histogram=histogram))] * 2, PLAN, law)
    assert found.utilisation[0, 0] == 0.0  # all cycles lie below the cut-off
    assert found.load_factor[0, 0] == pytest.approx(2.0, rel=0.04)
