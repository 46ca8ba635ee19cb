"""Shear in the tables of a result: which points have sums and half cycles of their paths, and what these should be."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.results import read_codes, read_table
from fatigue.verify.recount.anew.mission import RecountEvent
from fatigue.verify.recount.anew.point import OnePass, Values
from fatigue.verify.recount.anew.shear.passes import ShearPass, ShearRules
from fatigue.verify.recount.inputs.case import RecountInputs
from fatigue.verify.recount.layout import Key
from fatigue.verify.recount.stored.compare import Row
from fatigue.verify.recount.stored.rows import NEGLIGIBLE, SMALL, place
from fatigue.verify.recount.stored.tables import Stored

HALF_CYCLES_FROM = 0.1  # of the damage limit, by range: the worst point of a weld has its half cycles from there on
EQUAL = 1.0 - 1e-12  # of the largest sum: only rounding tells these apart
PATH_SUMS = ("utilisation_path_", "path_")
RATIOS = ("path_factor", "path_moment", "bending_ratio", "shear_bending_ratio")
PATH_COLUMNS = ["start_s", "end_s", "range_MPa", "path_factor", "path_moment", "normal_range_MPa", "shear_range_MPa",
                "bending_ratio", "shear_bending_ratio", "equivalent_range_dS", "damage"]  # fmt: skip
PATHS = ("range", "length", "mlp")  # methods that decide by the paths of all points
WITH_HALF_CYCLES = ("fails", "counted")  # status of points that only the paths could settle
DECIDING = ("range", "length", "mlp", "asme")  # methods that may decide about life and verdict


@dataclass(frozen=True, slots=True, eq=False)
class StoredShear:
    """What the tables have of shear.

    Attributes
    ----------
    rules : of the case
    counted : (p,) points with sums of their paths
    half_cycles : points whose half cycles are compared: those that have some, and those that have to
    bound : (p,) bound of the sum by range
    by_method : (p,) sum by the method that decides, NaN where none does
    """

    rules: ShearRules
    counted: NDArray[np.bool_]
    half_cycles: frozenset[int]
    bound: NDArray[np.float64]
    by_method: NDArray[np.float64]


def stored_shear(stored: Stored, inputs: RecountInputs, record: Mapping[str, Any]) -> StoredShear | None:
    """Shear in the tables of a result; None where the case wants none of it, or the result is older than it."""
    asked = inputs.case.get("multiaxial", {})
    method = asked.get("method", "report")
    if method == "off" or "multiaxial" not in record["rules"]:
        return None
    rules = ShearRules(method, asked.get("beta", 3.0), asked.get("alpha"))
    of_method = f"utilisation_{method}" if method == "asme" else f"utilisation_path_{method}"
    names = {"utilisation_path_range", "multiaxial_bound", of_method if method in DECIDING else "multiaxial_bound"}
    table = read_table(stored.folder, "nodes", sorted({*names, "multiaxial_status"}))
    column = {name: stored.nodes.in_order(table[name].to_numpy()).astype(float) for name in names}
    by_range = column["utilisation_path_range"]
    status = stored.nodes.in_order(table["multiaxial_status"].to_numpy())
    decides = np.isin(status, WITH_HALF_CYCLES) | (method in PATHS)
    kept = frozenset(_with_half_cycles(stored, np.where(decides, by_range, np.nan)))
    found = frozenset() if stored.path_cycles is None else frozenset(stored.path_cycles.points().tolist())
    by_method = column[of_method] if method in DECIDING else np.full(len(by_range), np.nan)
    return StoredShear(rules, ~np.isnan(by_range), kept | found, column["multiaxial_bound"], by_method)


def _texts(stored: Stored, column: str) -> NDArray[np.object_]:
    """Texts (p,) of a column of the table of points."""
    codes, names = read_codes(stored.folder, "nodes", column)
    return stored.nodes.in_order(np.array([*names, ""], dtype=object)[codes])


def _with_half_cycles(stored: Stored, by_range: NDArray[np.float64]) -> list[int]:
    """Points that have to have half cycles in the table: the worst one of each weld, from some sum on.

    ``by_range`` (p,) is NaN where the sum of the paths matters to no verdict.
    """
    points = []
    first = 2 * stored.body.first
    for begin, end in zip(first[:-1].tolist(), first[1:].tolist(), strict=True):
        of_weld = np.nan_to_num(by_range[begin:end], nan=-1.0)
        if of_weld.max() >= HALF_CYCLES_FROM:
            points.append(begin + int((of_weld >= EQUAL * of_weld.max()).argmax()))
    return points


def shear_rows(
    key: Key, values: Values, bounds: Mapping[str, float], found: Mapping[str, Any], *, exact_bound: bool, toe: bool
) -> list[Row]:
    """Columns of shear of one point, as they should be beside those in the table.

    The bound may be larger than that of the exact path where this was not traced, and so may the ASME sum of a point
    whose cycles were not counted. Of a point whose path has sums and was not counted again they are believed.
    """
    screened = bool(found["screened"]) and toe
    of_path = found["utilisation_path_range"]
    is_believed = toe and np.isnan(values["utilisation_path_range"]) and not pd.isna(of_path)
    if screened:  # what follows from normal stress that was not counted is not known exactly, or not at all
        known = ["multiaxial_bound", "utilisation_asme"]
        if not pd.isna(found["shear_required"]):
            known.append("shear_required")
        if not (pd.isna(of_path) or is_believed):
            known += [name for name in values if name.startswith(PATH_SUMS)]
        values = {name: values[name] for name in known}
    elif is_believed:
        left = "multiaxial_verdict" if values["multiaxial_verdict"] != "settled_fails" else ""
        values = {name: value for name, value in values.items() if not name.startswith(PATH_SUMS) and name != left}
    is_bound = {"multiaxial_bound": not exact_bound, "utilisation_asme": screened}
    rows = []
    for as_bound in (False, True):
        some = {
            name: value
            for name, value in values.items()
            if as_bound == (toe and is_bound.get(name, False) and not pd.isna(found[name]))
        }
        if some:
            rows.append(Row(place(key), found, some, {"path_moment_largest": 1.0}, as_bound, bounds))
    return rows


def half_cycle_row(key: Key, event: RecountEvent, path: ShearPass, one: OnePass, found: pd.DataFrame) -> Row | None:
    """All half cycles of one event at one point as one row: in each column, sorted, the value that differs most.

    Half cycles that only rounding makes are left out on both sides, ratios of small ones, too. None where the stress is
    nothing but rounding.
    """
    if 2.0 * one.cycle_bounds["delta"] > NEGLIGIBLE * path.range:
        return None
    ours, theirs = path.rows["range_MPa"], found["range_MPa"].to_numpy()
    expected: Values = {}
    stored: Values = {}
    scale = {}
    for name, column in path.rows.items():
        least = path.range * (SMALL if name in RATIOS else NEGLIGIBLE)
        a, b = np.sort(column[ours > least]), np.sort(found[name].to_numpy()[theirs > least])
        if len(a) != len(b):
            a, b = np.array([float(len(a))]), np.array([float(len(b))])
        if len(a):
            worst = int(np.abs(a - b).argmax())
            expected[name], stored[name] = float(a[worst]), float(b[worst])
            scale[name] = 1.0 if name in RATIOS else float(np.abs(a).max())
    bounds = dict.fromkeys(("start_s", "end_s"), one.cycle_bounds["instant"])
    bounds |= dict.fromkeys(("normal_range_MPa", "shear_range_MPa"), 2.0 * one.cycle_bounds["delta"])
    return Row(f"{place(key)}, event '{event.name}'", stored, expected, scale, bounds=bounds)
