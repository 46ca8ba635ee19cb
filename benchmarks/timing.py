"""Best times of functions that take turns, so that a busy machine disturbs all of them alike."""

import time
from collections.abc import Callable, Mapping

Row = tuple[str, str]


def best_times(
    functions: Mapping[str, Callable[[], object]], rounds: int = 12, clock: Callable[[], float] = time.perf_counter
) -> dict[str, float]:
    """Best time [s] of each function by a clock, after one call of each to warm up."""
    for function in functions.values():
        function()
    best = dict.fromkeys(functions, float("inf"))
    for _ in range(rounds):
        for name, function in functions.items():
            start = clock()
            function()
            best[name] = min(best[name], clock() - start)
    return best
