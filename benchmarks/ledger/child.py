"""One way on one kind of input, measured in a process of its own: ``python -m benchmarks.ledger.child < task``.

Wall and processor time are the best of several rounds after one on short inputs, which imports and compiles. Memory is
what the kernel says was resident at most (``VmHWM``, set back before), over what was resident before the round.
"""

import json
import resource
import sys
import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from benchmarks.ledger import ways
from benchmarks.ledger.signals import BANDS, signals_of

Floats = NDArray[np.float64]

ENOUGH_S, MOST_ROUNDS = 4.0, 20
SHORT = 1024  # samples that warm up
LINES = 2049
SPREAD = 0.5  # of the logarithm of levels of spectra


@dataclass(frozen=True, slots=True)
class Task:
    """What is to be measured: the name of a way, the kind of input, how many of them, and how long; where to write."""

    way: str
    kind: str
    signals: int
    samples: int
    out: str


def spectra_of(kind: str, spectra: int, lines: int = LINES) -> tuple[Floats, Floats]:
    """Frequencies (f,) and densities (n, f) of a flat band at different levels, the first at its own."""
    f, density = BANDS[kind].sampled(lines)
    level = np.exp(SPREAD * np.linspace(0.0, 1.0, spectra))
    return f, level[:, np.newaxis] * density


def measure(task: Task) -> dict[str, Any]:
    """Measure a task; what was found and all its ranges go to ``task.out`` as an archive of numpy."""
    known = {way.name: way for way in (*ways.COUNTING, *ways.SPECTRAL)}
    way = known[task.way]
    is_counting = way in ways.COUNTING
    given = (signals_of(task.kind, task.signals, task.samples),) if is_counting else spectra_of(task.kind, task.signals)
    short = (signals_of(task.kind, 2, SHORT),) if is_counting else spectra_of(task.kind, 2)
    with warnings.catch_warnings(), threadpool_limits(1):
        warnings.simplefilter("ignore")
        call = way.ready()
        call(*short)
        wall, cpu, memory, result = best(lambda: call(*given))
        found = way.found(result)
    values = given[-1].size if is_counting else len(given[-1])
    if is_counting:
        halves = np.empty(0) if found.halves is None else found.halves
        np.savez(task.out, halves=halves, sums=[found.cycles, found.power_sum, found.largest])
    else:
        np.savez(task.out, rates=found)
    return {"wall_ns": 1e9 * wall / values, "cpu_ns": 1e9 * cpu / values, "memory_MB": memory}


def best(call: Callable[[], Any]) -> tuple[float, float, float, Any]:
    """Best wall and processor time [s] of some rounds, peak memory of the first one [MB], and what the last gave."""
    wall = cpu = float("inf")
    memory, begin, result = 0.0, time.perf_counter(), None
    for number in range(MOST_ROUNDS):
        result = None
        before, at, used = resident_peak(reset=True) if number == 0 else 0.0, time.perf_counter(), time.process_time()
        result = call()
        wall, cpu = min(wall, time.perf_counter() - at), min(cpu, time.process_time() - used)
        if number == 0:
            memory = resident_peak() - before
        if time.perf_counter() - begin > ENOUGH_S:
            break
    return wall, cpu, memory, result


def resident_peak(*, reset: bool = False) -> float:
    """Largest resident memory so far [MB], or since it was set back to what is resident now (Linux)."""
    try:
        if reset:
            Path("/proc/self/clear_refs").write_text("5", "ascii")
        line = next(row for row in Path("/proc/self/status").read_text().splitlines() if row.startswith("VmHWM"))
        return float(line.split()[1]) / 1024.0
    except OSError:
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


if __name__ == "__main__":
    print(json.dumps(measure(Task(**json.loads(sys.stdin.read())))))
