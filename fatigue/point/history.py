"""Stress over time at a station of a weld line: what was counted, with its constants and factors, event after event."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, NamedTuple, get_args

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.errors import CaseError, Problem
from fatigue.life.counting.vertex import move, shifts
from fatigue.life.records.history import stress_chunks
from fatigue.life.records.spool import Samples
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.point.found import Station
from fatigue.point.reopened import Reopened, counted_load, event_numbers, forget, sampled_load, solved_station
from fatigue.results import Column
from fatigue.results.dictionary.decided.history import AT_VERTICES, HISTORY

Floats = NDArray[np.float64]
Instants = Literal["counted", "file"]  # every instant that was counted, or the samples of the file only

PIECE = 1 << 16  # samples that are in memory at a time, at least
COMPONENTS = ("membrane", "bending", "in_plane_shear", "twist_shear", "transverse_shear")
SIDES = np.array([[1.0], [-1.0]])  # sign of the bending stress at the top and at the bottom face


class Piece(NamedTuple):
    """Some successive samples of a history.

    ``time`` (t,) is that of the file [s], ``stress`` (5, t) are the ``COMPONENTS``, bending and twist of the top face,
    ``counted`` (2, t) is what cycles are counted on, at the top and at the bottom face [MPa].
    """

    time: Floats
    stress: Floats
    counted: Floats

    @property
    def structural(self) -> Floats:
        """Structural stress (2, t) of the top and the bottom face [MPa]."""
        return np.asarray(self.stress[0] + SIDES * self.stress[1])


@dataclass(frozen=True, slots=True, eq=False)
class EventHistory:
    """The history of a station in one pass of an event, as long as the record of the event is there.

    Attributes
    ----------
    station : where
    components : (5, c) stress per unit of each coordinate [MPa]
    load : the event
    is_static : whether it is a static load case, whose values follow each other and have no times
    every : of how many samples of ``load`` one is taken
    """

    station: Station
    components: Floats
    load: EventLoad
    is_static: bool
    every: int = 1

    @property
    def event(self) -> str:
        """Name of the event."""
        return self.load.counted.event

    @property
    def step(self) -> float:
        """Time between samples [s]."""
        return self.load.counted.step * self.every

    @property
    def samples(self) -> int:
        """Number of samples."""
        return int(-(-self.load.counted.q.shape[1] // self.every))

    @property
    def at_vertices(self) -> bool:
        """Whether reversals were counted at their vertices, between the samples."""
        return self.load.vertex and self.every == 1

    @property
    def constant(self) -> Floats:
        """Constants in the components (5,) [MPa]: of unit loads and of means that were removed."""
        return np.asarray(self.load.stress_factor * (self.components @ self.load.offset))

    def pieces(self) -> Iterator[Piece]:
        """The history from its first sample to its last, some ``PIECE`` samples at a time."""
        modal, constant = self.load.stress_factor * self.components, self.constant[:, None]
        first, step = 0, self.load.counted.step
        for padded in _with_neighbours(modal, self.load.counted.q, recurs=self.load.record.recurs):
            own = padded[:, 1:-1]
            at = first + np.arange(own.shape[1])
            level = constant[0] + SIDES * constant[1]
            counted = (_at_vertices(padded) if self.at_vertices else own[0] + SIDES * own[1]) + level
            some = slice(-first % self.every, None, self.every)
            time = self.load.counted.start + step * at[some].astype(np.float64)
            if time.size:
                yield Piece(time, (own + constant)[:, some], counted[:, some])
            first += own.shape[1]


def event_histories(
    inputs: Reopened, station: Station, event: str | None = None, *, instants: Instants = "counted"
) -> Iterator[EventHistory]:
    """Histories of a station, event after event or of one; each is good until the next is asked for.

    Raises
    ------
    DataError : no such event, or records and forces that cannot be read
    """
    numbers = event_numbers(inputs, event)
    model, index = solved_station(inputs, station)
    treated = model.stations.treated
    components = np.stack([getattr(treated, name)[index] for name in COMPONENTS])
    for number in numbers:
        is_static = inputs.body.case.mission.event[number].history is None
        load = counted_load(inputs, number) if instants == "counted" else sampled_load(inputs, number)
        yield EventHistory(station, components, load, is_static, 1 if instants == "counted" else load.upsample)
        forget(load)


def refuse_unknown_instants(instants: str) -> None:
    """Refuse what are no instants of a history.

    Raises
    ------
    CaseError : something else than ``counted`` and ``file``
    """
    if instants not in get_args(Instants):
        what = f"{instants!r} are no instants of a history"
        raise CaseError(Problem("argument", "instants", what, "Say 'counted' or 'file'"))


def piece_columns(history: EventHistory, piece: Piece, *, at_vertices: bool) -> dict[str, Floats]:
    """Numbers of the table of a history by column, ``event`` excepted; ``at_vertices``: with ``AT_VERTICES``."""
    values = [piece.time, *piece.stress, *piece.structural, *(piece.counted if at_vertices else ())]
    return {column.name: value for column, value in zip(columns_of(at_vertices=at_vertices)[1:], values, strict=True)}


def history_frame(histories: Iterator[EventHistory], *, at_vertices: bool) -> pd.DataFrame:
    """Histories as one table, event above event, all of it in memory."""
    frames = [
        pd.DataFrame({"event": history.event} | piece_columns(history, piece, at_vertices=at_vertices))
        for history in histories
        for piece in history.pieces()
    ]
    return pd.concat(frames, ignore_index=True)


def columns_of(*, at_vertices: bool) -> tuple[Column, ...]:
    """Columns of the table of a history; two more where reversals were counted at their vertices."""
    return (*HISTORY, *AT_VERTICES) if at_vertices else HISTORY


def reads_vertices(inputs: Reopened, instants: Instants) -> bool:
    """Whether the case has reversals read at their vertices, and the history is of the instants that were counted."""
    return instants == "counted" and inputs.body.case.counting.reversals == "vertex"


def _with_neighbours(modal: Floats, q: Samples, *, recurs: bool) -> Iterator[Floats]:
    """Stress (k, t + 2) of some samples, the one before and the one after them; the ends once more where none is.

    Of a record that recurs the first sample follows on the last.
    """
    first, last = (modal @ q[:, some].astype(np.float64) for some in (slice(0, 1), slice(-1, None)))
    before, after = (last, first) if recurs else (first, last)
    waiting: list[Floats] = []
    for chunk in stress_chunks(modal, q):
        waiting.append(chunk)
        if len(waiting) > 1 and sum(one.shape[1] for one in waiting) > PIECE:
            *ready, held = waiting
            yield np.concatenate([before, *ready, held[:, :1]], axis=1)
            before, waiting = ready[-1][:, -1:], [held]
    yield np.concatenate([before, *waiting, after], axis=1)


def _at_vertices(padded: Floats) -> Floats:
    """Structural stress (2, t) of both faces, each reversal at its vertex, of samples with neighbours (5, t + 2)."""
    membrane, bending = np.ascontiguousarray(padded[:2])
    faces = np.empty((2, padded.shape[1]))
    for face, side in enumerate(SIDES.ravel()):
        shift, m, b = np.empty((3, padded.shape[1]))
        shifts(membrane + side * bending, False, shift)
        move(membrane, shift, m)
        move(bending, shift, b)
        faces[face] = m + side * b
    return faces[:, 1:-1]
