"""Modal coordinates of a NASTRAN transient run: solution set displacements of a punch file, ``SDISPLACEMENT(PUNCH)``.

A row has the mode, or the time where the file is sorted by mode (SORT2), the type M, and the coordinate in the first of
six fields; velocities and accelerations of the solution set are passed over.
"""

import re
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.channels.group import ChannelGroup, RecordedChannel
from fatigue.readers.foreign.nastran.results.punch_fields import damaged, real
from fatigue.readers.text.encoding import unreadable

REQUEST = "Request SDISPLACEMENT(PUNCH,REAL) = ALL in the modal transient run (SOL 112)"
_HEADING = re.compile(r"\$DISPLACEMENTS?\b[^A-Z]*SOLUTION SET", re.IGNORECASE)
_SUBCASE = re.compile(r"\$SUBCASE ID\s*=\s*(\d{1,9})", re.ASCII)
_TIME = re.compile(r"\$TIME(?: STEP)?\s*=\s*([-+.\dED]+)", re.ASCII)
_POINT = re.compile(r"\$POINT ID\s*=\s*(\d{1,9})(?:\s+IDENTIFIED BY (\w+))?", re.ASCII)
_COMPLEX = ("$REAL-IMAGINARY", "$MAGNITUDE-PHASE")

_Samples = dict[int, dict[float, float]]
"""Coordinates by mode and time."""


def read_solution_punch(path: Path) -> tuple[ChannelGroup, ...]:
    """Modal coordinates of every subcase, a group each, as channels ``q_<mode>``.

    Raises
    ------
    DataError : no solution set displacements, complex ones, a damaged row, a mode with other times than the others
    """
    try:
        lines = path.read_text("ascii", errors="replace").splitlines()
    except OSError as error:
        raise unreadable(path, error) from error
    heads = [k for k, line in enumerate(lines) if _HEADING.match(line)]
    if not heads:
        what = "the punch file has no displacements of the solution set"
        raise DataError(Problem("no_coordinates", str(path), what, REQUEST))
    subcases: dict[int, _Samples] = {}
    points: dict[str, int] = {}
    for head in heads:
        _block(path, lines, head, subcases, points)
    warnings: tuple[Problem, ...] = ()
    if points:
        kinds = ", ".join(f"{count} of type {kind}" for kind, count in points.items())
        what = f"rows that are no modes are left out: {kinds}"
        warnings = (Problem("points_left_out", str(path), what, "Nothing, unless they are modal coordinates"),)
    return tuple(_group(path, number, samples, len(subcases), warnings) for number, samples in subcases.items())


def _block(path: Path, lines: list[str], head: int, subcases: dict[int, _Samples], points: dict[str, int]) -> None:
    """Take the rows of one block, which goes on to the next line with a $ behind its rows."""
    subcase, time, mode, at = _stated(path, lines, head + 1)
    samples = subcases.setdefault(subcase, {})
    while at < len(lines) and not lines[at].startswith("$"):
        line = lines[at]
        if line.startswith("-CONT-"):
            _refuse_more_values(path, at, line[18:72])
        elif line.strip():
            words = line[:18].split()
            if len(words) != 2 or (time is None) == (mode is None):
                raise damaged(path, at, "a row of a mode or a time, its type and its values was expected")
            if words[1] != "M":
                points[words[1]] = points.get(words[1], 0) + 1
            else:
                first = real(path, at, words[0])
                number, when = (int(first), time or 0.0) if mode is None else (mode, first)
                of_mode = samples.setdefault(number, {})
                if when in of_mode:
                    raise damaged(path, at, f"mode {number} has two coordinates at {when:.9g} s")
                of_mode[when] = real(path, at, line[18:36])
                _refuse_more_values(path, at, line[36:72])
        at += 1


def _stated(path: Path, lines: list[str], at: int) -> tuple[int, float | None, int | None, int]:
    """Subcase, time or mode that the lines below a heading state, and where the rows begin."""
    subcase, time, mode = 1, None, None
    while at < len(lines) and lines[at].startswith("$"):
        line = lines[at][:72]
        if found := _SUBCASE.match(line):
            subcase = int(found[1])
        elif found := _TIME.match(line):
            time = real(path, at, found[1])
        elif found := _POINT.match(line):
            mode = int(found[1])
            if found[2] not in (None, "TIME"):
                what = f"the coordinates go by {found[2].lower()}, not by time"
                raise DataError(Problem("harmonic", f"{path}, line {at + 1}", what, REQUEST))
        elif line.startswith(_COMPLEX) or line.startswith("$FREQUENCY"):
            raise DataError(Problem("harmonic", f"{path}, line {at + 1}", "the coordinates are complex", REQUEST))
        at += 1
    return subcase, time, mode, at


def _refuse_more_values(path: Path, at: int, fields: str) -> None:
    """Refuse values beside the first of a row: a mode has one coordinate, the other fields hold zeros."""
    for k in range(0, len(fields.rstrip()), 18):
        if fields[k : k + 18].strip() and real(path, at, fields[k : k + 18]) != 0.0:
            raise damaged(
                path, at, f"{fields[k : k + 18].strip()} stands beside the coordinate of a mode, where zeros belong"
            )


def _group(path: Path, subcase: int, samples: _Samples, subcases: int, warnings: tuple[Problem, ...]) -> ChannelGroup:
    """Group of one subcase, whose modes all have the same times."""
    if not samples:
        what = f"subcase {subcase} has no coordinates of modes (rows of type M)"
        raise DataError(Problem("no_coordinates", str(path), what, REQUEST))
    modes = sorted(samples)
    times = np.array(sorted(samples[modes[0]]))
    for mode in modes[1:]:
        if len(samples[mode]) != times.size or not np.array_equal(np.array(sorted(samples[mode])), times):
            what = f"mode {mode} has {len(samples[mode])} times, mode {modes[0]} has {times.size}"
            raise DataError(Problem("several_times", f"{path}, subcase {subcase}", what, "Copy the punch file again"))
    table = np.array([[samples[mode][t] for t in times.tolist()] for mode in modes])
    channels = tuple(RecordedChannel(f"q_{mode}") for mode in modes)
    name = f"subcase {subcase}" if subcases > 1 else ""
    return ChannelGroup(name, channels, times.size, times, partial(_values, table), "", warnings)


def _values(table: NDArray[np.float64], at: Sequence[int]) -> NDArray[np.floating]:
    """Coordinates (k, t) of some modes."""
    return table[list(at)]
