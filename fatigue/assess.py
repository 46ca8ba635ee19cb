"""The assessment as a story: files, stress shapes, cycles and spectra, damage, kilometres, tables."""

import logging
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from fatigue.case import Case
from fatigue.errors import NumericalError, Problem
from fatigue.life.mission import Plan
from fatigue.pipeline.body import Body, conversion_file, read_body, register_file
from fatigue.pipeline.checkpoint import Checkpoint, locked, state_key
from fatigue.pipeline.cycles import point_cycles
from fatigue.pipeline.event_block import assess_event_block
from fatigue.pipeline.event_load import EventLoad
from fatigue.pipeline.events import event_loads, mission_plan
from fatigue.pipeline.folder import publish, refuse_foreign, result_log
from fatigue.pipeline.mission_block import mission_block
from fatigue.pipeline.model import GROUP, Model, check_forces, solve_group, weld_groups
from fatigue.pipeline.provenance import provenance_record
from fatigue.pipeline.register import PointLives, excluded_rows, toe_faces, weld_rows, worst_points
from fatigue.pipeline.rows import damage_rows, node_rows, stress_rows
from fatigue.pipeline.stations import BLOCK, Block, cut_blocks, shapes_of
from fatigue.report.page import write_report
from fatigue.report.vtp import write_vtp
from fatigue.results import TableWriter, input_register, result_tables, software_versions, write_json
from fatigue.spectrum.diagnosis import FEW_SAMPLES_PER_PEAK, sampling_loss

log = logging.getLogger(__name__)

Progress = Callable[[str, int, int], None]


@dataclass(frozen=True, slots=True, eq=False)
class Assessment:
    """What a finished assessment says at a glance; the numbers are in the tables of ``folder``."""

    folder: Path
    fulfilled: bool
    warnings: tuple[Problem, ...]
    blocks: int
    blocks_reused: int


def assess(
    case: Case,
    folder: Path,
    *,
    threads: int | None = None,
    strict: bool = False,
    force: bool = False,
    report: bool = True,
    verification: Sequence[Mapping[str, Any]] = (),
    progress: Progress = lambda label, done, total: None,
) -> Assessment:
    """Fatigue life, in km, of every point of every weld of one flexible body.

    Parameters
    ----------
    case : the checked case
    folder : where the result goes; an interrupted run in it is continued
    threads : worker threads, by default one per processor core; the bytes of the tables do not depend on it
    strict : take unknown columns in the tables for errors
    force : overwrite files that fatigue did not write
    report : write the report and the ParaView file as well
    verification : checks of the program to show in the report, as ``fatigue.verify`` gives them
    progress : called with a label, blocks done and blocks in all

    Raises
    ------
    CaseError, DataError : the case or its files are wrong; nothing has been written then
    NumericalError : a computation lost its footing
    """
    body = read_body(case, strict=strict)
    plan, record_warnings = mission_plan(body)
    files = {case.path, *case.input_files().values(), *filter(None, [register_file(case), conversion_file(case)])}
    inputs = input_register(sorted(files), case.path.parent)
    key = state_key({"inputs": inputs, "software": software_versions(), "blocks": (GROUP, BLOCK)})

    refuse_foreign(folder, force=force)
    with locked(folder), one_blas_thread(), Checkpoint(folder, key) as state:
        groups = weld_groups(body, scratch=state.folder / "forces")
        check_forces(groups)
        with result_log(folder):
            log.info("assessing '%s': %d welds, %d events", case.path.name, len(body.welds), len(plan.passes))
            loads = event_loads(groups, plan)
            done = Tally(total=sum(len(line.node) for line in body.lines) * len(loads), progress=progress)
            unpublished = state.folder / "tables"
            with workers(threads) as executor, result_tables(unpublished) as tables:
                for number in range(len(groups)):
                    model = solve_group(groups, number)
                    blocks = cut_blocks(model.stations, model.curve_of_weld)
                    parts = count_group(number, model, blocks, loads, state, executor, done)
                    write_group(tables, model, blocks, parts, loads, plan, state, done)
                tables["welds"].write(excluded_rows(body.excluded))
            log.info("%d of %d blocks were there from an earlier run", state.reused, done.blocks)
            warnings = (*body.warnings, *record_warnings, *done.warnings, *sampling_warnings(body, done))
            write_json(unpublished / "provenance.json", provenance_record(body, plan, loads, folder, inputs, warnings))
            if report:
                write_vtp(unpublished)
                write_report(unpublished, case.path, verification)
            publish(unpublished, folder)
            log.info("the result is complete")
    return Assessment(folder, done.fulfilled, warnings, done.blocks, state.reused)


@dataclass(slots=True, eq=False)
class Tally:
    """What adds up while groups of welds stream by: progress, verdict, doubts, and the sampling of the records."""

    total: int
    progress: Progress
    stations: int = 0
    blocks: int = 0
    fulfilled: bool = True
    warnings: list[Problem] = field(default_factory=list)
    samples_per_peak: dict[str, float] = field(default_factory=dict)

    def finished(self, block: Block) -> None:
        """Count a finished block of one event; raw end values come on top of the stations."""
        self.blocks += 1
        self.stations += 0 if block.raw else len(block.rows)
        self.progress("assessing", min(self.stations, self.total), self.total)

    def sampled(self, event: str, samples_per_peak: NDArray[np.float64]) -> None:
        """Remember the fewest samples per peak of an event."""
        fewest = float(np.nanmin(samples_per_peak, initial=np.inf))
        self.samples_per_peak[event] = min(fewest, self.samples_per_peak.get(event, np.inf))


