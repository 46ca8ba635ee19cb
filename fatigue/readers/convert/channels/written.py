"""Channels of a recording as a table that a case reads: ``time_s`` and a column for each, with its unit."""

import csv
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from fatigue.errors import CaseError, DataError, Problem, given_path
from fatigue.files.whole import replacing
from fatigue.readers.convert.channels.listed import STEP_TOLERANCE
from fatigue.readers.foreign.channels.group import ChannelGroup
from fatigue.readers.foreign.read import read_channels

ENDINGS = (".parquet", ".csv")
TIME = "time_s"


@dataclass(frozen=True, slots=True)
class WrittenChannels:
    """A table that was written: its columns with their units, and its time."""

    output: Path
    group: str
    columns: tuple[tuple[str, str], ...]
    samples: int
    start: float
    step: float
    warnings: tuple[Problem, ...]

    def as_record(self) -> Mapping[str, Any]:
        """The same for machines."""
        return {
            "output": str(self.output),
            "group": self.group,
            "samples": self.samples,
            "start_s": self.start,
            "step_s": self.step,
            "columns": [{"column": name, "unit": unit} for name, unit in self.columns],
            "warnings": [str(warning) for warning in self.warnings],
        }

    def as_text(self) -> str:
        """The same in a line, and the warnings."""
        count = f"{len(self.columns)} channel{'s' * (len(self.columns) != 1)}"
        line = f"written to {self.output}: {TIME} and {count}, {self.samples} samples from {self.start:.9g} s every "
        return "\n".join([f"{line}{self.step:.6g} s", *(f"note   {warning}" for warning in self.warnings)])


def write_channels(
    path: Path | str,
    output: Path | str,
    *,
    group: str | None = None,
    channels: Sequence[str] = (),
    force: bool = False,
) -> WrittenChannels:
    """Write channels of one group of a recording as a table.

    Parameters
    ----------
    path : the recording, of any format that is read
    output : ``.parquet`` or ``.csv``
    group : its name; None where the file has one group with time, or the channels are all in one
    channels : names, or ``NAME=COLUMN`` to give a column another name; all by default
    force : overwrite a file that is there already

    Raises
    ------
    CaseError : another ending
    DataError : any refusal of the readers, no such group or channel, no time or uneven steps, two columns of one
        name, a file in the way, the recording itself among them
    """
    path, output = given_path(path, "path"), given_path(output, "output")
    if output.suffix.lower() not in ENDINGS:
        what = f"the table ends in {output.suffix!r}" if output.suffix else "the name of the table has no ending"
        raise CaseError(Problem("unknown_format", str(output), what, f"Name it {' or '.join(ENDINGS)}"))
    if output.exists() and path.exists() and output.samefile(path):
        raise DataError(Problem("onto_itself", str(output), "this is the recording itself", "Name another table"))
    if output.exists() and not force:
        raise DataError(Problem("foreign_file", str(output), "the file exists", "Use --force, or name another"))
    groups = read_channels(path)
    there = {one.name for some in groups for one in some.channels}
    renamed = dict(_renamed(one, there) for one in channels)
    found = _chosen(path, groups, group, tuple(renamed))
    at = [k for k, one in enumerate(found.channels) if not renamed or one.name in renamed]
    columns = tuple((renamed.get(found.channels[k].name) or found.channels[k].name, found.channels[k].unit) for k in at)
    time, step = _even_time(path, found)
    columns, numbered = _numbered([found.channels[k].name for k in at], columns, f"{path}, {found.called}")
    _refuse_names(path, [name for name, _ in columns])
    values = found.values(at)
    with replacing(output) as unfinished:
        (_write_parquet if output.suffix.lower() == ".parquet" else _write_csv)(unfinished, time, columns, values)
    missing = _missing(path, found, columns, values)
    warnings = (*found.warnings, *numbered, *missing)
    return WrittenChannels(output, found.name, columns, time.size, float(time[0]), step, warnings)


def _missing(
    path: Path, group: ChannelGroup, columns: Sequence[tuple[str, str]], values: np.ndarray[Any, Any]
) -> list[Problem]:
    """Warning about samples that are missing: strain gauges flag them, histories and loads of a case refuse them."""
    bad = ~np.isfinite(values)
    if not bad.any():
        return []
    row, sample = np.unravel_index(int(bad.argmax()), bad.shape)
    where = f"{path}, {group.called}, channel {columns[int(row)][0]!r}"
    count = f"{int(bad.sum())} of all samples"
    what = f"{count} are missing or no numbers, sample {int(sample) + 1} the first; they are so in the table"
    remedy = "Gauges leave them out; for histories and loads leave the channel out, or cut the record"
    return [Problem("missing_samples", where, what, remedy)]


