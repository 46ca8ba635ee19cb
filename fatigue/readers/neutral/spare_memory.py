"""Memory that is free and still held: the allocators of Arrow and C keep for the next table what a large one took."""

import ctypes

import pyarrow as pa


def give_back() -> None:
    """Give freed memory back to the system; nothing is lost by it, and it takes some milliseconds.

    Some 100 MB are free after a body of a million nodes has been read. In an assessment of its welds, group after
    group, the gaps between what is held would grow to 300 MB.
    """
    pa.default_memory_pool().release_unused()
    try:
        ctypes.CDLL(None).malloc_trim(0)
    except (AttributeError, OSError, TypeError):  # a C library other than glibc does without
        return
