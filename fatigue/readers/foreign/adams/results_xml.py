"""Channels of Adams results as XML (``.res``), read as a stream.

A map of steps names the components of every entity by an id; a step is their values in the order of the ids, time among
them. Steps of a simulation over time are taken, with the state they start from; model input and other static positions
are not. The file is read once for names and times, and again for the values of the components that are asked for: a
model has thousands of them, a flexible body some dozens.
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
_STATES = frozenset({"initialconditions", "static"})
_PIECE = 1 << 16


@dataclass(slots=True, eq=False)
class _Analysis:
    """One analysis while its names and times are read.

    Attributes
    ----------
    names : name and unit of every component, by id
    start : number and time of the last state before the first step over time: initial conditions, or static equilibrium
    taken, times : numbers of the steps over time among all steps of the analysis, and their times
    steps : number of all steps so far
    left_out : number of steps by type that are not over time
    """

    name: str
    names: dict[int, tuple[str, str]] = field(default_factory=dict)
    start: tuple[int, str, float] | None = None
    taken: list[int] = field(default_factory=list)
    times: list[float] = field(default_factory=list)
    steps: int = 0
    left_out: dict[str, int] = field(default_factory=dict)


def is_adams_results(head: str) -> bool:
    """Whether a text begins like Adams results as XML."""
    return "<?xml" in head[:200] and "<Results" in head[:2000] and "xrf" in head[:4000]


def read_adams_results(path: Path) -> tuple[ChannelGroup, ...]:
    """The components of every analysis over time, named by entity and component.

    Raises
    ------
    DataError : damaged XML, entities that expand, no steps over time, no time, a step of another number of values
    """
    analyses: list[_Analysis] = []
    for tag, element, entity in _elements(path):
        if tag == "Analysis":
            analyses.append(_Analysis(element.get("name", "")))
        elif analyses and tag == "Component":
            _name(path, analyses[-1], entity, element)
        elif analyses and tag == "Step":
            _outline(path, analyses[-1], element.get("type", ""), (element.text or "").split())
    groups = [
        group
        for k, one in enumerate(analyses)
        if (group := _group(path, k, one, several=len(analyses) > 1)) is not None
    ]
    if not groups:
        what = "the results have no steps of a simulation over time"
        raise DataError(Problem("no_channels", str(path), what, "Run a dynamic simulation with RESULTS/XRF"))
    return tuple(groups)


def _elements(path: Path) -> Iterator[tuple[str, ET.Element, str]]:
    """Analyses as they begin, components and steps as they end, with the name of their entity; then forgotten."""
    entity = ""
    try:
        with path.open("rb") as file:
            for event, element in ET.iterparse(_Undefined(path, file), ("start", "end")):
                tag = element.tag.rpartition("}")[2]
                if event == "start":
                    if tag == "Entity":
                        entity = element.get("name", "")
                    elif tag == "Analysis":
                        yield tag, element, entity
                    continue
                if tag in ("Component", "Step"):
                    yield tag, element, entity
                if tag in ("Step", "Component", "Data"):
                    element.clear()
    except ET.ParseError as error:
        line, column = error.position
        what = f"the XML breaks off or is damaged at column {column + 1} ({str(error).split(':')[0]})"
        raise DataError(Problem("res_damaged", f"{path}, line {line}", what, "Copy the file again")) from None


class _Undefined:
    """A file whose reading stops at a definition of an entity: a few of them expand to more than any memory."""

    def __init__(self, path: Path, file: BinaryIO) -> None:
        self.path, self.file, self.tail = path, file, b""

    def read(self, size: int = _PIECE) -> bytes:
        """The next bytes."""
        piece = self.file.read(size)
        text = self.tail + piece.replace(b"\0", b"")  # UTF-16 has a zero beside every letter
        if b"<!ENTITY" in text or b"<!DOCTYPE" in text:
            what = "the XML defines entities, which Adams never does"
            raise DataError(Problem("res_damaged", str(self.path), what, "Give the file that Adams wrote"))
        self.tail = text[-16:]
        return piece


def _name(path: Path, analysis: _Analysis, entity: str, element: ET.Element) -> None:
    """Take the name of a component."""
    number, name = element.get("id", ""), element.get("name", "")
    called = name if entity.lower() == "time" else f"{entity}.{name}"
    what = ""
    if analysis.steps:
        what = "a component is named below the steps: they are not all of one map"
    elif not (number.isascii() and number.isdecimal() and len(number) < 10):
        what = f"component {called!r} has the id {number!r}, which is no number"
    elif int(number) in analysis.names:
        what = f"components {analysis.names[int(number)][0]!r} and {called!r} have the id {number}"
    if what:
        where = f"{path}, analysis {analysis.name!r}" if analysis.name else str(path)
        raise DataError(Problem("res_damaged", where, what, "Copy the file again, or repeat the run"))
    analysis.names[int(number)] = called, element.get("unitsValue", "")


def _outline(path: Path, analysis: _Analysis, kind: str, words: list[str]) -> None:
    """Take the time of a step over time, or of the state before it; count the others."""
    number, analysis.steps = analysis.steps, analysis.steps + 1
    word = kind.replace(" ", "").lower()
    is_start = word in _STATES and not analysis.taken
    if word not in _IN_TIME and not is_start:
        analysis.left_out[kind] = analysis.left_out.get(kind, 0) + 1
        return
    where = _step(path, analysis.name, number)
    if len(words) != len(analysis.names):
        what = f"it has {len(words)} values, and {len(analysis.names)} components are named"
        raise DataError(Problem("cut", where, what, "Copy the file again, or repeat the run"))
    at = _time_at(analysis)
    if at is None:
        what = "no component is named TIME, or several are"
        raise DataError(Problem("no_time", where, what, "Export the results with their time"))
    time = _real(where, words[at])
    if is_start:
        if analysis.start is not None:  # what a later state takes the place of
            before = analysis.start[1]
            analysis.left_out[before] = analysis.left_out.get(before, 0) + 1
        analysis.start = number, kind, time
    else:
        analysis.taken.append(number)
        analysis.times.append(time)


def _time_at(analysis: _Analysis) -> int | None:
    """Place of time among the values of a step."""
    timed = [k for k, number in enumerate(sorted(analysis.names)) if analysis.names[number][0].upper() == "TIME"]
    return timed[0] if len(timed) == 1 else None


def _group(path: Path, number: int, analysis: _Analysis, *, several: bool) -> ChannelGroup | None:
    """Channels of one analysis, None without steps over time."""
    at = _time_at(analysis)
    if not analysis.taken or at is None:
        return None
    steps, times, warnings = list(analysis.taken), list(analysis.times), []
    left_out = dict(analysis.left_out)
    if analysis.start is not None:
        step, kind, start = analysis.start
        if start < times[0]:
            steps, times = [step, *steps], [start, *times]
        else:
            left_out[kind] = left_out.get(kind, 0) + 1
    time = np.array(times)
    again = np.flatnonzero(np.diff(time) == 0.0)
    if again.size:  # the last step of one simulation is the first of the one that goes on from it
        what = f"{again.size} steps repeat the time of the one before, the first at {time[again[0]]:.9g} s"
        warnings.append(Problem("step_again", str(path), what, "Nothing, unless simulations were meant apart"))
        time = np.delete(time, again + 1)
        steps = np.delete(steps, again + 1).tolist()
    if left_out:
        kinds = ", ".join(f"{count} of type {kind!r}" for kind, count in left_out.items())
        warnings.append(Problem("steps_left_out", str(path), f"steps that are not over time are left out: {kinds}", ""))
    ids = sorted(analysis.names)
    unit = analysis.names[ids[at]][1]
    factor = seconds_per(unit) if unit else 1
    if factor is None:
        what = f"time is in {unit!r}, which is no unit of time"
        raise DataError(Problem("time_unit", str(path), what, "Export with time in seconds"))
    kept = [k for k in range(len(ids)) if k != at]
    channels = tuple(RecordedChannel(*analysis.names[ids[k]]) for k in kept)
    values = partial(_values, path, number, np.array(steps), kept)
    return ChannelGroup(
        analysis.name if several else "", channels, time.size, time * float(factor), values, "", tuple(warnings)
    )


def _values(
    path: Path, analysis: int, steps: NDArray[np.int64], kept: list[int], at: Sequence[int]
) -> NDArray[np.float64]:
    """Values (k, t) of some components, of the steps of these numbers in one analysis of the file."""
    table = np.empty((len(at), steps.size))
    places = {int(step): place for place, step in enumerate(steps)}
    columns = [kept[k] for k in at]
    current, step, name = -1, 0, ""
    for tag, element, _ in _elements(path):
        if tag == "Analysis":
            current, step, name = current + 1, 0, element.get("name", "")
        elif tag == "Step":
            if current == analysis and step in places:
                words = (element.text or "").split()
                where = _step(path, name, step)
                table[:, places[step]] = [_real(where, words[k]) for k in columns]
            step += 1
    return table


def _step(path: Path, analysis: str, number: int) -> str:
    return f"{path}, step {number + 1}" + (f" of {analysis}" if analysis else "")


def _real(where: str, word: str) -> float:
    try:
        return float(word.replace("D", "E").replace("_", "?"))
    except ValueError:
        what = f"it holds {word[:20]!r}, which is no number"
        raise DataError(Problem("not_a_number", where, what, "Repeat the run")) from None