def count_group(
    number: int,
    model: Model,
    blocks: Sequence[Block],
    loads: Sequence[EventLoad],
    state: Checkpoint,
    executor: Executor,
    done: Tally,
) -> list[list[str]]:
    """Count every event on every block of a group of welds, except what an earlier run has finished.

    Returns the names of the finished parts, (block, event).
    """
    curve = model.case.curve
    parts = [[f"group-{number:05d}-block-{b.index:03d}-event-{e:04d}" for e in range(len(loads))] for b in blocks]

    def count(block: Block, load: EventLoad, part: str) -> Block:
        shapes = shapes_of(model.stations, block, model.curves, curve.thickness_rule)
        try:
            with np.errstate(over="raise"):
                result = assess_event_block(shapes, load, curve.yield_MPa, curve.mean_stress == "asme")
        except FloatingPointError:
            raise NumericalError(_overflow(model, block, load)) from None
        state.save(part, result)
        return block

    waiting = []
    for block, names in zip(blocks, parts, strict=True):
        for load, part in zip(loads, names, strict=True):
            if state.has(part):
                done.finished(block)
            else:
                waiting.append(executor.submit(count, block, load, part))
    for finished in as_completed(waiting):
        done.finished(finished.result())
    return parts


def _overflow(model: Model, block: Block, load: EventLoad) -> Problem:
    welds = sorted({model.welds[i].name for i in model.stations.weld[block.rows]})
    return Problem(
        "overflow",
        f"event '{load.counted.event}', welds {welds[0]} to {welds[-1]}",
        "stresses or damage exceed what double precision can hold",
        "Check the units of forces and modal coordinates, and look for a value that is far too large",
    )


def write_group(
    tables: Mapping[str, TableWriter],
    model: Model,
    blocks: Sequence[Block],
    parts: Sequence[Sequence[str]],
    loads: Sequence[EventLoad],
    plan: Plan,
    state: Checkpoint,
    done: Tally,
) -> None:
    """Weight the events of a group of welds with the mission and write its rows of every table."""
    stations, welds = model.stations, [weld.name for weld in model.welds]
    lives = PointLives.empty(len(stations))
    toes = toe_faces(model)
    raw_life = np.full((len(stations), 2), np.nan)
    # raw values of the ends first: the rows of the nodes want them
    for block, names in sorted(zip(blocks, parts, strict=True), key=lambda pair: not pair[0].raw):
        events = [state.load(name) for name in names]
        mission = mission_block(events, plan, model.curves[block.curve].law)
        if block.raw:
            raw_life[block.rows] = mission.life_km
            continue
        lives.put(block.rows, mission)
        raw = np.where(np.isnan(raw_life[block.rows]), mission.life_km, raw_life[block.rows])
        tables["nodes"].write(node_rows(stations, block.rows, mission, raw, toes[block.rows], plan, welds))
        tables["damage"].write(damage_rows(stations, block.rows, events, plan, welds))
        tables["structural_stress"].write(stress_rows(stations, block.rows, model.modes.mode, welds))
        for passed, event in zip(plan.passes, events, strict=True):
            done.sampled(passed.event, event.samples_per_peak)

    worst = worst_points(model, lives)
    for load in loads:
        for point in worst:
            tables["cycles"].write(point_cycles(model, load, point))
    tables["welds"].write(weld_rows(model, plan, lives, worst))
    done.fulfilled &= all(lives.utilisation[point.station, point.face] <= 1.0 for point in worst)
    done.warnings += model.warnings


def sampling_warnings(body: Body, done: Tally) -> list[Problem]:
    """Tell which records are sampled too coarsely for their points, and what damage that hides."""
    slope = max(float(rated.law.slopes[0]) for rated in body.curves.values())
    return [
        Problem(
            "sampling",
            f"event '{event}'",
            f"{samples:.1f} samples per peak at the fastest point, damage there is about "
            f"{100 * float(sampling_loss(np.array(samples), slope)):.0f} % low",
            'Set upsample = "auto" in [counting], or sample the simulation more finely',
        )
        for event, samples in done.samples_per_peak.items()
        if samples < FEW_SAMPLES_PER_PEAK
    ]


@contextmanager
def workers(threads: int | None) -> Iterator[Executor]:
    """Give a pool of threads that drops what has not begun when the run is interrupted."""
    executor = ThreadPoolExecutor(threads or os.cpu_count() or 1, thread_name_prefix="fatigue")
    try:
        yield executor
    finally:
        executor.shutdown(cancel_futures=True)


def one_blas_thread() -> threadpool_limits:
    """Keep BLAS to one thread: the workers are outside it, and the bytes do not depend on the processor."""
    return threadpool_limits(limits=1, user_api="blas")
