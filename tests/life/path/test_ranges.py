"""From half cycles to equivalent ranges and damage: a worked example number by number, and what must hold."""

import json
from pathlib import Path

import numpy as np
import pytest

from fatigue.life.curves import DamageLaw, catalogue
from fatigue.life.path.count import PathCycles, count_path
from fatigue.life.path.ranges import EndRanges, between_ends, combined_range, end_ranges, path_damage
from fatigue.life.rule import CycleRule, ratio_factor, size_factor

MICRO = json.loads((Path(__file__).parents[2] / "data" / "path_oracles.json").read_text(encoding="utf-8"))[
    "micro_example"
]
C, H = MICRO["inputs"]["C"], MICRO["inputs"]["h"]
LAW = DamageLaw(np.array([1.0 / H]), np.array([np.log(C) / H]), np.empty(0), 0.0)
RULE = CycleRule(LAW, uses_bending_ratio=True)
PLAIN = CycleRule(LAW, uses_bending_ratio=False)
SIZE = float(size_factor(np.array([6.0]), catalogue()["master-steel"], "actual")[0])
PASSES = {"track": 150_000.0, "load_unload": 6.0}  # at 1500 km


def counted(name: str) -> tuple[PathCycles, EndRanges]:
    """Half cycles of an event of the example, by falling range, and the ranges between their ends."""
    event = MICRO["events"][name]
    parts = [np.array(event[key]) for key in ("membrane", "bending", "tau_m", "tau_b")]
    residue = "repeat" if name == "track" else "half"
    cycles = count_path(parts[0] + parts[1], parts[2] + parts[3], 3.0, residue)
    return cycles, end_ranges(cycles, *parts, 1.0)


@pytest.mark.parametrize("name", ["track", "load_unload"])
def test_every_half_cycle_of_the_example(name):
    """Ranges between ends, bending ratios and the three equivalent ranges of every half cycle are the known ones."""
    cycles, ranges = counted(name)
    known = MICRO["events"][name]["path"]
    x = combined_range(ranges, SIZE, 3.0, RULE)
    found = {
        "range": cycles.range,
        "path_factor": cycles.factor,
        "g": cycles.moment,
        "d_sigma": ranges.normal,
        "d_tau": ranges.shear,
        "R_b": ranges.bending_ratio,
        "R_b_tau": ranges.shear_bending_ratio,
        "x": x,
        "x_length": cycles.factor * x,
        "x_mlp": (1.0 + MICRO["inputs"]["alpha"] * cycles.moment) * x,
    }
    order = np.argsort((cycles.start - known["repeat_start"]) % 6.0, kind="stable")
    for key, values in found.items():
        expected = [one[key] for one in known["half_cycles"] if one["range"] > 0]
        in_time = values[order] if name == "track" else values
        np.testing.assert_allclose(in_time, expected, rtol=1e-9, atol=1e-10, err_msg=key)


def test_damage_of_the_example():
    """Miner sums of both events, and of the mission, by range, length and moment are the known ones."""
    total = np.zeros(3)
    for name, passes in PASSES.items():
        cycles, ranges = counted(name)
        damage = path_damage(cycles, combined_range(ranges, SIZE, 3.0, RULE), LAW, alpha=1.0)
        known = MICRO["events"][name]["path"]
        sums = [damage.range, damage.length, damage.mlp]
        np.testing.assert_allclose(sums, [known["D_range"], known["D_length"], known["D_mlp"]], rtol=1e-9)
        total += passes * np.array(sums)
    mission = MICRO["mission"]
    np.testing.assert_allclose(total, [mission["D_range"], mission["D_length"], mission["D_mlp"]], rtol=1e-9)


def test_the_moment_has_no_default():
    """Without alpha there is no damage by the path moment."""
    cycles, ranges = counted("track")
    assert np.isnan(path_damage(cycles, combined_range(ranges, SIZE, 3.0, RULE), LAW).mlp)


def test_bottom_face_takes_the_bending_parts_away():
    """At the bottom face bending and twist are subtracted, from the normal and from the shear stress."""
    rise, rest = np.array([0.0, 1.0]), np.zeros(2)
    cycles = count_path(rise, rest, 3.0, "half")
    top = end_ranges(cycles, 10.0 * rise, 4.0 * rise, 5.0 * rise, 3.0 * rise, 1.0)
    bottom = end_ranges(cycles, 10.0 * rise, 4.0 * rise, 5.0 * rise, 3.0 * rise, -1.0)
    assert (top.normal[0], top.shear[0], bottom.normal[0], bottom.shear[0]) == (14.0, 8.0, 6.0, 2.0)
    assert (top.bending_ratio[0], top.shear_bending_ratio[0]) == pytest.approx((4.0 / 14.0, 3.0 / 8.0))


def test_shear_of_a_cycle_is_at_its_own_instants():
    """A shear that is largest between the ends of a half cycle counts with what it changes between them, with sign."""
    normal, shear = np.array([0.0, 50.0, 100.0]), np.array([-1.0, 9.0, 1.0])
    cycles = count_path(normal, shear, 3.0, "half")
    ranges = end_ranges(cycles, normal, 0.0 * normal, shear, 0.0 * shear, 1.0)
    assert (ranges.normal[0], ranges.shear[0]) == (100.0, 2.0)


def test_plain_ranges_have_no_bending_ratio():
    """On a curve in plain ranges the combined range is sqrt(ds^2 + beta dt^2) times the size; else each has its I."""
    ranges = EndRanges(np.array([3.0]), np.array([4.0]), np.array([0.3]), np.array([0.6]))
    assert combined_range(ranges, 2.0, 1.0, PLAIN)[0] == pytest.approx(10.0)
    with_ratios = 2.0 * np.hypot(3.0 / ratio_factor(0.3), 4.0 / ratio_factor(0.6))
    assert combined_range(ranges, 2.0, 1.0, RULE)[0] == pytest.approx(with_ratios)


def test_between_samples_stresses_are_linear_and_recur():
    """Ends between samples take both neighbours in part; behind the last sample of a block follows the first."""
    cycles = PathCycles(np.array([0.25]), np.array([2.5]), *(np.ones(1) for _ in range(3)))
    assert between_ends(np.array([[0.0, 4.0, 8.0]]), cycles)[0, 0] == pytest.approx((8.0 + 0.0) / 2.0 - 1.0)
