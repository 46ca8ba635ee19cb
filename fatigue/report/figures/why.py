"""Figures of a diagnosis: frequency bands and places on the track that make the damage."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.report.figures.drawn import Figure
from fatigue.report.figures.given import ResultTable, check_one_each, frame_of
from fatigue.report.figures.style import (
    ACCENT,
    QUIET,
    SHARES,
    across,
    axis,
    colour_bar,
    figure,
    log_axis,
    single,
    upright,
)
from fatigue.report.wording import in_figure, share


def damage_by_band(bands: ResultTable, modes: Sequence[float] = ()) -> Figure:
    """Share of each frequency band in the damage of one point.

    Parameters
    ----------
    bands : ``low_hz``, ``high_hz`` (NaN: no upper end) and ``share`` of each band, ascending
    modes : natural frequencies to be marked [Hz]
    """
    bands = frame_of(bands, "bands", ("low_hz", "high_hz", "share"))
    low, high = _edges(bands)
    values = bands["share"].to_numpy()
    bars = {
        "type": "bar",
        "x": np.sqrt(low * high),
        "y": single(values),
        "width": (high - low) * 0.94,
        "marker": {"color": np.where(values < 0.0, QUIET, ACCENT).tolist()},
        "text": [share(v) if abs(v) >= 0.05 else "" for v in values],
        "textposition": "outside",
        "cliponaxis": False,
        "customdata": [_span(*row) for row in bands[["low_hz", "high_hz"]].to_numpy()],
        "hovertemplate": "%{customdata}: %{y:.1%}<extra></extra>",
    }
    limits = [min(0.0, float(values.min()) * 1.3), max(float(values.max()), 0.05) * 1.18]
    return figure(
        [bars],
        height=340,
        showlegend=False,
        xaxis=log_axis("frequency [Hz]", float(np.log10(low[0])), float(np.log10(high[-1]))),
        yaxis=axis("share of the damage [%]", tickformat=".0%", range=limits),
        shapes=[*(upright(f) for f in modes if low[0] < f < high[-1]), across(0.0, QUIET, 1)],
    )


def bands_of_welds(welds: Sequence[str], shares: NDArray[np.float64], bands: ResultTable) -> Figure:
    """Map of the damage: worst points of the welds, worst on top, over frequency bands.

    ``shares`` is (weld, band); ``bands`` gives ``low_hz`` and ``high_hz`` (NaN: no upper end) of each, ascending.
    """
    bands = frame_of(bands, "bands", ("low_hz", "high_hz"))
    check_one_each(shares, welds, "shares")
    low, high = _edges(bands)
    rows = list(range(len(welds)))
    data = {
        "type": "heatmap",
        "x": np.append(low, high[-1]),
        "y": np.arange(len(welds) + 1) - 0.5,
        "z": single(100.0 * shares),
        "zmin": 0,
        "zmax": 100,
        "colorscale": SHARES,
        "ygap": 3,
        "colorbar": colour_bar("share of the damage [%]"),
        "hovertemplate": "%{x:.3g} Hz: %{z:.3g} %<extra></extra>",
    }
    return figure(
        [data],
        height=max(190, 90 + 20 * len(welds)),
        margin={"l": 20, "r": 20, "t": 12, "b": 46},
        xaxis=log_axis("frequency [Hz]", float(np.log10(low[0])), float(np.log10(high[-1])), showgrid=False),
        yaxis={
            "tickvals": rows,
            "ticktext": [in_figure(weld) for weld in welds],
            "range": [len(rows) - 0.5, -0.5],
            "showgrid": False,
            "automargin": True,
            "ticks": "",
        },
    )


def damage_on_track(track: ResultTable) -> Figure:
    """Where on the record of one event the damage is made: intensity 1 is its average.

    ``track`` has the columns ``start_km, end_km, start_s, end_s, share, intensity`` of one point and event; time is
    drawn for an event without distance.
    """
    track = frame_of(track, "track", ("start_km", "end_km", "start_s", "end_s", "share", "intensity"))
    unit = "s" if track["start_km"].isna().any() else "km"
    start, end = track[f"start_{unit}"].to_numpy(), track[f"end_{unit}"].to_numpy()
    bars = {
        "type": "bar",
        "x": 0.5 * (start + end),
        "width": end - start,
        "y": single(track["intensity"]),
        "marker": {"color": ACCENT, "line": {"width": 0.5, "color": "white"}},
        "customdata": single(track["share"]),
        "hovertemplate": f"%{{x:.4g}} {unit}: %{{y:.3g}} times the average, "
        "%{customdata:.1%} of the damage<extra></extra>",
    }
    where = "distance in the record [km]" if unit == "km" else "time of the record [s]"
    return figure(
        [bars],
        height=340,
        showlegend=False,
        bargap=0,
        xaxis=axis(where, range=[float(start[0]), float(end[-1])]),
        yaxis=axis("damage per length / average [-]", rangemode="tozero"),
        shapes=[across(1.0, QUIET, 1, "dash")],
    )


def _edges(bands: pd.DataFrame) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Edges as a logarithmic axis can show them: an open band is drawn half an octave wide."""
    low, high = bands["low_hz"].to_numpy(dtype=np.float64).copy(), bands["high_hz"].to_numpy(dtype=np.float64).copy()
    if np.isnan(high[-1]):
        high[-1] = max(low[-1], 1.0) * 1.5
    if low[0] <= 0.0:
        low[0] = high[0] / 1.5
    return low, high


def _span(low: float, high: float) -> str:
    return f"above {low:.3g} Hz" if np.isnan(high) else f"{low:.3g} to {high:.3g} Hz"
