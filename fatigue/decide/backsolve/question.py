"""What is asked: one quantity that shall just meet a target, and the target as a distance and as years."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

from fatigue.errors import CaseError, Problem
from fatigue.shown import few, visible

For = Literal["load", "curve", "km_per_year", "share", "thickness"]
KINDS: tuple[For, ...] = ("load", "curve", "km_per_year", "share", "thickness")
SHARE = "share:"
_TARGET = re.compile(r"\s*([0-9.eE+-]+)\s*(km|years|year|a)?\s*")


@dataclass(frozen=True, slots=True)
class Question:
    """What shall just meet the target.

    Attributes
    ----------
    of : the quantity
    event : whose share it is; empty of the others
    target_km : distance that has to be reached [km]
    years : time in which it has to be reached, at the mileage of the case
    """

    of: For
    event: str
    target_km: float
    years: float

    @property
    def name(self) -> str:
        """The question as it is asked."""
        return f"{SHARE}{self.event}" if self.event else self.of


def question(asked: str, target: str | float | None, record: Mapping[str, Any]) -> Question:
    """Question about a result; ``target`` in km or, as in ``30 years``, in years; None: that of the case.

    Raises
    ------
    CaseError : no such quantity, an event without a share, a target that is none
    """
    mission = record["mission"]
    of, event = _kind(asked, mission)
    per_year = float(mission["km_per_year"])
    km = float(mission["target_km"]) if target is None else _km(target, per_year)
    return Question(of, event, km, km / per_year)


def _kind(asked: str, mission: Mapping[str, Any]) -> tuple[For, str]:
    if asked.startswith(SHARE):
        return "share", _event(asked.removeprefix(SHARE), mission)
    for kind in KINDS:
        if asked == kind and kind != "share":
            return kind, ""
    what = f"nothing is solved for {asked!r}"
    raise CaseError(
        Problem("unknown_question", "--for", what, "Give load, curve, km_per_year, thickness or share:EVENT")
    )


def _event(name: str, mission: Mapping[str, Any]) -> str:
    """Event whose share may change.

    Raises
    ------
    CaseError : there is none of this name, it is counted by number, or no other has a share to give
    """
    shares = {one["event"]: one["share"] for one in mission["events"]}
    with_share = [event for event, share in shares.items() if share is not None]
    known = few([repr(visible(event)) for event in with_share], 10)
    if name not in shares:
        what = f"the mission has no event {visible(name)!r}"
        raise CaseError(Problem("unknown_event", "--for", what, f"Give share: and one of {known}"))
    if shares[name] is None:
        what = f"the event {visible(name)!r} is counted by number and has no share of the mileage"
        raise CaseError(
            Problem("no_share", "--for", what, f"Give share: and one of {known}" if known else "Ask another")
        )
    if not sum(shares[event] for event in with_share if event != name) > 0.0:
        what = f"the event {visible(name)!r} has all of the mileage: there is no mix of others that could take or give"
        raise CaseError(Problem("no_share", "--for", what, "Give the others a share in the case, and assess it"))
    return name


def _km(target: str | float, per_year: float) -> float:
    found = _TARGET.fullmatch(str(target))
    try:
        value = float(found[1]) if found else float("nan")
    except ValueError:
        value = float("nan")
    if not 0.0 < value < float("inf"):
        what = f"{target!r} is no target above 0"
        raise CaseError(Problem("bad_value", "--target", what, "Give km, as 1.5e7, or years, as '30 years'"))
    return value * (per_year if found and found[2] in ("years", "year", "a") else 1.0)
