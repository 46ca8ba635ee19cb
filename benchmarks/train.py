"""A train on this machine: ``python -m benchmarks.train [nodes] [events] [way ...]`` writes a case and assesses it.

Six cars have about 1.2 million weld nodes; with 100 modes and 12 events of 60 s at 500 Hz that is 8.6e11 stress
samples, each of them counted as it is (``upsample = 1``; ``auto`` doubles the records). The case takes about 1 GB of
disk per 250 000 nodes, the result three times as much. The ways are ``likely``, ``screened`` and ``exact``.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from fatigue.synth import Size, synthesize

MODES, SECONDS, RATE = 100, 60.0, 500.0
AS_SAMPLED = "[counting]\nupsample = 1"
_RUN = """
import resource, sys
from fatigue.cli import main
code = 0
try:
    main()
except SystemExit as done:
    code = done.code
used = resource.getrusage(resource.RUSAGE_SELF)
print(code, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024, file=sys.stderr)  # Linux: kB
"""
_BARE = "import fatigue.assess, pandas, resource; print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)"


def run_measured(case: Path, result: Path, *options: str) -> tuple[float, float]:
    """Processor time [s] and peak memory [MB] of an assessment in a process of its own, tables only."""
    command = [sys.executable, "-c", _RUN, "-q", "assess", str(case), "-o", str(result), "--no-report", *options]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    code, cpu, peak = done.stderr.split()[-3:]
    if code not in {"0", "1", "None"}:
        raise SystemExit(done.stderr)
    return float(cpu), float(peak)


def measure(nodes: int, events: int, folder: Path, *options: str) -> dict[str, float]:
    """Assess a synthetic case in a process of its own; give times [s], memory [MB] and what settled its stations."""
    path = synthesize(folder / "case", Size(nodes, MODES, events, SECONDS, RATE))
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("[mission]\n", f"{AS_SAMPLED}\n[mission]\n", 1), encoding="utf-8")
    result = folder / "result"
    start = time.perf_counter()
    cpu, peak = run_measured(path, result, *options)
    wall = time.perf_counter() - start
    bare = float(subprocess.run([sys.executable, "-c", _BARE], check=True, capture_output=True, text=True).stdout)
    inputs = MODES * SECONDS * RATE * events * 4 / 2**20
    settled = json.loads((result / "provenance.json").read_text())["rules"]["screening"]["stations"]
    samples = 2 * nodes * SECONDS * RATE * events
    return {
        "stress samples": samples,
        "wall s": wall,
        "cpu s": cpu,
        "ns of cpu per stress sample": 1e9 * cpu / samples,
        "peak MB": peak,
        "peak above bare import and histories MB": peak - bare - inputs,
        **{f"stations: {tier}": float(count) for tier, count in settled.items()},
    }


def main() -> None:
    """Measure one size: likely worst points, screened with proof, and with every point counted."""
    nodes = int(sys.argv[1]) if len(sys.argv) > 1 else 20_000
    events = int(sys.argv[2]) if len(sys.argv) > 2 else 12
    print(f"{nodes} nodes, {MODES} modes, {events} events of {SECONDS:g} s at {RATE:g} Hz; {os.cpu_count()} cores")
    ways = {
        "likely": ["--likely-worst", "--screen", "0.1"],
        "screened": ["--screen", "0.1"],
        "exact": ["--exact"],
    }
    for name in sys.argv[3:] or ways:
        options = ways[name]
        with tempfile.TemporaryDirectory() as folder:
            for what, value in measure(nodes, events, Path(folder), *options).items():
                print(f"| {name} | {what} | {value:.4g} |")


if __name__ == "__main__":
    main()
