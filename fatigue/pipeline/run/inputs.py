"""Whether the input files of a run are still those that it began with.

A run reads forces and records while it goes on, so a file that is replaced meanwhile would make a result of neither the
old one nor the new one. What the file system says of every file is noted before anything is read, and compared before
the result is put in place; only a file of which it says something else is hashed again. One that was merely touched, or
replaced by an equal one, is as good as before.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias, TypeVar

from fatigue.case import Case
from fatigue.errors import DataError, Problem, refuse
from fatigue.files.hashes import sha256
from fatigue.pipeline.run.work import input_paths, inputs_of
from fatigue.side_by_side import meanwhile

Found = TypeVar("Found")
Stamp: TypeAlias = tuple[int, ...] | None  # size, times of content and of status, device and number; None: not there

TRIES = 3  # of reading inputs that change while they are read
REMEDY = "Put the file back as it was to go on from here, or give the same command again to use the new one"


@dataclass(frozen=True, slots=True, eq=False)
class Inputs:
    """The inputs of a run: their names and hashes, and what the file system said of each before they were read."""

    case: Case
    register: Sequence[dict[str, Any]]
    stamps: Mapping[Path, Stamp]

    def refuse_replaced(self) -> None:
        """Refuse inputs that are other files by now.

        Raises
        ------
        DataError : all inputs that were changed, taken away or added since the run began
        """
        refuse(DataError, self._replaced())

    @contextmanager
    def unchanged(self) -> Iterator[None]:
        """Take a failure for what it is where an input was replaced: half of the old file and half of the new one.

        Raises
        ------
        DataError : something failed, and there are inputs that changed; their names
        """
        try:
            yield
        except Exception as error:
            if replaced := list(self._replaced()):
                raise DataError(*replaced) from error
            raise

    def _replaced(self) -> Iterator[Problem]:
        root = self.case.path.parent
        known = {root / entry["file"]: entry["sha256"] for entry in self.register}
        now = stamps_of(self.case)
        for path in sorted({*self.stamps, *now}):
            stamp = now[path] if path in now else _stamp(path)
            if path in self.stamps and stamp == self.stamps[path]:
                continue
            if stamp is None:
                yield Problem("changed_input", str(path), "was taken away while the run was going on", REMEDY)
            elif path not in self.stamps:
                what = "came while the run was going on, which began without it"
                yield Problem("changed_input", str(path), what, "Give the same command again, or take the file away")
            elif sha256(path) != known.get(path):
                yield Problem("changed_input", str(path), "was replaced while the run was going on", REMEDY)


def with_inputs(case: Case, read: Callable[[], Found]) -> tuple[Found, Inputs]:
    """What is read of the inputs of a case, and the inputs, which did not change while they were read and hashed.

    Raises
    ------
    DataError : the case file is no longer the one that ``case`` was read from, or the inputs do not come to rest;
        whatever ``read`` raises
    """
    for _ in range(TRIES):
        stamps = stamps_of(case)
        hashed = meanwhile(partial(inputs_of, case))
        found = read()
        register = hashed()
        if stamps_of(case) == stamps:
            refuse(DataError, _edited(case))
            return found, Inputs(case, register, stamps)
    what, remedy = "is being written while it is read", "Give the same command again when it is done"
    changing = sorted(path for path, stamp in stamps_of(case).items() if stamp != stamps.get(path))
    raise DataError(*(Problem("changed_input", str(path), what, remedy) for path in changing))


def stamps_of(case: Case) -> dict[Path, Stamp]:
    """What the file system says of every input of a case, behind links to them."""
    return {path: _stamp(path) for path in input_paths(case)}


def _stamp(path: Path) -> Stamp:
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_size, found.st_mtime_ns, found.st_ctime_ns, found.st_dev, found.st_ino


def _edited(case: Case) -> Iterator[Problem]:
    """Refusal of a case whose file has another text by now than the one it was read from."""
    if case.path.read_bytes().decode("utf-8-sig", errors="replace") != case.text:
        what = "was changed since it was read"
        yield Problem("changed_input", str(case.path), what, "Give the same command again")
