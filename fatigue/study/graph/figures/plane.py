"""Root loci in the plane of damping and frequency, as the analysis graph is drawn: one curve for each root."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.figures.style import GRID, INK, PAPER, QUIET, axis, figure, single
from fatigue.study.graph.figures.colours import UPTO_HZ, moved
from fatigue.study.graph.line import Line
from fatigue.vehicle.stability.loci import Locus

DAMPING = (-20.0, 60.0)  # % shown
ROAMS_HZ = 1.0  # along the line: a root that does not gets no values written beside it
UNSTABLE = "#f6d5d0"
TOLD_CONICITIES, TOLD_SPEEDS = (0.03, 0.1, 0.3, 1.0), (100.0, 200.0, 350.0, 600.0)


def plane_figure(lines: Sequence[Line], colours: Mapping[str, str]) -> Figure:
    """Loci of the first line; the others are chosen above the figure.

    Curves with colour are roots that the line moves, grey ones those it leaves alone. Points grow along the line.
    """
    data: list[Trace] = []
    belongs: list[int] = []
    for number, line in enumerate(lines):
        for trace in _traces(line, colours):
            data.append({**trace, "visible": number == 0})
            belongs.append(number)
    buttons = [
        {"label": said(line), "method": "update", "args": [{"visible": [of == number for of in belongs]}]}
        for number, line in enumerate(lines)
    ]
    menu = {"buttons": buttons, "x": 0.0, "xanchor": "left", "y": 1.0, "yanchor": "bottom", "pad": {"b": 6}}
    menu |= {"bgcolor": PAPER, "bordercolor": QUIET, "borderwidth": 1, "font": {"size": 12}, "showactive": True}
    unstable = {"type": "rect", "xref": "x", "yref": "paper", "x0": DAMPING[0], "x1": 0.0, "y0": 0.0, "y1": 1.0}
    unstable |= {"fillcolor": UNSTABLE, "line": {"width": 0}, "layer": "below"}
    zero = {"type": "line", "xref": "x", "yref": "paper", "x0": 0.0, "x1": 0.0, "y0": 0.0, "y1": 1.0}
    zero |= {"line": {"color": INK, "width": 1.5}}
    note = {"x": DAMPING[0], "y": 1.0, "yref": "paper", "xanchor": "left", "yanchor": "top", "showarrow": False}
    note |= {"text": "grows", "font": {"color": "#8c2c20", "size": 12}}
    return figure(
        data,
        height=560,
        xaxis=axis("damping ratio [%]", range=list(DAMPING), gridcolor=GRID),
        yaxis=axis("frequency [Hz]", range=[0.0, UPTO_HZ], gridcolor=GRID),
        shapes=[unstable, zero],
        annotations=[note],
        updatemenus=[menu] if len(lines) > 1 else [],
        legend={"orientation": "h", "x": 0, "y": -0.14, "yanchor": "top", "font": {"size": 11}},
        margin={"l": 56, "r": 12, "t": 46, "b": 120},
    )


def said(line: Line) -> str:
    """What stays along a line."""
    return f"at {line.at:g} km/h" if line.along == "conicity" else f"at conicity {line.at:g}"


def _traces(line: Line, colours: Mapping[str, str]) -> Iterator[Trace]:
    in_colour = moved(line)
    named = {id(locus) for locus in in_colour}
    grey = [locus for locus in line.loci if id(locus) not in named]
    yield _grey(line, grey)
    told = {int(np.abs(np.log(line.places / value)).argmin()): f"{value:g}" for value in _told(line)}
    for locus in in_colour:
        yield _curve(line, locus, colours[locus.name], told)


def _told(line: Line) -> tuple[float, ...]:
    """Values along the line that are written beside the curves."""
    values = TOLD_CONICITIES if line.along == "conicity" else TOLD_SPEEDS
    low, high = line.ends
    return tuple(value for value in values if low <= value <= high)


def _curve(line: Line, locus: Locus, colour: str, told: Mapping[int, str]) -> Trace:
    """One locus: a line with points that grow, some with what they are at."""
    damping = 100.0 * locus.damping
    n = len(line.places)
    roams = np.nanmax(locus.frequency_hz) - np.nanmin(locus.frequency_hz) > ROAMS_HZ
    in_view = (damping > DAMPING[0]) & (damping < DAMPING[1]) & (locus.frequency_hz < UPTO_HZ)
    return {
        "type": "scatter",
        "mode": "lines+markers+text",
        "name": locus.name,
        "x": single(damping),
        "y": single(locus.frequency_hz),
        "line": {"color": colour, "width": 2.2},
        "marker": {"color": colour, "size": (2.0 + 5.0 * np.arange(n) / max(1, n - 1)).round(2).tolist()},
        "text": [told.get(k, "") if in_view[k] and roams else "" for k in range(n)],
        "textposition": "middle right",
        "textfont": {"size": 10, "color": colour},
        "customdata": [_told_of(line, k, locus) for k in range(n)],
        "hovertemplate": "%{customdata}<br>%{y:.2f} Hz, %{x:.1f} %<extra></extra>",
    }


def _grey(line: Line, loci: Sequence[Locus]) -> Trace:
    """All loci that the line leaves alone, as one trace."""
    x, y, words = [], [], []
    for locus in loci:
        x += [*(100.0 * locus.damping), np.nan]
        y += [*locus.frequency_hz, np.nan]
        words += [*(_told_of(line, k, locus) for k in range(len(line.places))), ""]
    return {
        "type": "scatter",
        "mode": "lines+markers",
        "name": "roots that it leaves alone",
        "x": single(np.array(x)),
        "y": single(np.array(y)),
        "line": {"color": "#9aa5af", "width": 1.2},
        "marker": {"color": "#9aa5af", "size": 4},
        "customdata": words,
        "hovertemplate": "%{customdata}<br>%{y:.2f} Hz, %{x:.1f} %<extra></extra>",
    }


def _told_of(line: Line, place: int, locus: Locus) -> str:
    root = locus.roots[place]
    value = line.places[place]
    at = f"conicity {value:.3g}" if line.along == "conicity" else f"{value:.0f} km/h"
    return "" if root is None else f"{at}: {root.of.name}"
