"""Memory of the command's own process: what is freed is used again by all threads, or goes back to the system.

The allocators of Arrow and of C learn from every large table and array to keep the memory of the next ones, for each
thread: some 300 MB in a large job. A library call has no business to change that, so it is done here.
"""

import ctypes
import os

LARGE = 2 << 20  # bytes; modal stresses of a group of welds are larger: in the heap the gaps they leave add up
SPARE = 64 << 20  # free at the end of the heap: to give it back and take it again for every group takes time
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
