"""Damaged result folders: whatever happens to one file, every command says so or gives the right answer."""

import random
import shutil
import traceback
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.diagnose import diagnose
from fatigue.documents import CSV, write_documents
from fatigue.errors import FatigueError
from fatigue.results.outputs import damage_told
from fatigue.results.summary import result_summary
from fatigue.verify.recount import recount
from tests.fuzz import damage
from tests.small_case import sine_only

Damaging = Callable[[Path, random.Random], None]

JSON = ("[]", "null", "{}", "1e999", "[" * 100_000, '{"program": "fatigue"}', '{"program": "fatigue", "outputs": [{}]}')


@dataclass(frozen=True)
class Told:
    """What became of one damage and one command: refused, named, or as if nothing was wrong; else a traceback."""

    file: str
    damage: str
    command: str
    kind: str
    detail: str = ""


def sound_result(folder: Path) -> Path:
    """A small result with diagnosis and CSV files, beside its case."""
    case = sine_only()
    case.weld_nodes = case.weld_nodes[case.weld_nodes.order <= 3]
    case.nodal_forces = case.nodal_forces[case.nodal_forces.node % 100 < 3]
    case.histories["sine"] = case.histories["sine"][:600]
    assess(load_case(case.write(folder / "case")), folder / "result", threads=1, report=False)
    diagnose(folder / "result")
    write_documents(folder / "result", CSV)
    return folder / "result"


def damaged(sound: Path, file: str, kind: str, rng: random.Random, folder: Path) -> Path:
    """Copy of a result and its case in which something happened to one file."""
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(sound.parent, folder)
    KINDS[kind](folder / "result" / file, rng)
    return folder / "result"


def told(folder: Path, file: str, kind: str, expected: dict[str, str]) -> Iterator[Told]:
    """What every command says of a folder; ``expected`` is what it says of the sound one."""
    for command, run in COMMANDS.items():
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            try:
                with damage_told(folder):
                    answer = run(folder)
            except FatigueError as error:
                yield Told(file, kind, command, *_refusal(error))
            except Exception:
                yield Told(file, kind, command, "traceback", traceback.format_exc()[-1500:])
            else:
                same = answer == expected[command]
                yield Told(file, kind, command, "same" if same else "named" if file in answer else "silent", answer)


def _refusal(error: FatigueError) -> tuple[str, str]:
    lines = str(error).splitlines()
    is_clear = error.exit_code == 3 and len(lines) == len(error.problems) and all(p.remedy for p in error.problems)
    return "refused" if is_clear else "message", str(error)


def _show(folder: Path) -> str:
    return result_summary(folder).as_text()


def _report(folder: Path) -> str:
    done = write_documents(folder, CSV, force=True)
    assert not done.problems, done.problems
    return "".join(path.read_text() for path in done.written)


def _diagnose(folder: Path) -> str:
    return diagnose(folder).as_text()


def _verify(folder: Path) -> str:
    found = recount(folder, sample=2)
    return "agrees" if found.passed else found.as_text()


COMMANDS = {"show": _show, "verify": _verify, "report": _report, "diagnose": _diagnose}


def _bytes(kind: damage.Damage) -> Damaging:
    def change(path: Path, rng: random.Random) -> None:
        path.write_bytes(kind(path.read_bytes(), rng))

    return change


def _emptied(path: Path, _rng: random.Random) -> None:
    path.write_bytes(b"")


def _removed(path: Path, _rng: random.Random) -> None:
    path.unlink()


def _directory(path: Path, _rng: random.Random) -> None:
    path.unlink()
    path.mkdir()


def _loop(path: Path, _rng: random.Random) -> None:
    path.unlink()
    path.symlink_to(path.name)


def _json(path: Path, rng: random.Random) -> None:
    path.write_text(rng.choice(JSON))


KINDS: dict[str, Damaging] = {
    **{kind.__name__: _bytes(kind) for kind in damage.BINARY},
    "emptied": _emptied,
    "removed": _removed,
    "directory": _directory,
    "loop": _loop,
    "json": _json,
}
