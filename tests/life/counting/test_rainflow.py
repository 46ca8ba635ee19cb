"""Rainflow counting and the damage of a block, against the `rainflow` package, a slow version and invariants."""

from collections import Counter
from collections.abc import Callable

import numpy as np
import pytest
import rainflow as oracle
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy import stats

from fatigue.errors import CaseError, NumericalError
from fatigue.life import damage
from fatigue.life.counting import rainflow
from fatigue.life.counting.rainflow import HISTOGRAM_BINS, HISTOGRAM_EDGES, BlockCount, Cycles, count_block
from fatigue.life.curves import DamageLaw, catalogue, damage_law, user_curve
from tests import naive

Signal = NDArray[np.float64]
Spectrum = dict[tuple[float, float], float]

RESIDUES = ("half", "repeat")
INTEGERS = st.lists(st.integers(-6, 6), min_size=2, max_size=50).map(lambda x: np.array(x, dtype=float))
STEEL = damage_law(catalogue()["master-steel"], "mean-2sigma", "none", 1e7)
ALUMINIUM = damage_law(catalogue()["master-aluminium"], "mean-2sigma", "none", 1e7)
HAIBACH = damage_law(catalogue()["master-steel"], "mean-2sigma", "haibach", 1e7)
CUTOFF = damage_law(catalogue()["master-steel"], "mean-2sigma", "cutoff", 1e7)
THREE_SLOPES = damage_law(
    user_curve("class", (3.0, 5.0, 9.0), (5e6, 1e7, 1e8), 50.0, "structural", "test"), None, "none", 1e7
)
LAWS = {"straight": STEEL, "haibach": HAIBACH, "cutoff": CUTOFF, "three slopes and a cutoff": THREE_SLOPES}


def spectrum(cycles: Cycles) -> Spectrum:
    """Add up the counts by range and mean."""
    totals: Spectrum = {}
    for x, mean, n in zip(cycles.range.tolist(), cycles.mean.tolist(), cycles.count.tolist(), strict=True):
        totals[x, mean] = totals.get((x, mean), 0.0) + n
    return totals


def by_range(cycles: Cycles) -> dict[float, float]:
    """Add up the counts by range."""
    return {float(x): float(cycles.count[cycles.range == x].sum()) for x in np.unique(cycles.range)}


def count_one(membrane: Signal, bending: Signal, law: DamageLaw = STEEL, **choices: object) -> BlockCount:
    """Count the two surfaces of one point of unit size factor."""
    rules = {"uses_bending_ratio": True, "residue": "repeat", "yield_MPa": None, "mean_stress": False} | choices
    return count_block(membrane[None], bending[None], np.ones(1), np.zeros((1, 2)), law, **rules)


def count_of_ranges(x: Signal, law: DamageLaw) -> Signal:
    """Count one cycle of each range 0-x-0 and return the damages."""
    membrane = np.stack([np.zeros_like(x), x], axis=1)
    choices = {"uses_bending_ratio": False, "residue": "repeat", "yield_MPa": None, "mean_stress": False}
    count = count_block(membrane, 0.0 * membrane, np.ones(x.size), np.zeros((x.size, 2)), law, **choices)
    np.testing.assert_array_equal(count.damage[:, 0], count.damage[:, 1])
    return count.damage[:, 0]


def random_signal(rng: np.random.Generator, kind: int) -> Signal:
    """Draw integers with ties, held samples, a clipped walk, a growing or a decaying history, or plain noise."""
    t = int(rng.integers(2, 120))
    integers = rng.integers(-4, 5, t).astype(float)
    return [
        integers,
        np.repeat(integers, rng.integers(1, 4, t)),
        np.clip(np.cumsum(rng.integers(-2, 3, t)), -5, 5).astype(float),
        rng.normal(size=t) * np.linspace(0, 1, t),
        rng.normal(size=t) * np.linspace(1, 0, t),
        rng.normal(size=t),
    ][kind]


def random_block(seed: int, points: int = 4, samples: int = 300) -> tuple[Signal, Signal, Signal, Signal]:
    """Draw membrane and bending stress, size factors and bending ratios, some points in high mean tension."""
    rng = np.random.default_rng(seed)
    preload = rng.choice([-300.0, 0.0, 150.0, 400.0], (points, 1))
    membrane = preload + 60.0 * rng.normal(size=(points, samples))
    bending = 30.0 * rng.normal(size=(points, samples)) + 0.2 * (membrane - preload)
    return membrane, bending, rng.uniform(1.0, 2.0, points), rng.uniform(0.0, 1.0, (points, 2))


