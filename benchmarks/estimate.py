"""What `fatigue check` foretells against what `fatigue assess` takes: ``python -m benchmarks.estimate [rounds]``.

Processor time of all threads, because others may load the machine; the best of some rounds of each. Everything is
compiled before. The constants of `fatigue.pipeline.run.trial` come from here.
"""

import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from fatigue.example import write_example
from fatigue.synth import Size, synthesize

SIZES = {
    "30 nodes": Size(30, 6, 3, 10.0),
    "2000 nodes": Size(2000),
    "10 000 nodes": Size(10_000),
    "10 000 nodes, 100 modes, 12 events at 500 Hz": Size(10_000, 100, 12, rate=500.0),
}
_RUN = """
import resource, sys
from fatigue.cli import main
try:
    main()
except SystemExit:
    pass
used = resource.getrusage(resource.RUSAGE_SELF)
print(f"cpu {used.ru_utime + used.ru_stime}", file=sys.stderr)
"""


def main() -> None:
    """Print a row for each size: foretold, taken, and their ratio."""
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 2
    print(f"{os.cpu_count()} cores; processor time of the best of {rounds} rounds")
    print("| case | options | foretold s | taken s | foretold / taken |")
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        cases = {"shipped example": write_example(folder / "example")[0]}
        cases |= {name: synthesize(folder / name, size) for name, size in SIZES.items()}
        for name, case in cases.items():
            record = json.loads(_run("check", str(case), "--json")[0])
            ways = {"default": ([], "estimated_s"), "--exact": (["--exact"], "estimated_exact_s")}
            for way, (options, key) in ways.items() if record["estimate"]["screened"] else [*ways.items()][:1]:
                foretold = min(float(json.loads(_run("check", str(case), "--json")[0])[key]) for _ in range(rounds))
                arguments = ("assess", str(case), "-o", str(folder / "result"), "--force", *options)
                taken = min(_run(*arguments)[1] for _ in range(rounds))
                print(f"| {name} | {way} | {foretold:.1f} | {taken:.1f} | {foretold / taken:.2f} |", flush=True)


def _run(*arguments: str) -> tuple[str, float]:
    """Run the program in a process of its own; give what it prints and its processor time [s]."""
    command = [sys.executable, "-c", _RUN, "-q", *arguments]
    done = subprocess.run(command, check=True, capture_output=True, text=True, cwd=Path(__file__).parents[1])
    found = re.search(r"cpu ([0-9.]+)", done.stderr)
    assert found is not None, done.stderr
    return done.stdout, float(found[1])


if __name__ == "__main__":
    main()
