"""The bounds from the few histories of a weld: never below what is counted, and hardly above it."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from fatigue.life.bounds import weld_basis, weld_sums
from fatigue.life.bounds.screening import ModalExtent, damage_bound, modal_extent
from fatigue.life.bounds.weld_basis import WeldBases, reduced_bound, weld_bases
from fatigue.life.counting.rainflow import rainflow
from fatigue.life.counting.record import SingleRecord
from fatigue.life.counting.rows import count_histories
from fatigue.life.counting.single.prepare import single_record
from fatigue.life.records.history import Residue
from fatigue.life.records.spool import create_spool
from fatigue.life.rule import CycleRule
from tests.awkward_records import KINDS, LAWS, modal_coordinates

Floats = NDArray[np.float64]

STATIONS = (6, 1, 9, 4)


def shapes(rng: np.random.Generator, modes: int) -> tuple[Floats, Floats, NDArray[np.int64]]:
    """Draw welds of a few patterns with some scatter, of any shapes, of cancelling ones, and one without stress."""
    weld = np.repeat(np.arange(len(STATIONS)), STATIONS)
    S_m, S_b = np.zeros((2, len(weld), modes))
    for number, scatter in enumerate(10.0 ** rng.uniform(-6, 0, len(STATIONS))):
        patterns = rng.normal(size=(2, modes))
        for S in (S_m, S_b):
            n = STATIONS[number]
            S[weld == number] = rng.normal(size=(n, 2)) @ patterns + scatter * rng.normal(size=(n, modes))
    level = 30.0 * np.exp(3 * rng.normal(size=(len(weld), 1)))
    S_b[0], S_m[1], S_b[2] = S_m[0], 0.0, 0.0
    if rng.random() < 0.3:
        S_m[weld == 2] = S_b[weld == 2] = 0.0
    return level * S_m, level * S_b, weld


@pytest.mark.parametrize("residue", ["half", "repeat"])
@pytest.mark.parametrize("kind", KINDS)
def test_no_point_is_damaged_more_than_its_bound(kind: str, residue: Residue, monkeypatch: pytest.MonkeyPatch) -> None:
    """Range, sums and damage of 14 000 points in 36 x 10 records, two to a set of histories, in chunks of any size."""
    rng = np.random.default_rng(KINDS.index(kind))
    laws = list(LAWS.values())
    for draw in range(10):
        modes = int(rng.integers(1, 12))
        events = [modal_coordinates(rng, kind, modes), 1e-3 * modal_coordinates(rng, kind, modes)]
        S_m, S_b, weld = shapes(rng, modes)
        extents = [modal_extent(q, residue) for q in events]
        monkeypatch.setattr(weld_sums, "CHUNK", 32 * int(rng.integers(1, 4)))
        bases = weld_bases(S_m, S_b, weld, extents)
        rows = np.flatnonzero(rng.random(len(weld)) < 0.8)
        stress = np.stack([S_m + S_b, S_m - S_b], axis=1)[rows]
        for q, extent in zip(events, extents, strict=True):
            largest, sums = reduced_bound(bases, rows, single_record(q), extent)
            s = stress @ q
            noise = 1e-12 * np.abs(stress) @ np.abs(q).max(axis=1) * s.shape[-1]
            assert (np.ptp(s, axis=-1) <= largest + noise).all()
            for at in np.ndindex(largest.shape):
                cycles = rainflow(s[at], residue)
                for p, bound in sums.items():
                    power_sum = (cycles.count * np.maximum(cycles.range - noise[at], 0.0) ** p).sum()
                    assert power_sum <= bound[at], (p, at)
            law, size = laws[draw % len(laws)], np.ones(len(rows))
            count = count_histories(
                S_m[rows] @ q, S_b[rows] @ q, size, np.zeros(largest.shape), residue, CycleRule(law, True)
            )
            bound, _ = damage_bound(largest, sums, size[:, None], CycleRule(law, True))
            counted = count.max_range > noise
            assert (count.damage[counted] <= bound[counted]).all()


def resonances(modes: int, samples: int, seed: int) -> Floats:
    """Draw records of resonances at 2 to 18 % of the sampling rate."""
    rng = np.random.default_rng(seed)
    f = np.fft.rfftfreq(samples)
    noise = rng.normal(size=(modes, f.size)) + 1j * rng.normal(size=(modes, f.size))
    return np.fft.irfft(noise / (1 - (f / np.linspace(0.02, 0.18, modes)[:, None]) ** 2 + 0.06j), samples)


def smooth_weld(q: Floats, stations: int, seed: int) -> tuple[Floats, Floats]:
    """Draw shapes that change little from one station to the next."""
    rng = np.random.default_rng(seed)
    patterns = rng.normal(size=(4, len(q))) / q.std(axis=1)
    along = np.linspace(0.0, 1.0, stations)[:, None] ** np.arange(4)
    return along * rng.normal(size=4) @ patterns, along * rng.normal(size=4) @ patterns


@pytest.mark.parametrize("residue", ["half", "repeat"])
def test_a_smooth_weld_needs_few_histories_and_its_bounds_are_close(residue: Residue) -> None:
    """Four histories of 40 modes; variations to two hundredths, range and damage to a third."""
    q = resonances(40, 20_000, 1)
    S_m, S_b = smooth_weld(q, 10, 2)
    extent = modal_extent(q, residue)
    bases = weld_bases(S_m, S_b, np.zeros(10, int), [extent])
    assert len(bases.basis) <= 4
    rows = np.arange(10)
    largest, sums = reduced_bound(bases, rows, single_record(q), extent)
    s = np.stack([S_m + S_b, S_m - S_b], axis=1) @ q
    s -= s.mean(axis=-1, keepdims=True)
    closed = np.concatenate([s, s[..., :1]], axis=-1) if residue == "repeat" else s
    assert (largest / np.ptp(s, axis=-1)).max() < 1.34
    for p, bound in sums.items():
        exact = 2.0 ** (p - 2) * np.abs(np.diff(closed * np.abs(closed) ** (p - 1))).sum(axis=-1)
        assert bound == pytest.approx(exact, rel=0.02)
    law, ones = LAWS["straight"], np.ones(10)
    damage = count_histories(S_m @ q, S_b @ q, ones, np.zeros((10, 2)), residue, CycleRule(law, False)).damage
    bound, _ = damage_bound(largest, sums, ones[:, None], CycleRule(law, False))
    assert (bound / damage).max() < 1.33


def three_welds(samples: int) -> tuple[WeldBases, NDArray[np.intp], SingleRecord, ModalExtent]:
    """What the bounds of all stations of three welds need."""
    q = resonances(12, samples, 3)
    S_m, S_b = smooth_weld(q, 20, 4)
    extent = modal_extent(q, "repeat")
    bases = weld_bases(S_m, S_b, np.repeat([0, 1, 2], [9, 4, 7]), [extent])
    return bases, np.arange(20), single_record(q), extent


def test_chunks_leave_no_seam(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sums and extremes do not depend on where a record is cut."""
    largest, sums = reduced_bound(*three_welds(3000))
    monkeypatch.setattr(weld_sums, "CHUNK", 96)
    cut, of_cut = reduced_bound(*three_welds(3000))
    assert largest == pytest.approx(cut, rel=1e-3)
    for p, bound in sums.items():
        assert bound == pytest.approx(of_cut[p], rel=1e-3)


