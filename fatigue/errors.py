"""What went wrong, as data: every refusal and every warning names place, value and remedy."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from numbers import Integral
from os import PathLike, fsencode, fspath
from pathlib import Path
from typing import ClassVar

from fatigue.shown import visible


@dataclass(frozen=True, slots=True)
class Problem:
    """One mistake or one warning, in words for the person who can mend it.

    ``where`` is the file and the place in it, ``what`` the finding with its value, ``remedy`` what to do
    (an imperative without a full stop); ``code`` names the kind of problem for machines. One that sums up others has
    their number as its ``count``.
    """

    code: str
    where: str
    what: str
    remedy: str
    count: int = 1

    def __str__(self) -> str:
        """One line: place, finding and remedy, what cannot be seen in them spelled out."""
        return visible(f"{self.where}: {self.what}. {self.remedy}.")


class FatigueError(Exception):
    """A refusal the user can act on; holds all the problems found, never only the first."""

    exit_code: ClassVar[int] = 1

    def __init__(self, *problems: Problem) -> None:
        super().__init__(*problems)
        self.problems = problems

    def __str__(self) -> str:
        """One line for each problem."""
        return "\n".join(str(problem) for problem in self.problems)


class CaseError(FatigueError):
    """The case file is wrong or contradicts itself."""

    exit_code: ClassVar[int] = 3


class DataError(FatigueError):
    """An input file is missing, damaged, incomplete or contradicts another."""

    exit_code: ClassVar[int] = 3


class NumericalError(FatigueError):
    """A computation lost its footing although the inputs were valid."""

    exit_code: ClassVar[int] = 4


def refuse(error: type[FatigueError], problems: Iterable[Problem]) -> None:
    """Raise ``error`` with all ``problems`` if there are any."""
    if found := tuple(problems):
        raise error(*found)


def no_threads(threads: int | None) -> Iterator[Problem]:
    """Refusal of what is no number of threads; None is one for each processor core."""
    if threads is not None and not (isinstance(threads, Integral) and threads >= 1):
        yield Problem("bad_threads", "threads", f"{threads!r} is no number of threads", "Give 1 or more")


def given_path(given: Path | str, argument: str) -> Path:
    """Path that a caller gives as text or as a path.

    Raises
    ------
    CaseError : anything else, or text that no file can have as its name
    """
    what = ""
    if not isinstance(given, str | PathLike) or (isinstance(given, PathLike) and not isinstance(fspath(given), str)):
        what = f"{type(given).__name__} is no path"
    elif "\0" in fspath(given) or not _is_encodable(fspath(given)):
        what = f"{fspath(given)!r} holds a character that no path can have"
    if what:
        raise CaseError(Problem("argument", argument, what, "Give a path, as text or as pathlib.Path"))
    return Path(given)


def given_names(given: str | Sequence[str], argument: str) -> tuple[str, ...]:
    """Names that a caller gives, one or several.

    Raises
    ------
    CaseError : anything else
    """
    names = (given,) if isinstance(given, str) else given
    if not isinstance(names, Iterable) or isinstance(names, bytes) or not all(isinstance(n, str) for n in names):
        raise CaseError(Problem("argument", argument, f"{given!r} is no list of names", "Give texts"))
    return tuple(names)


def _is_encodable(text: str) -> bool:
    try:
        fsencode(text)
    except UnicodeEncodeError:
        return False
    return True
