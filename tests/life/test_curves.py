"""S-N curves: golden values, survival levels, extensions, user curves."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.errors import CaseError
from fatigue.life.curves import SIGMAS_BELOW_MEAN, TABULATED, catalogue, damage_law, survival_level, user_curve
from fatigue.life.rule import cycle_damage


def cycles_to_failure(curve, survival, x, extension="none", knee_cycles=1e7):
    """N of one equivalent range."""
    return 1.0 / cycle_damage(np.array([x]), damage_law(curve, survival, extension, knee_cycles))[0]


@pytest.mark.parametrize(
    ("name", "x", "mean", "two", "three"),
    [
        ("master-steel", 157.57788, 3.79386e6, 1.22148e6, 6.93101e5),
        ("master-steel", 121.28206, 8.60886e6, 2.77172e6, 1.57276e6),
        ("master-steel", 109.25380, 1.19376e7, 3.84345e6, 2.18089e6),
        ("master-aluminium", 45.12506, 6.55701e6, 1.48626e6, 7.07604e5),
        ("master-aluminium", 31.10732, 2.51007e7, 5.68949e6, 2.70876e6),
    ],
)
def test_master_curve_golden_values(name, x, mean, two, three):
    """Cycles to failure of the ASME constants, worked by hand, at three survival levels."""
    curve = catalogue()[name]
    assert cycles_to_failure(curve, "mean", x) == pytest.approx(mean, rel=1e-5)
    assert cycles_to_failure(curve, "mean-2sigma", x) == pytest.approx(two, rel=1e-5)
    assert cycles_to_failure(curve, "mean-3sigma", x) == pytest.approx(three, rel=1e-5)


@pytest.mark.parametrize(("name", "step"), [("master-steel", 1.19847), ("master-aluminium", 1.22833)])
def test_survival_levels_are_equally_spaced(name, step):
    """One standard deviation is the same stress factor everywhere: a mistyped constant would break the spacing."""
    ranges = catalogue()[name].reference_range
    levels = [ranges[level] for level in ("mean", "mean-1sigma", "mean-2sigma", "mean-3sigma")]
    assert np.divide(levels[:-1], levels[1:]) == pytest.approx(step, rel=2e-5)


def test_slope_is_one_over_h_not_h():
    """Ten times the range costs 10^(1/h) in life: 3.130 for steel, 3.609 for aluminium."""
    for name, k in (("master-steel", 3.12989), ("master-aluminium", 3.60855)):
        curve = catalogue()[name]
        assert math.log10(
            cycles_to_failure(curve, "mean", 10.0) / cycles_to_failure(curve, "mean", 100.0)
        ) == pytest.approx(k, rel=1e-5)


def test_default_survival_is_two_sigma_where_there_is_scatter():
    """Left out, survival means mean-2sigma on the master curves and the table value on FAT classes."""
    assert survival_level(catalogue()["master-aluminium"], None) == "mean-2sigma"
    assert survival_level(catalogue()["iiw-aluminium-40"], None) == TABULATED


def test_survival_of_a_curve_without_scatter_is_refused():
    """A survival level that the source does not give cannot be made up."""
    with pytest.raises(
        CaseError, match=r"curve\.survival: 'mean' is asked of curve 'iiw-steel-90', which has no scatter"
    ):
        survival_level(catalogue()["iiw-steel-90"], "mean")


def test_fat_100_miner_sum_of_three_blocks():
    """FAT 100 with knee at 1e7: knee stress and a three-block Miner sum worked by hand."""
    law = damage_law(catalogue()["iiw-steel-100"], None, "none", 1e7)
    assert law.knees[0] == pytest.approx(58.4803548, rel=1e-8)
    damage = cycle_damage(np.array([100.0, 60.0, 40.0]), law)
    assert 1.0 / damage[2] == pytest.approx(66795935, rel=1e-7)
    assert damage @ [1e5, 1e6, 1e6] == pytest.approx(0.172970971, rel=1e-8)


def test_eurocode_detail_90_above_its_knee():
    """EN 1993-1-9 category 90 at 120 MPa: 843 750 cycles."""
    assert cycles_to_failure(catalogue()["en1993-hotspot-90"], None, 120.0) == pytest.approx(843750, rel=1e-12)


def test_eurocode_cutoff_ends_damage_strictly_below():
    """The cut-off of EN 1993-1-9 is 0.549 x 0.737 of the category; a cycle there still counts, below it does not."""
    law = damage_law(catalogue()["en1993-hotspot-100"], None, "none", 1e7)
    assert law.knees[0] == pytest.approx(73.7, rel=1e-3)
    assert law.cutoff == pytest.approx(40.5, rel=2e-3)
    at, below = cycle_damage(np.array([law.cutoff, np.nextafter(law.cutoff, 0.0)]), law)
    assert at == pytest.approx(1e-8, rel=1e-9)
    assert below == 0.0


def test_haibach_and_cutoff_of_the_master_curve():
    """The knee sits on the selected-survival curve at the knee cycles; below it slope 2k - 1, or nothing."""
    curve = catalogue()["master-steel"]
    k = 1.0 / 0.3195
    for survival in ("mean", "mean-2sigma"):
        knee = curve.reference_range[survival] * 1e7**-0.3195
        half = cycles_to_failure(curve, survival, knee / 2.0, "haibach")
        assert half == pytest.approx(1e7 * 2.0 ** (2.0 * k - 1.0), rel=1e-9)
        assert cycles_to_failure(curve, survival, knee * 2.0, "haibach") == pytest.approx(1e7 / 2.0**k, rel=1e-9)
        cut = damage_law(curve, survival, "cutoff", 1e7)
        assert cut.cutoff == pytest.approx(knee, rel=1e-12)
        assert cycle_damage(np.array([knee * 0.999]), cut)[0] == 0.0
        assert cycle_damage(np.array([knee * 1.001]), cut)[0] > 0.0


@settings(deadline=None, max_examples=100)
@given(
    slope=st.floats(2.0, 15.0),
    strength=st.floats(5.0, 300.0),
    knee_cycles=st.floats(1e2, 1e10),
    scatter=st.none() | st.floats(0.05, 0.4),
    survival=st.sampled_from(list(SIGMAS_BELOW_MEAN)),
)
def test_an_extension_leaves_the_finite_life_line_where_it_is(slope, strength, knee_cycles, scatter, survival):
    """On whichever side of 2e6 the knee lies: above it nothing changes, at it nothing jumps, a cut-off ends damage."""
    curve = user_curve("own", (slope,), (), strength, "structural", "test", log10_scatter=scatter)
    level = None if scatter is None else survival
    plain, haibach, cutoff = (damage_law(curve, level, e, knee_cycles) for e in ("none", "haibach", "cutoff"))
    knee = float(haibach.knees[0])
    assert cutoff.cutoff == knee
    assert 1.0 / cycle_damage(np.array([knee]), plain)[0] == pytest.approx(knee_cycles, rel=1e-9)
    above = knee * np.geomspace(1.0 + 1e-9, 100.0, 30)
    for law in (haibach, cutoff):
        np.testing.assert_allclose(cycle_damage(above, law), cycle_damage(above, plain), rtol=1e-12)
    below = knee * np.geomspace(0.01, 1.0 - 1e-9, 30)
    expected = (below / knee) ** (2.0 * slope - 1.0) / knee_cycles
    np.testing.assert_allclose(cycle_damage(below, haibach), expected, rtol=1e-9)
    assert not cycle_damage(below, cutoff).any()
    at_2e6 = curve.reference_range[survival_level(curve, level)]
    if at_2e6 > knee:
        assert 1.0 / cycle_damage(np.array([at_2e6]), haibach)[0] == pytest.approx(2e6, rel=1e-9)


def test_a_knee_before_the_reference_cycles_by_hand():
    """180 MPa at 2e6 cycles, slope 5, knee at 1e6: 180 x 2^(1/5) MPa there, and slope 9 below."""
    curve = user_curve("own", (5.0,), (), 180.0, "structural", "test")
    law = damage_law(curve, None, "haibach", 1e6)
    assert law.knees[0] == pytest.approx(180.0 * 2.0**0.2, rel=1e-12)
    assert cycles_to_failure(curve, None, 250.0, "haibach", 1e6) == pytest.approx(2e6 * (180 / 250) ** 5, rel=1e-12)
    assert cycles_to_failure(curve, None, 100.0, "haibach", 1e6) == pytest.approx(1e6 * (law.knees[0] / 100) ** 9)


def test_extension_of_a_curve_with_its_own_knee_is_refused():
    """Two knees of different origin cannot both hold."""
    with pytest.raises(CaseError, match="'haibach' is asked of curve 'iiw-steel-90', which has its own knee at 1e"):
        damage_law(catalogue()["iiw-steel-90"], None, "haibach", 1e7)


def test_user_curve_with_scatter_shifts_log_cycles():
    """log10_scatter is the standard deviation of log10 N at constant range."""
    curve = user_curve("own", (3.0,), (), 80.0, "structural", "test", log10_scatter=0.2)
    n_mean, n_two = (cycles_to_failure(curve, s, 50.0) for s in ("mean", "mean-2sigma"))
    assert math.log10(n_mean / n_two) == pytest.approx(0.4, rel=1e-9)
    assert cycles_to_failure(curve, "mean", 80.0) == pytest.approx(2e6, rel=1e-12)


def test_reference_beyond_the_first_knee_lies_on_the_second_slope():
    """A curve with its knee at 1e6 keeps its range at 2e6 cycles, on the segment that holds 2e6."""
    curve = user_curve("own", (3.0, 5.0), (1e6,), 50.0, "structural", "test")
    assert cycles_to_failure(curve, None, 50.0) == pytest.approx(2e6, rel=1e-12)
    knee = 50.0 * 2.0 ** (1 / 5)
    assert cycles_to_failure(curve, None, knee) == pytest.approx(1e6, rel=1e-9)
    assert cycles_to_failure(curve, None, 2 * knee) == pytest.approx(1e6 / 8, rel=1e-9)


@settings(deadline=None, max_examples=60)
@given(
    slopes=st.lists(st.floats(2.0, 9.0), min_size=1, max_size=4),
    start=st.floats(1e4, 1e7),
    strength=st.floats(5.0, 200.0),
    cut=st.booleans(),
)
def test_every_law_is_continuous_and_falling(slopes, start, strength, cut):
    """Damage never falls with range, and does not jump at a knee."""
    knees = tuple(start * 10.0**j for j in range(len(slopes) - (0 if cut else 1)))
    law = damage_law(user_curve("own", tuple(slopes), knees, strength, "structural", "test"), None, "none", 1e7)
    x = np.geomspace(0.1, 1e4, 400)
    damage = cycle_damage(x, law)
    assert np.all(np.diff(damage) >= 0.0)
    for knee in law.knees:
        above, below = cycle_damage(np.array([knee * (1 + 1e-9), knee * (1 - 1e-9)]), law)
        assert above == pytest.approx(below, rel=1e-6)


def test_every_catalogue_curve_names_edition_clause_and_source():
    """A number without a source does not belong in a homologation file."""
    for name, curve in catalogue().items():
        assert curve.name == name
        assert "edition" in curve.source
        assert any(word in curve.source for word in ("Annex", "Table", "clause"))