def test_compiled_and_interpreted_loop_find_the_same_bounds(monkeypatch: pytest.MonkeyPatch) -> None:
    """To the last bit, in several chunks and welds."""
    of_three_welds = three_welds(5000)
    compiled = reduced_bound(*of_three_welds)
    monkeypatch.setattr(weld_sums, "add_in_memory", weld_sums.add_record)
    np.testing.assert_equal(reduced_bound(*of_three_welds), compiled)


def test_every_station_has_its_own_bound() -> None:
    """Whatever other stations and welds are asked for with it."""
    q = resonances(12, 1000, 5)
    S_m, S_b = smooth_weld(q, 20, 6)
    extent, record = modal_extent(q, "half"), single_record(q)
    bases = weld_bases(S_m, S_b, np.repeat([7, 3, 5], [9, 4, 7]), [extent])
    largest, sums = reduced_bound(bases, np.arange(20), record, extent)
    for rows in (np.array([2, 10, 11, 19]), np.array([12])):
        some, some_sums = reduced_bound(bases, rows, record, extent)
        assert some == pytest.approx(largest[rows], rel=1e-5)
        for p, bound in some_sums.items():
            assert bound == pytest.approx(sums[p][rows], rel=1e-5)


def test_a_record_is_read_by_slices_of_time_only(tmp_path: Path) -> None:
    """So that it may lie on disk."""

    class OnDisk:
        def __init__(self, q: NDArray[np.floating]) -> None:
            self._q, self.shape, self.dtype = q, q.shape, q.dtype

        def __getitem__(self, part: tuple[slice, slice]) -> NDArray[np.floating]:
            modes, samples = part
            assert modes == slice(None)
            assert samples.step is None
            return self._q[part].copy()

    q = resonances(6, 9000, 7)
    S_m, S_b = smooth_weld(q, 5, 8)
    extent, record = modal_extent(q, "repeat"), single_record(q)
    on_disk = modal_extent(OnDisk(q), "repeat")
    assert on_disk.reach == extent.reach
    bases = weld_bases(S_m, S_b, np.zeros(5, int), [extent])
    expected = reduced_bound(bases, np.arange(5), record, extent)
    of_file = single_record(q, create_spool(tmp_path / "q", q.shape, np.dtype(np.float32)))
    found = reduced_bound(bases, np.arange(5), of_file, on_disk)
    np.testing.assert_equal(found, expected)


