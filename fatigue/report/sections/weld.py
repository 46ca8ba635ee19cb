"""One weld on the page: its figures along the line, its worst point in detail, its life under other assumptions."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

import pandas as pd

from fatigue.report import figures, wording
from fatigue.report.checks import ShownChecks
from fatigue.report.result import ShownResult
from fatigue.report.sections import weld_tables
from fatigue.report.sections.beside.checks import weld_checks
from fatigue.report.sections.beside.life_band import band_facts
from fatigue.report.sections.beside.shear import shear_facts
from fatigue.report.sections.cells import PageTable
from fatigue.report.sections.curves import all_marked, curve_words, figure_mark, of_toes
from fatigue.report.sections.embed import Figures, Shown
from fatigue.report.sections.formation.words import of_one_weld
from fatigue.report.sections.load_spectra import LoadSpectra, equivalent_table, spectra_figures
from fatigue.report.sections.point.detail import Detail
from fatigue.report.sections.point.figures import cycle_figures, record_figures, shear_figure, why_figures
from fatigue.report.sections.why import Why, exponents
from fatigue.report.variants import assumptions_of, variants
from fatigue.results.beside.life_band import Bands

EVENTS_LISTED = 20
ONLY_SCREEN = ("matrix", "damage-bands", "track")  # figures of a weld that paper does without


@dataclass(frozen=True, slots=True)
class WeldPage:
    """One weld in detail; what only a diagnosis or load spectra know is empty without one.

    ``on_paper``: it is printed, but for the figures ``only_screen``. ``bounded`` points of it have a lower bound of
    life in place of a counted one; ``unverified``: its life rests on a curve that nobody has verified.
    """

    id: str
    name: str
    row: Mapping[str, Any]
    unverified: bool
    on_paper: bool
    only_screen: Collection[str]
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
    printed: Collection[str],
) -> WeldPage:
    """All that is shown of one weld; ``detail`` is None where the records were not found, ``printed`` go to paper."""
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
    shown += cycle_figures(result.record, wording.short(weld), cycles, used, figs)
    if detail is not None:
        shown += record_figures(result.record, detail, event, figs, modes_too=why is None)
        shown += shear_figure(result.record, detail, event, figs)
    if why is not None and event is not None:
        shown += why_figures(result.record, why, event, figs)
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
        on_paper=weld in printed,
        only_screen={f"{id_}-{name}" for name in ONLY_SCREEN},
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
