"""The counter in single precision against the double precision one, the `rainflow` package and its own plain loops."""

import importlib.util
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import FunctionType
from typing import Any

import numpy as np
import pytest
import rainflow as oracle
from numba import njit
from numpy.typing import NDArray

from fatigue.errors import NumericalError
from fatigue.life.counting.block import BlockCount, BlockStress
from fatigue.life.counting.count import count
from fatigue.life.counting.record import CountedRecord
from fatigue.life.counting.rows import count_rows
from fatigue.life.counting.single import count as counter
from fatigue.life.counting.single import prepare
from fatigue.life.counting.single.kernels import loops, over_time, state
from fatigue.life.counting.single.kernels.state import SIDE
from fatigue.life.counting.single.prepare import single_record
from fatigue.life.curves import DamageLaw, catalogue, damage_law, user_curve
from fatigue.life.records.history import Residue
from fatigue.life.records.spool import create_spool
from fatigue.life.rule import CycleRule

Floats = NDArray[np.float64]

STEEL = damage_law(catalogue()["master-steel"], "mean-2sigma", "none", 1e7)
ALUMINIUM = damage_law(catalogue()["master-aluminium"], "mean-2sigma", "none", 1e7)
HAIBACH = damage_law(catalogue()["master-steel"], "mean-2sigma", "haibach", 1e7)
PLAIN_CUBE = damage_law(user_curve("class", (3.0,), (), 90.0, "structural", "test"), None, "none", 1e7)
STEEP = damage_law(user_curve("class", (15.0,), (), 90.0, "structural", "test"), None, "none", 1e7)

RESIDUES: tuple[Residue, ...] = ("half", "repeat")
vector_instructions = pytest.mark.skipif(
    importlib.util.find_spec("fatigue.life.counting.single.kernels.simd") is None, reason="without vector instructions"
)


KINDS = (
    *("ties", "held", "clipped", "growing", "decaying", "zigzag", "wrapping plateau", "constant", "spike", "tiny"),
    *("huge", "far from zero", "flat extremes", "sine", "noise"),
)


