"""What counts as a difference from the result: relative, but for what is rounding beside its kind."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from fatigue.diagnose import diagnose
from fatigue.point.page.checked import _largest, checks_of
from tests.point.cases import result_of
from tests.small_case import small_case

STORED = pd.Series({"max_range_MPa": 50.0, "mean_stress_MPa": 1e-14, "damage_per_km": 2e-9, "life_km": 5e8})


@pytest.mark.parametrize(
    ("changed", "difference"),
    [
        ({}, 0.0),
        ({"mean_stress_MPa": -1e-14}, 4e-13),  # rounding of a mean, beside a thousandth of the range
        ({"max_range_MPa": 50.005}, 1e-4),
        ({"damage_per_km": 2.02e-9}, 0.02 / 2.02),
        ({"life_km": np.inf}, np.inf),
    ],
)
def test_relative_differences(changed, difference):
    """Of the number that differs most."""
    now = pd.Series(STORED.to_dict() | changed)
    assert _largest(now, STORED) == pytest.approx(difference, rel=1e-3)


def test_what_the_result_does_not_have_is_not_compared():
    """A life without end treatment that screening left out; an infinite life that is infinite again."""
    stored = pd.Series({"life_km_raw_end": np.nan, "life_km": np.inf})
    assert _largest(pd.Series({"life_km_raw_end": 3e7, "life_km": np.inf}), stored) == 0.0
    assert _largest(pd.Series({"life_km_raw_end": np.nan}), pd.Series({"life_km_raw_end": 1.0})) != 0.0


def differing(found):
    """What does not agree, with its difference."""
    return {check.what: check.difference for check in checks_of(found) if not check.agrees}


def test_every_comparison_finds_its_difference(tmp_path, gathered):
    """A number of the point, of an event, of the band or of the diagnosis that is another one."""
    folder = result_of(small_case(seconds=60.0).write(tmp_path / "case"), tmp_path / "result")
    diagnose(folder)
    found = gathered(folder, "A", order=3)
    assert differing(found) == {}
    load_factor = found.stored.copy()
    load_factor["load_factor"] *= 1.001
    assert differing(replace(found, stored=load_factor)) == {
        "nodes.parquet, its numbers counted again": pytest.approx(1e-3, rel=0.01)
    }
    kurtosis = found.damage_stored.copy()
    kurtosis.loc[1, "kurtosis"] += 1.0
    assert list(differing(replace(found, damage_stored=kurtosis))) == ["damage.parquet, its numbers counted again"]
    assert list(differing(replace(found, cycles=found.cycles.iloc[1:]))) == ["damage, from its cycles one by one"]
    shared = found.why.attribution.copy()
    shared.loc[shared["kind"] == "mode", "damage_per_km"] *= 2.0
    assert differing(replace(found, why=replace(found.why, attribution=shared))) == {
        "damage, shared out to modes and unit loads": pytest.approx(0.5)
    }
    known = found.diagnosis.attribution.copy()
    known.iloc[0, known.columns.get_loc("share")] += 0.01
    other = replace(found, diagnosis=replace(found.diagnosis, attribution=known))
    assert list(differing(other)) == ["shares of the damage, in the diagnosis of the result"]
    fewer = replace(found, diagnosis=replace(found.diagnosis, attribution=known.iloc[1:]))
    assert list(differing(fewer)) == ["shares of the damage, in the diagnosis of the result"]


def test_a_bound_that_is_none(results, gathered):
    """A damage above the bound that the result has in its place is no rounding."""
    found = gathered(results("plain"), "A", order=3)
    damage = found.counted["damage_per_km"]
    for bound, above in ((damage, 0.0), (0.8 * damage, 0.25), (2.0 * damage, 0.0), (0.0, 1.0)):
        stored = found.stored.copy()
        stored["damage_per_km"] = bound
        screened = replace(found, stored=stored, station=replace(found.station, screened=(True, True)))
        assert checks_of(screened)[0].difference == pytest.approx(above)
        assert checks_of(screened)[0].agrees == (above == 0.0)
