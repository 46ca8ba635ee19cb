"""The page of a comparison: one HTML file that needs nothing but itself, in the look of the report."""

import math
from typing import Any

import pandas as pd

from fatigue.decide.compare.figures import event_figure, mode_figure, ratio_figure
from fatigue.decide.compare.pairs import Pair
from fatigue.decide.compare.said import gains, notes, sentences
from fatigue.decide.compare.summary import Comparison, match_rows, result_rows
from fatigue.report.page_text import page_text
from fatigue.report.rows_table import MOST_ROWS, filter_label, rows_table
from fatigue.report.sections.cells import Cell, Heading, PageTable, life, num, text, verdict
from fatigue.report.sections.embed import Figures
from fatigue.results.dictionary.decided.compare import MATCHES, RESULTS

PAGE = "compare.html"


def compare_page(found: Comparison) -> str:
    """Return the page as text: what differs first, then who gains, who loses and why."""
    figs = Figures()
    ratios = ratio_figure(found.pairs)
    caption = (
        "Life of each weld, its worst point there over its worst point in A; right of 1 it lasts longer. Open marks: "
        "the weld meets its target in one of them only, with a red edge where it misses it now."
    )
    context = {
        "title": _title(found),
        "several": len(found.pairs) > 1,
        "results": _results(found),
        "ratios": figs.add("ratios", ratios, caption, wide=True) if ratios is not None else None,
        "pairs": [_pair(pair, figs) for pair in found.pairs],
    }
    return page_text("fatigue.decide.compare", "compare.html", context, figs)


def _pair(pair: Pair, figs: Figures) -> dict[str, Any]:
    letter = pair.other.letter
    under = figs.under(f"{letter.lower()}-")
    losing, gaining, same = gains(pair)
    by_event, by_mode = event_figure(pair), mode_figure(pair)
    return {
        "id": f"result-{letter.lower()}",
        "letter": letter,
        "title": str(pair.other.record["title"]),
        "key": _key(pair, losing, gaining, same),
        "said": list(sentences(pair)),
        "notes": list(notes(pair)),
        "differences": _differences(pair) if pair.differences else None,
        "ranking": _ranking(pair),
        "left_out": max(0, len(pair.welds) - MOST_ROWS),
        "events": under.add(
            "events",
            by_event,
            f"What each event does to the life of a weld, {letter} over A: left of 1 it costs life. The parts of a bar "
            "multiply to the diamond, which is the ratio of the lives. Hatched: how often an event occurs; plain: the "
            "damage of a pass.",
            wide=True,
        )
        if by_event is not None
        else None,
        "modes": under.add(
            "modes",
            by_mode,
            "The same by modes and unit loads, all events together, damage limits left out; a mode may cost life or "
            "relieve, by the sign of what it adds to cycles.",
            wide=True,
        )
        if by_mode is not None
        else None,
        "matches": rows_table(f"matches-{letter}", MATCHES[1:], _rows(match_rows(pair))),
    }


def _results(found: Comparison) -> PageTable:
    """The results; a hash says nothing to a reader of the page."""
    columns = [column for column in RESULTS if column.name != "hash"]
    return rows_table("results", columns, _rows(result_rows(found.results)))


def _rows(table: pd.DataFrame) -> list[Any]:
    """Rows of a table by the names of its columns; what is missing is None."""
    return list(table.astype(object).where(table.notna(), None).itertuples(index=False))


def _title(found: Comparison) -> str:
    first, *others = (str(one.record["title"]) for one in found.results)
    return f"{others[0] if len(others) == 1 else f'{len(others)} results'} against {first}"


def _differences(pair: Pair) -> PageTable:
    """What else differs, a column for each result."""
    names = ("what", "in A", f"in {pair.other.letter}", "sits in")
    rows = tuple((text(d.what), text(d.value), text(d.other_value), text(d.sits_in)) for d in pair.differences)
    return PageTable(f"differences-{pair.other.letter}", tuple(Heading(name, numeric=False) for name in names), rows)


def _key(pair: Pair, *groups: pd.DataFrame) -> list[dict[str, str]]:
    """The first numbers of a pair."""
    losing, gaining, same = (str(len(some)) for some in groups)
    flips = pair.welds["flip"]
    return [
        {"name": "welds that lose life", "value": losing},
        {"name": "welds that gain life", "value": gaining},
        {"name": "as long, to 5 %", "value": same},
        {"name": "miss their target now", "value": str(int((flips == "lost").sum()))},
        {"name": "meet their target now", "value": str(int((flips == "gained").sum()))},
    ]


def _ranking(pair: Pair) -> PageTable:
    """Welds from the largest loss to the largest gain."""
    letter = pair.other.letter
    headings = (
        Heading("weld", numeric=False),
        Heading("life in A", "km"),
        Heading(f"life in {letter}", "km"),
        Heading("ratio"),
        Heading("in A", numeric=False),
        Heading(f"in {letter}", numeric=False),
        Heading("why", numeric=False),
    )
    rows = [
        (
            text(row.weld if row.weld == row.other_weld else f"{row.weld} = {row.other_weld}"),
            life(row.life_km),
            life(row.other_life_km),
            _ratio(float(row.life_ratio), str(row.basis)),
            verdict(row.fulfilled),
            verdict(row.other_fulfilled),
            Cell(row.why or "–"),
        )
        for row in pair.welds.head(MOST_ROWS).itertuples(index=False)
    ]
    return PageTable(f"ranking-{letter.lower()}", headings, tuple(rows), filter_label(len(rows), "weld"))


def _ratio(ratio: float, basis: str) -> Cell:
    """Ratio of three digits, one-sided where it is."""
    sign = {"at_least": "≥ ", "at_most": "≤ "}.get(basis, "")
    return (
        num(None) if math.isnan(ratio) else Cell(f"{sign}{ratio:.3g}" if ratio < math.inf else "∞", min(ratio, 1e300))
    )
