"""All weld lines in space, coloured by life, over the outline of the body."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
import plotly.graph_objects as go
from numpy.typing import NDArray
from plotly.subplots import make_subplots

from fatigue.report.figures.style import PAPER, QUIET, TEMPLATE, drawn_life, figure, life_scale, single
from fatigue.report.wording import in_figure, number

LABELLED_POINTS = 20_000  # beyond, texts at every point would outweigh the page
SHADED_ELEMENTS = 60_000  # beyond, only the outline of the body is drawn
FEATURE_ANGLE = 30.0  # [deg] between neighbouring elements that makes their common edge part of the outline


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """What is drawn of the body: corner coordinates (k, 3) [mm], triangles (t, 3) and outline edges (e, 2)."""

    xyz: NDArray[np.float64]
    triangle: NDArray[np.int64]
    edge: NDArray[np.int64]


def body_outline(node: NDArray[np.int64], xyz: NDArray[np.float64], corners: NDArray[np.int64]) -> Body:
    """Turn shell elements into triangles and the edges that are free, shared by three, or sharper than 30 degrees.

    ``corners`` (e, 4) are node ids around each element, 0 in the last column of triangles; ``node`` ascends.
    """
    quad = np.where(corners[:, 3:4] > 0, corners[:, :4], corners[:, [0, 1, 2, 2]])
    index = np.searchsorted(node, quad)
    a, b, c, d = (xyz[index[:, i]] for i in range(4))
    normal = np.cross(c - a, d - b)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-30)

    edges = np.concatenate([index[:, [0, 1]], index[:, [1, 2]], index[:, [2, 3]], index[:, [3, 0]]])
    element = np.tile(np.arange(len(index)), 4)
    real = edges[:, 0] != edges[:, 1]
    edges, element = np.sort(edges[real], axis=1), element[real]
    unique, inverse, count = np.unique(edges, axis=0, return_inverse=True, return_counts=True)
    order = np.argsort(inverse.ravel(), kind="stable")
    first = np.concatenate([[0], np.cumsum(count)[:-1]])
    smooth = count == 2
    one, two = element[order[first]], element[order[np.minimum(first + 1, len(order) - 1)]]
    smooth &= np.abs((normal[one] * normal[two]).sum(axis=1)) > np.cos(np.radians(FEATURE_ANGLE))
    triangles = np.concatenate([index[:, [0, 1, 2]], index[corners[:, 3] > 0][:, [0, 2, 3]]])
    used, compact = np.unique(np.concatenate([triangles.ravel(), unique[~smooth].ravel()]), return_inverse=True)
    split = triangles.size
    return Body(xyz[used], compact[:split].reshape(-1, 3), compact[split:].reshape(-1, 2))


def worst_faces(nodes: pd.DataFrame) -> pd.DataFrame:
    """Keep one row per station: the toe face with the shorter life (where no face has a toe, the shorter life)."""
    ranked = nodes.assign(rank=np.where(nodes["toe"], nodes["utilisation"], -1.0 + nodes["utilisation"] * 1e-9))
    best = ranked.groupby(["weld", "part", "order"], sort=False)["rank"].idxmax()
    return nodes.loc[best].reset_index(drop=True)


def line_rows(stations: pd.DataFrame, closed: frozenset[str]) -> NDArray[np.int64]:
    """Rows of the stations in drawing order: -1 between the lines, the first repeated at the end of a closed line."""
    pieces = []
    for (weld, _), rows in stations.groupby(["weld", "part"], sort=False).indices.items():
        pieces += [rows, rows[:1] if weld in closed else rows[:0], [-1]]
    return np.concatenate(pieces).astype(np.int64)


def scene(stations: pd.DataFrame, rows: NDArray[np.int64], target_km: float, body: Body | None = None) -> go.Figure:
    """Draw all weld lines in 3-D, coloured by log10 of their life, over the body in grey.

    Parameters
    ----------
    stations : one row per station with the columns of the table of nodes, see `worst_faces`
    rows : drawing order, see `line_rows`
    target_km : centre of the colour scale [km]
    body : the body to draw, None for none
    """
    fig = figure(height=620, margin={"l": 0, "r": 0, "t": 0, "b": 0}, showlegend=False)
    if body is not None:
        _draw_body(fig, body)
    x, y, z = (single(_drawn(stations[c], rows)) for c in ("x_mm", "y_mm", "z_mm"))
    life = _drawn(np.log10(drawn_life(stations["life_km"])), rows)
    scale: dict[str, Any] = life_scale(target_km)
    colour = {**scale, "color": single(life)}
    few = len(stations) <= LABELLED_POINTS
    fig.add_scatter3d(
        x=x, y=y, z=z, mode="lines+markers", name="weld lines",
        line={"width": 6, **{k: v for k, v in colour.items() if k != "colorbar"}}, marker={"size": 4, **colour},
        text=_labels(stations, rows) if few else None, hoverinfo="text" if few else "none",
    )  # fmt: skip
    fig.update_layout(scene=_space(stations))
    return fig


def projections(stations: pd.DataFrame, rows: NDArray[np.int64], target_km: float, body: Body | None = None) -> go.Figure:
    """Draw the same in two views for paper: side and plan, true to scale, each weld's worst point numbered by rank."""
    fig = make_subplots(rows=2, cols=1, vertical_spacing=0.1)
    fig.update_layout(template=TEMPLATE, height=460, margin={"l": 70, "r": 20, "t": 12, "b": 46}, showlegend=False)
    scale = life_scale(target_km)
    for row, (across, up) in enumerate((("x_mm", "z_mm"), ("x_mm", "y_mm")), start=1):
        if body is not None:
            i, j = "xyz".index(across[0]), "xyz".index(up[0])
            ends = body.xyz[body.edge][:, :, [i, j]]
            lines = np.concatenate([ends, np.full((len(ends), 1, 2), np.nan)], axis=1).reshape(-1, 2)
            fig.add_scattergl(
                x=single(lines[:, 0]), y=single(lines[:, 1]), mode="lines", line={"color": "#d4d9de", "width": 0.6},
                hoverinfo="skip", row=row, col=1,
            )  # fmt: skip
        fig.add_scatter(
            x=single(_drawn(stations[across], rows)), y=single(_drawn(stations[up], rows)), mode="markers", hoverinfo="skip",
            marker={"size": 4, "color": single(_drawn(np.log10(drawn_life(stations["life_km"])), rows)), **scale, "showscale": row == 1},
            row=row, col=1,
        )  # fmt: skip
        fig.update_yaxes(title_text=f"{up[0]} [mm]", scaleanchor="x" if row == 1 else "x2", showgrid=False, row=row, col=1)
        fig.update_xaxes(title_text="x [mm]", showgrid=False, row=row, col=1)
    return fig


