"""Figures of the load spectra of one point: exceedance, matrices of classes, level crossings."""

from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.report.figures.cycles import corner_note, counts_matrix
from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.figures.given import ResultTable, frame_of
from fatigue.report.figures.style import INK, MISSED, QUIET, axis, event_colours, figure, log_axis, single
from fatigue.report.wording import in_figure, number

Floats = NDArray[np.float64]

MISSION, MEASURED = "(mission)", "(measured)"
MOST_EVENTS = 6
PER_1E6_KM = 1e6


def spectrum_exceedance(spectrum: ResultTable, events: Sequence[str] = ()) -> Figure:
    """Exceedance of stress ranges in 1e6 km in logarithmic axes: mission, its events, and what was measured.

    Parameters
    ----------
    spectrum : rows of one point of the table of this name
    events : all events of the mission, whose colours are those of the other figures; by default those of the table
    """
    columns = ("event", "lower_MPa", "upper_MPa", "count_per_km", "max_MPa", "exceedance_per_1e6_km")
    spectrum = frame_of(spectrum, "spectrum", columns)
    largest = spectrum.groupby("event", sort=False)["max_MPa"].max()
    data = [
        _line(name, *_reached(spectrum[spectrum["event"] == name]), look)
        for name, look in _looks(spectrum["event"], largest, events)
    ]
    data = [trace for trace in data if len(trace["x"])]
    x = np.concatenate([np.zeros(0), *(trace["x"] for trace in data)])
    y = np.concatenate([np.zeros(0), *(trace["y"] for trace in data)])
    low, high = (np.log10(x.min()), np.log10(x.max())) if len(x) else (0.0, 1.0)
    bottom, top = (np.log10(y.min()), np.log10(y.max())) if len(y) else (0.0, 1.0)
    notes = [
        f"{name.strip('()')}: largest {number(largest[name])} MPa" for name in (MISSION, MEASURED) if name in largest
    ]
    return figure(
        data,
        height=340,
        xaxis=log_axis("cycles reached or exceeded in 1e6 km [-]", np.floor(low), np.ceil(high + 0.05)),
        yaxis=axis("stress range [MPa]", type="log", range=[bottom - 0.05, top + 0.1], tickvals=_one_two_five(y)),
        annotations=[corner_note("<br>".join(notes))],
    )


def _one_two_five(values: Floats) -> list[float]:
    """Ticks 1, 2, 5, 10 ... of a logarithmic axis over some values."""
    if not len(values):
        return [1.0, 10.0]
    decades = range(int(np.floor(np.log10(values.min()))), int(np.ceil(np.log10(values.max()))) + 1)
    return [step * 10.0**decade for decade in decades for step in (1, 2, 5)]


def _reached(rows: pd.DataFrame) -> tuple[Floats, Floats]:
    """Exceedances, and the ranges they are of: the lower edges above 0, and the largest range at the end."""
    reached, lower = rows["exceedance_per_1e6_km"].to_numpy(), rows["lower_MPa"].to_numpy()
    top = rows["max_MPa"].max()
    there = (reached > 0.0) & (lower > 0.0) & ~(lower > top)
    last = rows.loc[rows["max_MPa"] == top, "count_per_km"].to_numpy()[-1:] * PER_1E6_KM
    end = last[last > 0.0]
    return np.append(reached[there], end), np.append(lower[there], np.full(len(end), top))


def class_matrices(range_mean: ResultTable, from_to: ResultTable) -> Figure:
    """Range-mean matrix and from-to matrix side by side: cycles in 1e6 km, empty classes white.

    Both take rows of one point and one event of the tables of these names.
    """
    means = frame_of(range_mean, "range_mean", _edges("range", "mean"))
    reversals = frame_of(from_to, "from_to", _edges("from", "to"))
    title = "cycles in 1e6 km [-]"
    return figure(
        [
            counts_matrix(*_grid(means, "range", "mean"), "x", title, 0.43),
            counts_matrix(*_grid(reversals, "from", "to"), "x2", title, 1.0) | {"yaxis": "y2"},
        ],
        height=330,
        margin={"l": 70, "r": 16, "t": 10, "b": 50},
        xaxis=axis("stress range [MPa]", domain=[0.0, 0.41]),
        xaxis2=axis("first reversal [MPa]", domain=[0.6, 0.985], anchor="y2"),
        yaxis=axis("mean stress [MPa]"),
        yaxis2=axis("second reversal [MPa]", anchor="x2"),
    )


