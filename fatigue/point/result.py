"""A finished result in a notebook or a script: its tables as data frames, and any point of it on demand."""

import shutil
import tempfile
import weakref
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from html import escape
from numbers import Integral
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from threadpoolctl import threadpool_limits

from fatigue.errors import CaseError, DataError, Problem, given_names, given_path, refuse
from fatigue.pipeline.run.inputs import Stamp, stamps_of
from fatigue.point.cycles import cycle_frame
from fatigue.point.drawn import FIGURES, FigureName, draw_lives, draw_point, draw_weld
from fatigue.point.found import Station, find_station, meant, refuse_unknown_weld
from fatigue.point.history import (
    Instants,
    event_histories,
    history_frame,
    reads_vertices,
    refuse_unknown_instants,
)
from fatigue.point.reopened import Reopened, reopened
from fatigue.report.of_record import target_of
from fatigue.report.wording import NOT_AVAILABLE, km, life, number
from fatigue.results import (
    ASSESSED,
    TABLES,
    assessed,
    finished_result,
    read_rows,
    read_table,
    read_welds,
    refuse_mixed,
    rows_of_welds,
    worst_toes,
)
from fatigue.results.dictionary.decided.history import HISTORIES
from fatigue.results.tables import unknown_columns
from fatigue.shown import visible

if TYPE_CHECKING:
    import plotly.graph_objects as go

SHOWN = 10  # welds in a notebook


@dataclass(slots=True)
class _Held:
    """Inputs of a result once they were read, what the file system said of them then, and the folder for the rest."""

    inputs: Reopened | None = None
    stamps: Mapping[Path, Stamp] = field(default_factory=dict)
    scratch: Path | None = None


