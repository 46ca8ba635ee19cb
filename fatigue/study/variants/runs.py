"""All runs of a study, side by side: first what histories they need, each once, then every run to its numbers.

A run that fails is told with its settings, and the others go on.
"""

import logging
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from os import cpu_count
from threading import Event
from typing import TypeVar

from fatigue.errors import FatigueError, NumericalError
from fatigue.side_by_side import RUN_THREADS
from fatigue.stages import STAGES, stage
from fatigue.study.study_file import Study
from fatigue.study.variants.base_files import BaseFiles
from fatigue.study.variants.hashes import Hashes
from fatigue.study.variants.planned_runs import PlannedRun
from fatigue.study.variants.run import Done, completed
from fatigue.study.variants.simulation import Simulation, simulated, simulation_of
from fatigue.study.variants.source.made import Made

Progress = Callable[[str, int, int], None]
Item = TypeVar("Item")
Result = TypeVar("Result")


@dataclass(frozen=True, slots=True)
class Failed:
    """Why a run has no numbers."""

    error: FatigueError

    @property
    def is_numerical(self) -> bool:
        """Whether inputs were valid and a computation lost its footing."""
        return isinstance(self.error, NumericalError)


Outcome = Done | Failed


def outcomes(
    study: Study, files: BaseFiles, runs: Sequence[PlannedRun], threads: int | None, progress: Progress
) -> list[Outcome]:
    """What became of each run, in their order.

    ``threads`` are by default one per processor core; as many runs are under way at a time, and where there are fewer
    runs each has several.
    """
    hashes, stop = Hashes(), Event()
    threads = threads or cpu_count() or 1
    first: dict[str, Simulation] = {}
    needed = [_simulations(study, files, run, hashes, first) for run in runs]
    every = {one.folder: one for of in needed if not isinstance(of, Failed) for one in of}
    made: dict[object, Made | Failed] = {}
    with quiet_threads():
        if every:
            stage("making histories (%d runs of the source)", len(every))
            simulations = list(every.values())
            of_source = _side_by_side(
                lambda one: simulated(study, files, one, stop), simulations, threads, progress, "histories", stop
            )
            made = dict(zip((one.folder for one in simulations), of_source, strict=True))

        def finish(place: int) -> Done:
            own = needed[place]
            if isinstance(own, Failed):
                raise own.error
            given: dict[str, Made] = {}
            for one in own:
                found = made[one.folder]
                if isinstance(found, Failed):
                    raise found.error
                given[one.asked.event] = found
            each = max(1, threads // max(1, min(threads, len(runs))))
            return completed(runs[place], given, hashes, each, diagnosed=study.diagnose)

        stage("assessing (%d runs)" if study.base.case else "gathering numbers (%d runs)", len(runs))
        return _side_by_side(finish, range(len(runs)), threads, progress, "runs", stop)


def _simulations(
    study: Study, files: BaseFiles, run: PlannedRun, hashes: Hashes, first: dict[str, Simulation]
) -> list[Simulation] | Failed:
    """What the source has to make for a run; ``first`` has the first simulation of each key, which others share."""
    try:
        made = [simulation_of(study, files, asked, run.case, place, hashes) for place, asked in run.asked.items()]
    except FatigueError as error:
        return Failed(error)
    return [one if one.key == "" else replace(one, folder=first.setdefault(one.key, one).folder) for one in made]


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


@contextmanager
def quiet_threads() -> Iterator[None]:
    """Keep what single runs say from the log on stderr and from its stages; their own logs have it."""
    here = threading.get_ident()

    def is_of_the_study(record: logging.LogRecord) -> bool:
        return record.thread == here

    with ExitStack() as stack:
        for name in ("fatigue", STAGES):
            for handler in logging.getLogger(name).handlers:
                handler.addFilter(is_of_the_study)
                stack.callback(handler.removeFilter, is_of_the_study)
        yield
