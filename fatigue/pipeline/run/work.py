"""The job of an assessment, opened: any group of welds can be assessed from it, in any order, by any thread."""

import hashlib
import logging
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from fatigue.case import Case, numbers_text
from fatigue.errors import DataError, refuse
from fatigue.life.bounds.path_extent import path_extent
from fatigue.life.bounds.screening import modal_extent
from fatigue.life.mission import Plan
from fatigue.pipeline.checks.group import group_checks, has_checks
from fatigue.pipeline.count.bounds import Screening
from fatigue.pipeline.count.group import assess_group
from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.count.worst import HistogramPoints
from fatigue.pipeline.mission.event_load import EventLoad, held_copies, kept_single_record
from fatigue.pipeline.mission.events import event_loads
from fatigue.pipeline.mission.precision import Precision, is_large
from fatigue.pipeline.multiaxial.counted import long_paths
from fatigue.pipeline.multiaxial.found import MODELS
from fatigue.pipeline.multiaxial.group import Shear, group_multiaxial
from fatigue.pipeline.multiaxial.method import DECIDING, decided_by
from fatigue.pipeline.run.checkpoint import state_key
from fatigue.pipeline.sensitivity.group import Job, group_sensitivity
from fatigue.pipeline.sensitivity.sampling import OtherSampling, other_sampling
from fatigue.pipeline.solve.body import conversion_file, register_file
from fatigue.pipeline.solve.model import Model, solve_group
from fatigue.pipeline.solve.weld_groups import BLOCK, GROUPS, LARGEST_GROUP, SMALLEST_GROUP, WeldGroups
from fatigue.results import input_register, software_versions
from fatigue.side_by_side import in_order

log = logging.getLogger(__name__)

WORST_PATHS = 4e6  # samples of the paths of all worst points together: some seconds; of more only those that matter,
SMALL_SHARE = 1e-3  # from this share of the damage limit on
SHARE = 0.1  # of the damage limit: a point proven to stay below it lasts ten times as long as it must


@dataclass(frozen=True, slots=True)
class ScreeningOptions:
    """Which points may go without counting, and of which the histograms are kept, as the user asks for it.

    A proven bound below ``share`` of the damage limit is enough. 0: every point is counted. None: ``SHARE`` for a
    large job, else 0; see ``mission.precision``. ``proves_worst``: see ``bounds.Screening``. ``histogram``: see
    ``worst.histogram_points``. ``precision``: in which cycles are counted.
    """

    share: float | None = None
    proves_worst: bool = True
    histogram: HistogramPoints = "worst"
    precision: Precision = "auto"


@dataclass(frozen=True, slots=True, eq=False)
class Work:
    """What every group of welds needs to be assessed; threads may share it.

    ``screening`` is None where every point is to be counted. ``kept_from`` is the utilisation from which the cycles of
    the worst point of a weld are kept: the cycles of all welds of a train would fill the disk. ``histogram`` says of
    which points histograms are kept. ``sampling`` has the records sampled otherwise than they are counted, ``shear``
    says how shear is counted at the toes, None: not at all.
    """

    groups: WeldGroups
    loads: tuple[EventLoad, ...]
    plan: Plan
    screening: Screening | None
    kept_from: float
    histogram: HistogramPoints
    sampling: OtherSampling
    shear: Shear | None = None

    @property
    def counts_all_paths(self) -> bool:
        """Whether a method of the path counter decides about every toe point."""
        return self.shear is not None and self.shear.counts_all

    @property
    def factors(self) -> tuple[int, ...]:
        """By how much the record of each event is upsampled."""
        return tuple(load.upsample for load in self.loads)

    def group(self, number: int) -> tuple[Model, GroupResult]:
        """One group of welds, solved, and its result."""
        model = solve_group(self.groups, number)
        result = assess_group(model, self.loads, self.plan, self.screening)
        if self.shear is not None:
            result = replace(result, multiaxial=group_multiaxial(model, result, self.loads, self.plan, self.shear))
            if self.shear.method in DECIDING:
                result = decided_by(self.shear.method, model, result, self.plan)
        if has_checks(model.case):
            result = replace(result, checks=group_checks(model, result, self.loads, self.plan))
        job = Job(self.loads, self.plan, self.screening, self.sampling, counts_again=self.kept_from == 0.0)
        return model, replace(result, sensitivity=group_sensitivity(model, result, job))


