"""The page of a study: one HTML file that needs nothing but itself, in the look of the report."""

from typing import Any

from fatigue.report.page_text import page_text
from fatigue.report.sections.embed import Figures, Shown
from fatigue.report.wording import short
from fatigue.study.claims.verdict import CONTRADICTED, REPRODUCED, Verdict
from fatigue.study.page import words
from fatigue.study.page.chosen import Group, groups
from fatigue.study.page.claims_figure import claims_figure
from fatigue.study.page.conicity import conicity_figure
from fatigue.study.page.lives import lives_figure, lives_of
from fatigue.study.page.maps import weld_maps
from fatigue.study.page.means import means_table
from fatigue.study.page.spectra import spectra_figure, spectra_of
from fatigue.study.page.studied import Studied
from fatigue.study.page.tables import MOST_ROWS, ratio_table, seed_table, undone_table, variant_table, whole_ratios

MARK = {REPRODUCED: ("✓", "met"), CONTRADICTED: ("✕", "missed")}
FOLDED_FROM = 25  # rows
MOST_LIVES = 3  # figures


def study_page(of: Studied) -> str:
    """Return the page as text: the story, claims with their verdicts, spectra, weld maps, lives, ratios."""
    figs = Figures()
    drawn = groups(of)
    context = {
        "title": of.title,
        "caution": words.caution(of),
        "story": list(words.story(of)),
        "outcome": words.outcome(of.verdicts) if of.verdicts else "",
        "glance": _glance(of, figs),
        "claims": [_claim(number, one) for number, one in enumerate(of.verdicts, 1)],
        "conicity": _conicity(of, figs),
        "spectra": _spectra(of, drawn, figs),
        "maps": _maps(of, figs),
        "lives": _lives(of, drawn, figs),
        "means": means_table(of),
        "variants": variant_table(of),
        "folded": FOLDED_FROM,
        "ratios": ratio_table(of.ratios),
        "left_out": max(0, whole_ratios(of.ratios) - MOST_ROWS),
        "undone": undone_table(of.runs),
        "warnings": of.warnings,
    }
    return page_text("fatigue.study.page", "study.html", context, figs)


def _glance(of: Studied, figs: Figures) -> Shown | None:
    drawn = claims_figure(of.verdicts)
    caption = (
        "Left over right side of each claim, a mark for each seed; shaded: where the sentence holds. Of a claim "
        "between two ends the right side is their geometric mean."
    )
    return None if drawn is None else figs.add("claims", drawn, caption, wide=True)


def _claim(number: int, one: Verdict) -> dict[str, Any]:
    """What the page says of one claim."""
    sign, mark = MARK.get(one.verdict, ("–", "doubt"))
    tried = bool(one.of_seeds)
    return {
        "number": number,
        "text": one.claim.text,
        "paper": one.claim.paper,
        "sign": sign,
        "mark": mark,
        "verdict": one.verdict,
        "reason": one.reason,
        "statement": one.claim.statement(),
        "left": words.told(one.left, one.unit) if tried else "",
        "right": words.right_of(one) if tried else "",
        "ratio": words.told(one.ratio, "") if one.ratio.known and one.claim.operator != "between" else "",
        "agreement": words.agreement(one) if tried else "",
        "geometric": one.is_logarithmic and len(one.of_seeds) > 1,
        "seeds": seed_table(number, one),
    }


def _conicity(of: Studied, figs: Figures) -> Shown | None:
    """Stable conicities of the vehicles whose analysis graph claims ask for."""
    drawn = conicity_figure(of)
    caption = (
        "Equivalent conicities at which each vehicle is stable at the speed of its run, with the frequency of the root "
        "that grows beyond either end. fatigue study graph draws all of it over speed and conicity."
    )
    return None if drawn is None else figs.add("conicity", drawn, caption, wide=True)


def _spectra(of: Studied, drawn: list[Group], figs: Figures) -> list[Shown]:
    """Spectra of bogies and equipment, a figure for each group of variants that has any."""
    spectra = spectra_of(of, drawn)
    shown: list[Shown] = []
    for number, group in enumerate(drawn, 1):
        fig = spectra_figure(group, spectra, of.seeds)
        if fig is not None:
            mean = "mean over the seeds" if len(of.seeds) > 1 else f"seed {of.seeds[0]}"
            of_what = f", by {short(group.title, 80)}" if group.title else ""
            caption = f"Power spectral density of bogie and equipment{of_what}; {mean}"
            shown.append(figs.add(f"spectra-{number}", fig, caption))
    return shown


def _maps(of: Studied, figs: Figures) -> list[Shown]:
    return [
        figs.add(
            f"map-{number}", one.drawn, f"Welds of {short(one.variant, 60)}, coloured by life in km, seed {one.seed}"
        )
        for number, one in enumerate(weld_maps(of), 1)
    ]


def _lives(of: Studied, drawn: list[Group], figs: Figures) -> list[Shown]:
    """Lives of the welds with their scatter, a figure for each group of variants."""
    lives = lives_of(of)
    shown: list[Shown] = []
    for number, group in enumerate(drawn, 1):
        fig = lives_figure(group, lives)
        if fig is not None and len(shown) < MOST_LIVES:
            scatter = "mean, least and greatest over the seeds" if len(of.seeds) > 1 else f"seed {of.seeds[0]}"
            of_what = f", by {short(group.title, 80)}" if group.title else ""
            shown.append(figs.add(f"lives-{number}", fig, f"Life of the worst point of each weld{of_what}; {scatter}"))
    return shown
