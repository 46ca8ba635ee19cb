"""Who has the kinetic energy of a root that loses stability, along the line: how modes exchange it."""

from collections.abc import Sequence

import numpy as np

from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.figures.style import INK, axis, figure, single
from fatigue.study.graph.figures.along import TICKS
from fatigue.study.graph.figures.colours import OF_GROUP, WORDS
from fatigue.study.graph.line import Line
from fatigue.vehicle.stability.loci import Locus

MOST = 3  # loci side by side


def that_cross(line: Line) -> list[Locus]:
    """Loci that pass zero damping along the line, ascending by where they do first."""
    found = []
    for locus in line.loci:
        grows = locus.damping < 0.0
        here = np.isfinite(locus.damping)
        if (grows & here).any() and (~grows & here).any():
            found.append((int(np.flatnonzero(grows & here)[0]), locus))
    return [locus for _, locus in sorted(found, key=lambda one: one[0])][:MOST]


def energy_figure(line: Line, loci: Sequence[Locus]) -> Figure:
    """Shares of the kinetic energy of some loci, one panel above the other; upright lines where stability changes."""
    data: list[Trace] = []
    layout: dict[str, object] = {}
    gap, n = 0.11, len(loci)
    height = (1.0 - gap * (n - 1)) / n
    notes = []
    for row, locus in enumerate(loci):
        suffix = "" if row == 0 else str(row + 1)
        top = 1.0 - row * (height + gap)
        for group, colour in OF_GROUP.items():
            data.append(_share(line, locus, group, colour, suffix, shown=row == 0))
        layout[f"yaxis{suffix}"] = axis("", range=[0.0, 1.0], domain=[max(0.0, top - height), top], tickformat=".0%")
        where = {"x": 0, "xref": "paper", "xanchor": "left", "y": top, "yref": "paper", "yanchor": "bottom"}
        notes.append({**where, "text": f"<b>{locus.name}</b>{_crossing(locus)}", "showarrow": False})
    title = "equivalent conicity [-]" if line.along == "conicity" else "speed [km/h]"
    x = axis(title, range=list(line.ends), anchor="y" if n == 1 else f"y{n}")
    if line.along == "conicity":
        shown = [value for value in TICKS if line.ends[0] * 0.999 <= value <= line.ends[1] * 1.001]
        ends = [float(np.log10(end)) for end in line.ends]
        x = axis(title, type="log", range=ends, anchor=x["anchor"], tickvals=shown)
        x["ticktext"] = [f"{value:g}" for value in shown]
    uprights = [
        {
            "type": "line",
            "xref": "x",
            "yref": "paper",
            "x0": crossing.at,
            "x1": crossing.at,
            "y0": 0,
            "y1": 1,
            "line": {"color": INK, "width": 1.2, "dash": "dot"},
        }
        for crossing in line.crossings
    ]
    return figure(
        data,
        height=90 + 190 * n,
        xaxis=x,
        shapes=uprights,
        annotations=notes,
        legend={"orientation": "h", "x": 0, "y": -0.2 if n == 1 else -0.12, "yanchor": "top", "font": {"size": 11}},
        margin={"l": 56, "r": 12, "t": 28, "b": 110},
        **layout,
    )


def _crossing(locus: Locus) -> str:
    """From which frequency to which a locus goes."""
    f = locus.frequency_hz[np.isfinite(locus.frequency_hz)]
    return f", {f[0]:.1f} to {f[-1]:.1f} Hz"


def _share(line: Line, locus: Locus, group: str, colour: str, suffix: str, *, shown: bool) -> Trace:
    values = [np.nan if root is None else root.of.shares[group] for root in locus.roots]
    return {
        "type": "scatter",
        "mode": "lines",
        "name": WORDS[group],
        "x": single(line.places),
        "y": single(np.array(values)),
        "yaxis": f"y{suffix}",
        "stackgroup": suffix or "1",
        "line": {"color": colour, "width": 0.5},
        "fillcolor": colour,
        "legendgroup": group,
        "showlegend": shown,
        "hovertemplate": "%{y:.0%}",
    }