def open_work(
    groups: WeldGroups,
    plan: Plan,
    options: ScreeningOptions,
    scratch: Path,
    threads: int | None,
    factors: Sequence[int] | None = None,
) -> Work:
    """The work of a job, with the records of its events read and its screening prepared.

    ``scratch`` is a folder for what memory cannot hold; ``threads`` are by default one per processor core; ``factors``
    as of ``event_loads``.
    """
    loads = event_loads(groups, plan, scratch / "histories", threads, factors, options.precision)
    samples = [load.counted.q.shape[1] for load in loads]
    large = SHARE if is_large(int(groups.body.lines.begin[-1]), samples) else 0.0
    named = groups.body.case.multiaxial.method in DECIDING  # no bound says what shear does to the points it settles
    share = 0.0 if named else large if options.share is None else options.share
    log.info("points proven to stay below %g of the damage limit are not counted", share)
    screening = None if share == 0.0 else screening_of(share, options.proves_worst, loads, scratch, threads)
    sampling = other_sampling(groups, loads, plan)
    shear = shear_of(groups.body.case, loads, 0.0 if named else _worst_paths_from(groups, loads, large), threads)
    return Work(
        groups, loads, plan, screening, kept_from=large, histogram=options.histogram, sampling=sampling, shear=shear
    )


def _worst_paths_from(groups: WeldGroups, loads: Sequence[EventLoad], large: float) -> float:
    """Utilisation from which on the path of the worst point of a weld is counted, whatever settles it."""
    samples = len(groups.body.welds) * sum(load.counted.q.shape[1] for load in loads)
    return max(large, SMALL_SHARE if samples > WORST_PATHS else 0.0)


def shear_of(case: Case, loads: Sequence[EventLoad], counted_from: float, threads: int | None) -> Shear | None:
    """How the case wants shear at the toes, with the records prepared for its bounds on some threads.

    Raises
    ------
    DataError : a method of the path counter is named, and a record is too long for it
    """
    asked = case.multiaxial
    if asked.method == "off":
        return None
    if asked.method in MODELS:
        as_counted = ((load.counted.event, load.counted.q.shape[1], load.upsample) for load in loads)
        refuse(DataError, long_paths(case.path.name, as_counted))
    extents = in_order(lambda load: path_extent(load.counted.q, load.residue, load.covariance), loads, threads)
    return Shear(asked.method, asked.beta, asked.alpha, tuple(extents), counted_from)


def screening_of(
    share: float, proves_worst: bool, loads: Sequence[EventLoad], scratch: Path, threads: int | None
) -> Screening:
    """What settles points without counting, prepared on some threads; see ``ScreeningOptions`` and ``open_work``."""
    samples = [load.counted.q.shape[1] for load in loads]
    given = [0 if load.is_upsampled else n for load, n in zip(loads, samples, strict=True)]
    held = held_copies(loads[0].counted.q.shape[0], given, samples)
    return Screening(
        share=share,
        proves_worst=proves_worst,
        extents=tuple(in_order(lambda load: modal_extent(load.counted.q, load.residue, load.known), loads, threads)),
        records=tuple(
            in_order(
                lambda job: job[0].single or kept_single_record(job[0].counted.q, scratch, job[0].known, held=job[1]),
                zip(loads, held, strict=True),
                threads,
            )
        ),
    )


def input_paths(case: Case) -> list[Path]:
    """Every input file of a case, the case file included."""
    files = {case.path, *case.input_files().values(), *filter(None, [register_file(case), conversion_file(case)])}
    return sorted(files)


def inputs_of(case: Case) -> list[dict[str, str]]:
    """Every input file of a case with its hash."""
    return input_register(input_paths(case), case.path.parent)


def key_of(case: Case, inputs: Sequence[dict[str, str]], options: ScreeningOptions) -> str:
    """Key of everything the numbers of a job depend on: equal keys, equal bytes.

    Who answers for the report of the case is no part of it.
    """
    cut = (GROUPS, SMALLEST_GROUP, LARGEST_GROUP, BLOCK)
    return state_key(
        {
            "inputs": _without_identity(case, inputs),
            "software": software_versions(),
            "groups": cut,
            "counted": asdict(options),
        }
    )


def _without_identity(case: Case, inputs: Sequence[dict[str, str]]) -> list[dict[str, Any]]:
    """The inputs, the case file as it would be without ``[report]``."""
    if case.report.is_empty:
        return list(inputs)
    content = numbers_text(case.text).encode()
    of_case = {"bytes": len(content), "sha256": hashlib.sha256(content).hexdigest()}
    return [entry | of_case if entry["file"] == case.path.name else entry for entry in inputs]