def _drawn(values: Any, rows: NDArray[np.int64]) -> NDArray[np.float64]:
    return np.where(rows >= 0, np.asarray(values, dtype=np.float64)[rows], np.nan)


def _labels(stations: pd.DataFrame, rows: NDArray[np.int64]) -> list[str]:
    texts = [
        f"{in_figure(weld)}, node {node}, {face}<br>life {number(life)} km ({number(years)} years)<br>"
        f"utilisation {number(utilisation)}, load factor {number(factor)}"
        for weld, node, face, life, years, utilisation, factor in stations[
            ["weld", "node", "surface", "life_km", "life_years", "utilisation", "load_factor"]
        ].itertuples(index=False)
    ]
    return [texts[row] if row >= 0 else "" for row in rows]


def _draw_body(fig: go.Figure, body: Body) -> None:
    x, y, z = (single(axis) for axis in body.xyz.T)
    if len(body.triangle) <= 2 * SHADED_ELEMENTS:
        i, j, k = (axis.astype(np.int32) for axis in body.triangle.T)
        fig.add_mesh3d(
            x=x, y=y, z=z, i=i, j=j, k=k, color="#c9d0d6", opacity=0.25, hoverinfo="skip", name="body", flatshading=True,
            lighting={"ambient": 0.9, "diffuse": 0.2, "specular": 0.0},
        )  # fmt: skip
    ends = body.xyz[body.edge]
    lines = np.concatenate([ends, np.full((len(ends), 1, 3), np.nan)], axis=1).reshape(-1, 3)
    fig.add_scatter3d(
        x=single(lines[:, 0]), y=single(lines[:, 1]), z=single(lines[:, 2]), mode="lines", name="outline",
        line={"color": "#9aa4ae", "width": 1}, hoverinfo="skip",
    )  # fmt: skip


def _space(stations: pd.DataFrame) -> dict[str, Any]:
    """Axes true to scale, with little around the picture."""
    axis = {"showbackground": False, "gridcolor": PAPER, "zeroline": False, "showspikes": False, "tickfont": {"size": 10, "color": QUIET}}
    return {
        "aspectmode": "data",
        "xaxis": {**axis, "title": {"text": "x [mm]"}},
        "yaxis": {**axis, "title": {"text": "y [mm]"}},
        "zaxis": {**axis, "title": {"text": "z [mm]"}},
        "camera": {"eye": {"x": 0.9, "y": -1.5, "z": 0.8}, "projection": {"type": "orthographic"}},
    }
