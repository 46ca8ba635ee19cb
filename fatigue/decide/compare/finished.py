"""Finished results as they are compared: what each says of its points, its welds and its mission."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.decide.of_result import FACES, case_keys, counted_points, damage_limits, loops_of
from fatigue.errors import DataError, Problem
from fatigue.report.of_record import weights_of
from fatigue.results import assessed, finished_result, not_assessed, read_codes, read_rows, read_table, read_welds

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

READ = ("nodes", "damage", "welds")
LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
_NUMBERS = ["part", "node", "order", "toe", "x_mm", "y_mm", "z_mm", "damage_per_km", "life_km"]


@dataclass(frozen=True, slots=True, eq=False)
class Points:
    """Points of a result, n rows, top face and bottom face of each of n / 2 stations in turn.

    Attributes
    ----------
    weld : (n,) number of the weld, in the order of ``names``
    part, node, order : (n,)
    xyz : (n / 2, 3) [mm]
    toe : (n,) whether the face carries a weld toe
    damage : (n,) Miner sum per km, or a bound of it where ``screened`` [1/km]
    life : (n,) [km]
    """

    names: tuple[str, ...]
    weld: Ints
    part: Ints
    node: Ints
    order: Ints
    xyz: Floats
    toe: NDArray[np.bool_]
    damage: Floats
    life: Floats
    screened: NDArray[np.bool_]

    def __len__(self) -> int:
        """Count the points."""
        return len(self.weld)

    @property
    def stations(self) -> slice:
        """Rows of the top faces: one for each station."""
        return slice(0, None, 2)

    def keys(self, rows: Ints) -> dict[str, Any]:
        """Columns that name some points."""
        return {
            "weld": np.array(self.names, object)[self.weld[rows]],
            "part": self.part[rows],
            "node": self.node[rows],
            "order": self.order[rows],
            "surface": np.array(FACES, object)[rows % 2],
        }


@dataclass(frozen=True, slots=True, eq=False)
class Finished:
    """A finished result.

    Attributes
    ----------
    letter : A for the reference, B, C ... for those compared with it
    welds : those that were assessed, a row each, by name
    left_out : listed welds that were not assessed, with the reason, by name
    limit : largest Miner sum allowed on each weld of ``points.names``
    passes : passes per km of every event, and runs per km of every sequence behind them [1/km]
    is_diagnosed : whether there is a table that says what the modes did
    """

    letter: str
    folder: Path
    record: Mapping[str, Any]
    points: Points
    welds: pd.DataFrame
    left_out: Mapping[str, str]
    limit: Floats
    passes: Mapping[str, float]
    is_diagnosed: bool

    @property
    def sequences(self) -> frozenset[str]:
        """Names of the sequences of events, which are no events."""
        return frozenset(loop["name"] for loop in loops_of(self.record))

    @property
    def case_keys(self) -> dict[str, Any]:
        """The case as it was assessed, its keys by their tables."""
        return case_keys(self.record)

    @property
    def frequency_hz(self) -> dict[int, float]:
        """Natural frequency of every mode [Hz]."""
        modes = self.record["modes"]
        return dict(zip(modes["used"], modes["frequency_hz"], strict=True))

    @property
    def worst(self) -> Ints:
        """Row of the worst point of every weld of ``points.names``; -1 of a weld without one."""
        points = self.points
        known = self.welds.reindex(points.names)
        at = known["worst_part"].notna() & known["worst_order"].notna()
        wanted = known[at]
        of_point = pd.MultiIndex.from_arrays([points.weld, points.part, points.order, np.arange(len(points)) % 2])
        keys = [np.flatnonzero(at), wanted["worst_part"], wanted["worst_order"], wanted["worst_surface"].eq("bottom")]
        found = np.full(len(points.names), -1)
        found[np.flatnonzero(at)] = of_point.get_indexer(pd.MultiIndex.from_arrays([np.asarray(k, int) for k in keys]))
        return found

    def damage_per_pass(self, rows: Ints) -> Floats:
        """Miner sum of a pass of every event and of a run of every sequence at some points, (p, e) as ``passes``.

        Raises
        ------
        DataError : the table has other rows than the points and events of the result
        """
        events = list(self.passes)
        wanted = (rows[:, None] * len(events) + np.arange(len(events))).ravel()
        once, place = np.unique(wanted, return_inverse=True)
        table = read_rows(self.folder, "damage", once, ["event", "damage_per_pass"])
        if table["event"].to_pylist() != np.array(events, object)[once % len(events)].tolist():
            what = "its rows are not those of the points and events of this result"
            raise DataError(
                Problem("damaged_result", str(self.folder / "damage.parquet"), what, "Run the assessment again")
            )
        return np.asarray(table["damage_per_pass"].to_numpy()[place].reshape(len(rows), len(events)), np.float64)


def read_results(folders: Sequence[Path], *, no_lock: bool) -> list[Finished]:
    """Read finished results, the first of which is the reference.

    Raises
    ------
    DataError : a folder without finished result, or with tables that are not as they were written
    """
    return [_read(letter, folder, no_lock=no_lock) for letter, folder in zip(LETTERS, folders, strict=False)]


def _read(letter: str, folder: Path, *, no_lock: bool) -> Finished:
    is_diagnosed = (folder / "attribution.parquet").exists()
    tables = [*READ, *["attribution"] * is_diagnosed]
    record = finished_result(folder, tables, tables, no_lock=no_lock)
    points, every = _points(folder), read_welds(folder)
    welds = assessed(every).set_index("weld")
    out = not_assessed(every)
    return Finished(
        letter=letter,
        folder=folder,
        record=record,
        points=points,
        welds=welds,
        left_out=dict(zip(out["weld"], out["reason"], strict=True)),
        limit=damage_limits(every, points.names, record),
        passes=weights_of(record),
        is_diagnosed=is_diagnosed,
    )


def _points(folder: Path) -> Points:
    table = read_table(folder, "nodes", _NUMBERS)
    column = {name: table[name].to_numpy() for name in _NUMBERS}
    code, names = read_codes(folder, "nodes", "weld")
    face, faces = read_codes(folder, "nodes", "surface")
    if [faces[f] for f in np.unique(face[0::2])] + [faces[f] for f in np.unique(face[1::2])] != list(FACES):
        what = "it does not have the top and the bottom face of every station in turn"
        raise DataError(Problem("damaged_result", str(folder / "nodes.parquet"), what, "Run the assessment again"))
    return Points(
        names=tuple(names),
        weld=code.astype(np.int64),
        part=column["part"].astype(np.int64),
        node=column["node"].astype(np.int64),
        order=column["order"].astype(np.int64),
        xyz=np.column_stack([column[name][0::2] for name in ("x_mm", "y_mm", "z_mm")]),
        toe=column["toe"].astype(np.bool_),
        damage=column["damage_per_km"],
        life=column["life_km"],
        screened=~counted_points(folder),
    )
