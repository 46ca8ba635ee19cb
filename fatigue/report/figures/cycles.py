"""Figures of the cycles of one point: rainflow and damage matrix, exceedance, S-N curve with the spectrum on it."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.life.curves import DamageLaw
from fatigue.life.rule import cycle_damage
from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.figures.given import ResultTable, check_known, check_one_each, frame_of
from fatigue.report.figures.style import (
    DASHES,
    INK,
    QUIET,
    SEQUENTIAL,
    SHARES,
    axis,
    colour_bar,
    event_colours,
    figure,
    log_axis,
    power,
    single,
)
from fatigue.report.wording import in_figure, number

MATRIX_CLASSES = 24
DECADES_SHOWN = 5  # of counts and damage in the matrices
CLASSES_PER_DECADE = 8  # of equivalent ranges on the S-N curve
STAIRS = 60


def rainflow_matrices(cycles: ResultTable, per_km: NDArray[np.float64]) -> Figure:
    """Rainflow matrix and damage matrix side by side: mean over range in equal classes, empty classes white.

    ``cycles`` has the columns of the table of cycles; ``per_km`` (c,) is how often each cycle occurs [1/km].
    """
    cycles = frame_of(cycles, "cycles", ("range_MPa", "mean_MPa", "damage", "count"))
    check_one_each(per_km, cycles, "per_km")
    stress_range, mean = cycles["range_MPa"].to_numpy(), cycles["mean_MPa"].to_numpy()
    ranges = np.linspace(0.0, 1.001 * stress_range.max(), MATRIX_CLASSES + 1)
    half = max(0.5 * float(np.ptp(mean)), 0.05 * ranges[-1]) * 1.02
    means = 0.5 * (mean.min() + mean.max()) + np.linspace(-half, half, MATRIX_CLASSES + 1)
    damage_per_km = per_km * (cycles["damage"] / cycles["count"]).to_numpy()
    count, _, _ = np.histogram2d(mean, stress_range, bins=(means, ranges), weights=1e6 * per_km)
    damage, _, _ = np.histogram2d(mean, stress_range, bins=(means, ranges), weights=damage_per_km)
    parts = 100.0 * damage / damage.sum() if damage.sum() > 0.0 else damage
    return figure(
        [
            counts_matrix(ranges, means, count, "x", "cycles in 1e6 km [-]", 0.44),
            counts_matrix(ranges, means, parts, "x2", "share of the damage [%]", 1.0),
        ],
        height=330,
        margin={"l": 70, "r": 16, "t": 10, "b": 50},
        xaxis=axis("stress range [MPa]", domain=[0.0, 0.42]),
        xaxis2=axis("stress range [MPa]", domain=[0.58, 0.985]),
        yaxis=axis("mean stress [MPa]"),
    )


def counts_matrix(
    ranges: NDArray[np.float64], means: NDArray[np.float64], values: NDArray[np.float64], x: str, title: str, bar: float
) -> Trace:
    """Heat map of counts (row, column) between edges, by the logarithm; ``x`` names its axis, ``bar`` is its place."""
    logs = np.log10(values, out=np.full_like(values, np.nan), where=values > 0.0)
    high = float(np.ceil(np.nanmax(logs, initial=-9.0)))
    decades = np.arange(high - DECADES_SHOWN, high + 1)
    return {
        "type": "heatmap",
        "x": single(ranges),
        "y": single(means),
        "z": single(np.maximum(logs, decades[0])),
        "xaxis": x,
        "zmin": decades[0],
        "zmax": high,
        "colorscale": SEQUENTIAL,
        "reversescale": True,
        "hoverongaps": False,
        "colorbar": colour_bar(
            title, x=bar, xanchor="left", tickvals=decades, ticktext=[power(int(d)) for d in decades]
        ),
        "hovertemplate": "range %{x:.3g} MPa<br>mean %{y:.3g} MPa<br>10<sup>%{z:.2f}</sup><extra></extra>",
    }


def exceedance(cycles: ResultTable, passes_per_km: Mapping[str, float], most: int = 6) -> Figure:
    """Range exceedance: how often each stress range is reached in 1e6 km, by event and for the whole mission.

    ``cycles`` has the columns of the table of cycles; ``most`` events, those with the largest ranges, are drawn.
    """
    cycles = frame_of(cycles, "cycles", ("event", "range_MPa", "count"))
    check_known(cycles["event"].unique(), passes_per_km, "passes_per_km", "event")
    colours = event_colours(list(passes_per_km))
    ranges = cycles["range_MPa"].to_numpy()
    codes, events = pd.factorize(cycles["event"])
    passes = np.array([passes_per_km[event] for event in events])
    count = 1e6 * passes[codes] * cycles["count"].to_numpy()
    largest = np.full(len(events), -np.inf)
    np.maximum.at(largest, codes, ranges)
    event = {events[code]: codes == code for code in np.argsort(-largest, kind="stable")[:most]}
    data = [_stairs(ranges, count, "mission", INK, 2.2)]
    for name in (name for name in passes_per_km if name in event):
        at = event[name]
        if (count[at] < 0.0).any():  # a sequence: a difference, which is in the line of the mission
            continue
        data.append(_stairs(ranges[at], count[at], in_figure(name), colours[name], 1.4))
    text = f"largest {number(ranges.max())} MPa<br>{number(count.sum())} cycles in 1e6 km"
    reached = [float(d["x"][0]) for d in data if len(d["x"]) and d["x"][0] > 0.0]
    x = log_axis(
        "cycles reached or exceeded in 1e6 km [-]",
        np.floor(np.log10(min(reached))),
        np.ceil(np.log10(max(count.sum(), 1.0)) + 0.05),
    )
    return figure(
        data, height=340, xaxis=x, yaxis=axis("stress range [MPa]", rangemode="tozero"), annotations=[corner_note(text)]
    )


def _stairs(ranges: NDArray[np.float64], count: NDArray[np.float64], name: str, colour: str, width: float) -> Trace:
    """Cumulative count from the largest range down, thinned to equal steps of its logarithm."""
    x, y = cumulative(ranges, count)
    return {
        "type": "scatter",
        "x": single(x),
        "y": single(y),
        "mode": "lines",
        "name": name,
        "line": {"shape": "hv", "color": colour, "width": width},
        "hovertemplate": "%{x:.3g} cycles of %{y:.4g} MPa and more",
    }


def cumulative(
    ranges: NDArray[np.float64], count: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """How often ranges are reached or exceeded, and these ranges, from the largest down; at most ``STAIRS`` steps."""
    by_range = np.argsort(-ranges, kind="stable")
    y, x = ranges[by_range], np.maximum.accumulate(np.cumsum(count[by_range]))  # rounding of what replaces cycles
    if len(x) > STAIRS and x[0] > 0.0:
        keep = np.unique(np.minimum(np.searchsorted(x, np.geomspace(x[0], x[-1], STAIRS)), len(x) - 1))
        x, y = x[keep], y[keep]
    return x, y


def sn_with_spectrum(
    cycles: ResultTable, per_target: NDArray[np.float64], laws: Mapping[str, DamageLaw], used: str, unit: str
) -> Figure:
    """S-N curves at their survival levels with the cumulative spectrum of the target mileage on them.

    Parameters
    ----------
    cycles : rows of the table of cycles of one point
    per_target : how often each cycle occurs over the target mileage [-]
    laws : damage law of each survival level
    used : the level of the assessment
    unit : of the equivalent range

    The marks on the spectrum are classes of equal ratio, coloured by the damage of the cycles in them.
    """
    cycles = frame_of(cycles, "cycles", ("equivalent_range_dS", "damage", "count"))
    check_one_each(per_target, cycles, "per_target")
    check_known([used], laws, "laws", "survival level")
    x = cycles["equivalent_range_dS"].to_numpy()
    largest = float(x.max())
    edges = largest * 10.0 ** (-np.arange(2 * CLASSES_PER_DECADE, -1, -1) / CLASSES_PER_DECADE)
    damage, _ = np.histogram(x, bins=edges, weights=per_target * (cycles["damage"] / cycles["count"]).to_numpy())
    reached = np.array([per_target[x >= edge].sum() for edge in edges[:-1]])
    ranges = np.geomspace(edges[0], 30.0 * largest, 60)
    data = [_curve(law, ranges, level, used, DASHES[i % len(DASHES)]) for i, (level, law) in enumerate(laws.items())]
    data.append(
        {
            "type": "scatter",
            "x": single(reached),
            "y": single(edges[:-1]),
            "mode": "lines+markers",
            "name": "cycles reached or exceeded",
            "line": {"color": QUIET, "width": 1},
            "marker": {
                "size": 9,
                "color": single(100.0 * damage / damage.sum() if damage.sum() > 0.0 else damage),
                "colorscale": SHARES,
                "cmin": 0,
                "line": {"width": 0.6, "color": INK},
                "colorbar": colour_bar("share of the damage [%]"),
            },
            "hovertemplate": "%{x:.4g} cycles of %{y:.4g} and more<br>class: %{marker.color:.3g} % of the damage",
        }
    )
    y = log_axis(f"equivalent range [{unit}]", float(np.log10(edges[0])), float(np.log10(30.0 * largest)))
    return figure(
        data, height=340, xaxis=log_axis("cycles [-]", 2.0, max(10.0, np.ceil(np.log10(reached.max())) + 1)), yaxis=y
    )


def _curve(law: DamageLaw, ranges: NDArray[np.float64], level: str, used: str, dash: str) -> Trace:
    per_cycle = cycle_damage(ranges, law)
    to_failure = np.divide(1.0, per_cycle, out=np.full_like(per_cycle, np.nan), where=per_cycle > 0.0)
    return {
        "type": "scatter",
        "x": single(to_failure),
        "y": single(ranges),
        "mode": "lines",
        "name": f"{level}, used" if level == used else level,
        "line": {"color": INK if level == used else QUIET, "width": 2.4 if level == used else 1, "dash": dash},
        "hovertemplate": "%{x:.3g} cycles at %{y:.4g}",
    }


def corner_note(text: str) -> Trace:
    """Note in the upper right corner: the numbers that pointing would show, for paper."""
    place = {"x": 0.99, "y": 0.98, "xref": "paper", "yref": "paper", "xanchor": "right", "yanchor": "top"}
    return {**place, "text": text, "align": "right", "showarrow": False, "bgcolor": "rgba(255,255,255,0.8)"}
