"""Loops in machine code: one decorator for all of them.

Machine code is kept on disk: in ``NUMBA_CACHE_DIR`` where that is set, else in ``__pycache__``, else, of a read-only
install, in the user's cache folder. It contains the functions it calls and the named tuples it takes, also those of
other files; numba looks only at the file of the function itself. So machine code that is older than a file of the rooms
with loops is removed before any is loaded.

A loop costs a tenth to half a second to compile. What makes it dear: each function that is called from it, compiled
for itself, for any mixture of types and constants (``f(s, True)`` and ``f(s, False)`` are two); named tuples of many
arrays as arguments; fields of structured arrays; slices that are assigned to; ``np.empty`` and array expressions. So
loops take arrays, write into them, and leave to numpy what numpy does as fast.
"""

import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, ParamSpec, TypeVar, cast

import scipy.linalg.cython_blas  # noqa: F401 - the BLAS of compiled products; limits of its threads need it loaded
from numba import njit

P = ParamSpec("P")
R = TypeVar("R")

ROOMS = ("weld", "life", "spectrum", "vehicle")  # with compiled loops


def compiled(*fastmath: str) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Compile at the first call, keep the result on disk if it may be, run outside the GIL.

    ``fastmath`` are flags of LLVM. Where no folder can be written to, every process compiles anew.
    """
    flags: dict[str, Any] = {"nogil": True, "error_model": "numpy", "fastmath": set(fastmath)}
    flags["no_cfunc_wrapper"] = True  # nobody calls the loops from C

    def compile_lazily(function: Callable[P, R]) -> Callable[P, R]:
        loops: Any = njit(**flags)(function)
        with suppress(RuntimeError, AttributeError):  # no such folder; plain Python, with NUMBA_DISABLE_JIT
            loops.enable_caching()
            _clean(loops._cache.cache_path)
            loops._cache.save_overload = _unless_refused(loops._cache.save_overload)
        return cast(Callable[P, R], loops)

    return compile_lazily


def _unless_refused(save: Callable[..., None]) -> Callable[..., None]:
    """Save machine code where the disk takes it: a full one costs the next process the compilation, and no result."""

    def saved(*code: Any) -> None:
        with suppress(OSError):
            save(*code)

    return saved


def inlined(function: Callable[P, R]) -> Callable[P, R]:
    """Let compiled code contain a function in place of calling it: a call counts the references to its arrays."""
    return cast(Callable[P, R], njit(inline="always")(function))


def remove_stale(folder: Path, written: float) -> None:
    """Remove machine code in a folder that is older than the time at which its sources were ``written``.

    Where nothing may be removed, nothing is.
    """
    for kept in folder.glob("*.nb[ic]"):
        try:
            if kept.stat().st_mtime < written:
                kept.unlink()
        except OSError:  # another process was faster, or the folder is read-only
            continue


def last_written(rooms: Sequence[Path]) -> float:
    """When the newest source file of rooms was written; not one dated in the future: machine code were always older."""
    now = time.time()
    written = [path.stat().st_mtime for room in rooms for path in room.rglob("*.py")]
    return max((when for when in written if when <= now), default=0.0)


@cache
def _clean(folder: str | None) -> None:
    """Remove machine code from a folder, of whatever place, that is older than the rooms with loops."""
    if folder:
        remove_stale(Path(folder), WRITTEN)


WRITTEN = last_written([Path(__file__).parent / room for room in ROOMS])
