"""Figures of a fleet: lives of the units, percentiles of every weld, and what makes the difference."""

from collections.abc import Sequence

import numpy as np

from fatigue.decide.fleet.rows import PercentileRow, UnitRow, VarianceRow
from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.figures.style import ACCENT, INK, MISSED, QUIET, SERIES, axis, figure, log_axis, upright
from fatigue.report.wording import in_figure, life

MOST_UNITS, MOST_WELDS = 40, 30  # drawn: those with the shortest lives
LONGEST_YEARS = 1e4  # drawn; longer lives stand there
LONGEST = f"longer than {LONGEST_YEARS:g} years: drawn there"


def ranking(rows: Sequence[UnitRow], target_years: float | None) -> Figure:
    """Life of the worst weld of each unit, the shortest on top; a triangle where it is a lower bound."""
    shown = rows[:MOST_UNITS]
    lives = np.array([_drawn(row.life_years) for row in shown])
    missed = [row.fulfilled is False for row in shown]
    marks = {
        "type": "scatter",
        "mode": "markers",
        "x": lives,
        "y": list(range(len(shown))),
        "marker": {
            "color": [MISSED if miss else ACCENT for miss in missed],
            "symbol": ["triangle-right" if row.is_bound else "circle" for row in shown],
            "size": 9,
        },
        "text": [f"{in_figure(row.weld)}<br>{_life(row)}" for row in shown],
        "hovertemplate": "%{text}<extra></extra>",
        "showlegend": False,
    }
    names = [in_figure(row.unit, 24) for row in shown]
    return _beside_names([marks], names, _life_axis([*lives, *([target_years] if target_years else [])]), target_years)


def spread(rows: Sequence[PercentileRow], target_years: float | None) -> Figure:
    """Percentiles of the life of each weld over the units: outer ones as a line, all as marks."""
    welds = [name for name in dict.fromkeys(row.weld for row in rows) if name][:MOST_WELDS]
    percent = sorted({row.percentile for row in rows})
    place = {name: i for i, name in enumerate(welds)}
    of = {(row.weld, row.percentile): _drawn(row.life_years) for row in rows}
    x: list[float | None] = []
    y: list[int | None] = []
    for name in welds:
        x += [of[name, percent[0]], of[name, percent[-1]], None]
        y += [place[name], place[name], None]
    data: list[Trace] = [
        {
            "type": "scatter",
            "mode": "lines",
            "x": x,
            "y": y,
            "line": {"color": QUIET, "width": 3},
            "hoverinfo": "skip",
            "showlegend": False,
        }
    ]
    for i, p in enumerate(percent):
        data.append(
            {
                "type": "scatter",
                "mode": "markers",
                "name": f"P{p:g}",
                "x": [of[name, p] for name in welds],
                "y": list(range(len(welds))),
                "marker": {"color": SERIES[i % len(SERIES)], "size": 9 if p == 50.0 else 7},
                "hovertemplate": f"P{p:g}: %{{x:.3g}} years",
            }
        )
    lives = [of[name, p] for name in welds for p in percent]
    shown = _life_axis([*lives, *([target_years] if target_years else [])])
    return _beside_names(data, [in_figure(name, 28) for name in welds], shown, target_years, legend=True)


def shares(rows: Sequence[VarianceRow], of: str) -> Figure | None:
    """Shares of the variance, a bar for each weld (``of`` units) or unit; below 0 to the left. None without rows."""
    own = [row for row in rows if row.of == of]
    if not own:
        return None
    bars = list(dict.fromkeys(_bar(row) for row in own))[:MOST_WELDS]
    data: list[Trace] = []
    conditions = list(dict.fromkeys(row.condition for row in own))
    for condition, source in dict.fromkeys((row.condition, row.source) for row in own if row.share):
        of_bar = {_bar(row): row.share for row in own if (row.condition, row.source) == (condition, source)}
        name = in_figure(condition, 24) + ("" if source == "distance" else f" ({source})")
        data.append(
            {
                "type": "bar",
                "orientation": "h",
                "name": name,
                "x": [100.0 * of_bar.get(bar, 0.0) for bar in bars],
                "y": list(range(len(bars))),
                "marker": {
                    "color": SERIES[conditions.index(condition) % len(SERIES)],
                    "pattern": {"shape": {"distance": "", "damage": "/", "both": "x"}[source]},
                },
                "hovertemplate": f"{name}: %{{x:.3g}} %<extra></extra>",
            }
        )
    shown = axis("share of the variance [%]", zeroline=True, zerolinecolor=INK)
    return _beside_names(data, [in_figure(bar, 28) for bar in bars], shown, None, legend=True, barmode="relative")


def _bar(row: VarianceRow) -> str:
    return row.unit if row.of == "unit" else row.weld


def _drawn(years: float) -> float:
    return min(years, LONGEST_YEARS)


def _life(row: UnitRow) -> str:
    told = LONGEST if row.life_years > LONGEST_YEARS else f"{life(row.life_years)} years"
    return f"at least {told}" if row.is_bound else told


def _life_axis(lives: Sequence[float]) -> dict[str, object]:
    known = np.log10([years for years in lives if years > 0.0])
    return log_axis("life [years]", np.floor(known.min() - 0.05), np.ceil(known.max() + 0.05))


def _beside_names(
    data: Sequence[Trace],
    names: Sequence[str],
    along: dict[str, object],
    target_years: float | None,
    *,
    legend: bool = False,
    **layout: object,
) -> Figure:
    """Figure with a row for each name, the first on top, and the target as an upright line."""
    return figure(
        data,
        height=(150 if legend else 80) + 24 * len(names),
        margin={"l": 190, "r": 16, "t": 90 if legend else 20, "b": 50},
        xaxis=along,
        yaxis=axis("", tickvals=list(range(len(names))), ticktext=list(names), range=[len(names) - 0.5, -0.5]),
        shapes=[] if target_years is None else [upright(target_years, INK, dash="solid")],
        **layout,
    )
