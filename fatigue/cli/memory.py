"""Memory of the command's own process: whether it may have enough, and that what is freed goes back to the system.

The allocators of Arrow and of C learn from every large table and array to keep the memory of the next ones, for each
thread: some 300 MB in a large job. A library call has no business to change that, so it is done here.
"""

import ctypes
import os

from fatigue.errors import NumericalError, Problem

LARGE = 2 << 20  # bytes; modal stresses of a group of welds are larger: in the heap the gaps they leave add up
SPARE = 64 << 20  # free at the end of the heap: to give it back and take it again for every group takes time
NEEDED_MB = 800  # of address space: the smallest assessment on two cores takes 700, most of it imports
NEEDED_TO_SHOW_MB = 450  # by commands that count nothing
PER_CORE_MB = 20  # stacks of the threads that libraries keep for each core beyond the second
NO_COUNTING = ("schema", "show", "synth", "tension-patch")
HEAPS = 1  # a heap for each thread would hold the gaps of each; few calls are made at a time that matters
M_TRIM_THRESHOLD, M_MMAP_THRESHOLD, M_ARENA_MAX = -1, -3, -8  # malloc.h of glibc


def hold_little() -> None:
    """Make Arrow use the allocator of C, with one heap for all threads that gives back large blocks once they are free.

    To be called before Arrow is imported. Whoever has chosen an allocator for Arrow keeps it.
    """
    os.environ.setdefault("ARROW_DEFAULT_MEMORY_POOL", "system")
    try:
        libc = ctypes.CDLL(None)
        libc.mallopt(M_ARENA_MAX, HEAPS)
        libc.mallopt(M_MMAP_THRESHOLD, LARGE)
        libc.mallopt(M_TRIM_THRESHOLD, SPARE)
    except (AttributeError, OSError, TypeError):  # another C library, with habits of its own
        return


def refuse_little_address_space(command: str | None) -> None:
    """Refuse to begin where `ulimit -v` leaves too little; libraries that meet it crash, or try again without end.

    Raises
    ------
    NumericalError : the limit is below what the command needs
    """
    try:
        import resource  # not there on Windows

        limit, _ = resource.getrlimit(resource.RLIMIT_AS)
    except (ImportError, OSError, ValueError):
        return
    if limit == resource.RLIM_INFINITY or command == "example":
        return
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # a core more takes 40 MB; the counting uses one in any case
    needed = NEEDED_TO_SHOW_MB if command in NO_COUNTING else NEEDED_MB
    needed += PER_CORE_MB * max(0, (os.cpu_count() or 1) - 2)
    if limit < needed << 20:
        what = f"the address space is limited to {limit >> 20} MB (`ulimit -v`), {needed} MB are needed to begin with"
        remedy = f"Raise the limit, for instance `ulimit -v {2 * needed << 10}`, or remove it (`ulimit -v unlimited`)"
        raise NumericalError(Problem("memory", f"fatigue {command or ''}".strip(), what, remedy))