def adversarial(rng: np.random.Generator, kind: str, t: int) -> Floats:
    """Draw one history of a kind that counters fail on."""
    integers = rng.integers(-4, 5, t).astype(float)
    time = np.arange(t)
    return {
        "ties": integers,
        "held": np.repeat(integers, rng.integers(1, 4, t))[:t],
        "clipped": np.clip(np.cumsum(rng.integers(-2, 3, t)), -5, 5).astype(float),
        "growing": rng.normal(size=t) * np.linspace(0, 1, t),
        "decaying": np.cos(1.3 * time) * np.exp(-2.0 * time / t),
        "zigzag": (time + 1.0) * (-1.0) ** time,
        "wrapping plateau": np.where(time < t // 3, 5.0, np.where(time > t - t // 4, 5.0, integers)),
        "constant": np.full(t, 3.7),
        "spike": np.where(time == t // 2, 1e3, 1e-3 * rng.normal(size=t)),
        "tiny": 1e-30 * rng.normal(size=t),
        "huge": 1e12 * rng.normal(size=t),
        "far from zero": 1e4 + np.round(rng.normal(size=t), 2),
        "flat extremes": np.sin(0.01 * time) + 1e-9 * rng.normal(size=t),
        "sine": 10.0 * np.sin(2 * np.pi * time / 40),
        "noise": rng.normal(size=t),
    }[kind]


def block_of(rng: np.random.Generator, kind: str, points: int, t: int) -> tuple[Floats, Floats, Floats]:
    """Shapes and modal coordinates of points each of which has a membrane and a bending history of its own."""
    histories = [adversarial(rng, kind, t) for _ in range(2 * points)]
    both = np.eye(2 * points)
    return both[:points], both[points:], np.array(histories)


def modal_block(seed: int, points: int = 40, modes: int = 12, t: int = 3000) -> tuple[Floats, Floats, Floats]:
    """Shapes and smooth modal coordinates of resonances, some points with nearly cancelling faces."""
    rng = np.random.default_rng(seed)
    spectrum = rng.normal(size=(modes, t // 2 + 1)) + 1j * rng.normal(size=(modes, t // 2 + 1))
    f = np.fft.rfftfreq(t)
    q = np.fft.irfft(spectrum / (1 - (f / np.linspace(0.01, 0.18, modes)[:, None]) ** 2 + 0.06j) * (f < 0.25), t)
    q = q / q.std(axis=1, keepdims=True) + rng.normal(size=(modes, 1))
    S_m = rng.normal(size=(points, modes)) * np.exp(2 * rng.normal(size=(points, 1)))
    S_b = rng.normal(size=(points, modes)) * np.exp(2 * rng.normal(size=(points, 1)))
    S_b[:3] = -S_m[:3] * (1 + 1e-3 * rng.normal(size=(3, modes)))
    S_b[3], S_m[4], S_b[5] = 0.0, 0.0, S_m[5]
    S_m[6] = S_b[6] = 0.0
    return S_m, S_b, q


def recorded(q: NDArray[np.floating], residue: Residue = "repeat") -> CountedRecord:
    """Prepare modal coordinates for the counter in single precision."""
    return CountedRecord(q, residue, single_record(q))


def both_counts(
    S_m: Floats,
    S_b: Floats,
    q: NDArray[np.floating],
    law: DamageLaw = ALUMINIUM,
    residue: Residue = "repeat",
    **choices: Any,
) -> tuple[BlockCount, BlockCount]:
    """Count in single and in double precision."""
    rule = CycleRule(law, **({"uses_bending_ratio": True} | choices))
    rng = np.random.default_rng(len(S_m))
    stress = BlockStress(S_m, S_b, rng.uniform(1, 2, len(S_m)), rng.uniform(0, 1, (len(S_m), 2)))
    record = recorded(q, residue)
    return count(stress, record, rule), count_rows(stress, record, rule)


def one_ratio(S_m: Floats, S_b: Floats) -> BlockStress:
    """Stress of points of unit size factor."""
    return BlockStress(S_m, S_b, np.ones(len(S_m)), np.full((len(S_m), 2), 0.3))


def assert_same(fast: BlockCount, exact: BlockCount, rtol: float = 1e-6) -> None:
    """Every field agrees, and is NaN at the same places."""
    for name in BlockCount.__slots__:
        a, b = getattr(fast, name), getattr(exact, name)
        scale = np.abs(exact.max_range) + np.abs(exact.mean) if name in ("mean", "max_range") else 0.0
        limit = rtol * (np.abs(b) + scale)
        bad = ~((np.abs(a - b) <= limit) | (np.isnan(a) & np.isnan(b)))
        if name == "r_largest":  # the quotient of two stresses is only as good as the smaller one
            bad &= np.abs(a - b) > rtol * (1.0 + np.abs(b)) ** 2
        assert not bad.any(), (name, a[bad][:3], b[bad][:3])


@pytest.mark.parametrize("residue", RESIDUES)
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.slow
def test_adversarial_histories_count_as_in_double_precision(kind: str, residue: Residue) -> None:
    """Every field, in histories of some hundred samples."""
    rng = np.random.default_rng(KINDS.index(kind))
    for t in (512, 515, 528, 900):
        assert_same(*both_counts(*block_of(rng, kind, 40, t), residue=residue))


@pytest.mark.parametrize("residue", RESIDUES)
@pytest.mark.parametrize("kind", KINDS)
def test_short_adversarial_histories(kind: str, residue: Residue, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same cycles in histories from 2 samples on; so few do not average rounding out."""
    monkeypatch.setattr(counter, "SHORTEST", 2)
    rng = np.random.default_rng(KINDS.index(kind))
    for t in (2, 3, 4, 5, 7, 16, 17, 33, 64, 150):
        fast, exact = both_counts(*block_of(rng, kind, 40, t), residue=residue)
        np.testing.assert_array_equal(fast.cycles, exact.cycles)
        np.testing.assert_allclose(fast.damage, exact.damage, rtol=2e-5, atol=1e-12 * exact.damage.max())


@pytest.mark.parametrize("residue", RESIDUES)
@pytest.mark.parametrize("law", [STEEL, ALUMINIUM, PLAIN_CUBE])
def test_modal_stress_counts_as_in_double_precision(law: DamageLaw, residue: Residue) -> None:
    """Smooth stress of resonances, whose extremes single precision alone cannot always tell."""
    for seed in range(5):
        S_m, S_b, q = modal_block(seed)
        choices = {"residue": residue, "uses_bending_ratio": law is not PLAIN_CUBE, "yield_MPa": 1e9}
        assert_same(*both_counts(S_m, S_b, q.astype(np.float32), law, **choices))


def test_a_thousand_points_of_one_event() -> None:
    """Largest and median error of the damage, over points whose stresses differ by orders of magnitude."""
    S_m, S_b, q = modal_block(11, points=1000, t=2048)
    fast, exact = both_counts(S_m, S_b, q.astype(np.float32))
    error = np.abs(fast.damage / np.maximum(exact.damage, 1e-300) - 1.0)[exact.damage > 0.0]
    assert error.max() < 1e-6
    assert np.median(error) < 1e-7


@pytest.mark.parametrize("residue", RESIDUES)
@pytest.mark.parametrize("kind", ["ties", "held", "growing", "zigzag", "wrapping plateau", "constant", "noise"])
def test_the_length_of_the_chunks_does_not_matter(kind: str, residue: Residue, monkeypatch: pytest.MonkeyPatch) -> None:
    """Chunks of 32 samples, and no room for long residues, count what one chunk counts."""
    monkeypatch.setattr(counter, "SHORTEST", 2)
    for module in (counter, prepare):
        monkeypatch.setattr(module, "CHUNK", 32)
    monkeypatch.setattr(counter, "RESIDUE", 80)
    rng = np.random.default_rng(KINDS.index(kind))
    for t in (2, 3, 8, 50, 400):
        fast, exact = both_counts(*block_of(rng, kind, 20, t), residue=residue)
        np.testing.assert_array_equal(fast.cycles, exact.cycles)
        np.testing.assert_allclose(fast.damage, exact.damage, rtol=2e-5, atol=1e-12 * exact.damage.max())


def test_the_number_of_points_does_not_matter() -> None:
    """The bytes of a row are the same alone and among others, whatever was counted again."""
    S_m, S_b, q = modal_block(3, points=300, t=600)
    stress, record, rule = one_ratio(S_m, S_b), recorded(q.astype(np.float32)), CycleRule(ALUMINIUM, True)
    whole = count(stress, record, rule)
    part = slice(128, 256)
    alone = count(stress.at(part), record, rule)
    assert alone.damage.tobytes() == whole.damage[part].tobytes()


class Slices:
    """Modal coordinates of which only some samples can be had at a time, as of a file."""

    def __init__(self, q: NDArray[np.floating]) -> None:
        self.q, self.shape, self.dtype = q, q.shape, q.dtype

    def __getitem__(self, part: tuple[slice, slice]) -> NDArray[np.floating]:
        """Give all modes at up to 10 000 samples."""
        modes, samples = part
        assert modes == slice(None)
        assert samples.stop - samples.start <= 10_000
        return np.ascontiguousarray(self.q[part])


@pytest.mark.parametrize("yield_MPa", [None, 30.0])
def test_modal_coordinates_need_not_be_in_memory(yield_MPa: float | None, tmp_path: Path) -> None:
    """Slices of bounded length are enough, also for what is counted in double precision, and count the same bytes."""
    S_m, S_b, q = modal_block(4, points=150, t=20_100)
    stress, rule = one_ratio(S_m, S_b), CycleRule(ALUMINIUM, True, yield_MPa)
    record = recorded(q.astype(np.float32))
    on_disk = create_spool(tmp_path / "q", q.shape, np.dtype(np.float32))
    of_slices = CountedRecord(Slices(record.q), "repeat", single_record(record.q, on_disk))
    array, slices = (count(stress, r, rule) for r in (record, of_slices))
    for name in BlockCount.__slots__:
        np.testing.assert_array_equal(getattr(array, name), getattr(slices, name))


@pytest.mark.parametrize("residue", RESIDUES)
@pytest.mark.parametrize("points", [3, 150])
def test_compiled_and_interpreted_loop_count_the_same_bytes(
    points: int, residue: Residue, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Over several chunks and pieces, the last ones shorter, and with what is in doubt."""
    S_m, S_b, q = modal_block(9, points=max(points, 7), t=9000)
    S_m, S_b = S_m[-points:], S_b[-points:]
    stress, record, rule = one_ratio(S_m, S_b), recorded(q.astype(np.float32), residue), CycleRule(ALUMINIUM, True)
    compiled = count(stress, record, rule)
    monkeypatch.setattr(counter, "count_in_memory", over_time.count_record)
    interpreted = count(stress, record, rule)
    for name in BlockCount.__slots__:
        np.testing.assert_array_equal(getattr(compiled, name), getattr(interpreted, name))


def test_few_surfaces_are_counted_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nearly all of what rounding may have decided is settled within its chunk."""
    S_m, S_b, q = modal_block(7, points=500, t=20_000)
    again, in_doubt = [], []
    count_again, exactly = counter._count, over_time.count_chunk_exactly

    def counting(block: object, wanted: NDArray[np.bool_], *rest: object) -> NDArray[np.void]:
        again.append(int(wanted.sum()))
        return count_again(block, wanted, *rest)

    def settling(*args: Any) -> None:
        in_doubt.append(len(args[-1]))
        exactly(*args)

    monkeypatch.setattr(counter, "_count", counting)
    monkeypatch.setattr(over_time, "count_chunk_exactly", settling)
    monkeypatch.setattr(counter, "count_in_memory", over_time.count_record)
    count(one_ratio(S_m, S_b), recorded(q.astype(np.float32)), CycleRule(ALUMINIUM, True))
    assert sum(in_doubt) > 5
    assert again[1:] == [4]  # the faces that nearly cancel, with which single precision is not trusted


@pytest.mark.parametrize("residue", RESIDUES)
@pytest.mark.parametrize("chunk", [32, 4096])
def test_a_chunk_in_doubt_counts_as_in_double_precision(
    chunk: int, residue: Residue, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Chunks of some points taken for doubtful at random, so that both ways follow each other; with mean stresses."""
    for module in (counter, prepare):
        monkeypatch.setattr(module, "CHUNK", chunk)
    in_single, rng = over_time.count_chunk, np.random.default_rng(3)

    def doubting(stress: Any, samples: Any, stage: Any, law: Any, state: Any, room: Any, doubts: Any) -> int:
        sides, waiting = state.sides.copy(), state.waiting.copy()
        found = in_single(stress, samples, stage, law, state, room, doubts)
        if stress.dtype == np.float64:  # counted again as a whole
            return found
        some = (rng.random(sides.shape) < 0.5) & ~sides["doubtful"]
        some[tuple(doubts[:found].T)] = True
        for name in set(SIDE.names) - {"second", "fourth"}:
            state.sides[name][some] = sides[name][some]
        state.waiting[some] = waiting[some]
        chosen = np.argwhere(some)
        doubts[: len(chosen)] = chosen
        return len(chosen)

    monkeypatch.setattr(over_time, "count_chunk", doubting)
    monkeypatch.setattr(counter, "count_in_memory", over_time.count_record)
    for seed in range(3):
        S_m, S_b, q = modal_block(seed, t=900)
        assert_same(*both_counts(S_m, S_b, (q + 5.0).astype(np.float32), residue=residue))
    for kind in ("held", "growing", "zigzag", "far from zero", "noise"):
        assert_same(*both_counts(*block_of(rng, kind, 20, 600), residue=residue))


@pytest.mark.parametrize("kind", ["noise", "growing", "sine"])
def test_half_is_the_damage_of_the_rainflow_package(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Sum of n S^3 without bending, against an independent counter."""
    monkeypatch.setattr(counter, "SHORTEST", 2)
    rng = np.random.default_rng(1)
    for t in (50, 333):
        s = adversarial(rng, kind, t)
        fast, _ = both_counts(np.ones((1, 1)), np.zeros((1, 1)), s[None], PLAIN_CUBE, residue="half")
        cycles = list(oracle.extract_cycles(s.tolist()))
        assert fast.cycles[0, 0] == sum(n for _, _, n, _, _ in cycles)
        assert fast.power_sum[0, 0] == pytest.approx(sum(n * S**3 for S, _, n, _, _ in cycles), rel=2e-6)


@pytest.mark.parametrize("law", [HAIBACH, STEEP])
def test_laws_with_knees_and_very_steep_ones_are_counted_in_double_precision(law: DamageLaw) -> None:
    """To rounding errors."""
    assert_same(*both_counts(*modal_block(1, points=20, t=600), law), rtol=1e-10)


@pytest.mark.parametrize("mean_stress", [False, True])
def test_points_in_high_mean_tension_have_the_mean_stress_factor(mean_stress: bool) -> None:
    """Where a cycle may reach the tension at which f_M begins; elsewhere both damages are the same."""
    S_m, S_b, q = modal_block(2, points=20, t=600)
    fast, exact = both_counts(S_m, S_b, q + 3.0, yield_MPa=30.0, mean_stress=mean_stress)
    assert_same(fast, exact)
    assert (exact.damage_mean_stress > 1.01 * exact.damage).any() != mean_stress


def test_what_is_not_finite_is_refused() -> None:
    """A sample of a modal coordinate, and a stress shape."""
    S_m, S_b, q = modal_block(1, points=20, t=600)
    spoilt = q.copy()
    spoilt[2, 17] = np.nan
    with pytest.raises(NumericalError, match="sample 17 of modal coordinate 2"):
        single_record(spoilt)
    S_b[3, 0] = np.inf
    with pytest.raises(NumericalError, match="row 3 of the block: the stress is NaN or infinite"):
        count(one_ratio(S_m, S_b), recorded(q, "half"), CycleRule(STEEL, True))


# ------------------------------------------------------------------------------------------------ vectors


def room_for(samples: int, precision: type[np.floating]) -> state.Room:
    """Work space filled with numbers that must not be read."""
    room = state.room_for(samples, 0, precision)
    for array in room:
        array[:] = 7
    return room


@vector_instructions
@pytest.mark.parametrize(("width", "precision"), [(512, np.float32), (512, np.float64), (256, np.float32)])
def test_vector_instructions_do_what_the_plain_loops_do(
    width: int, precision: type[np.floating], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Reversals, closed ranges and doubts, bit for bit, for every kind of history and both surfaces."""
    from fatigue.life.counting.single.kernels import simd  # noqa: PLC0415

    if width > simd.vector_bits():
        pytest.skip("not on this processor")
    monkeypatch.setattr(simd, "WIDTH", width)

    def compiled_now(function: Callable[..., object]) -> Callable[..., object]:
        plain: FunctionType = function.py_func  # type: ignore[attr-defined]
        return njit(plain)

    write, close = compiled_now(simd.write_reversals), compiled_now(simd.close_pass)
    rng = np.random.default_rng(5)
    flat = np.float32(1e-3)
    for kind in KINDS:
        for t in (2, 9, 17, 40, 333):
            m, b = (np.pad(adversarial(rng, kind, t), (0, state.PAD), "edge").astype(precision) for _ in "mb")
            for side in (np.float32(1.0), np.float32(-1.0)):
                rooms = [room_for(t, precision) for _ in range(2)]
                found = [
                    f(m, b, side, flat, t, 1, r, 0) for f, r in zip((loops.write_reversals, write), rooms, strict=True)
                ]
                assert found[0] == found[1]
                n = found[0][0]
                closed = [f(r, n, 0, flat) for f, r in zip((loops.close_pass, close), rooms, strict=True)]
                assert closed[0] == closed[1]
                left, cycles, _ = closed[0]
                for row, length in enumerate((left, left, cycles, cycles)):
                    a, c = (room.numbers[row, :length] for room in rooms)
                    np.testing.assert_array_equal(a.view(np.uint8), c.view(np.uint8))


@vector_instructions
def test_the_product_in_tiles_is_the_product() -> None:
    """For numbers of rows, modes and samples that fill no tile, and for part of a longer record."""
    from fatigue.life.counting.single.kernels import simd  # noqa: PLC0415

    if simd.vector_bits() < 512:
        pytest.skip("not on this processor")
    rng = np.random.default_rng(0)
    for rows, modes, samples in ((1, 1, 1), (12, 60, 64), (25, 7, 100), (96, 3, 31)):
        shapes = rng.normal(size=(rows, modes)).astype(np.float32)
        q = rng.normal(size=(modes, samples + 50)).astype(np.float32)[:, 13 : 13 + samples]
        stress = np.full((-(-rows // 12) * 12, 1 + -(-samples // 32) * 32), 7.0, np.float32)
        panels = simd.lay_out(q, simd.panels_for(modes, samples + 40))
        simd.multiply(simd.tiles_of(shapes), panels, stress)
        exact = shapes.astype(np.float64) @ q
        limit = modes * 2.0**-24 * (np.abs(shapes).astype(np.float64) @ np.abs(q))
        assert (np.abs(stress[:rows, 1 : samples + 1] - exact) <= limit).all()
        assert not stress[rows:, 1:].any()
        assert not stress[:, samples + 1 :].any()
        assert (stress[:, 0] == 7.0).all()


@vector_instructions
def test_the_plain_loops_are_used_where_there_are_no_vectors(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the processor numba compiles for, not of the one it runs on."""
    from fatigue.life.counting.single.kernels import simd  # noqa: PLC0415

    for features, bits in (("", 0), ("+sse2", 0), ("+avx2,+fma", 256), ("+avx2,+avx512f", 512)):
        monkeypatch.setattr(simd.config, "CPU_FEATURES", features)
        assert simd.vector_bits() == bits


KEPT = """
import numpy as np
from numba.core.registry import cpu_target
from fatigue.life.counting.single.kernels import loops, simd, state
loops.close_all(state.room_for(40, 0, np.float32), 0, np.float32(0.0))
_, name, features = cpu_target.target_context.codegen().magic_tuple()
has = set(features.split(","))
wide = 512 if "+avx512f" in has else 256 if "+avx2" in has else 0
print(simd.WIDTH, wide, sum(loops.close_all.stats.cache_hits.values()))
"""
AVX2 = {"NUMBA_CPU_NAME": "haswell", "NUMBA_CPU_FEATURES": "+avx,+avx2,+fma"}


@vector_instructions
@pytest.mark.slow
def test_machine_code_of_other_vectors_is_never_taken(tmp_path: Path) -> None:
    """A folder of machine code copied to another processor serves it only where vectors and features are the same."""

    def width_and_hits(**environment: str) -> list[int]:
        where = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)} | environment
        command = [sys.executable, "-c", KEPT]
        done = subprocess.run(command, env=where, capture_output=True, text=True, check=True)
        width, of_features, hits = map(int, done.stdout.split())
        assert width == of_features
        return [width, hits]

    own, _ = width_and_hits()
    if own < 256:
        pytest.skip("not on this processor")
    assert width_and_hits() == [own, 1]
    for width, environment in ((256, AVX2), (0, {"NUMBA_CPU_NAME": "generic"}), (0, {"NUMBA_ENABLE_AVX": "0"})):
        assert width_and_hits(**environment) == [width, 0]
        assert width_and_hits(**environment) == [width, 1]
    assert width_and_hits(NUMBA_CPU_NAME="haswell") == [own, 0]  # a name alone leaves the features as they are
    assert width_and_hits() == [own, 1]
