"""Figures of one gauge: histories around the largest cycles, spectra, exceedance, samples around spikes."""

from collections.abc import Sequence
from html import escape

import numpy as np
from numpy.typing import NDArray

from fatigue.gauges.correlated.compared import Comparison
from fatigue.gauges.correlated.flag_rows import SpikeShown
from fatigue.gauges.instrument import MICROSTRAIN
from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.figures.style import MISSED, QUIET, SERIES, axis, figure, log_axis, single
from fatigue.shown import shortened, visible

Floats = NDArray[np.float64]

COLOUR = {"measured": SERIES[1], "simulated": SERIES[0]}
DASH = {"measured": "solid", "simulated": "dash"}
MOST_DECADES = 6.0  # of density and exceedance


def histories(one: Comparison) -> Figure | None:
    """Strain of both sides around the largest cycles; None without any.

    Aligned sides lie on each other. Others are two places of two records: one above the other, on one scale.
    """
    excerpts = one.drawn.excerpts
    if not excerpts:
        return None
    data = [_line(e.side, e.time, e.strain, f"%{{x:.4g}} s: %{{y:.4g}} {MICROSTRAIN}") for e in excerpts]
    if one.alignment is not None:
        title = axis("time of the simulation [s]")
        return figure(data, height=300, xaxis=title, yaxis=axis(f"strain in the band [{MICROSTRAIN}]"))
    largest = 1.05 * max(float(np.nanmax(np.abs(e.strain))) for e in excerpts) or 1.0
    layout: dict[str, Trace] = {}
    for trace, name, domain in zip(data, ("", "2"), ([0.54, 1.0], [0.0, 0.46]), strict=False):
        trace.update(yaxis=f"y{name}", line=trace["line"] | {"dash": "solid"})
        layout[f"yaxis{name}"] = axis(f"strain [{MICROSTRAIN}]", domain=domain, range=[-largest, largest])
    title = axis("time from the middle of the largest cycle [s]", anchor=data[-1]["yaxis"])
    return figure(data, height=420, xaxis=title, **layout)


def densities(one: Comparison) -> Figure:
    """Power spectral density of both sides."""
    drawn = one.drawn
    both = (("measured", drawn.measured_density), ("simulated", drawn.simulated_density))
    unit = f"({MICROSTRAIN})²/Hz"
    data = [_line(side, drawn.frequency[1:], _above(y[1:]), f"%{{x:.4g}} Hz: %{{y:.4g}} {unit}") for side, y in both]
    low, high = _decades([y for _, y in both])
    return figure(
        data,
        height=320,
        xaxis=axis("frequency [Hz]"),
        yaxis=log_axis(f"power spectral density [{unit}]", low, high),
    )


def exceedances(one: Comparison) -> Figure:
    """Ranges over how often they are reached in a km, both sides."""
    drawn = one.drawn
    both = (("measured", drawn.measured_reached), ("simulated", drawn.simulated_reached))
    data = [_line(side, _above(n), drawn.level, f"%{{y:.4g}} {MICROSTRAIN}: %{{x:.4g}} per km") for side, n in both]
    low, high = _decades([n for _, n in both])
    top = 1.05 * float(drawn.level[-1])
    return figure(
        data,
        height=320,
        xaxis=log_axis("cycles per km that reach the range [1/km]", low, high),
        yaxis=axis(f"strain range [{MICROSTRAIN}]", range=[0.0, top]),
    )


def spike_samples(spikes: Sequence[SpikeShown]) -> Figure | None:
    """Raw samples around the largest spikes, one panel each; None without any."""
    if not spikes:
        return None
    columns = min(3, len(spikes))
    rows = -(-len(spikes) // columns)
    data: list[Trace] = []
    layout: dict[str, Trace] = {}
    notes = []
    for i, spike in enumerate(spikes):
        name = "" if i == 0 else str(i + 1)
        row, column = divmod(i, columns)
        across, down = _share(column, columns, 0.06), _share(rows - 1 - row, rows, 0.14)
        middle = float(spike.time[spike.marked].mean())
        layout[f"xaxis{name}"] = axis("", domain=across, anchor=f"y{name}", nticks=3)
        layout[f"yaxis{name}"] = axis(
            f"raw [{MICROSTRAIN}]" if column == 0 else "", domain=down, anchor=f"x{name}", nticks=4
        )
        data += [
            _samples(name, spike, np.ones_like(spike.marked), QUIET, "lines+markers"),
            _samples(name, spike, spike.marked, MISSED, "markers"),
        ]
        notes.append(
            {
                "text": f"{middle:.3f} s",
                "xref": f"x{name} domain",
                "yref": f"y{name} domain",
                "x": 0.0,
                "y": 1.02,
                "xanchor": "left",
                "yanchor": "bottom",
                "showarrow": False,
                "font": {"size": 11},
            }
        )
    return figure(data, height=60 + 170 * rows, showlegend=False, annotations=notes, **layout)


def _line(side: str, x: Floats, y: Floats, hover: str) -> Trace:
    return {
        "type": "scatter",
        "mode": "lines",
        "name": side,
        "x": single(x),
        "y": single(y),
        "line": {"color": COLOUR[side], "dash": DASH[side], "width": 1.5},
        "hovertemplate": hover,
    }


def _samples(panel: str, spike: SpikeShown, which: NDArray[np.bool_], colour: str, mode: str) -> Trace:
    record = escape(shortened(visible(spike.record), 40))
    return {
        "type": "scatter",
        "mode": mode,
        "x": spike.time[which].tolist(),  # seconds of a long record want double precision
        "y": single(spike.strain[which]),
        "xaxis": f"x{panel}",
        "yaxis": f"y{panel}",
        "line": {"color": colour, "width": 1},
        "marker": {"color": colour, "size": 6 if mode == "markers" else 3},
        "hovertemplate": f"%{{x:.4f}} s: %{{y:.5g}} {MICROSTRAIN}<extra>{record}</extra>",
    }


def _share(place: int, of: int, gap: float) -> list[float]:
    """Domain of one of several panels side by side."""
    width = (1.0 - gap * (of - 1)) / of
    return [place * (width + gap), place * (width + gap) + width]


def _above(values: Floats) -> Floats:
    """Values that a logarithmic axis can show."""
    return np.where(values > 0.0, values, np.nan)


def _decades(values: Sequence[Floats]) -> tuple[float, float]:
    """Whole decades that hold some values above 0, no more than a figure can show."""
    logs = np.log10(np.concatenate([one[one > 0.0] for one in values] or [np.ones(1)]))
    if not logs.size:
        return 0.0, 1.0
    high = float(np.ceil(logs.max() + 0.02))
    return max(float(np.floor(logs.min())), high - MOST_DECADES), high
