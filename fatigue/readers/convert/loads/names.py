"""What unit loads are called, and what one of each is: from the deck of their subcases, or as the user says."""

import math
import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass

from fatigue.errors import CaseError, Problem
from fatigue.readers.foreign.fe.static_case import StaticCase

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*\Z")
_LONGEST = 40  # characters of a name made of a title


@dataclass(frozen=True, slots=True)
class LoadName:
    """What a static subcase is, in the words of the user: ``1001 tunnel_pressure 5 kPa``.

    Attributes
    ----------
    subcase : its number
    name : of the unit load
    amount : how much of the unit was applied in the subcase
    unit : of the load
    """

    subcase: int
    name: str
    amount: float
    unit: str

    def __post_init__(self) -> None:
        """Refuse what can be no name, amount or unit.

        Raises
        ------
        CaseError : with the subcase
        """
        where = f"--unit-load-name {self.subcase}"
        if not NAME.match(self.name):
            what, remedy = f"{self.name!r} is no name", "A letter comes first, then letters, digits and _"
            raise CaseError(Problem("unit_load_name", where, what, remedy))
        if not math.isfinite(self.amount) or self.amount == 0:
            what = f"{self.amount:g} {self.unit} cannot have been applied"
            raise CaseError(Problem("unit_load_name", where, what, "Give how much of the unit the subcase applies"))
        if not self.unit.strip():
            raise CaseError(Problem("unit_load_name", where, "the unit is empty", "Give it, as in kPa; 1 for a number"))


@dataclass(frozen=True, slots=True)
class UnitLoad:
    """A static subcase that is a load beside the modes.

    Attributes
    ----------
    case : the subcase
    name : of the unit load, unique
    unit : that the forces are for 1 of
    amount : how much of the unit was applied in the subcase
    is_unit_known : whether the user gave the unit; else it is the load of the subcase as it was run
    """

    case: StaticCase
    name: str
    unit: str
    amount: float = 1.0
    is_unit_known: bool = False

    @property
    def column(self) -> str:
        """Name of its column in histories."""
        return f"u_{self.name}"


def named_loads(cases: Sequence[StaticCase], given: Sequence[LoadName]) -> tuple[UnitLoad, ...]:
    """Every static subcase as a unit load, named as given, else as its deck calls it.

    A name is made of the first of subtitle, label and title by which the subcases differ. No unit is made up: where
    none is given, 1 is the load of the subcase as it was run, and the unit says so.

    Raises
    ------
    CaseError : a name for a subcase that is not there or stands in two files, two names of one subcase, one name of two
    """
    said = _by_case(cases, given)
    taken = {one.name for one in given}
    found = []
    for case, text in zip(cases, _texts(cases), strict=True):
        if (own := said.get(case.number)) is not None:
            found.append(UnitLoad(case, own.name, own.unit, own.amount, is_unit_known=True))
            continue
        name = _unused(name_of(text) or f"subcase_{case.subcase}", case.subcase, taken)
        taken.add(name)
        found.append(UnitLoad(case, name, f"subcase {case.subcase}"))
    return tuple(found)


def name_of(text: str) -> str:
    """Name made of a title: its letters and digits in small letters, joined by _; empty if it has none."""
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode("ascii").lower()
    words = re.findall(r"[a-z0-9]+", plain)
    name = ""
    for word in words:
        longer = f"{name}_{word}" if name else word
        if name and len(longer) > _LONGEST:
            break
        name = longer[:_LONGEST]
    return f"load_{name}" if name[:1].isdigit() else name


def _texts(cases: Sequence[StaticCase]) -> list[str]:
    """Text that tells each subcase from the others, empty where none does."""
    columns = [[getattr(case.heading, field) for case in cases] for field in ("subtitle", "label", "title")]
    telling = [column for column in columns if len(cases) == 1 or len(set(column)) > 1]
    return [next(filter(None, texts), "") for texts in zip(*telling, strict=True)] if telling else [""] * len(cases)


def _unused(name: str, subcase: int, taken: set[str]) -> str:
    """The name, with the number of the subcase, and one more, where others have it."""
    if name not in taken:
        return name
    own, number = f"{name}_{subcase}", 2
    while own in taken:
        own, number = f"{name}_{subcase}_{number}", number + 1
    return own


def _by_case(cases: Sequence[StaticCase], given: Sequence[LoadName]) -> dict[int, LoadName]:
    """Names by the number of their subcase."""
    found: dict[int, LoadName] = {}
    for one in given:
        where = f"--unit-load-name {one.subcase}"
        own = [case for case in cases if case.subcase == one.subcase]
        if not own:
            shown = ", ".join(str(case.subcase) for case in cases[:10]) or "none"
            what = f"the files have no static subcase {one.subcase}; those that they have: {shown}"
            raise CaseError(Problem("unit_load_name", where, what, "Name one of these"))
        if len(own) > 1:
            what = f"{len(own)} files of unit loads have a subcase {one.subcase}: {own[0].source}, {own[1].source}"
            raise CaseError(Problem("unit_load_name", where, what, "Number the subcases of the two files apart"))
        if own[0].number in found:
            raise CaseError(Problem("unit_load_name", where, "the subcase is named twice", "Name it once"))
        if any(one.name == other.name for other in found.values()):
            what = f"{one.name!r} names another subcase, too"
            raise CaseError(Problem("unit_load_name", where, what, "Give every load a name of its own"))
        found[own[0].number] = one
    return found
