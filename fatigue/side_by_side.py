"""Independent items of work on a few threads, given back in order."""

import os
from collections.abc import Callable, Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from threading import Thread
from typing import TypeVar

RUN_THREADS = "fatigue-run"  # threads that have a whole assessment each; their logs do not mix

Item = TypeVar("Item")
Result = TypeVar("Result")


def in_order(do: Callable[[Item], Result], items: Iterable[Item], threads: int | None) -> list[Result]:
    """Results of all items in their order; as many are worked on at a time as there are threads.

    ``threads`` are by default one per processor core. Of several errors the error of the first item is raised. What has
    not begun then, or when the user interrupts, is dropped.
    """
    executor = ThreadPoolExecutor(threads or os.cpu_count() or 1, thread_name_prefix="fatigue")
    try:
        return [future.result() for future in [executor.submit(do, item) for item in items]]
    finally:
        executor.shutdown(cancel_futures=True)


def meanwhile(do: Callable[[], Result]) -> Callable[[], Result]:
    """A call that waits for work begun on a thread of its own, and gives its result or its error.

    Where nobody asks, nobody waits.
    """
    found: Future[Result] = Future()

    def work() -> None:
        try:
            found.set_result(do())
        except BaseException as error:  # whoever asks gets it
            found.set_exception(error)

    Thread(target=work, name="fatigue", daemon=True).start()
    return found.result
