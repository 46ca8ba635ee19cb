"""Stability maps: least damping over speed and conicity with the boundary, and boundaries of several vehicles."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.figures.style import INK, PAPER, SERIES, axis, colour_bar, figure, single
from fatigue.report.wording import in_figure
from fatigue.study.graph.stability import StabilityMap
from fatigue.study.graph.vehicle_graph import VehicleGraph
from fatigue.vehicle.critical import Crossing

Floats = NDArray[np.float64]

MOST = 12.0  # % of damping at either end of the colours
APART = (0.075, 0.05)  # of the map: labels closer than that would lie on one another
SLOW_HZ = 3.0  # car bodies hunt below, bogies above
# Red grows, blue decays, white is the boundary: apart for colour-blind readers, and dark where it matters.
DAMPING = [[0.0, "#7f1d17"], [0.25, "#c65a4b"], [0.5, "#fbf6f2"], [0.75, "#8fb7d3"], [1.0, "#1f5f8b"]]
DECADES = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0)
NAMED_FROM = 0.015  # of the map: smaller unstable regions get no name


def stability_figure(of: VehicleGraph) -> Figure:
    """Map of one vehicle: least damping as colour, the boundary, what hunts where, frequencies at the crossings."""
    its = of.map
    percent = np.clip(100.0 * its.damping, -MOST, MOST)
    field = {"x": its.speeds, "y": its.conicities, "type": "contour", "hoverinfo": "skip"}
    bar = colour_bar(
        "least damping [%]",
        tickvals=[-12, -6, 0, 6, 12],
        ticktext=["≤ −12", "−6", "0", "6", "≥ 12"],
        orientation="h",
        y=1.0,
        yanchor="bottom",
        x=0.0,
        xanchor="left",
        len=0.62,
    )
    bar["title"]["side"] = "top"
    colours = {"zmin": -MOST, "zmax": MOST, "colorscale": DAMPING, "colorbar": bar}
    steps = {"start": -MOST, "end": MOST, "size": 1.0}
    data = [
        {**field, "z": single(percent), **colours, "contours": {**steps, "coloring": "fill"}, "line": {"width": 0}},
        _boundary(its, INK, 2.0, ""),
        _hover(its),
        *_crossings(of),
        _own(of),
    ]
    crossed = [(*told, INK) for told in _told_crossings(of)]
    return figure(
        data,
        height=570,
        xaxis=axis("speed [km/h]", range=_ends(its.speeds), showgrid=False),
        yaxis=_conicity_axis(its.conicities),
        annotations=[*_regions(its), *_labels(crossed, its)],
        showlegend=False,
        margin={"l": 64, "r": 12, "t": 70, "b": 48},
    )


def boundaries_figure(graphs: Sequence[VehicleGraph]) -> Figure:
    """Boundaries of some vehicles in one map, and what the contact and the run of each are."""
    colours = dict(zip((g.name for g in graphs), SERIES * len(graphs), strict=False))
    data, crossed = [], []
    for g in graphs:
        data += [_boundary(g.map, colours[g.name], 2.6, in_figure(g.name))]
        data += [_marks(g, colours[g.name])]
        crossed += [(*of, colours[g.name]) for of in _told_crossings(g)[: len(g.over_conicity[0].crossings)]]
    data.append(_own(graphs[0]))
    x = np.concatenate([g.map.speeds for g in graphs])
    y = np.concatenate([g.map.conicities for g in graphs])
    return figure(
        data,
        height=480,
        xaxis=axis("speed [km/h]", range=_ends(x)),
        yaxis=_conicity_axis(y),
        annotations=list(_labels(crossed, graphs[0].map)),
    )


def _conicity_axis(conicities: Floats) -> dict[str, object]:
    """Logarithmic axis of conicities, written as people write them."""
    low, high = float(conicities.min()), float(conicities.max())
    shown = [value for value in DECADES if 0.999 * low <= value <= 1.001 * high]
    return axis(
        "equivalent conicity [-]",
        type="log",
        range=[float(np.log10(low)), float(np.log10(high))],
        tickvals=shown,
        ticktext=[f"{value:g}" for value in shown],
        showgrid=False,
    )


def _ends(values: Floats) -> list[float]:
    return [float(values.min()), float(values.max())]


def _boundary(its: StabilityMap, colour: str, width: float, name: str) -> Trace:
    """Line where the least damping of all roots is zero."""
    z = single(np.clip(100.0 * its.damping, -MOST, MOST))
    return {
        "type": "contour",
        "x": its.speeds,
        "y": its.conicities,
        "z": z,
        "contours": {"start": 0.0, "end": 0.0, "size": 1.0, "coloring": "none"},
        "line": {"color": colour, "width": width},
        "showscale": False,
        "hoverinfo": "skip",
        "name": name,
        "showlegend": bool(name),
    }


def _hover(its: StabilityMap) -> Trace:
    """Invisible points that say what a place of the map is."""
    x, y = (grid.ravel() for grid in np.meshgrid(its.speeds, its.conicities))
    return {
        "type": "scattergl",
        "mode": "markers",
        "x": single(x),
        "y": single(y),
        "marker": {"opacity": 0.0, "size": 9},
        "text": [name.name for row in its.of for name in row],
        "customdata": single(np.column_stack([100.0 * its.damping.ravel(), its.frequency_hz.ravel()])),
        "hovertemplate": "%{x:.0f} km/h, conicity %{y:.3g}<br>%{text}<br>"
        "%{customdata[0]:.1f} % at %{customdata[1]:.2f} Hz<extra></extra>",
    }


def _told_crossings(of: VehicleGraph) -> list[tuple[float, float, float]]:
    """Speed, conicity and frequency of the crossings that are written down: of the run's speed, and over speed."""
    return [
        (*line.point_at(crossing.at), crossing.root.frequency_hz)
        for line in (of.over_conicity[0], *of.over_speed)
        for crossing in line.crossings
    ]


