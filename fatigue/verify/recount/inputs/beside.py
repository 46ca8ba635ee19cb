"""Tables of what is checked beside the toe, read anew: throats, stress points, static load cases, endurance lines."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.verify.recount.anew.beside.endurance import CaseStates, HaighLine, alternating
from fatigue.verify.recount.inputs.case import RecountInputs, column, texts
from fatigue.verify.recount.inputs.coordinates import RecountCoordinates
from fatigue.verify.recount.inputs.tables import read_frame

Floats = NDArray[np.float64]

STRESSES = ("sx_MPa", "sy_MPa", "txy_MPa")


@dataclass(frozen=True, slots=True, eq=False)
class CaseRow:
    """One static load case: its kind, the amounts (c,) of the coordinates or, at a point, the stress (3,) there."""

    case: str
    kind: str
    group: str
    point: str
    amounts: Floats


def throat_rows(inputs: RecountInputs) -> dict[str, dict[str, Any]]:
    """Rows of the table of throats by the name of the weld; none where the case has no such table."""
    frame = _frame(inputs, "body", "weld_throats")
    return {} if frame is None else {str(row["weld"]).strip(): _filled(row) for row in frame.to_dict("records")}


def _filled(row: Mapping[Any, Any]) -> dict[str, Any]:
    """A row with texts trimmed and what may be left out filled in."""
    filled = {str(name): value.strip() if isinstance(value, str) else value for name, value in row.items()}
    for name, default in (("penetration_mm", 0.0), ("lever", ""), ("curve_root", "")):
        if name not in filled or pd.isna(filled[name]):
            filled[name] = default
    return filled


def point_frame(inputs: RecountInputs) -> dict[str, dict[str, Any]]:
    """Rows of the table of stress points by the name of the point."""
    frame = _frame(inputs, "body", "stress_points")
    if frame is None:
        return {}
    columns = {name: texts(frame, name) for name in ("point", "kind", "weld", "curve", "curve_shear", "planes")}
    return {
        point: {name: values[i] for name, values in columns.items()} | {"thickness_mm": float(thickness)}
        for i, (point, thickness) in enumerate(zip(columns["point"], frame["thickness_mm"], strict=True))
    }


def stress_frame(inputs: RecountInputs) -> pd.DataFrame:
    """The table of stresses at points per unit coordinate, names trimmed."""
    frame = _frame(inputs, "body", "modal_stresses")
    assert frame is not None
    return frame.assign(point=texts(frame, "point"))


def case_rows(inputs: RecountInputs, coordinates: RecountCoordinates) -> list[CaseRow]:
    """Static load cases, each times its factor."""
    frame = _frame(inputs, "checks", "static_cases")
    if frame is None:
        return []
    names = [f"q_{mode}" for mode in coordinates.mode.tolist()] + [f"u_{name}" for name in coordinates.unit_loads]
    if "point" in frame:
        names = list(STRESSES)
    frame = frame.rename(columns={name: _plain(name) for name in frame.columns})
    values = np.stack([column(frame, name, 0.0) for name in names], axis=1) * column(frame, "factor", 1.0)[:, None]
    keys = zip(*(texts(frame, name) for name in ("case", "kind", "group", "point")), strict=True)
    return [
        CaseRow(case, kind, group, point, row) for (case, kind, group, point), row in zip(keys, values, strict=True)
    ]


def case_states(rows: list[CaseRow], group: str, point: str, stress: Floats | None) -> CaseStates | None:
    """States of a group at a point with the stress (3, c) per unit coordinate; None where it has nothing there."""
    own = [row for row in rows if row.group == group and row.point in ("", point)]
    if not own or (stress is None and not own[0].point):
        return None
    at = {row.case: row.amounts if row.point else np.asarray(stress) @ row.amounts for row in own}
    of_kind = {kind: [at[row.case] for row in own if row.kind == kind] for kind in ("static", "alternating", "state")}
    if of_kind["state"]:
        return CaseStates(np.array(of_kind["state"]))
    return alternating(np.sum([np.zeros(3), *of_kind["static"]], axis=0), np.array(of_kind["alternating"]))


def haigh_lines(inputs: RecountInputs) -> dict[str, HaighLine]:
    """Endurance lines by name."""
    frame = _frame(inputs, "checks", "endurance_lines")
    if frame is None:
        return {}
    frame = frame.assign(line=texts(frame, "line"))
    return {
        str(name): HaighLine.through(column(rows, "R"), column(rows, "stress_max_MPa"))
        for name, rows in frame.groupby("line")
    }


def _plain(name: str) -> str:
    """Name of a column of amounts as modes are written: q_007 is q_7."""
    found = re.fullmatch(r"q_(-?\d+)", name)
    return name if found is None else f"q_{int(found[1])}"


def _frame(inputs: RecountInputs, table: str, key: str) -> pd.DataFrame | None:
    file = inputs.case.get(table, {}).get(key)
    return None if file is None else read_frame(inputs.folder / file)
