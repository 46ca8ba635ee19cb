"""Spoil the package in small ways and say what the tests do not notice.

``python -m tests.mutation --rooms weld life --sample 40 --seed 1``: a sample of each room, drawn with the seed. A
mutant is killed where a test of the same room fails, or hangs. ``--at fatigue/weld/mesh.py:40`` tries every mutant of
a line.
"""

import argparse
import difflib
import math
import os
import random
import sys
import tempfile
import time
import tomllib
from collections import Counter
from itertools import chain
from pathlib import Path

from tests.mutation.mutants import Mutant, defaults_of, mutants
from tests.mutation.tree import ROOT, Tree, copy_of_tree, files_by_line, reaching, sound_nearby, stages, tried

ROOMS = ("weld", "life", "spectrum", "case", "results", "readers")
EQUIVALENTS = Path(__file__).with_name("equivalents.toml")


def main() -> int:
    """Try a sample, print every verdict, the survivors and the score of each room; exit code 1 if one survived."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutation", description=__doc__)
    parser.add_argument("--rooms", nargs="+", default=list(ROOMS), choices=ROOMS, help="rooms of the package")
    parser.add_argument("--sample", type=int, default=40, help="mutants of each room")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--first", type=int, default=0, help="number of the first one within the sample of a room")
    parser.add_argument(
        "--at", nargs="+", default=[], help="FILE or FILE:LINE, all mutants there, in place of a sample"
    )
    parser.add_argument("--near", action="store_true", help="only tests that import the module: a lower bound")
    parser.add_argument("--list", action="store_true", help="print the mutants and try none")
    parser.add_argument("--silent-s", type=float, default=180, help="seconds without a word that mean a hang")
    parser.add_argument("--tree", type=Path, help="folder of the copy, kept for the next run with its machine code")
    asked = parser.parse_args()
    by_room = _at(asked.at) if asked.at else {r: _sample(r, asked.seed, asked.first, asked.sample) for r in asked.rooms}
    if asked.list:
        print("\n".join(_told(mutant) for chosen in by_room.values() for mutant in chosen))
        return 0
    os.nice(10)
    with tempfile.TemporaryDirectory(prefix="mutation-") as name:
        tree = copy_of_tree(asked.tree or Path(name))
        found = {room: _survivors(tree, room, chosen, asked) for room, chosen in by_room.items()}
    for mutant in chain.from_iterable(survivors for survivors, _ in found.values()):
        print("\n" + _diff(mutant))
    print()
    for room, (survivors, count) in found.items():
        print(score(room, count - len(survivors), count))
    return int(any(survivors for survivors, _ in found.values()))


def equivalents() -> dict[tuple[str, str, str, str], str]:
    """The reason why a mutant is as good as the sound program, by its key; ``after`` is empty for all of a line."""
    rows = tomllib.loads(EQUIVALENTS.read_text()).get("equivalent", [])
    return {(r["module"], r["function"], r["before"], r.get("after", "")): r["reason"] for r in rows}


def every_mutant(room: str) -> list[Mutant]:
    """All mutants of a room but those that are equivalent."""
    files = sorted((ROOT / "fatigue" / room).rglob("*.py"))
    defaults = defaults_of(sorted((ROOT / "fatigue").rglob("*.py")))
    known = equivalents()
    found = [m for path in files for m in mutants(path.read_text(), str(path.relative_to(ROOT)), defaults)]
    keys = {key for mutant in found for key in (mutant.key, (*mutant.key[:3], ""))}
    for key in known:
        if key[0].startswith(f"fatigue/{room}/") and key not in keys:
            print(f"{EQUIVALENTS.name}: no mutant any more: {key[0]} {key[1]} {key[2]}", file=sys.stderr)
    return [mutant for mutant in found if mutant.key not in known and (*mutant.key[:3], "") not in known]


def score(room: str, killed: int, of: int) -> str:
    """Share of mutants killed, with the bounds that it has with 95 % (Wilson, JASA 22, 1927)."""
    share, z2 = killed / max(of, 1), 1.96**2
    middle = (share + z2 / (2 * of)) / (1 + z2 / of) if of else 0.5
    half = 1.96 * math.sqrt(share * (1 - share) / of + z2 / (4 * of * of)) / (1 + z2 / of) if of else 0.5
    return f"{room}: {killed} of {of} killed, {share:.1%} ({middle - half:.1%} to {middle + half:.1%})"


def _sample(room: str, seed: int, first: int, count: int) -> list[Mutant]:
    found = every_mutant(room)
    return random.Random(seed).sample(found, len(found))[first : first + count]


def _at(places: list[str]) -> dict[str, list[Mutant]]:
    """Give the mutants of some places, by room."""
    chosen: dict[str, list[Mutant]] = {}
    for place in places:
        path, _, line = place.partition(":")
        room = Path(path).parts[1]
        here = [m for m in every_mutant(room) if m.module == path and line in ("", str(m.line))]
        chosen[room] = [*chosen.get(room, []), *here]
    return chosen


def _survivors(tree: Tree, room: str, chosen: list[Mutant], asked: argparse.Namespace) -> tuple[list[Mutant], int]:
    """Give what the tests of a room do not notice, and how many were tried; every verdict is printed as it falls.

    Who interrupts the program gets what was found until then.
    """
    silent_s: float = asked.silent_s
    reached = {} if asked.near else files_by_line(tree, room, silent_s)
    kinds: Counter[str] = Counter()
    survivors = []
    for mutant in chosen:
        try:
            if asked.near:
                selection = sound_nearby(tree, mutant.module, silent_s)
            else:
                files = reaching(tree.root / mutant.module, mutant.line, reached.get(mutant.module, {}))
                selection = stages(tree.root, mutant.module, files)
            started = time.monotonic()
            verdict = tried(tree, mutant, selection, silent_s)
        except KeyboardInterrupt:
            break
        kinds[verdict] += 1
        print(f"{verdict:8} {time.monotonic() - started:5.0f} s  {_told(mutant)}", flush=True)
        if verdict == "survived":
            survivors.append(mutant)
    print(f"{room}: " + ", ".join(f"{kind} {count}" for kind, count in kinds.most_common()), flush=True)
    return survivors, kinds.total()


def _told(mutant: Mutant) -> str:
    place = f"{mutant.module}:{mutant.line}"
    return f"{place} {mutant.function}  [{mutant.before}]  ->  [{mutant.after}]"


def _diff(mutant: Mutant) -> str:
    sound = (ROOT / mutant.module).read_text().splitlines()
    name = f"{mutant.module} {mutant.function}".rstrip()
    return "\n".join(difflib.unified_diff(sound, mutant.text.splitlines(), name, "survived", n=2, lineterm=""))


if __name__ == "__main__":
    sys.exit(main())
