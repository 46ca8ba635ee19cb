"""Lives of welds, variant by variant, with their scatter over the seeds."""

import math
from collections.abc import Sequence

import numpy as np

from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.figures.style import GRID, SERIES, axis, drawn_life, figure, log_axis
from fatigue.report.wording import LONGEST, in_figure, number
from fatigue.study.claims.verdict import Scatter, scatter
from fatigue.study.page.chosen import Group
from fatigue.study.page.studied import Studied
from fatigue.study.quantities import LIFE

MOST_WELDS = 30  # drawn, those of the shortest lives; the table of numbers has all
SPREAD = 0.62  # of a row, over which the variants of a weld are spread
MARKS = ("circle", "diamond", "square", "triangle-up", "cross", "x")

Lives = dict[tuple[str, str], Scatter]


def lives_of(of: Studied) -> Lives:
    """Scatter of the life of every weld over the seeds, by variant and weld; means are geometric."""
    values: dict[tuple[str, str], list[float]] = {}
    for one in of.numbers:
        if one.quantity == LIFE and one.weld:
            values.setdefault((one.variant, one.weld), []).append(float(one.value))
    return {place: scatter([min(life, LONGEST) for life in lives], logarithmic=True) for place, lives in values.items()}


def lives_figure(group: Group, lives: Lives) -> Figure | None:
    """Mean life of each weld and its least and greatest over the seeds, a mark for each variant; None without any."""
    names = [one.name for one in group.variants]
    known = {place: found for place, found in lives.items() if place[0] in names and found.known}
    shortest: dict[str, float] = {}
    for (_, weld), found in known.items():
        shortest[weld] = min(shortest.get(weld, math.inf), found.low)
    welds = sorted(shortest, key=lambda weld: shortest[weld])[:MOST_WELDS]
    if not welds:
        return None
    data = [
        _marks(label, place, len(names), welds, [known.get((name, weld)) for weld in welds])
        for place, (name, label) in enumerate(zip(names, group.labels, strict=True))
    ]
    drawn = [found for (_, weld), found in known.items() if weld in welds]
    low = np.floor(np.log10(max(min(found.low for found in drawn), 1e-3)) - 0.05)
    high = np.ceil(np.log10(max(found.high for found in drawn)) + 0.05)
    lines = [
        {"type": "line", "xref": "paper", "x0": 0, "x1": 1, "y0": row + 0.5, "y1": row + 0.5,
         "line": {"color": GRID, "width": 1}}
        for row in range(len(welds) - 1)
    ]  # fmt: skip
    lives_axis = log_axis("life [km]", low, high)
    if high >= np.log10(LONGEST):
        kept = [(v, t) for v, t in zip(lives_axis["tickvals"], lives_axis["ticktext"], strict=True) if v < LONGEST]
        lives_axis["tickvals"], lives_axis["ticktext"] = (
            [*(v for v, _ in kept), LONGEST],
            [*(t for _, t in kept), "> 1e12"],
        )
    return figure(
        data,
        height=110 + max(26, 9 * len(names)) * len(welds),
        margin={"l": 24, "r": 16, "t": 40, "b": 50},
        xaxis=lives_axis,
        yaxis=axis(
            "",
            tickvals=list(range(len(welds))),
            ticktext=[in_figure(weld, 26) for weld in welds],
            range=[len(welds) - 0.5, -0.5],
            automargin=True,
            showgrid=False,
        ),
        shapes=lines,
    )


def _marks(label: str, place: int, variants: int, welds: Sequence[str], lives: Sequence[Scatter | None]) -> Trace:
    """Marks of one variant, with bars from the least to the greatest life."""
    offset = SPREAD * ((place + 0.5) / variants - 0.5)
    shown = [(row, found) for row, found in enumerate(lives) if found is not None and found.known]
    mean = drawn_life([found.mean for _, found in shown])
    low, high = (drawn_life([getattr(found, end) for _, found in shown]) for end in ("low", "high"))
    colour = SERIES[place % len(SERIES)]
    facts = [[in_figure(welds[row]), *map(number, (f.mean, f.low, f.high)), f.known] for row, f in shown]
    return {
        "type": "scatter",
        "mode": "markers",
        "name": label,
        "x": mean,
        "y": [row + offset for row, _ in shown],
        "error_x": {"type": "data", "symmetric": False, "array": high - mean, "arrayminus": mean - low,
                    "color": colour, "thickness": 1.2, "width": 3},
        "marker": {"color": colour, "size": 7, "symbol": MARKS[place % len(MARKS)]},
        "customdata": facts,
        "hovertemplate": "%{customdata[0]}: %{customdata[1]} km<br>%{customdata[2]} to %{customdata[3]} km, "
        "seeds: %{customdata[4]}",
    }  # fmt: skip
