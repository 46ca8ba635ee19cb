"""Figures of virtual gauges: where they are on the body, what they read for some seconds, their range spectra."""

from collections.abc import Sequence

import numpy as np

from fatigue.gauges.histories.counts import GaugeSpectra
from fatigue.gauges.histories.tables import GaugeRow
from fatigue.gauges.instrument import MICROSTRAIN, Floats
from fatigue.gauges.simulated import Reading
from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.figures.scene import BodyOutline, body_traces, space_around
from fatigue.report.figures.style import DASHES, INK, SERIES, axis, figure, log_axis, single
from fatigue.report.wording import in_figure, number

MOST_HISTORIES, MOST_SPECTRA = 6, 12
EXCERPT_S = 4.0
PER_1E6_KM = 1e6
ARROW = 0.025  # of the extent of the body: length of the grids that are drawn
TOGETHER = 2.0  # such lengths: gauges this near to each other have one label
SYMBOL = {"element": "circle", "table": "diamond", "toe": "x"}
NAME = {"element": "on an element", "table": "at a stress point", "toe": "stand-in at a toe"}


def places(rows: Sequence[GaugeRow], lines: Sequence[Floats], body: BodyOutline | None) -> Figure:
    """Gauges over the outline of the body, each with its direction; ``lines`` (n, 3) are the weld lines [mm]."""
    at = np.array([[row.x_mm, row.y_mm, row.z_mm] for row in rows])
    towards = np.array([[row.dir_x, row.dir_y, row.dir_z] for row in rows])
    xyz = np.concatenate([at, *lines] if body is None else [at, body.xyz])
    reach = ARROW * float(np.ptp(xyz, axis=0).max())
    gap = np.full((1, 3), np.nan)
    seams = np.concatenate([part for line in lines for part in (line, gap)] or [gap])
    ends = np.stack([at - reach * towards, at + reach * towards, np.full_like(at, np.nan)], axis=1).reshape(-1, 3)
    data = list(body_traces(body)) if body is not None else []
    for name, points, colour, width in (("weld lines", seams, "#9aa4ae", 4), ("direction", ends, INK, 4)):
        line = {"color": colour, "width": width}
        data.append({"type": "scatter3d", **_xyz(points), "mode": "lines", "name": name, "line": line} | _SILENT)
    for i, kind in enumerate(dict.fromkeys(row.kind for row in rows)):
        own = [n for n, row in enumerate(rows) if row.kind == kind]
        data.append(
            {
                "type": "scatter3d",
                **_xyz(at[own]),
                "mode": "markers",
                "name": NAME[kind],
                "marker": {"size": 5, "symbol": SYMBOL[kind], "color": SERIES[i]},
                "hovertext": [_hover(rows[n]) for n in own],
                "hoverinfo": "text",
            }
        )
    named = _labels(rows, at, TOGETHER * reach)
    names = {"type": "scatter3d", **_xyz(at[list(named)]), "mode": "text", "text": list(named.values())}
    data.append(names | {"textposition": "top center", "textfont": {"size": 11}, "showlegend": False} | _SILENT)
    return figure(data, height=440, margin={"l": 0, "r": 0, "t": 30, "b": 0}, scene=space_around(xyz))


def _labels(rows: Sequence[GaugeRow], at: Floats, apart: float) -> dict[int, str]:
    """Labels by the number of a gauge: of several in one place the first, and how many others."""
    found: dict[int, int] = {}
    for n in range(len(rows)):
        near = next((first for first in found if np.linalg.norm(at[n] - at[first]) < apart), None)
        if near is None:
            found[n] = 0
        else:
            found[near] += 1
    return {n: in_figure(rows[n].gauge, 24) + (f" +{more}" if more else "") for n, more in found.items()}


def excerpts(rows: Sequence[GaugeRow], readings: Sequence[Reading]) -> list[tuple[str, Figure]]:
    """Some seconds of every event around the largest swing of the gauges that read most, about their means."""
    drawn = [n for n in np.argsort([-row.rms_ue for row in rows], kind="stable").tolist() if rows[n].rms_ue > 0.0]
    drawn = drawn[:MOST_HISTORIES]
    found = []
    for reading in readings if drawn else ():
        change = reading.strain[drawn] - reading.strain[drawn].mean(axis=1, keepdims=True)
        middle = int(np.abs(change[0]).argmax())
        half = max(1, round(EXCERPT_S / 2.0 / reading.step))
        first = max(0, min(middle - half, change.shape[1] - 2 * half))
        some = slice(first, first + 2 * half + 1)
        data = [
            _line(rows[n].gauge, i, reading.time[some], change[i, some], "%{x:.4g} s: %{y:.4g}")
            for i, n in enumerate(drawn)
        ]
        title = f"strain about its mean [{MICROSTRAIN}]"
        found.append((reading.event, figure(data, height=300, xaxis=axis("time [s]"), yaxis=axis(title))))
    return found


def exceedance(rows: Sequence[GaugeRow], spectra: Sequence[GaugeSpectra]) -> Figure | None:
    """Strain ranges of the mission over how often they are reached in 1e6 km; None where nothing moves."""
    order = np.argsort([-float(of.largest.max(initial=0.0)) for of in spectra], kind="stable").tolist()
    data: list[Trace] = []
    for n in order[:MOST_SPECTRA]:
        of = spectra[n]
        reached = PER_1E6_KM * of.mission.reached
        there = (reached > 0.0) & (of.edges[:-1] > 0.0)
        if there.any():
            x, y = reached[there], of.edges[:-1][there]
            data.append(_line(rows[n].gauge, len(data), x, y, "%{x:.3g} times: %{y:.4g}"))
    if not data:
        return None
    times = np.concatenate([trace["x"] for trace in data])
    low, high = np.floor(np.log10(times.min())), np.ceil(np.log10(times.max()) + 0.05)
    return figure(
        data,
        height=380,
        xaxis=log_axis("cycles reached or exceeded in 1e6 km [-]", low, high),
        yaxis=axis(f"strain range [{MICROSTRAIN}]", rangemode="tozero"),
    )


_SILENT: Trace = {"hoverinfo": "skip"}


def _xyz(points: Floats) -> Trace:
    return {name: single(values) for name, values in zip("xyz", points.T, strict=True)}


def _hover(row: GaugeRow) -> str:
    at = f"{number(row.x_mm)}, {number(row.y_mm)}, {number(row.z_mm)} mm"
    on = (
        f"element {row.element}, {row.surface}" if row.element else f"{in_figure(row.point or row.weld)}, {row.surface}"
    )
    return f"{in_figure(row.gauge)}<br>{on}<br>{at}<br>rms {number(row.rms_ue)} {MICROSTRAIN}"


def _line(name: str, i: int, x: Floats, y: Floats, hover: str) -> Trace:
    look = {"color": SERIES[i % len(SERIES)], "dash": DASHES[i // len(SERIES) % len(DASHES)], "width": 1.4}
    return {
        "type": "scatter",
        "mode": "lines",
        "name": in_figure(name, 28),
        "x": single(x),
        "y": single(y),
        "line": look,
        "hovertemplate": hover,
    }