def _labels(crossed: Sequence[tuple[float, float, float, str]], its: StabilityMap) -> Iterator[Trace]:
    """Frequencies beside their crossings; none on top of another."""
    wide, high = np.ptp(its.speeds), np.ptp(np.log10(its.conicities))
    placed: list[tuple[float, float]] = []
    for speed, conicity, hz, colour in crossed:
        x, y = speed / wide, np.log10(conicity) / high
        if all(abs(x - a) > APART[0] or abs(y - b) > APART[1] for a, b in placed):
            placed.append((x, y))
            where = {"x": speed, "y": float(np.log10(conicity)), "xshift": -6, "yshift": 12, "xanchor": "right"}
            look = {
                "showarrow": False,
                "bgcolor": "rgba(255,255,255,0.82)",
                "borderpad": 1,
                "font": {"size": 11, "color": colour},
            }
            yield {**where, **look, "text": f"{hz:.1f} Hz"}


def _crossings(of: VehicleGraph) -> Iterator[Trace]:
    """Crossings of all lines, on the boundary."""
    for line in of.lines:
        places = [(line.point_at(crossing.at), crossing) for crossing in line.crossings]
        if places:
            yield {
                "type": "scatter",
                "mode": "markers",
                "x": [point[0] for point, _ in places],
                "y": [point[1] for point, _ in places],
                "marker": {"size": 7, "color": PAPER, "line": {"color": INK, "width": 1.4}},
                "customdata": [_said(crossing) for _, crossing in places],
                "hovertemplate": "%{x:.4g} km/h, conicity %{y:.4g}<br>%{customdata}<extra></extra>",
            }


def _said(crossing: Crossing) -> str:
    return f"{crossing.change} stability<br>{crossing.root.of.name}, {crossing.root.frequency_hz:.2f} Hz"


def _own(of: VehicleGraph) -> Trace:
    """The point of the vehicle itself."""
    return {
        "type": "scatter",
        "mode": "markers",
        "x": [of.vehicle.run.speed_km_h],
        "y": [of.vehicle.contact.conicity],
        "marker": {"symbol": "star", "size": 14, "color": "#ffd54a", "line": {"color": INK, "width": 1.2}},
        "showlegend": False,
        "hovertemplate": "run and contact of the vehicle<br>%{x:g} km/h, conicity %{y:g}<extra></extra>",
    }


def _marks(of: VehicleGraph, colour: str) -> Trace:
    """Crossings of the first line over conicity, with the frequency."""
    line = of.over_conicity[0]
    return {
        "type": "scatter",
        "mode": "markers",
        "x": [line.at for _ in line.crossings],
        "y": [crossing.at for crossing in line.crossings],
        "marker": {"size": 8, "color": PAPER, "line": {"color": colour, "width": 2}},
        "customdata": [_said(crossing) for crossing in line.crossings],
        "hovertemplate": "%{x:.4g} km/h, conicity %{y:.4g}<br>%{customdata}<extra></extra>",
        "showlegend": False,
    }


def _regions(its: StabilityMap) -> Iterator[Trace]:
    """Names of the unstable regions, each at its innermost point: what hunts there, and between which frequencies."""
    slow = its.frequency_hz < SLOW_HZ
    for kind in (slow, ~slow):
        labels, count = ndimage.label(~its.stable & kind)
        for number in range(1, count + 1):
            inside = labels == number
            if inside.mean() < NAMED_FROM:
                continue
            depth = ndimage.distance_transform_edt(np.pad(inside, 1))[1:-1, 1:-1]
            i, j = np.unravel_index(int(depth.argmax()), depth.shape)
            hz = its.frequency_hz[inside]
            yield {
                "x": float(its.speeds[j]),
                "y": float(np.log10(its.conicities[i])),
                "text": f"<b>{_hunter(its, inside)}</b><br>{hz.min():.1f} to {hz.max():.1f} Hz",
                "showarrow": False,
                "xanchor": "right" if its.speeds[j] > its.speeds[0] + 0.7 * np.ptp(its.speeds) else "center",
                "font": {"size": 12, "color": PAPER if its.damping[inside].mean() < -0.04 else INK},
            }


def _hunter(its: StabilityMap, inside: NDArray[np.bool_]) -> str:
    """What hunts in most points of a region: by the names of the roots, their phase or end left out."""
    names = [its.of[i][j].name.split(" (")[0] for i, j in zip(*np.nonzero(inside), strict=True)]
    name = max(sorted(set(names)), key=names.count)
    return "car body hunts" if name.startswith("car body") else name
