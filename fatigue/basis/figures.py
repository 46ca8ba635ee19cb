"""Figures of a basis: effective mass summed over frequency, dynamic mass over frequency."""

from collections.abc import Sequence

import numpy as np
import plotly.graph_objects as go
from numpy.typing import NDArray

from fatigue.basis.mass.rows import DynamicMass, ModalMass
from fatigue.report.figures.style import DASHES, QUIET, SERIES, Trace, across, axis, figure, log_axis, single

Floats = NDArray[np.float64]


def summed_masses(rows: Sequence[ModalMass]) -> go.Figure | None:
    """Share of the mass that modes up to a frequency carry, one stair for each direction; None without shares."""
    data = []
    for i, direction in enumerate(dict.fromkeys(row.direction for row in rows)):
        of = sorted((r for r in rows if r.direction == direction), key=lambda r: r.frequency_hz)
        share = np.array([row.summed_share for row in of])
        if np.isfinite(share).any():
            f = np.array([row.frequency_hz for row in of])
            data.append(_line(direction, i, np.append(0.0, f), np.append(0.0, share), "%{x:.4g} Hz: %{y:.1%}", "hv"))
    if not data:
        return None
    return figure(
        data,
        height=360,
        xaxis=axis("natural frequency [Hz]", rangemode="tozero"),
        yaxis=axis("summed effective mass over the body's [-]", range=[0.0, 1.05], tickformat=".0%"),
        shapes=[across(1.0, QUIET, 1.0, "dot")],
    )


def dynamic_masses(rows: Sequence[DynamicMass]) -> go.Figure | None:
    """Dynamic mass over frequency: of the whole body where its mass is known, else of its elastic part.

    Along x, y, z in the upper panel, about them in the lower.
    """
    data, panels = [], []
    for panel, (axes, title) in enumerate(((("x", "y", "z"), "[t]"), (("rx", "ry", "rz"), "[t mm2]"))):
        shown = [direction for direction in axes if any(row.direction == direction for row in rows)]
        if shown:
            panels.append((panel, title))
        for direction in shown:
            of = [row for row in rows if row.direction == direction]
            mass = np.array([row.dynamic_mass for row in of])
            whole = bool(np.isfinite(mass).all())
            y = mass if whole else np.array([row.elastic_mass for row in of])
            name = f"{direction}, {'rigid + elastic' if whole else 'elastic'}"
            f = np.array([row.frequency_hz for row in of])
            line = _line(name, axes.index(direction), f[y > 0.0], y[y > 0.0], "%{x:.4g} Hz: %{y:.4g}", "linear")
            data.append(line | {"yaxis": "y" if len(panels) == 1 else "y2"})
    if not data:
        return None
    lows = [np.log10(trace["y"]).min() for trace in data if len(trace["y"])]
    if not lows:
        return None
    layout = {}
    for i, (_, title) in enumerate(panels):
        ys = [trace["y"] for trace in data if trace["yaxis"] == ("y2" if i else "y") and len(trace["y"])]
        low, high = min(np.log10(y).min() for y in ys), max(np.log10(y).max() for y in ys)
        low = max(low, high - 6.0)
        domain = [0.0, 1.0] if len(panels) == 1 else [0.55, 1.0] if i == 0 else [0.0, 0.45]
        name = "yaxis2" if i else "yaxis"
        layout[name] = log_axis(f"dynamic mass {title}", np.floor(low), np.ceil(high), domain=domain)
    return figure(data, height=340 * len(panels), xaxis=axis("frequency [Hz]", rangemode="tozero"), **layout)


def _line(name: str, colour: int, x: Floats, y: Floats, hover: str, shape: str) -> Trace:
    return {
        "type": "scatter",
        "mode": "lines",
        "name": name,
        "x": single(x),
        "y": single(y),
        "line": {"color": SERIES[colour % len(SERIES)], "dash": DASHES[colour // 3], "width": 1.6, "shape": shape},
        "hovertemplate": hover,
    }
