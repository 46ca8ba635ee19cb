"""A check of nodal forces in the order of their file, which shows in one pass that none of them will be refused.

Most programs write node by node all modes, in the same order of modes at every node. Where they do, a few comparisons
of whole columns take the place of looking up every row; the nodes may come in any order. A table of another form, or
with any mistake in it, is left to ``check_nodal_forces``, which looks at every row and says what is wrong.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pyarrow as pa
import pyarrow.types as pt
from numpy.typing import NDArray

from fatigue.errors import DataError
from fatigue.readers.neutral.body.modes import Modes
from fatigue.readers.neutral.columns import DAMAGE
from fatigue.readers.neutral.forces.convention import COMPONENTS
from fatigue.readers.neutral.forces.placement import stations_of
from fatigue.readers.neutral.forces.source import Batches, Source
from fatigue.readers.neutral.forces.weld_codes import WeldCodes
from fatigue.readers.neutral.line_file import LineFile

ROWS_AT_ONCE = 250_000  # decoded: 10 MB


class NotRegular(Exception):
    """The table is not of the form that can be checked here, or not without mistakes."""


@dataclass(frozen=True, slots=True, eq=False)
class RegularCheck:
    """A table of forces under the assumption that row after row it has the modes of ``cycle``, again and again.

    ``batches`` and ``rows`` come from the ``Source``; ``welds`` are numbered as in ``lines``. ``modes`` repeats the
    cycle for a batch of rows that begins anywhere in it. Threads may check different buckets at the same time.
    """

    batches: Batches
    rows: tuple[int, ...]
    welds: WeldCodes
    lines: LineFile
    cycle: NDArray[np.int64]
    modes: NDArray[np.int64]

    def runs(self, bucket: int) -> NDArray[np.int64]:
        """Runs of rows of one station in a bucket, (2, k): the first slot of each run, and how many rows it has.

        Slots count through all stations in the order of the lines, and at each through the ``cycle``.

        Raises
        ------
        NotRegular : it has to be looked at row by row
        """
        width = self.cycle.size
        first = sum(self.rows[:bucket])
        found = [np.zeros((2, 0), dtype=np.int64)]
        rows = 0
        try:
            for batch in self.batches(bucket, ROWS_AT_ONCE):
                found.append(self._runs(batch, (first + rows) % width))
                rows += batch.num_rows
        except DAMAGE:
            raise NotRegular from None
        if rows != self.rows[bucket]:
            raise NotRegular
        return np.concatenate(found, axis=1)

    def covers(self, runs: Sequence[NDArray[np.int64]]) -> bool:
        """Whether the runs of all buckets fill every slot exactly once."""
        slot, rows = np.concatenate(runs, axis=1)
        if np.any(slot[1:] < slot[:-1]):
            order = np.argsort(slot)
            slot, rows = slot[order], rows[order]
        slots = int(self.lines.begin[-1]) * self.cycle.size
        return bool(np.array_equal(np.append(0, slot + rows), np.append(slot, slots)))

    def _runs(self, batch: pa.RecordBatch, phase: int) -> NDArray[np.int64]:
        """Runs in a batch whose first row has the mode at ``phase`` of the cycle."""
        if any(column.null_count for column in batch.columns):
            raise NotRegular
        for name in COMPONENTS:
            values = batch.column(name).to_numpy()
            if not (np.isfinite(values.min()) and np.isfinite(values.max())):  # NaN is both
                raise NotRegular
        width, rows = self.cycle.size, batch.num_rows
        if not np.array_equal(batch.column("mode").to_numpy(), self.modes[phase : phase + rows]):
            raise NotRegular
        begin = np.arange(-phase, rows, width)
        begin[0] = 0
        ((known, weld),) = self.welds.coded(pa.chunked_array([batch.column("weld")]))
        node = batch.column("node").to_numpy()
        for ids in (weld, node):
            changes = ids[1:] != ids[:-1]
            changes[begin[1:] - 1] = False
            if changes.any():
                raise NotRegular
        slot = self._stations(known[weld[begin]], node[begin].astype(np.int64)) * width
        slot[0] += phase
        return np.stack([slot, np.diff(begin, append=rows)])

    def _stations(self, weld: NDArray[np.int32], node: NDArray[np.int64]) -> NDArray[np.int64]:
        """Position of each (weld, node) along the lines of all welds."""
        first, last = int(weld.min()), int(weld.max())
        if first < 0:
            raise NotRegular
        some = self.lines.lines(slice(first, last + 1))
        station = stations_of(some.weld, weld - first, node, some).astype(np.int64)
        if np.any(station < 0):
            raise NotRegular
        return np.asarray(station + self.lines.begin[first])


def regular_check(
    source: Source, welds: WeldCodes, lines: LineFile, modes: Modes, ignore_modes: Collection[int], *, strict: bool
) -> RegularCheck | None:
    """Check of a table whose rows begin node by node; None where they do not.

    ``welds`` have to be numbered as in ``lines``.
    """
    table = replace(source.header, problems=[], warnings=[])
    if source.batches is None:
        return None
    try:
        table.expect(("weld", "node", "mode", *COMPONENTS), (), strict=strict)
    except DataError:
        return None
    kinds = {name: table.columns.kinds[position] for name, position in table.position.items()}
    whole = all(pt.is_integer(kinds[name]) and kinds[name] != pa.uint64() for name in ("node", "mode"))
    floating = all(kinds[name] in (pa.float32(), pa.float64()) for name in COMPONENTS)
    if table.problems or not (whole and floating):
        return None
    try:
        mode = _first_modes(source.batches, len(source.rows), modes.mode.size + len(ignore_modes) + 1)
    except DAMAGE:
        return None
    again = np.flatnonzero(mode[1:] == mode[0])
    cycle = mode[: again[0] + 1] if again.size else mode
    used = cycle[~np.isin(cycle, list(ignore_modes))]
    if not np.array_equal(np.sort(used), modes.mode) or np.unique(cycle).size < cycle.size:
        return None
    return RegularCheck(source.batches, source.rows, welds, lines, cycle, np.resize(cycle, cycle.size + ROWS_AT_ONCE))


def _first_modes(batches: Batches, buckets: int, rows: int) -> NDArray[np.int64]:
    """Modes of so many rows at the beginning; ``pa.ArrowInvalid`` where one is missing."""
    found = np.zeros(0, dtype=np.int64)
    for batch in (batch for bucket in range(buckets) for batch in batches(bucket, rows)):
        found = np.append(found, batch.column("mode").to_numpy().astype(np.int64))
        if found.size >= rows:
            break
    return found
