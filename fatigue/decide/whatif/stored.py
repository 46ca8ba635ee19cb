"""What a result has stored of its points, read as far as a question needs it: columns, not tables.

Rows of ``damage.parquet`` are point by point as those of ``nodes.parquet``, and event by event within a point.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, Self

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.decide.of_result import FACES, attachment_lengths, counted_points, events_and_loops
from fatigue.errors import DataError, Problem
from fatigue.life.bounds.histogram import Classes
from fatigue.results import (
    ASSESSED,
    assessed,
    finished_result,
    number_groups,
    read_codes,
    read_table,
    read_welds,
    refuse_mixed,
)
from fatigue.results.tables import table_path

Floats = NDArray[np.float64]
Kind = Literal["S", "dS"]
LARGEST: dict[Kind, str] = {"S": "max_range_MPa", "dS": "max_equivalent_range_dS"}
READ = ("nodes", "damage", "welds")


@dataclass(frozen=True, slots=True, eq=False)
class Stored:
    """A finished result with n points and r events and loops.

    Attributes
    ----------
    folder, record : where it is, and its provenance
    names : of the events, then of the loops
    welds : names of the welds
    weld : (n,) number of the weld of each point
    toe : (n,) whether it carries a weld toe
    counted : (n,) whether its cycles were counted; else its damage is a bound
    damage_per_km : (n,) Miner sum per km
    per_pass : (n, r) Miner sum of one pass, or of one run of a loop
    thickness, attachment : (n,) of the plate and of what the weld attaches [mm]; +inf: it has no length
    of_welds : (w,) rows of ``welds.parquet``, by the number of the weld
    """

    folder: Path
    record: Mapping[str, Any]
    names: tuple[str, ...]
    welds: tuple[str, ...]
    weld: NDArray[np.int32]
    toe: NDArray[np.bool_]
    counted: NDArray[np.bool_]
    damage_per_km: Floats
    per_pass: Floats
    thickness: Floats
    attachment: Floats
    of_welds: pd.DataFrame

    def __len__(self) -> int:
        """Number of points."""
        return len(self.weld)

    def largest(self, kind: Kind) -> Floats:
        """Largest range (n, r) of every event and loop, or a bound of it."""
        column: Floats = read_table(self.folder, "damage", [LARGEST[kind]])[LARGEST[kind]].to_numpy()
        return column.reshape(len(self), len(self.names))

    def cycles(self) -> Floats:
        """Cycles (n, r) of one pass of every event, and what one run of a loop changes; NaN of points not counted."""
        column: Floats = read_table(self.folder, "damage", ["cycles_per_pass"])["cycles_per_pass"].to_numpy()
        return column.reshape(len(self), len(self.names))

    def keys(self) -> pd.DataFrame:
        """Key of every point and its node, row by row."""
        texts = {}
        for name in ("weld", "surface"):
            codes, words = read_codes(self.folder, "nodes", name)
            texts[name] = pd.Categorical.from_codes(codes, categories=words)
        table = read_table(self.folder, "nodes", ["part", "node", "order"])
        numbers = {name: table[name].to_numpy() for name in table.column_names}
        return pd.DataFrame({"weld": texts["weld"], **numbers, "surface": texts["surface"]})


@dataclass(frozen=True, slots=True, eq=False)
class StoredRanges:
    """Histograms of some points: ``classes.of`` is the number of the point; ``row`` (c,) of event or loop."""

    classes: Classes
    row: NDArray[np.intp]

    def some(self, rows: NDArray[np.bool_]) -> Self:
        """Some of the classes."""
        return type(self)(self.classes.some(rows), self.row[rows])

    def classes_of(self, rows: NDArray[np.bool_], weights: Floats) -> Classes:
        """Some of the classes per km, of events and loops with these weights (r,) [1/km]."""
        some = self.some(rows)
        return some.classes.times(weights[some.row])


def open_stored(folder: Path, *, no_lock: bool = False) -> Stored:
    """What a finished result has stored.

    Raises
    ------
    DataError : no finished result in the folder, a table is damaged, or its rows are not point by point
    """
    record = finished_result(folder, ASSESSED, READ, no_lock=no_lock)
    names = events_and_loops(record)
    weld, welds = read_codes(folder, "nodes", "weld")
    nodes = read_table(folder, "nodes", ["toe", "damage_per_km", "thickness_mm"])
    column = read_table(folder, "damage", ["damage_per_pass"])["damage_per_pass"].to_numpy()
    if len(column) != len(weld) * len(names) or not _in_order(folder, names):
        what = "its rows are not event by event as those of nodes.parquet are point by point"
        raise DataError(Problem("other_points", str(table_path(folder, "damage")), what, "Run the assessment again"))
    of_welds = assessed(read_welds(folder)).set_index("weld").loc[welds].reset_index()
    return Stored(
        folder=folder,
        record=record,
        names=names,
        welds=tuple(welds),
        weld=weld,
        toe=nodes["toe"].to_numpy(),
        counted=counted_points(folder),
        damage_per_km=nodes["damage_per_km"].to_numpy(),
        per_pass=column.reshape(len(weld), len(names)),
        thickness=nodes["thickness_mm"].to_numpy(),
        attachment=attachment_lengths(of_welds)[weld],
        of_welds=of_welds,
    )


def _in_order(folder: Path, names: Sequence[str]) -> bool:
    """Whether the rows of every point are its events in their order."""
    codes, words = read_codes(folder, "damage", "event")
    place = np.array([words.index(name) if name in words else -2 for name in names])
    return bool((codes.reshape(-1, len(names)) == place).all())


def stored_ranges(stored: Stored, kind: Kind) -> StoredRanges:
    """The histograms of a result, of one kind of range; none where it has none.

    Raises
    ------
    DataError : the table is damaged, or has points that the result has not
    """
    if not (stored.folder / "histogram.parquet").exists():
        return StoredRanges(Classes(*(np.zeros(0, np.intp),) * 2, *(np.zeros(0),) * 3), np.zeros(0, np.intp))
    refuse_mixed(stored.folder, stored.record, ("histogram",), ("histogram",))
    numbers = ("part", "order", "bin", "count_per_pass", "power_sum_per_pass")
    texts = {"kind": (kind,), "weld": stored.welds, "event": stored.names, "surface": FACES}
    groups = number_groups(stored.folder, "histogram", numbers, texts)
    parts = [{name: of[name][of["kind"] == 0] for name in (*numbers, *texts)} for of in groups]
    rows = {name: np.concatenate([part[name] for part in parts]) for name in (*numbers, *texts)}
    point, event = _points(stored, rows), rows["event"].astype(np.intp)
    largest = stored.largest(kind)[point, event]
    counts = rows["count_per_pass"], rows["power_sum_per_pass"]
    return StoredRanges(Classes(point, rows["bin"].astype(np.intp), *counts, largest), event)


def _points(stored: Stored, rows: Mapping[str, NDArray[Any]]) -> NDArray[np.intp]:
    """Row in the table of nodes of every row of the histogram.

    Raises
    ------
    DataError : there is none
    """
    keys = stored.keys()
    face = (keys["surface"] == "bottom").to_numpy()
    every = _code(stored.weld, keys["part"].to_numpy(), keys["order"].to_numpy(), face)
    wanted = _code(rows["weld"], rows["part"], rows["order"], rows["surface"])
    ascending = np.argsort(every, kind="stable")
    at = np.searchsorted(every[ascending], wanted)
    row = ascending[np.minimum(at, len(every) - 1)]
    if (every[row] != wanted).any() or (rows["event"] < 0).any():
        what, remedy = "has points or events that nodes.parquet has not", "Run the assessment again"
        raise DataError(Problem("other_points", str(table_path(stored.folder, "histogram")), what, remedy))
    return row


def _code(weld: NDArray[Any], part: NDArray[Any], order: NDArray[Any], face: NDArray[Any]) -> NDArray[np.int64]:
    """One number for the key of a point."""
    numbers = weld.astype(np.int64)
    for value, most in ((part, 1 << 12), (order, 1 << 30), (face, 2)):
        numbers = numbers * most + value.astype(np.int64)
    return numbers
