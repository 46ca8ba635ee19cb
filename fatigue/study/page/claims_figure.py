"""All claims at a glance: left over right of every seed, and on which side of it the sentence holds."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.figures.style import ACCENT, GRID, MISSED, QUIET, axis, figure, log_axis, upright
from fatigue.report.wording import in_figure, number
from fatigue.study.claims.verdict import Says, Verdict

HOLDS = "#e3eef5"  # behind the side on which a sentence holds
LOOK: dict[Says, tuple[str, str, str]] = {
    "holds": ("holds", ACCENT, "circle"),
    "reverse": ("holds the reverse", MISSED, "x"),
    "same": ("both are equal", QUIET, "circle-open"),
}
ROW_PX = 40
LETTERS = 56
MARK_AT = 0.19  # of a row: in the middle of its shade
LEAST_DECADES = 0.6  # to each side of 1
MOST_DECADES = 6.0


def claims_figure(verdicts: Sequence[Verdict]) -> Figure | None:
    """Ratio of every seed of every claim, a row for each; None where no claim has a ratio above 0.

    Of 'between' the right side is the geometric mean of its ends, and the shade reaches from one to the other.
    """
    rows = [(place, one) for place, one in enumerate(verdicts, 1) if one.of_seeds]
    points = [point for row, (place, one) in enumerate(rows) for point in _points(row, place, one)]
    if not points:
        return None
    reach = max(abs(math.log10(point.ratio)) for point in points)
    reach = max(reach, *(abs(math.log10(end)) for _, one in rows for end in _ends(one) if 0.0 < end < math.inf))
    reach = min(max(reach + 0.15, LEAST_DECADES), MOST_DECADES)
    return figure(
        [_marks(says, points) for says in LOOK if any(point.says == says for point in points)],
        height=100 + ROW_PX * len(rows),
        margin={"l": 40, "r": 16, "t": 40, "b": 50},
        xaxis=_ratio_axis(reach),
        yaxis=axis(
            "claim",
            tickvals=list(range(len(rows))),
            ticktext=[str(place) for place, _ in rows],
            range=[len(rows) - 0.5, -0.5],
            showgrid=False,
        ),
        annotations=[_said(row, one.claim.text) for row, (_, one) in enumerate(rows)],
        shapes=[*(_shade(row, one, reach) for row, (_, one) in enumerate(rows)), upright(1.0, QUIET, dash="solid")],
    )


def _said(row: int, text: str) -> Trace:
    """The sentence above the marks of its row, so that it needs no room beside them."""
    return {
        "x": 0,
        "xref": "paper",
        "xanchor": "left",
        "xshift": 4,
        "y": row - 0.26,
        "yanchor": "middle",
        "showarrow": False,
        "text": in_figure(text, LETTERS),
        "font": {"size": 11, "color": QUIET},
    }


def _ratio_axis(reach: float) -> dict[str, object]:
    """Logarithmic axis around 1; ticks within a decade where it spans few of them."""
    title = "left / right [-]"
    if reach > 1.3:
        return log_axis(title, -reach, reach)
    ticks = [
        t for t in (0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0, 20.0) if abs(math.log10(t)) <= reach
    ]
    return axis(title, type="log", range=[-reach, reach], tickvals=ticks, ticktext=[f"{t:g}" for t in ticks])


@dataclass(frozen=True, slots=True)
class _Point:
    """One seed of one claim: its row in the figure, the number of the claim, the ratio that is drawn."""

    row: int
    claim: int
    seed: int
    says: Says
    ratio: float


def _points(row: int, claim: int, one: Verdict) -> Iterator[_Point]:
    """Seeds of a claim whose ratio a logarithmic axis can show."""
    ends = _pair(one)
    for of in one.of_seeds:
        middle = of.right if ends is None else math.sqrt(ends[0] * ends[1])
        if of.says in LOOK and of.left > 0.0 and middle > 0.0 and 0.0 < of.left / middle < math.inf:
            yield _Point(row, claim, of.seed, of.says, of.left / middle)


def _pair(one: Verdict) -> tuple[float, float] | None:
    """Both ends of 'between' with the factor in them; None of other claims, and of ends that are no numbers above 0."""
    ends = [one.claim.factor * side for side in one.claim.right_sides if isinstance(side, float)]
    return (ends[0], ends[1]) if len(ends) == 2 and ends[0] > 0.0 else None


def _ends(one: Verdict) -> tuple[float, float]:
    """Ratios between which the sentence holds."""
    if one.claim.operator == ">":
        return 1.0, math.inf
    if one.claim.operator == "<":
        return 0.0, 1.0
    ends = _pair(one)
    half = 1.0 if ends is None else math.sqrt(ends[1] / ends[0])
    return 1.0 / half, half


def _shade(row: int, one: Verdict, reach: float) -> Trace:
    low, high = np.clip(_ends(one), 10.0**-reach, 10.0**reach)
    return {
        "type": "rect",
        "x0": float(low),
        "x1": float(high),
        "y0": row - 0.02,
        "y1": row + 0.4,
        "fillcolor": HOLDS,
        "line": {"width": 1, "color": GRID},
        "layer": "below",
    }


def _marks(says: Says, points: Sequence[_Point]) -> Trace:
    name, colour, symbol = LOOK[says]
    shown = [point for point in points if point.says == says]
    return {
        "type": "scatter",
        "mode": "markers",
        "name": name,
        "x": [point.ratio for point in shown],
        "y": [point.row + MARK_AT for point in shown],
        "marker": {"size": 9, "color": colour, "symbol": symbol, "line": {"width": 1.5, "color": colour}},
        "customdata": [[number(point.ratio), point.claim, point.seed] for point in shown],
        "hovertemplate": "claim %{customdata[1]}, seed %{customdata[2]}: %{customdata[0]}<extra></extra>",
    }
