"""The S-N curves of a result: what they rest on, what stands between a range and each of them, and who has looked.

A life, a utilisation and a picture that rest on a curve nobody has compared with its source carry the word.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from fatigue.report.result import ShownResult
from fatigue.report.sections.cells import Cell, Heading, PageTable, num, text
from fatigue.report.wording import number
from fatigue.results import read_table
from fatigue.results.provenance import curves_of_status
from fatigue.results.tables import table_path
from fatigue.shown import few

UNVERIFIED, USER = "unverified", "user"
LIVES = ("life", "utilisation", "load factor", "Dirlik life")  # headings of what rests on a curve
WORDS = {UNVERIFIED: "unverified", USER: "values entered by the user"}
FOR = {
    "structural": "structural stress",
    "dS": "equivalent structural stress",
    "hot_spot": "hot-spot stress",
    "nominal": "nominal stress",
    "throat": "throat",
    "parent": "parent metal",
}
ROLES = {"strength": "divides the range", "stress": "multiplies the range", "limit": "multiplies the damage limit"}
BENDING = "bending, BS 7608: ({t:g} mm / t)^{b:g} (1 + 0.18 R_b^1.4) divides the range"
RATIO = {
    "iiw_low": "f(R), IIW, low residual stress, divides the range",
    "iiw_medium": "f(R), IIW, medium residual stress, divides the range",
}


def curve_sections(result: ShownResult) -> dict[str, Any]:
    """What the page says of curves: the table, the factors, and the sentences about what was not verified."""
    record, unverified = result.record, unverified_welds(result)
    used = {*result.assessed["curve"], *_of_checks(result)["curve"].dropna()}
    entered = [name for name in curves_of_status(record, USER) if name in used]
    names = [name for name in curves_of_status(record, UNVERIFIED) if name in used]
    on_top = [f"{event['event']} {number(event['stress_factor'])}" for event in _with_factor(record)]
    return {
        "curves": curve_table(record),
        "factors": factor_table(record),
        "unverified": _unverified(unverified, of_toes(result), len(result.assessed), names) if names else "",
        "entered": f"values entered by the user: {few(entered)}" if entered else "",
        "stress_factors": few(on_top) if on_top else "",
    }


def _unverified(welds: Sequence[str], of_lives: Sequence[str], of: int, names: Sequence[str]) -> str:
    """How many welds rest on unverified curves, and how many of them by checks beside the toe alone."""
    said = f"{len(welds)} of {of} welds rest on unverified curves ({few(names)})"
    if len(of_lives) == len(welds):
        return said
    return f"{said}, {len(of_lives) or 'none'} of them with {'their lives' if len(of_lives) > 1 else 'its life'}"


def unverified_welds(result: ShownResult) -> list[str]:
    """Welds of which any verdict rests on an unverified curve: that of the toe, or of a check beside it."""
    checks = _of_checks(result)
    welds = {*of_toes(result), *checks.loc[checks["curve_status"] == UNVERIFIED, "weld"].dropna()}
    return [weld for weld in result.assessed["weld"] if weld in welds]


def _of_checks(result: ShownResult) -> pd.DataFrame:
    """Weld, curve and status of the curve of every check beside the toe; no rows where there are none."""
    columns = ["weld", "curve", "curve_status"]
    if not table_path(result.folder, "checks").exists():
        return pd.DataFrame({name: np.empty(0, object) for name in columns})
    return read_table(result.folder, "checks", columns).to_pandas()


def of_toes(result: ShownResult) -> list[str]:
    """Welds whose lives rest on an unverified curve."""
    names = curves_of_status(result.record, UNVERIFIED)
    return result.assessed.loc[result.assessed["curve"].isin(names), "weld"].tolist() if names else []


def curve_words(name: str, record: Mapping[str, Any]) -> str:
    """Name of a curve, and what is to be known of its numbers."""
    words = WORDS.get(record["curves"].get(name, {}).get("status", ""), "")
    return f"{name} ({words})" if words else name


def figure_mark(welds: Sequence[str], of: int) -> str:
    """What is added to the caption of a picture of ``of`` welds, of which some rest on unverified curves."""
    if not welds:
        return ""
    return " (unverified curve)" if of == 1 else f" ({len(welds)} of {of} welds: unverified curve)"


def marked(table: PageTable, welds: Collection[str]) -> PageTable:
    """The same table, with the word at every life and utilisation of the welds that rest on unverified curves."""
    headings = [heading.text for heading in table.headings]
    if not welds or "weld" not in headings:
        return table
    name, lives = headings.index("weld"), [i for i, heading in enumerate(headings) if heading in LIVES]
    return replace(table, rows=tuple(_marked(row, lives) if row[name].text in welds else row for row in table.rows))


def all_marked(table: PageTable, headings: Collection[str]) -> PageTable:
    """The same table of one weld that rests on an unverified curve, with the word in some columns."""
    some = [i for i, heading in enumerate(table.headings) if heading.text in headings]
    return replace(table, rows=tuple(_marked(row, some) for row in table.rows))


def _marked(row: tuple[Cell, ...], columns: Sequence[int]) -> tuple[Cell, ...]:
    word = " (unverified)"
    return tuple(
        replace(cell, text=cell.text + word, after=word) if i in columns else cell for i, cell in enumerate(row)
    )


def curve_table(record: Mapping[str, Any]) -> PageTable:
    """Every curve of the result with its source, what it rests on, and what stands between a range and it."""
    rows = []
    for name, curve in record["curves"].items():
        of, used = curve.get("allowances", {}), curve["used"]
        quantity = "shear, " if curve.get("quantity") == "shear" else ""
        rows.append(
            (
                text(name),
                text(quantity + FOR.get(curve["applies"], curve["applies"])),
                text(", ".join(number(k) for k in used["slopes"])),
                text(used["survival"]),
                text(curve["source"]),
                text(curve.get("edition")),
                text(curve.get("clause")),
                text(_status(curve)),
                text(", ".join(filter(None, (curve.get("checked_by"), curve.get("checked_on"))))),
                num(of.get("gamma_Ff", 1.0)),
                num(of.get("gamma_Mf", 1.0)),
                num(used.get("factor_on_range", 1.0)),
                num(used.get("damage_limit", record["mission"]["damage_limit"])),
                text("; ".join(_allowances(curve))),
            )
        )
    headings = (
        Heading("curve", numeric=False),
        Heading("for", numeric=False),
        Heading("slopes", numeric=False),
        Heading("survival", numeric=False),
        Heading("source", numeric=False),
        Heading("edition", numeric=False),
        Heading("clause", numeric=False),
        Heading("status", numeric=False),
        Heading("checked by", numeric=False),
        Heading("γ_Ff", "-"),
        Heading("γ_Mf", "-"),
        Heading("all factors on the range", "-"),
        Heading("damage limit", "-"),
        Heading("allowances", numeric=False),
    )
    return PageTable("curves", headings, tuple(rows))


def factor_table(record: Mapping[str, Any]) -> PageTable | None:
    """Every factor of the table of strength factors with its clause; None without one."""
    rows = [
        (
            text(name),
            text(factor["factor"]),
            text(ROLES[factor["role"]]),
            num(factor["value"]),
            text(factor["clause"]),
            text(factor["edition"]),
            text(factor["note"]),
        )
        for name, curve in record["curves"].items()
        for factor in curve.get("factors", ())
    ]
    if not rows:
        return None
    names = ("curve", "factor", "what it does", "value", "clause", "edition", "note")
    headings = tuple(Heading(name, "-" if name == "value" else "", numeric=name == "value") for name in names)
    return PageTable("strength-factors", headings, tuple(rows))


def allowances_in_words(record: Mapping[str, Any]) -> list[str]:
    """What stands between ranges and each curve that asks for anything, for the assumptions of the first page."""
    found = []
    for name, curve in record["curves"].items():
        words, factor = _allowances(curve), float(curve["used"].get("factor_on_range", 1.0))
        words += [f"factor {number(factor)} on every range"] if factor != 1.0 else []
        if words:
            found.append(f"{name}: {', '.join(words)}")
    return found


def damage_limits(record: Mapping[str, Any]) -> str:
    """The allowed Miner sum, and those of curves that have another."""
    common = float(record["mission"]["damage_limit"])
    limits = {name: float(curve["used"].get("damage_limit", common)) for name, curve in record["curves"].items()}
    others = [f"{number(limit)} on {name}" for name, limit in limits.items() if limit != common]
    return "; ".join([number(common), *others])


def _with_factor(record: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    return [event for event in record["mission"]["events"] if event.get("stress_factor", 1.0) != 1.0]


def _status(curve: Mapping[str, Any]) -> str:
    status = str(curve.get("status", ""))
    return f"{status}: values entered by the user" if status == USER else status


def _allowances(curve: Mapping[str, Any]) -> list[str]:
    of = curve.get("allowances", {})
    words = []
    if curve["thickness_reference_mm"] is not None:
        t = "half the attachment, at most the plate" if of.get("thickness_effective") == "L_half" else "plate"
        reference, exponent = number(curve["thickness_reference_mm"]), number(curve["thickness_exponent"])
        words.append(f"thickness: ({t} / {reference} mm)^{exponent} above the reference")
    if of.get("bending_factor", "none") != "none":
        words.append(BENDING.format(t=of["bending_reference"], b=of["bending_exponent"]))
    if of.get("stress_ratio", "none") != "none":
        words.append(RATIO[of["stress_ratio"]])
    return words
