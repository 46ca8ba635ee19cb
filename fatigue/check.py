"""The dry run as a story: read and check everything, and say how large the job is, before anything is counted.

Every file is read as an assessment reads it, and all welds are solved, so that whatever an assessment would refuse is
refused here. What is there is added up to numbers of welds, stations and stress samples. One group of the welds is
counted under a chunk of one record, and from its time follows the time of the whole job.
"""

import math
import os
import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from fatigue.case import Case, given_case
from fatigue.errors import DataError, Problem, refuse
from fatigue.pipeline.forecast.band_trial import band_warnings
from fatigue.pipeline.forecast.needs import job_needs, size_text
from fatigue.pipeline.forecast.size import job_size
from fatigue.pipeline.forecast.spare import shortage_warnings
from fatigue.pipeline.forecast.trial import JobTime, job_time
from fatigue.pipeline.forecast.upsampling_trial import foretold, upsampling_text
from fatigue.pipeline.mission.counted import EventCount, event_counts, listed
from fatigue.pipeline.mission.events import mean_levels
from fatigue.pipeline.mission.gravity import HeldGravity, gravity_audit, has_gravity
from fatigue.pipeline.mission.in_words import sequence_texts
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.multiaxial.counted import long_paths
from fatigue.pipeline.multiaxial.found import MODELS
from fatigue.pipeline.solve.absent_loads import load_warnings
from fatigue.pipeline.solve.body import read_body
from fatigue.pipeline.solve.model import solve_group
from fatigue.pipeline.solve.point_stress import point_stress
from fatigue.pipeline.solve.weld_groups import weld_groups
from fatigue.pipeline.tables.warnings.summary import WarningSummary
from fatigue.report.identity.identity import identity_of
from fatigue.ride.checked import ChannelLine, checked_channels
from fatigue.shown import few, visible
from fatigue.stages import stage
from fatigue.weld.load_extent import LoadExtent


@dataclass(frozen=True, slots=True, eq=False)
class CheckedCase:
    """Sizes of a case that passed every check, and the warnings about it.

    Of the lines that the weld register lists and that are not assessed, ``excluded`` are excluded and ``candidates``
    are candidates. ``samples`` are stress samples of one face: stations times kept samples, over all events. ``counts``
    says what each event counts.
    ``estimated_s`` is the processor time of an assessment with its default options [s], ``estimated_exact_s`` the time
    with every point counted, ``estimate`` what they consist of. ``estimated_memory_MB`` is the largest memory that it
    takes, ``gravity`` is what the mean of q of each event holds of the dead load, where the body has a gravity load;
    ``estimated_scratch_MB`` are files that are gone at its end, ``estimated_result_MB`` those that stay.
    ``sequences`` say which orders of events are counted; ``stress_points`` is the number of points beside welds and in
    parent metal, which the estimates leave out.
    ``channels`` are those of the events, which no assessment reads; ``warnings`` are summed up as in an assessment.
    """

    title: str
    welds: int
    excluded: int
    candidates: int
    parts: int
    stations: int
    modes: int
    unit_loads: int
    events: int
    samples: int
    distance_km: float
    counts: tuple[EventCount, ...]
    estimated_s: float
    estimated_exact_s: float
    estimated_memory_MB: float  # noqa: N815 - the unit keeps its spelling
    estimated_scratch_MB: float  # noqa: N815
    estimated_result_MB: float  # noqa: N815
    estimate: JobTime
    gravity: tuple[HeldGravity, ...]
    sequences: tuple[str, ...]
    warnings: tuple[Problem, ...]
    stress_points: int = 0
    channels: tuple[ChannelLine, ...] = ()

    @property
    def has_left_out(self) -> bool:
        """Whether the weld register lists lines that are not assessed."""
        return self.excluded + self.candidates > 0

    def as_record(self) -> dict[str, Any]:
        """The sizes for machines."""
        nested = ("warnings", "estimate", "counts", "gravity", "channels")
        plain = {name: getattr(self, name) for name in self.__slots__ if name not in nested}
        return plain | {
            "counts": [asdict(one) | {"counts": one.counts} for one in self.counts],
            "estimate": asdict(self.estimate),
            "gravity": [one.as_record() for one in self.gravity],
            "channels": [asdict(one) for one in self.channels],
            "warnings": [str(problem) for problem in self.warnings],
        }

    def _space(self) -> str:
        """Memory and disk in words."""
        memory, scratch, result = (
            size_text(1e6 * size)
            for size in (self.estimated_memory_MB, self.estimated_scratch_MB, self.estimated_result_MB)
        )
        return f"{memory} of memory; on disk {scratch} of scratch files and {result} of result"

    def as_text(self) -> str:
        """The sizes for people."""
        candidates = f"{self.candidates} candidate{'s' * (self.candidates != 1)}"
        return "\n".join(
            [
                f"{visible(self.title)}: the case is complete and consistent",
                f"  welds            {self.welds} in {self.parts} straight parts, {self.stations} stations, both faces",
                *([f"  not assessed     {self.excluded} excluded, {candidates}"] * self.has_left_out),
                f"  modes            {self.modes}",
                *([f"  unit loads       {self.unit_loads}"] * (self.unit_loads > 0)),
                *([f"  stress points    {self.stress_points}, not in the estimates"] * (self.stress_points > 0)),
                f"  events           {self.events}, {self.distance_km:.4g} km simulated",
                *(f"    {line}" for line in listed(self.counts)),
                *(f"  {'' if i else 'sequences':16} {text}" for i, text in enumerate(self.sequences)),
                *(f"  {'' if i else 'channels':16} {one.as_text()}" for i, one in enumerate(self.channels)),
                f"  stress samples   {2 * self.samples:.3g}",
                f"  upsampling       {upsampling_text(self.estimate.upsample)}",
                *(f"  {label:<16} {line}" for label, line in _gravity_lines(self.gravity)),
                f"  estimated time   {_time_text(self.estimate)}",
                f"  estimated space  {self._space()}",
                f"  warnings         {sum(warning.count for warning in self.warnings)}",
            ]
        )


