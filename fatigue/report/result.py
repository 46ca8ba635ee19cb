"""A finished result read for its report: the welds worst first, points that are drawn, details of those that govern."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.life.rule import cycle_damage
from fatigue.report.domains import Domains, read_domains
from fatigue.report.merged_cycles import MOST_ROWS, MergedCycles, ShownPoint, merged_cycles
from fatigue.report.of_record import coordinates_of, events_of, target_of, weights_of
from fatigue.report.variants import assumptions_of, law_of
from fatigue.results import (
    assessed,
    read_provenance,
    read_rows,
    read_table,
    read_welds,
    refuse_mixed,
    row_count,
    rows_of_welds,
)

POINT = ("weld", "part", "order", "surface")
_WORST = ("weld", "worst_part", "worst_order", "worst_surface")
OF_CYCLE = (
    "event", "start_s", "end_s", "range_MPa", "mean_MPa", "count", "bending_ratio", "equivalent_range_dS", "damage",
)  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class ShownResult:
    """What a report needs of a result folder: never all points of a train.

    Attributes
    ----------
    record : provenance
    welds : the register, worst first, those that were not assessed last
    assessed : the register without these
    drawn : the welds, worst first, whose lines are drawn
    nodes : all points of the drawn welds
    toes : number of toe points of all welds
    domains : both domains at the points of all welds
    detailed : the welds, worst first, whose worst point is shown in detail
    damage : the worst points of the detailed welds only
    worst_of : of each detailed weld, the row of its worst point in the table of nodes
    listed : of each detailed weld, the cycles of its worst point; none where these are merged or not kept
    merged : of each detailed weld that has cycles, its merged cycles, where the table of cycles is very long
    folder : where the tables lie
    """

    record: Mapping[str, Any]
    welds: pd.DataFrame
    assessed: pd.DataFrame
    drawn: tuple[str, ...]
    nodes: pd.DataFrame
    toes: int
    domains: Domains
    detailed: tuple[str, ...]
    damage: pd.DataFrame
    worst_of: Mapping[str, pd.Series]
    listed: Mapping[str, pd.DataFrame]
    merged: Mapping[str, MergedCycles]
    folder: Path

    @property
    def target_km(self) -> float:
        """Mileage to be reached [km]."""
        return target_of(self.record)

    @property
    def events(self) -> list[dict[str, Any]]:
        """The events of the mission in its order."""
        return events_of(self.record)

    @property
    def passes_per_km(self) -> dict[str, float]:
        """Passes of every event, and runs of every sequence, in one km of the mission [1/km]."""
        return weights_of(self.record)

    @property
    def coordinates(self) -> dict[int, str]:
        """Names of modes by their ids, and of unit loads by the numbers behind these, in the order of the tables."""
        return coordinates_of(self.record)

    def worst(self, weld: str) -> pd.Series:
        """Row of the worst point of a detailed weld in the table of nodes."""
        return self.worst_of[weld]

    def cycles(self, weld: str) -> pd.DataFrame:
        """Cycles of a detailed weld's worst point, of a very long table merged; none where they are not kept."""
        if weld in self.merged:
            return self.merged[weld].rows[[*OF_CYCLE]]
        return self.listed[weld]

    def modal_stress(self, columns: Sequence[str]) -> dict[str, tuple[pd.DataFrame, NDArray[np.float64]]]:
        """Read stress columns of the detailed welds [MPa per unit modal coordinate].

        Returns for each weld its stations (``part`` and ``order``) and an array (column, station, mode), both in the
        order of the table, which lists all modes of a station one after the other, and its unit loads behind them.
        """
        modes = len(self.coordinates)
        rows = rows_of(self.folder, "structural_stress", self.detailed, ["weld", "part", "order", *columns])
        found = {}
        for weld, of_weld in rows.groupby("weld", sort=False):
            stations = of_weld[["part", "order"]].iloc[::modes].reset_index(drop=True)
            found[str(weld)] = (stations, of_weld[list(columns)].to_numpy().T.reshape(len(columns), -1, modes))
        return found


