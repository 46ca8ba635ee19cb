"""The story of the ledger: every way on every kind of input, each in a process of its own, beside what is right.

1. ``asked``: which ways there are; a package that is not installed is a row that says so, with the command to get it.
2. ``measured``: time and memory of a way, in a fresh process.
3. ``compared``: cycles, ``sum n S^k`` and the largest deviation of a range from the reference of the same residue.
"""

import json
import math
import os
import platform
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.ledger import reference, ways
from benchmarks.ledger.child import Task, spectra_of
from benchmarks.ledger.signals import BANDS, KINDS, signals_of
from fatigue.files.extras import install_command

Floats = NDArray[np.float64]

SPECTRA = 1024


@dataclass(frozen=True, slots=True)
class Size:
    """How much is measured: signals and samples of all kinds, or None: as each kind has them; spectra."""

    signals: int | None = None
    samples: int | None = None
    spectra: int = SPECTRA


@dataclass(frozen=True, slots=True)
class Entry:
    """A row of the ledger; numbers are NaN where a way does not tell them, and ``missing`` says why there are none.

    ``wall_ns`` and ``cpu_ns`` are per sample or per spectrum; ``cycles`` and ``power_sum`` are over those of the
    reference, minus one (``power_sum``: the damage, of spectra); ``largest`` is the largest deviation of a range over
    the largest range.
    """

    task: str
    kind: str
    way: str
    package: str
    version: str = ""
    precision: str = ""
    residue: str = ""
    wall_ns: float = math.nan
    cpu_ns: float = math.nan
    memory_MB: float = math.nan  # noqa: N815
    cycles: float = math.nan
    power_sum: float = math.nan
    largest: float = math.nan
    missing: str = ""


def ledger(size: Size, told: Callable[[str], None] = lambda _: None) -> Iterator[Entry]:
    """Rows of both tables, kind by kind."""
    for kind in KINDS:
        for way in ways.COUNTING:
            yield _row("counting", kind, way, size, told)
    for kind in BANDS:
        for way in ways.SPECTRAL:
            yield _row("spectral", kind, way, size, told)


def _row(task: str, kind: str, way: ways.Way, size: Size, told: Callable[[str], None]) -> Entry:
    """Row of one way on one kind of input."""
    entry = Entry(task, kind, way.name, way.package, precision=way.precision, residue=way.residue)
    found = installed(way.package)
    if not found:
        return replace(entry, missing=f"not installed: {_command(way.package)}")
    told(f"{kind}: {way.name}")
    is_counting = task == "counting"
    signals = (size.signals or KINDS[kind].signals) if is_counting else size.spectra
    samples = (size.samples or KINDS[kind].samples) if is_counting else 0
    with tempfile.TemporaryDirectory() as folder:
        asked = Task(way.name, kind, signals, samples, str(Path(folder) / "found.npz"))
        measured = in_a_child(asked)
        with np.load(asked.out) as archive:
            arrays = dict(archive)
    if is_counting:
        right = exact(kind, signals, samples, way.residue)
        deviations = compared(arrays["sums"].tolist(), arrays["halves"], right)
    else:
        deviations = {"power_sum": largest_share(arrays["rates"], exact_rates(kind, signals, way.name))}
    return replace(entry, version=found, **measured, **deviations)


def installed(package: str) -> str:
    """Version of a package; empty where it is not installed."""
    try:
        return version(package)
    except PackageNotFoundError:
        return ""


def _command(package: str) -> str:
    return 'pip install "rainflow"' if package == "rainflow" else install_command(package)


def in_a_child(task: Task) -> dict[str, float]:
    """Measure a task in a fresh process.

    Raises
    ------
    SystemExit : the process fails; with what it says
    """
    command = [sys.executable, "-m", "benchmarks.ledger.child"]
    asked = json.dumps({name: getattr(task, name) for name in Task.__slots__})
    root = Path(__file__).parents[2]
    done = subprocess.run(command, input=asked, capture_output=True, text=True, check=False, cwd=root)
    if done.returncode:
        raise SystemExit(f"{task.way} on {task.kind} failed:\n{done.stderr}")
    measured: dict[str, float] = json.loads(done.stdout.splitlines()[-1])
    return measured


@cache
def exact(kind: str, signals: int, samples: int, residue: str) -> Floats:
    """Ranges of all signals by the reference, ascending, twice for a full cycle."""
    counted = reference.closed_cycles if residue == "repeat" else reference.half_cycles
    return np.sort(np.concatenate([counted(x) for x in signals_of(kind, signals, samples)]))


def exact_rates(kind: str, spectra: int, way: str) -> Floats:
    """Damage per second of each spectrum: it grows with the density to the power of half the slope."""
    method = reference.dirlik if way.endswith("Dirlik") else reference.tovo_benasciutti
    _, densities = spectra_of(kind, spectra, 2)
    levels = densities[:, 0] / BANDS[kind].density
    return np.asarray(method(BANDS[kind], ways.SLOPE) * levels ** (ways.SLOPE / 2))


def compared(sums: list[float], halves: Floats, right: Floats) -> dict[str, float]:
    """Deviations of what a way found from the reference: its cycles, their sum, and the largest one of a range.

    Ranges are compared one by one in ascending order; where there are not as many as there should be, each half cycle
    too many or missing counts as one of no range at all: lists are filled up with zeros. Ways that tell no ranges are
    compared by their largest one.
    """
    cycles, power_sum, largest = sums
    whole = reference.power_sum(right, ways.SLOPE)
    if halves.size:
        size = max(halves.size, right.size)
        a, b = (np.concatenate([np.zeros(size - some.size), some]) for some in (halves, right))
        deviation = float(np.abs(a - b).max()) / float(right[-1])
    else:
        deviation = abs(largest / float(right[-1]) - 1.0)
    return {
        "cycles": cycles / (0.5 * right.size) - 1.0,
        "power_sum": power_sum / whole - 1.0,
        "largest": deviation,
    }


def largest_share(found: Floats, right: Floats) -> float:
    """Deviation of the largest magnitude of ``found / right - 1``, with its sign."""
    share = found / right - 1.0
    return float(share[np.argmax(np.abs(share))])


def facts() -> dict[str, Any]:
    """What a reader needs to compare with his own run: packages and machine."""
    lines = Path("/proc/cpuinfo").read_text().splitlines() if Path("/proc/cpuinfo").is_file() else []
    model = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), "")
    flags = next((set(line.split()) for line in lines if line.startswith("flags")), set())
    vectors = "AVX-512" if "avx512f" in flags else "AVX2" if "avx2" in flags else ""
    return {
        "processor": ", ".join(filter(None, (model or platform.processor() or platform.machine(), vectors))),
        "cores": os.cpu_count(),
        "system": f"{platform.system()} {platform.release()}",
        "Python": platform.python_version(),
        **{name: version(name) for name in ("numpy", "numba", "scipy")},
    }
