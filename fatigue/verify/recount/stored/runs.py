"""Cycles and histograms of a result: which points have some, and those of one event, without reading whole tables."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.results import number_groups, read_rows
from fatigue.verify.recount.layout import FACES, Layout, station_finder
from fatigue.verify.recount.stored.compare import ColumnCheck


@dataclass(frozen=True, slots=True, eq=False)
class StoredRuns:
    """Stretches of rows in a table, each of one point and one event.

    Attributes
    ----------
    folder : of the result
    table : its name
    point, event : (r,) index of each run; -1: there is no such point, or no such event
    first : (r + 1,) first row of each run and, last, the number of rows
    """

    folder: Path
    table: str
    point: NDArray[np.int64]
    event: NDArray[np.int64]
    first: NDArray[np.int64]

    def points(self) -> NDArray[np.int64]:
        """Points that have rows, ascending."""
        return np.unique(self.point[self.point >= 0])

    @property
    def strangers(self) -> ColumnCheck:
        """Check that no rows belong to points or events that are not in the case."""
        astray = np.flatnonzero((self.point < 0) | (self.event < 0))
        return ColumnCheck(
            table=self.table,
            column="weld, part, order, surface, event",
            unit="rows",
            compared=int(self.first[-1]),
            difference=float(np.diff(self.first)[astray].sum()),
            tolerance=0.5,  # rows
            where=f"not in the case: row {self.first[astray[0]] + 1}" if len(astray) else "",
            found=int(self.first[-1]),
            expected=int(self.first[-1] - np.diff(self.first)[astray].sum()),
        )

    def of_event(self, event: int, points: Sequence[int], columns: Sequence[str]) -> dict[int, pd.DataFrame]:
        """Rows of one event at some points, by point."""
        runs = np.flatnonzero((self.event == event) & np.isin(self.point, points))
        rows = [np.arange(self.first[run], self.first[run + 1]) for run in runs]
        found = read_rows(self.folder, self.table, np.concatenate([np.zeros(0, dtype=np.int64), *rows]), columns)
        owner = np.repeat(self.point[runs], [len(some) for some in rows])
        frame = found.to_pandas()
        return {point: frame[owner == point] for point in points}


def find_runs(folder: Path, table: str, body: Layout, events: Sequence[str]) -> StoredRuns:
    """Whose cycles or classes of ranges are in which rows.

    Raises
    ------
    DataError : the folder holds no such table, or the file is damaged
    """
    find = station_finder(body)
    known = {"weld": body.welds, "surface": FACES, "event": events}
    pieces, rows = [np.zeros((3, 0), dtype=np.int64)], 0
    for columns in number_groups(folder, table, ["part", "order"], known):
        station = find(columns["weld"], columns["part"], columns["order"])
        point = np.where((station >= 0) & (columns["surface"] >= 0), 2 * station + columns["surface"], -1)
        key = np.stack([point, columns["event"]])
        starts = np.flatnonzero(np.append(True, (np.diff(key) != 0).any(axis=0))[: len(point)])
        pieces.append(np.vstack([key[:, starts], rows + starts]))
        rows += len(point)
    point, event, first = np.concatenate(pieces, axis=1)
    return StoredRuns(folder, table, point, event, np.append(first, rows))
