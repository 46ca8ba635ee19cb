"""The recount of checks beside the toe: rows are chosen, their stresses made and counted anew, and compared.

A row is told by its place and by what it is of; where directions are searched all of them are counted, and the one in
the table has to do as much damage as any other.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.verify.recount.anew.beside.mission import missions, signal
from fatigue.verify.recount.anew.beside.point_stress import ALL_ROUND, NEAR_TOE, on_plane, shear_on_plane
from fatigue.verify.recount.anew.beside.throat import SIDES, throat_stress
from fatigue.verify.recount.anew.point import RecountPoint, Values
from fatigue.verify.recount.anew.rounding import Bounds
from fatigue.verify.recount.beside import StationOf, Tables, endurance_rows, read_tables
from fatigue.verify.recount.counted import mean_stress_of
from fatigue.verify.recount.inputs.case import RecountInputs
from fatigue.verify.recount.inputs.coordinates import RecountCoordinates
from fatigue.verify.recount.layout import Layout
from fatigue.verify.recount.stored.checks import chosen_rows, consistent, missing_rows, where
from fatigue.verify.recount.stored.compare import LOAD_FACTOR_STEP, TOLERANCE, ColumnCheck, Row, compare, merged
from fatigue.verify.recount.stored.rows import Station

Floats = NDArray[np.float64]

CHECK_OF_KIND = {"hot_spot_a": "hot_spot", "hot_spot_b": "hot_spot", "nominal": "nominal", "parent": "parent",
                 "haz": "parent"}  # fmt: skip
HALF_CIRCLE = [float(psi) for psi in range(0, 180, 5)]
OTHERS = 2  # rows of each check beside its worst one, where some are drawn
SHARE = 0.25  # of the samples that points may take


@dataclass(slots=True, eq=False)
class Asked:
    """A row of the table with the stresses to count for it.

    Attributes
    ----------
    row : as it is in the table
    signals : stresses of which one decides, or of an interaction both parts
    directions : of each signal [deg]; empty where none are searched
    """

    row: Mapping[str, Any]
    signals: list[RecountPoint]
    directions: list[float] = field(default_factory=list)


def check_table(
    frame: pd.DataFrame,
    inputs: RecountInputs,
    coordinates: RecountCoordinates,
    record: Mapping[str, Any],
    body: Layout,
    station_of: StationOf,
    sampling: Sequence[tuple[float, int]],
    *,
    sample: int | None,
    seed: int,
    most: int,
) -> list[ColumnCheck]:
    """Checks of the table of checks; ``most`` stresses may be counted."""
    tables = read_tables(inputs, coordinates, record)
    found = consistent(frame, inputs.case["mission"])
    found += missing_rows(frame, _expected_keys(tables, body))
    if not all(check.passed for check in found):
        return found
    others = None if sample is None else min(sample, OTHERS)
    chosen = chosen_rows(frame, sample=others, seed=seed)
    rows, asked, left = [], [], max(most, 1)
    for check, places in chosen.items():
        for number, place in enumerate(places):
            row = frame.loc[place].to_dict()
            if check == "endurance":
                rows += endurance_rows(row, tables, station_of)
                continue
            one = _asked(row, tables, station_of)
            if one is None or (number > 0 and len(one.signals) > left):
                continue
            left -= len(one.signals)
            asked.append(one)
    signals = [one for of in asked for one in of.signals]
    counted = missions(inputs, coordinates, signals, sampling, mean_stress_of(inputs))
    first = 0
    for of in asked:
        rows += _counted_rows(of, counted[first : first + len(of.signals)], inputs)
        first += len(of.signals)
    straight = all(one.curve.is_straight and not mean_stress_of(inputs).counts for one in signals)
    steps = {} if straight else {"utilisation_stress": LOAD_FACTOR_STEP, "value": LOAD_FACTOR_STEP}
    return [*found, *merged(compare("checks", rows, steps))] if rows else found


def _expected_keys(tables: Tables, body: Layout) -> dict[str, list[tuple[Any, ...]]]:
    """Keys of the rows that throats and stress points have, by check."""
    keys: dict[str, list[tuple[Any, ...]]] = {}
    for number, weld in enumerate(body.welds):
        if weld in tables.throats:
            at, sides = np.flatnonzero(body.weld == number), SIDES[tables.throats[weld]["sides"]]
            own = [(weld, int(body.part[i]), int(body.order[i]), side) for side in sides for i in at]
            for check in ("throat_perp", "throat_par"):
                keys.setdefault(check, []).extend(own)
    for point, given in tables.points.items():
        for surface in tables.tensors(point):
            for component in _components(given):
                keys.setdefault(CHECK_OF_KIND[str(given["kind"])], []).append((point, component, surface))
    return keys


def _components(point: Mapping[str, Any]) -> list[str]:
    """Components that are counted at a stress point."""
    kind = point["kind"]
    if kind in ("parent", "haz"):
        found = ["planes"]
    else:
        both = kind != "hot_spot_b" and (point["planes"] or "planes_60") == "planes_60"
        found = ["normal", "planes_60"] if both else ["normal"]
    return found + ["shear"] * bool(point["curve_shear"])


def _asked(row: Mapping[str, Any], tables: Tables, station_of: StationOf) -> Asked | None:
    """What a row asks to be counted; None of rows without a verdict, and of those that follow from other tables."""
    check = row["check"]
    if check == "toe_multiaxial" or pd.isna(row["fulfilled"]):
        return None
    if check == "interaction":
        return _of_interaction(row, tables, station_of)
    if check.startswith("throat"):
        return _of_throat(row, tables, station_of(row["weld"], int(row["part"]), int(row["order"])))
    return _of_point(row, tables)


def _of_throat(row: Mapping[str, Any], tables: Tables, station: Station) -> Asked:
    throat = tables.throats[row["weld"]]
    t = float(station.solved.line.thickness[station.at])
    stress = throat_stress(throat, station.solved.treated[station.at], t, row["side"])
    a = float(throat["throat_mm"])
    largest = station.largest * (t / a) * max(1.0, t / a) * 4.0  # of what the stresses in the throat are made of
    if row["check"] == "throat_par":
        return Asked(row, [signal(stress["tau_par"], largest, tables.curve(throat["curve_shear"]), a)])
    if row["check"] == "throat_root":
        curve = tables.curve(throat["curve_root"])
        bends = [sign * stress["bending"] for sign in (1.0, -1.0)]
        return Asked(row, [signal(stress["sigma_perp"], largest, curve, a, bending) for bending in bends])
    curve, turns = tables.curve(throat["curve"]), np.deg2rad(HALF_CIRCLE)
    parts = [np.cos(psi) * stress["sigma_perp"] + np.sin(psi) * stress["tau_perp"] for psi in turns]
    return Asked(row, [signal(one, largest, curve, a) for one in parts], HALF_CIRCLE)


def _of_point(row: Mapping[str, Any], tables: Tables) -> Asked:
    own, component = tables.points[row["point"]], row["component"]
    tensor, thickness = tables.tensors(row["point"])[row["surface"]], float(own["thickness_mm"])
    largest = 2.0 * np.abs(tensor).sum(axis=0)
    shear = component == "shear"
    curve = tables.curve(own["curve_shear"] if shear else own["curve"])
    around = NEAR_TOE if component == "planes_60" else ALL_ROUND if own["kind"] in ("parent", "haz") else [0.0]
    of_plane = shear_on_plane if shear else on_plane
    return Asked(row, [signal(of_plane(tensor, phi), largest, curve, thickness) for phi in around], around)


def _of_interaction(row: Mapping[str, Any], tables: Tables, station_of: StationOf) -> Asked | None:
    station = station_of(row["weld"], int(row["part"]), int(row["order"]))
    rules = [one for one in tables.inputs.case["checks"]["interaction"] if one["rule"] == row["component"]]
    rules = [one for one in rules if not one.get("welds") or row["weld"] in one["welds"]]
    entry = tables.inputs.register.welds[row["weld"]]
    limits = [float(one.get("damage_limit", 1.0)) for one in rules]
    if not limits or row["component"] == "dnv":
        return None
    limit = min(limits, key=lambda one: abs(one - row["damage_limit"]))
    side = 1.0 if row["surface"] == "top" else -1.0
    membrane, bending, in_plane, twist, _ = station.solved.treated[station.at].T
    names = entry.curve or tables.inputs.case["curve"]["name"], entry.curve_shear
    own = [tables.curve(name) for name in names]
    own = [replace(one, allowed=replace(one.allowed, own_limit=limit, on_limit=1.0)) for one in own]
    t, long = float(station.solved.line.thickness[station.at]), station.weld.attachment
    return Asked(
        row,
        [
            signal(membrane, station.largest, own[0], t, side * bending, long),
            signal(in_plane, station.largest, own[1], t, side * twist, long),
        ],
    )


def _counted_rows(of: Asked, counted: Sequence[tuple[Values, Bounds]], inputs: RecountInputs) -> Iterator[Row]:
    """Rows as they should be beside one of the table."""
    target = inputs.case["mission"]["target_km"]
    if of.row["check"] == "interaction":
        yield from _interaction_rows(of, counted, inputs)
        return
    damages = np.array([values["damage_per_km"] for values, _ in counted])
    ranges = np.array([values["max_range_MPa"] for values, _ in counted])
    severity = damages if damages.max() > 0.0 else ranges
    best = int((severity >= (1.0 - 1e-9) * severity.max()).argmax())
    expected: Values = {}
    if of.directions:
        stored = [i for i, angle in enumerate(of.directions) if angle == of.row["direction_deg"]]
        if stored and severity[stored[0]] >= (1.0 - TOLERANCE) * severity.max():
            best = stored[0]
        expected["direction_deg"] = of.directions[best]
    elif len(of.signals) == 2:
        expected["surface"] = "root" if best == 0 else "face"
    values, bounds = counted[best]
    limit = of.signals[best].curve.limit(inputs.case["mission"])
    factor = values["load_factor"]
    expected |= {
        "range_max_MPa": values["max_range_MPa"],
        "damage_per_km": values["damage_per_km"],
        "life_km": values["life_km"],
        "damage_sum": values["damage_per_km"] * target,
        "damage_limit": limit,
        "utilisation_damage": values["utilisation"],
        "utilisation_stress": 0.0 if np.isinf(factor) else 1.0 / factor,
        "fulfilled": values["fulfilled"],
        "governing_event": values["governing_event"],
        "limit_value": 1.0,
    }
    own = bounds | {
        "range_max_MPa": bounds["max_range_MPa"],
        "damage_sum": bounds["damage_per_km"] * target,
        "utilisation_damage": bounds["utilisation"],
        "utilisation_stress": bounds["load_factor"],
    }
    yield Row(where(of.row), of.row, expected, {"direction_deg": 180.0}, bounds=own)


def _interaction_rows(of: Asked, counted: Sequence[tuple[Values, Bounds]], inputs: RecountInputs) -> Iterator[Row]:
    """An interaction as it should be; where a curve has knees its stress utilisation is an upper bound."""
    target, (normal, shear) = inputs.case["mission"]["target_km"], [values for values, _ in counted]
    limit = of.signals[0].curve.limit(inputs.case["mission"])
    u = np.array([0.0 if np.isinf(one["load_factor"]) else 1.0 / one["load_factor"] for one in (normal, shear)])
    sums = [one["damage_per_km"] * target for one in (normal, shear)]
    rounding = max(bounds["utilisation"] for _, bounds in counted)
    bounds = dict.fromkeys(("value", "normal_part", "shear_part", "utilisation_stress"), rounding)
    if of.row["component"] == "iiw":
        cv = float(of.row["limit_value"])
        given = [one["cv"] for one in inputs.case["checks"]["interaction"] if one["rule"] == "iiw"]
        value = float(u @ u)
        expected: Values = {
            "value": value,
            "normal_part": float(u[0] ** 2),
            "shear_part": float(u[1] ** 2),
            "limit_value": min((float(one) for one in given), key=lambda one: abs(one - cv)),
            "utilisation_stress": float(np.sqrt(value / cv)),
            "fulfilled": bool(value <= cv),
        }
        yield Row(where(of.row), of.row, expected | {"damage_limit": limit}, {}, bounds=bounds)
        return
    value = sums[0] + sums[1]
    expected = {
        "damage_per_km": value / target,
        "damage_sum": value,
        "value": value,
        "normal_part": sums[0],
        "shear_part": sums[1],
        "damage_limit": limit,
        "limit_value": limit,
        "utilisation_damage": value / limit,
        "fulfilled": bool(value <= limit),
    }
    slopes = [one.curve.slopes[0] for one in of.signals]
    is_exact = all(one.curve.is_straight for one in of.signals)
    joint = {"utilisation_stress": _joint(u, slopes) if is_exact else float(u.max())}
    yield Row(where(of.row), of.row, expected | (joint if is_exact else {}), {}, bounds=bounds)
    if not is_exact:
        yield Row(where(of.row), of.row, joint, {}, is_bound=True, bounds=bounds)


def _joint(u: Floats, slopes: Sequence[float]) -> float:
    """1 / the factor on all stresses up to which two damage sums, each of one slope, add up to their limit."""
    if not u.any():
        return 0.0
    low, high = float(u.max()), float(u.sum() * 2.0)
    for _ in range(80):
        middle = (low + high) / 2.0
        too_small = sum((one / middle) ** k for one, k in zip(u, slopes, strict=True)) > 1.0
        low, high = (middle, high) if too_small else (low, middle)
    return (low + high) / 2.0
