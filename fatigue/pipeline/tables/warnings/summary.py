"""The warnings of a job in few lines, however many welds it has: nothing is lost, little is said twice.

Of one kind the first stand in full. Of the others, which say the same of other welds, the places are kept, and one
warning at the end lists them.
"""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field

from fatigue.errors import Problem

MOST_IN_FULL = 20  # warnings of one code

_OF_A_WELD = ": weld "  # between file and weld in the place of a warning


@dataclass(slots=True, eq=False)
class WarningSummary:
    """The warnings of a job, in the order in which they come.

    ``in_full`` are the first ``MOST_IN_FULL`` of each code; ``counts`` says how many there are of each code in all;
    ``places`` names the places of the others, by code and by what they begin with, the file as a rule.
    """

    in_full: list[Problem] = field(default_factory=list)
    counts: Counter[str] = field(default_factory=Counter)
    places: dict[str, dict[str, list[str]]] = field(default_factory=dict)

    def add(self, warnings: Iterable[Problem]) -> None:
        """Take warnings in; what is kept of most of them is the name of a weld."""
        for warning in warnings:
            self.counts[warning.code] += 1
            if self.counts[warning.code] <= MOST_IN_FULL:
                self.in_full.append(warning)
            else:
                begin, name = _parts(warning.where)
                names = self.places.setdefault(warning.code, {}).setdefault(begin, [])
                if names[-1:] != [name]:  # a weld of several parts is named once
                    names.append(name)

    def listed(self) -> tuple[Problem, ...]:
        """The warnings in full, as they came, then one for the others of each code."""
        summed = (_sum(code, self.counts[code] - MOST_IN_FULL, places) for code, places in self.places.items())
        return (*self.in_full, *summed)


def _parts(where: str) -> tuple[str, str]:
    """A place in two, behind what many have in common: ``nodes.csv: weld`` and the weld, or the file and the rest."""
    for mark in (_OF_A_WELD, ": "):
        begin, found, name = where.partition(mark)
        if found:
            return begin + found, name
    return "", where


def _sum(code: str, count: int, places: dict[str, list[str]]) -> Problem:
    """One warning for those of one code, with their places."""
    where = "; ".join(begin + ", ".join(names) for begin, names in places.items())
    what = f"{count} more of this kind, the first {MOST_IN_FULL} are listed one by one"
    return Problem(code, where, what, "Do what is said of those", count)