# ------------------------------------------------------------------------------------------------ one signal


@pytest.mark.parametrize("kind", range(6))
def test_half_is_what_the_rainflow_package_counts(kind: int) -> None:
    """Every cycle, in the same order, with the same two samples, in 500 random signals of each kind."""
    rng = np.random.default_rng(kind)
    for _ in range(500):
        s = random_signal(rng, kind)
        if s.size < 3 or np.ptp(s) == 0:
            continue  # where the package finds nothing, or a cycle of range 0
        c = rainflow.rainflow(s, "half")
        rows = list(zip(c.range, c.mean, c.count, c.start, c.end, strict=True))
        assert rows == list(oracle.extract_cycles(s.tolist()))


@pytest.mark.parametrize("kind", range(6))
def test_repeat_is_what_the_package_counts_from_maximum_to_maximum(kind: int) -> None:
    """Range, mean and count of the rotated and closed block, in 500 random signals of each kind."""
    rng = np.random.default_rng(100 + kind)
    for _ in range(500):
        s = random_signal(rng, kind)
        if np.ptp(s) == 0:
            continue
        path = np.append(np.roll(s, -s.argmax()), s.max())
        expected: Spectrum = {}
        for x, mean, n, _, _ in oracle.extract_cycles(path.tolist()):
            expected[x, mean] = expected.get((x, mean), 0.0) + n
        assert spectrum(rainflow.rainflow(s, "repeat")) == expected


@settings(deadline=None, max_examples=100)
@given(INTEGERS)
def test_repeat_is_what_one_more_pass_adds(s: Signal) -> None:
    """Closed cycles of three passes in series minus those of two."""
    closed = [
        Counter((abs(a[1] - b[1]), (a[1] + b[1]) / 2) for a, b in naive.four_point(naive.turning_points(passes))[0])
        for passes in (np.tile(s, 2), np.tile(s, 3))
    ]
    assert spectrum(rainflow.rainflow(s, "repeat")) == closed[1] - closed[0]


@pytest.mark.parametrize("seed", range(20))
def test_repeat_finds_the_two_samples_in_the_given_block(seed: int) -> None:
    """Pairs of samples as the slow version has them, when no two samples are equal."""
    s = np.random.default_rng(seed).normal(size=61)
    c = rainflow.rainflow(s, "repeat")
    ends = Counter(frozenset(pair) for pair in zip(c.start.tolist(), c.end.tolist(), strict=True))
    expected: Counter[frozenset[int]] = Counter()
    for i, j, n in naive.cycles(s, "repeat"):
        expected[frozenset((i, j))] += n
    assert ends == expected


def test_a_cycle_across_the_end_of_the_block_ends_before_it_starts() -> None:
    """The cycle of range 7 goes from the last peak into the first valley of the next pass."""
    c = rainflow.rainflow(np.array([-2, 1, -3, 5, -1, 3, -4, 4, -2]), "repeat")
    assert (c.range[2], c.start[2], c.end[2]) == (7, 7, 2)


@pytest.mark.parametrize("residue", RESIDUES)
@pytest.mark.parametrize("signal", [[], [3.0], [3.0, 3.0, 3.0]])
def test_a_signal_that_never_changes_has_no_cycles(signal: list[float], residue: str) -> None:
    """Nothing, one sample, a constant."""
    assert rainflow.rainflow(np.array(signal), residue).range.size == 0


@pytest.mark.parametrize(
    ("signal", "half", "repeat"),
    [
        ([0, 1], {1: 0.5}, {1: 1}),
        ([0, 1, 2, 3], {3: 0.5}, {3: 1}),
        ([0, 5, 0, 0], {5: 1}, {5: 1}),
        ([0, 5, 5, -5, -5, 0], {5: 1, 10: 0.5}, {10: 1}),
        ([0, 5, 5, 0, 0, 5], {5: 1.5}, {5: 2}),
    ],
)
def test_short_signals_and_plateaus(signal: list[int], half: dict[float, float], repeat: dict[float, float]) -> None:
    """Count of each range of signals on which other programs lose cycles."""
    assert by_range(rainflow.rainflow(np.array(signal), "half")) == half
    assert by_range(rainflow.rainflow(np.array(signal), "repeat")) == repeat