def read_result(folder: Path, most_detailed: int, most_stations: int) -> ShownResult:
    """Read a result folder.

    Parameters
    ----------
    most_detailed : welds whose worst point is shown in detail
    most_stations : on the lines that are drawn; beyond, the lines of the worst welds are

    Raises
    ------
    DataError : no finished result there, a table is damaged or of another result
    """
    record = read_provenance(folder)
    refuse_mixed(folder, record)
    domains = read_domains(folder, list(weights_of(record)))
    toes = int(np.count_nonzero(read_table(folder, "nodes", ["toe"])["toe"].to_numpy()))
    welds = read_welds(folder)
    rows = assessed(welds)
    detailed = tuple(rows["weld"].head(most_detailed))
    fitting = int(np.searchsorted(rows["nodes"].cumsum(), most_stations, side="right"))
    drawn = tuple(rows["weld"].head(max(fitting, most_detailed)))
    nodes = rows_of(folder, "nodes", drawn)
    worst_nodes = nodes.merge(_places(rows, detailed), on=list(POINT))
    is_long = row_count(folder, "cycles") > MOST_ROWS
    cycles = rows_of_worst_points(folder, "cycles", rows, () if is_long else detailed, [*POINT, *OF_CYCLE])
    return ShownResult(
        record=record,
        welds=welds,
        assessed=rows,
        drawn=drawn,
        nodes=nodes,
        toes=toes,
        domains=domains,
        detailed=detailed,
        damage=rows_of_worst_points(folder, "damage", rows, detailed),
        worst_of={str(row["weld"]): row for _, row in worst_nodes.iterrows()},
        listed=_by_weld(cycles, detailed),
        merged=_merged(folder, record, rows[rows["weld"].isin(detailed)]) if is_long else {},
        folder=folder,
    )


def _merged(folder: Path, record: Mapping[str, Any], welds: pd.DataFrame) -> dict[str, MergedCycles]:
    """Merged cycles of the worst points of some welds."""
    passes = weights_of(record)
    points = {}
    for row in welds.to_dict("records"):
        law = law_of(assumptions_of(record, row["curve"]))
        points[str(row["weld"])] = ShownPoint(
            part=int(row["worst_part"]),
            order=int(row["worst_order"]),
            surface=str(row["worst_surface"]),
            slope=float(law.slopes[0]),
            damage=partial(cycle_damage, law=law),
            passes_per_km=passes,
        )
    return merged_cycles(folder, points, list(passes))


def rows_of(folder: Path, table: str, welds: Sequence[str], columns: Sequence[str] | None = None) -> pd.DataFrame:
    """Read the rows of some welds in the order of the table."""
    rows = np.concatenate([np.zeros(0, dtype=np.int64), *rows_of_welds(folder, table, welds).values()])
    return read_rows(folder, table, np.sort(rows), columns).to_pandas()


def rows_of_worst_points(
    folder: Path, table: str, welds: pd.DataFrame, some: Sequence[str], columns: Sequence[str] | None = None
) -> pd.DataFrame:
    """Read the rows of the worst points of some welds; ``welds`` is the register."""
    return rows_of(folder, table, some, columns).merge(_places(welds, some), on=list(POINT))


def _places(welds: pd.DataFrame, some: Sequence[str]) -> pd.DataFrame:
    """Worst points of some welds of the register, by the columns of a point."""
    return welds.loc[welds["weld"].isin(some), list(_WORST)].set_axis(list(POINT), axis=1)


def _by_weld(cycles: pd.DataFrame, welds: Sequence[str]) -> dict[str, pd.DataFrame]:
    """Cycles of each of some welds, be it none."""
    at = cycles.groupby("weld", sort=False).indices
    return {weld: cycles.iloc[at.get(weld, [])][[*OF_CYCLE]].reset_index(drop=True) for weld in welds}
