"""How large a job is: the numbers that time, memory and scratch files follow from."""

import os
from collections.abc import Sequence
from dataclasses import dataclass

from fatigue.life.mission import Plan
from fatigue.pipeline.count.worst import HistogramPoints
from fatigue.pipeline.forecast.throats import counted_throats
from fatigue.pipeline.mission.precision import Precision, counts_single, is_large
from fatigue.pipeline.multiaxial.method import DECIDING
from fatigue.pipeline.run.work import SHARE
from fatigue.pipeline.solve.body import Body
from fatigue.pipeline.solve.weld_groups import GROUPS, LARGEST_GROUP, SMALLEST_GROUP

SCREENED = 0.3  # of the points are counted where bounds settle points, or as much time goes into their bounds
HIGHLY_USED = 0.02  # of the points: they use up a tenth of the damage limit
AUTOMATIC = 4  # upsampling assumed where the program finds it: a record of 5 samples per peak needs it


@dataclass(frozen=True, slots=True)
class JobSize:
    """How large a job is.

    Attributes
    ----------
    modes, stations, welds : how many there are; unit loads are counted with the modes
    samples : of the kept record of each event
    factors : by which each is upsampled
    share : of the damage limit below which points need no counting; 0: every point is counted
    has_knees : whether any curve has knees, so that ranges are kept in histograms
    threads : that work side by side
    report : whether a page is written
    histogram : of which points histograms are kept
    vertex : whether reversals are read at their vertices, which takes double precision
    shear : how shear is counted at the toes, as in the case
    throats : of fillet welds that are counted, at all stations
    """

    modes: int
    stations: int
    welds: int
    samples: tuple[int, ...]
    factors: tuple[int, ...]
    share: float
    has_knees: bool
    threads: int
    report: bool
    histogram: HistogramPoints = "worst"
    vertex: bool = False
    shear: str = "off"
    throats: int = 0
    precision: Precision = "auto"

    @property
    def counted(self) -> tuple[int, ...]:
        """Samples of each event that cycles are counted on."""
        return tuple(n * factor for n, factor in zip(self.samples, self.factors, strict=True))

    @property
    def is_single(self) -> bool:
        """Whether the counter in single precision serves."""
        return not self.vertex and counts_single(self.stations, self.counted, self.precision)

    @property
    def is_large(self) -> bool:
        """Whether few cycles are kept."""
        return is_large(self.stations, self.counted)

    @property
    def is_screened(self) -> bool:
        """Whether bounds settle points."""
        return self.share > 0.0

    @property
    def histograms(self) -> float:
        """Points whose histograms are kept, as far as can be told before anything is counted."""
        points = 2.0 * self.stations
        if self.histogram == "worst":
            return min(points, self.welds + HIGHLY_USED * points)
        return points * (SCREENED if self.is_screened else 1.0) if self.histogram == "all" else 0.0

    @property
    def group(self) -> int:
        """Stations of a group of welds."""
        return min(self.stations, LARGEST_GROUP, max(SMALLEST_GROUP, self.stations // GROUPS))


def job_size(
    body: Body,
    plan: Plan,
    *,
    factors: Sequence[int] = (),
    share: float | None = None,
    threads: int | None = None,
    report: bool = True,
    histogram: HistogramPoints = "worst",
    precision: Precision = "auto",
) -> JobSize:
    """Size of a job; ``factors`` where they are known, ``share`` and ``threads`` None as in an assessment."""
    asked = body.case.counting.upsample
    wanted = tuple(factors) or (AUTOMATIC if asked == "auto" else asked,) * len(plan.passes)
    assumed = tuple(p.factor(factor) for p, factor in zip(plan.passes, wanted, strict=True))
    stations, samples = int(body.lines.begin[-1]), tuple(one.samples for one in plan.passes)
    counted = [n * factor for n, factor in zip(samples, assumed, strict=True)]
    method = body.case.multiaxial.method
    screens = is_large(stations, counted) and method not in DECIDING
    by_default = SHARE if screens else 0.0
    return JobSize(
        modes=len(body.coordinates),
        stations=stations,
        welds=len(body.welds),
        samples=samples,
        factors=assumed,
        share=by_default if share is None else share,
        has_knees=not all(rated.rule.law.is_straight for rated in body.curves.values()),
        threads=threads or os.cpu_count() or 1,
        report=report,
        histogram=histogram,
        vertex=body.case.counting.reversals == "vertex",
        shear=method,
        throats=counted_throats(body),
        precision=precision,
    )
