"""The page of a correlation: verdicts first, then warnings, then every gauge with what its verdict rests on."""

import math
from collections.abc import Sequence
from typing import Any

from fatigue.gauges.correlated.compared import Comparison
from fatigue.gauges.correlated.flag_rows import DRIFT, FlagRow
from fatigue.gauges.correlated.page.figures import densities, exceedances, histories, spike_samples
from fatigue.gauges.correlated.summary import Correlation, verdicts_in_words
from fatigue.gauges.correlated.verdict import (
    DATA,
    FAIR,
    GOOD,
    NOT_ALIGNABLE,
    POOR,
    SIGN,
    YARDSTICK,
)
from fatigue.gauges.instrument import MICROSTRAIN
from fatigue.report.page_text import page_text
from fatigue.report.rows_table import FILTERED_FROM, MOST_ROWS
from fatigue.report.sections.cells import Cell, Heading, PageTable, integer, num, percent, text
from fatigue.report.sections.embed import Figures, Shown

PAGE = "correlation.html"
MOST_GAUGES = 40  # with figures, those furthest off; the tables have all
MOST_FLAGS = 60  # places of a channel
LEAST_SHARE = 5e-5  # that a percentage of two decimals shows

WORDS = {
    GOOD: Cell("✓ good", 0.0, mark="met"),
    FAIR: Cell("~ fair", 1.0, mark="doubt"),
    POOR: Cell("✕ poor", 2.0, mark="missed"),
    SIGN: Cell("✕ sign", 3.0, mark="missed"),
    DATA: Cell("? data", 4.0, mark="doubt"),
    NOT_ALIGNABLE: Cell("? not alignable", 5.0, mark="doubt"),
}
MEANINGS = (
    ("good", "equivalent range ratio from 0.9 to 1.1"),
    ("fair", "from 0.8 to 1.25"),
    ("poor", "outside"),
    ("sign", "aligned, and the correlation is below -0.5: the channel has the other sign"),
    ("data", "less than 90 % of the samples are left, or nothing to compare"),
    ("not alignable", "aligned, and the correlation is below 0.7"),
)


def correlation_page(found: Correlation) -> str:
    """Return the page as text."""
    figs = Figures()
    shown = _furthest_first(found.comparisons)[:MOST_GAUGES]
    ids = {id(one): f"gauge-{i}" for i, one in enumerate(shown, start=1)}
    context = {
        "title": found.title,
        "agrees": found.agrees,
        "statement": verdicts_in_words(found.comparisons),
        "line": found.line_in_words(),
        "basis": found.basis(),
        "yardstick": YARDSTICK,
        "meanings": MEANINGS,
        "verdicts": _verdict_table(found, ids),
        "warnings": found.warnings,
        "gauges": [_section(one, ids[id(one)], figs, found.is_aligned) for one in shown],
        "not_listed": max(0, len(found.comparisons) - MOST_ROWS),
        "left_out": len(found.comparisons) - len(shown),
    }
    return page_text("fatigue.gauges.correlated.page", "correlation.html", context, figs)


def _furthest_first(comparisons: Sequence[Comparison]) -> list[Comparison]:
    """Channels in the order of how far they are off, those without verdict first."""

    def off(one: Comparison) -> float:
        ratio = one.numbers.equivalent_range_ratio
        return -math.inf if not 0.0 < ratio < math.inf else -abs(math.log(ratio))

    return sorted(comparisons, key=off) if len(comparisons) > MOST_GAUGES else list(comparisons)


def _verdict_table(found: Correlation, ids: dict[int, str]) -> PageTable:
    """Verdict of every channel, with the numbers it rests on."""
    headings = [
        Heading("gauge", numeric=False),
        Heading("channel", numeric=False),
        Heading("verdict", numeric=False),
        Heading("equivalent range ratio"),
        Heading("damage ratio"),
        Heading("rms ratio"),
    ]
    if found.is_aligned:
        headings += [Heading("lag", "s"), Heading("correlation"), Heading("coherence")]
    headings += [Heading("kept"), Heading("outside band"), Heading("flags", numeric=False)]
    rows = tuple(_verdict_row(one, ids.get(id(one), "")) for one in found.comparisons[:MOST_ROWS])
    return PageTable("verdicts-table", tuple(headings), rows, "Find a gauge" if len(rows) >= FILTERED_FROM else "")


