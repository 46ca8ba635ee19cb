"""Counting with the allowances of a curve: every counter against its cycles one by one; bounds, factors, shares."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from fatigue.life.attribution import credit
from fatigue.life.bounds.screening import damage_bound
from fatigue.life.counting.block import BlockCount, BlockStress
from fatigue.life.counting.chunks import count_chunks, try_chunks
from fatigue.life.counting.count import count, count_at_factors, count_histograms
from fatigue.life.counting.factors import trials
from fatigue.life.counting.rainflow import rainflow
from fatigue.life.counting.record import CountedRecord
from fatigue.life.counting.rows import count_rows
from fatigue.life.counting.single.count import is_single
from fatigue.life.counting.single.prepare import single_record
from fatigue.life.counting.vertex import vertex_history
from fatigue.life.curves import damage_law, user_curve
from fatigue.life.records.history import Residue
from fatigue.life.rule import CycleRule
from tests.naive import cycles

Floats = NDArray[np.float64]
LAWS = {
    "straight": damage_law(user_curve("own", (3.0,), (), 90.0, "structural", "test"), None, "none", 1e7),
    "knee and cut-off": damage_law(
        user_curve("own", (3.0, 5.0), (5e6, 1e8), 90.0, "structural", "test"), None, "none", 1e7
    ),
}
ALLOWED = {
    "low": {"stress_ratio": "iiw_low"},
    "medium": {"stress_ratio": "iiw_medium"},
    "bending": {"bending_factor": "bs7608"},
    "both": {"stress_ratio": "iiw_low", "bending_factor": "bs7608"},
}
COUNTERS: dict[str, Callable[[BlockStress, CountedRecord, CycleRule], BlockCount]] = {
    "rows": count_rows,
    "chunks": lambda stress, record, rule: count_chunks(stress, record, rule, 97),
    "one call": count,
}
SIZE = 1.36


def rules() -> list[tuple[str, str]]:
    """Every law with every allowance."""
    return [(law, allowed) for law in LAWS for allowed in ALLOWED]


def rule_of(law: str, allowed: str) -> CycleRule:
    """The rule of a law and its allowances."""
    return CycleRule(LAWS[law], False, **ALLOWED[allowed])


def a_block(seed: int, samples: int = 700) -> tuple[BlockStress, Floats]:
    """Four points in tension, in compression and about 0, with and without a constant beside the samples."""
    rng = np.random.default_rng(seed)
    q = np.concatenate([rng.standard_normal((2, samples)), np.ones((1, samples))])
    q[0] = np.convolve(q[0], np.ones(5) / 2.0, "same")
    S_m, S_b = rng.normal(0.0, 40.0, (4, 3)), rng.normal(0.0, 20.0, (4, 3))
    S_m[:, 2], S_b[:, 2] = [0.0, 120.0, -150.0, 60.0], 0.0
    offset = np.array([[0.0, 0.0], [30.0, -20.0], [0.0, 0.0], [-200.0, 200.0]])
    return BlockStress(S_m, S_b, np.full(4, SIZE), np.full((4, 2), 0.3), offset=offset), q


def by_hand(m: Floats, b: Floats, side: float, offset: float, residue: str, allowed: str) -> Floats:
    """Design range and count of every cycle, by the formulas of the standards as they are printed."""
    s, found = m + side * b, []
    for i, j, n in cycles(s, residue):
        S = abs(s[j] - s[i])
        low, high = min(s[i], s[j]) + offset, max(s[i], s[j]) + offset
        x = S * SIZE
        if "stress_ratio" in ALLOWED[allowed]:
            R = low / high if high > 0.0 else -np.inf
            top, at_0 = (1.6, 1.2) if ALLOWED[allowed]["stress_ratio"] == "iiw_low" else (1.3, 0.9)
            x /= top if R < -1.0 else max(1.0, at_0 - 0.4 * R)
        if "bending_factor" in ALLOWED[allowed]:
            dm, db = abs(m[j] - m[i]), abs(b[j] - b[i])
            x /= 1.0 + 0.18 * (db / (dm + db)) ** 1.4
        found.append((x, n))
    return np.array(found)


def damage_by_hand(ranges: Floats, law: str) -> float:
    """FAT 90 of slope 3, then 5 below 5e6 cycles, nothing beyond 1e8."""
    x, n = ranges.T
    N = 2e6 * (90.0 / x) ** 3
    if law == "knee and cut-off":
        knee = 90.0 * (2e6 / 5e6) ** (1 / 3)
        N = np.where(x < knee, 5e6 * (knee / x) ** 5, N)
        N = np.where(x < knee * (5e6 / 1e8) ** 0.2, np.inf, N)
    return float((n / N).sum())


@pytest.mark.parametrize("residue", ["repeat", "half"])
@pytest.mark.parametrize("counter", COUNTERS.values(), ids=COUNTERS.keys())
@pytest.mark.parametrize(("law", "allowed"), rules())
def test_every_counter_allows_for_it_cycle_by_cycle(law: str, allowed: str, counter: Callable, residue: str) -> None:
    """Damage and largest design range of both faces; the stress range itself stays what it is."""
    stress, q = a_block(1)
    found = counter(stress, CountedRecord(q, residue, single_record(q)), rule_of(law, allowed))
    plain = count_rows(stress, CountedRecord(q, residue), CycleRule(LAWS[law], False))
    np.testing.assert_allclose(found.max_range, plain.max_range, rtol=1e-12)
    np.testing.assert_allclose(found.power_sum, plain.power_sum, rtol=1e-12)
    assert (found.damage < plain.damage).any()
    assert (found.damage <= plain.damage * (1.0 + 1e-12)).all()
    for row in range(4):
        for face, side in enumerate((1.0, -1.0)):
            m, b = stress.membrane[row] @ q, stress.bending[row] @ q
            ranges = by_hand(m, b, side, stress.level[row, face], residue, allowed)
            assert found.damage[row, face] == pytest.approx(damage_by_hand(ranges, law), rel=1e-11)
            assert found.max_equivalent_range[row, face] == pytest.approx(ranges[:, 0].max(), rel=1e-12)


@pytest.mark.parametrize("allowed", ALLOWED)
def test_single_precision_leaves_them_to_double(allowed: str) -> None:
    """A record prepared for it, long enough, on a straight law: with an allowance the other counters take over."""
    _, q = a_block(2, 1500)
    record = CountedRecord(q, "repeat", single_record(q))
    assert is_single(record, CycleRule(LAWS["straight"], False))
    assert not is_single(record, rule_of("straight", allowed))


@pytest.mark.parametrize(("law", "allowed"), rules())
def test_at_vertices(law: str, allowed: str) -> None:
    """Cycles between the vertices, of which the stress ratio and the bending ratio are."""
    stress, q = a_block(3, 200)
    found = count_rows(stress, CountedRecord(q, "half", vertex=True), rule_of(law, allowed))
    m, b, _ = vertex_history(stress.membrane[1] @ q, stress.bending[1] @ q, -1.0, recurs=False)
    ranges = by_hand(m, b, -1.0, stress.level[1, 1], "half", allowed)
    assert found.damage[1, 1] == pytest.approx(damage_by_hand(ranges, law), rel=1e-10)


@pytest.mark.parametrize("residue", ["repeat", "half"])
@pytest.mark.parametrize(("law", "allowed"), rules())
def test_every_factor_is_a_count_of_the_scaled_stress(law: str, allowed: str, residue: Residue) -> None:
    """What is constant scales as well, so that no stress ratio changes."""
    stress, q = a_block(4, 200)
    record, rule = CountedRecord(q, residue), rule_of(law, allowed)
    first, step = np.full((4, 2), 0.3), np.full((4, 2), 0.11)
    found = count_at_factors(stress, record, rule, first, step, 24)
    in_chunks = trials(first, step, 24)
    try_chunks(stress, record, rule, in_chunks, chunk=37)
    np.testing.assert_allclose(in_chunks.damage, found, rtol=1e-12)
    for i in range(0, 24, 5):
        f = 0.3 * np.exp(0.11 * i)
        parts = f * stress.membrane, f * stress.bending, stress.size, stress.same_ratio
        scaled = BlockStress(*parts, offset=f * stress.level)
        np.testing.assert_allclose(found[..., i], count_rows(scaled, record, rule).damage, rtol=1e-11)


@pytest.mark.parametrize("allowed", ALLOWED)
def test_histograms_have_design_ranges(allowed: str) -> None:
    """Their sums are those of all cycles."""
    stress, q = a_block(5, 200)
    rule = rule_of("straight", allowed)
    found = count_histograms(stress, CountedRecord(q, "repeat"), rule)
    ranges = by_hand(stress.membrane[3] @ q, stress.bending[3] @ q, 1.0, stress.level[3, 0], "repeat", allowed)
    of_dS = found[3, 0, 1].sum(axis=0)
    np.testing.assert_allclose(of_dS, [ranges[:, 1].sum(), (ranges[:, 1] * ranges[:, 0] ** 3).sum()], rtol=1e-11)


@settings(max_examples=60)
@given(seed=st.integers(0, 2**32 - 1), law=st.sampled_from([*LAWS]), allowed=st.sampled_from([*ALLOWED]))
def test_bounds_hold_with_them(seed: int, law: str, allowed: str) -> None:
    """They take f(R) as 1 and pure membrane, which no cycle exceeds."""
    rng = np.random.default_rng(seed)
    m, b = rng.normal(rng.uniform(-200, 200), 40.0, (3, 60)), rng.normal(0.0, 30.0, (3, 60))
    rule, size, nothing = rule_of(law, allowed), np.ones(3), np.zeros((3, 2))
    stress = BlockStress(m, b, size, nothing)
    found = count_rows(stress, CountedRecord(np.eye(60), "half"), rule)
    for face, side in enumerate((1.0, -1.0)):
        s = m + side * b
        R, variation = np.ptp(s, axis=1), np.abs(np.diff(s, axis=1)).sum(axis=1)
        bound, largest = damage_bound(R, {1: 0.5 * variation}, size, rule)
        assert (found.damage[:, face] <= bound).all()
        assert (found.max_equivalent_range[:, face] <= largest * (1.0 + 1e-12)).all()


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("allowed", ALLOWED)
def test_the_gradient_of_the_damage(allowed: str, side: float) -> None:
    """By every sample of membrane and bending stress, against differences; the shares add up to the damage."""
    rng = np.random.default_rng(6)
    m, b, rule, offset = rng.normal(20.0, 50.0, 40), rng.normal(0.0, 30.0, 40), rule_of("straight", allowed), 25.0

    def damage(m: Floats, b: Floats) -> float:
        stress = BlockStress(m[None], b[None], np.full(1, SIZE), np.zeros((1, 2)), offset=np.full((1, 2), offset))
        found = count_rows(stress, CountedRecord(np.eye(40), "repeat"), rule)
        return float(found.damage[0, 0 if side > 0 else 1])

    of = credit(rainflow(m + side * b, "repeat"), m, b, side, SIZE, rule, offset)
    assert of.damage == pytest.approx(damage(m, b), rel=1e-12)
    assert (m + side * b) @ of.share == pytest.approx(of.damage, rel=1e-9)
    for at in range(0, 40, 3):
        for gradient, which in ((of.by_membrane, 0), (of.by_bending, 1)):
            h, moved = 1e-5, [[m.copy(), b.copy()] for _ in range(2)]
            moved[0][which][at] += h
            moved[1][which][at] -= h
            slope = (damage(*moved[0]) - damage(*moved[1])) / (2.0 * h)
            assert gradient[at] == pytest.approx(slope, rel=2e-4, abs=1e-6 * of.damage)


@settings(max_examples=30)
@given(gamma=st.floats(0.5, 2.0), seed=st.integers(0, 999))
def test_a_factor_on_the_range_is_none_on_the_damage(gamma: float, seed: int) -> None:
    """A partial factor of 1.1 is 1.1^3 in damage on a slope of 3, whatever else the curve allows for."""
    stress, q = a_block(seed, 60)
    with_gamma = BlockStress(
        stress.membrane, stress.bending, gamma * stress.size, stress.same_ratio, offset=stress.offset
    )
    record, rule = CountedRecord(q, "repeat"), rule_of("straight", "both")
    of_one = count_rows(stress, record, rule).damage
    np.testing.assert_allclose(count_rows(with_gamma, record, rule).damage, gamma**3 * of_one, rtol=1e-11)
