"""Groups of welds assessed by other processes: the names of files travel there, arrays of results come back."""

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from shutil import rmtree
from tempfile import mkdtemp
from threading import Lock
from typing import Any
from weakref import finalize

from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from fatigue.case import load_case
from fatigue.errors import DataError, Problem
from fatigue.pipeline.count.result import arrays_of
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.run.work import ScreeningOptions, Work, inputs_of, key_of, open_work
from fatigue.pipeline.solve.body import read_body
from fatigue.pipeline.solve.weld_groups import weld_groups


@dataclass(frozen=True, slots=True)
class Order:
    """One group of welds to be assessed in a process that sees the same files.

    ``key`` is the key of the job: a worker with other inputs or another version of the program is found out by it.
    ``factors`` by which the records are upsampled are told, as finding them may take solving all welds.
    """

    case: str
    strict: bool
    options: ScreeningOptions
    key: str
    factors: tuple[int, ...]
    group: int


def fulfil(order: Order) -> dict[str, NDArray[Any]]:
    """Arrays of the result of the group that an order names; the files are read once per process.

    Raises
    ------
    DataError : this process sees other inputs, or is another version of the program
    """
    with _OPENING:  # the first thread reads, the others wait for it
        work, _ = _opened(order.case, order.strict, order.options, order.key, order.factors)
    _, result = work.group(order.group)
    return arrays_of(result)


_OPENING = Lock()


class _Scratch:
    """A folder for scratch files that goes with the object, without the warning of ``TemporaryDirectory``."""

    def __init__(self) -> None:
        self.path = Path(mkdtemp(prefix="fatigue-"))
        finalize(self, rmtree, self.path, ignore_errors=True)


@lru_cache(maxsize=1)
def _opened(
    path: str, strict: bool, options: ScreeningOptions, key: str, factors: tuple[int, ...]
) -> tuple[Work, _Scratch]:
    """The work of a job, and the folder of its scratch files, which goes when neither is needed any more."""
    threadpool_limits(limits=1, user_api="blas")  # for good: orders side by side must not lift it for each other
    case = load_case(Path(path))
    if key_of(case, inputs_of(case), options) != key:
        raise DataError(
            Problem(
                "other_inputs",
                path,
                "a worker sees other input files or other versions of packages than the process that gave the order",
                "Give all workers the same files under the same path and the same installation",
            )
        )
    body = read_body(case, strict=strict)
    plan, _ = mission_plan(body, threads=1)
    scratch = _Scratch()
    return open_work(weld_groups(body, scratch.path / "forces"), plan, options, scratch.path, 1, factors), scratch
