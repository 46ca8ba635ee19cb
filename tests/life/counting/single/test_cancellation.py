"""Modes that all but cancel: what single precision cannot count of them goes to double precision, at any slope."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from fatigue.assess import assess
from fatigue.life.counting.block import BlockStress
from fatigue.life.counting.count import count
from fatigue.life.counting.record import CountedRecord
from fatigue.life.counting.rows import count_histories
from fatigue.life.counting.single.prepare import single_record
from fatigue.life.curves import damage_law, user_curve
from fatigue.life.rule import CycleRule
from fatigue.results import read_table
from tests.small_case import SmallCase, small_case

Floats = NDArray[np.float64]

POINTS, SAMPLES = 3, 700
UNIT = 2.0**-53


def opposed(rng: np.random.Generator, cancels: float) -> tuple[Floats, Floats, Floats]:
    """Shapes of points under two opposite modes whose common motion is ``cancels`` times what they leave."""
    common, *own = rng.normal(size=(3, SAMPLES))
    S_m = rng.uniform(0.5, 2.0, (POINTS, 1)) * [1.0, -1.0]
    return S_m, rng.uniform(-0.9, 0.9, (POINTS, 1)) * S_m, cancels * common + np.array(own)


def damages(S_m: Floats, S_b: Floats, q: Floats, rule: CycleRule) -> tuple[Floats, Floats]:
    """Damage by the counter in single precision, and of stress that was added up in extended precision."""
    m, b = ((S.astype(np.longdouble) @ q.astype(np.longdouble)).astype(np.float64) for S in (S_m, S_b))
    stress = BlockStress(S_m, S_b, np.ones(POINTS), np.full((POINTS, 2), 0.3))
    fast = count(stress, CountedRecord(q, "repeat", single_record(q)), rule)
    return fast.damage, count_histories(m, b, stress.size, stress.same_ratio, "repeat", rule).damage


@settings(max_examples=60, deadline=None)
@given(
    decades=st.floats(0.0, 13.0),
    slope=st.floats(1.0, 12.0),
    amplitude=st.sampled_from([1e-9, 1.0, 1e9]),
    seed=st.integers(0, 2**32 - 1),
)
def test_what_cancels_is_counted_as_well_as_double_precision_can(
    decades: float, slope: float, amplitude: float, seed: int
) -> None:
    """Up to modes 1e13 times what they leave, on both sides of every limit: what rounding does to ranges."""
    S_m, S_b, q = opposed(np.random.default_rng(seed), 10.0**decades)
    law = damage_law(user_curve("class", (slope,), (), 90.0, "structural", "test"), None, "none", 1e7)
    fast, exact = damages(S_m, S_b, amplitude * q, CycleRule(law, uses_bending_ratio=True))
    # the difference of two stresses of four terms each: a share of the ranges, which are 1 to 8 times what is left
    # in double precision; in single precision a range is within 4e-7, and its power within slope times that
    np.testing.assert_allclose(fast, exact, rtol=max(1e-6, 5e-7 * slope) + 64.0 * slope * UNIT * 10.0**decades)


@pytest.mark.parametrize("slope", [3.0, 5.0, 12.0])
def test_both_ways_agree_at_their_limit(slope: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where S^k of the largest range comes near the limit, the loops in single precision are still right."""
    monkeypatch.setattr("fatigue.life.counting.single.count.SMALLEST", -90.0)
    law = damage_law(user_curve("class", (slope,), (), 90.0, "structural", "test"), None, "none", 1e7)
    S_m, S_b, q = opposed(np.random.default_rng(4), 2.0 ** (64.0 / slope))
    fast, exact = damages(S_m, S_b, q, CycleRule(law, uses_bending_ratio=True))
    np.testing.assert_allclose(fast, exact, rtol=1e-6)
    assert (fast != exact).any()


def noisy_case(first: Floats, second: Floats) -> SmallCase:
    """The small case with a second mode opposite to its first one, and these as their coordinates in its only event."""
    case = small_case()
    forces = ["fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"]
    table = case.nodal_forces
    table.loc[table["mode"] == 2, forces] = -table.loc[table["mode"] == 1, forces].to_numpy()
    noise = case.histories["noise"]
    noise["q_1"], noise["q_2"], noise["q_7"] = first, second, 0.0
    case.histories = {"noise": noise}
    case.events = [{"name": "noise", "history": "noise", "speed_km_h": 360.0, "share": 1.0}]
    return case


@pytest.mark.parametrize("cancels", [1e3, 1e6, 1e9, 1e12])
def test_opposite_modes_in_a_case(cancels: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """From files to tables, counted by default and all in double precision: the life is that of what they leave."""
    common, *own = 20.0 * np.random.default_rng(1).normal(size=(3, 2400))
    first, second = cancels * common + own[0], cancels * common + own[1]
    plain = noisy_case(own[0] - own[1], np.zeros_like(common)).write(tmp_path / "plain", "parquet")
    large = noisy_case(first, second).write(tmp_path / "large", "parquet")
    assess(plain, tmp_path / "expected", report=False)
    assess(large, tmp_path / "double", report=False, precision="double")
    monkeypatch.setattr("fatigue.pipeline.mission.precision.SINGLE_FROM", 0.0)
    assess(large, tmp_path / "auto", share=0.0, report=False)
    expected, *found = (read_table(tmp_path / name, "damage").to_pandas() for name in ("expected", "double", "auto"))
    assert (expected["damage_per_pass"] > 0.0).all()
    for table in found:
        for name in ("damage_per_pass", "max_range_MPa", "cycles_per_pass"):
            tolerance = 1e-6 + 1e3 * UNIT * cancels  # the coordinates as they are given are rounded, too
            np.testing.assert_allclose(table[name], expected[name], rtol=tolerance, err_msg=name)