def _edges(row: str, column: str) -> tuple[str, ...]:
    return (*(f"{name}_{end}_MPa" for name in (row, column) for end in ("lower", "upper")), "count_per_km")


def _grid(cells: pd.DataFrame, row: str, column: str) -> tuple[Floats, Floats, Floats]:
    """Edges of both, and counts between them, of cells as a table lists them; classes without cycles may be joined."""
    edges = []
    for name in (row, column):
        edges.append(np.unique(cells[[f"{name}_lower_MPa", f"{name}_upper_MPa"]].to_numpy()))
    counts = np.zeros((len(edges[1]) - 1, len(edges[0]) - 1))
    at = [np.searchsorted(of, cells[f"{name}_lower_MPa"]) for of, name in zip(edges, (row, column), strict=True)]
    counts[at[1], at[0]] = PER_1E6_KM * cells["count_per_km"].to_numpy()
    return edges[0], edges[1], counts


def crossings_by_level(level_crossings: ResultTable, events: Sequence[str] = ()) -> Figure:
    """How often each stress level is crossed upwards in 1e6 km, by event and for the mission.

    ``level_crossings`` are rows of one point of the table of this name; ``events`` as in ``spectrum_exceedance``.
    """
    rows = frame_of(level_crossings, "level_crossings", ("event", "level_MPa", "up_crossings_per_km"))
    reached = rows[rows["up_crossings_per_km"] > 0.0].groupby("event", sort=False)["level_MPa"]
    data, span = [], reached.max() - reached.min()
    for name, look in _looks(rows["event"], span, events):
        of_event = rows[rows["event"] == name]
        crossed = PER_1E6_KM * of_event["up_crossings_per_km"].to_numpy()
        there = crossed > 0.0
        if there.any():
            data.append(_line(name, crossed[there], of_event["level_MPa"].to_numpy()[there], look))
    x = np.concatenate([np.ones(1) if not data else np.zeros(0), *(trace["x"] for trace in data)])
    return figure(
        data,
        height=340,
        xaxis=log_axis(
            "crossings upwards in 1e6 km [-]", np.floor(np.log10(x.min())), np.ceil(np.log10(x.max()) + 0.05)
        ),
        yaxis=axis("stress level [MPa]"),
    )


def _looks(event: pd.Series, size: pd.Series, events: Sequence[str]) -> Iterator[tuple[str, Trace]]:
    """Names that are drawn and their lines: mission, the largest of its events, what was measured."""
    names = list(dict.fromkeys(event))
    own = [name for name in names if name not in (MISSION, MEASURED)]
    colours = event_colours(list(events) or [name for name in own if not name.startswith("(")])
    if MISSION in names:
        yield MISSION, {"color": INK, "width": 2.2}
    largest = set(size.reindex(own).sort_values(ascending=False, kind="stable").index[:MOST_EVENTS])
    for name in (name for name in own if name in largest):
        yield name, {"color": colours.get(name, QUIET), "width": 1.4, "dash": "solid" if name in colours else "dot"}
    if MEASURED in names:
        yield MEASURED, {"color": MISSED, "width": 2.2, "dash": "dash"}


def _line(name: str, x: Floats, y: Floats, look: Trace) -> Trace:
    shown = name.strip("()") if name in (MISSION, MEASURED) else in_figure(name)
    return {
        "type": "scatter",
        "x": single(x),
        "y": single(y),
        "mode": "lines",
        "name": shown,
        "line": look,
        "hovertemplate": "%{x:.3g} at %{y:.4g} MPa",
    }
