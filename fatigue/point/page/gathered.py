"""All that is known of one point: its row in the result, its cycles and damage counted again, its records, and why."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.life.rule import cycle_damage
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.model import Model
from fatigue.point.found import FACES, Station
from fatigue.point.page.beside import checks_at
from fatigue.point.page.counted import CYCLES, count_station, write_band, write_cycles
from fatigue.point.page.shared_out import AS_USUAL, Diagnosed, diagnosed, share_out, tables_of
from fatigue.point.reopened import Reopened, solved_station
from fatigue.report.checks import ShownChecks
from fatigue.report.inputs import FoundInputs
from fatigue.report.merged_cycles import MOST_ROWS, ShownPoint, merged_cycles
from fatigue.report.of_record import Record, events_of, weights_of
from fatigue.report.sections.point.detail import COMPONENTS, Detail, DetailedPoint, point_details
from fatigue.report.sections.point.worst_cycles import leading_event, most_damaging
from fatigue.report.sections.why import Why
from fatigue.report.variants import assumptions_of, law_of
from fatigue.results import read_rows, read_table, read_welds, row_count, rows_of_welds
from fatigue.results.beside.life_band import BandOfPoint, Bands, read_bands
from fatigue.spectrum.moments import point_moments
from fatigue.why.evidence import Evidence
from fatigue.why.points import Points, points_of

Floats = NDArray[np.float64]

CLOSE_BY = 4  # cycles whose stress is shown close by
ON_DEMAND = np.array(["on demand"], dtype=object)


@dataclass(frozen=True, slots=True, eq=False)
class Gathered:
    """What is known of one point.

    Attributes
    ----------
    record : provenance of its result
    station, face : where it is
    stored : its row of ``nodes.parquet``
    counted : the same columns counted again, without those about shear
    weld : row of its weld in the register
    line : rows of all points of its weld
    bands_counted, bands_stored : band of its life counted now, and in the result; None: none there
    damage, damage_stored : its rows of ``damage.parquet`` counted again, and as they are in the result
    cycles : its cycles, with the columns of ``cycles.parquet``; of very many those that are alike are one row
    cycle_rows : how many cycles and half cycles there are
    event : whose record is shown: by default the one that damages most, of an undamaged point that with the largest
        range
    evidence, why : whose damage it is, in numbers and as the tables of a diagnosis
    beside : checks beside the normal stress that the result made at its place
    diagnosis : what the diagnosis in the folder has of it; None where there is none
    detail : what the records say of it
    spectral : moments m0, m1, m2, m4 of its stress in that event [MPa^2 Hz^n] and the duration of a pass [s]; None
        without a spectrum
    """

    record: Record
    station: Station
    face: int
    stored: pd.Series
    counted: pd.Series
    weld: pd.Series
    line: pd.DataFrame
    bands_counted: Bands | None
    bands_stored: Bands | None
    damage: pd.DataFrame
    damage_stored: pd.DataFrame
    cycles: pd.DataFrame
    cycle_rows: int
    event: str
    evidence: Evidence
    why: Why
    beside: ShownChecks
    diagnosis: Diagnosed | None
    detail: Detail
    spectral: tuple[Floats, float] | None

    @property
    def surface(self) -> str:
        """Name of its face."""
        return FACES[self.face]

    @property
    def is_screened(self) -> bool:
        """Whether the result has a bound where it was counted now."""
        return self.station.screened[self.face]

    @property
    def bands(self) -> Bands | None:
        """Bands that hold that of its life: those of the result, with the survival of its line, else that of now."""
        has_it = self.bands_stored is not None and self.bands_stored.of(*self.key) is not None
        return self.bands_stored if has_it and not self.is_screened else self.bands_counted

    @property
    def band(self) -> BandOfPoint | None:
        """Band of its life."""
        return None if self.bands is None else self.bands.of(*self.key)

    @property
    def key(self) -> tuple[str, int, int, str]:
        """Weld, part, order and surface."""
        return self.station.weld, self.station.part, self.station.order, self.surface

    @property
    def row(self) -> pd.Series:
        """Its row in the table of nodes, with counted numbers where the result has bounds."""
        if not self.is_screened:
            return self.stored
        return pd.Series({name: self.counted.get(name, value) for name, value in self.stored.items()})


def gather(
    inputs: Reopened,
    found: FoundInputs,
    station: Station,
    face: int,
    loads: Sequence[EventLoad],
    plan: Plan,
    shown: str | None = None,
) -> Gathered:
    """Solve the welds around a point, count it again under all ``loads``, and share its damage out.

    ``shown`` is the event whose record is shown, None: the one that damages most.

    Raises
    ------
    DataError : a table or an input is damaged, gone or of another result
    NumericalError : stress or damage exceeds double precision
    """
    folder, record = inputs.folder, inputs.record
    model, at = solved_station(inputs, station)
    points = points_of(model, np.array([at]), np.array([face]), ON_DEMAND)
    again = count_station(model, at, loads, plan)
    damage = again.damage[again.damage["surface"] == FACES[face]].reset_index(drop=True)
    stored = read_rows(folder, "nodes", np.array([station.rows[face]])).to_pandas().iloc[0]
    counted = again.nodes.iloc[face]

    scratch = inputs.scratch / "point"
    scratch.mkdir()
    write_cycles(scratch, again, face, loads, plan)
    write_band(scratch, again, face, counted if station.screened[face] else stored, loads, plan)
    weld = read_welds(folder).set_index("weld", drop=False).loc[station.weld]
    cycles = _cycles(scratch, record, station, face, str(weld["curve"]))
    event = _event_of(damage, record) if shown is None else shown

    key = (station.part, station.order, FACES[face])
    known = diagnosed(folder, record, station.weld, key)
    of_events = [damage.iloc[number : number + 1].reset_index(drop=True) for number in range(len(loads))]
    how = AS_USUAL if known is None else known.settings
    this = pd.DataFrame([stored[["weld", "part", "order", "surface"]].to_dict()])
    evidence = share_out(inputs.body, points, loads, plan, of_events, how)
    return Gathered(
        record=record,
        station=station,
        face=face,
        stored=stored,
        counted=counted,
        weld=weld,
        line=read_rows(folder, "nodes", rows_of_welds(folder, "nodes", [station.weld])[station.weld]).to_pandas(),
        bands_counted=read_bands(scratch, this),
        bands_stored=read_bands(folder, this),
        damage=damage,
        damage_stored=_stored_damage(folder, station.rows[face], len(plan.names)),
        cycles=cycles,
        cycle_rows=row_count(scratch, CYCLES),
        event=event,
        evidence=evidence,
        why=tables_of(evidence, scratch),
        beside=checks_at(folder, record, station),
        diagnosis=known,
        detail=_detail(found, record, model, at, points, event, cycles, stored),
        spectral=_spectral(points, loads[[one.event for one in plan.passes].index(event)]),
    )


def _stored_damage(folder: Path, row: int, events: int) -> pd.DataFrame:
    """Rows of a point in the table of damage, which lists all events of every point in the order of the nodes."""
    return read_rows(folder, "damage", row * events + np.arange(events)).to_pandas()


def _cycles(scratch: Path, record: Record, station: Station, face: int, curve: str) -> pd.DataFrame:
    """Cycles that were written to a folder, of very many those that are alike as one row."""
    if row_count(scratch, CYCLES) <= MOST_ROWS:
        return read_table(scratch, CYCLES).to_pandas()
    law, passes_per_km = law_of(assumptions_of(record, curve)), weights_of(record)
    damage = partial(cycle_damage, law=law)
    point = ShownPoint(station.part, station.order, FACES[face], float(law.slopes[0]), damage, passes_per_km)
    return merged_cycles(scratch, {station.weld: point}, list(passes_per_km))[station.weld].rows


def listed(cycles: pd.DataFrame) -> pd.DataFrame:
    """Cycles with their instants, those with the largest ranges first; merged ones have none."""
    return cycles[cycles["start_s"].notna()].sort_values("range_MPa", ascending=False, kind="stable")


def _event_of(damage: pd.DataFrame, record: Record) -> str:
    """The event that damages most, of those with a record; where none does, the one with the largest range."""
    rows = damage[damage["event"].isin([event["event"] for event in events_of(record)])]
    if rows["damage_per_pass"].max() > 0.0 and (leading := leading_event(rows, record)):
        return leading
    return str(rows.loc[rows["max_range_MPa"].idxmax(), "event"])


def _spectral(points: Points, load: EventLoad) -> tuple[Floats, float] | None:
    """Spectral moments of the stress of a point in an event and the duration of a pass; None without a spectrum."""
    if load.moments is None:
        return None
    modal_stress = load.stress_factor * (points.membrane + points.side[:, None] * points.bending)
    moments = point_moments(modal_stress, load.moments)[:, 0]
    return (moments, load.duration) if moments[0] > 0.0 else None


def _detail(
    found: FoundInputs,
    record: Record,
    model: Model,
    at: int,
    points: Points,
    event: str,
    cycles: pd.DataFrame,
    stored: pd.Series,
) -> Detail:
    """What the records say of a point, with the stresses along its weld."""
    stations = model.stations
    of_weld = stations.weld == stations.weld[at]
    components = {name: getattr(stations.treated, column.removesuffix("_MPa")) for name, column in COMPONENTS.items()}
    side = float(points.side[0])
    by_model = stored.get("multiaxial_verdict") == "model_dependent"
    point = DetailedPoint(
        modal_stress=points.membrane[0] + side * points.bending[0],
        stations={name: stress[of_weld] for name, stress in components.items()},
        shear=stations.treated.in_plane_shear[at] + side * stations.treated.twist_shear[at] if by_model else None,
        governing_event=event,
        cycles=most_damaging(listed(cycles), event, CLOSE_BY),
    )
    details, _ = point_details({"": point}, found, record)
    return details[""]
