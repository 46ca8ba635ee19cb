"""Best times of functions that take turns, so that a busy machine disturbs all of them alike."""

import time
from collections.abc import Callable, Mapping

Row = tuple[str, str]


def best_times(functions: Mapping[str, Callable[[], object]], rounds: int = 12) -> dict[str, float]:
    """Best wall time [s] of each function, after one call of each to warm up."""
    for function in functions.values():
        function()
    best = dict.fromkeys(functions, float("inf"))
    for _ in range(rounds):
        for name, function in functions.items():
            start = time.perf_counter()
            function()
            best[name] = min(best[name], time.perf_counter() - start)
    return best
