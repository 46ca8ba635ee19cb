"""What `fatigue check` foretells against what `fatigue assess` takes: ``python -m benchmarks.estimate [case ...]``.

Processor time of all threads, because others may load the machine; everything is compiled before. Memory is ``VmHWM``
of the kernel, pages of mapped files included. The constants of `fatigue.pipeline.forecast` come from here.
"""

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from fatigue.example import write_example
from fatigue.synth import Size, synthesize

SIZES = {  # size, upsampling, options
    "30 nodes": (Size(30, 6, 3, 10.0), "1", ()),
    "2000 nodes": (Size(2000), "1", ()),
    "300 nodes, upsampled 8 times": (Size(300, 30, 3, 60.0), "8", ()),
    "60 nodes, upsampled 64 times": (Size(60, 10, 2, 60.0), "64", ()),
    "24 nodes, 1 mode, 1e7 samples": (Size(24, 1, 1, 40_000.0), "1", ()),
    "100 nodes, 60 modes, 40 events": (Size(100, 60, 40, 60.0), "1", ()),
    "10 000 nodes, 30 modes, 1 event": (Size(10_000, 30, 1, 20.0), "1", ()),
    "3000 nodes, 40 modes, --screen 0.1": (Size(3000, 40, 3, 60.0), "1", ("--screen", "0.1")),
    "10 000 nodes, 100 modes, 12 events at 500 Hz": (Size(10_000, 100, 12, rate=500.0), "1", ()),
}
_RUN = """
import re, resource, sys
from fatigue.cli import main
try:
    main()
except SystemExit:
    pass
used = resource.getrusage(resource.RUSAGE_SELF)
top = int(re.search(r"VmHWM:\\s+(\\d+)", open("/proc/self/status").read())[1])
print(f"measured {used.ru_utime + used.ru_stime} {top * 1024}", file=sys.stderr)
"""


def main() -> None:
    """Print a row for each size: foretold, taken, and their ratio."""
    parser = argparse.ArgumentParser()
    parser.add_argument("case", nargs="*", help="parts of names: shipped, " + ", ".join(SIZES))
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    given = parser.parse_args()
    print(f"{os.cpu_count()} cores, {given.threads} threads")
    print("| case | s by check | s by assess | s taken | ratio | MB foretold | MB taken | ratio |")
    print("|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        for name in ("shipped example", *SIZES):
            if given.case and not any(part in name for part in given.case):
                continue
            case, options = _written(folder / name.replace(" ", "_"), name)
            record = json.loads(_run("check", str(case), "--json")[0])
            result = folder / "result"
            threads = ("--threads", str(given.threads))
            _, taken, memory = _run("assess", str(case), "-o", str(result), "--force", *threads, *options)
            log = (result / "fatigue.log").read_text()
            first = re.findall(r"of disk is expected, and (\d+) s", log)[-1]
            at_first = re.findall(r"about ([\d.]+ [MG]B) of memory", log)[-1]
            foretold = 1e-6 * float(at_first.split()[0]) * (1e6 if at_first.endswith("MB") else 1e9)
            seconds = record["estimated_s"]
            ratios = f"{seconds / taken:.2f}, {float(first) / taken:.2f}"
            print(
                f"| {name} | {seconds:.1f} | {first} | {taken:.1f} | {ratios} | "
                f"{record['estimated_memory_MB']:.0f}, {foretold:.0f} | {memory / 1e6:.0f} | "
                f"{1e6 * foretold / memory:.2f} |",
                flush=True,
            )


def _written(folder: Path, name: str) -> tuple[Path, tuple[str, ...]]:
    """Case of a name, and the options it is assessed with."""
    if name not in SIZES:
        return write_example(folder)[0], ()
    size, upsample, options = SIZES[name]
    case = synthesize(folder, size)
    case.write_text(case.read_text().replace("[mission]", f"[counting]\nupsample = {upsample}\n[mission]"))
    return case, options


def _run(*arguments: str) -> tuple[str, float, float]:
    """Run the program in a process of its own; give what it prints, its processor time [s] and its peak [bytes]."""
    command = [sys.executable, "-c", _RUN, "-q", *arguments]
    done = subprocess.run(command, check=True, capture_output=True, text=True, cwd=Path(__file__).parents[1])
    found = re.search(r"measured ([0-9.]+) (\d+)", done.stderr)
    assert found is not None, done.stderr
    return done.stdout, float(found[1]), float(found[2])


if __name__ == "__main__":
    main()
