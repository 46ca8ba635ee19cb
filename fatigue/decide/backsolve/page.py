"""The page of answers: one HTML file that needs nothing but itself, in the look of the report."""

import numpy as np

from fatigue.decide.backsolve.rows import AnswerRow
from fatigue.decide.backsolve.summary import ASKED, Answers, answer_words
from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.figures.style import ACCENT, INK, QUIET, axis, figure, log_axis, upright
from fatigue.report.page_text import page_text
from fatigue.report.rows_table import MOST_ROWS, filter_label
from fatigue.report.sections.cells import Cell, Heading, PageTable, integer, num, text
from fatigue.report.sections.embed import Figures, Shown
from fatigue.report.wording import in_figure, number

PAGE = "backsolve.html"
MOST_DRAWN = 40


def answers_page(found: Answers) -> str:
    """Return the page as text: the answer for the body, a figure, a table of welds, what is held."""
    figs = Figures()
    context = {
        "title": found.title,
        "verdict": found.verdict,
        "missed": not found.solved,
        "question": found.asked.name,
        "target": f"{number(found.asked.target_km)} km, {found.asked.years:.4g} years at the mileage of the case",
        "figure": _figure(found, figs),
        "table": _welds(found),
        "left_out": max(0, len(found.rows) - 1 - MOST_ROWS),
        "notes": found.notes,
        "held": found.held,
        "points": found.points,
        "warnings": found.warnings,
    }
    return page_text("fatigue.decide.backsolve", "backsolve.html", context, figs)


def _figure(found: Answers, figs: Figures) -> Shown | None:
    rows = [row for row in found.rows[1:] if row.state == "solved"][:MOST_DRAWN]
    if not rows:
        return None
    caption = f"Of every weld: {ASKED[found.asked.of]} that just meets the target; ring: what it is now."
    if any(row.basis == "histogram" for row in rows):
        caption += " Line: between the bounds."
    return figs.add("answers", _drawn(found, rows), caption, wide=True)


def _drawn(found: Answers, rows: list[AnswerRow]) -> Figure:
    """Answer of each weld beside what is now, the one that decides on top."""
    y = list(range(len(rows)))
    x: list[float | None] = []
    at: list[int | None] = []
    for i, row in enumerate(rows):
        x += [row.low, row.high, None]
        at += [i, i, None]
    marker = {"type": "scatter", "mode": "markers", "y": y}
    data: list[Trace] = [
        {"type": "scatter", "mode": "lines", "x": x, "y": at, "line": {"color": QUIET, "width": 3}, "hoverinfo": "skip",
         "showlegend": False},
        marker | {"name": "now", "x": [row.now for row in rows], "hovertemplate": "now %{x:.4g}<extra></extra>",
                  "marker": {"color": INK, "symbol": "circle-open", "size": 9}},
        marker | {"name": "just meets the target", "x": [row.answer for row in rows],
                  "hovertemplate": "%{x:.5g}<extra></extra>", "marker": {"color": ACCENT, "size": 9}},
    ]  # fmt: skip
    values = np.array([value for row in rows for value in (row.now, row.answer, row.low, row.high)])
    title = ASKED[found.asked.of]
    if found.asked.of == "share":
        along = axis("share [-]", range=[-0.02, 1.02])
    else:
        logs = np.log10(values[values > 0.0])
        along = log_axis(
            title if "[" in title or "km" in title else f"{title} [-]", logs.min() - 0.05, logs.max() + 0.05
        )
        if logs.max() - logs.min() < 1.0:  # less than a decade has no ticks of its own
            along = axis(along["title"]["text"])
    body = found.body.answer
    return figure(
        data,
        height=150 + 24 * len(rows),
        margin={"l": 190, "r": 16, "t": 60, "b": 50},
        xaxis=along,
        yaxis=axis("", tickvals=y, ticktext=[in_figure(row.weld, 28) for row in rows], range=[len(rows) - 0.5, -0.5]),
        shapes=[upright(body, ACCENT)] if np.isfinite(body) else [],
    )


def _welds(found: Answers) -> PageTable:
    asked, rows = found.asked, found.rows[1 : MOST_ROWS + 1]
    between = any(row.basis == "histogram" for row in rows)
    headings = [Heading("weld", numeric=False), Heading("face", numeric=False), Heading("node"), Heading("now")]
    headings += [Heading(ASKED[asked.of])]
    headings += [Heading("low"), Heading("high")] if between else []
    if asked.of == "share":
        headings += [Heading(name) for name in ("at least", "at most", "utilisation at 0", "utilisation at 1")]
    headings += [Heading("factor")] if asked.of in ("thickness", "km_per_year") else []
    headings += [Heading("utilisation now"), Heading("deviation of the proof"), Heading("basis", numeric=False)]
    cells = []
    for row in rows:
        line = [text(row.weld), text(row.surface), integer(row.node), num(row.now), _answer(row)]
        line += [num(row.low), num(row.high)] if between else []
        if asked.of == "share":
            of_span = (row.share_at_least, row.share_at_most, row.utilisation_at_0, row.utilisation_at_1)
            line += [num(value) for value in of_span]
        line += [num(row.factor)] if asked.of in ("thickness", "km_per_year") else []
        line += [num(row.utilisation_now), _deviation(row), text(row.basis)]
        cells.append(tuple(line))
    return PageTable("backsolve-table", tuple(headings), tuple(cells), filter_label(len(rows), "weld"))


def _deviation(row: AnswerRow) -> Cell:
    solved = row.state == "solved" and np.isfinite(row.deviation)
    return Cell(f"{row.deviation:.1e}".replace("-", "−"), row.deviation) if solved else num(None)


def _answer(row: AnswerRow) -> Cell:
    return Cell(answer_words(row), num(row.answer if row.state == "solved" else None).value)
