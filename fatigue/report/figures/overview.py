"""Figures of the whole body: welds against the target, all weld lines at a glance, time against frequency domain."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
import plotly.graph_objects as go

from fatigue.report.figures.style import (
    ACCENT,
    GRID,
    INK,
    MISSED,
    QUIET,
    SEQUENTIAL,
    drawn_life,
    event_colours,
    figure,
    life_axis,
    life_scale,
    single,
)
from fatigue.report.wording import in_figure, number, share

STRIP_CELLS = 120
EVENTS_SHOWN = 6


def weld_lives(welds: pd.DataFrame, target_km: float, most: int = 30) -> go.Figure:
    """Life of the worst point of every weld against the target, worst on top.

    ``welds`` has the columns of the weld register; at most ``most`` are drawn.
    """
    shown = welds.sort_values("utilisation", ascending=False, kind="stable").head(most).iloc[::-1]
    life = drawn_life(shown["life_km"])
    missed = ~shown["fulfilled"].to_numpy(dtype=bool)
    labels = [in_figure(name) for name in shown["weld"]]
    rows = np.arange(len(shown))
    fig = figure(height=90 + 22 * len(shown), showlegend=False, margin={"l": 20, "r": 24, "t": 28, "b": 46})
    fig.add_scatter(
        x=np.column_stack([np.full(len(life), target_km), life, np.full(len(life), np.nan)]).ravel(),
        y=np.repeat(rows, 3),
        mode="lines",
        line={"color": GRID, "width": 5},
        hoverinfo="skip",
    )
    fig.add_scatter(
        x=life,
        y=rows,
        mode="markers+text",
        marker={
            "size": 10,
            "symbol": np.where(missed, "x", "circle"),
            "color": np.where(missed, MISSED, ACCENT),
        },
        text=[number(value) for value in shown["life_km"]],
        textposition=["middle left" if value < target_km else "middle right" for value in life],
        textfont={"size": 11},
        cliponaxis=False,
        customdata=np.column_stack([[number(v) for v in shown[c]] for c in ("life_years", "utilisation", "load_factor")]),
        hovertemplate="%{y}<br>life %{text} km (%{customdata[0]} years)<br>utilisation %{customdata[1]}"
        "<br>load factor %{customdata[2]}<extra></extra>",
    )
    _mark_target(fig, target_km)
    axis = life_axis(shown["life_km"], target_km)
    axis["range"] = [axis["range"][0] - 0.4, axis["range"][1] + 0.6]
    fig.update_xaxes(title_text="life of the worst point [km]", **axis)
    fig.update_yaxes(tickvals=rows, ticktext=labels, range=[-0.7, len(shown) - 0.3], showgrid=False, automargin=True)
    return fig


def weld_strips(nodes: pd.DataFrame, target_km: float, most: int = 60) -> go.Figure:
    """Every weld line as a strip coloured by the shorter life of its toe faces, worst weld on top.

    ``nodes`` has the columns of the table of nodes; of a weld split into parts the parts follow each other. Each strip has
    120 cells, a cell shows the shortest life in it, or that of the nearest node.
    """
    toes = nodes[nodes["toe"]]
    order = toes.groupby("weld", sort=False)["utilisation"].max().sort_values(ascending=False, kind="stable")
    shown = list(order.index[:most])[::-1]
    strips = np.stack([_strip(toes[toes["weld"] == weld]) for weld in shown])
    scale = life_scale(target_km)
    fig = figure(height=110 + 18 * len(shown), margin={"l": 20, "r": 20, "t": 16, "b": 46})
    fig.add_heatmap(
        z=single(np.log10(drawn_life(strips))),
        x=(np.arange(STRIP_CELLS) + 0.5) / STRIP_CELLS,
        y=np.arange(len(shown)),
        zmin=scale["cmin"],
        zmax=scale["cmax"],
        colorscale=SEQUENTIAL,
        colorbar=scale["colorbar"],
        ygap=3,
        hovertemplate="%{text}<br>at %{x:.0%} of the line<br>life 10^%{z:.2f} km<extra></extra>",
        text=[[in_figure(weld)] * STRIP_CELLS for weld in shown] if len(shown) <= 20 else None,
    )
    fig.update_xaxes(title_text="position along the weld line [% of its length]", tickformat=".0%", range=[0, 1])
    labels = [in_figure(weld) for weld in shown]
    fig.update_yaxes(tickvals=np.arange(len(shown)), ticktext=labels, showgrid=False, automargin=True)
    return fig


def _strip(points: pd.DataFrame) -> np.ndarray:
    """Shortest life in each cell of one weld line; empty cells take that of the nearest node."""
    worst = points.groupby(["part", "order", "arc_length_mm"], sort=False)["life_km"].min().reset_index()
    lengths = worst.groupby("part")["arc_length_mm"].max()
    begins = (lengths.cumsum() - lengths).reindex(worst["part"]).to_numpy()
    place = (worst["arc_length_mm"].to_numpy() + begins) / max(lengths.sum(), 1e-9)
    life = worst["life_km"].to_numpy()
    by_place = np.argsort(place, kind="stable")
    place, life = place[by_place], life[by_place]
    cell = np.minimum((place * STRIP_CELLS).astype(np.int64), STRIP_CELLS - 1)
    strip = np.full(STRIP_CELLS, np.inf)
    np.minimum.at(strip, cell, life)
    empty = np.setdiff1d(np.arange(STRIP_CELLS), cell)
    middles = (empty + 0.5) / STRIP_CELLS
    right = np.clip(np.searchsorted(place, middles), 0, len(place) - 1)
    left = np.maximum(right - 1, 0)
    strip[empty] = np.where(np.abs(place[left] - middles) <= np.abs(place[right] - middles), life[left], life[right])
    return strip


def time_against_frequency(nodes: pd.DataFrame) -> go.Figure:
    """Dirlik's life over the rainflow life at the same bending ratio, all points, with bands of factor 2 and 3.

    ``nodes`` has the columns of the table of nodes and ``kurtosis``, that of the stress in the governing event, which
    colours the points: 3 for a Gaussian record. Points without an estimate are left out.
    """
    lives = nodes[["life_km_same_ratio", "life_km_dirlik"]]
    shown = nodes[(lives.notna() & np.isfinite(lives)).all(axis=1).to_numpy()]
    x, y = drawn_life(shown["life_km_same_ratio"]), drawn_life(shown["life_km_dirlik"])
    fig = figure(height=520, margin={"l": 80, "r": 20, "t": 44, "b": 56})
    span = np.array([min(x.min(), y.min()) / 2, max(x.max(), y.max()) * 2]) if len(shown) else np.array([1e6, 1e8])
    for factor, dash in ((1, "solid"), (2, "dash"), (3, "dot")):
        for side in {1 / factor, float(factor)}:
            fig.add_scatter(
                x=span,
                y=span * side,
                mode="lines",
                line={"color": QUIET, "width": 1, "dash": dash},
                name="equal" if factor == 1 else f"factor {factor}",
                legendgroup=str(factor),
                showlegend=side == factor,
                hoverinfo="skip",
            )
    fig.add_scattergl(
        x=single(x),
        y=single(y),
        mode="markers",
        name="points",
        showlegend=False,
        marker={
            "size": 6,
            "color": single(shown["kurtosis"].fillna(3.0)),
            "cmin": 2.0,
            "cmax": 6.0,
            "colorscale": SEQUENTIAL,
            "reversescale": True,
            "line": {"width": 0.4, "color": INK},
            "colorbar": {"title": {"text": "kurtosis [-] (Gaussian 3)", "side": "right"}, "thickness": 12, "outlinewidth": 0},
        },
        customdata=single(shown["dirlik_ratio"]),
        text=_names(shown) if len(shown) <= 20_000 else None,
        hovertemplate="%{text}<br>rainflow %{x:.4g} km<br>Dirlik %{y:.4g} km<br>damage ratio %{customdata:.4g}<extra></extra>",
    )
    limits = np.log10(span).tolist()
    fig.update_xaxes(title_text="life by rainflow, one bending ratio [km]", type="log", range=limits, dtick=1)
    fig.update_yaxes(title_text="life by Dirlik [km]", type="log", range=limits, dtick=1)
    return fig


def ratio_histogram(nodes: pd.DataFrame) -> go.Figure:
    """How the damage ratio Dirlik / rainflow is spread over the points, on a logarithmic axis."""
    ratio = nodes["dirlik_ratio"].to_numpy(dtype=np.float64)
    ratio = ratio[np.isfinite(ratio) & (ratio > 0.0)]
    limit = max(0.35, float(np.abs(np.log10(ratio)).max())) if len(ratio) else 0.35
    edges = np.linspace(-limit, limit, 42)
    count, _ = np.histogram(np.log10(ratio), bins=edges)
    fig = figure(height=300, showlegend=False, bargap=0.08)
    fig.add_bar(
        x=10 ** (0.5 * (edges[1:] + edges[:-1])),
        y=count,
        width=np.diff(10**edges),
        marker={"color": ACCENT},
        hovertemplate="ratio %{x:.3g}<br>%{y} points<extra></extra>",
    )
    for value, dash in ((0.5, "dash"), (1.0, "solid"), (2.0, "dash")):
        fig.add_vline(x=value, line={"color": QUIET, "width": 1, "dash": dash})
    fig.update_xaxes(
        title_text="damage by Dirlik / damage by rainflow [-]",
        type="log",
        tickvals=[0.1, 0.2, 0.5, 1, 2, 5, 10],
        ticktext=["0.1", "0.2", "0.5", "1", "2", "5", "10"],
    )
    fig.update_yaxes(title_text="points [-]")
    return fig


def damage_by_event(
    points: Sequence[str], shares: pd.DataFrame, weights: Mapping[str, str], most: int = EVENTS_SHOWN
) -> go.Figure:
    """Stacked bars: share of each event in the damage of each point.

    Parameters
    ----------
    points : labels, worst first
    shares : (point, event) shares of the damage [-], columns named by event
    weights : what is written beside each event in the legend: its share of the mileage
    most : events drawn on their own; the rest is one bar
    """
    colours = event_colours(list(shares.columns))
    leading = list(shares.sum().sort_values(ascending=False, kind="stable").index[:most])
    rest = [event for event in shares.columns if event not in leading]
    fig = figure(height=110 + 26 * len(points), barmode="stack", margin={"l": 20, "r": 20, "t": 40, "b": 46})
    labels = list(range(len(points)))
    series = [(in_figure(f"{e} ({weights[e]})", 48), colours[e], shares[e]) for e in shares.columns if e in leading]
    if rest:
        series.append((f"{len(rest)} other events", QUIET, shares[rest].sum(axis=1)))
    for name, colour, values in series:
        fig.add_bar(
            y=labels,
            x=single(values),
            orientation="h",
            name=name,
            marker={"color": colour, "line": {"color": "white", "width": 1}},
            text=[share(v) if v >= 0.06 else "" for v in values],
            textposition="inside",
            insidetextanchor="middle",
            textangle=0,
            hovertemplate="%{x:.1%}<extra>" + name + "</extra>",
        )
    fig.update_xaxes(title_text="share of the damage [%]", tickformat=".0%", range=[0, 1])
    fig.update_yaxes(
        tickvals=labels, ticktext=[in_figure(p, 48) for p in points], autorange="reversed", showgrid=False, automargin=True
    )
    return fig


def _mark_target(fig: go.Figure, target_km: float) -> None:
    fig.add_vline(x=target_km, line={"color": INK, "width": 1.5})
    fig.add_annotation(
        x=np.log10(target_km), y=1, yref="paper", yanchor="bottom", showarrow=False, text=f"target {number(target_km)} km"
    )


def _names(points: pd.DataFrame) -> list[str]:
    return [
        f"{in_figure(weld)}, node {node}, {face}"
        for weld, node, face in zip(points["weld"], points["node"], points["surface"], strict=True)
    ]


