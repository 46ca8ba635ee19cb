"""What only a fresh process shows: start-up, first compilation, peak memory."""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from benchmarks.timing import Row

_PEAK = "import resource; print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)"  # Linux: kB
_RATIO = """
import time
from threadpoolctl import threadpool_limits
from benchmarks.load import load
from benchmarks.timing import best_times

case = load(512)
with threadpool_limits(1, user_api="blas"):
    best = best_times({"product": case.product, "single": case.count_single}, 8, time.process_time)
print(f"{best['single'] / best['product']:.2f}")
"""
_WITHOUT_VECTORS = """
import importlib.util

find_spec = importlib.util.find_spec
importlib.util.find_spec = lambda name, package=None: None if "kernels.simd" in name else find_spec(name, package)
"""
# A processor is a name and its features, for numba, and a kernel of BLAS. The name alone leaves numba the features of
# the processor at hand. Vectors of 128 bits are what arm64 has: there is no other way to ask for them here.
_AVX2 = {
    "NUMBA_CPU_NAME": "haswell",
    "NUMBA_CPU_FEATURES": "+avx,+avx2,+bmi,+bmi2,+fma,+lzcnt,+popcnt",
    "OPENBLAS_CORETYPE": "Haswell",
}
_128_BITS = {
    "NUMBA_CPU_NAME": "nehalem",
    "NUMBA_CPU_FEATURES": "+popcnt,+sse4.1,+sse4.2",
    "OPENBLAS_CORETYPE": "Nehalem",
}
_COUNT = "from benchmarks.load import load; case = load({nodes}, 60, {steps}); case.count_single()"


def start_up() -> list[Row]:
    """Wall time of the command line against that of a bare Python."""
    bare = _seconds(["-c", "pass"])
    command = _seconds(["-m", "fatigue", "--help"])
    with tempfile.TemporaryDirectory() as folder:
        case, result = Path(folder) / "case", Path(folder) / "result"
        _run(["-m", "fatigue", "synth", str(case), "--nodes", "30", "--modes", "6", "--seconds", "10"])
        _run(["-m", "fatigue", "-q", "assess", str(case / "case.toml"), "-o", str(result)], expected=(0, 1))
        show = _seconds(["-m", "fatigue", "show", str(result)])
    return [
        ("fatigue --help", f"{command:.2f} s, bare Python {bare:.2f} s"),
        ("fatigue show, a small result", f"{show:.2f} s"),
    ]


def processors() -> list[Row]:
    """The pipeline over the float64 product of the same stresses, both as on other processors, in processor time."""
    what = "single precision pipeline / product, 60 modes x 20 000 steps"
    kinds: dict[str, tuple[str, dict[str, str]]] = {
        "this processor": ("", {}),
        "AVX2": ("", _AVX2),
        "plain loops, this processor": (_WITHOUT_VECTORS, {}),
        "plain loops, AVX2": (_WITHOUT_VECTORS, _AVX2),
        "plain loops, vectors of 128 bits": (_WITHOUT_VECTORS, _128_BITS),
    }
    rows = []
    for name, (before, environment) in kinds.items():
        with tempfile.TemporaryDirectory() as empty:
            ratio = _run(["-c", before + _RATIO], NUMBA_CACHE_DIR=empty, **environment)
        rows.append((f"{what}, {name}", ratio.strip()))
    return rows


def first_run() -> list[Row]:
    """Compiling what the shipped example needs, and both counters, with an empty cache."""
    counters = "from benchmarks.load import load; case = load(8, 4, 600); case.count_single(); case.count_double()"
    with tempfile.TemporaryDirectory() as folder:
        example = ["-m", "fatigue", "-q", "assess", "data/carbody/case.toml", "-o", f"{folder}/result", "--exit-zero"]
        jobs = {"the example with its report": example, "both counters, single and double": ["-c", counters]}
        rows = []
        for name, arguments in jobs.items():
            empty = f"{folder}/{len(rows)}"
            cold, *warm = (_processor_time(arguments, NUMBA_CACHE_DIR=empty) for _ in range(3))
            rows.append((f"compilation at the first run, {name}", f"{cold - min(warm):.1f} s of processor time"))
    return rows


def memory() -> list[Row]:
    """Peak of a process that draws a load and counts it, above importing and above its inputs."""
    bare = _peak("import benchmarks.load")
    rows = []
    for nodes, steps in ((256, 20_000), (2560, 20_000), (256, 200_000)):
        inputs = (2 * 60 * nodes * 8 + 60 * steps * (4 + 8)) / 2**20
        above = _peak(_COUNT.format(nodes=nodes, steps=steps)) - bare - inputs
        rows.append((f"peak memory above import and inputs, {nodes} nodes x {steps} steps", f"{above:.0f} MB"))
    return rows


def _seconds(arguments: list[str], rounds: int = 5, **environment: str) -> float:
    best = float("inf")
    for _ in range(rounds):
        start = time.perf_counter()
        _run(arguments, **environment)
        best = min(best, time.perf_counter() - start)
    return best


def _processor_time(arguments: list[str], **environment: str) -> float:
    """User and system time of a process [s]."""
    before = os.times()
    _run(arguments, **environment)
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system


def _peak(code: str) -> float:
    return float(_run(["-c", f"{code}\n{_PEAK}"]).split()[-1])


def _run(arguments: list[str], expected: tuple[int, ...] = (0,), **environment: str) -> str:
    root = Path(__file__).parents[1]
    command = [sys.executable, *arguments]
    done = subprocess.run(command, cwd=root, env=os.environ | environment, check=False, capture_output=True, text=True)
    if done.returncode not in expected:
        raise subprocess.CalledProcessError(done.returncode, command, done.stdout, done.stderr)
    return done.stdout
