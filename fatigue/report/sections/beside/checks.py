"""The sections about checks beside the normal stress at the toe: of a weld, of stress points, of endurance."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from fatigue.report.checks import ShownChecks
from fatigue.report.result import ShownResult
from fatigue.report.sections.cells import Cell, Heading, PageTable, life, linked, num, text
from fatigue.report.wording import listed, number, whole

CHECKS: dict[str, str] = {
    "toe_multiaxial": "toe, with shear",
    "throat_perp": "throat, across",
    "throat_par": "throat, along",
    "throat_root": "root",
    "hot_spot": "hot spot",
    "nominal": "nominal stress",
    "parent": "parent metal",
    "interaction": "interaction",
    "endurance": "endurance",
}
_HEADINGS = (
    Heading("check", numeric=False),
    Heading("verdict", numeric=False),
    Heading("utilisation, stress", "-"),
    Heading("damage / limit", "-"),
    Heading("life", "km"),
    Heading("largest range", "MPa"),
    Heading("where", numeric=False),
    Heading("stress", numeric=False),
    Heading("curve", numeric=False),
    Heading("note", numeric=False),
)
WELD = Heading("weld", numeric=False)


def weld_checks(id_: str, checks: ShownChecks, weld: str) -> PageTable | None:
    """The checks of one weld, the one that uses up most first; None where there are none."""
    rows = checks.of_weld(weld) if checks else pd.DataFrame()
    return PageTable(id_, _HEADINGS, tuple(map(_cells, rows.to_dict("records")))) if len(rows) else None


def beside(result: ShownResult, checks: ShownChecks, links: Mapping[str, str]) -> dict[str, Any]:
    """What the page says of all checks beside the toe; ``beside`` is None where the case asks for none."""
    if not checks:
        return {"beside": None}
    rows = checks.rows
    missed = rows[rows["missed"] > 0]
    return {
        "beside": {
            "checks": len(rows) + checks.left_out,
            "missed": [_in_words(row) for row in missed.head(10).to_dict("records")],
            "missed_left_out": max(0, len(missed) - 10),
            "not_assessed": int(rows["not_assessed"].sum()),
            "left_out": checks.left_out,
            "decides": listed([CHECKS[name] for name in _counted(result)]),
            "table": _all(rows[rows["check"] != "endurance"], links),
            "endurance": _endurance(result, checks, links),
        }
    }


def _counted(result: ShownResult) -> list[str]:
    """Checks that decide verdict and exit code, by the case of the result."""
    import tomllib  # noqa: PLC0415 - only where there are checks

    return list(tomllib.loads(result.record["case_text"]).get("checks", {}).get("counts", []))


def _in_words(row: Mapping[str, Any]) -> str:
    """A check that is not met, in words."""
    where = row["weld"] or f"point {row['point']}"
    return f"{where}: {CHECKS[row['check']]} ({number(row['utilisation_stress'])} of the stress it allows)"


def _all(rows: pd.DataFrame, links: Mapping[str, str]) -> PageTable | None:
    """All checks but endurance."""
    if rows.empty:
        return None
    cells = tuple((linked(row["weld"], links) if row["weld"] else text(None), *_cells(row)) for row in _records(rows))
    return PageTable("checks", (WELD, *_HEADINGS), cells, "Find a check")


def _records(rows: pd.DataFrame) -> list[dict[str, Any]]:
    return [{str(key): value for key, value in row.items()} for row in rows.to_dict("records")]


def _cells(row: Mapping[str, Any]) -> tuple[Cell, ...]:
    """Cells of a check."""
    status = f" ({row['curve_status']})" if row.get("curve_status") else ""
    return (
        Cell(CHECKS.get(row["check"], row["check"])),
        _verdict(row),
        num(row["utilisation_stress"]),
        num(row["utilisation_damage"]),
        life(row["life_km"]),
        num(row["range_max_MPa"]),
        text(_place(row)),
        text(row["component"]),
        text(f"{row['curve']}{status}" if row["curve"] else None),
        text(_note(row)),
    )


def _place(row: Mapping[str, Any]) -> str:
    """Where the check is worst."""
    order = "" if pd.isna(row["order"]) else f"position {int(row['order'])}"
    point = f"point {row['point']}" if row["point"] else ""
    side = f"weld on {row['side']}" if row["side"] else ""
    surface = "" if pd.isna(row["surface"]) or not row["surface"] else str(row["surface"])
    direction = "" if pd.isna(row["direction_deg"]) else f"{row['direction_deg']:.0f}°"
    return ", ".join(filter(None, (point, order, side, surface, direction)))


def _note(row: Mapping[str, Any]) -> str:
    """What a reader has to know, with how many places the row stands for where some differ from it."""
    places, missed, without = int(row["places"]), int(row["missed"]), int(row["not_assessed"])
    value, note = row.get("value"), row["note"]
    said = [
        "" if value is None or pd.isna(value) else f"{number(value)} of {number(row['limit_value'])} allowed",
        f"{whole(missed)} of {whole(places)} places not met" if missed and places > 1 else "",
        f"{whole(without)} of {whole(places)} places not assessed" if without and places > 1 else "",
        "" if note is None or pd.isna(note) else str(note),
    ]
    return "; ".join(filter(None, said))


def _verdict(row: Mapping[str, Any]) -> Cell:
    """Cell of the verdict: met, missed or not assessed."""
    if row["missed"]:
        return Cell("✕ missed", 0.0, mark="missed")
    if row["fulfilled"] is None or pd.isna(row["fulfilled"]):
        return Cell("not assessed", 0.5, mark="doubt")
    return Cell("✓ met", 1.0, mark="met")


def _endurance(result: ShownResult, checks: ShownChecks, links: Mapping[str, str]) -> PageTable | None:
    """Endurance between static load cases, and beside it the life that the cycles of the mission leave."""
    rows = checks.endurance
    if rows.empty:
        return None
    toes = result.assessed.set_index("weld")[["life_km", "utilisation"]]
    of_points = checks.rows[checks.rows["life_km"].notna() & (checks.rows["point"] != "")]
    shortest = of_points.groupby("point")["life_km"].min()
    cells = []
    for row in _records(rows):
        miner = toes.loc[row["weld"], "life_km"] if row["weld"] in toes.index else shortest.get(row["point"])
        cells.append(
            (
                linked(row["weld"], links) if row["weld"] else text(None),
                _verdict(row),
                num(row["utilisation_stress"]),
                life(miner),
                text(_place(row)),
                text(row["component"]),
                text(row["curve"]),
                num(row["range_max_MPa"]),
                num(row.get("R")),
                num(row.get("amplitude_MPa")),
                num(row.get("allowed_amplitude_MPa")),
                text(row["governing_event"]),
                text(_note(row)),
            )
        )
    headings = (
        WELD,
        Heading("verdict", numeric=False),
        Heading("endurance utilisation", "-"),
        Heading("Miner life", "km"),
        Heading("where", numeric=False),
        Heading("stress", numeric=False),
        Heading("line or curve", numeric=False),
        Heading("range", "MPa"),
        Heading("R"),
        Heading("amplitude", "MPa"),
        Heading("allowed", "MPa"),
        Heading("load cases", numeric=False),
        Heading("note", numeric=False),
    )
    return PageTable("endurance", headings, tuple(cells), "Find a check")
