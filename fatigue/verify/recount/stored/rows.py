"""Rows of the result tables as they should be, beside the rows as they are."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.verify.recount.anew.curve import RecountCurve
from fatigue.verify.recount.anew.line import RecountLineStress, edge_length, edges
from fatigue.verify.recount.anew.mission import RecountEvent
from fatigue.verify.recount.anew.point import OnePass, Values
from fatigue.verify.recount.anew.rounding import Bounds
from fatigue.verify.recount.inputs.coordinates import RecountCoordinates
from fatigue.verify.recount.layout import Key
from fatigue.verify.recount.stored.compare import TOLERANCE, Row

COMPONENTS = ("membrane", "bending", "in_plane_shear", "twist_shear", "transverse_shear")
NEGLIGIBLE = 1e-9  # of the largest range: what differs between two orders of summation
SMALL = 1e-2  # of the largest range: the ratio of two parts of a smaller one says little
_NOT_COLUMNS = {"power_sum", "R_largest", "with_mean_stress", "with_shear", "shear_ratio"}  # of a pass


@dataclass(frozen=True, slots=True, eq=False)
class RecountWeld:
    """A weld of the case: its row in the weld table, its parts, its curve and the faces that carry a toe.

    ``attachment`` is the length of what it attaches [mm], infinite where nothing is said; ``limit`` is the largest
    Miner sum allowed, ``origin`` status and edition of the curve.
    """

    given: Mapping[str, Any]
    parts: tuple[RecountLineStress, ...]
    curve_name: str
    curve: RecountCurve
    toes: tuple[str, ...]
    attachment: float = np.inf
    limit: float = 1.0
    origin: tuple[str, str] = ("", "")


@dataclass(frozen=True, slots=True, eq=False)
class Station:
    """One node of a solved part of a weld; ``largest`` stress of each mode along the part, (m,) [MPa]."""

    weld: RecountWeld
    solved: RecountLineStress
    at: int
    largest: NDArray[np.float64]


def largest_stress(solved: RecountLineStress) -> NDArray[np.float64]:
    """Largest stress of each mode along a part, (m,) [MPa]: the components added up."""
    both = (np.abs(stress).sum(axis=2).max(axis=0) for stress in (solved.raw, solved.treated))
    return np.asarray(np.maximum(*both))


def node_row(
    key: Key, station: Station, values: Values, bounds: Bounds, found: Mapping[str, Any], raw_life_enough: float
) -> Row:
    """One row of the table of points.

    ``bounds`` are what rounding may do; ``raw_life_enough`` [km] is a life without end treatment from which on the row
    need not give it.
    """
    if pd.isna(found["life_km_raw_end"]) and values["life_km_raw_end"] >= raw_life_enough:
        values = {name: value for name, value in values.items() if name != "life_km_raw_end"}
    solved, line, at = station.solved, station.solved.line, station.at
    x, y, z = (float(v) for v in line.xyz[at])
    size = float(np.abs(line.xyz).max() + np.ptp(line.xyz, axis=0).max())
    geometry = {
        "node": int(line.node[at]),
        "curve_status": station.weld.origin[0],
        "toe": key[3] in station.weld.toes,
        "arc_length_mm": float(solved.arc_length[at]),
        "x_mm": x,
        "y_mm": y,
        "z_mm": z,
        "thickness_mm": float(line.thickness[at]),
        "at_end": bool(solved.at_end[at]),
        "at_corner": bool(solved.at_corner[at]),
        "summed_corner": bool(solved.summed_corner[at]),
    }
    scale = dict.fromkeys(("bending_ratio", "shear_ratio"), 1.0)
    scale["R_largest_cycle"] = max(1.0, values["R_largest_cycle"] ** 2)  # a ratio to a stress that may be close to 0
    scale |= dict.fromkeys(("arc_length_mm", "x_mm", "y_mm", "z_mm"), size)
    scale["mean_stress_MPa"] = values["max_range_MPa"]
    return Row(place(key), found, geometry | values, scale, bool(found["screened"]), bounds)


def damage_row(key: Key, event: RecountEvent, one: OnePass, found: Mapping[str, Any], *, is_bound: bool) -> Row:
    """One row of the table of points and events."""
    values = {name: value for name, value in one.quantities.items() if name not in _NOT_COLUMNS}
    length_km = event.length_km
    per_km = np.nan if length_km is None else 1.0 / length_km
    values |= {
        name.replace("_per_pass", "_per_km"): value * per_km
        for name, value in values.items()
        if name.endswith("_per_pass")
    }
    bounds = one.bounds | {
        name.replace("_per_pass", "_per_km"): bound * (1.0 if length_km is None else 1.0 / length_km)
        for name, bound in one.bounds.items()
        if name.endswith("_per_pass")
    }
    scale = {"bending_ratio": 1.0, "irregularity": 1.0, "outside_share": 1.0}
    scale["mean_stress_MPa"] = one.quantities["max_range_MPa"]
    return Row(f"{place(key)}, event '{event.name}'", found, values, scale, is_bound, bounds)


def stress_rows(station: Station, coordinates: RecountCoordinates, found: Sequence[Mapping[str, Any]]) -> Iterator[Row]:
    """Rows of the table of structural stress for one station: all coordinates."""
    solved, line, at, modes = station.solved, station.solved.line, station.at, len(coordinates.mode)
    for j, label in enumerate(coordinates.labels):
        expected: Values = {"node": int(line.node[at])}
        if "unit_load" in found[j]:
            expected["unit_load"] = coordinates.unit_loads[j - modes] if j >= modes else ""
        for c, name in enumerate(COMPONENTS):
            expected[f"{name}_MPa"] = float(solved.treated[at, j, c])
            expected[f"{name}_raw_MPa"] = float(solved.raw[at, j, c])
        size = float(max(np.abs(solved.treated[:, j]).max(), np.abs(solved.raw[:, j]).max()))
        where = f"weld {line.weld}, part {line.part}, order {line.order[at]}, {label}"
        yield Row(where, found[j], expected, dict.fromkeys(expected, size))


def cycle_row(key: Key, event: RecountEvent, one: OnePass, found: pd.DataFrame) -> Row:
    """All cycles of one event at one point as one row: in each column, sorted, the value that differs most.

    Cycles that only rounding makes are left out on both sides. Where the numbers of cycles differ, all columns do.
    Where rounding reaches further than that, the largest cycle alone is compared.
    """
    if 2.0 * one.cycle_bounds["delta"] > NEGLIGIBLE * one.quantities["max_range_MPa"]:
        return _largest_cycle_row(key, event, one, found)
    our_ranges, their_ranges = one.rows["range_MPa"], found["range_MPa"].to_numpy()
    expected: Values = {}
    stored: Values = {}
    scale = {}
    for name, column in one.rows.items():
        least = our_ranges.max(initial=0.0) * (SMALL if name == "bending_ratio" else NEGLIGIBLE)
        a, b = np.sort(column[our_ranges > least]), np.sort(found[name].to_numpy()[their_ranges > least])
        if not len(a) and not len(b):
            continue
        if len(a) != len(b):
            a, b = np.array([float(len(a))]), np.array([float(len(b))])
        worst = int(np.abs(a - b).argmax())
        expected[name], stored[name], scale[name] = float(a[worst]), float(b[worst]), float(np.abs(a).max())
    if "mean_MPa" in scale:
        scale["mean_MPa"] = max(scale["mean_MPa"], scale["range_MPa"])
    for name in ("start_event", "end_event"):  # of cycles across events only
        expected[name], stored[name] = "", next((text for text in found[name].dropna().tolist() if text), "")
    bounds = dict.fromkeys(("start_s", "end_s"), np.inf if one.cycle_bounds["ties"] else one.cycle_bounds["instant"])
    return Row(f"{place(key)}, event '{event.name}'", stored, expected, scale, bounds=bounds)


def _largest_cycle_row(key: Key, event: RecountEvent, one: OnePass, found: pd.DataFrame) -> Row:
    bounds = {name: bound for name, bound in one.cycle_bounds.items() if name in one.rows}
    expected = {name: float(one.rows[name].max(initial=0.0)) for name in bounds}
    stored = {name: float(found[name].max()) if len(found) else 0.0 for name in bounds}
    return Row(f"{place(key)}, event '{event.name}'", stored, expected, {}, bounds=bounds)


def weld_row(
    weld: RecountWeld,
    recounted: Mapping[Key, Values],
    bounds: Mapping[Key, Bounds],
    found: Mapping[str, Any],
    of_checks: Mapping[str, Any],
    *,
    all_counted: bool,
) -> Row:
    """Row of a weld: the worst of its recounted toe points decides; proven to be it where all points were counted.

    ``of_checks`` are further columns, and whether a check fails that counts.
    """
    parts = [solved.line for solved in weld.parts]
    lives = {key: values for key, values in recounted.items() if key[3] in weld.toes}
    stored: Key = (parts[0].weld, found["worst_part"], found["worst_order"], found["worst_surface"])
    first = max(lives, key=lambda key: lives[key]["utilisation"])
    least = lives[first]["utilisation"] * (1 - TOLERANCE) - bounds[first]["utilisation"]
    if stored not in lives or lives[stored]["utilisation"] + bounds[stored]["utilisation"] < least:
        stored = first
    worst = lives[stored]
    solved = next(s for s in weld.parts if s.line.part == stored[1])
    at = int(np.flatnonzero(solved.line.order == stored[2])[0])
    thickness = np.concatenate([line.thickness for line in parts])
    end_length = parts[0].end_length
    expected: Values = {
        "closed": bool(weld.given["closed"]),
        "parts": len(parts),
        "nodes": len({int(n) for line in parts for n in line.node}),
        "length_mm": sum(edge_length(line.xyz[edge]) for line in parts for edge in edges(line)),
        "thickness_min_mm": float(thickness.min()),
        "thickness_max_mm": float(thickness.max()),
        "surface": weld.given["surface"],
        "curve": weld.curve_name,
        "curve_status": weld.origin[0],
        "edition": weld.origin[1],
        "end_length_mm": np.nan if end_length is None else end_length,
        "attachment_mm": np.nan if np.isinf(weld.attachment) else weld.attachment,
        "damage_limit": weld.limit,
        **{name: worst[name] for name in ("life_km", "life_years", "utilisation", "fulfilled")},
        **({"worst_is_proven": True} if all_counted else {}),
        "worst_part": stored[1],
        "worst_order": stored[2],
        "worst_node": int(solved.line.node[at]),
        "worst_surface": stored[3],
        "worst_arc_length_mm": float(solved.arc_length[at]),
        "worst_summed_corner": bool(solved.summed_corner[at]),
        "governing_event": worst["governing_event"],
        **of_checks,
    }
    expected["fulfilled"] &= not expected.pop("a check fails")
    scale = {"worst_arc_length_mm": expected["length_mm"]}
    expected = {name: value for name, value in expected.items() if name in found}  # fewer columns of older versions
    return Row(f"weld {stored[0]}", found, expected, scale, bounds=bounds[stored])


def place(key: Key) -> str:
    """Place of a point in words."""
    return f"weld {key[0]}, part {key[1]}, order {key[2]}, {key[3]}"