def test_a_plateau_reports_its_last_sample() -> None:
    """In a single pass, and in a block whose maximum lasts from its end into its beginning."""
    half = rainflow.rainflow(np.array([0, 5, 5, 5, -5, -5, 0]), "half")
    assert list(zip(half.start, half.end, strict=True)) == [(0, 3), (3, 5), (5, 6)]
    repeat = rainflow.rainflow(np.array([5, 5, 1, 1, 3, 3, 0, 0, 0, 5]), "repeat")
    assert list(zip(repeat.range, repeat.start, repeat.end, strict=True)) == [(2, 3, 5), (5, 1, 8)]


@pytest.mark.parametrize(
    ("signal", "ranges"),
    [
        (np.array([0, 100, -100, 100, 0], dtype=np.int8), {100: 1, 200: 1}),
        (np.array([0, 200, 10, 200, 0], dtype=np.uint8), {190: 1, 200: 1}),
        (np.array([0, 100, -100, 100, 0], dtype=np.float32), {100: 1, 200: 1}),
    ],
)
def test_narrow_number_types_do_not_overflow(signal: NDArray[np.generic], ranges: dict[float, float]) -> None:
    """Integers of 8 bits wrap round in other programs."""
    assert by_range(rainflow.rainflow(signal, "half")) == ranges


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_a_sample_that_is_not_finite_is_refused(value: float) -> None:
    """The message names the first such sample."""
    with pytest.raises(NumericalError, match="sample 2 of the signal: the stress is NaN or infinite"):
        rainflow.rainflow(np.array([0.0, 1.0, value, 1.0, value]), "half")


def test_the_signal_is_left_as_it_was() -> None:
    """Counting writes into its own buffers only."""
    s = np.array([1.0, 3.0, 3.0, -2.0, 4.0, 0.0])
    before = s.copy()
    rainflow.rainflow(s, "repeat")
    np.testing.assert_array_equal(s, before)


# ------------------------------------------------------------------------------------------------ invariants


@settings(deadline=None, max_examples=150)
@given(INTEGERS)
def test_half_counts_add_up_to_the_turning_points(s: Signal) -> None:
    """(turning points - 1) / 2: every range between neighbours is half a cycle of some size."""
    assert rainflow.rainflow(s, "half").count.sum() == max(len(naive.turning_points(s)) - 1, 0) / 2


@settings(deadline=None, max_examples=150)
@given(INTEGERS)
def test_half_is_closed_cycles_and_residue(s: Signal) -> None:
    """The three-point rule of ASTM and the four-point rule count the same."""
    assert spectrum(rainflow.rainflow(s, "half")) == naive.spectrum(naive.cycles(s, "half"), s)


@settings(deadline=None, max_examples=150)
@given(INTEGERS, st.sampled_from(RESIDUES))
def test_the_largest_cycle_is_the_whole_range(s: Signal, residue: str) -> None:
    """Whatever the residue, the extremes of the signal form a cycle."""
    assert rainflow.rainflow(s, residue).range.max(initial=0.0) == np.ptp(s)


@settings(deadline=None, max_examples=150)
@given(INTEGERS, st.integers(0, 50))
def test_a_recurring_block_may_begin_anywhere(s: Signal, shift: int) -> None:
    """Only whole cycles, the same ones after a cyclic rotation."""
    cycles = rainflow.rainflow(s, "repeat")
    assert np.all(cycles.count == 1.0)
    assert spectrum(rainflow.rainflow(np.roll(s, shift), "repeat")) == spectrum(cycles)


@settings(deadline=None, max_examples=150)
@given(INTEGERS, st.sampled_from([1, 3, 5, 8]))
def test_damage_grows_from_closed_to_half_to_repeat(s: Signal, m: int) -> None:
    """Sum of n S^m: closed cycles alone, with the residue as half cycles, of the block for ever."""
    closed, _ = naive.four_point(naive.turning_points(s))
    half, repeat = (rainflow.rainflow(s, residue) for residue in RESIDUES)
    sums = [sum(abs(a[1] - b[1]) ** m for a, b in closed), *(np.sum(c.count * c.range**m) for c in (half, repeat))]
    assert sums == sorted(sums)


@settings(deadline=None, max_examples=150)
@given(INTEGERS, st.sampled_from(RESIDUES), st.integers(1, 3), st.integers(-9, 9))
def test_counts_ignore_sign_offset_direction_and_held_samples(s: Signal, residue: str, held: int, offset: int) -> None:
    """The ranges and means move with the signal, the counts stay."""
    expected = spectrum(rainflow.rainflow(s, residue))

    def moved(change: Callable[[float], float]) -> Spectrum:
        return {(x, change(mean)): n for (x, mean), n in expected.items()}

    assert spectrum(rainflow.rainflow(-s, residue)) == moved(lambda mean: -mean)
    assert spectrum(rainflow.rainflow(s + offset, residue)) == moved(lambda mean: mean + offset)
    assert spectrum(rainflow.rainflow(s[::-1], residue)) == expected
    assert spectrum(rainflow.rainflow(np.repeat(s, held), residue)) == expected


