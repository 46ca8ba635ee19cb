"""The record of one event in all its coordinates: modes and unit loads, these from their own files where they have any.

Loads that stand at the instants of the record are rows of it. Others are read at the instants that are counted; where
one is sampled more finely than the record, the record is upsampled first, by a power of 2.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.life.records.history import ModalHistory, Residue, first_kept, kept, upsampled
from fatigue.life.records.unit_load import LoadRecord, LoadSource, UniformGrid
from fatigue.readers.neutral.event.load_file import read_load
from fatigue.readers.neutral.event.load_units import load_unit_problems, without_units_of
from fatigue.readers.neutral.history import TimeGrid, check_history, coordinate_numbers, read_history
from fatigue.readers.neutral.record_outline import RecordOutline

STATIC_STEP = 1.0  # s between the values of a static load case, which have no times
FINER = "-finer"  # behind the name of the file of a record that was upsampled for a load
FINEST = 1024  # times a record is upsampled for the sake of a load
OVERSHOOT = 0.05  # of the sampled range, beyond which an interpolant has left it


@dataclass(frozen=True, slots=True)
class EventFiles:
    """What the record of an event is read from.

    Attributes
    ----------
    event : name of the event
    path : file of its modal coordinates; None: a static load case
    modes : (m,) ids
    ignore_modes : ids of columns that are left out
    start_s : start-up that is cut off [s]
    residue : whether the record repeats
    loads : where each unit load comes from
    strict : whether unknown columns are refused
    beside : other columns of the file that are known, and not read here
    """

    event: str
    path: Path | None
    modes: NDArray[np.int64]
    ignore_modes: Collection[int]
    start_s: float
    residue: Residue
    loads: tuple[LoadSource, ...]
    strict: bool
    beside: Collection[str] = ()

    @property
    def columns(self) -> list[str | None]:
        """Column of each unit load in the record of the event, None where it comes from elsewhere."""
        return [load.column if load.way == "column" else None for load in self.loads]


@dataclass(frozen=True, slots=True, eq=False)
class EventRecord:
    """The kept record of an event.

    Attributes
    ----------
    history : (c, t) modes and unit loads; of constants the samples are zero
    duration : of a pass, kept samples of the file times their step [s]
    refined : by how much ``history`` is finer than the file of the modal coordinates
    between : unit loads that are read between their samples, by their rows in q
    is_static : whether it is a static load case, without time
    """

    history: ModalHistory
    duration: float
    refined: int = 1
    between: tuple[tuple[int, LoadRecord], ...] = ()
    is_static: bool = False

    def upsampled(self, factor: int, residue: Residue, scratch: Path | None = None) -> ModalHistory:
        """The record interpolated to a step ``factor`` times shorter than that of the file; see ``history.upsampled``.

        A static load case stays as it is.
        """
        if factor <= self.refined or self.is_static:
            return self.history
        fine = upsampled(self.history, factor // self.refined, residue, scratch)
        _put(fine, self.between)
        return fine

    def shortened(self, samples: int) -> "EventRecord":
        """The first samples, in memory; loads are not read again between their samples."""
        history = replace(self.history, q=np.ascontiguousarray(self.history.q[:, 0:samples]))
        return EventRecord(history, history.duration, self.refined, (), self.is_static)


@dataclass(frozen=True, slots=True, eq=False)
class CheckedRecord:
    """Times of the record of an event that was read, checked and not kept.

    ``refined``: by how much it is upsampled so that no unit load is finer, 0 of a static load case, which never is.
    ``warnings`` are about all its files.
    """

    grid: TimeGrid
    refined: int
    warnings: list[Problem]


def read_event(files: EventFiles, scratch: Path | None = None) -> EventRecord:
    """The kept record of an event; a file named ``scratch`` takes its samples, if one is given.

    Raises
    ------
    DataError : as ``read_history`` and ``read_load``; a load that does not cover the record
    """
    if files.path is None:
        return _static(files)
    own = [(row, *_own(files, load)) for row, load in _with_files(files)]
    single = all(load.values.dtype == np.float32 for _, load, _ in own)
    whole, _ = read_history(
        files.path,
        files.event,
        files.modes,
        files.ignore_modes,
        strict=files.strict,
        scratch=scratch,
        loads=files.columns,
        single=single,
        beside=files.beside,
    )
    history = kept(whole, files.start_s)
    duration = history.duration
    if not own:
        return EventRecord(history, duration)
    base = _grid_of(history)
    refined, loads = _fitted(files, [(row, load) for row, load, _ in own], base)
    _put(history, [(row, load) for row, load in loads if _stands_at(load, base)])  # upsampled as the modes are
    if refined > 1:
        history = upsampled(history, refined, files.residue, scratch and scratch.with_name(f"{scratch.name}{FINER}"))
        if scratch is not None:
            scratch.unlink()
    others = [(row, load) for row, load in loads if not _stands_at(load, base)]
    _put(history, others)
    grid = _grid_of(history)
    between = [(row, load) for row, load in others if not _stands_at(load, grid)]
    return EventRecord(history, duration, refined, tuple(between))


def check_event(files: EventFiles, outline: RecordOutline) -> CheckedRecord:
    """Check the record of an event, of which ``outline`` takes in the samples; raises what ``read_event`` raises."""
    if files.path is None:
        q = np.asarray(_static(files).history.q)
        for row in range(len(q)):
            outline.add(row, q[row], STATIC_STEP)
        return CheckedRecord(TimeGrid(q.shape[1], STATIC_STEP, 0.0), 0, [])
    refuse(DataError, load_unit_problems(files.path, files.loads))
    grid, warnings = check_history(
        files.path,
        files.modes,
        files.ignore_modes,
        strict=files.strict,
        outline=outline,
        loads=files.columns,
        beside=files.beside,
    )
    if files.beside:
        warnings = without_units_of(files.path, files.beside, warnings)
    skipped = min(first_kept(grid.step, files.start_s), grid.samples)
    base = UniformGrid(grid.start + skipped * grid.step, grid.step, grid.samples - skipped)
    own = [(row, *_own(files, load)) for row, load in _with_files(files)]
    warnings += [warning for *_, found in own for warning in found]
    if base.samples < 2:  # told with the plan
        return CheckedRecord(grid, 1, warnings)
    refined, loads = _fitted(files, [(row, load) for row, load, _ in own], base)
    fine = base.finer(refined, repeats=files.residue == "repeat")
    for row, load in loads:
        values = load.at(fine)
        outline.add_kept(row, values)
        warnings += _overshoot(files, files.loads[row - files.modes.size], load, values)
    for row, source in enumerate(files.loads, start=files.modes.size):
        if source.way in ("constant", "missing"):
            outline.add_kept(row, np.array([source.constant]))
    return CheckedRecord(grid, refined, warnings)


def _with_files(files: EventFiles) -> list[tuple[int, LoadSource]]:
    """Unit loads with a file of their own, by their rows in q."""
    return [(row, load) for row, load in enumerate(files.loads, start=files.modes.size) if load.way == "file"]


def _own(files: EventFiles, source: LoadSource) -> tuple[LoadRecord, list[Problem]]:
    """Record of a load, and the warnings about its file."""
    return read_load(source, strict=files.strict)


def _stands_at(load: LoadRecord, grid: UniformGrid) -> bool:
    """Whether the samples of a load stand at these instants, so that it is read between them as the modes are."""
    return load.interpolation == "fourier" and load.same_instants(grid) is not None


def _fitted(
    files: EventFiles, own: Sequence[tuple[int, LoadRecord]], base: UniformGrid
) -> tuple[int, list[tuple[int, LoadRecord]]]:
    """By how much the record is upsampled for its loads, and these in its event; loads that are too short are refused.

    Raises
    ------
    DataError : all loads that do not cover the kept record, or would upsample it too much
    """
    loads = [(row, load.within(base, repeats=files.residue == "repeat")) for row, load in own]
    problems: list[Problem] = []
    refined = 1
    for row, load in loads:
        source = files.loads[row - files.modes.size]
        factor = load.refinement(base.step)
        if not load.covers(base):
            problems.append(_too_short(files, source, load, base))
        elif factor > FINEST:
            problems.append(_too_fine(files, source, load, base))
        refined = max(refined, min(factor, FINEST))
    refuse(DataError, problems)
    return refined, loads


def _static(files: EventFiles) -> EventRecord:
    """Record of a static load case: modes at zero, the values of its loads a second apart."""
    samples = max(len(load.values) for load in files.loads)
    q = np.zeros((files.modes.size + len(files.loads), samples))
    for row, load in enumerate(files.loads, start=files.modes.size):
        if load.way == "values":
            q[row] = load.values
    history = ModalHistory(files.event, coordinate_numbers(files.modes, len(files.loads)), q, STATIC_STEP, 0.0)
    return EventRecord(history, history.duration, is_static=True)


def _grid_of(history: ModalHistory) -> UniformGrid:
    return UniformGrid(history.start, history.step, history.q.shape[1])


def _put(history: ModalHistory, loads: Sequence[tuple[int, LoadRecord]]) -> None:
    """Write the values of loads at the instants of a record into its rows."""
    grid = _grid_of(history)
    for row, load in loads:
        history.q[row : row + 1, :] = load.at(grid)[np.newaxis].astype(history.q.dtype, copy=False)


def _too_short(files: EventFiles, source: LoadSource, load: LoadRecord, base: UniformGrid) -> Problem:
    assert source.path is not None
    return Problem(
        "short_load",
        f"{source.path.name}: column {source.column}",
        f"the load '{source.name}' lasts from {load.grid.start:.9g} to {load.grid.end:.9g} s, and the kept record of "
        f"event '{files.event}' from {base.start:.9g} to {base.end:.9g} s, which it has to cover within half a step",
        "Record the load longer, or correct shift_s; nothing is extrapolated",
    )


def _too_fine(files: EventFiles, source: LoadSource, load: LoadRecord, base: UniformGrid) -> Problem:
    assert source.path is not None
    return Problem(
        "fine_load",
        f"{source.path.name}: column time_s",
        f"the step of the load '{source.name}' is {load.grid.step:g} s, and that of event '{files.event}' "
        f"{base.step:g} s, more than {FINEST} times as long",
        "Check that both are in s, or give the load at a longer step",
    )


def _overshoot(files: EventFiles, source: LoadSource, load: LoadRecord, values: NDArray[np.floating]) -> list[Problem]:
    """Warning about a load whose interpolant leaves the range of its samples."""
    share = load.overshoot(values)
    if share <= OVERSHOOT or source.path is None:
        return []
    what = f"between its samples the load '{source.name}' of event '{files.event}' leaves their range by {share:.0%} "
    what += f"of it, more than {OVERSHOOT:.0%}: it has steps or content above half its sampling rate"
    remedy = "Set interpolation = 'linear' for steps, which invents no extremes, or sample the load more finely"
    return [Problem("load_overshoot", f"{source.path.name}: column {source.column}", what, remedy)]
