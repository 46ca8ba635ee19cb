"""Loops in machine code: one decorator for all of them.

Machine code is kept on disk as long as the file of its function is the same. Functions of other files that it calls,
and named tuples that it takes, are part of it: whoever changes or renames these deletes the ``*.nbi`` files in
``__pycache__``.
"""

from collections.abc import Callable
from typing import ParamSpec, TypeVar, cast

import scipy.linalg.cython_blas  # noqa: F401 - the BLAS of compiled products; limits of its threads need it loaded
from numba import njit

P = ParamSpec("P")
R = TypeVar("R")


def compiled(*fastmath: str) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Compile at the first call, keep the result on disk, run outside the GIL; ``fastmath``: flags of LLVM."""

    def compile_lazily(function: Callable[P, R]) -> Callable[P, R]:
        return cast(Callable[P, R], njit(cache=True, nogil=True, error_model="numpy", fastmath=set(fastmath))(function))

    return compile_lazily


def inlined(function: Callable[P, R]) -> Callable[P, R]:
    """Let compiled code contain a function in place of calling it: a call counts the references to its arrays."""
    return cast(Callable[P, R], njit(inline="always")(function))
