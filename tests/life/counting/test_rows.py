"""The damage of a block of histories, against a slow version, closed forms and invariants."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

from fatigue.errors import CaseError, NumericalError
from fatigue.life import rule
from fatigue.life.counting.block import HISTOGRAM_BINS, HISTOGRAM_EDGES, BlockCount
from fatigue.life.counting.rainflow import rainflow
from fatigue.life.counting.rows import count_histories
from fatigue.life.curves import DamageLaw, catalogue, damage_law, user_curve
from fatigue.life.records.history import Residue
from fatigue.life.rule import CycleRule
from tests import naive

Signal = NDArray[np.float64]

RESIDUES: tuple[Residue, ...] = ("half", "repeat")
STEEL = damage_law(catalogue()["master-steel"], "mean-2sigma", "none", 1e7)
ALUMINIUM = damage_law(catalogue()["master-aluminium"], "mean-2sigma", "none", 1e7)
HAIBACH = damage_law(catalogue()["master-steel"], "mean-2sigma", "haibach", 1e7)
CUTOFF = damage_law(catalogue()["master-steel"], "mean-2sigma", "cutoff", 1e7)
THREE_SLOPES = damage_law(
    user_curve("class", (3.0, 5.0, 9.0), (5e6, 1e7, 1e8), 50.0, "structural", "test"), None, "none", 1e7
)
LAWS = {"straight": STEEL, "haibach": HAIBACH, "cutoff": CUTOFF, "three slopes and a cutoff": THREE_SLOPES}


def count_one(
    membrane: Signal, bending: Signal, law: DamageLaw = STEEL, residue: Residue = "repeat", **choices: Any
) -> BlockCount:
    """Count the two surfaces of one point of unit size factor."""
    rule = CycleRule(law, True, **choices)
    return count_histories(membrane[None], bending[None], np.ones(1), np.zeros((1, 2)), residue, rule)


def count_of_ranges(x: Signal, law: DamageLaw) -> Signal:
    """Count one cycle of each range 0-x-0 and return the damages."""
    membrane = np.stack([np.zeros_like(x), x], axis=1)
    count = count_histories(
        membrane, 0.0 * membrane, np.ones(x.size), np.zeros((x.size, 2)), "repeat", CycleRule(law, False)
    )
    np.testing.assert_array_equal(count.damage[:, 0], count.damage[:, 1])
    return count.damage[:, 0]


def random_block(seed: int, points: int = 4, samples: int = 300) -> tuple[Signal, Signal, Signal, Signal]:
    """Draw membrane and bending stress, size factors and bending ratios, some points in high mean tension."""
    rng = np.random.default_rng(seed)
    preload = rng.choice([-300.0, 0.0, 150.0, 400.0], (points, 1))
    membrane = preload + 60.0 * rng.normal(size=(points, samples))
    bending = 30.0 * rng.normal(size=(points, samples)) + 0.2 * (membrane - preload)
    return membrane, bending, rng.uniform(1.0, 2.0, points), rng.uniform(0.0, 1.0, (points, 2))


@pytest.mark.parametrize("residue", RESIDUES)
@pytest.mark.parametrize(("yield_MPa", "mean_stress"), [(None, False), (250.0, False), (250.0, True)])
@pytest.mark.parametrize("uses_bending_ratio", [True, False])
@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())
def test_a_block_is_the_sum_of_its_cycles(
    law: DamageLaw, uses_bending_ratio: bool, yield_MPa: float | None, mean_stress: bool, residue: Residue
) -> None:
    """Every total of both surfaces equals the evaluation cycle by cycle."""
    membrane, bending, size, ratio = random_block(1)
    count = count_histories(
        membrane, bending, size, ratio, residue, CycleRule(law, uses_bending_ratio, yield_MPa, mean_stress)
    )
    for row in range(len(membrane)):
        for surface, side in enumerate((1.0, -1.0)):
            expected = naive.surface_count(
                membrane[row],
                side * bending[row],
                size[row],
                ratio[row, surface],
                law,
                uses_bending_ratio=uses_bending_ratio,
                residue=residue,
                yield_MPa=yield_MPa,
                mean_stress=mean_stress,
            )
            dS_power_sum = expected.pop("dS_power_sum")
            for name, value in expected.items():
                assert getattr(count, name)[row, surface] == pytest.approx(value, rel=2e-14, nan_ok=True), name
            if not law.is_straight:
                histogram = count.histogram[row, surface].sum(axis=0)
                np.testing.assert_allclose(histogram, [expected["cycles"], dS_power_sum], rtol=1e-12)


def test_the_law_is_that_of_the_rule() -> None:
    """The damage of one cycle of each range, knees and cutoff included."""
    for law in LAWS.values():
        x = np.concatenate([np.geomspace(1e-3, 1e4, 200), law.knees, [law.cutoff, 0.0]])
        np.testing.assert_allclose(count_of_ranges(x, law), rule.cycle_damage(x, law), rtol=1e-13)


@pytest.mark.parametrize(
    ("phase", "S", "dm", "r"),
    [(0, 30.0, 20.0, 1 / 3), (90, 22.3606797750, 17.8885438200, 0.2), (180, 10.0, 20.0, 1 / 3)],
)
def test_membrane_and_bending_are_read_at_the_same_two_instants(phase: float, S: float, dm: float, r: float) -> None:
    """10 sin and 5 sin shifted by 0, 90, 180 degrees; maximum minus minimum of each part gives 30 three times."""
    shift = np.radians(phase)
    peak = np.angle(1j / (10 + 5 * np.exp(1j * shift)))  # a sample of the grid hits each extreme of the sum
    angle = peak + np.arange(400) * 2 * np.pi / 400
    membrane, bending = 10 * np.sin(angle), 5 * np.sin(angle + shift)
    count = count_one(membrane, bending)
    dS = S / rule.ratio_factor(np.array(r))
    assert count.cycles[0, 0] == 1.0
    assert count.max_range[0, 0] == pytest.approx(S, rel=1e-11)
    assert count.max_equivalent_range[0, 0] == pytest.approx(dS, rel=1e-11)
    cycle = rainflow(membrane + bending, "repeat")
    assert abs(np.diff(membrane[[cycle.start[0], cycle.end[0]]])[0]) == pytest.approx(dm, rel=1e-11)


@pytest.mark.parametrize("law", [STEEL, ALUMINIUM])
def test_constant_amplitude_does_the_damage_of_its_cycles(law: DamageLaw) -> None:
    """A single mode at constant amplitude, n cycles of one range: D = n / N."""
    wave = np.tile([40.0, 0.0, -40.0, 0.0], 250)
    count = count_one(wave, 0.25 * wave, law)
    dS = 100.0 / rule.ratio_factor(np.array(0.2))
    N = np.exp(law.log_constants[0]) * dS ** -law.slopes[0]
    assert count.damage[0, 0] == pytest.approx(250 / N, rel=1e-13)
    assert (count.cycles[0, 0], count.max_range[0, 0]) == (250.0, 100.0)


@pytest.mark.parametrize(("law", "factor"), [(STEEL, 8.7537), (ALUMINIUM, 12.1978)])
@pytest.mark.parametrize("residue", RESIDUES)
def test_twice_the_load_does_2_to_the_k_times_the_damage(law: DamageLaw, factor: float, residue: Residue) -> None:
    """On a straight law the damage scales with load^k, whatever the signal."""
    membrane, bending, _, _ = random_block(2, points=1)
    once = count_one(membrane[0], bending[0], law, residue=residue)
    twice = count_one(2 * membrane[0], 2 * bending[0], law, residue=residue)
    np.testing.assert_allclose(twice.damage / once.damage, 2.0 ** law.slopes[0], rtol=1e-12)
    np.testing.assert_allclose(twice.damage / once.damage, factor, rtol=1e-5)


def test_the_bottom_surface_is_the_top_of_the_reversed_bending() -> None:
    """Turning the plate over swaps the two surfaces and nothing else."""
    membrane, bending, size, ratio = random_block(3)
    up = count_histories(membrane, bending, size, ratio, "repeat", CycleRule(HAIBACH, True, 250.0, True))
    down = count_histories(membrane, -bending, size, ratio[:, ::-1], "repeat", CycleRule(HAIBACH, True, 250.0, True))
    for name in BlockCount.__slots__:
        np.testing.assert_array_equal(getattr(up, name), getattr(down, name)[:, ::-1])


@pytest.mark.parametrize("residue", RESIDUES)
@pytest.mark.parametrize("cuts", [[1], [3], [1, 2, 3, 4, 5, 6], [5, 6]])
def test_rows_count_the_same_in_any_block(cuts: list[int], residue: Residue) -> None:
    """The bytes of every result are the same however the rows are split into blocks."""
    arrays = random_block(4, points=7, samples=501)
    whole = count_histories(*arrays, residue, CycleRule(HAIBACH, True, 250.0))
    split = zip(*(np.split(a, cuts) for a in arrays), strict=True)
    parts = [count_histories(*part, residue, CycleRule(HAIBACH, True, 250.0)) for part in split]
    for name in BlockCount.__slots__:
        joined = np.concatenate([getattr(part, name) for part in parts])
        assert joined.tobytes() == getattr(whole, name).tobytes(), name


def test_the_histogram_puts_each_range_into_its_bin() -> None:
    """Ranges at bin centres, and beyond both ends of the grid."""
    bins = np.array([0, 1, 200, 350, HISTOGRAM_BINS - 1])
    x = np.sqrt(HISTOGRAM_EDGES[bins] * HISTOGRAM_EDGES[bins + 1])
    x[[0, -1]] = 1e-5, 1e7
    membrane = np.stack([np.zeros_like(x), x], axis=1)
    count = count_histories(membrane, 0 * membrane, np.ones(5), np.zeros((5, 2)), "repeat", CycleRule(HAIBACH, False))
    expected = np.zeros((5, HISTOGRAM_BINS, 2))
    expected[np.arange(5), bins, 0] = 1.0
    expected[np.arange(5), bins, 1] = x ** HAIBACH.slopes[0]
    np.testing.assert_allclose(count.histogram[:, 0], expected, rtol=1e-13)
    assert HISTOGRAM_EDGES[[0, 64, -1]] == pytest.approx([1e-3, 1e-2, 1e5], rel=1e-14)


def test_a_straight_law_needs_no_histogram() -> None:
    """Its power sum scales exactly."""
    wave = np.array([0.0, 1.0, 0.5])
    assert count_one(wave, wave).histogram.shape == (1, 2, 0, 2)
    assert count_one(wave, wave, CUTOFF).histogram.shape == (1, 2, HISTOGRAM_BINS, 2)


def test_a_range_at_the_cutoff_damages_and_one_below_does_not() -> None:
    """Strictly below."""
    x = np.array([CUTOFF.cutoff, np.nextafter(CUTOFF.cutoff, 0.0)])
    assert (count_of_ranges(x, CUTOFF) > 0.0).tolist() == [True, False]


def test_mean_and_kurtosis_of_the_samples() -> None:
    """Against scipy, far from zero too; a constant row has no kurtosis."""
    rng = np.random.default_rng(5)
    membrane, bending = 1e4 + rng.standard_t(6, (1, 5000)), rng.normal(size=(1, 5000))
    count = count_one(membrane[0], bending[0])
    for surface, s in enumerate((membrane[0] + bending[0], membrane[0] - bending[0])):
        assert count.mean[0, surface] == pytest.approx(s.mean(), rel=1e-14)
        assert count.kurtosis[0, surface] == pytest.approx(stats.kurtosis(s, fisher=False), rel=1e-10)
    constant = count_one(np.full(7, 0.1), np.full(7, 0.2))
    np.testing.assert_array_equal(constant.mean, [[0.1 + 0.2, 0.1 - 0.2]])
    assert np.isnan(constant.kurtosis).all()


def test_the_stress_ratio_of_the_largest_cycle() -> None:
    """min/max with its sign; not a number where the maximum is 0."""
    membrane = np.array([10.0, 40.0, 20.0, 30.0])
    bending = np.array([0.0, 0.0, 0.0, 0.0])
    np.testing.assert_array_equal(count_one(membrane, bending).r_largest, [[0.25, 0.25]])
    assert np.isnan(count_one(membrane - 40.0, bending).r_largest).all()


@pytest.mark.parametrize("residue", RESIDUES)
@pytest.mark.parametrize("law", [STEEL, HAIBACH])
@pytest.mark.parametrize(("points", "samples"), [(0, 5), (2, 0), (2, 1), (2, 5)])
def test_nothing_that_changes_does_no_damage(points: int, samples: int, law: DamageLaw, residue: Residue) -> None:
    """Blocks without rows, without samples, with one sample, and constant ones."""
    stress = np.full((points, samples), 7.0)
    count = count_histories(
        stress, stress, np.ones(points), np.zeros((points, 2)), residue, CycleRule(law, True, 250.0, True)
    )
    zero = ("damage", "damage_same_ratio", "damage_mean_stress", "cycles", "power_sum", "max_range")
    for name in (*zero, "max_equivalent_range"):
        np.testing.assert_array_equal(getattr(count, name), np.zeros((points, 2)))
    for name in ("r_largest", "kurtosis"):
        np.testing.assert_array_equal(getattr(count, name), np.full((points, 2), np.nan))
    np.testing.assert_array_equal(count.mean, np.tile([14.0, 0.0] if samples else [np.nan, np.nan], (points, 1)))


def test_the_mean_stress_damage_is_unknown_without_a_yield_stress() -> None:
    """NaN, not the uncorrected value."""
    wave = np.array([0.0, 100.0, 20.0])
    assert np.isnan(count_one(wave, 0 * wave).damage_mean_stress).all()
    with pytest.raises(CaseError, match="f_M needs the yield stress"):
        count_one(wave, 0 * wave, mean_stress=True)


def test_high_mean_tension_raises_the_damage_by_the_mean_stress_factor() -> None:
    """A cycle from 200 to 300 MPa, R = 2/3, yield stress 250 MPa: f_M = (1/3)^(1/3.6)."""
    wave = np.array([200.0, 300.0])
    count = count_one(wave, 0 * wave, yield_MPa=250.0)
    ratio = count.damage_mean_stress / count.damage
    np.testing.assert_allclose(ratio, 3.0 ** (STEEL.slopes[0] / 3.6), rtol=1e-13)
    np.testing.assert_allclose(count_one(wave, 0 * wave, yield_MPa=501.0).damage_mean_stress, count.damage, rtol=0)


def test_a_row_that_is_not_finite_is_refused() -> None:
    """The message names the row."""
    membrane, bending, size, ratio = random_block(6)
    bending[2, 17] = np.inf
    membrane[2, 17] = -np.inf
    with pytest.raises(NumericalError, match="row 2 of the block: the stress is NaN or infinite"):
        count_histories(membrane, bending, size, ratio, "half", CycleRule(STEEL, True))


def test_the_block_may_be_single_precision_read_only_or_a_view() -> None:
    """Any layout of the same numbers counts the same."""
    membrane, bending, size, ratio = (np.round(a, 2).astype(np.float32) for a in random_block(7))
    wide = [np.asfortranarray(a.astype(np.float64)) for a in (membrane, bending, size, ratio)]
    for a in wide:
        a.flags.writeable = False
    single = count_histories(membrane, bending, size, ratio, "half", CycleRule(STEEL, True))
    np.testing.assert_array_equal(single.damage, count_histories(*wide, "half", CycleRule(STEEL, True)).damage)
