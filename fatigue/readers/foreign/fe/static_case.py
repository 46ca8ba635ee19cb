"""What a file tells of a static subcase besides its forces: its number, and how its deck calls it."""

import re
from dataclasses import dataclass

APART = 1_000_000_000
"""Numbers from here on are given to static subcases whose own a mode has, and to unit loads; no solver uses them."""

_BEHIND = re.compile(r"(?:\A|\s{2,})(?:SUBCASE|SUBCOM|SUPERELEMENT)\b.*\Z", re.IGNORECASE)
"""What solvers write behind subtitle and label."""
_BY_A_PROGRAM = re.compile(r"(?:MSC.NASTRAN JOB\b.*|DEFAULT)\Z", re.IGNORECASE)
"""Titles and subtitles that preprocessors write where the user gives none."""


@dataclass(frozen=True, slots=True)
class Heading:
    """Title, subtitle and label of a subcase, empty where there is none."""

    title: str = ""
    subtitle: str = ""
    label: str = ""


def heading(title: str, subtitle: str, label: str) -> Heading:
    """Heading of the texts of a file, without what solvers and preprocessors put there by themselves."""
    return Heading(*(_own_text(text) for text in (title, subtitle, label)))


def _own_text(text: str) -> str:
    bare = _BEHIND.sub("", text.strip()).strip()
    return "" if _BY_A_PROGRAM.match(bare) else " ".join(bare.split())


@dataclass(frozen=True, slots=True)
class StaticCase:
    """A static subcase that was read.

    Attributes
    ----------
    number : that stands for it where modes have theirs: its own, or one from ``APART`` on if a mode has that
    subcase : its own number
    heading : how its deck calls it
    source : file
    """

    number: int
    subcase: int
    heading: Heading = Heading()
    source: str = ""