@dataclass(frozen=True, slots=True, weakref_slot=True, eq=False, repr=False)
class Result:
    """A finished result; ``open_result`` makes one.

    A table is read when it is asked for, anew each time, and refused where it is not as it was written. Points need the
    input files, which are read once and refused where they have changed since.

    Attributes
    ----------
    folder : where it is
    record : its provenance: case, inputs, rules, mission, warnings
    case_file : the case it was made from, None where the provenance says
    no_lock : for a file system without locks, see ``fatigue.assess``
    """

    folder: Path
    record: Mapping[str, Any]
    case_file: Path | None = None
    no_lock: bool = False
    _held: _Held = field(default_factory=_Held, init=False)

    @property
    def title(self) -> str:
        """Title of the case."""
        return str(self.record["title"])

    @property
    def target_km(self) -> float:
        """Mileage to be reached [km]."""
        return target_of(self.record)

    @property
    def fulfilled(self) -> bool:
        """Whether every weld meets its target."""
        return bool(assessed(self.welds)["fulfilled"].all())

    @property
    def tables(self) -> list[str]:
        """Names of the tables that are there."""
        return [name for name in TABLES if (self.folder / f"{name}.parquet").exists()]

    @property
    def welds(self) -> pd.DataFrame:
        """Every weld, the assessed ones worst first, those that were not (``status``, ``reason``) behind them."""
        self._as_written("welds")
        return read_welds(self.folder)

    @property
    def nodes(self) -> pd.DataFrame:
        """Every point of every weld, one row each; of a large body see ``worst``, and ``table`` with a weld."""
        return self.table("nodes")

    @property
    def events(self) -> pd.DataFrame:
        """The events of the mission: share or number, passes per km, samples, stress factor."""
        return pd.DataFrame(self.record["mission"]["events"])

    @property
    def warnings(self) -> pd.DataFrame:
        """Warnings of the assessment: ``code``, ``where``, ``what``, ``remedy``, ``count``."""
        columns = ["code", "where", "what", "remedy", "count"]
        return pd.DataFrame(self.record["warnings"], columns=columns)

    def table(self, name: str, columns: str | Sequence[str] | None = None, *, weld: str | None = None) -> pd.DataFrame:
        """One of the ``tables``, or some columns of it; of one weld, where it has welds.

        Raises
        ------
        DataError : no such table, column or weld, or a table that is not as it was written
        """
        if name in TABLES:
            self._as_written(name)
        if weld is None or name not in TABLES:
            return read_table(self.folder, name, columns).to_pandas()
        if "weld" not in [column.name for column in TABLES[name]]:
            what = f"the table {name} has no column weld"
            raise DataError(Problem("no_column", str(self.folder), what, "Leave the weld out"))
        rows = rows_of_welds(self.folder, name, [weld])[weld]
        if not rows.size:
            refuse_unknown_weld(self.folder, weld)
        own = [column.name for column in TABLES[name]]
        wanted = own if columns is None else list(given_names(columns, "columns"))
        refuse(DataError, unknown_columns(self.folder / f"{name}.parquet", wanted, own))
        return read_rows(self.folder, name, rows, wanted).to_pandas()[wanted]

    def columns(self, name: str) -> pd.DataFrame:
        """Columns of one of the ``tables``, or of ``history``: ``column``, ``unit``, ``meaning``.

        Raises
        ------
        DataError : no such table
        """
        known = TABLES | HISTORIES
        if name not in known:
            what = f"there is no table {name!r} of a result"
            raise DataError(Problem("no_table", str(self.folder), what, meant(str(name), list(known))))
        rows = [(column.name, column.unit, column.meaning) for column in known[name]]
        return pd.DataFrame(rows, columns=["column", "unit", "meaning"])

    def worst(self, top: int = SHOWN, *, weld: str | None = None) -> pd.DataFrame:
        """Rows of ``nodes`` of the points with the shortest lives: counted, with a weld toe; of all welds or of one.

        Raises
        ------
        DataError : no such weld, or a table that is not as it was written; CaseError : ``top`` is no number of points
        """
        if not (isinstance(top, Integral) and top >= 1):
            what = f"{top!r} is no number of points"
            raise CaseError(Problem("argument", "top", what, "Give a whole number from 1 on"))
        self._as_written("nodes", "welds")
        if weld is not None:
            refuse_unknown_weld(self.folder, weld)
        rows = worst_toes(self.folder, top, () if weld is None else [weld])
        return read_rows(self.folder, "nodes", rows).to_pandas()

    def point(
        self,
        weld: str,
        order: int | None = None,
        part: int | None = None,
        *,
        node: int | None = None,
        surface: str | None = None,
    ) -> pd.Series:
        """Row of ``nodes`` of one point: at a position along a weld or at a node, by default its worst one.

        Raises
        ------
        DataError : no such point, or several
        """
        station = self._station(weld, order, part, node)
        row = np.array([station.rows[station.face(surface)]])
        return read_rows(self.folder, "nodes", row).to_pandas().iloc[0]

    def history(
        self,
        weld: str,
        order: int | None = None,
        part: int | None = None,
        event: str | None = None,
        *,
        node: int | None = None,
        instants: Instants = "counted",
    ) -> pd.DataFrame:
        """Stress over time [MPa] at a station of a weld, by default its worst: components and both faces, as counted.

        Columns are those of ``fatigue history``: ``event``, ``time_s``, five components, both faces. All of it is in
        memory; ``fatigue.point.written.write_history`` writes it to a file piece by piece.

        Raises
        ------
        DataError : no such point or event, or inputs that are gone or have changed
        """
        refuse_unknown_instants(instants)
        station = self._station(weld, order, part, node)
        with self._reopened() as inputs:
            histories = event_histories(inputs, station, event, instants=instants)
            return history_frame(histories, at_vertices=reads_vertices(inputs, instants))

    def cycles(
        self,
        weld: str,
        order: int | None = None,
        part: int | None = None,
        event: str | None = None,
        *,
        node: int | None = None,
        surface: str | None = None,
    ) -> pd.DataFrame:
        """Every cycle of a point of a weld, by default its worst, in the columns of ``cycles``: counted once more.

        ``surface`` is ``top`` or ``bottom``, by default the face that decides. All of them are in memory.

        Raises
        ------
        DataError : no such point or event, or inputs that are gone or have changed
        """
        station = self._station(weld, order, part, node)
        with self._reopened() as inputs:
            return cycle_frame(inputs, station, station.face(surface), event)

    def figure(
        self,
        name: FigureName,
        weld: str | None = None,
        order: int | None = None,
        part: int | None = None,
        event: str | None = None,
        *,
        node: int | None = None,
        surface: str | None = None,
    ) -> "go.Figure":
        """A figure of the report, of any weld or point: a plotly figure.

        Parameters
        ----------
        name : ``lives`` of all welds; ``weld``: life, load factor and stress along it; of a point its ``history`` with
            the most damaging cycle close by, its ``spectrum``, ``rainflow`` matrices, ``exceedance`` of ranges and
            ``sn`` curve with the spectrum of ranges
        weld : by default the worst one
        order, part, node, surface : the point, by default the worst of the weld
        event : of a point; by default all of them, of a history the one with the most damage

        Raises
        ------
        DataError : no such point or event, or inputs that are gone or have changed; CaseError : no such figure
        """
        if name not in FIGURES:
            what, remedy = f"there is no figure {name!r}", f"Name one of {', '.join(FIGURES)}"
            raise CaseError(Problem("argument", "name", what, remedy))
        if name == "lives":
            return draw_lives(self.welds, self.target_km).plotly()
        if weld is None:
            weld = str(self.welds["weld"].iloc[0])
        if name == "weld":
            return draw_weld(self.table("nodes", weld=weld), self.target_km).plotly()
        station = self._station(weld, order, part, node)
        with self._reopened() as inputs:
            return draw_point(name, inputs, station, station.face(surface), event).plotly()

    def __repr__(self) -> str:
        """Name it in a line."""
        return f"Result({str(self.folder)!r}): {visible(self.title)}"

    def _repr_html_(self) -> str:
        """Title, verdict and the worst welds, for notebooks."""
        welds = assessed(self.welds)
        missed = int((~welds["fulfilled"]).sum())
        verdict = f"{missed} of {len(welds)} welds miss" if missed else f"all {len(welds)} welds meet"
        head = "".join(f"<th>{name}</th>" for name in ("weld", "life [km]", "utilisation", "worst point", "event", ""))
        rows = "".join(_row_html(row) for row in welds.head(SHOWN).to_dict("records"))
        more = f"<p>and {len(welds) - SHOWN} more: <code>.welds</code></p>" if len(welds) > SHOWN else ""
        return (
            f"<h4>{escape(visible(self.title))}</h4><p>{verdict} the target of {escape(km(self.target_km))}.</p>"
            f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>{more}"
        )

    def _as_written(self, *tables: str) -> None:
        """Refuse tables that are of another result, or not as they were written."""
        refuse_mixed(self.folder, self.record, tables, tables)

    def _station(self, weld: str, order: int | None, part: int | None, node: int | None) -> Station:
        self._as_written("nodes", "welds")
        return find_station(self.folder, weld, order=order, node=node, part=part)

    @contextmanager
    def _reopened(self) -> Iterator[Reopened]:
        """The inputs, read again where a file has been touched since they were read; BLAS has one thread meanwhile."""
        held = self._held
        with threadpool_limits(limits=1, user_api="blas"):
            if held.inputs is None or stamps_of(held.inputs.body.case) != held.stamps:
                if held.scratch is None:
                    held.scratch = Path(tempfile.mkdtemp(prefix="fatigue-"))
                    weakref.finalize(self, shutil.rmtree, held.scratch, ignore_errors=True)
                held.inputs = None
                anew = Path(tempfile.mkdtemp(dir=held.scratch))
                inputs = reopened(self.folder, self.record, anew, self.case_file)
                held.inputs, held.stamps = inputs, stamps_of(inputs.body.case)
            yield held.inputs


