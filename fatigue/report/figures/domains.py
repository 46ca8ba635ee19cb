"""Time against frequency domain: at all points, and at one point event by event and range by range."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.report.figures.cycles import cumulative
from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.figures.given import ResultTable, check_known, check_one_each, frame_of
from fatigue.report.figures.style import (
    ACCENT,
    INK,
    QUIET,
    SEQUENTIAL,
    SERIES,
    axis,
    colour_bar,
    drawn_life,
    figure,
    log_axis,
    single,
    upright,
)
from fatigue.report.wording import in_figure
from fatigue.spectrum import trust
from fatigue.spectrum.methods import dirlik_density, spectral_shape

MOST_POINTS = 20_000  # beyond, only a part of the points that agree is drawn
VERDICTS = ("valid", *(verdict for verdict in trust.VERDICTS if verdict != "valid"))  # in the order of the legend
TRUSTED = VERDICTS[:2]
SYMBOLS = ("circle", "diamond", "square", "triangle-up", "triangle-down", "cross", "x", "pentagon", "star", "hexagram")
_ESTIMATES = ("life_km_same_ratio", "life_km_dirlik", "dirlik_ratio", "dirlik_verdict")
METHODS = {
    "rainflow": "damage_per_pass",
    "rainflow, one bending ratio": "damage_same_ratio_per_pass",
    "Dirlik": "damage_dirlik_per_pass",
    "Tovo-Benasciutti": "damage_tb_per_pass",
}
METHOD_COLOURS = dict(zip(METHODS, (ACCENT, SERIES[4], SERIES[1], SERIES[5]), strict=True))
RAREST = 0.1  # cycles of a pass that are drawn
FACTOR_BANDS = ((1, "solid"), (2, "dash"), (3, "dot"))


def time_against_frequency(nodes: ResultTable) -> Figure:
    """Dirlik's life over the rainflow life at the same bending ratio, all points, with bands of factor 2 and 3.

    ``nodes`` has the columns of the table of nodes and ``kurtosis``: of the stress in the governing event, 3 for a
    Gaussian record; it colours the points. Points without an estimate are left out; of very many points some are drawn,
    see ``drawn_points``.
    """
    nodes = frame_of(nodes, "nodes", (*_ESTIMATES, "kurtosis", "weld", "node", "surface"), empty=True)
    shown = nodes[drawn_points(nodes)]
    x, y = drawn_life(shown["life_km_same_ratio"]), drawn_life(shown["life_km_dirlik"])
    both = np.concatenate([x, y]) if len(shown) else np.array([1e6, 1e8])
    low, high = np.floor(np.log10(both.min()) * 2 - 0.4) / 2, np.ceil(np.log10(both.max()) * 2 + 0.4) / 2
    span = np.array([10.0**low, 10.0**high])
    bands = [
        {
            "type": "scatter",
            "x": span,
            "y": span * side,
            "mode": "lines",
            "line": {"color": QUIET, "width": 1, "dash": dash},
            "name": "equal" if factor == 1 else f"factor {factor}",
            "legendgroup": str(factor),
            "showlegend": side == factor,
            "hoverinfo": "skip",
        }
        for factor, dash in FACTOR_BANDS
        for side in sorted({1 / factor, float(factor)})
    ]
    verdict = shown["dirlik_verdict"].to_numpy()
    points = [_points(shown[verdict == v], v, i) for i, v in enumerate(v for v in VERDICTS if (verdict == v).any())]
    return figure(
        [*bands, *points],
        height=500,
        margin={"l": 76, "r": 16, "t": 52, "b": 52},
        xaxis=log_axis("life by rainflow, one bending ratio [km]", low, high),
        yaxis=log_axis("life by Dirlik, one bending ratio [km]", low, high),
    )


def drawn_points(nodes: ResultTable, most: int = MOST_POINTS) -> NDArray[np.bool_]:
    """Whether each point is drawn, (n,): all that have an estimate, or ``most``, beginning with those that disagree."""
    nodes = frame_of(nodes, "nodes", _ESTIMATES, empty=True)
    lives = nodes[["life_km_same_ratio", "life_km_dirlik"]].to_numpy(dtype=np.float64)
    drawn: NDArray[np.bool_] = np.isfinite(lives).all(axis=1)
    found = int(np.count_nonzero(drawn))
    if found <= most:
        return drawn
    off = np.abs(np.log(np.nan_to_num(nodes["dirlik_ratio"].to_numpy(dtype=np.float64), nan=1.0)))
    untrusted = ~nodes["dirlik_verdict"].isin(TRUSTED).to_numpy() | (off > np.log(2.0))
    rank = np.arange(len(nodes)) % (found // most + 1)  # every so manyth of those that agree
    candidates = np.flatnonzero(drawn & (untrusted | (rank == 0)))
    first = candidates[np.argsort(-(untrusted[candidates] * (1.0 + off[candidates])), kind="stable")[:most]]
    return np.isin(np.arange(len(nodes)), first)


def _points(shown: pd.DataFrame, verdict: str, number: int) -> Trace:
    """Points of one verdict, in a symbol of its own."""
    return {
        "type": "scattergl",
        "x": single(drawn_life(shown["life_km_same_ratio"])),
        "y": single(drawn_life(shown["life_km_dirlik"])),
        "mode": "markers",
        "name": f"{verdict.replace('_', ' ')} ({len(shown)})",
        "marker": {
            "size": 6 if verdict in TRUSTED else 9,
            "symbol": SYMBOLS[number % len(SYMBOLS)],
            "showscale": number == 0,
            "color": single(shown["kurtosis"].fillna(3.0)),
            "cmin": 2.0,
            "cmax": 6.0,
            "colorscale": SEQUENTIAL,
            "reversescale": True,
            "line": {"width": 0.4, "color": INK},
            "colorbar": colour_bar("kurtosis of the stress [-], Gaussian 3"),
        },
        "customdata": single(shown["dirlik_ratio"]),
        "text": _names(shown),
        "hovertemplate": "%{text}<br>rainflow %{x:.4g} km<br>Dirlik %{y:.4g} km<br>"
        "damage ratio %{customdata:.4g}<extra></extra>",
    }


def ratio_histogram(nodes: ResultTable) -> Figure:
    """How the damage ratio Dirlik / rainflow is spread over the points, on a logarithmic axis."""
    nodes = frame_of(nodes, "nodes", ("dirlik_ratio",), empty=True)
    ratio = nodes["dirlik_ratio"].to_numpy(dtype=np.float64)
    ratio = ratio[np.isfinite(ratio) & (ratio > 0.0)]
    limit = max(0.4, float(np.abs(np.log10(ratio)).max(initial=0.0)) * 1.05)
    count, edges = np.histogram(np.log10(ratio), bins=np.linspace(-limit, limit, 42))
    bars = {
        "type": "bar",
        "x": 10 ** (0.5 * (edges[1:] + edges[:-1])),
        "y": count,
        "width": np.diff(10**edges) * 0.94,
        "marker": {"color": ACCENT},
        "hovertemplate": "ratio %{x:.3g}<br>%{y} points<extra></extra>",
    }
    ticks = [t for t in (0.01, 0.03, 0.1, 0.2, 0.33, 0.5, 1, 2, 3, 5, 10, 30, 100) if abs(np.log10(t)) <= limit]
    x = axis("damage by Dirlik / damage by rainflow [-]", type="log", range=[-limit, limit])
    return figure(
        [bars],
        height=500,
        showlegend=False,
        margin={"l": 70, "r": 16, "t": 34, "b": 52},
        xaxis={**x, "tickvals": ticks, "ticktext": [f"{t:g}" for t in ticks]},
        yaxis=axis("points [-]"),
        shapes=[upright(0.5, dash="dash"), upright(1.0, dash="solid"), upright(2.0, dash="dash")],
    )


def _names(points: pd.DataFrame) -> list[str]:
    short = {weld: in_figure(weld) for weld in points["weld"].unique()}
    return [
        f"{short[weld]}, node {node}, {face}"
        for weld, node, face in zip(points["weld"], points["node"], points["surface"], strict=True)
    ]


def damage_by_method(damage: ResultTable, passes_per_km: Mapping[str, float], most: int = 8) -> Figure:
    """Damage of one point by every method, event by event and in all: over the counted damage of all events together.

    ``damage`` has its rows of the table of damage. Events without a spectrum, and sequences, are left out: estimates
    have nothing of them. ``most`` events are drawn, those that damage most; together are all of them.
    """
    damage = frame_of(damage, "damage", ("event", *METHODS.values()))
    check_known(damage["event"].unique(), passes_per_km, "passes_per_km", "event")
    events = damage[damage[list(METHODS.values())].notna().all(axis=1)]
    weights = events["event"].map(passes_per_km).astype(float)
    per_km = events[list(METHODS.values())].astype(float).mul(weights, axis=0)
    total = float(per_km[METHODS["rainflow"]].sum())
    drawn = np.sort(np.argsort(-per_km[METHODS["rainflow"]].to_numpy(), kind="stable")[:most])
    names = [in_figure(event) for event in events["event"].iloc[drawn]]
    bars: list[Trace] = []
    for method, column in METHODS.items():
        parts = per_km[column].to_numpy() / (total or 1.0)
        bars.append(
            {
                "type": "bar",
                "x": [*names, "together"] if len(names) > 1 else names,
                "y": single([*parts[drawn], parts.sum()] if len(names) > 1 else parts),
                "name": method,
                "marker": {"color": METHOD_COLOURS[method]},
                "hovertemplate": "%{x}: %{y:.1%}",
            }
        )
    y = axis("damage / counted damage together [%]", tickformat=".0%", rangemode="tozero")
    return figure(bars, height=340, barmode="group", xaxis=axis("", type="category"), yaxis=y)


def ranges_by_method(cycles: ResultTable, moments: NDArray[np.float64], duration: float) -> Figure:
    """How often each stress range is reached in one pass of an event: counted, and as Dirlik expects of its spectrum.

    Parameters
    ----------
    cycles : rows of the table of cycles of one point and event
    moments : (4,) spectral moments m0, m1, m2, m4 of its stress [MPa^2 Hz^n]
    duration : of the pass [s]

    Beside both is what would be if the stress were of a narrow band: Rayleigh ranges at the rate of zero crossings.
    """
    cycles = frame_of(cycles, "cycles", ("range_MPa", "count"))
    check_one_each(moments, range(4), "moments")
    ranges = cycles["range_MPa"].to_numpy(dtype=np.float64)
    counted, reached = cumulative(ranges, cycles["count"].to_numpy(dtype=np.float64))
    shape = spectral_shape(moments[:, None])
    of = dirlik_density(shape)
    S = np.linspace(0.0, 1.25 * float(ranges.max()), 200)
    z = S / (2.0 * np.sqrt(moments[0]))
    with np.errstate(divide="ignore", invalid="ignore"):
        exponential = np.where(of.d1 > 0.0, np.exp(-z / of.q), 0.0)
        narrower = np.where(of.d2 > 0.0, np.exp(-0.5 * (z / of.r) ** 2), 0.0)
    rayleigh = np.exp(-0.5 * z**2)
    dirlik = shape.peaks * duration * (of.d1 * exponential + of.d2 * narrower + of.d3 * rayleigh)
    narrow = shape.zero_crossings * duration * rayleigh
    lines = [
        _reached(counted, reached, "rainflow", {"shape": "hv", "color": METHOD_COLOURS["rainflow"], "width": 2.2}),
        _reached(dirlik, S, "Dirlik", {"color": METHOD_COLOURS["Dirlik"], "width": 1.8, "dash": "dash"}),
        _reached(narrow, S, "narrow band", {"color": QUIET, "width": 1.2, "dash": "dot"}),
    ]
    most = np.log10(max(float(counted[-1]), float(dirlik[0]), 10.0)) + 0.1
    return figure(
        lines,
        height=340,
        xaxis=log_axis("cycles of a pass reached or exceeded [-]", float(np.log10(RAREST)), float(most)),
        yaxis=axis("stress range [MPa]", rangemode="tozero"),
    )


def _reached(x: NDArray[np.float64], y: NDArray[np.float64], name: str, line: Trace) -> Trace:
    """Line of how often ranges are reached, rarer ones than ``RAREST`` left out."""
    drawn = x >= RAREST
    hover = "%{x:.3g} cycles of %{y:.4g} MPa and more"
    return {
        "type": "scatter",
        "x": single(x[drawn]),
        "y": single(y[drawn]),
        "mode": "lines",
        "name": name,
        "line": line,
        "hovertemplate": hover,
    }
