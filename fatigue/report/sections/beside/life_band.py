"""How sure the lives are: bands of the worst points of the welds, and what the bands say and do not say."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from fatigue import digits
from fatigue.report.result import ShownResult
from fatigue.report.sections.cells import Cell, Heading, PageTable, life, linked, num
from fatigue.report.wording import NOT_AVAILABLE, life_in_band, life_km, share
from fatigue.results.beside.life_band import (
    AT_LEAST,
    LIVES,
    REASONS,
    SHORT_REASONS,
    WHAT_IT_IS_NOT,
    BandOfPoint,
    Bands,
    read_bands,
    worst_of,
)

MOST = 20  # welds with their row; the others are in the table of the result
SURVIVALS = {"life_km_p50": "50 %", "life_km_p90": "90 %", "life_km_p97_7": "97.7 %", "life_km_p99": "99 %"}


def bands_of(result: ShownResult) -> Bands | None:
    """Bands of the worst points of the welds that the page names; None of a result without bands."""
    shown = (np.arange(len(result.assessed)) < MOST) | result.assessed["weld"].isin(result.detailed)
    return read_bands(result.folder, worst_of(result.assessed[shown]))


def life_band_section(result: ShownResult, bands: Bands | None, links: Mapping[str, str]) -> dict[str, Any]:
    """What page one says of bands: ``band`` is False of a result without them."""
    if bands is None:
        return {"band": False}
    welds = result.assessed.head(MOST)
    found = bands.of_points(welds, "worst_")
    reasons = list(dict.fromkeys(one.reason for one in found if one is not None and one.reason))
    lines = any(one is not None and np.isfinite(one.line_survival) for one in found)
    asked = result.record["rules"]["life_band"]
    return {
        "band": True,
        "band_head": band_sentence(found[0]) if found else "",
        "life_bands": _table(welds, found, links, with_lines=lines),
        "band_left_out": max(0, len(result.assessed) - MOST),
        "band_reasons": [(SHORT_REASONS[reason], REASONS[reason]) for reason in reasons],
        "band_without_scatter": any(one is not None and one.has_band and not one.has_lives for one in found),
        "band_miner": _miner_words(asked),
        "band_lines": _line_words(asked) if lines else "",
        "band_is_not": WHAT_IT_IS_NOT,
    }


def band_facts(bands: Bands | None, point: pd.Series) -> list[tuple[str, str]]:
    """Facts about the band of one point; none where it has no row."""
    found = None if bands is None else bands.of(*(point[name] for name in ("weld", "part", "order", "surface")))
    if found is None:
        return []
    facts = [("Life, 90 % band of load", _band_words(found))]
    if found.has_lives:
        lives = ", ".join(f"{percent} {life_km(found.lives_km[name])}" for name, percent in SURVIVALS.items())
        facts.append(("Life that a share reaches", lives))
    if np.isfinite(found.line_survival):
        words = f"{share(found.line_survival)} at the target, half of them {life_km(found.line_life_km)}"
        facts.append(("Survival of the whole line", words))
    return facts


def band_sentence(found: BandOfPoint | None) -> str:
    """Sentence beneath a life; empty where it has no row."""
    if found is None:
        return ""
    if not found.has_band:
        return f"No band of this life: {REASONS[found.reason]}."
    words = [f"90 % band by the scatter of the load: {life_in_band(found.life_km, found.low_km, found.high_km)}"]
    if found.reason == AT_LEAST:
        words.append(f", at least this wide, as {REASONS[AT_LEAST].partition(',')[0]}")
    if found.has_lives:
        of = {name: life_km(found.lives_km[name]) for name in SURVIVALS}
        words.append("; with that of S-N curve and damage sum half ")
        words.append(f"reach {of['life_km_p50']}, 90 % reach {of['life_km_p90']}")
    return f"{''.join(words)}."


def _band_words(found: BandOfPoint) -> str:
    """Band of load of one point, or why there is none."""
    if not found.has_band:
        return f"none: {REASONS[found.reason]}"
    more = f"; {REASONS[AT_LEAST]}" if found.reason == AT_LEAST else ""
    return life_in_band(found.life_km, found.low_km, found.high_km) + more


def _table(
    welds: pd.DataFrame, found: list[BandOfPoint | None], links: Mapping[str, str], *, with_lines: bool
) -> PageTable:
    in_millions = digits.in_millions(end for one in found if one is not None for end in (one.low_km, one.high_km))
    scale = digits.MILLION if in_millions else 1.0
    rows = tuple(
        (linked(str(weld), links), life(assessed), *_cells(one, scale, with_lines=with_lines))
        for weld, assessed, one in zip(welds["weld"], welds["life_km"], found, strict=True)
    )
    headings = (
        Heading("weld", numeric=False),
        Heading("life", "km"),
        Heading("90 % band of load", "million km" if in_millions else "km", numeric=False),
        *(Heading(f"{percent} reach", "km") for percent in SURVIVALS.values()),
        *((Heading("line survives to the target", "-"), Heading("half of all lines", "km")) if with_lines else ()),
    )
    return PageTable("life-bands", headings, rows)


def _cells(found: BandOfPoint | None, scale: float, *, with_lines: bool) -> tuple[Cell, ...]:
    if found is None:
        return (Cell(NOT_AVAILABLE),) * (1 + len(LIVES) + 2 * with_lines)
    said = SHORT_REASONS.get(found.reason, "")
    band = said
    if found.has_band:
        ends = " – ".join(digits.results([found.low_km / scale, found.high_km / scale]))
        band = f"{said} {ends}".strip()
    of_line = (num(found.line_survival), life(found.line_life_km)) if with_lines else ()
    return (Cell(band), *(life(found.lives_km[name]) for name in LIVES), *of_line)


def _miner_words(asked: Mapping[str, Any]) -> str:
    """What is taken of the damage sum at failure."""
    median, sigma = asked["miner_median"], asked["miner_sigma_ln"]
    of = f"at a damage sum of {median:g}" if isinstance(median, float | int) else "at the allowed damage sum"
    scatter = f", scattering by {sigma:g} in its logarithm" if sigma else ", which does not scatter"
    return f"half of all fail {of}{scatter}"


def _line_words(asked: Mapping[str, Any]) -> str:
    length, dependence = asked["reference_length_mm"], asked["dependence"]
    return f"lengths of {length:g} mm, correlated by {dependence:g}"
