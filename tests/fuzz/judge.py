"""Reads a damaged file and compares what came out with what the sound one holds."""

import random
import shutil
import signal
import traceback
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import FrameType

import numpy as np

from fatigue.errors import FatigueError, Problem
from tests.fuzz.sources import Columns, Source

SECONDS = 20  # that reading one of these small files may take on a busy machine
FINDINGS = ("traceback", "hang", "warning", "message", "nan", "structure")
"""Outcomes that must not be."""


@dataclass(frozen=True)
class Sound:
    """What a sound file gives, and the warnings that come with it."""

    columns: Columns
    warned: frozenset[str]


@dataclass(frozen=True)
class Outcome:
    """What became of one damaged file: one of ``FINDINGS``, or refused, warned, same, values, ids, fewer, more."""

    number: int
    source: str
    damage: str
    kind: str
    detail: str = ""


class Hang(Exception):
    """Reading took too long."""


def sound(source: Source, folder: Path) -> Sound:
    """Read the sound file."""
    columns, told = source.read(_written(source, source.files[source.file], folder))
    return Sound(columns, _codes(told))


def damaged(source: Source, seed: int, number: int) -> tuple[str, bytes]:
    """Damage a file, by the same number always in the same way, once or twice."""
    rng = random.Random(f"{seed} {number} {source.name}")
    data, names = source.files[source.file], []
    for _ in range(rng.choice((1, 1, 1, 2))):
        kind = rng.choice(source.kinds)
        data = kind(data, rng) or b"\n"
        names.append(kind.__name__)
    return "+".join(names), data


def judged(source: Source, expected: Sound, seed: int, number: int, folder: Path) -> Outcome:
    """Damage, read and compare one file."""
    name, data = damaged(source, seed, number)
    path = _written(source, data, folder)
    kind, detail = _read(source, expected, name, path)
    if kind != "same" and data == source.files[source.file]:
        kind, detail = ("same", "") if kind in ("refused", "warned") else (kind, detail)
    return Outcome(number, source.name, name, kind, detail)


def _read(source: Source, expected: Sound, name: str, path: Path) -> tuple[str, str]:
    with warnings.catch_warnings(record=True) as raised, _time_limit():
        warnings.simplefilter("always")
        try:
            columns, told = source.read(path)
        except FatigueError as error:
            kind, detail = _refused(error)
        except Hang:
            kind, detail = "hang", traceback.format_exc()[-600:]
        except Exception:
            kind, detail = "traceback", traceback.format_exc()[-900:]
        else:
            kind, detail = _silent(source, expected, name, columns, _codes(told))
    if raised and kind not in ("hang", "traceback"):
        return "warning", f"{raised[0].filename}:{raised[0].lineno} {raised[0].message}"
    return kind, detail


def _refused(error: FatigueError) -> tuple[str, str]:
    """Check that a refusal is one line for each problem, with a finding and a remedy."""
    bad = [problem for problem in error.problems if "\n" in str(problem) or not problem.what or not problem.remedy]
    if bad or not error.problems:
        return "message", repr(str(error))[:300]
    return "refused", str(error)[:200]


def _silent(source: Source, expected: Sound, name: str, columns: Columns, warned: frozenset[str]) -> tuple[str, str]:
    """Say whether what was read without a refusal differs, and whether it may."""
    kind, detail = compared(expected.columns, columns)
    if kind != "same" and warned - expected.warned:
        return "warned", detail
    if kind in ("fewer", "more") and (source.structure or not _can_change_counts(name)):
        return "structure", f"{kind}: {detail}"
    return kind, detail


def compared(before: Columns, after: Columns) -> tuple[str, str]:
    """Say how columns differ: nan (a number became none), fewer, more, ids, values, or the same.

    In a column whose name begins with ? a number may be absent.
    """
    if before.keys() != after.keys():
        lost = sorted(before.keys() - after.keys())
        return ("fewer", f"{lost} lost") if lost else ("more", f"{sorted(after.keys() - before.keys())} new")
    found = "same", ""
    for name, old in before.items():
        new = np.asarray(after[name])
        is_number = new.dtype.kind == "f"
        if is_number and not name.startswith("?") and not np.isfinite(new).all() and np.isfinite(old).all():
            return "nan", name
        if new.shape != np.shape(old):
            kind = "fewer" if new.size < np.size(old) else "more"
            return kind, f"{name}: {np.shape(old)} became {new.shape}"
        if not np.array_equal(old, new, equal_nan=is_number):
            if is_number and name.startswith("?") and np.isnan(new).sum() > np.isnan(old).sum():
                return "fewer", f"{name} lost"
            found = ("values" if is_number else "ids"), name
    return found


def _can_change_counts(name: str) -> bool:
    """Whether this damage may lose or add rows that a text cannot miss."""
    return any(kind not in ("number", "flip", "field_changed", "line_joined", "saved_anew") for kind in name.split("+"))


def _codes(told: tuple[Problem, ...]) -> frozenset[str]:
    return frozenset(f"{p.code} {p.what}" for p in told)


def _written(source: Source, data: bytes, folder: Path) -> Path:
    """Write a file and those beside it into an empty folder."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name, content in source.files.items():
        (folder / name).write_bytes(data if name == source.file else content)
    return folder / source.file


@contextmanager
def _time_limit() -> Iterator[None]:
    """Interrupt what takes too long; code that is not Python is caught by whoever watches the process."""

    def stop(_signal: int, _frame: FrameType | None) -> None:
        raise Hang

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, SECONDS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
