"""Independent pieces of work on a few threads, given back in order."""

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")


def in_order(do: Callable[[Item], Result], items: Iterable[Item], threads: int | None) -> list[Result]:
    """Do the work of all items, as many at a time as there are threads, by default one per processor core.

    The results are in the order of the items. Of several errors that of the first item is raised; what has not begun
    then, or when the user interrupts, is dropped.
    """
    executor = ThreadPoolExecutor(threads or os.cpu_count() or 1, thread_name_prefix="fatigue")
    try:
        return [future.result() for future in [executor.submit(do, item) for item in items]]
    finally:
        executor.shutdown(cancel_futures=True)
