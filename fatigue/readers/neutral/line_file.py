"""The weld lines of a body in a scratch file, so that memory does not grow with the body.

The lines of a million nodes take some 100 MB. A job needs every line but two or three times, together with its
neighbours in the register.
"""

import weakref
from collections.abc import Iterator
from dataclasses import dataclass
from tempfile import TemporaryFile, gettempdir
from threading import Lock
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from fatigue.files.mishaps import refused_writing
from fatigue.weld.line import LINE_COLUMNS, NODE_COLUMNS, LineStack, WeldLine

AT_ONCE = 64  # lines read together when all are walked through
NODES_AT_ONCE = 16_384  # nodes written together


@dataclass(frozen=True, slots=True, weakref_slot=True, eq=False)
class LineFile:
    """Weld lines one after another, k lines with n nodes in all, their nodes on disk.

    ``heads`` is the stack of the lines without their nodes; ``begin``, (k + 1,), is the position of each line's first
    node, n at its end. The file is closed with the object. Threads may read at the same time.
    """

    heads: LineStack
    begin: NDArray[np.int64]
    record: np.dtype[np.void]
    file: BinaryIO
    lock: Lock

    @property
    def weld(self) -> tuple[str, ...]:
        """Names of the welds, (k,)."""
        return self.heads.weld

    def __len__(self) -> int:
        """Count the lines."""
        return len(self.heads)

    def __iter__(self) -> Iterator[WeldLine]:
        """Read one line after the other."""
        for first in range(0, len(self), AT_ONCE):
            yield from self.lines(slice(first, first + AT_ONCE))

    def lines(self, some: slice) -> LineStack:
        """Read some neighbouring lines."""
        first, end, _ = some.indices(len(self))
        begin = self.begin[first : end + 1]
        with self.lock:
            self.file.seek(int(begin[0]) * self.record.itemsize)
            nodes = np.frombuffer(self.file.read(int(begin[-1] - begin[0]) * self.record.itemsize), self.record)
        heads: dict[str, Any] = {name: getattr(self.heads, name)[first:end] for name in LINE_COLUMNS}
        columns: dict[str, Any] = {name: np.ascontiguousarray(nodes[name]) for name in NODE_COLUMNS}
        return LineStack(**heads, begin=begin - begin[0], **columns)


def line_file(lines: LineStack) -> LineFile:
    """Lines in a scratch file that nobody else sees.

    Raises
    ------
    DataError : the disk for temporary files is full or cannot be written
    """
    columns: dict[str, Any] = {name: getattr(lines, name) for name in NODE_COLUMNS}
    record = np.dtype([(name, column.dtype, column.shape[1:]) for name, column in columns.items()])
    with refused_writing(gettempdir(), "give the same command again, or name another disk in TMPDIR"):
        file = TemporaryFile(prefix="fatigue-")  # noqa: SIM115 (closed with the object that reads it)
        for first in range(0, lines.node.size, NODES_AT_ONCE):
            nodes = slice(first, first + NODES_AT_ONCE)
            some = np.empty(lines.node[nodes].size, record)
            for name, column in columns.items():
                some[name] = column[nodes]
            file.write(some.tobytes())
        file.flush()
    heads = LineStack(
        **{name: getattr(lines, name) for name in LINE_COLUMNS},
        begin=np.zeros_like(lines.begin),
        **{name: column[:0].copy() for name, column in columns.items()},
    )
    found = LineFile(heads, lines.begin, record, file, Lock())
    weakref.finalize(found, file.close)
    return found
