"""Superposition, counting and damage against the bare matrix product, and how the cost grows."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np

from benchmarks.load import load
from benchmarks.timing import Row, best_times
from fatigue.life.bounds.forms import face_forms
from fatigue.life.bounds.screening import extent_bound, modal_extent


def against_the_product() -> list[Row]:
    """Two surfaces, 60 modes, 20 000 steps, or more of both; recounts in double precision included."""
    case, longer = load(512), load(512, 100, 30_000)
    best = best_times(
        {"product": case.product, "single": case.count_single, "double": lambda: case.count_double(0, 128)}, 8
    )
    best_longer = best_times({"product": longer.product, "single": longer.count_single}, 5)
    extent = modal_extent(case.q, "repeat")

    def modal_bound() -> object:
        return extent_bound(case.S_m, case.S_b, face_forms(case.S_m, case.S_b, extent.products), extent)

    bound = best_times({"bound": modal_bound}, 5)
    single, double = case.count_single(0, 128), case.count_double(0, 128)
    error = np.abs(single.damage / double.damage - 1.0)
    samples = 2 * 512 * 20_000
    return [
        ("float64 product of the same stresses", f"{1e9 * best['product'] / samples:.2f} ns per stress sample"),
        ("single precision pipeline / product", f"{best['single'] / best['product']:.2f}"),
        (
            "single precision pipeline / product, 100 modes x 30 000 steps",
            f"{best_longer['single'] / best_longer['product']:.2f}",
        ),
        ("double precision pipeline / product", f"{4 * best['double'] / best['product']:.1f}"),
        ("stress samples per second and thread, single precision", f"{samples / best['single'] / 1e6:.0f} million"),
        ("stress samples per second and thread, double precision", f"{samples / 4 / best['double'] / 1e6:.0f} million"),
        ("modal bound, without a loop over time / product", f"{bound['bound'] / best['product']:.5f}"),
        ("damage, single / double precision - 1", f"median {np.median(error):.1e}, largest {error.max():.1e}"),
    ]


def growth() -> list[Row]:
    """Time per stress sample and mode against the middle case, which is 1."""
    sizes = {
        "256 nodes x 60 modes x 10 000 steps": (256, 60, 10_000),
        "twice the nodes": (512, 60, 10_000),
        "twice the steps": (256, 60, 20_000),
        "half the modes": (256, 30, 10_000),
        "twice the modes": (256, 120, 10_000),
    }
    cases = {name: load(*size) for name, size in sizes.items()}
    best = best_times({name: case.count_single for name, case in cases.items()}, 8)
    per_sample = {name: best[name] / (nodes * steps) for name, (nodes, _, steps) in sizes.items()}
    middle = next(iter(per_sample.values()))
    return [(f"time per stress sample, {name}", f"{time / middle:.2f}") for name, time in per_sample.items()]


def threads() -> list[Row]:
    """Blocks of 128 nodes in two threads against one."""
    case = load(1024, steps=10_000)
    blocks = range(0, 1024, 128)

    def run(workers: int) -> None:
        with ThreadPoolExecutor(workers) as executor:
            list(executor.map(lambda first: case.count_single(first, first + 128), blocks))

    best = best_times({"1": lambda: run(1), "2": lambda: run(2)}, 5)
    return [("speed-up with two threads", f"{best['1'] / best['2']:.2f}")]
