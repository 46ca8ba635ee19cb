"""Channels of Adams results as XML (``.res``), read as a stream.

A map of steps names the components of every entity by an id; a step is their values in the order of the ids, time among
them. Steps of a simulation over time are taken, with the initial conditions before them; model input and static
positions are not.
"""

import xml.etree.ElementTree as ET
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.channels.group import ChannelGroup, RecordedChannel
from fatigue.readers.units.channel_names import seconds_per

_IN_TIME = frozenset({"dynamic", "kinematic", "quasistatic", "quasi-static"})
_BEFORE = "initialconditions"
_PIECE = 1 << 16


@dataclass(slots=True, eq=False)
class _Analysis:
    """One analysis while it is read: names and units by id, and its steps."""

    name: str
    names: dict[int, tuple[str, str]] = field(default_factory=dict)
    steps: list[NDArray[np.float64]] = field(default_factory=list)
    before: NDArray[np.float64] | None = None
    left_out: dict[str, int] = field(default_factory=dict)


def is_adams_results(head: str) -> bool:
    """Whether a text begins like Adams results as XML."""
    return "<?xml" in head[:200] and "<Results" in head[:2000] and "xrf" in head[:4000]


def read_adams_results(path: Path) -> tuple[ChannelGroup, ...]:
    """The components of every analysis over time, named by entity and component.

    Raises
    ------
    DataError : damaged XML, entities that expand, no steps over time, a step of another number of values
    """
    try:
        analyses = list(_analyses(path))
    except ET.ParseError as error:
        line, column = error.position
        what = f"the XML breaks off or is damaged at column {column + 1} ({str(error).split(':')[0]})"
        raise DataError(Problem("res_damaged", f"{path}, line {line}", what, "Copy the file again")) from None
    groups = [group for one in analyses if (group := _group(path, one, len(analyses))) is not None]
    if not groups:
        what = "the results have no steps of a simulation over time"
        raise DataError(Problem("no_channels", str(path), what, "Run a dynamic simulation with RESULTS/XRF"))
    return tuple(groups)


def _analyses(path: Path) -> Iterator[_Analysis]:
    """Analyses of the file; each step is turned into numbers and forgotten as text."""
    current, entity = _Analysis(""), ""
    with path.open("rb") as file:
        for event, element in ET.iterparse(_Undefined(path, file), ("start", "end")):
            tag = element.tag.rpartition("}")[2]
            if event == "start":
                if tag == "Analysis":
                    current = _Analysis(element.get("name", ""))
                elif tag == "Entity":
                    entity = element.get("name", "")
                continue
            if tag == "Component":
                number = element.get("id", "")
                if number.isascii() and number.isdecimal():
                    name = element.get("name", "")
                    called = name if entity.lower() == "time" else f"{entity}.{name}"
                    current.names[int(number)] = called, element.get("unitsValue", "")
            elif tag == "Step":
                _take(path, current, element.get("type", ""), element.text or "")
            elif tag == "Analysis":
                yield current
            if tag in ("Step", "Component", "Data"):
                element.clear()


class _Undefined:
    """A file whose reading stops at a definition of an entity: a few of them expand to more than any memory."""

    def __init__(self, path: Path, file: BinaryIO) -> None:
        self.path, self.file, self.tail = path, file, b""

    def read(self, size: int = _PIECE) -> bytes:
        """The next bytes."""
        piece = self.file.read(size)
        if b"<!ENTITY" in self.tail + piece or b"<!DOCTYPE" in self.tail + piece:
            what = "the XML defines entities, which Adams never does"
            raise DataError(Problem("res_damaged", str(self.path), what, "Give the file that Adams wrote"))
        self.tail = piece[-16:]
        return piece


def _take(path: Path, analysis: _Analysis, kind: str, text: str) -> None:
    """Keep a step over time; count the others."""
    word = kind.replace(" ", "").lower()
    if word not in (*_IN_TIME, _BEFORE):
        analysis.left_out[kind] = analysis.left_out.get(kind, 0) + 1
        return
    words = text.split()
    if len(words) != len(analysis.names):
        where = f"{path}, step {len(analysis.steps) + 1}" + (f" of {analysis.name}" if analysis.name else "")
        what = f"it has {len(words)} values, and {len(analysis.names)} components are named"
        raise DataError(Problem("cut", where, what, "Copy the file again, or repeat the run"))
    try:
        values = np.array([word.replace("D", "E") for word in words], np.float64)
    except ValueError:
        where = f"{path}, step {len(analysis.steps) + 1}"
        raise DataError(Problem("not_a_number", where, "it holds a word that is no number", "Repeat the run")) from None
    if word == _BEFORE:
        analysis.before = values
    else:
        analysis.steps.append(values)


def _group(path: Path, analysis: _Analysis, analyses: int) -> ChannelGroup | None:
    """Channels of one analysis, None without steps over time."""
    ids = sorted(analysis.names)
    timed = [k for k, number in enumerate(ids) if analysis.names[number][0].upper() == "TIME"]
    if not analysis.steps or len(timed) != 1:
        return None
    at = timed[0]
    steps, warnings = list(analysis.steps), []
    if analysis.before is not None and analysis.before[at] < steps[0][at]:
        steps.insert(0, analysis.before)
    table = np.array(steps).T
    again = np.flatnonzero(np.diff(table[at]) == 0.0)
    if again.size:  # the last step of one simulation is the first of the one that goes on from it
        table = np.delete(table, again + 1, axis=1)
        what = f"{again.size} steps repeat the time of the one before, the first at {table[at, again[0]]:.9g} s"
        warnings.append(Problem("step_again", str(path), what, "Nothing, unless simulations were meant apart"))
    if analysis.left_out:
        kinds = ", ".join(f"{count} of type {kind!r}" for kind, count in analysis.left_out.items())
        warnings.append(Problem("steps_left_out", str(path), f"steps that are not over time are left out: {kinds}", ""))
    unit = analysis.names[ids[at]][1]
    factor = seconds_per(unit) if unit else 1
    if factor is None:
        what = f"time is in {unit!r}, which is no unit of time"
        raise DataError(Problem("time_unit", str(path), what, "Export with time in seconds"))
    kept = [k for k in range(len(ids)) if k != at]
    channels = tuple(RecordedChannel(*analysis.names[ids[k]]) for k in kept)
    name = analysis.name if analyses > 1 else ""
    time = table[at] * float(factor)
    return ChannelGroup(name, channels, time.size, time, partial(_values, table[kept]), "", tuple(warnings))


def _values(table: NDArray[np.float64], at: Sequence[int]) -> NDArray[np.floating]:
    """Values (k, t) of some components."""
    return table[list(at)]
