"""The tables of a result as the recount reads them: where every row is, and the rows of some points."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.results import TABLES, number_groups, read_codes, read_rows, read_table
from fatigue.results.tables import later_columns, table_path
from fatigue.verify.recount.choice import worst_points
from fatigue.verify.recount.inputs.case import RecountInputs
from fatigue.verify.recount.inputs.coordinates import RecountCoordinates
from fatigue.verify.recount.layout import FACES, Layout, station_finder
from fatigue.verify.recount.stored.compare import ColumnCheck, compare_keys
from fatigue.verify.recount.stored.keys import RowPlaces, find_rows
from fatigue.verify.recount.stored.runs import StoredRuns, find_runs

HISTOGRAM_FROM = 0.1  # of the damage limit: a counted toe point has a histogram from there on


@dataclass(frozen=True, slots=True, eq=False)
class Stored:
    """The tables of a result: where the rows of points, stations and cycles are, and the small table of welds.

    ``welds`` are the rows of the welds that were assessed, ``left_out`` the others. ``histogram`` and ``path_cycles``
    are None where the result has no such table.
    """

    folder: Path
    body: Layout
    nodes: RowPlaces
    damage: RowPlaces
    stress: RowPlaces
    cycles: StoredRuns
    histogram: StoredRuns | None
    path_cycles: StoredRuns | None
    welds: pd.DataFrame
    left_out: pd.DataFrame

    @property
    def keys(self) -> list[ColumnCheck]:
        """Checks that every table has the rows it should have."""
        checks = [self.nodes.check, self.damage.check, self.stress.check]
        checks.append(compare_keys("welds", self.welds.index, list(self.body.welds)))
        runs = [run for run in (self.cycles, self.histogram, self.path_cycles) if run is not None]
        return [*checks, *(run.strangers for run in runs if not run.strangers.passed)]


def open_tables(
    folder: Path,
    body: Layout,
    events: Sequence[str],
    coordinates: RecountCoordinates,
    record: Mapping[str, Any],
) -> Stored:
    """Tables of a result, whose provenance is ``record``, with the places of their rows.

    Raises
    ------
    DataError : a table is missing or damaged
    """
    welds = read_table(folder, "welds", [column.name for column in TABLES["welds"]]).to_pandas().set_index("weld")
    welds = welds.drop(columns=later_columns(table_path(folder, "welds"), "welds"))
    is_assessed = welds["status"] == "assessed"
    return Stored(
        folder=folder,
        body=body,
        nodes=find_rows(folder, "nodes", body, {"surface": FACES}),
        damage=find_rows(folder, "damage", body, {"surface": FACES, "event": events}),
        stress=find_rows(
            folder, "structural_stress", body, {"mode": coordinates.mode.tolist()}, coordinates.unit_loads
        ),
        cycles=find_runs(folder, "cycles", body, events),
        histogram=find_runs(folder, "histogram", body, events) if has_histogram(record) else None,
        path_cycles=find_runs(folder, "path_cycles", body, events) if has_paths(record) else None,
        welds=welds[is_assessed],
        left_out=welds[~is_assessed],
    )


def left_out_check(stored: Stored, inputs: RecountInputs) -> list[ColumnCheck]:
    """Check of why welds are not assessed, against the register; nothing where all are assessed."""
    expected, found = Counter(inputs.register.left_out), Counter(stored.left_out["reason"].fillna("").tolist())
    if not expected and not found:
        return []
    astray = list(((expected - found) + (found - expected)).elements())
    return [
        ColumnCheck(
            table="welds",
            column="reason",
            unit="rows",
            compared=expected.total(),
            difference=float(len(astray)),
            tolerance=0.5,  # rows
            where=f"first {astray[0]}" if astray else "",
            found=found.total(),
            expected=expected.total(),
        )
    ]


def rows_of(stored: Stored, table: str, rows: NDArray[np.integer]) -> list[dict[str, Any]]:
    """Rows of a table by their numbers."""
    found: list[dict[str, Any]] = read_rows(stored.folder, table, rows).to_pandas().to_dict("records")
    return found


def toes_and_utilisation(stored: Stored) -> tuple[NDArray[np.bool_], NDArray[np.float64]]:
    """Whether each point is at a toe, and its utilisation, (p,) each."""
    table = read_table(stored.folder, "nodes", ["toe", "utilisation"])
    return stored.nodes.in_order(table["toe"].to_numpy()), stored.nodes.in_order(table["utilisation"].to_numpy())


def is_counted(stored: Stored) -> NDArray[np.bool_]:
    """Whether each point was counted and does not stand for a bound, (p,)."""
    tier, names = read_codes(stored.folder, "nodes", "screened")
    return stored.nodes.in_order(np.array([name == "" for name in [*names, ""]])[tier])


def governing_points(stored: Stored) -> NDArray[np.int64]:
    """Points whose cycles are in the table; of a weld without any, the worst point of its row."""
    points = stored.cycles.points()
    bare = np.setdiff1d(np.arange(len(stored.body.welds)), stored.body.weld[points // 2])
    worst = worst_of_welds(stored, bare)
    return np.union1d(points, worst[worst >= 0]).astype(np.int64)


def worst_of_welds(stored: Stored, welds: NDArray[np.int64]) -> NDArray[np.int64]:
    """Points that the rows of some welds name as the worst; -1 where there is no such point."""
    named = stored.welds.loc[[stored.body.welds[weld] for weld in welds]]
    station = station_finder(stored.body)(welds, named["worst_part"].to_numpy(), named["worst_order"].to_numpy())
    face = np.array([FACES.index(surface) if surface in FACES else -1 for surface in named["worst_surface"]], dtype=int)
    return np.where((station >= 0) & (face >= 0), 2 * station + face, -1)


def with_cycles(stored: Stored, governing: NDArray[np.int64], record: Mapping[str, Any]) -> frozenset[int]:
    """Points of which the table has to have the cycles: they lie in welds from some utilisation on."""
    utilisation = stored.welds["utilisation"].loc[list(stored.body.welds)].to_numpy()
    of_point = utilisation[stored.body.weld[governing // 2]]
    return frozenset(governing[of_point >= record["rules"]["cycles_kept_from_utilisation"]].tolist())


def fastest_peaks(folder: Path, inputs: RecountInputs, events: Sequence[str]) -> list[float]:
    """Highest peak rate of all points in every event [1/s]; 0 where nobody asks for it or there is none."""
    highest = np.zeros(len(events))
    if inputs.case.get("counting", {}).get("upsample", "auto") == "auto":
        for columns in number_groups(folder, "damage", ["peaks_per_s"], {"event": events}):
            np.maximum.at(highest, columns["event"], np.nan_to_num(columns["peaks_per_s"]))
    return highest.tolist()


def has_histogram(record: Mapping[str, Any]) -> bool:
    """Whether a result has a table of classes of ranges; older ones have not."""
    return str(record["rules"].get("histogram", "none")) != "none"


def has_paths(record: Mapping[str, Any]) -> bool:
    """Whether a result has a table of half cycles of paths: where shear is looked at."""
    return str(record["rules"].get("multiaxial", {}).get("method", "off")) != "off"


def with_histogram(stored: Stored, record: Mapping[str, Any], toe: NDArray[np.bool_]) -> frozenset[int]:
    """Points whose classes of ranges are compared: those that have some, and those that have to; ``toe``, (p,)."""
    if stored.histogram is None:
        return frozenset()
    counted, (_, utilisation) = is_counted(stored), toes_and_utilisation(stored)
    if not record["rules"]["histogram"].startswith("every"):
        worst = np.zeros(len(counted), dtype=bool)
        worst[worst_points(stored.body, toe, np.where(counted, utilisation, -1.0))] = True
        counted &= toe & ((utilisation >= HISTOGRAM_FROM) | worst)
    return frozenset([*stored.histogram.points().tolist(), *np.flatnonzero(counted).tolist()])
