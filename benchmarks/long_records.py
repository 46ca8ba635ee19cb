"""Peak memory of every command on long records: ``python -m benchmarks.long_records [case ...] [--keep DIR]``.

Each command runs in a process of its own. ``VmHWM`` of the kernel is the largest resident memory ever; it counts pages
of mapped files, too, which the kernel takes back when somebody needs them. ``RssAnon``, looked at every 5 ms, is what
is the process's own. Both are given above a process that only imports what the commands do. The bound is 500 MB and
the histories as float32.
"""

import argparse
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import pyarrow.parquet as pq
from pyarrow import csv

from fatigue.synth import Size, synthesize

RATE = 250.0
PROMISE = 500.0  # MB above imports and histories
NODES = 24
CASES = {  # modes, samples, format of the history, upsample
    "1 x 2e7": (1, 20_000_000, "parquet", "1"),
    "10 x 2e6": (10, 2_000_000, "parquet", "1"),
    "100 x 2e5": (100, 200_000, "parquet", "1"),
    "1 x 2e7 csv": (1, 20_000_000, "csv", "1"),
    "100 x 2e5 csv": (100, 200_000, "csv", "1"),
    "1 x 2e7 auto": (1, 20_000_000, "parquet", '"auto"'),
    "1 x 5e6 x 4": (1, 5_000_000, "parquet", "4"),
    "10 x 5e5 x 4": (10, 500_000, "parquet", "4"),
    "100 x 5e4 x 4": (100, 50_000, "parquet", "4"),
    "1 x 20000003": (1, 20_000_003, "parquet", "1"),
    "1 x 5000011 x 4": (1, 5_000_011, "parquet", "4"),
}
COMMANDS = {
    "check": ("check", "{case}"),
    "assess": ("assess", "{case}", "-o", "{result}", "--exit-zero", "--no-report", "--threads", "1"),
    "screened": ("assess", "{case}", "-o", "{result}s", "--exit-zero", "--no-report", "--screen", "0.1"),
    "report": ("report", "{result}"),
    "show": ("show", "{result}"),
    "diagnose": ("diagnose", "{result}"),
    "verify": ("verify", "--results", "{result}", "--sample", "2"),
}
_RUN = """
import re, resource, sys, threading, time
own, going = [0], threading.Event()
def look():
    while not going.wait(0.005):
        own[0] = max(own[0], int(re.search(r"RssAnon:\\s+(\\d+)", open("/proc/self/status").read())[1]))
watch = threading.Thread(target=look, daemon=True)
watch.start()
code = 0
if sys.argv[1:] == ["bare"]:
    import fatigue.assess, fatigue.diagnose, fatigue.check, fatigue.verify, pandas, scipy.special, scipy.signal
    time.sleep(0.05)
else:
    from fatigue.cli import main
    try:
        main()
    except SystemExit as done:
        code = done.code or 0
going.set()
watch.join()
status = open("/proc/self/status").read()
used = resource.getrusage(resource.RUSAGE_SELF)
top = int(re.search(r"VmHWM:\\s+(\\d+)", status)[1])
print("measured", code, used.ru_utime + used.ru_stime, top / 1024, own[0] / 1024, file=sys.stderr)
"""


def main() -> None:
    """Print a row for each case and command."""
    parser = argparse.ArgumentParser()
    parser.add_argument("case", nargs="*", help=", ".join(CASES))
    parser.add_argument("--commands", default=",".join(COMMANDS))
    parser.add_argument("--keep", type=Path, help="folder for cases, which are used again")
    given = parser.parse_args()
    _, _, bare_top, bare_own = measured(["bare"])
    print(f"bare import: {bare_top:.0f} MB, {bare_own:.0f} MB of it its own; above it, in MB:")
    print("| record (modes x samples) | histories | command | peak | own | above promise | cpu s |", flush=True)
    print("|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as scratch:
        for name in given.case or CASES:
            modes, samples, *_ = CASES[name]
            folder = (given.keep or Path(scratch)) / name.replace(" ", "_")
            case = written(folder, *CASES[name])
            inputs = 4 * modes * samples / 2**20
            for command in given.commands.split(","):
                words = [word.format(case=case, result=folder / "result") for word in COMMANDS[command]]
                code, cpu, top, own = measured(words)
                if code not in {0, 1}:
                    print(f"| {name} | {inputs:.0f} | {command} | failed with {code} | | | |", flush=True)
                    continue
                above = top - bare_top
                print(
                    f"| {name} | {inputs:.0f} | {command} | {above:.0f} | {own - bare_own:.0f} | "
                    f"{max(0.0, above - inputs - PROMISE):.0f} | {cpu:.0f} |",
                    flush=True,
                )


def measured(words: Sequence[str]) -> tuple[int, float, float, float]:
    """Exit code, processor time [s], peak of resident memory and of what is the process's own [MB] of a command."""
    command = [sys.executable, "-c", _RUN, *(() if list(words) == ["bare"] else ("-q",)), *words]
    done = subprocess.run(command, check=False, capture_output=True, text=True, cwd=Path(__file__).parents[1])
    last = done.stderr.strip().splitlines()[-1].split() if done.stderr.strip() else []
    if not last or last[0] != "measured":
        print(done.stderr[-2000:], file=sys.stderr)
        return done.returncode or 99, 0.0, 0.0, 0.0
    if last[1] not in {"0", "1"}:
        print(done.stderr[-2000:], file=sys.stderr)
    return int(last[1]), *map(float, last[2:])


def written(folder: Path, modes: int, samples: int, kind: str, upsample: str) -> Path:
    """Write a case with few welds and one long record, unless it is there; return its path."""
    path = folder / "case.toml"
    if path.is_file():
        return path
    synthesize(folder, Size(NODES, modes, 1, samples / RATE, RATE))
    record = folder / "q_1.parquet"
    if kind == "csv":
        csv.write_csv(pq.read_table(record), folder / "q_1.csv")
        record.unlink()
    text = path.read_text().replace("q_1.parquet", f"q_1.{kind}")
    path.write_text(text.replace("[mission]", f"[counting]\nupsample = {upsample}\n[mission]"))
    return path


if __name__ == "__main__":
    main()
