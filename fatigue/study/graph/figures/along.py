"""Damping and frequency of the roots that a line moves, over what grows along it, and where the vehicle is unstable."""

from collections.abc import Iterator, Mapping

import numpy as np

from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.figures.style import INK, QUIET, axis, figure, single
from fatigue.study.graph.figures.colours import UPTO_HZ, moved
from fatigue.study.graph.figures.plane import UNSTABLE
from fatigue.study.graph.line import Line
from fatigue.vehicle.stability.loci import Locus

DAMPING = (-10.0, 40.0)  # % shown
TICKS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0)


def along_figure(line: Line, own: float, colours: Mapping[str, str]) -> Figure:
    """Damping above, frequency below; red where the vehicle is unstable, dotted at its ``own`` value."""
    data: list[Trace] = []
    for locus in moved(line):
        data += [_curve(line, locus, colours[locus.name], upper=upper) for upper in (True, False)]
    title = "equivalent conicity [-]" if line.along == "conicity" else "speed [km/h]"
    x = axis(title, range=list(line.ends), anchor="y2")
    if line.along == "conicity":
        low, high = np.log10(line.ends)
        shown = [value for value in TICKS if line.ends[0] * 0.999 <= value <= line.ends[1] * 1.001]
        x = axis(title, type="log", range=[float(low), float(high)], anchor="y2", tickvals=shown)
        x["ticktext"] = [f"{value:g}" for value in shown]
    zero = {"type": "line", "xref": "x domain", "yref": "y", "x0": 0, "x1": 1, "y0": 0, "y1": 0}
    zero |= {"line": {"color": INK, "width": 1.2}}
    dotted = {"type": "line", "xref": "x", "yref": "paper", "x0": own, "x1": own, "y0": 0, "y1": 1}
    dotted |= {"line": {"color": QUIET, "width": 1, "dash": "dot"}}
    return figure(
        data,
        height=560,
        xaxis=x,
        yaxis=axis("damping ratio [%]", range=list(DAMPING), domain=[0.46, 1.0]),
        yaxis2=axis("frequency [Hz]", range=[0.0, UPTO_HZ], domain=[0.0, 0.40]),
        shapes=[*_unstable(line), zero, dotted],
        legend={"orientation": "h", "x": 0, "y": -0.14, "yanchor": "top", "font": {"size": 11}},
        margin={"l": 56, "r": 12, "t": 14, "b": 120},
        hovermode="x",
    )


def _curve(line: Line, locus: Locus, colour: str, *, upper: bool) -> Trace:
    values = 100.0 * locus.damping if upper else locus.frequency_hz
    return {
        "type": "scatter",
        "mode": "lines",
        "name": locus.name,
        "x": single(line.places),
        "y": single(values),
        "yaxis": "y" if upper else "y2",
        "line": {"color": colour, "width": 2.0},
        "legendgroup": locus.name,
        "showlegend": upper,
        "hovertemplate": "%{y:.1f} %" if upper else "%{y:.2f} Hz",
    }


def _unstable(line: Line) -> Iterator[Trace]:
    """Red bands between the stable ranges."""
    low, high = line.ends
    edges = [low, *(edge for ends in line.stable for edge in ends), high]
    for a, b in zip(edges[::2], edges[1::2], strict=True):
        if b > a:
            band = {"type": "rect", "xref": "x", "yref": "paper", "x0": a, "x1": b, "y0": 0, "y1": 1}
            yield band | {"fillcolor": UNSTABLE, "line": {"width": 0}, "layer": "below"}
