"""Groups of welds assessed side by side: by threads of this process, or by any other executor."""

import os
from collections import deque
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Any

from numpy.typing import NDArray

from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.run.checkpoint import Checkpoint
from fatigue.pipeline.run.orders import Order, fulfil
from fatigue.pipeline.run.work import Work
from fatigue.pipeline.solve.model import Model, solve_group

ORDERS_AHEAD = 32  # groups under way or waiting to be written, by an executor that does not say how many workers it has


@dataclass(frozen=True, slots=True, eq=False)
class Group:
    """A group of welds solved and assessed; ``reused``: by an earlier run that was interrupted."""

    model: Model
    result: GroupResult
    reused: bool


def by_threads(work: Work, state: Checkpoint, threads: int | None) -> Generator[Group]:
    """The groups in order, assessed on threads, by default one per processor core.

    What has not begun when the iterator is closed is dropped.
    """
    number_of_threads = threads or os.cpu_count() or 1
    executor = ThreadPoolExecutor(number_of_threads, thread_name_prefix="fatigue")

    def assessed(number: int) -> Group:
        before = state.load(_name(number))
        if before is not None:
            return Group(solve_group(work.groups, number), before, reused=True)
        model, result = work.group(number)
        state.save(_name(number), result)
        return Group(model, result, reused=False)

    def begin(number: int) -> Callable[[], Group]:
        return executor.submit(assessed, number).result

    try:
        # While a group is written one thread has nothing to do: its core writes, and memory holds a group less.
        yield from _in_order(begin, len(work.groups), number_of_threads - 1)
    finally:
        executor.shutdown(cancel_futures=True)


def by_orders(work: Work, state: Checkpoint, executor: Executor, order: Order) -> Generator[Group]:
    """The groups in order; the workers of an executor assess those that no earlier run has finished.

    ``order`` is the order of any group of the job. A worker that dies costs the executor a second try and nothing else.
    """
    under_way: set[Future[dict[str, NDArray[Any]]]] = set()

    def begin(number: int) -> Callable[[], Group]:
        before = state.load(_name(number))
        if before is not None:
            return lambda: Group(solve_group(work.groups, number), before, reused=True)
        future = executor.submit(fulfil, replace(order, group=number))
        under_way.add(future)

        def fetch() -> Group:
            result = GroupResult(**future.result())
            under_way.discard(future)
            state.save(_name(number), result)
            return Group(solve_group(work.groups, number), result, reused=False)

        return fetch

    try:
        yield from _in_order(begin, len(work.groups), ORDERS_AHEAD)
    finally:
        for future in under_way:
            future.cancel()


def _in_order(begin: Callable[[int], Callable[[], Group]], groups: int, ahead: int) -> Iterator[Group]:
    """The groups one after the other, some of them begun ahead."""
    waiting: deque[Callable[[], Group]] = deque()
    for number in range(groups):
        waiting.append(begin(number))
        if len(waiting) > ahead:
            yield waiting.popleft()()
    while waiting:
        yield waiting.popleft()()


def _name(number: int) -> str:
    """Name under which the result of a group is kept until the run is complete."""
    return f"group-{number:05d}"
