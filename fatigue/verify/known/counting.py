"""Sequences whose rainflow cycles are published, and histories whose cycles are known."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.rainflow import rainflow
from fatigue.life.counting.rows import count_histories
from fatigue.life.curves import DamageLaw
from fatigue.life.records.history import ModalHistory, Residue, upsampled
from fatigue.life.rule import CycleRule
from fatigue.verify.check import Check

ASTM = [-2, 1, -3, 5, -1, 3, -4, 4, -2]
ISO = [4, 7, 2, 10, 5, 9, 3, 4, 2, 12, 5, 11, 1, 4, 3, 10, 6, 12, 4, 8, 1, 9, 4, 6]
WIKIPEDIA = [2, -14, 10, 0, 13, -9, 11, -8, 8, -9, 15, -4, 10, 0, 13, 0]
LONG = [-1.5, 1, -3, 10, -1, 3, -8, 4, -2, 6, -1, -4, -8, 2, 1, -5, 0, 2.5, -4, 1, 0, 2, -0.5]

PACKAGE, WIKI = "test suite of the rainflow package", "Wikipedia, Rainflow-counting algorithm"
HALF, REPEAT = "ASTM E1049-85 5.4.4", "ASTM E1049-85 5.4.5"

# name, sequence, residue rule, {range: count}, source
SEQUENCES: tuple[tuple[str, Sequence[float], Residue, dict[float, float], str], ...] = (
    ("ASTM figure 6", ASTM, "half", {3: 0.5, 4: 1.5, 6: 0.5, 8: 1, 9: 0.5}, HALF),
    ("ASTM figure 6", ASTM, "repeat", {3: 1, 4: 1, 7: 1, 9: 1}, REPEAT),
    ("ISO example", ISO, "half", {1: 2, 2: 0.5, 3: 0.5, 4: 3, 5: 1, 6: 1, 8: 1.5, 10: 0.5, 11: 1.5}, "ISO 12110-2"),
    ("ISO example", ISO, "repeat", {1: 2, 2: 1, 3: 1, 4: 3, 6: 1, 7: 1, 8: 1, 11: 2}, "ISO 12110-2"),
    ("23 reversals", LONG, "half",
     {1: 1, 2.5: 1, 4: 1.5, 6: 1.5, 6.5: 0.5, 7: 1, 10.5: 0.5, 13: 0.5, 14: 1, 18: 0.5}, PACKAGE),
    ("16 reversals", WIKIPEDIA, "half", {10: 2, 13: 0.5, 16: 1.5, 17: 0.5, 19: 0.5, 20: 1, 22: 1, 29: 0.5}, WIKI),
    ("16 reversals", WIKIPEDIA, "repeat", {2: 1, 10: 2, 16: 1, 17: 1, 20: 1, 22: 1, 29: 1}, WIKI),
    ("2 5 3 7", [2, 5, 3, 7], "repeat", {2: 1, 5: 1}, REPEAT),
    ("0 1", [0, 1], "half", {1: 0.5}, HALF),
)  # fmt: skip


def counting_checks() -> Iterator[Check]:
    """Checks of rainflow counting, of ranges of membrane and bending at the same instants, and of upsampling."""
    for name, sequence, residue, expected, source in SEQUENCES:
        yield _sequence(name, np.array(sequence, dtype=np.float64), residue, expected, source)
    i = np.arange(1001)
    two_tones = rainflow(0.8 * np.sin(0.01 * np.pi * i) + 0.2 * np.sin(0.032 * np.pi * i), "half")
    largest = float(two_tones.range.max())
    yield Check("rainflow", "two sines", "largest range", "-", 1.9942872896932382, largest, 1e-12, PACKAGE)
    yield from _paired_ranges()
    yield _upsampling()


def _sequence(
    name: str, sequence: NDArray[np.float64], residue: Residue, expected: Mapping[float, float], source: str
) -> Check:
    """Check of a count by its sum of n (S^3 + 1), which every one of its cycles changes."""
    cycles = rainflow(sequence, residue)
    found = float(cycles.count @ (cycles.range**3 + 1))
    total = sum(n * (S**3 + 1) for S, n in expected.items())
    return Check("rainflow", f"{name}, {residue}", "sum of n (S^3 + 1)", "-", total, found, 1e-12, source)


def _paired_ranges() -> Iterator[Check]:
    """Checks on membrane 10 sin and bending 5 sin, 0, 90, 180 degrees apart: their ranges at the same two instants."""
    cube = CycleRule(DamageLaw(np.array([3.0]), np.array([0.0]), np.array([]), 0.0), uses_bending_ratio=True)
    for degrees, S, r in ((0, 30.0, 1 / 3), (90, np.sqrt(500.0), 0.2), (180, 10.0, 1 / 3)):
        shift = np.radians(degrees)
        peak = np.arctan2(10 + 5 * np.cos(shift), 5 * np.sin(shift))
        angle = peak + 2 * np.pi * np.arange(720) / 360  # two periods that meet every peak
        membrane, bending = 10 * np.sin(angle)[None], 5 * np.sin(angle + shift)[None]
        counted = count_histories(membrane, bending, np.ones(1), np.zeros((1, 2)), "repeat", cube)
        case = f"bending {degrees} degrees from membrane"
        dS = S / ((1.23 - 0.364 * r - 0.17 * r**2) / (1.007 - 0.306 * r - 0.178 * r**2))
        clause = "closed form; ASME VIII-2 5.5.5.2, steps 2 to 6"
        found_S = float(counted.max_range[0, 0])
        yield Check("rainflow", case, "structural stress range", "MPa", float(S), found_S, 1e-9, clause)
        yield Check(
            "rainflow",
            case,
            "damage of 2 cycles, N = 1/dS^3",
            "-",
            float(2 * dS**3),
            float(counted.damage[0, 0]),
            1e-9,
            clause,
        )


def _upsampling() -> Check:
    """Check of a sine of 5 samples per period, made 4 times finer."""
    sine = ModalHistory("sine", np.array([1]), np.sin(2 * np.pi * np.arange(50) / 5)[None], 0.2, 0.0)
    fine = np.asarray(upsampled(sine, 4, "repeat").q)[0]
    worst = float(np.abs(fine - np.sin(2 * np.pi * np.arange(200) / 20)).max())
    return Check(
        "rainflow", "sine of 5 samples, upsampled 4 times", "largest error", "-", 0.0, worst, 1e-12, "closed form"
    )
