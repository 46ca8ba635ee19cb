"""The assessment as a story: files, stress shapes, cycles and spectra, damage, kilometres, tables."""

import logging
import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from fatigue.case import Case
from fatigue.checkpoint import Checkpoint, locked, state_key
from fatigue.cycles import weld_cycles
from fatigue.errors import Problem
from fatigue.event_block import EventLoad, assess_event_block
from fatigue.events import event_load, mission_plan
from fatigue.folder import publish, refuse_foreign, result_log
from fatigue.life.mission import Plan
from fatigue.model import Model, read_model
from fatigue.provenance import provenance_record
from fatigue.register import PointLives, toe_faces, weld_rows, worst_points
from fatigue.results import input_register, software_versions, table_writer, write_json
from fatigue.stations import BLOCK, Block, cut_blocks, shapes_of
from fatigue.tables import damage_rows, mission_block, node_rows, stress_rows

log = logging.getLogger(__name__)

Progress = Callable[[str, int, int], None]

SAMPLES_PER_PEAK = 10.0  # below, cycles are cut short by the sampling


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
    progress : called with a label, blocks done and blocks in all

    Raises
    ------
    CaseError, DataError : the case or its files are wrong; nothing has been written then
    NumericalError : a computation lost its footing
    """
    model = read_model(case, strict=strict)
    plan, doubts = mission_plan(model)
    blocks = cut_blocks(model.stations, model.curve_of_weld)
    inputs = input_register(sorted({case.path, *case.input_files().values()}), case.path.parent)
    key = state_key({"inputs": inputs, "software": software_versions(), "block": BLOCK})

    refuse_foreign(folder, force=force)
    with locked(folder), result_log(folder), one_blas_thread(), Checkpoint(folder, key) as state:
        log.info("assessing '%s': %d stations, %d events", case.path.name, len(model.stations), len(plan.passes))
        with workers(threads) as executor:
            for number, event in enumerate(case.mission.event):
                count_event(number, event_load(model, event), blocks, model, state, executor, progress)
        log.info("%d of %d blocks were there from an earlier run", state.reused, len(blocks) * len(plan.passes))

        tables = state.folder / "tables"
        tables.mkdir(exist_ok=True)
        lives, sampling = write_points(tables, blocks, model, plan, state)
        worst = worst_points(model, lives)
        with table_writer(tables, "cycles") as cycles:
            for rows in weld_cycles(model, worst):
                cycles.write(rows)
        with table_writer(tables, "welds") as welds:
            welds.write(weld_rows(model, plan, lives, worst))
        warnings = (*model.warnings, *doubts, *sampling)
        write_json(tables / "provenance.json", provenance_record(model, plan, folder, inputs, warnings))
        publish(tables, folder)
        log.info("the result is complete")
    return Assessment(
        folder=folder,
        fulfilled=all(lives.utilisation[point.station, point.face] <= 1.0 for point in worst),
        warnings=warnings,
        blocks=len(blocks) * len(plan.passes),
        blocks_reused=state.reused,
    )


def count_event(
    number: int,
    load: EventLoad,
    blocks: Sequence[Block],
    model: Model,
    state: Checkpoint,
    executor: Executor,
    progress: Progress,
) -> None:
    """Count one event on every block that no earlier run has finished."""
    curve = model.case.curve

    def count(block: Block) -> None:
        shapes = shapes_of(model.stations, block, model.curves, curve.thickness_rule)
        state.save(number, block.index, assess_event_block(shapes, load, curve.yield_MPa, curve.mean_stress == "asme"))

    label = f"event {number + 1} of {len(model.case.mission.event)}"
    waiting = [block for block in blocks if not state.has(number, block.index)]
    done = len(blocks) - len(waiting)
    for finished in as_completed([executor.submit(count, block) for block in waiting]):
        finished.result()
        done += 1
        progress(label, done, len(blocks))


def write_points(
    folder: Path, blocks: Sequence[Block], model: Model, plan: Plan, state: Checkpoint
) -> tuple[PointLives, list[Problem]]:
    """Weight the events with the mission block by block and write the tables of all points.

    Returns what the weld register needs of every point, and the doubts about the sampling of the records.
    """
    stations, welds = model.stations, [weld.name for weld in model.welds]
    lives = PointLives.empty(len(stations))
    toes = toe_faces(model)
    raw_life = np.full((len(stations), 2), np.nan)
    fewest_samples = np.full(len(plan.passes), np.inf)
    with (
        table_writer(folder, "nodes") as nodes,
        table_writer(folder, "damage") as damage,
        table_writer(folder, "structural_stress") as stress,
    ):
        for block in sorted(blocks, key=lambda b: not b.raw):  # raw values first: the rows of the nodes want them
            parts = [state.load(event, block.index) for event in range(len(plan.passes))]
            mission = mission_block(parts, plan, model.curves[block.curve].law)
            if block.raw:
                raw_life[block.rows] = mission.life_km
                continue
            lives.put(block.rows, mission)
            raw = np.where(np.isnan(raw_life[block.rows]), mission.life_km, raw_life[block.rows])
            nodes.write(node_rows(stations, block.rows, mission, raw, toes[block.rows], plan, welds))
            damage.write(damage_rows(stations, block.rows, parts, plan, welds))
            stress.write(stress_rows(stations, block.rows, model.modes.mode, welds))
            samples = [np.nanmin(p.samples_per_peak, initial=np.inf) for p in parts]
            fewest_samples = np.minimum(fewest_samples, samples)
    return lives, sampling_warnings(model, plan, fewest_samples)


def sampling_warnings(model: Model, plan: Plan, samples_per_peak: NDArray[np.float64]) -> list[Problem]:
    """Tell which records are sampled too coarsely for their points, and what damage that hides.

    A peak cut short by sampling loses ``k (pi nu_p / f_s)^2 / 6`` of its damage on average.
    """
    slope = max(float(rated.law.slopes[0]) for rated in model.curves.values())
    return [
        Problem(
            "sampling",
            f"event '{event.event}'",
            f"{samples:.1f} samples per peak at the fastest point, damage there is about "
            f"{100 * slope * (np.pi / samples) ** 2 / 6:.0f} % low",
            'Set upsample = "auto" in [counting], or sample the simulation more finely',
        )
        for event, samples in zip(plan.passes, samples_per_peak, strict=True)
        if samples < SAMPLES_PER_PEAK
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
