"""Figures of the records of one point: its stress over time and at its cycles with the parts of modes, its spectra."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.figures.given import check_one_each
from fatigue.report.figures.style import (
    ACCENT,
    INK,
    QUIET,
    SERIES,
    across,
    axis,
    figure,
    log_axis,
    shaded,
    single,
    upright,
)
from fatigue.report.stress import Envelope, Excerpt, StressSpectrum
from fatigue.report.wording import in_figure, number, share

PSD_POINTS = 400
PSD_DECADES = 6
PANEL_GAP, EXCERPT_GAP = 0.12, 0.01  # between cycles, of a panel; between the reversals of one, of the figure


def stress_history(envelope: Envelope, excerpts: Sequence[Excerpt], modes: Mapping[int, str], colour: str) -> Figure:
    """Stress over the whole record of an event, and close by around the instants of one cycle with the parts of modes.

    ``modes`` names the modes of the excerpts; their parts are drawn about their own mean. One or two excerpts, or none:
    the whole record is drawn alone then.
    """
    both = np.column_stack([envelope.low, envelope.high]).ravel()
    data: list[Trace] = [
        {
            "type": "scatter",
            "x": single(np.repeat(envelope.time, 2)),
            "y": single(both),
            "mode": "lines",
            "line": {"color": colour, "width": 1},
            "showlegend": False,
            "hovertemplate": "%{x:.4g} s: %{y:.4g} MPa<extra></extra>",
        }
    ]
    if not excerpts:
        return figure(data, height=240, xaxis=axis("time of the record [s]"), yaxis=axis("stress [MPa]"))
    layout = {"xaxis": axis("", anchor="y"), "yaxis": axis("stress [MPa]", domain=[0.68, 1.0])}
    width = 1.0 / len(excerpts)
    for i, excerpt in enumerate(excerpts):
        n = i + 2
        data += _close_up(excerpt, modes, f"x{n}", "y2", named=i == 0, worded=True)
        layout[f"xaxis{n}"] = axis(
            "time of the record [s]", anchor="y2", domain=[i * width + 0.03 * i, (i + 1) * width], nticks=6
        )
    layout["yaxis2"] = axis("stress [MPa]", domain=[0.0, 0.54])
    bands = [shaded(float(e.time[0]), float(e.time[-1]), y="y domain") for e in excerpts]
    return figure(data, height=440, shapes=bands, **layout)


def cycles_close_by(cycles: Sequence[Sequence[Excerpt]], titles: Sequence[str], modes: Mapping[int, str]) -> Figure:
    """Stress around the reversals of some cycles, each in a panel of its own, with the parts of modes.

    ``cycles`` has the one or two excerpts of each, one where both reversals are close; ``titles`` names the cycles and
    ``modes`` the modes, whose parts are drawn about their own mean.
    """
    check_one_each(titles, cycles, "titles")
    data: list[Trace] = []
    axes: dict[str, Trace] = {}
    notes: list[Trace] = []
    for i, (excerpts, title) in enumerate(zip(cycles, titles, strict=True)):
        edges = np.linspace(i, i + 1 - PANEL_GAP, len(excerpts) + 1) / (len(cycles) - PANEL_GAP)
        notes.append(_panel_title(title, float(edges[0])))
        for excerpt, left, right in zip(excerpts, edges, edges[1:], strict=False):
            x = f"x{len(axes) + 1}" if axes else "x"
            data += _close_up(excerpt, modes, x, "y", named=not axes, worded=False)
            domain = [float(left), float(right - EXCERPT_GAP * (right < edges[-1]))]
            words = "time of the record [s]" if left == edges[0] else ""
            axes[x.replace("x", "xaxis")] = axis(words, domain=domain, nticks=4, tickangle=0)
    stress = axis("stress [MPa]")
    return figure(data, height=340, yaxis=stress, annotations=notes, **axes)


def _panel_title(text: str, x: float) -> Trace:
    place = {"x": x, "y": 1.0, "xref": "paper", "yref": "paper", "xanchor": "left", "yanchor": "top", "xshift": 4}
    return {**place, "text": text, "showarrow": False, "font": {"size": 11}, "bgcolor": "rgba(255,255,255,0.85)"}


def _close_up(excerpt: Excerpt, modes: Mapping[int, str], x: str, y: str, *, named: bool, worded: bool) -> list[Trace]:
    common = {"type": "scatter", "xaxis": x, "yaxis": y, "showlegend": named}
    lines = [
        {
            **common,
            "x": single(excerpt.time),
            "y": single(excerpt.stress),
            "mode": "lines",
            "line": {"color": INK, "width": 2},
            "name": "structural stress",
            "hovertemplate": "%{x:.5g} s: %{y:.4g} MPa",
        }
    ]
    for (mode, part), colour in zip(excerpt.parts.items(), SERIES, strict=False):
        look = {"mode": "lines", "line": {"width": 1.2, "color": colour}, "name": modes[mode]}
        lines.append({**common, **look, "x": single(excerpt.time), "y": single(part), "hovertemplate": "%{y:.4g} MPa"})
    at = [int(np.abs(excerpt.time - t).argmin()) for t in excerpt.instants]
    lines.append(
        {
            **common,
            "x": single(excerpt.time[at]),
            "y": single(excerpt.stress[at]),
            "mode": "markers+text",
            "name": "reversals of the cycle",
            "marker": {"symbol": "circle-open", "size": 11, "color": ACCENT, "line": {"width": 2}},
            "text": [f" {number(v)} MPa" if worded else "" for v in excerpt.stress[at]],
            "textposition": "middle right",
            "hoverinfo": "skip",
        }
    )
    return lines


def stress_spectrum(
    spectra: Sequence[StressSpectrum],
    colours: Mapping[str, str],
    modes: Mapping[str, tuple[float, float]],
    governing: str,
) -> Figure:
    """Stress spectra of some events with the natural frequencies that matter; the cumulative variance below.

    ``modes`` gives frequency [Hz] and share of the variance of each mode to be marked; the cumulative variance is that
    of the governing event.
    """
    peak = max(float(s.density.max()) for s in spectra) or 1.0
    first = max(min(float(s.frequency[1]) for s in spectra), 0.1)
    last = max(float(s.frequency[-1]) for s in spectra)
    data: list[Trace] = []
    for s in spectra:
        look = {"color": colours[s.event], "width": 2 if s.event == governing else 1.2}
        frequency, density = _thinned(s.frequency[1:], s.density[1:])
        data.append(
            {
                "type": "scatter",
                "x": single(frequency),
                "y": single(np.maximum(density, peak * 10.0 ** -(PSD_DECADES + 2))),
                "mode": "lines",
                "name": in_figure(s.event),
                "line": look,
                "hovertemplate": "%{x:.3g} Hz: %{y:.3g} MPa²/Hz",
            }
        )
        if s.event == governing:
            total = np.cumsum(s.density)
            frequency, part = _thinned(s.frequency[1:], total[1:] / max(float(total[-1]), 1e-300))
            data.append(
                {
                    "type": "scatter",
                    "x": single(frequency),
                    "y": single(part),
                    "yaxis": "y2",
                    "mode": "lines",
                    "line": look,
                    "showlegend": False,
                    "hovertemplate": "%{y:.1%} of the variance below %{x:.3g} Hz<extra></extra>",
                }
            )
    top = float(np.log10(peak)) + 0.3
    return figure(
        data,
        height=440,
        xaxis=log_axis("frequency [Hz]", float(np.log10(first)), float(np.log10(last)), anchor="y2"),
        yaxis=log_axis("PSD [MPa²/Hz]", top - PSD_DECADES, top, domain=[0.36, 1.0]),
        yaxis2=axis("variance below [%]", tickformat=".0%", range=[0, 1.02], domain=[0.0, 0.28], nticks=3),
        shapes=[*(upright(frequency) for frequency, _ in modes.values()), across(0.5, QUIET, 1, "dot", on="y2")],
        annotations=[_mode_note(name, *where) for name, where in modes.items()],
    )


def _mode_note(name: str, frequency: float, part: float) -> Trace:
    return {
        "x": float(np.log10(frequency)),
        "y": 0.37,
        "yref": "paper",
        "text": f"{name}: {share(part)}",
        "textangle": -90,
        "xanchor": "right",
        "yanchor": "bottom",
        "showarrow": False,
        "font": {"size": 10, "color": INK},
        "bgcolor": "rgba(255,255,255,0.7)",
    }


def _thinned(x: NDArray[np.float64], y: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Largest value of each of many equal spans of log x, so that no peak is lost."""
    if len(x) <= PSD_POINTS:
        return x, y
    span = np.floor(np.interp(np.log(x), np.log(x[[0, -1]]), [0.0, PSD_POINTS - 1e-9]))
    first = np.flatnonzero(np.diff(span, prepend=-1.0))
    largest = [a + int(y[a:b].argmax()) for a, b in zip(first, [*first[1:], len(x)], strict=True)]
    return x[largest], y[largest]
