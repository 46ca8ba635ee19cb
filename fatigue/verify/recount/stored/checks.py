"""The table of checks beside the toe: what follows in all of its rows, and which of them are counted again."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.results import TABLES, read_table
from fatigue.verify.recount.inputs.case import RecountInputs
from fatigue.verify.recount.stored.compare import TOLERANCE, ColumnCheck

Floats = NDArray[np.float64]

ALL_ROWS = "checks, all rows"
COUNTED = ("throat_perp", "throat_par", "throat_root", "hot_spot", "nominal", "parent")
WITHOUT_SUM = ("interaction", "endurance")  # checks whose verdict is not that of a damage sum
DECIDING = ("range", "length", "mlp", "asme")


def has_checks(inputs: RecountInputs) -> bool:
    """Whether a case asks for anything that goes into the table of checks."""
    body, checks = inputs.case["body"], inputs.case.get("checks", {})
    named = inputs.case.get("multiaxial", {}).get("method", "report") in DECIDING
    asked = body.get("weld_throats"), body.get("stress_points"), checks.get("interaction"), checks.get("endurance")
    return named or any(asked)


def check_frame(folder: Path) -> pd.DataFrame:
    """The whole table, missing texts as empty ones.

    Raises
    ------
    DataError : the folder holds no such table, or the file is damaged
    """
    frame = read_table(folder, "checks", [column.name for column in TABLES["checks"]]).to_pandas()
    for column in TABLES["checks"]:
        if column.type == "text":
            frame[column.name] = frame[column.name].astype(object).where(frame[column.name].notna(), "")
    return frame


def where(row: Mapping[str, Any]) -> str:
    """Place of a row in words."""
    at = f"weld {row['weld']}, part {row['part']:g}, order {row['order']:g}" if row["part"] == row["part"] else ""
    at = at or (f"point {row['point']}" if row["point"] else f"weld {row['weld']}")
    return ", ".join([at, row["check"], *(row[name] for name in ("side", "surface", "component") if row[name])])


def chosen_rows(frame: pd.DataFrame, *, sample: int | None, seed: int) -> dict[str, list[int]]:
    """Rows of each check in the order in which they are counted again: the worst one, then others as they are drawn.

    ``sample`` is how many others there are at most; None: all.
    """
    rng = np.random.default_rng(seed)
    chosen = {}
    for check, rows in frame.groupby("check", sort=False):
        places = rows.index.to_numpy()
        worst = int(places[rows["utilisation_stress"].fillna(-1.0).to_numpy().argmax()])
        others = rng.permutation(places[places != worst]).tolist()
        chosen[str(check)] = [worst, *(others if sample is None else others[:sample])]
    return chosen


def consistent(frame: pd.DataFrame, mission: Mapping[str, Any]) -> list[ColumnCheck]:
    """Checks of what follows from other columns, in all rows of the table."""
    sums = ~frame["check"].isin(WITHOUT_SUM).to_numpy()
    damage, limit = frame["damage_per_km"].to_numpy(float), frame["damage_limit"].to_numpy(float)
    per_km = sums & ~np.isnan(damage)
    own = frame["check"].to_numpy() == "toe_multiaxial"  # whose limit is that of the curve
    used, value = (frame[name].to_numpy(float) for name in ("utilisation_stress", "value"))
    with np.errstate(divide="ignore", invalid="ignore"):
        life = np.where(damage > 0.0, limit / damage, np.where(damage == 0.0, np.inf, np.nan))
        expected = {
            "life_km": (np.full(len(frame), True), life),
            "damage_sum": (per_km & ~own, damage * mission["target_km"]),
            "utilisation_damage": (np.full(len(frame), True), frame["damage_sum"].to_numpy(float) / limit),
        }
    verdict = np.where(per_km, frame["utilisation_damage"].to_numpy(float), used) <= 1.0
    limits = frame["limit_value"].to_numpy(float)
    verdict = np.where(np.isnan(value), verdict, value <= limits)
    close = np.abs(np.where(np.isnan(value), np.where(per_km, frame["utilisation_damage"], used), value / limits) - 1.0)
    is_known = frame["fulfilled"].notna().to_numpy() & (close > TOLERANCE)
    expected["fulfilled"] = is_known, verdict.astype(float)
    return [_check(frame, name, rows, values) for name, (rows, values) in expected.items()]


def of_weld(
    frame: pd.DataFrame | None, weld: str, load_factor: float, checks: Mapping[str, Any]
) -> dict[str, str | float | int]:
    """Columns of a weld that follow from its rows in the table of checks, and from its load factor."""
    rows = frame[frame["weld"] == weld] if frame is not None else pd.DataFrame(columns=["utilisation_stress"])
    used = rows["utilisation_stress"].to_numpy(float)
    known = ~np.isnan(used)
    at = int(np.where(known, used, -1.0).argmax()) if known.any() else -1
    worst = float(used[at]) if known.any() else np.nan
    at_toe = np.nan if np.isnan(load_factor) else 0.0 if np.isinf(load_factor) else 1.0 / load_factor
    most = float(np.fmax(at_toe, worst))
    limits = checks.get("stress_category", {})
    categories = (limits.get("medium_from", 0.75), "medium"), (limits.get("high_from", 0.9), "high")
    category = "" if np.isnan(most) else next((name for least, name in reversed(categories) if most >= least), "low")
    return {
        "worst_check": str(rows["check"].iloc[at]) if known.any() else "",
        "worst_check_utilisation": worst,
        "checks_not_assessed": int(rows["fulfilled"].isna().sum()) if len(rows) else 0,
        "stress_utilisation": most,
        "stress_category": category,
    }


def _check(frame: pd.DataFrame, name: str, rows: NDArray[np.bool_], expected: Floats) -> ColumnCheck:
    at = np.flatnonzero(rows)
    found = frame[name].to_numpy()[at].astype(float)
    wanted = expected[at]
    with np.errstate(divide="ignore", invalid="ignore"):
        difference = np.abs(found - wanted) / np.abs(wanted)
    same = (found == wanted) | (np.isnan(found) & np.isnan(wanted))
    difference = np.where(same, 0.0, np.where(np.isnan(difference), np.inf, difference))
    worst = int(difference.argmax()) if len(at) else 0
    return ColumnCheck(
        table=ALL_ROWS,
        column=name,
        unit=next(column.unit for column in TABLES["checks"] if column.name == name),
        compared=len(at),
        difference=float(difference[worst]) if len(at) else 0.0,
        tolerance=TOLERANCE,
        where=where(frame.iloc[at[worst]].to_dict()) if len(at) else "",
        found=found[worst].item() if len(at) else None,
        expected=wanted[worst].item() if len(at) else None,
    )


def missing_rows(frame: pd.DataFrame, expected: Mapping[str, Sequence[tuple[Any, ...]]]) -> list[ColumnCheck]:
    """Checks of which rows some checks have: none dropped, none twice, none from elsewhere; keys by check."""
    found = []
    for check, keys in expected.items():
        rows = frame[frame["check"] == check]
        names = ["weld", "part", "order", "side"] if check.startswith("throat") else ["point", "component", "surface"]
        there = [tuple(row) for row in rows[names].itertuples(index=False, name=None)]
        extra = [key for key in there if key not in set(keys)] + [key for key in set(there) if there.count(key) > 1]
        astray = extra + [key for key in keys if key not in set(there)]
        found.append(
            ColumnCheck(
                table="checks",
                column=", ".join(["check", *names]),
                unit="rows",
                compared=len(keys),
                difference=float(len(astray)),
                tolerance=0.5,  # rows
                where=f"{check}: first {astray[0]}" if astray else "",
                found=len(there),
                expected=len(keys),
            )
        )
    return found