def _numbered(
    names: Sequence[str], columns: Sequence[tuple[str, str]], where: str
) -> tuple[tuple[tuple[str, str], ...], list[Problem]]:
    """Columns of channels that have one name in the file, told apart by numbers in their order there, and a warning."""
    twice = {name for name in names if names.count(name) > 1}
    count: Counter[str] = Counter()
    found = []
    for name, (column, unit) in zip(names, columns, strict=True):
        count[name] += 1
        found.append((f"{column} ({count[name]})" if name in twice else column, unit))
    listed = ", ".join(sorted(map(repr, twice)))
    what = f"several channels have one name, {listed}: their columns are numbered in the order of the file"
    remedy = "Check which is which, or give them names of their own where they are recorded"
    return tuple(found), [Problem("names_twice", where, what, remedy)] if twice else []


def _renamed(asked: str, there: Collection[str]) -> tuple[str, str]:
    """Name of a channel and the column asked for it; a name may hold an equals sign itself."""
    if asked in there:
        return asked, ""
    name, is_given, column = asked.rpartition("=")
    if not is_given or name not in there:
        name, is_given, column = asked.partition("=")
    return (name, column) if is_given else (asked, "")


def _chosen(path: Path, groups: Sequence[ChannelGroup], group: str | None, channels: Sequence[str]) -> ChannelGroup:
    """The group that was named, or the only one that can be meant."""
    names = ", ".join(repr(one.name) for one in groups)
    if group is not None:
        named = [one for one in groups if one.name == group]
        if not named:
            raise DataError(Problem("no_group", str(path), f"there is no group {group!r}", f"Name one of {names}"))
        if len(named) > 1:
            what = f"{len(named)} groups are named {group!r}"
            raise DataError(
                Problem("many_groups", str(path), what, "Name channels of one by --channel, without --group")
            )
        found = named[0]
    else:
        having = [one for one in groups if set(channels) <= {c.name for c in one.channels}] if channels else []
        timed = [one for one in (having or groups) if one.time is not None]
        if len(timed) > 1:
            remedy = "Name one by --group, or channels of one by --channel"
            raise DataError(Problem("many_groups", str(path), f"its groups with time are {names}", remedy))
        found = (timed or having or list(groups))[0]
    if missing := sorted(set(channels) - {one.name for one in found.channels}):
        there = ", ".join(repr(one.name) for one in found.channels[:12])
        what = f"{found.called} has no channel {missing[0]!r}"
        raise DataError(Problem("no_channel", str(path), what, f"Name some of {there}"))
    return found


def _even_time(path: Path, group: ChannelGroup) -> tuple[np.ndarray[Any, np.dtype[np.float64]], float]:
    """Times of a group and their step [s]; refused where there are none, or steps differ."""
    where = f"{path}, {group.called}"
    if group.time is None:
        what = group.without_time or "the file gives its channels no time"
        raise DataError(Problem("no_time", where, what, "Export the channels with their time"))
    if group.time.size < 2:
        raise DataError(Problem("too_short", where, f"{group.time.size} samples", "Export at least two"))
    step = float(group.time[-1] - group.time[0]) / (group.time.size - 1)
    off = np.abs(np.diff(group.time) - step)
    if not step > 0.0 or off.max() > STEP_TOLERANCE * step:
        sample = int(off.argmax())
        own = float(group.time[sample + 1] - group.time[sample])
        what = f"between samples {sample + 1} and {sample + 2} the step is {own:.6g} s, {step:.6g} s on average"
        raise DataError(Problem("uneven", where, what, "Resample the record evenly, or cut it at its gaps"))
    return group.time, step


def _refuse_names(path: Path, names: Sequence[str]) -> None:
    twice = next((name for name in names if names.count(name) > 1 or name == TIME), None)
    if twice is not None:
        what = f"two columns would be named {twice!r}"
        raise DataError(Problem("column_twice", str(path), what, f"Name one otherwise: --channel {twice!r}=OTHER"))


def _write_parquet(
    file: Path, time: np.ndarray[Any, Any], columns: Sequence[tuple[str, str]], values: np.ndarray[Any, Any]
) -> None:
    named = [(TIME, "s"), *columns]
    schema = pa.schema(pa.field(name, pa.float64(), metadata={"unit": unit} if unit else None) for name, unit in named)
    pq.write_table(pa.table([time, *values], schema=schema), file)


def _write_csv(
    file: Path, time: np.ndarray[Any, Any], columns: Sequence[tuple[str, str]], values: np.ndarray[Any, Any]
) -> None:
    with file.open("w", newline="", encoding="utf-8") as out:
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow([TIME, *(name for name, _ in columns)])
        if any(unit for _, unit in columns):
            writer.writerow(["s", *(unit or "-" for _, unit in columns)])
        writer.writerows(
            ["" if np.isnan(x) else repr(float(x)) for x in row] for row in np.column_stack([time, values.T])
        )
