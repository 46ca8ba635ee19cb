"""The first sheet of the workbook: the verdict, what it rests on, and what the other sheets hold."""

import tomllib
from collections.abc import Iterator, Mapping
from typing import Any

import pandas as pd

from fatigue.report.wording import life_km, life_years, listed, number
from fatigue.results import assessed

_SHOWN = ("document", "revision", "date", "author", "checker", "approver", "company", "vehicle")  # of [report]


def write_cover(  # type: ignore[no-untyped-def]
    sheet, record: Mapping[str, Any], title: str, welds: pd.DataFrame, about: Mapping[str, str], formats
) -> None:
    """Write the cover to a worksheet of xlsxwriter; ``welds`` is the register, ``about`` what each sheet holds."""
    rated = assessed(welds)
    fulfilled = bool(rated["fulfilled"].all())
    sheet.set_column(0, 0, 30)
    sheet.set_column(1, 1, 100)
    sheet.write_string(0, 0, title, formats["title"])
    said = "✓ Target fulfilled" if fulfilled else "✕ Target not fulfilled"
    sheet.write_string(1, 0, said, formats["met" if fulfilled else "verdict"])
    row = 3
    for part in (_verdict(record, rated), _identity(record), _rests_on(record), about.items()):
        for name, words in part:
            sheet.write_string(row, 0, name, formats["label"])
            sheet.write_string(row, 1, words, formats["wrapped"])
            row += 1
        row += 1
    sheet.write_string(row, 0, "above 1", formats["missed"])
    sheet.write_string(row, 1, "utilisation of a target that is missed", formats["wrapped"])
    sheet.write_string(row + 1, 0, "from 0.75", formats["near"])
    sheet.write_string(row + 1, 1, "utilisation near the limit", formats["wrapped"])
    sheet.hide_gridlines(2)


def _verdict(record: Mapping[str, Any], welds: pd.DataFrame) -> Iterator[tuple[str, str]]:
    """Target, how many welds miss it, and the worst point."""
    mission, worst = record["mission"], welds.iloc[0]
    missed, target = int((~welds["fulfilled"].astype(bool)).sum()), mission["target_km"]
    yield "target", f"{life_km(target)}, {life_years(target / mission['km_per_year'])} of service"
    yield "welds that miss it", f"{missed} of {len(welds)}"
    yield "shortest life", f"{life_km(worst['life_km'])}, {life_years(worst['life_years'])}"
    yield (
        "utilisation",
        f"{number(worst['utilisation'])} of the damage, {number(1.0 / worst['load_factor'])} of the load",
    )
    place = f"node {worst['worst_node']:.0f}, {worst['worst_surface']} face"
    yield "worst point", f"{worst['weld']}, {place}, {number(worst['worst_arc_length_mm'])} mm along the line"
    if not pd.isna(worst["governing_event"]):
        yield "governing event", str(worst["governing_event"])


def _identity(record: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Who answers for the report: as it was issued last, else as the case said."""
    issued = record.get("identity") or [{"report": tomllib.loads(record["case_text"]).get("report", {})}]
    entries = issued[-1]["report"]
    if not entries:
        yield "identity", "DRAFT, not identified"
    for key in _SHOWN:
        if key in entries:
            yield key, str(entries[key])


def _rests_on(record: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Curves with the state of their numbers, warnings, program and the hash that every table carries."""
    for name, curve in record["curves"].items():
        words = [curve["used"]["survival"], str(curve.get("source") or ""), f"status {curve.get('status', '')}"]
        yield f"curve {name}", ", ".join(filter(None, words))
    warnings: dict[str, int] = {}
    for warning in record["warnings"]:
        warnings[warning["code"]] = warnings.get(warning["code"], 0) + int(warning.get("count", 1))
    counted = [f"{code.replace('_', ' ')} ({count})" for code, count in warnings.items()]
    yield "warnings", f"{listed(counted)}; see the report" if counted else "none"
    yield "program", f"fatigue {record['software']['fatigue']}"
    if record.get("result"):
        yield "hash of the result", str(record["result"])
