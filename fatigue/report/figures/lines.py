"""Figures along one weld line: life, load factor and stresses over the arc length, part after part."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.figures.given import (
    ResultTable,
    check_one_each,
    check_one_weld,
    check_point,
    check_target,
    frame_of,
)
from fatigue.report.figures.style import (
    ACCENT,
    DASHES,
    FACE,
    FACE_DASH,
    INK,
    MISSED,
    PAPER,
    SERIES,
    across,
    axis,
    drawn_life,
    figure,
    life_axis,
    shaded,
    single,
    upright,
)
from fatigue.report.wording import life_km

PART_GAP = 0.03  # of the whole length, between the parts of a weld split at its kinks
LARGEST_FACTOR = 1e3  # load factors beyond are drawn there
_COLUMNS = (
    "weld", "part", "order", "node", "surface", "toe", "arc_length_mm", "life_km", "load_factor", "max_range_MPa",
    "utilisation", "fulfilled", "at_end", "at_corner", "screened",
)  # fmt: skip
_PANELS = {"y": [0.57, 1.0], "y2": [0.30, 0.53], "y3": [0.0, 0.26]}


def along_weld(
    points: ResultTable,
    target_km: float,
    stress: Mapping[str, ArrayLike] | None = None,
    event: str = "",
    marked: tuple[int, int, str] | None = None,
) -> Figure:
    """Life, load factor and stress of one weld over its arc length, both faces, zoomed together.

    Parameters
    ----------
    points : rows of the table of nodes of one weld
    target_km : drawn as a line [km]
    stress : standard deviation of stress components in one event, one value per station [MPa]; None: the largest stress
        ranges of the faces are drawn instead
    event : name of that event
    marked : part, order and surface of a point that is marked

    Treated zones of weld ends are shaded, corners marked; faces without a toe are drawn thin, lives that are bounds as
    open circles.
    """
    points = frame_of(points, "points", _COLUMNS)
    check_one_weld(points)
    check_target(target_km)
    top = points[points["surface"] == "top"]
    for name, values in (stress or {}).items():
        check_one_each(values, top, f"stress[{name!r}]")
    place, breaks = _unrolled(top)
    data: list[Trace] = []
    for face in ("top", "bottom"):
        rows = points[points["surface"] == face]
        data += _face(rows, face, place, breaks, ranges=stress is None)
    for (name, values), dash, colour in zip((stress or {}).items(), DASHES, SERIES, strict=False):
        data.append(
            {
                "type": "scatter",
                "x": _gaps(place, breaks),
                "y": _gaps(values, breaks),
                "yaxis": "y3",
                "mode": "lines",
                "line": {"dash": dash, "color": colour},
                "name": f"{name} stress",
                "hovertemplate": "%{y:.4g} MPa",
            }
        )
    worst = points.loc[points["utilisation"].where(points["toe"], -1.0).idxmax()]
    at = int(((top["part"] == worst["part"]) & (top["order"] == worst["order"])).argmax())
    data.append(_worst(worst, float(place[at]), float(place[at] / max(place[-1], 1.0))))
    shapes = []
    if marked is not None:
        check_point(points, marked, "marked")
        here = int(((top["part"] == marked[0]) & (top["order"] == marked[1])).argmax())
        data.append(_marked(points, marked, float(place[here])))
        shapes.append(upright(float(place[here]), ACCENT, 1.5, "solid"))
    stress_title = "largest range [MPa]" if stress is None else "std of stress [MPa]"
    place_title = "arc length [mm]" + (f"; stresses in event {event}" if stress else "")
    margin = 0.02 * max(float(np.ptp(place)), 1.0)
    return figure(
        data,
        height=540,
        hovermode="x unified",
        xaxis=axis(place_title, anchor="y3", range=[place.min() - margin, place.max() + margin]),
        yaxis=life_axis("life [km]", points["life_km"], target_km, domain=_PANELS["y"]),
        yaxis2=axis("load factor [-]", rangemode="tozero", domain=_PANELS["y2"]),
        yaxis3=axis(stress_title, rangemode="tozero", domain=_PANELS["y3"]),
        shapes=[
            *(shaded(*zone) for zone in _end_zones(top["at_end"].to_numpy(), place)),
            *(upright(float(at)) for at in place[top["at_corner"].to_numpy()]),
            across(target_km),
            across(1.0, on="y2"),
            *shapes,
        ],
    )


def _face(
    rows: pd.DataFrame, face: str, place: NDArray[np.float64], breaks: NDArray[np.int64], *, ranges: bool
) -> list[Trace]:
    """Lines of one face in all panels; a face without a toe is thin."""
    toe = bool(rows["toe"].any())
    common: dict[str, Any] = {
        "type": "scatter",
        "x": _gaps(place, breaks),
        "mode": "lines+markers",
        "line": {"color": FACE[face], "width": 2 if toe else 1, "dash": FACE_DASH[face]},
        "marker": {"size": 5 if toe else 3, "symbol": _symbols(rows, breaks)},
        "opacity": 1.0 if toe else 0.6,
        "legendgroup": face,
        "name": f"{face} face" if toe else f"{face} face, no toe",
    }
    quiet = {**common, "showlegend": False}
    node = np.insert(rows["node"].to_numpy(), breaks, 0)
    life = {"y": _gaps(drawn_life(rows["life_km"]), breaks), "customdata": node}
    lines = [
        {**common, **life, "hovertemplate": "%{y:.4g} km, node %{customdata}"},
        {
            **quiet,
            "y": _gaps(np.minimum(rows["load_factor"], LARGEST_FACTOR), breaks),
            "yaxis": "y2",
            "hovertemplate": "%{y:.4g}",
        },
    ]
    if ranges:
        largest = _gaps(rows["max_range_MPa"], breaks)
        lines.append({**quiet, "y": largest, "yaxis": "y3", "hovertemplate": "%{y:.4g} MPa"})
    return lines


def _worst(worst: pd.Series, place: float, along: float) -> Trace:
    """Circle around the worst point, with its life; the text keeps within the figure, ``along`` from 0 to 1 of it."""
    level = "bottom" if worst["life_km"] > 1e11 else "top"
    side = "right" if along < 0.1 else "left" if along > 0.9 else "center"
    return {
        "type": "scatter",
        "x": [place],
        "y": drawn_life([worst["life_km"]]),
        "mode": "markers+text",
        "name": "worst point",
        "marker": {
            "symbol": "circle-open",
            "size": 13,
            "color": INK if worst["fulfilled"] else MISSED,
            "line": {"width": 2},
        },
        "text": [life_km(worst["life_km"])],
        "textposition": f"{level} {side}",
        "hoverinfo": "skip",
        "cliponaxis": False,
    }


def _marked(points: pd.DataFrame, marked: tuple[int, int, str], place: float) -> Trace:
    """Mark at the life of a point."""
    part, order, surface = marked
    row = points[(points["part"] == part) & (points["order"] == order) & (points["surface"] == surface)].iloc[0]
    return {
        "type": "scatter",
        "x": [place],
        "y": drawn_life([row["life_km"]]),
        "mode": "markers",
        "name": f"this point, {surface} face",
        "marker": {"symbol": "diamond", "size": 12, "color": ACCENT, "line": {"width": 1.5, "color": PAPER}},
        "hovertemplate": "%{y:.4g} km",
        "cliponaxis": False,
    }


def _unrolled(top: pd.DataFrame) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Arc length with the parts one after the other, and the rows at which a new part begins."""
    arc, part = top["arc_length_mm"].to_numpy(), top["part"].to_numpy()
    breaks = np.flatnonzero(np.diff(part)) + 1
    first = np.concatenate([[0], breaks])
    lengths = np.maximum.reduceat(arc, first)
    begins = np.concatenate([[0.0], np.cumsum(lengths[:-1] + PART_GAP * lengths.sum())])
    return arc + np.repeat(begins, np.diff(np.append(first, len(arc)))), breaks


def _gaps(values: ArrayLike, breaks: NDArray[np.int64]) -> NDArray[np.float32]:
    """Values with a gap before each new part."""
    return single(np.insert(np.asarray(values, dtype=np.float64), breaks, np.nan))


def _symbols(rows: pd.DataFrame, breaks: NDArray[np.int64]) -> str | list[str]:
    """Open circles where a life is a bound, one symbol where none is."""
    bounded = (rows["screened"] != "").to_numpy()
    if not bounded.any():
        return "circle"
    return np.insert(np.where(bounded, "circle-open", "circle"), breaks, "circle").tolist()


def _end_zones(at_end: NDArray[np.bool_], place: NDArray[np.float64]) -> list[tuple[float, float]]:
    """Zones of the treated nodes, half an edge wider where the line goes on."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], at_end, [False]]).astype(np.int8)))
    middle = np.concatenate([place[:1], 0.5 * (place[1:] + place[:-1]), place[-1:]])
    return [(float(middle[a]), float(middle[b])) for a, b in zip(edges[::2], edges[1::2], strict=True)]
