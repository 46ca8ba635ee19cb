"""What adds up while groups of welds stream by, and the warnings that only all of them together give."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from fatigue.errors import Problem
from fatigue.pipeline.checks.verdict import Decisive
from fatigue.pipeline.count.block import TIERS
from fatigue.pipeline.count.joined.matters import Transitions
from fatigue.pipeline.count.outside_band import OutsideBand, bands_of, outside_of, spectra_of
from fatigue.pipeline.count.worst import WorstPoint
from fatigue.pipeline.multiaxial.doubt import ShearTally
from fatigue.pipeline.run.work import Work
from fatigue.pipeline.run.workers import Group
from fatigue.pipeline.solve.absent_loads import load_warnings
from fatigue.pipeline.solve.body import Body
from fatigue.pipeline.tables.governing import worst_at_corners
from fatigue.pipeline.tables.warnings.sampling import sampling_warnings
from fatigue.pipeline.tables.warnings.stress import StressExtent
from fatigue.pipeline.tables.warnings.summary import WarningSummary
from fatigue.weld.load_extent import LoadExtent

Progress = Callable[[str, int, int], None]


@dataclass(slots=True, eq=False)
class Tally:
    """What adds up while groups of welds stream by.

    ``stations`` are counted by the tier that settled them. ``samples_per_peak`` is the smallest of each event.
    ``warnings`` has the warnings about the welds in the order of their groups, ``extents`` how large their
    forces are, ``stress`` how large their stress ranges, ``outside_band`` the points that the spectra miss,
    ``transitions`` those at which the order of the events may matter, ``shear`` those where the model of shear does,
    ``checks`` those that decide beside the toe.
    """

    total: int
    progress: Progress
    groups: int = 0
    reused: int = 0
    fulfilled: bool = True
    stations: dict[str, int] = field(default_factory=dict)
    warnings: WarningSummary = field(default_factory=WarningSummary)
    outside_band: OutsideBand = field(default_factory=OutsideBand)
    samples_per_peak: dict[str, float] = field(default_factory=dict)
    extents: list[LoadExtent] = field(default_factory=list)
    stress: StressExtent = field(default_factory=StressExtent)
    transitions: Transitions = field(default_factory=Transitions)
    checks: Decisive = field(default_factory=Decisive)
    shear: ShearTally = field(default_factory=ShearTally)

    def add(self, group: Group, work: Work, worst: Sequence[WorstPoint]) -> None:
        """Count a group of welds that has been written, ``worst`` the points that decide about them."""
        result = group.result
        self.groups += 1
        self.reused += group.reused
        self.fulfilled &= all(result.mission.utilisation[point.station, point.face] <= 1.0 for point in worst)
        for number, tier in enumerate(TIERS):
            settled = int(np.count_nonzero(result.tier == number))
            self.stations[tier or "counted"] = self.stations.get(tier or "counted", 0) + settled
        self.checks.add(result.checks, work.groups.body.case.checks.counts)
        self.warnings.add(group.model.warnings)
        self.warnings.add(worst_at_corners(group.model, result.mission, worst))
        self.extents += group.model.extents
        self.stress.add(group.model, result)
        self.transitions.add(group.model.stations, result)
        self.shear.add(group.model.stations, result)
        self.outside_band.add(group.model.stations, outside_of(result), spectra_of(result, work.plan))
        for passed, samples_per_peak in zip(work.plan.passes, result.of_events("samples_per_peak"), strict=True):
            fewest = float(np.nanmin(samples_per_peak, initial=np.inf))
            self.samples_per_peak[passed.event] = min(fewest, self.samples_per_peak.get(passed.event, np.inf))
        self.progress("assessing", min(sum(self.stations.values()), self.total), self.total)


def body_warnings(body: Body, work: Work, done: Tally) -> list[Problem]:
    """Warnings that only all welds together give: about loads that are not there, stress, sampling and spectra."""
    files = [event.history or body.case.path.name for event in body.case.mission.event]
    of_stress = done.stress.warnings(work.loads, body.coordinates, files)
    of_spectra = done.outside_band.warnings(bands_of(work.loads))
    of_order = done.transitions.warnings(work.plan)
    of_sampling = sampling_warnings(body, work.loads, done.samples_per_peak)
    of_shear = done.shear.warnings(work.loads)
    of_checks = done.checks.warnings(body.case.path.name)
    of_order = [*of_order, *of_shear, *of_checks]
    return [*load_warnings(body, done.extents), *of_stress, *of_sampling, *of_spectra, *of_order]
