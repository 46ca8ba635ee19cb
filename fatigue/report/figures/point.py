"""Figures of one governing point: cycles, exceedance, S-N curve, spectrum, history and what drives the damage."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
import plotly.graph_objects as go
from numpy.typing import NDArray
from plotly.subplots import make_subplots

from fatigue.life.curves import DamageLaw
from fatigue.life.damage import cycle_damage
from fatigue.report.figures.style import ACCENT, GRID, INK, QUIET, SEQUENTIAL, SERIES, TEMPLATE, event_colours, figure, single
from fatigue.report.signals import Envelope, Excerpt, Spectrum
from fatigue.report.wording import in_figure, number, share

MATRIX_CLASSES = 24
SPECTRUM_CLASSES = 40
PSD_POINTS = 400
STAIRCASE_POINTS = 60


def rainflow_matrices(cycles: pd.DataFrame, per_km: NDArray[np.float64]) -> go.Figure:
    """Rainflow matrix and damage matrix side by side: mean over range in equal classes, empty classes white.

    ``cycles`` has the columns of the table of cycles; ``per_km`` is the number of each cycle in one km [1/km].
    """
    stress_range, mean = cycles["range_MPa"].to_numpy(), cycles["mean_MPa"].to_numpy()
    ranges = np.linspace(0.0, _top(stress_range), MATRIX_CLASSES + 1)
    middle = 0.5 * (mean.min() + mean.max()) if len(mean) else 0.0
    half = max(0.5 * np.ptp(mean) if len(mean) else 0.0, 0.05 * ranges[-1]) * 1.02
    means = np.linspace(middle - half, middle + half, MATRIX_CLASSES + 1)
    count, _, _ = np.histogram2d(mean, stress_range, bins=(means, ranges), weights=per_km * 1e6)
    damage, _, _ = np.histogram2d(mean, stress_range, bins=(means, ranges), weights=per_km * cycles["damage"] / cycles["count"])
    total = damage.sum()
    fig = make_subplots(rows=1, cols=2, shared_yaxes=True, horizontal_spacing=0.17)
    fig.update_layout(template=TEMPLATE, height=340, margin={"l": 72, "r": 20, "t": 14, "b": 52})
    panels = ((count, "cycles in 1e6 km [-]", 0.415), (100.0 * damage / total if total > 0.0 else damage, "share of the damage [%]", 1.0))
    for column, (values, title, bar) in enumerate(panels, start=1):
        filled = np.where(values > 0.0, values, np.nan)
        logs = np.log10(filled)
        high = np.ceil(np.nanmax(logs)) if np.isfinite(logs).any() else 0.0
        low = max(high - 6, np.floor(np.nanmin(logs))) if np.isfinite(logs).any() else -1.0
        fig.add_heatmap(
            x=single(ranges), y=single(means), z=single(np.maximum(logs, low)), zmin=low, zmax=max(high, low + 1),
            colorscale=SEQUENTIAL, reversescale=True, hoverongaps=False, row=1, col=column,
            colorbar={
                "title": {"text": title, "side": "right"}, "x": bar, "xanchor": "left", "thickness": 10, "outlinewidth": 0,
                "tickvals": np.arange(low, high + 1).tolist(), "ticktext": [f"1e{int(d)}" for d in np.arange(low, high + 1)],
            },
            hovertemplate="range %{x:.3g} MPa<br>mean %{y:.3g} MPa<br>10^%{z:.2f}<extra></extra>",
        )  # fmt: skip
        fig.update_xaxes(title_text="stress range [MPa]", row=1, col=column)
    fig.update_yaxes(title_text="mean stress [MPa]", row=1, col=1)
    return fig


def exceedance(cycles: pd.DataFrame, passes_per_km: Mapping[str, float], most: int = 6) -> go.Figure:
    """Range exceedance: how often each stress range is reached in 1e6 km, by event and for the whole mission."""
    colours = event_colours(list(passes_per_km))
    per_km = cycles["event"].map(passes_per_km).to_numpy(dtype=np.float64) * cycles["count"].to_numpy()
    fig = figure(height=340)
    largest = cycles.groupby("event", sort=False)["range_MPa"].max().sort_values(ascending=False, kind="stable")
    drawn = [event for event in passes_per_km if event in set(largest.index[:most])]
    for event in [None, *drawn]:
        mine = np.ones(len(cycles), dtype=bool) if event is None else (cycles["event"] == event).to_numpy()
        x, y = _staircase(cycles["range_MPa"].to_numpy()[mine], 1e6 * per_km[mine])
        fig.add_scatter(
            x=single(x), y=single(y), mode="lines", name="mission" if event is None else in_figure(event),
            line={"shape": "hv", "color": INK if event is None else colours[event], "width": 2.2 if event is None else 1.4},
            hovertemplate="%{x:.3g} cycles of %{y:.4g} MPa and more",
        )  # fmt: skip
    if len(cycles):
        fig.add_annotation(
            x=0.99, y=0.97, xref="paper", yref="paper", showarrow=False, xanchor="right", yanchor="top",
            text=f"largest {number(cycles['range_MPa'].max())} MPa<br>{number(1e6 * per_km.sum())} cycles in 1e6 km", align="right",
        )  # fmt: skip
    fig.update_xaxes(title_text="cycles reached or exceeded in 1e6 km [-]", type="log", dtick=1)
    fig.update_yaxes(title_text="stress range [MPa]", rangemode="tozero")
    return fig


def sn_with_spectrum(
    cycles: pd.DataFrame, per_target: NDArray[np.float64], laws: Mapping[str, DamageLaw], used: str, unit: str
) -> go.Figure:
    """S-N curves at their survival levels with the spectrum of equivalent ranges of the target mileage on them.

    Parameters
    ----------
    cycles : rows of the table of cycles of one point
    per_target : number of each cycle over the target mileage [-]
    laws : damage law of each survival level
    used : the level of the assessment
    unit : of the equivalent range
    """
    x = cycles["equivalent_range_dS"].to_numpy()
    x_max = _top(x)
    edges = np.geomspace(x_max * 1e-3, x_max, SPECTRUM_CLASSES + 1)
    number_in, _ = np.histogram(np.maximum(x, edges[0]), bins=edges, weights=per_target)
    damage = number_in * cycle_damage(np.sqrt(edges[1:] * edges[:-1]), laws[used])
    middles = np.sqrt(edges[1:] * edges[:-1])
    filled = number_in > 0.0
    ranges = np.geomspace(x_max * 1e-2, x_max * 30, 60)
    fig = figure(height=340)
    for i, (level, law) in enumerate(laws.items()):
        per_cycle = cycle_damage(ranges, law)
        cycles_to_failure = np.divide(1.0, per_cycle, out=np.full_like(per_cycle, np.nan), where=per_cycle > 0.0)
        fig.add_scatter(
            x=single(cycles_to_failure), y=single(ranges), mode="lines", name=f"{level}, used" if level == used else level,
            line={"color": INK if level == used else QUIET, "width": 2.4 if level == used else 1, "dash": ("solid", "dash", "dot", "dashdot")[i % 4]},
            hovertemplate="%{x:.3g} cycles at %{y:.4g}",
        )  # fmt: skip
    fig.add_scatter(
        x=single(number_in[filled]), y=single(middles[filled]), mode="markers", name="cycles in target_km per class",
        marker={
            "size": 8, "color": single(100 * damage[filled] / max(damage.sum(), 1e-300)), "colorscale": SEQUENTIAL, "reversescale": True,
            "cmin": 0, "line": {"width": 0.5, "color": INK},
            "colorbar": {"title": {"text": "share of the damage [%]", "side": "right"}, "thickness": 10, "outlinewidth": 0},
        },
        hovertemplate="%{x:.4g} cycles of %{y:.4g}<br>%{marker.color:.3g} % of the damage",
    )  # fmt: skip
    high = max(float(number_in.max(initial=1.0)), 1e6)
    fig.update_xaxes(title_text="cycles [-]", type="log", range=[0, float(np.log10(high)) + 3], dtick=2)
    fig.update_yaxes(title_text=f"equivalent range [{unit}]", type="log")
    return fig


def stress_spectrum(
    spectra: Sequence[Spectrum], colours: Mapping[str, str], modes: Mapping[int, tuple[float, float]], governing: str
) -> go.Figure:
    """Stress spectra of the events with the natural frequencies that matter, and the cumulative variance below.

    ``modes`` gives frequency [Hz] and share of the variance of each mode to be marked; the cumulative variance is that of
    the governing event.
    """
    fig = make_subplots(rows=2, cols=1, shared_xaxes=True, vertical_spacing=0.05, row_heights=[0.68, 0.32])
    fig.update_layout(template=TEMPLATE, height=400, margin={"l": 76, "r": 20, "t": 34, "b": 50})
    peak = max((float(s.density.max()) for s in spectra), default=1.0)
    for s in spectra:
        frequency, density = _thinned(s.frequency[1:], s.density[1:])
        look = {"color": colours[s.event], "width": 2 if s.event == governing else 1.2}
        fig.add_scatter(
            x=single(frequency), y=single(np.maximum(density, peak * 1e-9)), mode="lines", name=in_figure(s.event), line=look,
            hovertemplate="%{x:.3g} Hz: %{y:.3g} MPa²/Hz", row=1, col=1,
        )  # fmt: skip
        if s.event == governing:
            variance = np.cumsum(s.density)
            part = variance / max(float(variance[-1]), 1e-300)
            x, y = _thinned(s.frequency[1:], part[1:])
            fig.add_scatter(
                x=single(x), y=single(y), mode="lines", line=look, showlegend=False, row=2, col=1,
                hovertemplate="%{y:.1%} of the variance below %{x:.3g} Hz<extra></extra>",
            )  # fmt: skip
    for mode, (frequency, part) in modes.items():
        fig.add_vline(x=frequency, line={"color": QUIET, "width": 1, "dash": "dot"})
        fig.add_annotation(
            x=float(np.log10(frequency)), y=1, yref="y domain", xref="x", text=f"mode {mode}, {frequency:.4g} Hz, {share(part)}",
            textangle=-90, xanchor="left", yanchor="top", showarrow=False, font={"size": 10, "color": QUIET},
        )  # fmt: skip
    low = np.log10(min((float(s.frequency[1]) for s in spectra if len(s.frequency) > 1), default=0.1))
    fig.update_xaxes(type="log", range=[max(low, -1.0), _log_top(spectra)])
    fig.update_xaxes(title_text="frequency [Hz]", row=2, col=1)
    fig.update_yaxes(title_text="PSD [MPa²/Hz]", type="log", row=1, col=1, range=[np.log10(peak) - 6, np.log10(peak) + 0.4])
    fig.update_yaxes(title_text="variance [%]", tickformat=".0%", range=[0, 1.02], row=2, col=1)
    return fig


def stress_history(envelope: Envelope, excerpt: Excerpt, frequencies: Mapping[int, float], colour: str) -> go.Figure:
    """Stress over the whole record of an event, and close by around its most damaging cycle with the parts of the modes.

    ``frequencies`` [Hz] of the modes in the excerpt; their parts are drawn about the mean.
    """
    fig = make_subplots(rows=2, cols=1, vertical_spacing=0.17, row_heights=[0.38, 0.62])
    fig.update_layout(template=TEMPLATE, height=440, margin={"l": 72, "r": 20, "t": 34, "b": 50})
    both = np.column_stack([envelope.low, envelope.high]).ravel()
    fig.add_scatter(
        x=single(np.repeat(envelope.time, 2)), y=single(both), mode="lines", line={"color": colour, "width": 1},
        name="structural stress, whole record", showlegend=False, row=1, col=1, hovertemplate="%{x:.4g} s: %{y:.4g} MPa<extra></extra>",
    )  # fmt: skip
    fig.add_vrect(
        x0=float(excerpt.time[0]), x1=float(excerpt.time[-1]), fillcolor=GRID, opacity=0.8, line_width=0, layer="below", row=1, col=1
    )
    fig.add_scatter(
        x=single(excerpt.time), y=single(excerpt.stress), mode="lines", line={"color": INK, "width": 2}, name="structural stress",
        row=2, col=1, hovertemplate="%{x:.5g} s: %{y:.4g} MPa",
    )  # fmt: skip
    for (mode, part), look in zip(excerpt.parts.items(), SERIES, strict=False):
        fig.add_scatter(
            x=single(excerpt.time), y=single(part), mode="lines", line={"width": 1.2, "color": look},
            name=f"mode {mode} ({frequencies[mode]:.4g} Hz)", row=2, col=1, hovertemplate="%{y:.4g} MPa",
        )  # fmt: skip
    at = [int(np.abs(excerpt.time - t).argmin()) for t in (excerpt.start_s, excerpt.end_s)]
    fig.add_scatter(
        x=single(excerpt.time[at]), y=single(excerpt.stress[at]), mode="markers+text", name="the cycle",
        marker={"symbol": "circle-open", "size": 11, "color": ACCENT, "line": {"width": 2}},
        text=[f"{number(v)} MPa" for v in excerpt.stress[at]], textposition="middle right", row=2, col=1, hoverinfo="skip",
    )  # fmt: skip
    fig.update_xaxes(title_text="time of the record [s]", row=2, col=1)
    for row in (1, 2):
        fig.update_yaxes(title_text="stress [MPa]", row=row, col=1)
    return fig


def shares(labels: Sequence[str], values: NDArray[np.float64], title: str) -> go.Figure:
    """Bars of shares, the largest on top; a negative one relieves."""
    fig = figure(height=70 + 24 * max(len(labels), 2), showlegend=False, margin={"l": 20, "r": 50, "t": 10, "b": 46})
    rows = list(range(len(labels)))
    fig.add_bar(
        y=rows, x=single(values), orientation="h", marker={"color": np.where(values < 0.0, QUIET, ACCENT)},
        text=[share(v) for v in values], textposition="outside", cliponaxis=False, hoverinfo="skip",
    )  # fmt: skip
    fig.update_xaxes(title_text=title, tickformat=".0%", rangemode="tozero")
    fig.update_yaxes(tickvals=rows, ticktext=[in_figure(n, 44) for n in labels], autorange="reversed", showgrid=False, automargin=True)
    return fig


def _staircase(ranges: NDArray[np.float64], counts: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Cumulative count from the largest range down, thinned to equal steps of the logarithm of the count."""
    by_range = np.argsort(-ranges, kind="stable")
    y, x = ranges[by_range], np.cumsum(counts[by_range])
    if len(x) > STAIRCASE_POINTS and x[0] > 0.0:
        wanted = np.geomspace(x[0], x[-1], STAIRCASE_POINTS)
        keep = np.unique(np.minimum(np.searchsorted(x, wanted), len(x) - 1))
        x, y = x[keep], y[keep]
    return x, y


def _thinned(x: NDArray[np.float64], y: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Keep the largest value of each of many equal spans of log x, so that no peak is lost."""
    if len(x) <= PSD_POINTS:
        return x, y
    span = np.floor(np.interp(np.log(x), np.log(x[[0, -1]]), [0.0, PSD_POINTS - 1e-9]))
    first = np.flatnonzero(np.diff(span, prepend=-1.0))
    return x[[a + int(y[a:b].argmax()) for a, b in zip(first, [*first[1:], len(x)], strict=True)]], np.maximum.reduceat(y, first)


def _top(values: NDArray[np.float64]) -> float:
    """Upper limit of a scale that holds all values and is never zero."""
    highest = float(values.max()) if len(values) else 0.0
    return highest * 1.0001 if highest > 0.0 else 1.0


def _log_top(spectra: Sequence[Spectrum]) -> float:
    return float(np.log10(max((float(s.frequency[-1]) for s in spectra), default=100.0)))