def check_case(case: Case | Path | str, *, strict: bool = False) -> CheckedCase:
    """Sizes of a case, or of the case of a file, that is read and checked with all its files.

    ``strict`` takes unknown columns for errors.

    Raises
    ------
    CaseError, DataError : what an assessment would refuse, this refuses with the same words
    """
    case = given_case(case)
    identity_of(case)  # refuses a logo or template that is unfit
    stage("reading and checking the case")
    begin = time.process_time()
    body = read_body(case, strict=strict)
    plan, record_warnings = mission_plan(body)
    channels, of_channels = checked_channels(case)
    warnings = WarningSummary()
    warnings.add((*body.warnings, *point_stress(body)[1], *record_warnings, *of_channels))
    extents: list[LoadExtent] = []
    parts = stations = 0
    stage("solving the weld lines")
    with TemporaryDirectory() as scratch:
        groups, upsampled = weld_groups(body, Path(scratch)), foretold(body, plan, Path(scratch))
        for number in range(len(groups)):
            model = solve_group(groups, number)
            parts += len(model.lines)
            stations += len(model.stations)
            warnings.add(model.warnings)
            extents += model.extents
            upsampled.add(model.stations.treated)
        warnings.add(load_warnings(body, extents))
        gravity: tuple[HeldGravity, ...] = ()
        if has_gravity(body):
            gravity, of_gravity = gravity_audit(groups, mean_levels(body, Path(scratch)))
            warnings.add(of_gravity)
        stage("timing a small piece")
        read_s = time.process_time() - begin
        sample = solve_group(groups, len(groups) // 2)
        factors = upsampled.factors(case.counting.upsample, plan)
        if case.multiaxial.method in MODELS:
            as_counted = ((p.event, f * p.samples, f) for p, f in zip(plan.passes, factors, strict=True))
            refuse(DataError, long_paths(case.path.name, as_counted))
        estimate = job_time(plan, sample, stations, factors, read_s, Path(scratch))
        warnings.add(band_warnings(sample, plan, Path(scratch)))
    needs = job_needs(job_size(body, plan, factors=estimate.upsample))
    warnings.add(tuple(shortage_warnings(needs, case.path.parent)))
    samples = stations * sum(p.samples for p in plan.passes)
    return CheckedCase(
        title=case.title,
        welds=len(body.welds),
        excluded=sum(row.status == "excluded" for row in body.excluded),
        candidates=sum(row.status == "candidate" for row in body.excluded),
        parts=parts,
        stations=stations,
        modes=len(body.modes.mode),
        unit_loads=len(body.coordinates.unit_loads),
        events=len(plan.passes),
        samples=samples,
        distance_km=sum(p.length or 0.0 for p in plan.passes),
        counts=event_counts(case, plan),
        estimated_s=estimate.total,
        estimated_exact_s=estimate.total_exact,
        estimated_memory_MB=round(needs.memory / 1e6, 1),
        estimated_scratch_MB=round(needs.scratch / 1e6, 1),
        estimated_result_MB=round(needs.result / 1e6, 1),
        estimate=estimate,
        gravity=gravity,
        sequences=tuple(sequence_texts(plan)),
        warnings=warnings.listed(),
        stress_points=0 if body.points is None else len(body.points),
        channels=channels,
    )


def _gravity_lines(gravity: Sequence[HeldGravity]) -> Iterator[tuple[str, str]]:
    """What the mean of q of the events holds of the dead load, verdict by verdict, in words."""
    verdicts = dict.fromkeys(one.in_words for one in gravity)
    for number, words in enumerate(verdicts):
        alike = [one for one in gravity if one.in_words == words]
        told = f"beta {_span([one.beta for one in alike])}, cosine {_span([one.cos for one in alike])}"
        events = [f"'{one.event}'" for one in alike]
        yield "" if number else "dead load", f"{words} ({told}): {few(events)}"


def _span(numbers: Sequence[float]) -> str:
    """The smallest and the largest of some numbers, one where they are shown alike; a dash where none is known."""
    known = [number for number in numbers if not math.isnan(number)]
    shown = list(dict.fromkeys(f"{number:.3g}" for number in (min(known), max(known)))) if known else ["-"]
    return " to ".join(shown)


def _time_text(needed: JobTime) -> str:
    """How long it takes, and what that includes, in words."""
    cores = os.cpu_count() or 1
    shared = needed.events + needed.counting
    counting = f"{_duration(needed.counting)} counting"
    if needed.screened:
        counting += f" where bounds settle what they can ({_duration(needed.counting_exact)} with --exact)"
    return (
        f"{_duration(needed.total)} of one processor core, {_duration(needed.total - shared + shared / cores)} on the "
        f"{cores} of this machine: {counting}, {_duration(needed.report)} the report; the first run of a version "
        "compiles for half a minute more"
    )


def _duration(seconds: float) -> str:
    if seconds < 60.0:
        return f"{max(seconds, 1.0):.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 7200.0 else f"{seconds / 3600.0:.1f} h"
