"""What a NASTRAN deck holds that its model does not: counted while reading, told in warnings."""

from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from fatigue.errors import Problem
from fatigue.readers.foreign.nastran.deck.lines import place

_SHELL_NAMES = ("CQUAD", "CTRIA", "CSHEAR", "CSHELL", "CQAUD", "CTIRA")
"""Beginnings of names of flat elements, misspelt ones among them."""


@dataclass(slots=True)
class LeftOut:
    """Cards nobody asked for: how many there are of each name, and the place of the first.

    ``unread`` is the number of lines with text in columns 73 to 80 that is no continuation mark, or beyond.
    """

    count: dict[str, int] = field(default_factory=dict)
    first: dict[str, str] = field(default_factory=dict)
    unread: int = 0
    first_unread: str = ""

    def add(self, name: str, source: str, number: int) -> None:
        """Count one more."""
        if name in self.count:
            self.count[name] += 1
        else:
            self.count[name], self.first[name] = 1, place(source, number)

    def warnings(self, source: str) -> list[Problem]:
        """Tell what was left out of the deck ``source``, each kind with its number and its first place."""
        warnings = []
        if self.unread:
            what = f"{self.unread} lines hold text behind column 72 that is no continuation mark; it is not read"
            warnings.append(
                Problem("unread_text", self.first_unread, what, "Nothing to do if it is no data", self.unread)
            )
        shells = [name for name in sorted(self.count) if name.startswith(_SHELL_NAMES)]
        if shells:
            listed = ", ".join(f"{self.count[name]} {name}" for name in shells)
            what = f"cards that may be shells are not read: {listed}; no weld is found at them"
            remedy = "Write plates as CQUAD4, CTRIA3 and the like; nothing to do for other elements"
            warnings.append(Problem("unread_shells", self.first[shells[0]], what, remedy, len(shells)))
        pyramids = [name for name in ("CPYRAM", "CPYRA") if name in self.count]
        if pyramids:
            what = f"{self.count[pyramids[0]]} {pyramids[0]} are not read: solids beside them look like a surface there"
            remedy = "Exclude lines that are found beside them; nothing to do if there are none"
            warnings.append(Problem("unread_solids", self.first[pyramids[0]], what, remedy, self.count[pyramids[0]]))
        if self.count:
            folder = f"{Path(source).parent}/"
            listed = ", ".join(
                f"{n} {name} ({self.first[name].removeprefix(f'{source}, ').removeprefix(folder)})"
                for name, n in sorted(self.count.items())
            )
            what = f"cards that weld lines do not need are left out, number, name and first place: {listed}"
            remedy = "Nothing to do, unless a name is misspelt"
            warnings.append(Problem("cards_left_out", source, what, remedy, sum(self.count.values())))
        return warnings


@dataclass(slots=True)
class Twice:
    """Cards of one id that stand in the deck again with equal content, and the first of them."""

    count: Counter[str] = field(default_factory=Counter)
    first: tuple[str, str] = ("", "")

    def add(self, name: str, number: str, where: str) -> None:
        """Count one more."""
        self.first = self.first if self.count else (f"{name} {number}", where)
        self.count[name] += 1

    def warnings(self) -> list[Problem]:
        """Tell how many there are, by name."""
        if not self.count:
            return []
        first, where = self.first
        listed = ", ".join(f"{n} {name}" for name, n in self.count.items())
        what = f"{listed} stand again with equal content, {first} the first; each is taken once"
        return [Problem("twice", where, what, "Nothing to do", self.count.total())]
