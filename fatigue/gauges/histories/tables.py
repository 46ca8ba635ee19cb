"""The rows of what gauges read, as the columns of ``fatigue.results.dictionary.decided.gauges`` are named."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from fatigue.gauges.histories.counts import Counted, GaugeSpectra
from fatigue.gauges.instrument import Floats
from fatigue.gauges.near import Neighbours, angle_sensitivity, nearest_welds, neighbours, rms
from fatigue.gauges.rows import GaugeRows
from fatigue.gauges.simulated import Reading
from fatigue.life.mission import Pass
from fatigue.pipeline.solve.body import Body

MISSION = "(mission)"


@dataclass(frozen=True, slots=True)
class GaugeRow:
    """Where a gauge sits and how sure its reading is; see the data dictionary."""

    gauge: str
    kind: str
    group: str
    stand_in: bool
    element: int | None
    point: str
    weld: str
    part: int | None
    order: int | None
    surface: str
    x_mm: float
    y_mm: float
    z_mm: float
    dir_x: float
    dir_y: float
    dir_z: float
    normal_x: float
    normal_y: float
    normal_z: float
    angle_deg: float
    grid_length_mm: float
    elements: int
    thickness_mm: float
    place_distance_mm: float
    transverse_sensitivity: float
    E_MPa: float
    nu: float
    nearest_weld: str
    distance_to_weld_mm: float
    rms_ue: float
    rms_MPa: float  # noqa: N815
    angle_sensitivity: float
    neighbours: int
    neighbour_sensitivity: float
    cost: float


@dataclass(frozen=True, slots=True)
class EventRow:
    """What a gauge reads in one event; see the data dictionary."""

    gauge: str
    event: str
    start_s: float
    step_s: float
    samples: int
    km_per_pass: float | None
    rms_ue: float
    rms_MPa: float  # noqa: N815
    mean_ue: float
    min_ue: float
    max_ue: float
    cycles_per_pass: float
    largest_range_ue: float
    exponent: float
    pseudo_damage_per_pass: float
    pseudo_damage_per_km: float
    pseudo_damage_per_mission_km: float
    equivalent_range_1_hz_ue: float


def gauge_table(body: Body, rows: GaugeRows, covariance: Floats) -> list[GaugeRow]:
    """Row of every gauge; ``covariance`` (c, c) of the coordinates over the mission."""
    near = nearest_welds(body.lines, [grid.xyz for grid in rows.grids])
    strain, stress = rms(rows.strain, covariance), rms(rows.stress, covariance)
    found = []
    for i, (gauge, grid) in enumerate(zip(rows.gauges, rows.grids, strict=True)):
        beside: Neighbours = neighbours(gauge, grid, rows.plates, covariance)
        x, d, n = grid.xyz.tolist(), grid.direction.tolist(), grid.normal.tolist()
        found.append(
            GaugeRow(
                gauge=gauge.name,
                kind=gauge.kind,
                group=gauge.group,
                stand_in=grid.stand_in,
                element=grid.element or None,
                point=(gauge.point or gauge.name) if gauge.kind == "table" else "",
                weld=gauge.weld,
                part=grid.part or None,
                order=gauge.order,
                surface=grid.surface,
                x_mm=x[0],
                y_mm=x[1],
                z_mm=x[2],
                dir_x=d[0],
                dir_y=d[1],
                dir_z=d[2],
                normal_x=n[0],
                normal_y=n[1],
                normal_z=n[2],
                angle_deg=grid.angle_deg,
                grid_length_mm=gauge.grid_length,
                elements=len(grid.pieces) if grid.element else 0,
                thickness_mm=grid.thickness,
                place_distance_mm=grid.distance,
                transverse_sensitivity=gauge.transverse_sensitivity,
                E_MPa=grid.material.E,
                nu=grid.material.nu,
                nearest_weld=gauge.weld or near[i].weld,  # a toe may lie on two lines
                distance_to_weld_mm=near[i].distance,
                rms_ue=float(strain[i]),
                rms_MPa=float(stress[i]),
                angle_sensitivity=angle_sensitivity(grid, covariance),
                neighbours=beside.count,
                neighbour_sensitivity=beside.largest,
                cost=gauge.cost,
            )
        )
    return found


def event_table(
    rows: Sequence[GaugeRow],
    readings: Sequence[Reading],
    passes: Sequence[Pass],
    spectra: Sequence[GaugeSpectra],
    exponent: float,
) -> list[EventRow]:
    """Rows of every gauge in every event."""
    found = []
    for g, (row, of) in enumerate(zip(rows, spectra, strict=True)):
        for e, (reading, one) in enumerate(zip(readings, passes, strict=True)):
            strain, damage = reading.strain[g], float(of.power_sum[e])
            found.append(
                EventRow(
                    gauge=row.gauge,
                    event=reading.event,
                    start_s=reading.start,
                    step_s=reading.step,
                    samples=strain.size,
                    km_per_pass=one.length,
                    rms_ue=float(strain.std()),
                    rms_MPa=float(reading.stress[g].std()),
                    mean_ue=float(strain.mean()),
                    min_ue=float(strain.min()),
                    max_ue=float(strain.max()),
                    cycles_per_pass=float(of.cycles[e]),
                    largest_range_ue=float(of.largest[e]),
                    exponent=exponent,
                    pseudo_damage_per_pass=damage,
                    pseudo_damage_per_km=damage / one.length if one.length else np.nan,
                    pseudo_damage_per_mission_km=float(of.weight[e] * damage),
                    equivalent_range_1_hz_ue=float(of.equivalent[e]),
                )
            )
    return found


def spectrum_table(
    names: Sequence[str], events: Sequence[Counted], spectra: Sequence[GaugeSpectra], *, whole: bool
) -> pd.DataFrame:
    """Classes of every gauge in every event, and of the mission where these are the ``whole`` of it."""
    labels = [*(one.event for one in events), *([MISSION] if whole else [])]
    parts = []
    for name, of in zip(names, spectra, strict=True):
        for event, ranges in zip(labels, (*of.ranges, of.mission), strict=False):
            parts.append(
                pd.DataFrame(
                    {
                        "gauge": name,
                        "event": event,
                        "lower_ue": of.edges[:-1],
                        "upper_ue": of.edges[1:],
                        "count_per_km": ranges.count,
                        "power_sum_per_km": ranges.power_sum,
                        "exceedance_per_km": ranges.reached,
                    }
                )
            )
    return pd.concat(parts, ignore_index=True)


def row_table(body: Body, rows: GaugeRows) -> pd.DataFrame:
    """Reading of every gauge per unit of every coordinate."""
    of, g = body.coordinates, len(rows)
    mode = pd.array([n if is_mode else None for n, is_mode in zip(of.number, of.is_mode, strict=True)], dtype="Int64")
    return pd.DataFrame(
        {
            "gauge": np.repeat(np.array(rows.names, dtype=object), len(of)),
            "mode": pd.array(list(mode) * g, dtype="Int64"),
            "unit_load": [load or None for load in of.unit_load] * g,
            "strain_ue": rows.strain.ravel(),
            "stress_MPa": rows.stress.ravel(),
        }
    )


def history_table(names: Sequence[str], readings: Sequence[Reading]) -> pd.DataFrame:
    """Readings of all gauges over time, two columns each, event after event."""
    columns: dict[str, object] = {
        "event": np.concatenate([np.full(one.strain.shape[1], one.event, dtype=object) for one in readings]),
        "time_s": np.concatenate([one.time for one in readings]),
    }
    for g, name in enumerate(names):
        columns[f"{name}_ue"] = np.concatenate([one.strain[g] for one in readings])
        columns[f"{name}_MPa"] = np.concatenate([one.stress[g] for one in readings])
    return pd.DataFrame(columns)