def open_result(folder: Path | str, *, case_file: Path | str | None = None, no_lock: bool = False) -> Result:
    """Open the folder of a finished result; of its tables nothing is read but the welds.

    Parameters
    ----------
    folder : as ``fatigue assess`` wrote it
    case_file : the case it was made from; by default where the provenance of the result says
    no_lock : for a file system without locks, see ``fatigue.assess``

    Raises
    ------
    DataError : no finished result there, or tables of another one
    """
    folder = given_path(folder, "folder")
    named = None if case_file is None else given_path(case_file, "case_file")
    refuse(DataError, _no_folder(folder))
    record = finished_result(folder, ASSESSED, ("welds",), no_lock=no_lock)
    return Result(folder, record, named, no_lock)


def _no_folder(folder: Path) -> Iterator[Problem]:
    if folder.is_file():
        remedy = f"Give the folder it is in, {folder.parent}"
        yield Problem("not_a_folder", str(folder), "is a file, not the folder of a result", remedy)


def _row_html(weld: Mapping[str, Any]) -> str:
    part, order, node, surface = (weld[f"worst_{name}"] for name in ("part", "order", "node", "surface"))
    event = weld["governing_event"]
    cells = (
        (visible(weld["weld"]), "left"),
        (life(weld["life_km"]), "right"),
        (number(weld["utilisation"]), "right"),
        (f"part {part}, order {order}, node {node}, {surface}", "left"),
        (NOT_AVAILABLE if pd.isna(event) else visible(event), "left"),
        ("meets" if weld["fulfilled"] else "misses", "left"),
    )
    shown = (f'<td style="text-align: {side}; padding: 2px 10px">{escape(text)}</td>' for text, side in cells)
    return f"<tr>{''.join(shown)}</tr>"