def _verdict_row(one: Comparison, link: str) -> tuple[Cell, ...]:
    numbers = one.numbers
    cells = [Cell(text(one.channel.gauge).text, link=link), text(one.channel.name), WORDS[one.verdict]]
    cells += [num(n) for n in (numbers.equivalent_range_ratio, numbers.damage_ratio, numbers.rms_ratio)]
    if one.alignment is not None:
        cells += [num(one.alignment.lag_s), num(one.alignment.correlation), num(one.coherence)]
    lost = one.lost_share if abs(one.lost_share) >= LEAST_SHARE else 0.0
    return (*cells, percent(one.kept_share), percent(lost), text(one.said_flags or "none"))


def _section(one: Comparison, id_: str, figs: Figures, is_aligned: bool) -> dict[str, Any]:
    """One gauge: sentence, figures, ratios by band, flagged places."""
    name = one.channel.gauge
    own = figs.under(f"{id_}-")
    flags = one.flags[:MOST_FLAGS]
    return {
        "id": id_,
        "gauge": name,
        "channel": one.channel.name,
        "verdict": WORDS[one.verdict],
        "said": _said(one),
        "figures": [
            *_shown(own, "histories", histories(one), _caption(name, is_aligned), wide=True),
            *_shown(
                own, "density", densities(one), f"Spectra at {name}: Welch, segments of equal length on both sides."
            ),
            *_shown(own, "exceedance", exceedances(one), f"Exceedance at {name}: cycles per km that reach a range."),
            *_shown(
                own,
                "spikes",
                spike_samples(one.drawn.spikes),
                f"Raw samples around the largest spikes of {one.channel.name}: one that was cut may be a real cycle.",
                wide=True,
            ),
        ],
        "bands": _band_table(one, id_),
        "flags": _flag_table(flags, id_) if flags else None,
        "more_flags": len(one.flags) - len(flags),
    }


def _shown(figs: Figures, id_: str, drawn: Any, caption: str, *, wide: bool = False) -> list[Shown]:
    return [] if drawn is None else [figs.add(id_, drawn, caption, wide=wide, of_curve=False)]


def _caption(gauge: str, is_aligned: bool) -> str:
    if is_aligned:
        return f"Strain at {gauge} around the largest measured cycle, the measured one moved back by its lag."
    return f"Strain in the band at {gauge} around the largest cycle of each side: two places of two records."


def _said(one: Comparison) -> str:
    """Sentence under the heading of a gauge."""
    numbers = one.numbers
    ue = MICROSTRAIN
    said = f"Root mean square {numbers.rms_measured:.4g} {ue} measured, {numbers.rms_simulated:.4g} {ue} simulated; "
    said += f"pseudo-damage per km {numbers.damage_measured:.4g} and {numbers.damage_simulated:.4g} ({ue})^k; "
    return said + f"{one.km:.4g} km counted, {one.km_lost:.3g} km lost to flagged samples."


def _band_table(one: Comparison, id_: str) -> PageTable:
    """Ratios by band and by how often ranges are reached, in one row."""
    bands, ranges = one.numbers.band_ratios, one.numbers.range_ratios
    headings = [Heading(f"rms {low:.4g} to {high:.4g}", "Hz") for low, high in bands]
    headings += [Heading(f"range at {n}", "1/km") for n in ranges]
    cells = [num(ratio) for ratio in (*bands.values(), *ranges.values())]
    return PageTable(f"{id_}-bands", tuple(headings), (tuple(cells),))


def _flag_table(flags: Sequence[FlagRow], id_: str) -> PageTable:
    """Flagged places with their times in the record."""
    headings = (
        Heading("record", numeric=False),
        Heading("flag", numeric=False),
        Heading("from", "s"),
        Heading("to", "s"),
        Heading("samples"),
        Heading("value", MICROSTRAIN),
        Heading("from its neighbours", MICROSTRAIN),
        Heading("counted", numeric=False),
    )
    rows = tuple(
        (
            text(row.record),
            text(row.flag),
            Cell(f"{row.first_s:.4f}", row.first_s),
            Cell(f"{row.last_s:.4f}", row.last_s),
            integer(row.samples, grouped=True),
            num(row.value_ue),
            num(row.distance_ue),
            text(_counted(row)),
        )
        for row in flags
    )
    return PageTable(f"{id_}-flags", headings, rows)


def _counted(row: FlagRow) -> str:
    """What is counted at a flagged place."""
    if row.flag == DRIFT:
        return "as it is"
    return "a line" if row.bridged else "no"
