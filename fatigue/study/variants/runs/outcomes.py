"""All runs of a study, side by side: first what histories they need, each once, then every run to its numbers.

A run that fails is told with its settings, and the others go on.
"""

import logging
import threading
from collections.abc import Callable, Collection, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from os import cpu_count
from threading import Event
from typing import TypeVar

from fatigue.errors import DataError, FatigueError, NumericalError, Problem
from fatigue.files.mishaps import refusal
from fatigue.side_by_side import RUN_THREADS
from fatigue.stages import STAGES, stage
from fatigue.study.study_file import Study
from fatigue.study.variants.runs.hashes import Hashes
from fatigue.study.variants.runs.planned_runs import PlannedRun
from fatigue.study.variants.runs.run import Done, completed, known
from fatigue.study.variants.runs.simulation import Simulation, before, simulated, simulation_of
from fatigue.study.variants.source.builtin import Bodies
from fatigue.study.variants.source.made import Made
from fatigue.study.variants.varied.base_files import BaseFiles

Progress = Callable[[str, int, int], None]
Item = TypeVar("Item")
Result = TypeVar("Result")


@dataclass(frozen=True, slots=True)
class Failed:
    """Why a run has no numbers."""

    error: FatigueError


@dataclass(frozen=True, slots=True)
class NotRun:
    """A run that was not asked for, and that no earlier command finished."""


Outcome = Done | Failed | NotRun


def outcomes(
    study: Study,
    files: BaseFiles,
    runs: Sequence[PlannedRun],
    asked: Collection[str],
    threads: int | None,
    progress: Progress,
) -> list[Outcome]:
    """What became of each run, in their order; of variants that are not ``asked`` for what earlier commands finished.

    ``threads`` are by default one per processor core; as many runs are under way at a time, and where there are fewer
    runs each has several.
    """
    hashes, bodies, stop = Hashes(), Bodies(), Event()
    threads = threads or cpu_count() or 1
    first: dict[str, Simulation] = {}
    needed = [_simulations(study, files, run, hashes, first) for run in runs]
    own = [place for place, run in enumerate(runs) if run.variant in asked]
    every = {one.folder: one for place in own for one in needed[place].simulations}
    each = max(1, threads // max(1, min(threads, len(own))))
    with quiet_threads():
        if every:
            stage("making histories (%d runs of the source)", len(every))
        simulations = list(every.values())
        of_source = _side_by_side(
            lambda one: simulated(study, files, bodies, one, stop), simulations, threads, progress, "histories", stop
        )
        made = dict(zip(every, of_source, strict=True))

        def finish(place: int) -> Done:
            given = {one.asked.event: _or_refused(made[one.folder]) for one in needed[place].or_refused()}
            return completed(runs[place], given, hashes, each, diagnosed=study.diagnose)

        stage("assessing (%d runs)" if study.base.case else "gathering numbers (%d runs)", len(own))
        done = dict(zip(own, _side_by_side(finish, own, threads, progress, "runs", stop), strict=True))
        others = (place for place in range(len(runs)) if place not in done)
        earlier = {place: _earlier(study, runs[place], needed[place], hashes) for place in others}
    return [done[place] if place in done else earlier[place] for place in range(len(runs))]


@dataclass(frozen=True, slots=True)
class _Needed:
    """What the source has to make for a run, or why that cannot be told."""

    simulations: tuple[Simulation, ...] = ()
    error: FatigueError | None = None

    def or_refused(self) -> tuple[Simulation, ...]:
        """The simulations; the error, if there is one, is raised."""
        if self.error is not None:
            raise self.error
        return self.simulations


def _or_refused(made: Made | Failed) -> Made:
    if isinstance(made, Failed):
        raise made.error
    return made


def _earlier(study: Study, run: PlannedRun, needed: _Needed, hashes: Hashes) -> Done | NotRun:
    """A run as an earlier command finished it."""
    try:
        found = {one.asked.event: before(study, one) for one in needed.or_refused()}
        made = {event: one for event, one in found.items() if one is not None}
        done = known(run, made, hashes, diagnosed=study.diagnose) if len(made) == len(found) else None
    except FatigueError:
        done = None
    return NotRun() if done is None else done


def _simulations(
    study: Study, files: BaseFiles, run: PlannedRun, hashes: Hashes, first: dict[str, Simulation]
) -> _Needed:
    """What the source has to make for a run; ``first`` has the first simulation of each key, which others share."""
    try:
        made = [simulation_of(study, files, asked, run.case, place, hashes) for place, asked in run.asked.items()]
    except FatigueError as error:
        return _Needed(error=error)
    return _Needed(
        tuple(one if one.key == "" else replace(one, folder=first.setdefault(one.key, one).folder) for one in made)
    )


def _side_by_side(
    do: Callable[[Item], Result],
    items: Sequence[Item],
    threads: int,
    progress: Progress,
    label: str,
    stop: Event,
) -> list[Result | Failed]:
    """Results or refusals of all items in their order; what is under way is ended when the user interrupts."""

    def tried(item: Item) -> Result | Failed:
        try:
            return do(item)
        except FatigueError as error:
            return Failed(error)
        except Exception as error:  # one run must not cost the others
            return Failed(_unforeseen(error))

    executor = ThreadPoolExecutor(min(threads, len(items)) or 1, thread_name_prefix=RUN_THREADS)
    try:
        futures = [executor.submit(tried, item) for item in items]
        progress(label, 0, len(items))
        for done, _ in enumerate(as_completed(futures), 1):
            progress(label, done, len(items))
        return [future.result() for future in futures]
    except BaseException:
        stop.set()
        raise
    finally:
        executor.shutdown(cancel_futures=True)


def _unforeseen(error: Exception) -> FatigueError:
    """What the machine refused, or a fault of the program, as the refusal of one run."""
    if isinstance(error, MemoryError):
        remedy = "Use fewer --threads, or a machine with more memory"
        return NumericalError(Problem("memory", "memory", "the program got no more of it", remedy))
    if isinstance(error, OSError):
        return DataError(refusal(error))
    what = f"this should not have happened ({type(error).__name__}: {error})"
    return NumericalError(Problem("unforeseen", "the program", what, "Run this variant with --only, and report it"))


@contextmanager
def quiet_threads() -> Iterator[None]:
    """Keep what single runs say from the log on stderr and from its stages; their own logs have it.

    The level of the log is theirs meanwhile: each would put it back as it found it, while others still write.
    """
    here, program = threading.get_ident(), logging.getLogger("fatigue")

    def is_of_the_study(record: logging.LogRecord) -> bool:
        return record.thread == here

    with ExitStack() as stack:
        stack.callback(program.setLevel, program.level)
        program.setLevel(logging.INFO)
        for log in (program, logging.getLogger(STAGES)):
            for handler in log.handlers:
                handler.addFilter(is_of_the_study)
                stack.callback(handler.removeFilter, is_of_the_study)
        yield
