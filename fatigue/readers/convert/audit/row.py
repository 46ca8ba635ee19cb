"""One check of an audit: a traffic light, a number, what was found and what to do about it."""

from dataclasses import dataclass
from typing import Literal

Light = Literal["green", "amber", "red"]


@dataclass(frozen=True, slots=True)
class AuditRow:
    """One check: what was measured, how it is judged, and what to do about it."""

    check: str
    light: Light
    value: float | None
    finding: str
    remedy: str = ""
