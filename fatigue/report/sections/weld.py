"""One weld on the page: its figures along the line, its worst point in detail, its life under other assumptions."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.life.curves import Survival, damage_law
from fatigue.report import figures, wording
from fatigue.report.checks import ShownChecks
from fatigue.report.result import ShownResult
from fatigue.report.sections import weld_tables
from fatigue.report.sections.beside.checks import weld_checks
from fatigue.report.sections.beside.life_band import band_facts
from fatigue.report.sections.beside.shear import shear_facts
from fatigue.report.sections.cells import PageTable
from fatigue.report.sections.curves import all_marked, curve_words, figure_mark, of_toes
from fatigue.report.sections.details import Detail
from fatigue.report.sections.embed import Figures, Shown
from fatigue.report.sections.formation.words import of_one_weld
from fatigue.report.sections.load_spectra import LoadSpectra, equivalent_table, spectra_figures
from fatigue.report.sections.why import Why, band_shares, exponents, mode_shares
from fatigue.report.variants import Assumptions, assumptions_of, how_often, variants
from fatigue.results.beside.life_band import Bands

SPECTRA_DRAWN, MODES_DRAWN, MODES_MARKED, EVENTS_LISTED = 6, 8, 4, 20


@dataclass(frozen=True, slots=True)
class WeldPage:
    """One weld in detail; what only a diagnosis or load spectra know is empty without one.

    ``bounded`` points of it have a lower bound of life in place of a counted one; ``unverified``: its life rests on a
    curve that nobody has verified.
    """

    id: str
    name: str
    row: Mapping[str, Any]
    unverified: bool
    facts: list[tuple[str, str]]
    checks: PageTable | None
    along: Shown
    point: list[Shown]
    variants: PageTable
    events: PageTable
    events_left_out: int
    formation: str
    levers: PageTable | None
    equivalent: PageTable | None
    reasons: list[tuple[str, str, str]]
    exponents: Mapping[str, float]
    bounded: int


def weld_page(
    result: ShownResult,
    weld: str,
    detail: Detail | None,
    why: Why | None,
    spectra: LoadSpectra | None,
    checks: ShownChecks,
    bands: Bands | None,
    figs: Figures,
    id_: str,
) -> WeldPage:
    """All that is shown of one weld; ``detail`` is None where the records were not found."""
    row = result.assessed.set_index("weld", drop=False).loc[weld]
    point = result.worst(weld)
    cycles = result.cycles(weld)
    used = assumptions_of(result.record, row["curve"])
    event = None if pd.isna(row["governing_event"]) else str(row["governing_event"])
    why = None if why is None else why.of_weld(weld)
    spectra = None if spectra is None else spectra.of_weld(weld)

    unverified = [weld] if weld in of_toes(result) else []
    figs = figs.under(f"{id_}-", figure_mark(unverified, 1))
    points = result.nodes[result.nodes["weld"] == weld]
    stress = detail.deviation if detail is not None and detail.deviation else None
    line = figures.along_weld(points, result.target_km, stress, wording.in_figure(event or ""))
    along = figs.add("along", line, f"{wording.short(weld)}: life, load factor and stress along the weld")
    shown: list[Shown] = []
    if len(cycles) and cycles["range_MPa"].max() > 0.0:
        shown += _cycle_figures(result, weld, cycles, used, figs)
    if detail is not None:
        shown += _record_figures(result, detail, event, figs, modes_too=why is None)
    if detail is not None and detail.path is not None:
        beta = float(result.record["rules"]["multiaxial"]["beta"])
        normal, of_shear = detail.path
        path = figures.shear_path(normal, of_shear, beta, _largest_half_cycle(detail.path, beta))
        caption = f"Path of normal stress and shear in event {wording.short(event or '')}: the model of shear decides"
        shown.append(figs.add("path", path, caption))
    if why is not None and event is not None:
        shown += _why_figures(result, why, event, figs)
    if spectra is not None:
        shown += spectra_figures(spectra, result, figs)
    of_variants = weld_tables.variant_table(
        f"{id_}-variants",
        variants(point, cycles, result.passes_per_km, used),
        float(point["life_km"]),
        float(result.record["mission"]["km_per_year"]),
    )
    return WeldPage(
        id=id_,
        name=weld,
        row=row.to_dict(),
        unverified=bool(unverified),
        facts=[
            *weld_tables.facts(point, row, curve_words(row["curve"], result.record)),
            *band_facts(bands, point),
            *shear_facts(point),
        ],
        checks=weld_checks(f"{id_}-checks", checks, weld),
        along=along,
        point=shown,
        variants=all_marked(of_variants, ("life",)) if unverified else of_variants,
        events=weld_tables.event_table(
            f"{id_}-events", result.damage[result.damage["weld"] == weld], result.passes_per_km, EVENTS_LISTED
        ),
        events_left_out=max(0, len(result.events) - EVENTS_LISTED),
        formation="" if why is None or why.formation is None else of_one_weld(why.formation),
        levers=None if why is None or why.levers.empty else weld_tables.lever_table(f"{id_}-levers", why.levers),
        equivalent=None if spectra is None else equivalent_table(f"{id_}-equivalent", spectra),
        reasons=[] if why is None else why.reasons(),
        exponents={} if why is None else exponents(why),
        bounded=int((points["screened"] != "").sum()),
    )


def _largest_half_cycle(path: NDArray[np.float64], beta: float) -> tuple[int, int]:
    """Samples of the most distant pair of a path (2, t), to 1e-4 of their distance: by their extents in directions."""
    angles = np.radians(np.arange(0.0, 180.0, 1.0))
    along = np.stack([np.cos(angles), np.sqrt(beta) * np.sin(angles)], axis=1) @ path
    widest = int(np.ptp(along, axis=1).argmax())
    first, last = sorted((int(along[widest].argmin()), int(along[widest].argmax())))
    return first, last


def _cycle_figures(
    result: ShownResult, weld: str, cycles: pd.DataFrame, used: Assumptions, figs: Figures
) -> list[Shown]:
    per_km = how_often(cycles, result.passes_per_km)
    laws = {
        level: damage_law(
            used.curve,
            cast(Survival, level) if used.curve.has_scatter else None,
            used.extension,
            used.knee_cycles,
        )
        for level in used.curve.reference_range
    }
    unit = "MPa mm<sup>−0.222</sup>" if used.curve.applies == "dS" else "MPa"
    spectrum = figures.sn_with_spectrum(cycles, per_km * result.target_km, laws, used.survival, unit)
    name = wording.short(weld)
    of_target = f"{name}: S-N curve and the cycles of {wording.km(result.target_km)}"
    return [
        figs.add(
            "matrix",
            figures.rainflow_matrices(cycles, per_km),
            f"{name}: rainflow matrix and damage matrix",
            wide=True,
        ),
        figs.add("exceedance", figures.exceedance(cycles, result.passes_per_km), f"{name}: stress ranges in 1e6 km"),
        figs.add("sn", spectrum, of_target),
    ]


def _record_figures(
    result: ShownResult, detail: Detail, event: str | None, figs: Figures, *, modes_too: bool
) -> list[Shown]:
    """Figures of the records, none where nothing damages; with the modes' shares of the variance if asked."""
    if event is None or detail.envelope is None or detail.variance_share is None:
        return []
    colours = figures.event_colours([e["event"] for e in result.events])
    names, natural = _mode_names(result)
    history = figures.stress_history(detail.envelope, detail.excerpts, names, colours[event])
    close_by = ", and close by at its most damaging cycle" if detail.excerpts else ""
    caption = f"Stress in event {wording.short(event)}{close_by}"
    shown = [figs.add("history", history, caption, wide=True, of_curve=False)]
    leading = np.argsort(-np.abs(detail.variance_share), kind="stable")[:MODES_DRAWN]
    numbers = list(result.coordinates)
    parts = {numbers[k]: float(detail.variance_share[k]) for k in leading}
    if modes_too:
        title = f"share of the stress variance in event {wording.in_figure(event)} [%]"
        bars = figures.shares([names[mode] for mode in parts], np.array(list(parts.values())), title)
        what = "Modes and unit loads" if result.record.get("unit_loads") else "Modes"
        shown.append(figs.add("modes", bars, f"{what} in the stress of the worst point", of_curve=False))
    if detail.spectra:
        drawn = sorted(detail.spectra, key=lambda s: s.event != event)[:SPECTRA_DRAWN]
        marked = {f"mode {m}, {natural[m]:.4g} Hz": (natural[m], part) for m, part in parts.items() if m in natural}
        spectrum = figures.stress_spectrum(drawn, colours, dict(list(marked.items())[:MODES_MARKED]), event)
        caption = "Stress spectrum, the leading normal modes, and where the variance lies"
        shown.append(figs.add("psd", spectrum, caption, of_curve=False))
    return shown


