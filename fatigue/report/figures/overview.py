"""Figures of the whole body: welds against the target, all weld lines at a glance, which event damages where."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.figures.given import ResultTable, check_known, check_one_each, check_target, frame_of
from fatigue.report.figures.style import (
    ACCENT,
    GRID,
    INK,
    MISSED,
    QUIET,
    SEQUENTIAL,
    axis,
    drawn_life,
    event_colours,
    figure,
    life_axis,
    life_scale,
    single,
    upright,
)
from fatigue.report.wording import in_figure, number, share
from fatigue.report.wording import life as life_words

STRIP_CELLS = 120
_OF_WELDS = ("weld", "life_km", "life_years", "utilisation", "load_factor", "fulfilled")


def weld_lives(welds: ResultTable, target_km: float, most: int = 30) -> Figure:
    """Life of the worst point of every weld against the target, worst on top.

    ``welds`` has the columns of the weld register; of those assessed at most ``most`` are drawn.
    """
    welds = frame_of(welds, "welds", _OF_WELDS, empty=True)
    check_target(target_km)
    shown = welds[welds["utilisation"].notna()].sort_values("utilisation", ascending=False, kind="stable").head(most)
    life = drawn_life(shown["life_km"])
    missed = ~shown["fulfilled"].to_numpy(dtype=bool)
    rows = np.arange(len(shown))
    stems = np.column_stack([np.full(len(life), target_km), life, np.full(len(life), np.nan)]).ravel()
    facts = [
        [life_words(of_point[0]), *(number(value) for value in of_point[1:])]
        for of_point in shown[["life_years", "utilisation", "load_factor"]].to_numpy()
    ]
    data: list[Trace] = [
        {
            "type": "scatter",
            "x": stems,
            "y": np.repeat(rows, 3),
            "mode": "lines",
            "line": {"color": GRID, "width": 5},
            "hoverinfo": "skip",
        },
        {
            "type": "scatter",
            "x": life,
            "y": rows,
            "mode": "markers+text",
            "marker": {
                "size": 10,
                "symbol": np.where(missed, "x", "circle").tolist(),
                "color": np.where(missed, MISSED, ACCENT).tolist(),
            },
            "text": [life_words(value) for value in shown["life_km"]],
            "textposition": ["middle left" if value < target_km else "middle right" for value in life],
            "textfont": {"size": 11},
            "cliponaxis": False,
            "customdata": facts,
            "hovertemplate": "life %{text} km (%{customdata[0]} years)<br>utilisation %{customdata[1]}<br>"
            "load factor %{customdata[2]}<extra></extra>",
        },
    ]
    lives = life_axis("life of the worst point [km]", shown["life_km"], target_km)
    lives["range"] = [lives["range"][0] - 0.3, lives["range"][1] + 0.4]
    note = {
        "x": float(np.log10(target_km)),
        "y": 1,
        "yref": "paper",
        "yanchor": "bottom",
        "showarrow": False,
        "text": f"target {number(target_km)} km",
    }
    return figure(
        data,
        height=86 + 21 * len(shown),
        showlegend=False,
        margin={"l": 20, "r": 24, "t": 24, "b": 44},
        xaxis=lives,
        yaxis=_names_axis(shown["weld"]),
        shapes=[upright(target_km, INK, 1.5, "solid")],
        annotations=[note],
    )


def weld_strips(nodes: ResultTable, target_km: float, most: int = 60) -> Figure:
    """Every weld line as a strip coloured by the shorter life of its toe faces, worst weld on top.

    ``nodes`` has the columns of the table of nodes; parts of a weld split at its kinks follow each other. A strip has
    120 cells; a cell shows the shortest life of its nodes, or the life of the nearest node.
    """
    nodes = frame_of(nodes, "nodes", ("weld", "part", "order", "toe", "arc_length_mm", "life_km", "utilisation"))
    check_target(target_km)
    toes = nodes[nodes["toe"]]
    worst = toes.groupby("weld", sort=False)["utilisation"].max()
    shown = worst.sort_values(ascending=False, kind="stable").index[:most]
    places = toes[toes["weld"].isin(shown)].groupby(["weld", "part", "order", "arc_length_mm"], sort=False)
    of_weld = dict(list(places["life_km"].min().reset_index().groupby("weld", sort=False)))
    strips = np.stack([_strip(of_weld[weld]) for weld in shown])
    scale = life_scale(target_km)
    data = [
        {
            "type": "heatmap",
            "z": single(np.log10(drawn_life(strips))),
            "x": (np.arange(STRIP_CELLS) + 0.5) / STRIP_CELLS,
            "y": np.arange(len(shown)),
            "zmin": scale["cmin"],
            "zmax": scale["cmax"],
            "colorscale": SEQUENTIAL,
            "colorbar": scale["colorbar"],
            "ygap": 3,
            "hovertemplate": "at %{x:.0%} of the line<br>life 10<sup>%{z:.2f}</sup> km<extra></extra>",
        }
    ]
    return figure(
        data,
        height=max(230, 80 + 20 * len(shown)),
        margin={"l": 20, "r": 20, "t": 12, "b": 46},
        xaxis=axis("position along the weld line [% of its length]", tickformat=".0%", range=[0, 1], showgrid=False),
        yaxis=_names_axis(shown),
    )


def damage_by_event(points: Sequence[str], shares: ResultTable, weights: Mapping[str, str], most: int = 6) -> Figure:
    """Stacked bars: share of each event in the damage of each point.

    Parameters
    ----------
    points : labels, worst first
    shares : (point, event) shares of the damage [-], columns named by event
    weights : what is written beside each event in the legend: its share of the mileage
    most : events drawn on their own, those with the largest shares; the rest is one bar
    """
    shares = frame_of(shares, "shares", (), empty=True)
    check_one_each(points, shares, "points")
    check_known(shares.columns, weights, "weights", "event")
    colours = event_colours(list(shares.columns))
    leading = set(shares.sum().sort_values(ascending=False, kind="stable").index[:most])
    series = [(in_figure(f"{e} ({weights[e]})", 44), colours[e], shares[e]) for e in shares.columns if e in leading]
    if rest := [event for event in shares.columns if event not in leading]:
        series.append((f"{len(rest)} other events", QUIET, shares[rest].sum(axis=1)))
    rows = list(range(len(points)))
    data = [
        {
            "type": "bar",
            "y": rows,
            "x": single(values),
            "orientation": "h",
            "name": name,
            "marker": {"color": colour, "line": {"color": "white", "width": 1}},
            "text": [share(v) if v >= 0.06 else "" for v in values],
            "textposition": "inside",
            "insidetextanchor": "middle",
            "textangle": 0,
            "hovertemplate": "%{x:.1%}<extra>" + name + "</extra>",
        }
        for name, colour, values in series
    ]
    return figure(
        data,
        height=104 + 25 * len(points),
        barmode="stack",
        margin={"l": 20, "r": 24, "t": 34, "b": 46},
        xaxis=axis("share of the damage [%]", tickformat=".0%", range=[0, 1]),
        yaxis=_names_axis(points),
    )


def shares(labels: Sequence[str], values: NDArray[np.float64], title: str) -> Figure:
    """Bars of shares, the first on top; a negative one relieves."""
    check_one_each(values, labels, "values")
    rows = list(range(len(labels)))
    low, high = min(0.0, float(np.min(values, initial=0.0))), max(0.0, float(np.max(values, initial=0.0)))
    room = 0.2 * max(high - low, 1e-9)  # for the numbers beside the bars
    data = [
        {
            "type": "bar",
            "y": rows,
            "x": single(values),
            "orientation": "h",
            "marker": {"color": np.where(values < 0.0, QUIET, ACCENT).tolist()},
            "text": [share(v) for v in values],
            "textposition": "outside",
            "cliponaxis": False,
            "hoverinfo": "skip",
        }
    ]
    limits = [low - (1.5 * room if low < 0.0 else 0.0), high + room]
    return figure(
        data,
        height=80 + 24 * max(len(labels), 2),
        showlegend=False,
        margin={"l": 20, "r": 24, "t": 10, "b": 46},
        xaxis=axis(title, tickformat=".0%", range=limits),
        yaxis=_names_axis(labels),
        shapes=[upright(0.0, QUIET, 1, "solid")],
    )


def _strip(worst: pd.DataFrame) -> NDArray[np.float64]:
    """Shortest life in each cell of one weld line, of that at its places; empty cells take that of the nearest."""
    lengths = worst.groupby("part")["arc_length_mm"].max()
    begins = (lengths.cumsum() - lengths).reindex(worst["part"]).to_numpy()
    place = (worst["arc_length_mm"].to_numpy() + begins) / max(lengths.sum(), 1e-9)
    by_place = np.argsort(place, kind="stable")
    place, life = place[by_place], worst["life_km"].to_numpy()[by_place]
    cell = np.minimum((place * STRIP_CELLS).astype(np.int64), STRIP_CELLS - 1)
    strip = np.full(STRIP_CELLS, np.inf)
    np.minimum.at(strip, cell, life)
    empty = np.setdiff1d(np.arange(STRIP_CELLS), cell)
    middle = (empty + 0.5) / STRIP_CELLS
    right = np.clip(np.searchsorted(place, middle), 0, len(place) - 1)
    left = np.maximum(right - 1, 0)
    strip[empty] = np.where(np.abs(place[left] - middle) <= np.abs(place[right] - middle), life[left], life[right])
    return strip


def _names_axis(names: Sequence[str] | pd.Index | pd.Series) -> dict[str, object]:
    """Axis with a name at every row, the first on top."""
    rows = list(range(len(names)))
    labels = [in_figure(name) for name in names]
    return {
        "tickvals": rows,
        "ticktext": labels,
        "range": [len(rows) - 0.4, -0.6],
        "showgrid": False,
        "automargin": True,
        "ticks": "",
    }