def test_the_histories_miss_what_the_tolerance_allows() -> None:
    """The rest of every stress has a small share of the largest rms of its weld."""
    q = resonances(30, 4000, 9)
    rng = np.random.default_rng(10)
    S_m, S_b = smooth_weld(q, 20, 11)
    S_m += 10.0 ** -rng.uniform(2, 6, 30) * rng.normal(size=S_m.shape)
    weld = np.repeat([0, 1], [13, 7])
    extent = modal_extent(q, "half")
    bases = weld_bases(S_m, S_b, weld, [extent])
    for number, (first, end) in enumerate(pairwise(bases.begin)):
        here = weld == number
        for S, part in ((S_m, bases.membrane_part), (S_b, bases.bending_part)):
            rest = S[here] - part[here, : end - first] @ bases.basis[first:end]
            largest = max((S_[here] @ q).std(axis=1).max() for S_ in (S_m, S_b))
            assert (rest @ q).std(axis=1).max() < 3 * weld_basis.TOLERANCE * largest


@pytest.mark.parametrize("level", [1e-5, 1e-14, 1e-40])
def test_hardly_any_stress_beside_much_of_it_is_bounded_too(level: float) -> None:
    """By a number, and by one that is not below it, far beyond what single precision tells apart."""
    q = resonances(12, 1000, 12)
    S_m, S_b = smooth_weld(q, 20, 13)
    S_m[4:9], S_b[4:9] = level * np.random.default_rng(14).normal(size=(2, 5, 12))
    extent = modal_extent(q, "half")
    bases = weld_bases(S_m, S_b, np.zeros(20, int), [extent])
    largest, sums = reduced_bound(bases, np.arange(4, 9), single_record(q), extent)
    assert all(np.isfinite(bound).all() for bound in sums.values())
    assert (np.ptp((S_m[4:9] + S_b[4:9]) @ q, axis=1) <= largest[:, 0]).all()
    for number, cycles in enumerate(rainflow(s, "half") for s in (S_m[4:9] + S_b[4:9]) @ q):
        assert all((cycles.count * cycles.range**p).sum() <= bound[number, 0] for p, bound in sums.items())
