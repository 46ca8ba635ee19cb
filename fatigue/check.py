"""A dry run: read and check everything, and say how large the job is, before anything is counted."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from fatigue.case import Case
from fatigue.errors import Problem
from fatigue.life.curves import catalogue, damage_law
from fatigue.life.rainflow import BlockCount, count_block
from fatigue.life.rainflow_fast import count_block_fast, record_of
from fatigue.pipeline.body import read_body
from fatigue.pipeline.doubts import Doubts
from fatigue.pipeline.events import DOUBLE_PRECISION_SAMPLES, mission_plan
from fatigue.pipeline.model import solve_group
from fatigue.pipeline.weld_groups import weld_groups

_TRIAL_ROWS, _TRIAL_SAMPLES = 64, 4096


@dataclass(frozen=True, slots=True, eq=False)
class CheckedCase:
    """Sizes of a case that passed every check, and the doubts that remain.

    Of the lines that the weld register lists and that are not assessed, ``excluded`` are excluded, ``candidates`` are
    candidates; ``samples`` are stress samples of one face: stations times kept samples, over all events. ``warnings``
    are summed up as those of an assessment are.
    """

    title: str
    welds: int
    excluded: int
    candidates: int
    parts: int
    stations: int
    modes: int
    events: int
    samples: int
    distance_km: float
    estimated_s: float
    warnings: tuple[Problem, ...]

    @property
    def has_left_out(self) -> bool:
        """Whether the weld register lists lines that are not assessed."""
        return self.excluded + self.candidates > 0

    def as_record(self) -> dict[str, Any]:
        """For machines."""
        return {name: getattr(self, name) for name in self.__slots__ if name != "warnings"} | {
            "warnings": [str(problem) for problem in self.warnings]
        }

    def as_text(self) -> str:
        """For people."""
        return "\n".join(
            [
                f"{self.title}: the case is complete and consistent",
                f"  welds            {self.welds} in {self.parts} straight parts, {self.stations} stations, both faces",
                *([f"  not assessed     {self.excluded} excluded, {self.candidates} candidates"] * self.has_left_out),
                f"  modes            {self.modes}",
                f"  events           {self.events}, {self.distance_km:.4g} km simulated",
                f"  stress samples   {2 * self.samples:.3g}",
                f"  estimated time   {_duration(self.estimated_s)} on one processor core, if every point is counted",
                f"  warnings         {sum(warning.count for warning in self.warnings)}",
            ]
        )


def check_case(case: Case, *, strict: bool) -> CheckedCase:
    """Read and check a case and all its files.

    Raises
    ------
    CaseError, DataError : what an assessment would refuse, this refuses with the same words
    """
    body = read_body(case, strict=strict)
    plan, record_warnings = mission_plan(body)
    doubts = Doubts()
    doubts.add((*body.warnings, *record_warnings))
    parts = stations = 0
    with TemporaryDirectory() as scratch:
        groups = weld_groups(body, Path(scratch))
        for number in range(len(groups)):
            model = solve_group(groups, number)
            parts += len(model.lines)
            stations += len(model.stations)
            doubts.add(model.warnings)
    samples = stations * sum(p.samples for p in plan.passes)
    return CheckedCase(
        title=case.title,
        welds=len(body.welds),
        excluded=sum(row.status == "excluded" for row in body.excluded),
        candidates=sum(row.status == "candidate" for row in body.excluded),
        parts=parts,
        stations=stations,
        modes=len(body.modes.mode),
        events=len(plan.passes),
        samples=samples,
        distance_km=sum(p.length or 0.0 for p in plan.passes),
        estimated_s=samples * _seconds_per_sample(len(body.modes.mode), 2 * samples > DOUBLE_PRECISION_SAMPLES),
        warnings=doubts.listed(),
    )


def _seconds_per_sample(modes: int, single: bool) -> float:
    """Time a small block of noise through superposition and counting, in the precision of the job, on this machine."""
    rng = np.random.default_rng(0)
    q = rng.standard_normal((modes, _TRIAL_SAMPLES))
    shapes = rng.standard_normal((2, _TRIAL_ROWS, modes))
    law = damage_law(catalogue()["master-steel"], None, "none", 1e7)

    record, size, ratio = record_of(q), np.ones(_TRIAL_ROWS), np.zeros((_TRIAL_ROWS, 2))
    count: Callable[..., BlockCount] = partial(
        count_block_fast if single else count_block,
        uses_bending_ratio=True,
        residue="repeat",
        yield_MPa=None,
        mean_stress=False,
    )

    def run() -> None:
        if single:
            count(shapes[0], shapes[1], record, size, ratio, law)
        else:
            count(shapes[0] @ q, shapes[1] @ q, size, ratio, law)

    run()  # compiles, or loads what was compiled before
    start = time.perf_counter()
    run()
    return (time.perf_counter() - start) / (_TRIAL_ROWS * _TRIAL_SAMPLES)


def _duration(seconds: float) -> str:
    if seconds < 60.0:
        return f"{max(seconds, 1.0):.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 7200.0 else f"{seconds / 3600.0:.1f} h"
