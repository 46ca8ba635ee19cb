"""Figures along one weld line: life, load factor and stresses over the arc length, part after part."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
import plotly.graph_objects as go
from numpy.typing import NDArray
from plotly.subplots import make_subplots

from fatigue.report.figures.style import FACE, FACE_DASH, GRID, INK, MISSED, QUIET, SERIES, TEMPLATE, drawn_life, life_axis
from fatigue.report.wording import number

PART_GAP = 0.03  # of the whole length, between the parts of a weld split at its kinks


def along_weld(
    points: pd.DataFrame, target_km: float, stress: Mapping[str, NDArray[np.float64]] | None = None, event: str = ""
) -> go.Figure:
    """Life, load factor and stress of one weld over its arc length, both faces, with one common axis.

    Parameters
    ----------
    points : rows of the table of nodes of one weld
    target_km : drawn as a line [km]
    stress : standard deviations in one event at the stations of ``points``' top face, in their order [MPa]: any of
        membrane, bending, in-plane shear; None: the largest ranges are drawn instead
    event : name of that event

    Weld ends are shaded, corners marked; faces without a toe are drawn thin.
    """
    top = points[points["surface"] == "top"]
    place, breaks = _unrolled(top)
    third = "stress range [MPa]" if stress is None else "std of stress [MPa]"
    fig = make_subplots(rows=3, cols=1, shared_xaxes=True, vertical_spacing=0.045, row_heights=[0.46, 0.24, 0.30])
    fig.update_layout(template=TEMPLATE, height=560, margin={"l": 76, "r": 20, "t": 34, "b": 50}, hovermode="x unified")

    for face in ("top", "bottom"):
        rows = points[points["surface"] == face]
        toe = bool(rows["toe"].any())
        look = {"color": FACE[face], "width": 2 if toe else 1, "dash": FACE_DASH[face]}
        name = f"{face} face" if toe else f"{face} face, no toe"
        common = {"mode": "lines+markers", "line": look, "marker": {"size": 5 if toe else 3}, "legendgroup": face}
        fig.add_scatter(
            x=_gaps(place, breaks), y=_gaps(drawn_life(rows["life_km"]), breaks), name=name, row=1, col=1,
            customdata=_gaps(rows["node"], breaks), hovertemplate="%{y:.4g} km, node %{customdata:.0f}", **common,
        )  # fmt: skip
        fig.add_scatter(
            x=_gaps(place, breaks), y=_gaps(np.minimum(rows["load_factor"], 1e3), breaks), name=name, showlegend=False,
            row=2, col=1, hovertemplate="%{y:.4g}", **common,
        )  # fmt: skip
        if stress is None:
            fig.add_scatter(
                x=_gaps(place, breaks), y=_gaps(rows["max_range_MPa"], breaks), name=f"largest range, {face}",
                showlegend=False, row=3, col=1, hovertemplate="%{y:.4g} MPa", **common,
            )  # fmt: skip
    for (name, values), dash, colour in zip((stress or {}).items(), ("solid", "dash", "dot"), SERIES, strict=False):
        fig.add_scatter(
            x=_gaps(place, breaks), y=_gaps(values, breaks), mode="lines", line={"dash": dash, "color": colour},
            name=f"{name} stress", row=3, col=1, hovertemplate="%{y:.4g} MPa",
        )  # fmt: skip

    _mark(fig, top, place, points, target_km)
    fig.update_yaxes(title_text="life [km]", row=1, col=1, **life_axis(points["life_km"], target_km))
    fig.update_yaxes(title_text="load factor [-]", row=2, col=1, rangemode="tozero")
    fig.update_yaxes(title_text=third, row=3, col=1, rangemode="tozero")
    fig.update_xaxes(title_text="arc length [mm]" + (f"; stresses in event {event}" if stress else ""), row=3, col=1)
    return fig


def _unrolled(top: pd.DataFrame) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Arc length with the parts one after the other, and the rows at which a new part begins."""
    arc, part = top["arc_length_mm"].to_numpy(), top["part"].to_numpy()
    breaks = np.flatnonzero(np.diff(part)) + 1
    lengths = np.maximum.reduceat(arc, np.concatenate([[0], breaks]))
    gap = PART_GAP * lengths.sum() if len(breaks) else 0.0
    begins = np.concatenate([[0.0], np.cumsum(lengths[:-1] + gap)])
    return arc + np.repeat(begins, np.diff(np.concatenate([[0], breaks, [len(arc)]]))), breaks


def _gaps(values: object, breaks: NDArray[np.int64]) -> NDArray[np.float64]:
    """Insert a gap before each new part."""
    return np.insert(np.asarray(values, dtype=np.float64), breaks, np.nan)


def _mark(fig: go.Figure, top: pd.DataFrame, place: NDArray[np.float64], points: pd.DataFrame, target_km: float) -> None:
    """Draw target, weld ends, corners and the worst point with its numbers."""
    fig.add_hline(y=target_km, line={"color": INK, "width": 1.5}, row=1, col=1)
    fig.add_hline(y=1.0, line={"color": INK, "width": 1.5}, row=2, col=1)
    end = top["at_end"].to_numpy()
    for first, last in _runs(end):
        left = place[first] - (0.0 if first == 0 else 0.5 * (place[first] - place[first - 1]))
        right = place[last] + (0.0 if last == len(place) - 1 else 0.5 * (place[last + 1] - place[last]))
        fig.add_vrect(x0=left, x1=right, fillcolor=GRID, opacity=0.6, line_width=0, layer="below")
    for at in place[top["at_corner"].to_numpy()]:
        fig.add_vline(x=float(at), line={"color": QUIET, "width": 1, "dash": "dot"})
    toes = points[points["toe"]]
    worst = toes.loc[toes["utilisation"].idxmax()]
    at = place[((top["part"] == worst["part"]) & (top["order"] == worst["order"])).to_numpy().argmax()]
    fig.add_scatter(
        x=[float(at)], y=drawn_life([worst["life_km"]]), mode="markers+text", name="worst point",
        marker={"symbol": "circle-open", "size": 13, "color": MISSED if not worst["fulfilled"] else INK, "line": {"width": 2}},
        text=[f"{number(worst['life_km'])} km"], textposition="top center", row=1, col=1, hoverinfo="skip", cliponaxis=False,
    )  # fmt: skip


def _runs(flag: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First and last index of every run of set flags."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flag, [False]]).astype(np.int8)))
    return [(int(a), int(b) - 1) for a, b in zip(edges[::2], edges[1::2], strict=True)]
