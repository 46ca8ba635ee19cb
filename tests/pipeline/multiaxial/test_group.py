"""What bounds settle is what the counter would find; and a point that is not settled is counted."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.bounds.path_extent import path_extent
from fatigue.life.curves import DamageLaw
from fatigue.life.rule import CycleRule
from fatigue.pipeline.multiaxial.asme import asme_bound, asme_counted
from fatigue.pipeline.multiaxial.found import MODELS, STATUSES, VERDICTS
from fatigue.pipeline.multiaxial.group import Shear, of_curve
from fatigue.pipeline.multiaxial.toes import passes_at_target
from tests.pipeline.multiaxial.random_shear import counted_toes, drawn_loads, drawn_stress

LAWS = {
    "straight": DamageLaw(np.array([3.6]), np.array([12.0]), np.empty(0), 0.0),
    "knee": DamageLaw(np.array([3.0, 5.0]), np.array([10.0, 10.0 + 2.0 * np.log(3.0)]), np.array([3.0]), 0.0),
    "cut-off": DamageLaw(np.array([3.0]), np.array([10.0]), np.empty(0), 2.0),
}


def shear_of(loads, method="report", alpha=1.0, counted_from=np.inf, is_large=False):
    """How shear is counted; by default no worst point is."""
    extents = tuple(path_extent(load.counted.q, load.residue, load.covariance) for load in loads)
    return Shear(method, 3.0, alpha, extents, counted_from, is_large)


def nowhere(toes):
    """No point is wanted whatever settles it."""
    return np.zeros(toes.toe.shape, np.bool_)


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 2**32 - 1), st.sampled_from(sorted(LAWS)), st.booleans(), st.floats(0.05, 20.0), st.booleans())
def test_settled_points_are_as_they_are_counted(seed, law, uses_bending_ratio, share, is_large):
    """Every status and every bound agrees with the sums of a count of all points; so do the flags of shear."""
    rng = np.random.default_rng(seed)
    loads, passes = drawn_loads(rng)
    stress = drawn_stress(rng, CycleRule(LAWS[law], uses_bending_ratio))
    plan, toes = counted_toes(stress, loads, passes)
    if not np.isfinite(toes.normal).all():
        return  # half of the points below a cut-off
    plan = replace(plan, damage_limit=share * plan.damage_limit)
    toes = replace(toes, normal=toes.normal / share, with_shear=toes.with_shear / share)
    found = of_curve(toes, nowhere(toes), loads, plan, shear_of(loads, is_large=is_large), "welds")
    everything = of_curve(toes, nowhere(toes), loads, plan, shear_of(loads, "mlp"), "welds")
    status = np.array(STATUSES)[found["status"]]
    assert not np.isnan(everything["range"]).any()
    assert (everything["range"] <= everything["bound"] * (1.0 + 1e-9)).all()
    assert (everything["range"] <= found["bound"] * (1.0 + 1e-9)).all()
    by_length = (everything["bound"] <= 1.0) | (found["bound"] > 1.0) | (not is_large)
    assert (everything["bound"][by_length] <= found["bound"][by_length] * (1.0 + 1e-9)).all()
    assert (toes.normal[status == "settled_fails"] > 1.0).all()
    passed = status == "settled_passes"
    assert (everything["range"][passed] <= 1.0).all()
    assert (found["asme"][passed] <= 1.0).all()
    assert (everything["range"][status == "fails"] > 1.0).all()
    counted = np.isin(status, ("fails", "counted"))
    assert np.array_equal(np.isnan(found["range"]), ~counted)
    for model in MODELS:
        np.testing.assert_allclose(found[model][counted], everything[model][counted], rtol=1e-12)
    assert (everything["length"] >= everything["range"] * (1.0 - 1e-12)).all()
    assert (everything["mlp"] >= everything["range"] * (1.0 - 1e-12)).all()
    ranges = np.zeros((2, *toes.toe.shape))
    for load in loads:
        for face, side in enumerate((1.0, -1.0)):
            for i, (mean, gradient) in enumerate(
                ((stress.membrane, stress.bending), (stress.in_plane_shear, stress.twist_shear))
            ):
                history = load.stress_factor * (mean + side * gradient) @ load.counted.q
                ranges[i, :, face] = np.maximum(ranges[i, :, face], np.ptp(history, axis=1))
    assert np.array_equal(found["shear_required"] == 1, ranges[1] > ranges[0] / 3.0)


def test_without_shear_the_path_is_that_of_the_normal_stress():
    """On a straight path the half cycles are those of rainflow: the same sum, path factors of 1, no moment."""
    rng = np.random.default_rng(5)
    loads, passes = drawn_loads(rng)
    stress = drawn_stress(rng, CycleRule(LAWS["straight"], False))
    nothing = np.zeros_like(stress.membrane)
    stress = replace(stress, in_plane_shear=nothing, twist_shear=nothing)
    plan, toes = counted_toes(stress, loads, passes)
    found = of_curve(toes, nowhere(toes), loads, plan, shear_of(loads, "mlp"), "welds")
    for name in (*MODELS, "asme"):
        np.testing.assert_allclose(found[name], toes.normal, rtol=1e-9)
    np.testing.assert_allclose(found["path_factor"], 1.0, rtol=1e-12)
    np.testing.assert_allclose(found["path_moment"], 0.0, atol=1e-9)
    assert not found["shear_required"].any()


def test_shear_alone_is_counted():
    """A point whose normal stress is at rest fails by shear, which no other number of the result tells."""
    rng = np.random.default_rng(6)
    loads, passes = drawn_loads(rng)
    stress = drawn_stress(rng, CycleRule(LAWS["straight"], True))
    stress = replace(stress, membrane=np.zeros_like(stress.membrane), bending=np.zeros_like(stress.bending))
    plan, toes = counted_toes(stress, loads, passes, limit=1e-9)
    found = of_curve(toes, nowhere(toes), loads, plan, shear_of(loads), "welds")
    assert (toes.normal == 0.0).all()
    assert (found["range"] > 1.0).all()
    assert {VERDICTS[code] for code in found["verdict"].ravel()} == {"fails"}
    assert (found["shear_required"] == 1).all()


def test_faces_without_a_toe_have_nothing():
    """No number, no code."""
    rng = np.random.default_rng(7)
    loads, passes = drawn_loads(rng)
    plan, toes = counted_toes(drawn_stress(rng, CycleRule(LAWS["straight"], True)), loads, passes)
    toes = replace(toes, toe=np.stack([toes.toe[:, 0], ~toes.toe[:, 1]], axis=1))
    found = of_curve(toes, ~nowhere(toes), loads, plan, shear_of(loads, "mlp"), "welds")
    assert not np.isnan(found["range"][:, 0]).any()
    for name in ("bound", "range", "length", "mlp", "asme", "normal", "path_factor"):
        assert np.isnan(found[name][:, 1]).all()
    for name in ("shear_required", "status", "verdict"):
        assert (found[name][:, 1] == -1).all()


def test_worst_points_are_counted_whatever_settles_them():
    """What is wanted is counted beside what is open; its status says what settled it."""
    rng = np.random.default_rng(8)
    loads, passes = drawn_loads(rng)
    plan, toes = counted_toes(drawn_stress(rng, CycleRule(LAWS["straight"], True)), loads, passes, of_largest=1e4)
    found = of_curve(toes, nowhere(toes), loads, plan, shear_of(loads), "welds")
    assert {STATUSES[code] for code in found["status"].ravel()} == {"settled_passes"}
    assert np.isnan(found["range"]).all()
    wanted = nowhere(toes)
    wanted[2, 1] = True
    again = of_curve(toes, wanted, loads, plan, shear_of(loads), "welds")
    assert np.array_equal(~np.isnan(again["range"]), wanted)
    assert np.array_equal(again["status"], found["status"])
    assert VERDICTS[again["verdict"][2, 1]] == "passes"


@pytest.mark.parametrize("law", LAWS)
def test_bound_of_the_asme_sum_holds(law):
    """No sum that is counted is above the bound of it, whatever the curve."""
    for seed in range(20):
        rng = np.random.default_rng(seed)
        loads, passes = drawn_loads(rng)
        plan, toes = counted_toes(drawn_stress(rng, CycleRule(LAWS[law], True)), loads, passes, of_largest=1.0)
        rows = np.array([0, 3, 4])
        normal, counted = asme_counted(toes, rows, loads, plan, "welds")
        np.testing.assert_allclose(normal, toes.normal[rows], rtol=1e-12)
        np.testing.assert_allclose(counted, toes.with_shear[rows], rtol=1e-12)
        assert (counted <= asme_bound(toes, rows, loads, passes_at_target(plan)) * (1.0 + 1e-9)).all()


def test_transitions_are_in_every_sum():
    """What cycles across events add stands in the bound and in the sums, and may make a point fail."""
    rng = np.random.default_rng(9)
    loads, passes = drawn_loads(rng)
    plan, toes = counted_toes(drawn_stress(rng, CycleRule(LAWS["straight"], True)), loads, passes, of_largest=1e4)
    more = replace(toes, transitions=np.full_like(toes.normal, 0.3), normal=toes.normal + 0.3)
    one, other = (of_curve(t, ~nowhere(t), loads, plan, shear_of(loads), "welds") for t in (toes, more))
    for name in ("bound", *MODELS):
        np.testing.assert_allclose(other[name], one[name] + 0.3, rtol=1e-12)


def test_mean_stress_leaves_the_bound_open_where_it_may_matter():
    """There the counter divides the ranges by f_M of their ends; far below the yield stress nothing changes."""
    rng = np.random.default_rng(10)
    loads, passes = drawn_loads(rng, residues=("repeat",))
    loads = [replace(load, offset=np.array([40.0, 0.0, 0.0])) for load in loads]
    plain = CycleRule(LAWS["straight"], True)
    stress = drawn_stress(rng, plain)
    stress = replace(stress, membrane=stress.membrane + np.array([2.0, 0.0, 0.0]))
    plan, toes = counted_toes(stress, loads, passes, of_largest=1e4)
    of_plain = of_curve(toes, ~nowhere(toes), loads, plan, shear_of(loads), "welds")
    limit = plan.damage_limit
    for yield_MPa, same in ((1e4, True), (20.0, False)):
        rule = CycleRule(LAWS["straight"], True, yield_MPa, mean_stress=True)
        plan, toes = counted_toes(replace(stress, rule=rule), loads, passes, limit=limit)
        found = of_curve(toes, ~nowhere(toes), loads, plan, shear_of(loads), "welds")
        if same:
            np.testing.assert_allclose(found["range"], of_plain["range"], rtol=1e-12)
            assert np.isfinite(found["bound"]).all()
        else:
            assert np.isinf(found["bound"]).any()
            assert (found["range"] >= of_plain["range"] * (1.0 - 1e-12)).all()
            assert (found["range"] > of_plain["range"] * 1.01).any()
            assert (found["status"][np.isinf(found["bound"])] == STATUSES.index("counted")).all()


def test_a_curve_flatter_than_one_has_no_bound():
    """d(x) / x falls there, so every point is counted."""
    rng = np.random.default_rng(11)
    loads, passes = drawn_loads(rng)
    flat = DamageLaw(np.array([0.8]), np.array([5.0]), np.empty(0), 0.0)
    plan, toes = counted_toes(drawn_stress(rng, CycleRule(flat, True)), loads, passes, of_largest=1e4)
    found = of_curve(toes, nowhere(toes), loads, plan, shear_of(loads), "welds")
    assert np.isinf(found["bound"]).all()
    assert not np.isnan(found["range"]).any()


@pytest.mark.parametrize("law", LAWS)
def test_normal_stress_that_rounding_alone_moves_passes(law):
    """Modes that cancel leave no variance and cycles of rounding: the ASME sum is a number, and the point settled."""
    rng = np.random.default_rng(12)
    loads, passes = drawn_loads(rng, modes=2)
    for load in loads:  # the second mode is a third of the first one, and three times as strong against it
        load.counted.q[1] = -3.0 * load.counted.q[0]
    loads = [replace(load, covariance=np.cov(load.counted.q, bias=True)) for load in loads]
    stress = drawn_stress(rng, CycleRule(LAWS[law], True), points=200, modes=2)
    parts = ("membrane", "bending", "in_plane_shear", "twist_shear")
    stress = replace(
        stress, **{name: np.outer(getattr(stress, name)[:, 0], np.array([1.0, 1.0 / 3.0])) for name in parts}
    )
    plan, toes = counted_toes(stress, loads, passes, limit=1.0)
    assert (toes.normal > 0.0).any() == (law != "cut-off")
    found = of_curve(toes, nowhere(toes), loads, plan, shear_of(loads), "welds")
    assert np.isfinite(found["asme"]).all()
    assert {STATUSES[code] for code in found["status"].ravel()} == {"settled_passes"}
    rows = np.arange(200)
    assert np.isfinite(asme_counted(toes, rows, loads, plan, "welds")).all()
    bound = asme_bound(toes, rows, loads, passes_at_target(plan))
    assert not np.isnan(bound).any()
