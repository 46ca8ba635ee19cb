"""The page of a point: one HTML file that needs nothing but itself, with the figures of the report."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from fatigue.point.page.checked import checks_of
from fatigue.point.page.gathered import Gathered, listed
from fatigue.point.page.notes import facts_of_band, notes_of
from fatigue.point.page.tables import cycle_table, domains_table, leading_events, number_table, verdict_cell
from fatigue.report import figures, wording
from fatigue.report.of_record import mode_names, target_of, weights_of
from fatigue.report.page_text import page_text
from fatigue.report.sections import weld_tables
from fatigue.report.sections.beside.checks import weld_checks
from fatigue.report.sections.beside.life_band import band_sentence
from fatigue.report.sections.beside.shear import shear_facts
from fatigue.report.sections.curves import curve_words, figure_mark
from fatigue.report.sections.embed import Figures, Shown
from fatigue.report.sections.formation.words import of_one_weld
from fatigue.report.sections.method import assumptions
from fatigue.report.sections.point.figures import (
    cycle_figures,
    history_figure,
    shear_figure,
    spectrum_figure,
    variance_figure,
    why_figures,
)
from fatigue.report.sections.why import exponents
from fatigue.report.variants import assumptions_of, variants
from fatigue.results.provenance import curves_of_status

ROOM = "fatigue.point.page"
EVENTS_LISTED = 20
ORDINALS = ("second", "third", "fourth")  # cycles beside the most damaging one


@dataclass(frozen=True, slots=True, eq=False)
class Drawn:
    """The figures of a point by what they tell; a group is empty where there is nothing to draw."""

    along: Shown
    over_time: list[Shown]
    ranges: list[Shown]
    damage: list[Shown]
    domains: list[Shown]
    spectrum: list[Shown]


def point_page(found: Gathered) -> str:
    """Return the page of a point as text."""
    figs = Figures()
    context = {**facts_of(found), "drawn": drawn(found, figs), **_tables(found)}
    return page_text(ROOM, "point.html", context, figs)


def facts_of(found: Gathered) -> dict[str, Any]:
    """What page and picture say in words."""
    record, row, weld = found.record, found.row, found.weld
    curve = curve_words(weld["curve"], record)
    return {
        "title": f"{wording.short(found.station.weld, 80)}, node {found.station.node}, {found.surface}",
        "case_title": record["title"],
        "result": record.get("result", ""),
        "weld": weld.to_dict(),
        "row": row.to_dict(),
        "place": _place(found),
        "is_bound": found.is_screened,
        "verdict": verdict_cell(found),
        "target_km": target_of(record),
        "notes": notes_of(found),
        "facts": [*weld_tables.facts(row, weld, curve), *facts_of_band(found), *shear_facts(row)],
        "band": "" if row["life_km"] > wording.LONGEST else band_sentence(found.band),
        "governing": wording.NOT_AVAILABLE if pd.isna(row["governing_event"]) else str(row["governing_event"]),
        "undamaged": row["damage_per_km"] == 0.0,
    }


def _place(found: Gathered) -> str:
    at = found.station
    part = f"part {at.part}, " if found.weld["parts"] > 1 else ""
    arc = wording.number(found.stored["arc_length_mm"])
    return f"Node {at.node}, {found.surface} face; {part}order {at.order}, {arc} mm along the line"


def _tables(found: Gathered) -> dict[str, Any]:
    """What only the page has: its tables, and what is said of levers and trust."""
    record, why, events = found.record, found.why, leading_events(found, EVENTS_LISTED)
    used = assumptions_of(record, found.weld["curve"])
    passes_per_km = weights_of(record)
    of_cycles = variants(found.row, found.cycles, passes_per_km, used)
    life, km_per_year = float(found.row["life_km"]), float(record["mission"]["km_per_year"])
    return {
        "cycles": cycle_table(found),
        "cycle_rows": found.cycle_rows,
        "events_left_out": max(0, len(found.damage) - EVENTS_LISTED),
        "events": weld_tables.event_table("events", found.damage, passes_per_km, EVENTS_LISTED),
        "levers": None if why.levers.empty else weld_tables.lever_table("levers", why.levers),
        "unit_loads": bool(record.get("unit_loads")),
        "exponents": exponents(why),
        "formation": "" if why.formation is None else of_one_weld(why.formation),
        "domains": domains_table(found, events),
        "reasons": [reason for reason in why.reasons() if reason[0] in events],
        "variants": weld_tables.variant_table("variants", of_cycles, life, km_per_year),
        "beside": weld_checks("checks-beside", found.beside, found.station.weld),
        "numbers": number_table(found),
        "assumptions": assumptions(record),
        "checks": checks_of(found),
        "diagnosed": found.diagnosis is not None and len(found.diagnosis.attribution) > 0,
    }


def drawn(found: Gathered, figs: Figures) -> Drawn:
    """The figures of a point, numbered in the order of the page."""
    record, name = found.record, f"Node {found.station.node}, {found.surface} face"
    unverified = [found.station.weld] if found.weld["curve"] in curves_of_status(record, "unverified") else []
    figs = figs.under("", figure_mark(unverified, 1))
    used = assumptions_of(record, found.weld["curve"])
    damaged = found.row["damage_per_km"] > 0.0
    return Drawn(
        along=_along(found, figs),
        over_time=[*history_figure(record, found.detail, found.event, figs), *_close_by(found, figs)],
        ranges=cycle_figures(record, name, found.cycles, used, figs),
        damage=why_figures(record, found.why, found.event, figs)
        if damaged
        else variance_figure(record, found.detail, found.event, "this point", figs),
        domains=[*_domains(found, figs), *shear_figure(record, found.detail, found.event, figs)],
        spectrum=spectrum_figure(record, found.detail, found.event, figs),
    )


def _along(found: Gathered, figs: Figures) -> Shown:
    """Life, load factor and stress along the weld with the point marked."""
    at = (found.station.part, found.station.order, found.surface)
    event, stress = wording.in_figure(found.event), found.detail.deviation or None
    line = figures.along_weld(_line(found), target_of(found.record), stress, event, marked=at)
    return figs.add("along", line, f"{wording.short(found.station.weld)}: where the point lies on its weld", wide=True)


def _line(found: Gathered) -> pd.DataFrame:
    """Points of the weld as in the result, this one as counted now."""
    here = (found.line[["part", "order", "surface"]] == list(found.key[1:])).all(axis=1)
    numbers = ["life_km", "load_factor", "max_range_MPa", "utilisation", "fulfilled"]
    line = found.line.astype({"screened": object})
    line.loc[here, numbers] = found.row[numbers].to_numpy()
    line.loc[here, "screened"] = ""
    return line


def _close_by(found: Gathered, figs: Figures) -> list[Shown]:
    """Stress around the next cycles, the most damaging one being in the figure of the history."""
    others = found.detail.excerpts[1:]
    if not others:
        return []
    names, _ = mode_names(found.record)
    own = listed(found.cycles[found.cycles["event"] == found.event])
    worst = np.argsort(-(own["damage"] / own["count"]).to_numpy(), kind="stable")
    ranges = own["range_MPa"].to_numpy()[worst[1 : len(others) + 1]]
    titles = [f"{which}: {wording.number(size)} MPa" for which, size in zip(ORDINALS, ranges, strict=False)]
    caption = f"The next cycles of event {wording.short(found.event)}, by their damage"
    return [figs.add("close-by", figures.cycles_close_by(others, titles, names), caption, wide=True, of_curve=False)]


def _domains(found: Gathered, figs: Figures) -> list[Shown]:
    """Damage by method, and the ranges behind it in the event that is shown."""
    shown = []
    if found.damage["damage_same_ratio_per_pass"].gt(0.0).any():
        fig = figures.damage_by_method(found.damage, weights_of(found.record))
        shown.append(figs.add("methods", fig, "Damage of each event, counted and estimated from its spectrum"))
    own = found.cycles[(found.cycles["event"] == found.event) & (found.cycles["count"] > 0.0)]
    if found.spectral is not None and len(own) and own["range_MPa"].max() > 0.0:
        fig = figures.ranges_by_method(own, *found.spectral)
        caption = f"Ranges in one pass of {wording.short(found.event)}: counted, and as its spectrum has it expected"
        shown.append(figs.add("domain-ranges", fig, caption, of_curve=False))
    return shown