@settings(deadline=None, max_examples=100)
@given(INTEGERS, st.sampled_from(RESIDUES))
def test_each_cycle_points_to_its_two_samples(s: Signal, residue: str) -> None:
    """Range and mean are those of the samples at start and end."""
    c = rainflow.rainflow(s, residue)
    np.testing.assert_array_equal(c.range, np.abs(s[c.start] - s[c.end]))
    np.testing.assert_array_equal(c.mean, (s[c.start] + s[c.end]) / 2)


# ------------------------------------------------------------------------------------------------ a block


@pytest.mark.parametrize("residue", RESIDUES)
@pytest.mark.parametrize(("yield_MPa", "mean_stress"), [(None, False), (250.0, False), (250.0, True)])
@pytest.mark.parametrize("uses_bending_ratio", [True, False])
@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())
def test_a_block_is_the_sum_of_its_cycles(
    law: DamageLaw, uses_bending_ratio: bool, yield_MPa: float | None, mean_stress: bool, residue: str
) -> None:
    """Every total of both surfaces equals the evaluation cycle by cycle."""
    membrane, bending, size, ratio = random_block(1)
    choices = {
        "uses_bending_ratio": uses_bending_ratio,
        "residue": residue,
        "yield_MPa": yield_MPa,
        "mean_stress": mean_stress,
    }
    count = count_block(membrane, bending, size, ratio, law, **choices)
    for row in range(len(membrane)):
        for surface, side in enumerate((1.0, -1.0)):
            expected = naive.surface_count(
                membrane[row], side * bending[row], size[row], ratio[row, surface], law, **choices
            )
            dS_power_sum = expected.pop("dS_power_sum")
            for name, value in expected.items():
                assert getattr(count, name)[row, surface] == pytest.approx(value, rel=2e-14, nan_ok=True), name
            if not law.is_straight:
                histogram = count.histogram[row, surface].sum(axis=0)
                np.testing.assert_allclose(histogram, [expected["cycles"], dS_power_sum], rtol=1e-12)


def test_the_law_and_its_factors_are_those_of_the_damage_module() -> None:
    """I(r)^(1/m), f_M and d(x) of the compiled code against the array versions, knees and cutoff included."""
    r = np.linspace(0.0, 1.0, 101)
    np.testing.assert_allclose([rainflow.ratio_factor(x) for x in r], damage.ratio_factor(r), rtol=1e-15)
    low, high = np.random.default_rng(0).uniform(-100.0, 900.0, (2, 500))
    low, high = np.minimum(low, high), np.maximum(low, high)
    factors = [rainflow.mean_stress_factor(a, b, 250.0) for a, b in zip(low, high, strict=True)]
    np.testing.assert_allclose(factors, damage.mean_stress_factor(low, high, 250.0), rtol=1e-15)
    assert min(factors) < 1.0
    for law in LAWS.values():
        x = np.concatenate([np.geomspace(1e-3, 1e4, 200), law.knees, [law.cutoff, 0.0]])
        np.testing.assert_allclose(count_of_ranges(x, law), damage.cycle_damage(x, law), rtol=1e-13)


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
    dS = S / damage.ratio_factor(np.array(r))
    assert count.cycles[0, 0] == 1.0
    assert count.max_range[0, 0] == pytest.approx(S, rel=1e-11)
    assert count.max_equivalent_range[0, 0] == pytest.approx(dS, rel=1e-11)
    cycle = rainflow.rainflow(membrane + bending, "repeat")
    assert abs(np.diff(membrane[[cycle.start[0], cycle.end[0]]])[0]) == pytest.approx(dm, rel=1e-11)


@pytest.mark.parametrize("law", [STEEL, ALUMINIUM])
def test_constant_amplitude_does_the_damage_of_its_cycles(law: DamageLaw) -> None:
    """A single mode at constant amplitude, n cycles of one range: D = n / N."""
    wave = np.tile([40.0, 0.0, -40.0, 0.0], 250)
    count = count_one(wave, 0.25 * wave, law)
    dS = 100.0 / damage.ratio_factor(np.array(0.2))
    N = np.exp(law.log_constants[0]) * dS ** -law.slopes[0]
    assert count.damage[0, 0] == pytest.approx(250 / N, rel=1e-13)
    assert (count.cycles[0, 0], count.max_range[0, 0]) == (250.0, 100.0)


