"""Lives under other assumptions, against the laws they come from."""

import numpy as np
import pandas as pd
import pytest

from fatigue.life.curves import SNCurve
from fatigue.report.result import read_result
from fatigue.report.variants import Assumptions, assumptions_of, damage_per_km, how_often, variants


@pytest.fixture(scope="module")
def worst(result_folder):
    """Worst point of a weld with its cycles, the passes of its events and the assumptions."""
    result = read_result(result_folder, 2, 100)
    return (
        result.worst("W1 bracket"),
        result.cycles("W1 bracket"),
        result.passes_per_km,
        assumptions_of(result.record, "master-aluminium"),
    )


def factors(table, assumption):
    """Damage factors of the choices of one assumption."""
    return table[table["assumption"] == assumption].set_index("choice")["damage_factor"]


def test_the_used_choices_change_nothing(worst):
    """Exactly one choice of each assumption is the one used, at factor 1."""
    table = variants(*worst)
    used = table[table["used"]]
    np.testing.assert_allclose(used["damage_factor"], 1.0)
    assert list(used["assumption"]) == ["survival", "below the knee", "thickness in dS", "bending ratio"]


def test_survival_levels_follow_the_constants_of_the_curve(worst):
    """On a straight curve damage goes with (C_used / C)^k."""
    point, cycles, passes, used = worst
    found = factors(variants(point, cycles, passes, used), "survival")
    k, C = used.curve.slopes[0], used.curve.reference_range
    for level, factor in found.items():
        assert factor == pytest.approx((C["mean-2sigma"] / C[level]) ** k, rel=1e-12)


def test_the_asme_thickness_raises_damage_by_its_power(worst):
    """10 mm taken for 16 mm: (16 / 10)^(k (m - 2) / 2m)."""
    point, cycles, passes, used = worst
    found = factors(variants(point, cycles, passes, used), "thickness in dS")
    assert found["ASME, at least 16 mm"] == pytest.approx(1.6 ** (used.curve.slopes[0] * 1.6 / 7.2), rel=1e-12)


def test_bending_ratios_bracket_the_result(worst):
    """Pure membrane damages most, pure bending least; I(r)^(1/m) goes from 1.2214 to 1.3306."""
    point, cycles, passes, used = worst
    found = factors(variants(point, cycles, passes, used), "bending ratio")
    assert found["0: pure membrane"] > 1.0 > found["1: pure bending"]
    ends = (1.23 / 1.007, (1.23 - 0.364 - 0.17) / (1.007 - 0.306 - 0.178))
    ratio = found["0: pure membrane"] / found["1: pure bending"]
    assert ratio == pytest.approx((ends[1] / ends[0]) ** used.curve.slopes[0], rel=1e-12)


def test_a_knee_spares_and_a_cutoff_spares_more(worst):
    """Small cycles count less with Haibach's slope and nothing below a cut-off."""
    point, cycles, passes, used = worst
    found = factors(variants(point, cycles, passes, used), "below the knee")
    assert found["cut-off at 1e+07 cycles"] <= found["Haibach at 1e+07 cycles"] <= found["no knee"] == 1.0


def test_weld_end_and_shear_come_from_the_point(worst):
    """The factor of the untreated end is the ratio of both lives."""
    point, cycles, passes, used = worst
    table = variants(point, cycles, passes, used)
    assert factors(table, "weld end").iloc[0] == pytest.approx(2.0)
    assert factors(table, "shear").iloc[0] == pytest.approx(1.02)
    assert factors(table, "mean stress").empty


def test_a_plain_curve_has_neither_bending_ratio_nor_thickness(worst):
    """On a curve in structural stress with its own knee these assumptions do not exist."""
    point, cycles, passes, _ = worst
    curve = SNCurve("class", "structural", (3.0, 5.0), (1e7,), 2e6, {"as tabulated": 40.0}, "user")
    used = Assumptions(curve, "as tabulated", "actual", "none", 1e7)
    table = variants(point, cycles, passes, used)
    assert set(table["assumption"]) == {"survival", "shear", "weld end"}


def test_nothing_damaged_has_no_factors(worst):
    """Without damage there is no ratio of damages."""
    point, cycles, passes, used = worst
    still = cycles.assign(equivalent_range_dS=0.0)
    table = variants(point, still, passes, used)
    assert factors(table, "survival").isna().all()


def test_damage_of_listed_cycles_is_that_of_the_table(worst):
    """Half cycles count half, events by their passes."""
    point, cycles, passes, used = worst
    found = damage_per_km(cycles["equivalent_range_dS"].to_numpy(), how_often(cycles, passes), used)
    assert found == pytest.approx(point["damage_per_km"], rel=1e-12)
    assert how_often(pd.DataFrame({"event": ["a"], "count": [0.5]}), {"a": 4.0}) == [2.0]
