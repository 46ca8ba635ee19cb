"""All weld lines in space, coloured by life, over the outline of the body."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.figures.given import ResultTable, check_target, frame_of
from fatigue.report.figures.style import BODY, PAPER, axis, drawn_life, figure, life_scale, single
from fatigue.report.wording import in_figure, life_km, life_years, number

LABELLED_STATIONS = 20_000  # beyond, texts at every station would outweigh the page
MOST_ON_PAPER = 20_000
SHADED_ELEMENTS = 60_000  # beyond, only the outline of the body is drawn
_PLACE = ("x_mm", "y_mm", "z_mm")
FLATTEST = 0.1  # smallest extent of the scene in any direction, of the largest
FEATURE_ANGLE = 30.0  # [deg] between neighbouring elements that makes their common edge part of the outline


@dataclass(frozen=True, slots=True, eq=False)
class BodyOutline:
    """What is drawn of the body: corner coordinates (k, 3) [mm], triangles (t, 3) and outline edges (e, 2)."""

    xyz: NDArray[np.float64]
    triangle: NDArray[np.int64]
    edge: NDArray[np.int64]


def body_outline(node: NDArray[np.int64], xyz: NDArray[np.float64], corners: NDArray[np.int64]) -> BodyOutline:
    """Triangles of shell elements, and their edges that are free, shared by three, or sharper than 30 degrees.

    ``corners`` (e, 4) are node ids around each element, 0 in the last column of triangles; ``node`` (k,) ascends.
    """
    quad = np.searchsorted(node, np.where(corners[:, 3:4] > 0, corners, corners[:, [0, 1, 2, 2]]))
    a, b, c, d = (xyz[quad[:, i]] for i in range(4))
    normal = np.cross(c - a, d - b)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-30)

    sides = np.concatenate([quad[:, [0, 1]], quad[:, [1, 2]], quad[:, [2, 3]], quad[:, [3, 0]]])
    element = np.tile(np.arange(len(quad)), 4)
    real = sides[:, 0] != sides[:, 1]
    edges, inverse, count = np.unique(np.sort(sides[real], axis=1), axis=0, return_inverse=True, return_counts=True)
    by_edge = element[real][np.argsort(inverse.ravel(), kind="stable")]
    first = np.cumsum(count) - count
    one, two = by_edge[first], by_edge[np.minimum(first + 1, len(by_edge) - 1)]
    flat = np.abs((normal[one] * normal[two]).sum(axis=1)) > np.cos(np.radians(FEATURE_ANGLE))
    outline = edges[~((count == 2) & flat)]

    triangles = np.concatenate([quad[:, [0, 1, 2]], quad[corners[:, 3] > 0][:, [0, 2, 3]]])
    used, compact = np.unique(np.concatenate([triangles.ravel(), outline.ravel()]), return_inverse=True)
    return BodyOutline(xyz[used], compact[: triangles.size].reshape(-1, 3), compact[triangles.size :].reshape(-1, 2))


def worst_faces(nodes: ResultTable) -> pd.DataFrame:
    """One row per station: the toe face with the larger utilisation (where no face has a toe, the larger)."""
    nodes = frame_of(nodes, "nodes", ("weld", "part", "order", "toe", "utilisation"), empty=True)
    rank = nodes["utilisation"].to_numpy() + np.where(nodes["toe"], 1e30, 0.0)
    best = pd.Series(rank, nodes.index).groupby([nodes["weld"], nodes["part"], nodes["order"]], sort=False).idxmax()
    return nodes.loc[best].reset_index(drop=True)


def line_rows(stations: ResultTable, closed: frozenset[str]) -> NDArray[np.int64]:
    """Rows of the stations in drawing order: -1 between the lines, the first repeated at the end of a closed line."""
    stations = frame_of(stations, "stations", ("weld", "part"))
    drawn: list[ArrayLike] = []
    for (weld, _), rows in stations.groupby(["weld", "part"], sort=False).indices.items():
        drawn += [rows, rows[:1] if weld in closed else rows[:0], [-1]]
    return np.concatenate(drawn).astype(np.int64)


def scene(stations: ResultTable, rows: NDArray[np.int64], target_km: float, body: BodyOutline | None = None) -> Figure:
    """Draw all weld lines in 3-D, coloured by log10 of their life, over the body in grey.

    Parameters
    ----------
    stations : one row per station with the columns of the table of nodes, see ``worst_faces``
    rows : drawing order, see ``line_rows``
    target_km : fixes the colour scale [km]
    body : the body to draw, None for none
    """
    stations = frame_of(stations, "stations", (*_PLACE, "life_km"))
    check_target(target_km)
    few = len(stations) <= LABELLED_STATIONS
    colour = {"color": single(_drawn(np.log10(drawn_life(stations["life_km"])), rows)), **life_scale(target_km)}
    colour["colorbar"] |= {"len": 0.86, "y": 0.44}  # below the mode bar
    lines = {
        "type": "scatter3d",
        **{axis_: single(_drawn(stations[f"{axis_}_mm"], rows)) for axis_ in "xyz"},
        "mode": "lines+markers",
        "name": "weld lines",
        "line": {"width": 7, **{key: value for key, value in colour.items() if key != "colorbar"}},
        "marker": {"size": 4, **colour},
        "text": _labels(stations, rows) if few else None,
        "hoverinfo": "text" if few else "none",
    }
    return figure(
        [*(body_traces(body) if body is not None else []), lines],
        height=540,
        margin={"l": 0, "r": 0, "t": 0, "b": 0},
        showlegend=False,
        scene=space_around(stations[["x_mm", "y_mm", "z_mm"]].to_numpy() if body is None else body.xyz),
    )


def projections(
    stations: ResultTable, rows: NDArray[np.int64], target_km: float, body: BodyOutline | None = None
) -> Figure:
    """Draw the same in side view and plan for paper, true to scale; of very many stations every so manyth."""
    stations = frame_of(stations, "stations", (*_PLACE, "life_km"))
    check_target(target_km)
    rows = rows[:: 1 + len(rows) // MOST_ON_PAPER]
    data: list[Trace] = []
    for n, across, up in (("", "x", "z"), ("2", "x", "y")):
        on = {"xaxis": f"x{n}", "yaxis": f"y{n}"}
        if body is not None:
            ends = body.xyz[body.edge][:, :, ["xyz".index(across), "xyz".index(up)]]
            x, y = _separated(ends)
            data.append(
                {
                    "type": "scatter",
                    "x": x,
                    "y": y,
                    "mode": "lines",
                    "line": {"color": BODY, "width": 0.5},
                    "hoverinfo": "skip",
                    **on,
                }
            )
        data.append(
            {
                "type": "scatter",
                "x": single(_drawn(stations[f"{across}_mm"], rows)),
                "y": single(_drawn(stations[f"{up}_mm"], rows)),
                "mode": "markers",
                "hoverinfo": "skip",
                "marker": {
                    "size": 4,
                    "color": single(_drawn(np.log10(drawn_life(stations["life_km"])), rows)),
                    **life_scale(target_km),
                    "showscale": not n,
                },
                **on,
            }
        )
    true = {"showgrid": False, "constrain": "domain"}
    return figure(
        data,
        height=360,
        showlegend=False,
        margin={"l": 64, "r": 16, "t": 8, "b": 44},
        xaxis=axis("", matches="x2", showticklabels=False, **true),
        yaxis=axis("z [mm]", domain=[0.54, 1.0], scaleanchor="x", **true),
        xaxis2=axis("x [mm]", anchor="y2", **true),
        yaxis2=axis("y [mm]", domain=[0.0, 0.48], scaleanchor="x2", **true),
    )


def _drawn(values: ArrayLike, rows: NDArray[np.int64]) -> NDArray[np.float64]:
    return np.where(rows >= 0, np.asarray(values, dtype=np.float64)[rows], np.nan)


def _separated(ends: NDArray[np.float64]) -> list[NDArray[np.float32]]:
    """Coordinates of separate segments (e, 2, d), with a gap after each."""
    gaps = np.full((len(ends), 1, ends.shape[2]), np.nan)
    return [single(column) for column in np.concatenate([ends, gaps], axis=1).reshape(-1, ends.shape[2]).T]


def _labels(stations: pd.DataFrame, rows: NDArray[np.int64]) -> list[str]:
    columns = ["weld", "node", "surface", "life_km", "life_years", "utilisation", "load_factor"]
    texts = [
        f"{in_figure(weld)}, node {node}, {face}<br>life {life_km(life)} ({life_years(years)})<br>"
        f"utilisation {number(utilisation)}, load factor {number(factor)}"
        for weld, node, face, life, years, utilisation, factor in stations[columns].itertuples(index=False)
    ]
    return [texts[row] if row >= 0 else "" for row in rows]


def body_traces(body: BodyOutline) -> list[Trace]:
    """What is drawn of the body in 3-D: its faces in grey, unless they are too many, and its outline."""
    traces: list[Trace] = []
    if len(body.triangle) <= 2 * SHADED_ELEMENTS:
        traces.append(
            {
                "type": "mesh3d",
                **{name: single(values) for name, values in zip("xyz", body.xyz.T, strict=True)},
                **{name: values.astype(np.int32) for name, values in zip("ijk", body.triangle.T, strict=True)},
                "color": BODY,
                "opacity": 0.2,
                "hoverinfo": "skip",
                "name": "body",
                "flatshading": True,
                "lighting": {"ambient": 0.95, "diffuse": 0.1, "specular": 0.0},
            }
        )
    x, y, z = _separated(body.xyz[body.edge])
    look = {"mode": "lines", "name": "outline", "line": {"color": "#9aa4ae", "width": 1}, "hoverinfo": "skip"}
    return [*traces, {"type": "scatter3d", "x": x, "y": y, "z": z, **look}]


def space_around(xyz: NDArray[np.float64]) -> dict[str, Any]:
    """Axes true to scale around points (k, 3), a flat direction a little widened; seen from the side and above."""
    low, high = xyz.min(axis=0), xyz.max(axis=0)
    extent = 1.04 * np.maximum(high - low, max(FLATTEST * float((high - low).max()), 1.0))
    middle = 0.5 * (low + high)
    plain = {
        "showbackground": False,
        "gridcolor": PAPER,
        "zeroline": False,
        "showspikes": False,
        "showticklabels": False,
    }
    axes = {
        f"{name}axis": {
            **plain,
            "title": {"text": f"{name} [mm]", "font": {"size": 11}},
            "range": [float(middle[i] - 0.5 * extent[i]), float(middle[i] + 0.5 * extent[i])],
        }
        for i, name in enumerate("xyz")
    }
    return {
        "aspectmode": "manual",
        "aspectratio": {name: float(2.0 * e / extent.max()) for name, e in zip("xyz", extent, strict=True)},
        "camera": {"eye": {"x": 0.62, "y": -1.33, "z": 0.66}, "projection": {"type": "orthographic"}},
        **axes,
    }
