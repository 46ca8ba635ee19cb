"""Page one: which welds change their verdict under other assumptions, and which assumptions change none."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from fatigue.report import wording
from fatigue.report.result import ShownResult
from fatigue.report.sections.cells import Cell, Heading, PageTable, linked, num
from fatigue.report.wording import listed, whole
from fatigue.results.beside.sensitivity import Sensitivity, in_words, read_sensitivity
from fatigue.results.dictionary.sensitivity import BOUND, COUNTED, RECOUNT, VARIANTS

MOST_FLIPPING = 20  # welds with their row; the others are in the table of the result

NAMES: dict[str, str] = {
    "shear_path_range": "shear, path range",
    "shear_asme": "shear, ASME factor",
    "raw_end": "raw weld end",
    "asme_thickness": "ASME thickness",
    "survival_3sigma": "mean − 3σ",
    "haibach_1e7": "Haibach at 1e7",
    "no_knee": "no knee",
    "upsample_1": "not upsampled",
    "upsample_auto": "upsampled",
    "damage_limit_0.5": "damage limit 0.5",
}


def sensitivity(result: ShownResult, links: Mapping[str, str]) -> dict[str, Any]:
    """What page one says of other assumptions: ``flips``, ``meanings``, and what changes nothing or is not known.

    ``sensitivity`` is False of a result that has none.
    """
    found = read_sensitivity(result.folder, result.assessed)
    if found is None:
        return {"sensitivity": False}
    welds = found.flipping
    return {
        "sensitivity": True,
        "flips": _table(found, welds[:MOST_FLIPPING], links) if welds else None,
        "flipping": len(welds),
        "flipping_left_out": max(0, len(welds) - MOST_FLIPPING),
        "meanings": [(NAMES[name], VARIANTS[name]) for name in found.variants if name not in found.own],
        "steady": listed([NAMES[name] for name in found.steady]),
        "own": listed([f"{NAMES[name]} ({why})" for name, why in found.own.items()]),
        "undecided": [_undecided(name, rows) for name, rows in found.undecided.items()],
        "has_bounds": bool((found.rows.loc[found.rows["weld"].isin(welds), "basis"].isin([BOUND, COUNTED])).any()),
        "has_recounts": bool((found.rows["basis"] == RECOUNT).any()),
    }


def _table(found: Sensitivity, welds: list[str], links: Mapping[str, str]) -> PageTable:
    """The welds whose verdict changes, with their utilisation as assessed and under every variant that says more."""
    variants = [name for name in found.variants if name not in found.own]
    of_variant = {name: found.under(name).loc[welds] for name in variants}
    rows = tuple(
        (linked(weld, links), _verdict(found.assessed[weld]), *(_cell(of_variant[name].loc[weld]) for name in variants))
        for weld in welds
    )
    headings = (
        Heading("weld", numeric=False),
        Heading("as assessed", numeric=False),
        *(Heading(NAMES[name], numeric=False) for name in variants),
    )
    return PageTable("sensitivity", headings, rows)


def _verdict(utilisation: float) -> Cell:
    """Cell of the utilisation as it was assessed: the verdict in a sign and not in colour alone."""
    is_met, words = utilisation <= 1.0, wording.result(utilisation)
    return Cell(f"{'✓' if is_met else '✕'} {words}", num(utilisation).value, mark="met" if is_met else "")


def _cell(row: "pd.Series[Any]") -> Cell:
    """Cell of a utilisation under a variant; the one that changes the verdict is marked."""
    words = in_words(row["utilisation"], row["basis"], row["fulfilled"], wording.result)
    if not row["flips"]:
        return Cell(words, num(row["utilisation"]).value)
    sign = "✓" if row["fulfilled"] else "✕"
    return Cell(f"{sign} {words}", num(row["utilisation"]).value, mark="used" if row["fulfilled"] else "missed")


def _undecided(variant: str, rows: pd.DataFrame) -> str:
    """How many welds are not decided under a variant, and why."""
    why = " / ".join(dict.fromkeys(filter(None, rows["note"])))
    welds = f"{whole(len(rows))} weld{'s' * (len(rows) != 1)}"
    return f"{NAMES[variant]}: {welds}" + (f" ({why})" if why else "")
