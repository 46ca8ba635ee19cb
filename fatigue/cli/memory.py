"""Memory of the command's own process: what is freed goes back to the system, at a small cost in time.

The allocators of Arrow and of C learn from every large table and array to keep the memory of the next ones, for each
thread: some 300 MB in a large job. A library call has no business to change that, so it is done here.
"""

import ctypes
import os

LARGE = 4 << 20  # bytes
SPARE = 16 << 20  # free at the end of a heap: to give it back and take it again for every group of welds takes time
M_TRIM_THRESHOLD, M_MMAP_THRESHOLD = -1, -3  # malloc.h of glibc


def hold_little() -> None:
    """Have Arrow use the allocator of C, and that give back large blocks and spare ends of heaps once they are free.

    To be called before Arrow is imported. Whoever has chosen an allocator for Arrow keeps it.
    """
    os.environ.setdefault("ARROW_DEFAULT_MEMORY_POOL", "system")
    try:
        libc = ctypes.CDLL(None)
        libc.mallopt(M_MMAP_THRESHOLD, LARGE)
        libc.mallopt(M_TRIM_THRESHOLD, SPARE)
    except (AttributeError, OSError, TypeError):  # another C library, with habits of its own
        return
