"""The welds of a group under every variant, as one array."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.case import Case
from fatigue.life.mission import Plan
from fatigue.pipeline.count.bounds import Screening
from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.multiaxial.method import DECIDING
from fatigue.pipeline.sensitivity import notes
from fatigue.pipeline.sensitivity.closed import Floats, Varied
from fatigue.pipeline.sensitivity.recount import counted_again
from fatigue.pipeline.sensitivity.sampling import OtherSampling
from fatigue.pipeline.sensitivity.toes import Toes, toes_of_curve
from fatigue.pipeline.sensitivity.variants import varied
from fatigue.pipeline.sensitivity.worst import FEW_STATIONS, NOWHERE, Again, Weld, worst_of_welds
from fatigue.pipeline.solve.model import Model
from fatigue.results.dictionary.sensitivity import AS_ASSESSED, BASES, BOUND, EXACT, UNDECIDED, VARIANTS

FIELDS = ("utilisation", "fulfilled", "station", "face", "basis", "recounted", "note")


@dataclass(frozen=True, slots=True, eq=False)
class Job:
    """What a group of welds is judged with: the events as they were counted and as they are sampled otherwise.

    ``counts_again`` is False of a large job, which is only told what closed forms and bounds say.
    """

    loads: Sequence[EventLoad]
    plan: Plan
    screening: Screening | None
    sampling: OtherSampling
    counts_again: bool


def variants_of(case: Case, sampling: OtherSampling) -> tuple[str, ...]:
    """Variants that a case is looked at under, in the order of ``VARIANTS``."""
    left_out = {"upsample_1", "upsample_auto"} - {sampling.variant}
    if case.curve.extension == "none":
        left_out.add("no_knee")
    if case.multiaxial.method == "off":
        left_out |= {"shear_path_range", "shear_asme"}
    return tuple(name for name in VARIANTS if name not in left_out)


def group_sensitivity(model: Model, result: GroupResult, job: Job) -> Floats:
    """Every weld of a group under every variant, (v, w, f) with the ``FIELDS``.

    Raises
    ------
    NumericalError : a stress is not finite
    """
    names, stations = variants_of(model.case, job.sampling), model.stations
    found = np.full((len(names), len(stations.welds), len(FIELDS)), np.nan)
    for toes in toes_of_curve(model, result, job.plan, job.loads, job.screening):
        for number, name in enumerate(names):
            under = varied(name, toes, job.sampling)
            welds = _unchanged(toes, under) if isinstance(under, int) else _changed(name, toes, under, job)
            for weld, row in zip(toes.welds, welds, strict=True):
                found[number, weld] = row
    return found


def _unchanged(toes: Toes, note: int) -> list[tuple[float, ...]]:
    """Welds whose utilisation is that of the assessment."""
    basis = BASES.index(AS_ASSESSED)
    same = Varied(toes.utilisation, toes.utilisation)
    welds = worst_of_welds(same, toes.toe, toes.first, toes.utilisation)
    return [_row(_at(toes, weld), note, basis) for weld in welds]


def _changed(name: str, toes: Toes, under: Varied, job: Job) -> list[tuple[float, ...]]:
    """Welds under a variant, their points counted again where that decides and can be done."""
    again, limit = None, under.note or notes.BOUNDED
    if under.rule is not None:
        if not job.counts_again:
            limit = notes.LARGE
        elif toes.case.multiaxial.method in DECIDING:
            limit = notes.EXPECTED_SHEAR if under.note == notes.EXPECTED else notes.SHEAR_DECIDES
        else:
            again = _again(toes, under, job, sampled=name == job.sampling.variant)
    few = 0 if name == "upsample_auto" else FEW_STATIONS  # upsampling takes as long as counting
    welds = worst_of_welds(under, toes.toe, toes.first, toes.utilisation, again, few)
    return [_row(_at(toes, weld), _limit(weld, under, limit, again is not None)) for weld in welds]


def _limit(weld: Weld, under: Varied, limit: int, counts_again: bool) -> int:
    """Code of the note about what limits the number of a weld: what could not be counted, not what need not be."""
    if BASES[weld.basis] == EXACT:
        return notes.NOTHING
    if BASES[weld.basis] not in (BOUND, UNDECIDED):
        return under.note
    if not counts_again:
        return limit
    if BASES[weld.basis] == UNDECIDED:
        return notes.MOST_COUNTED if weld.recounted else notes.LONG_RECORDS
    return under.note


def _again(toes: Toes, under: Varied, job: Job, *, sampled: bool) -> Again:
    """What counts some stations of a curve again under a variant, whose records may be ``sampled`` otherwise."""
    rule, size = under.rule, toes.stress.size if under.size is None else under.size
    assert rule is not None

    def counted(rows: NDArray[np.intp]) -> Floats | None:
        loads = job.sampling.sampled() if sampled else job.loads
        return None if loads is None else counted_again(toes.stress.at(rows), rule, size[rows], loads, toes.plan)

    return counted


def _at(toes: Toes, weld: Weld) -> Weld:
    """The same with the station by its number in the group."""
    if weld.station == NOWHERE:
        return weld
    return Weld(weld.utilisation, weld.fulfilled, int(toes.rows[weld.station]), weld.face, weld.basis, weld.recounted)


def _row(weld: Weld, note: int, basis: int | None = None) -> tuple[float, ...]:
    of_basis = weld.basis if basis is None else basis
    return (weld.utilisation, weld.fulfilled, weld.station, weld.face, of_basis, weld.recounted, note)