@pytest.mark.parametrize(("law", "factor"), [(STEEL, 8.7537), (ALUMINIUM, 12.1978)])
@pytest.mark.parametrize("residue", RESIDUES)
def test_twice_the_load_does_2_to_the_k_times_the_damage(law: DamageLaw, factor: float, residue: str) -> None:
    """On a straight law the damage scales with load^k, whatever the signal."""
    membrane, bending, _, _ = random_block(2, points=1)
    once = count_one(membrane[0], bending[0], law, residue=residue)
    twice = count_one(2 * membrane[0], 2 * bending[0], law, residue=residue)
    np.testing.assert_allclose(twice.damage / once.damage, 2.0 ** law.slopes[0], rtol=1e-12)
    np.testing.assert_allclose(twice.damage / once.damage, factor, rtol=1e-5)


def test_the_bottom_surface_is_the_top_of_the_reversed_bending() -> None:
    """Turning the plate over swaps the two surfaces and nothing else."""
    membrane, bending, size, ratio = random_block(3)
    choices = {"uses_bending_ratio": True, "residue": "repeat", "yield_MPa": 250.0, "mean_stress": True}
    up = count_block(membrane, bending, size, ratio, HAIBACH, **choices)
    down = count_block(membrane, -bending, size, ratio[:, ::-1], HAIBACH, **choices)
    for name in BlockCount.__slots__:
        np.testing.assert_array_equal(getattr(up, name), getattr(down, name)[:, ::-1])


@pytest.mark.parametrize("residue", RESIDUES)
@pytest.mark.parametrize("cuts", [[1], [3], [1, 2, 3, 4, 5, 6], [5, 6]])
def test_rows_count_the_same_in_any_block(cuts: list[int], residue: str) -> None:
    """The bytes of every result are the same however the rows are split into blocks."""
    arrays = random_block(4, points=7, samples=501)
    choices = {"uses_bending_ratio": True, "residue": residue, "yield_MPa": 250.0, "mean_stress": False}
    whole = count_block(*arrays, HAIBACH, **choices)
    parts = [count_block(*part, HAIBACH, **choices) for part in zip(*(np.split(a, cuts) for a in arrays), strict=True)]
    for name in BlockCount.__slots__:
        joined = np.concatenate([getattr(part, name) for part in parts])
        assert joined.tobytes() == getattr(whole, name).tobytes(), name


def test_the_histogram_puts_each_range_into_its_bin() -> None:
    """Ranges at bin centres, and beyond both ends of the grid."""
    bins = np.array([0, 1, 200, 350, HISTOGRAM_BINS - 1])
    x = np.sqrt(HISTOGRAM_EDGES[bins] * HISTOGRAM_EDGES[bins + 1])
    x[[0, -1]] = 1e-5, 1e7
    membrane = np.stack([np.zeros_like(x), x], axis=1)
    choices = {"uses_bending_ratio": False, "residue": "repeat", "yield_MPa": None, "mean_stress": False}
    count = count_block(membrane, 0 * membrane, np.ones(5), np.zeros((5, 2)), HAIBACH, **choices)
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
def test_nothing_that_changes_does_no_damage(points: int, samples: int, law: DamageLaw, residue: str) -> None:
    """Blocks without rows, without samples, with one sample, and constant ones."""
    stress = np.full((points, samples), 7.0)
    choices = {"uses_bending_ratio": True, "residue": residue, "yield_MPa": 250.0, "mean_stress": True}
    count = count_block(stress, stress, np.ones(points), np.zeros((points, 2)), law, **choices)
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
    choices = {"uses_bending_ratio": True, "residue": "half", "yield_MPa": None, "mean_stress": False}
    with pytest.raises(NumericalError, match="row 2 of the block: the stress is NaN or infinite"):
        count_block(membrane, bending, size, ratio, STEEL, **choices)


def test_the_block_may_be_single_precision_read_only_or_a_view() -> None:
    """Any layout of the same numbers counts the same."""
    membrane, bending, size, ratio = (np.round(a, 2).astype(np.float32) for a in random_block(7))
    wide = [np.asfortranarray(a.astype(np.float64)) for a in (membrane, bending, size, ratio)]
    for a in wide:
        a.flags.writeable = False
    choices = {"uses_bending_ratio": True, "residue": "half", "yield_MPa": None, "mean_stress": False}
    single = count_block(membrane, bending, size, ratio, STEEL, **choices)
    np.testing.assert_array_equal(single.damage, count_block(*wide, STEEL, **choices).damage)
