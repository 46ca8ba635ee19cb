"""Counting chunk by chunk against counting whole rows: the same cycles, wherever the chunks end."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from fatigue.errors import CaseError, NumericalError
from fatigue.life.counting.block import BlockCount, BlockStress
from fatigue.life.counting.chunks import count_chunks
from fatigue.life.counting.record import CountedRecord
from fatigue.life.counting.rows import count_histories, count_rows
from fatigue.life.curves import DamageLaw, catalogue, damage_law, user_curve
from fatigue.life.records.history import Residue
from fatigue.life.records.spool import create_spool
from fatigue.life.rule import CycleRule

Floats = NDArray[np.float64]

RESIDUES: tuple[Residue, ...] = ("half", "repeat")
LAWS = {
    "straight": damage_law(catalogue()["master-aluminium"], "mean-2sigma", "none", 1e7),
    "haibach": damage_law(catalogue()["master-steel"], "mean-2sigma", "haibach", 1e7),
    "cutoff": damage_law(catalogue()["master-steel"], "mean-2sigma", "cutoff", 1e7),
    "three slopes and a cutoff": damage_law(
        user_curve("class", (3.0, 5.0, 9.0), (5e6, 1e7, 1e8), 50.0, "structural", "test"), None, "none", 1e7
    ),
    "slope 1": damage_law(user_curve("one", (1.0,), (), 50.0, "structural", "test"), None, "none", 1e7),
}
RATIO_FREE = ("damage_same_ratio", "cycles", "power_sum", "max_range", "mean", "kurtosis")


def both_counts(
    stresses: Floats, chunk: int, residue: Residue, law: DamageLaw = LAWS["straight"], **choices: Any
) -> tuple[BlockCount, BlockCount]:
    """Count membrane and bending stresses (2, n, t) whole and in chunks; the stresses are the modal coordinates."""
    _, n, t = stresses.shape
    rule = CycleRule(law, **({"uses_bending_ratio": True} | choices))
    rng = np.random.default_rng(n)
    size, ratio = rng.uniform(1.0, 2.0, n), rng.uniform(0.0, 1.0, (n, 2))
    S_m, S_b = np.eye(n, 2 * n), np.eye(n, 2 * n, n)
    q = stresses.reshape(2 * n, t)
    return (
        count_chunks(BlockStress(S_m, S_b, size, ratio), CountedRecord(q, residue), rule, chunk),
        count_histories(*stresses, size, ratio, residue, rule),
    )


def assert_same(long: BlockCount, whole: BlockCount, names: tuple[str, ...] = BlockCount.__slots__) -> None:
    """Everything agrees to 1e-12: of a mean, of the largest mean; the kurtosis to what its sums of powers allow."""
    for name in names:
        found, expected = getattr(long, name), getattr(whole, name)
        relative = 1e-9 if name == "kurtosis" else 1e-12
        absolute = 1e-12 * np.abs(expected).max(initial=1.0) if name == "mean" else 0.0
        np.testing.assert_allclose(found, expected, rtol=relative, atol=absolute, err_msg=name)


def signals(rng: np.random.Generator, points: int, t: int) -> Iterator[Floats]:
    """Draw noise, a drifting walk, a growing and a decaying history, all without ties."""
    noise = rng.normal(size=(2, points, t))
    yield noise
    yield np.cumsum(noise, axis=2) + 40.0
    yield noise * np.linspace(0.0, 1.0, t) ** 2
    yield noise * np.linspace(1.0, 0.0, t) ** 2
    yield 1e3 + np.sin(0.3 * np.arange(t) + rng.uniform(0.0, 6.0, (2, points, 1))) + 0.2 * noise


@pytest.mark.parametrize("residue", RESIDUES)
@pytest.mark.parametrize("chunk", [1, 2, 3, 4, 5, 6, 7, 50, 8192])
def test_every_cycle_is_found_wherever_the_chunks_end(chunk: int, residue: Residue) -> None:
    """Growing, decaying, drifting and random records of 2 to 400 samples."""
    rng = np.random.default_rng(chunk)
    for t in (2, 3, 4, 9, 60, 400):
        for stresses in signals(rng, 4, t):
            assert_same(*both_counts(30.0 * stresses, chunk, residue))


@pytest.mark.parametrize("residue", RESIDUES)
@pytest.mark.parametrize(("yield_MPa", "mean_stress"), [(None, False), (90.0, False), (90.0, True)])
@pytest.mark.parametrize("uses_bending_ratio", [True, False])
@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())
def test_any_law_and_any_choice(
    law: DamageLaw, uses_bending_ratio: bool, yield_MPa: float | None, mean_stress: bool, residue: Residue
) -> None:
    """Knees, cutoffs, histograms, mean stress, with and without bending ratio."""
    choices = {"uses_bending_ratio": uses_bending_ratio, "yield_MPa": yield_MPa, "mean_stress": mean_stress}
    for stresses in signals(np.random.default_rng(1), 5, 300):
        long, whole = both_counts(30.0 * stresses, 37, residue, law, **choices)
        assert_same(long, whole)
        assert (whole.cycles > 0.0).all()


@settings(deadline=None, max_examples=300)
@given(
    st.lists(st.integers(-4, 4), min_size=1, max_size=40),
    st.lists(st.integers(1, 3), min_size=40, max_size=40),
    st.integers(1, 7),
    st.sampled_from(RESIDUES),
)
def test_ties_and_plateaus_across_the_ends_of_chunks(
    levels: list[int], held: list[int], chunk: int, residue: Residue
) -> None:
    """Whole numbers: equal extremes and ranges, held samples, constants, monotone ones; the same set of ranges.

    Bending in proportion to membrane stress has one ratio, so that it does not matter which of equal instants pair.
    """
    membrane = np.repeat(np.array(levels, dtype=np.float64), held[: len(levels)])
    stresses = np.stack([membrane, 0.25 * membrane])[:, None]
    for name in ("straight", "haibach"):
        long, whole = both_counts(20.0 * stresses, chunk, residue, LAWS[name])
        assert_same(long, whole, tuple(set(BlockCount.__slots__) - {"r_largest"}))


@settings(deadline=None, max_examples=300)
@given(st.data(), st.integers(1, 7))
def test_a_single_pass_pairs_even_equal_stresses_at_the_same_instants(data: st.DataObject, chunk: int) -> None:
    """Bending that has nothing to do with membrane stress tells the instants apart: same bytes, same order."""
    t = data.draw(st.integers(1, 40))
    draw = st.lists(st.integers(-3, 3), min_size=t, max_size=t)
    stresses = np.array([data.draw(draw), data.draw(draw)], dtype=np.float64)[:, None]
    long, whole = both_counts(stresses, chunk, "half", LAWS["haibach"], yield_MPa=2.0)
    for name in set(BlockCount.__slots__) - {"mean", "kurtosis"}:
        np.testing.assert_array_equal(getattr(long, name), getattr(whole, name), err_msg=name)
    assert_same(long, whole)


@settings(deadline=None, max_examples=200)
@given(st.integers(0, 2**32 - 1), st.integers(1, 7))
def test_a_block_that_recurs_pairs_at_the_same_instants_where_its_extremes_occur_once(seed: int, chunk: int) -> None:
    """Inner ties are paired as in whole rows."""
    rng = np.random.default_rng(seed)
    t = int(rng.integers(2, 60))
    stresses = rng.integers(-3, 4, (2, 1, t)).astype(np.float64)
    stresses[0, 0, rng.permutation(t)[:2]] = 20.0, -20.0
    assert_same(*both_counts(stresses, chunk, "repeat", LAWS["haibach"], yield_MPa=8.0))


@pytest.mark.parametrize("residue", RESIDUES)
def test_the_residue_may_be_as_long_as_the_record(residue: Residue) -> None:
    """A growing and a decaying oscillation close nothing before the end."""
    t = 3000
    swing = np.where(np.arange(t) % 2, 1.0, -1.0) * np.linspace(1.0, 200.0, t)
    stresses = np.stack([[swing, swing[::-1]], [0.3 * swing, 0.1 * swing[::-1]]])
    assert_same(*both_counts(stresses, 64, residue, LAWS["cutoff"]))


@pytest.mark.parametrize("residue", RESIDUES)
@pytest.mark.parametrize("t", [0, 1, 2, 9])
def test_what_never_changes_has_no_cycles(t: int, residue: Residue) -> None:
    """No samples, one, two, some: exactly constant rows have no kurtosis either."""
    long, whole = both_counts(np.full((2, 3, t), 0.1), 2, residue, yield_MPa=10.0)
    for name in BlockCount.__slots__:
        np.testing.assert_array_equal(getattr(long, name), getattr(whole, name), err_msg=name)


def test_more_points_than_are_counted_at_a_time(tmp_path) -> None:
    """Modal coordinates in single precision on disk, 300 points of 6 modes."""
    rng = np.random.default_rng(3)
    q = rng.normal(size=(6, 9000)).astype(np.float32)
    spool = create_spool(tmp_path / "q", q.shape, q.dtype)
    spool[:, :] = q
    S_m, S_b = rng.normal(size=(2, 300, 6))
    stress, rule = BlockStress(S_m, S_b, np.ones(300), np.zeros((300, 2))), CycleRule(LAWS["haibach"], True)
    whole = count_rows(stress, CountedRecord(q.astype(np.float64), "repeat"), rule)
    assert_same(count_chunks(stress, CountedRecord(spool, "repeat"), rule), whole)


def test_what_cannot_be_counted_is_refused() -> None:
    """A stress that is not finite, with its row, and mean stress without a yield stress."""
    stresses = np.random.default_rng(0).normal(size=(2, 3, 40))
    with pytest.raises(CaseError, match="f_M needs the yield stress"):
        both_counts(stresses, 8, "half", mean_stress=True)
    q = np.ones((1, 9))
    q[0, 7] = np.inf
    one = BlockStress(np.ones((1, 1)), np.ones((1, 1)), np.ones(1), np.zeros((1, 2)))
    with pytest.raises(NumericalError, match="row 0 of the block: the stress is NaN or infinite"):
        count_chunks(one, CountedRecord(q, "half"), CycleRule(LAWS["cutoff"], True))
