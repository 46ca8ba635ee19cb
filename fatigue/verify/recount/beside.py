"""What a case gives for checks beside the toe, and its pairs of static load cases beside the rows they made."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.verify.recount.anew.beside.endurance import (
    CaseStates,
    HaighLine,
    plane_range,
    worst_combination,
    worst_cycle,
)
from fatigue.verify.recount.anew.beside.point_stress import point_tensors
from fatigue.verify.recount.anew.curve import RecountCurve, curve_named
from fatigue.verify.recount.anew.point import Values
from fatigue.verify.recount.inputs.beside import (
    CaseRow,
    case_rows,
    case_states,
    haigh_lines,
    point_frame,
    stress_frame,
    throat_rows,
)
from fatigue.verify.recount.inputs.case import RecountInputs, strength_factors
from fatigue.verify.recount.inputs.coordinates import RecountCoordinates
from fatigue.verify.recount.stored.checks import where
from fatigue.verify.recount.stored.compare import Row
from fatigue.verify.recount.stored.rows import Station

Floats = NDArray[np.float64]
StationOf = Callable[[str, int, int], Station]


@dataclass(frozen=True, slots=True, eq=False)
class Tables:
    """What the case gives for checks beside the toe."""

    inputs: RecountInputs
    coordinates: RecountCoordinates
    record: Mapping[str, Any]
    throats: Mapping[str, Mapping[str, Any]]
    points: Mapping[str, Mapping[str, Any]]
    stresses: pd.DataFrame | None
    cases: list[CaseRow]
    lines: Mapping[str, HaighLine]
    factors: Sequence[Mapping[str, Any]]

    def curve(self, name: str) -> RecountCurve:
        """A curve as this case uses it."""
        return curve_named(name, self.inputs.case, self.record, self.factors)

    def tensors(self, point: str) -> Mapping[str, Floats]:
        """Stress (3, c) per unit coordinate at the surfaces of a stress point."""
        assert self.stresses is not None
        own = self.points[point]
        sign = {"on_element": 1.0, "on_node": -1.0}[self.inputs.case["body"]["force_convention"]]
        scale = np.array(self.coordinates.force_factor)
        modes = len(self.coordinates.mode)
        scale = np.concatenate([sign * scale[:modes], np.ones(len(scale) - modes)])
        rows = self.stresses[self.stresses["point"] == point]
        return point_tensors(rows, str(own["kind"]), float(own["thickness_mm"]), self.coordinates, scale)


def read_tables(inputs: RecountInputs, coordinates: RecountCoordinates, record: Mapping[str, Any]) -> Tables:
    """All tables of a case for checks beside the toe."""
    has_points = inputs.case["body"].get("stress_points") is not None
    return Tables(
        inputs=inputs,
        coordinates=coordinates,
        record=record,
        throats=throat_rows(inputs),
        points=point_frame(inputs),
        stresses=stress_frame(inputs) if has_points else None,
        cases=case_rows(inputs, coordinates),
        lines=haigh_lines(inputs),
        factors=strength_factors(inputs),
    )


def endurance_rows(row: Mapping[str, Any], tables: Tables, station_of: StationOf) -> list[Row]:
    """An endurance check as it should be: of the asked ones that may have made the row, the one that is nearest."""
    if pd.isna(row["fulfilled"]):
        return []
    states = _stress_at(row, tables, station_of)
    found = []
    for check in tables.inputs.case["checks"]["endurance"]:
        of = case_states(tables.cases, check["cases"], row["point"], states)
        names = [check[name] for name in ("perp", "par", "shear") if check.get(name)]
        if of is None or row["curve"] not in (*names, check.get("curve"), " + ".join(names)):
            continue
        expected = _columns(row, check, of, tables, station_of)
        if expected is not None:
            found.append(Row(where(row), row, expected, {"R": max(1.0, abs(row["R"])), "amplitude_MPa": 1e-3}))
    if not found:
        return []

    def apart(one: Row) -> float:
        value = one.expected["utilisation_stress"]
        return abs(value - row["utilisation_stress"]) if not np.isnan(value) else np.inf

    return [min(found, key=apart)]


def _stress_at(row: Mapping[str, Any], tables: Tables, station_of: StationOf) -> Floats | None:
    """Stress (3, c) per unit coordinate across the weld, along it and in shear at the place of a row."""
    if row["point"]:
        return tables.tensors(row["point"])[row["surface"]] if row["point"] in tables.points else None
    station = station_of(row["weld"], int(row["part"]), int(row["order"]))
    side = 1.0 if row["surface"] == "top" else -1.0
    membrane, bending, in_plane, twist, _ = station.solved.treated[station.at].T
    return np.stack([membrane + side * bending, np.zeros_like(membrane), in_plane + side * twist])


def _columns(
    row: Mapping[str, Any], check: Mapping[str, Any], of: CaseStates, tables: Tables, station_of: StationOf
) -> Values | None:
    """Columns of one endurance check at one place; None where corners are too many to go through."""
    across = plane_range(of)
    plane = {} if np.isnan(across) else {"plane_range_MPa": across}
    if row["component"] == "combination":
        lines = {name: tables.lines[check[name]] for name in ("perp", "par", "shear") if check.get(name)}
        worst = worst_combination(of, lines, check.get("kappa", ())) if check.get("limit") else None
        if worst is None:
            return None
        value, limit = worst[0], float(check["limit"])
        return plane | {
            "value": value,
            "limit_value": limit,
            "utilisation_stress": float(np.sqrt(value / limit)),
            "fulfilled": bool(value <= limit),
        }
    line = tables.lines.get(row["curve"])
    cycle = worst_cycle(of, row["component"], line)
    values = {name: float(cycle[name]) for name in ("range_max_MPa", "R", "amplitude_MPa", "allowed_amplitude_MPa")}
    used = float(cycle["utilisation_stress"])
    if line is None:
        curve = tables.curve(row["curve"])
        endured = curve.cutoff or (curve.knees[-1] if curve.knees else np.nan)
        if row["point"]:
            thickness = float(tables.points[row["point"]]["thickness_mm"]) if row["point"] in tables.points else np.nan
        else:
            station = station_of(row["weld"], int(row["part"]), int(row["order"]))
            thickness = float(station.solved.line.thickness[station.at])
        used = curve.size_factor(thickness) * values["range_max_MPa"] / endured
    return plane | values | {"utilisation_stress": used, "fulfilled": used <= 1.0}