def _why_figures(result: ShownResult, why: Why, event: str, figs: Figures) -> list[Shown]:
    """Figures of the modes, frequency bands and places that make the damage of a weld's worst point."""
    names, natural = _mode_names(result)
    shown = []
    modes = mode_shares(why).head(MODES_DRAWN)
    title = "share of the damage, all events [%]"
    pairs = zip(modes["mode"], modes["unit_load"], strict=True)
    called = [f"unit load {load}" if pd.isna(mode) else names[mode] for mode, load in pairs]
    bars = figures.shares(called, modes["share"].to_numpy(), title)
    what = "mode and unit load" if result.record.get("unit_loads") else "mode"
    shown.append(figs.add("damage-modes", bars, f"Damage by {what}; a negative share relieves"))
    bands = band_shares(why)
    if len(bands) > 1:
        leading = modes["mode"].dropna()[:MODES_MARKED]
        marked = [natural[mode] for mode in leading if mode in natural]
        caption = "Damage by frequency band; dotted: the leading normal modes"
        shown.append(figs.add("damage-bands", figures.damage_by_band(bands, marked), caption))
    track = why.track[why.track["event"] == event]
    if len(track) > 1:
        caption = f"Where in event {wording.short(event)} the damage is made"
        shown.append(figs.add("track", figures.damage_on_track(track), caption))
    return shown


def _mode_names(result: ShownResult) -> tuple[dict[int, str], dict[int, float]]:
    """Name of every mode and unit load, and the natural frequencies [Hz] of the normal modes."""
    modes, names, natural = result.record["modes"], dict(result.coordinates), {}
    for mode, frequency, kind in zip(modes["used"], modes["frequency_hz"], modes["kind"], strict=True):
        names[mode] = f"mode {mode}, {frequency:.4g} Hz" + ("" if kind == "normal" else f", {kind}")
        if kind == "normal" and frequency > 0.0:
            natural[mode] = frequency
    return names, natural
