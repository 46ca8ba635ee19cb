"""What a source is asked for, and what it gives."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

Setting = float | int | str | bool
NO_EVENT = ""


class SourceNumber(NamedTuple):
    """A number of a run that its source knows; NaN for a ``reason``."""

    quantity: str
    value: float
    unit: str
    reason: str = ""


@dataclass(frozen=True, slots=True)
class Asked:
    """One run of a source.

    Attributes
    ----------
    variant, seed : what it is asked for
    event : the event that has a run of its own, "" where one run serves all
    files : files that it has to leave, as the case names them, by event
    changes : what differs from the files of the study, by whole keys
    settings : what varies, by short name
    """

    variant: str
    seed: int
    event: str
    files: Mapping[str, tuple[str, ...]]
    changes: Mapping[str, Any]
    settings: Mapping[str, Setting]

    @property
    def place(self) -> str:
        """The run in words."""
        of_event = f", event '{self.event}'" if self.event else ""
        return f"variant '{self.variant}', seed {self.seed}{of_event}"


@dataclass(frozen=True, slots=True)
class Made:
    """What a run of a source gave.

    Attributes
    ----------
    files : where each file of an event is, by event and the name that the case has for it
    added : keys of an event that follow from the run, as its speed, by event
    numbers : what the source says of the run
    reused : it was made by an earlier command
    """

    files: Mapping[str, Mapping[str, Path]]
    added: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    numbers: tuple[SourceNumber, ...] = ()
    reused: bool = False
