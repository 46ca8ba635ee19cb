"""Figures of a basis: effective mass summed over frequency, dynamic mass over frequency."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.basis.mass.rows import DIRECTIONS, DynamicMass, ModalMass
from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.figures.style import DASHES, QUIET, SERIES, across, axis, figure, log_axis, single, upright

Floats = NDArray[np.float64]


BEYOND = 2.0  # bands of frequency that are shown
MOST_DECADES = 6.0


def summed_masses(rows: Sequence[ModalMass], band_hz: float) -> Figure | None:
    """Share of the mass that modes up to a frequency carry, one stair for each direction; None without shares."""
    end = BEYOND * band_hz
    data = []
    for i, direction in enumerate(dict.fromkeys(row.direction for row in rows)):
        of = sorted((r for r in rows if r.direction == direction), key=lambda r: r.frequency_hz)
        share = np.array([row.summed_share for row in of])
        if np.isfinite(share).any():
            f = np.array([row.frequency_hz for row in of])
            x, y = np.append(0.0, f), np.append(0.0, share)
            if f[-1] < end:
                x, y = np.append(x, end), np.append(y, share[-1])
            data.append(_line(direction, i, x, y, "%{x:.4g} Hz: %{y:.1%}", "hv"))
    if not data:
        return None
    return figure(
        data,
        height=360,
        xaxis=axis("natural frequency [Hz]", range=[0.0, end]),
        yaxis=axis("summed effective mass over the body's [-]", range=[0.0, 1.05], tickformat=".0%"),
        shapes=[across(1.0, QUIET, 1.0, "dot"), upright(band_hz)],
    )


def dynamic_masses(rows: Sequence[DynamicMass], band_hz: float) -> Figure | None:
    """Dynamic mass over frequency: of the whole body where its mass is known, else of its elastic part.

    Along x, y, z in one panel, about them in another; None where there is nothing to draw.
    """
    panels = [(unit, _dynamic_lines(rows, axes)) for unit, axes in (("t", DIRECTIONS[:3]), ("t mm2", DIRECTIONS[3:]))]
    panels = [(unit, lines) for unit, lines in panels if lines]
    domains = ([0.0, 1.0],) if len(panels) == 1 else ([0.55, 1.0], [0.0, 0.45])
    data, layout = [], {}
    for name, domain, (unit, lines) in zip(("", "2"), domains, panels, strict=False):
        data += [line | {"yaxis": f"y{name}"} for line in lines]
        high = max(np.log10(line["y"]).max() for line in lines)
        low = max(min(np.log10(line["y"]).min() for line in lines), high - MOST_DECADES)
        layout[f"yaxis{name}"] = log_axis(f"dynamic mass [{unit}]", np.floor(low), np.ceil(high), domain=domain)
    if not data:
        return None
    frequency = axis("frequency [Hz]", range=[0.0, BEYOND * band_hz], anchor=data[-1]["yaxis"])
    return figure(data, height=340 * len(panels), xaxis=frequency, shapes=[upright(band_hz)], **layout)


def _dynamic_lines(rows: Sequence[DynamicMass], directions: Sequence[str]) -> list[Trace]:
    """One line for each of some directions that has values above 0."""
    lines = []
    for direction in directions:
        of = [row for row in rows if row.direction == direction]
        whole = all(np.isfinite(row.dynamic_mass) for row in of)
        f = np.array([row.frequency_hz for row in of])
        mass = np.array([row.dynamic_mass if whole else row.elastic_mass for row in of])
        name = f"{direction}, {'rigid + elastic' if whole else 'elastic'}"
        if (mass > 0.0).any():
            colour = DIRECTIONS.index(direction)
            lines.append(_line(name, colour, f[mass > 0.0], mass[mass > 0.0], "%{x:.4g} Hz: %{y:.4g}", "linear"))
    return lines


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
