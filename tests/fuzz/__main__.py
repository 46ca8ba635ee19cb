"""Damage many files and report what must not be: ``python -m tests.fuzz --count 10000 --seed 0``."""

import argparse
import multiprocessing as mp
import resource
import sys
import tempfile
import time
from collections import Counter
from multiprocessing.connection import Connection
from pathlib import Path

from tests.fuzz.judge import FINDINGS, SECONDS, Outcome, damaged, judged, sound
from tests.fuzz.sources import sources

READY = "ready"
MEMORY = 3 << 30  # bytes beyond what the process has when it starts


def main() -> int:
    """Run, print a table of outcomes and every finding; exit code 1 if there is one."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    parser.add_argument("--count", type=int, default=10_000, help="files to damage")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--first", type=int, default=0, help="number of the first file")
    parser.add_argument("--only", type=int, help="damage this number alone, and tell what came of it")
    parser.add_argument("--source", default="", help="only sources whose name contains this text")
    parser.add_argument("--keep", type=Path, help="folder for the file of --only")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="fuzz-") as name:
        folder = Path(name)
        if asked.only is not None:
            return _one(asked.seed, asked.only, folder, asked.keep)
        numbers = range(asked.first, asked.first + asked.count)
        outcomes = list(_watched(asked.seed, numbers, asked.source, folder))
    kinds = Counter(outcome.kind for outcome in outcomes)
    print(f"{len(outcomes)} files, seed {asked.seed}: " + ", ".join(f"{k} {n}" for k, n in kinds.most_common()))
    for source in sorted({outcome.source for outcome in outcomes}):
        of_source = Counter(outcome.kind for outcome in outcomes if outcome.source == source)
        print(f"  {source:26}" + ", ".join(f"{k} {n}" for k, n in of_source.most_common()))
    found = [outcome for outcome in outcomes if outcome.kind in FINDINGS]
    for outcome in found:
        print(f"\n{outcome.kind}: number {outcome.number}, {outcome.source}, {outcome.damage}\n{outcome.detail}")
    return 1 if found else 0


def _one(seed: int, number: int, folder: Path, keep: Path | None) -> int:
    """Damage one file again and tell what came of it."""
    every = sources(folder)
    source = every[number % len(every)]
    outcome = judged(source, sound(source, folder / "sound"), seed, number, folder / "damaged")
    print(f"{outcome.kind}: {outcome.source}, {outcome.damage}\n{outcome.detail}")
    if keep is not None:
        keep.mkdir(parents=True, exist_ok=True)
        for name, content in source.files.items():
            (keep / name).write_bytes(content)
        (keep / source.file).write_bytes(damaged(source, seed, number)[1])
    return int(outcome.kind in FINDINGS)


def _watched(seed: int, numbers: range, only: str, folder: Path) -> list[Outcome]:
    """Work in a process of its own that is ended and begun anew where it crashes or hangs for good."""
    context = mp.get_context("fork")
    outcomes: list[Outcome] = []
    started = time.monotonic()
    names = [source.name for source in sources(folder)]
    todo = [n for n in numbers if only in names[n % len(names)]]
    while todo:
        ours, theirs = context.Pipe(duplex=False)
        worker = context.Process(target=_work, args=(theirs, seed, todo, folder), daemon=True)
        worker.start()
        theirs.close()
        done = 0
        if not (ours.poll(120) and ours.recv() == READY):
            raise SystemExit("a sound file cannot be read")
        try:
            while done < len(todo) and ours.poll(3 * SECONDS):
                outcomes.append(ours.recv())
                done += 1
                if len(outcomes) % 500 == 0:
                    print(f"{len(outcomes)} files, {time.monotonic() - started:.0f} s", file=sys.stderr, flush=True)
        except EOFError:
            pass
        if done < len(todo):
            worker.kill()
            worker.join()
            name = names[todo[done] % len(names)]
            kind = "hang" if worker.exitcode == -9 else "traceback"
            outcomes.append(Outcome(todo[done], name, "?", kind, f"the process ended with {worker.exitcode}"))
            done += 1
        worker.join()
        todo = todo[done:]
    return outcomes


def _work(results: Connection, seed: int, numbers: list[int], folder: Path) -> None:
    """Judge the files of these numbers, each source in turn."""
    in_use = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (in_use + MEMORY, in_use + MEMORY))
    every = sources(folder)
    expected = [sound(source, folder / "sound") for source in every]
    results.send(READY)
    for number in numbers:
        at = number % len(every)
        results.send(judged(every[at], expected[at], seed, number, folder / "damaged"))


if __name__ == "__main__":
    sys.exit(main())
