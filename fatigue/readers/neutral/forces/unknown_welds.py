"""Rows of a table of forces whose weld nobody knows, refused all together."""

import numpy as np
import pyarrow as pa
import pyarrow.types as pt
from numpy.typing import NDArray

from fatigue.readers.neutral.columns import Columns
from fatigue.readers.neutral.forces.weld_codes import WeldCodes
from fatigue.readers.neutral.tables import Table

MOST_ROWS = 1_000_000  # rows of unknown welds that are looked at


class UnknownWelds:
    """Collects the rows of a file whose weld nobody knows, to refuse them all together."""

    def __init__(self, header: Table) -> None:
        self.header = header
        self.names: list[pa.ChunkedArray] = []
        self.numbers: list[NDArray[np.int64]] = []

    def look(self, weld: pa.ChunkedArray, code: NDArray[np.int32], first: int) -> None:
        """Note those of neighbouring rows of the file, from row ``first``."""
        rows = np.flatnonzero(code == -1)
        if rows.size and sum(map(len, self.numbers)) < MOST_ROWS:
            name = weld.take(rows)
            self.names.append(name.cast(name.type.value_type) if pt.is_dictionary(name.type) else name)
            self.numbers.append(first + rows)

    def refuse(self, welds: WeldCodes) -> None:
        """Refuse the file if there were any."""
        if not self.names:
            return
        number = np.concatenate(self.numbers)
        names = pa.chunked_array([chunk for column in self.names for chunk in column.chunks])
        header = self.header
        rows = Columns(header.columns.names, header.columns.kinds, number.size, lambda _: names, number)
        table = Table(header.path, rows, header.position)
        table.known("weld", *table.groups("weld"), {*welds.code, *welds.skipped}, "the welds")
        table.refuse()
