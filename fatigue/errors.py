"""What went wrong, as data: every refusal and every warning names place, value and remedy."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar


@dataclass(frozen=True, slots=True)
class Problem:
    """One mistake or one doubt, in words for the person who can mend it.

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
        """One line: place, finding and remedy."""
        return f"{self.where}: {self.what}. {self.remedy}."


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
