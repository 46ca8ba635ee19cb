"""Figures of a ride: the hunting of a channel along its event, and how much of the damage its hot stretches hold."""

from itertools import pairwise

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.figures.given import ResultTable, frame_of
from fatigue.report.figures.style import ACCENT, GRID, INK, MISSED, QUIET, across, axis, figure, shaded, single, upright
from fatigue.report.wording import in_figure, number, share

Floats = NDArray[np.float64]

MOST_SLICES = 1500  # drawn of a track; of a longer one the clearest of each of as many equal parts
MOST_MODES = 8  # of equipment, those nearest to the hunting
INSIDE = 0.15  # share from which a bar is long enough for its number
FARTHEST = 2.0  # times the highest frequency of the track: a mode above is not drawn
_STRETCH = ("start_km", "end_km", "start_s", "end_s", "frequency_hz", "hot")
_SLICE = ("time_s", "km", "frequency_hz", "share", "rms", "reference_rms", "hot")


def hunting_along_event(
    flutter: ResultTable,
    flutter_track: ResultTable | None = None,
    coincidence: ResultTable | None = None,
    hot_factor: float | None = None,
) -> Figure:
    """Dominant frequency of a channel along its event, hot stretches shaded; below it the rms over its reference.

    Parameters
    ----------
    flutter : rows of one event and channel of the table of this name; time is drawn for an event without distance
    flutter_track : the same of its track; without it the frequencies of the stretches are drawn
    coincidence : the same with the modes of equipment, which are lines
    hot_factor : what a hot slice exceeds in the lower panel
    """
    stretches = frame_of(flutter, "flutter", _STRETCH)
    unit = "s" if stretches["start_km"].isna().any() else "km"
    hot = stretches[stretches["hot"].astype(bool)]
    title = "distance in the record [km]" if unit == "km" else "time of the record [s]"
    ends = [float(stretches[f"start_{unit}"].iloc[0]), float(stretches[f"end_{unit}"].iloc[-1])]
    layout = {"xaxis": axis(title, range=ends)}
    slices = None if flutter_track is None else frame_of(flutter_track, "flutter_track", _SLICE, empty=True)
    frequency = stretches["frequency_hz"].to_numpy(dtype=np.float64)
    x = stretches[[f"start_{unit}", f"end_{unit}"]].to_numpy(dtype=np.float64).mean(axis=1)
    if slices is None or not len(slices):
        data, shares_of_height = _of_stretches(stretches, unit), {}
    else:
        drawn = _clearest(slices)
        frequency = drawn["frequency_hz"].to_numpy(dtype=np.float64)
        x = drawn["time_s" if unit == "s" else "km"].to_numpy(dtype=np.float64)
        data = [*_of_slices(drawn, x, unit), _level(drawn, x, unit)]
        layout["xaxis"] |= {"anchor": "y2"}
        layout["yaxis2"] = axis("rms / reference [-]", domain=[0.0, 0.26], rangemode="tozero", nticks=4)
        shares_of_height = {"domain": [0.36, 1.0]}
    modes, places = modes_drawn(coincidence, frequency), (x - ends[0]) / max(ends[1] - ends[0], 1e-12)
    seen = np.concatenate([frequency[np.isfinite(frequency)], modes["frequency_hz"].to_numpy(dtype=np.float64)])
    low, high = (float(seen.min()), float(seen.max())) if seen.size else (0.0, 1.0)
    room = 0.08 * max(high - low, 1.0)
    layout["yaxis"] = axis(
        "dominant frequency [Hz]", range=[max(0.0, low - room), high + 1.6 * room], **shares_of_height
    )
    lines = [across(f, INK, 1.2, "dash") for f in modes["frequency_hz"]]
    if hot_factor is not None and "yaxis2" in layout:
        lines.append(across(float(hot_factor), QUIET, 1, "dash", on="y2"))
    return figure(
        data,
        height=400 if "yaxis2" in layout else 300,
        shapes=[*(shaded(a, b) for a, b in _merged(hot, unit, ends)), *lines],
        annotations=_names_of(modes, high - low + 2.6 * room, places, frequency),
        **layout,
    )


def modes_drawn(coincidence: ResultTable | None, frequency: Floats) -> pd.DataFrame:
    """Modes of equipment, each once, that a figure of hunting at these frequencies [Hz] has a line for."""
    columns = ["equipment", "frequency_hz"]
    if coincidence is None:
        return pd.DataFrame({"equipment": np.empty(0, dtype=object), "frequency_hz": np.empty(0)})
    modes = frame_of(coincidence, "coincidence", columns, empty=True)[columns].drop_duplicates()
    known = frequency[np.isfinite(frequency)]
    if not known.size:
        return modes.head(0)
    near = modes[modes["frequency_hz"] <= FARTHEST * known.max()]
    order = np.argsort((near["frequency_hz"] - np.median(known)).abs().to_numpy(), kind="stable")[:MOST_MODES]
    return near.iloc[order].sort_values("frequency_hz", kind="stable")


def _names_of(modes: pd.DataFrame, height: float, x: Floats, y: Floats) -> list[Trace]:
    """Names of the modes on their lines, where fewest points are; those of lines that lie close together are one text.

    ``height`` of the panel [Hz]; ``x`` and ``y`` of the points, x from 0 to 1.
    """
    groups: list[list[tuple[str, float]]] = []
    for name, frequency in modes.itertuples(index=False):
        words = f"{in_figure(name, 24)} {frequency:.4g} Hz"
        if groups and frequency - groups[-1][-1][1] < 0.09 * height:
            groups[-1].append((words, frequency))
        else:
            groups.append([(words, frequency)])
    notes = []
    for group in groups:
        low, high = group[0][1], group[-1][1]
        above, below = (y >= high) & (y < high + 0.1 * height), (y <= low) & (y > low - 0.1 * height)
        places = [
            (int(np.count_nonzero(across_ & along)), side, anchor, at)
            for along, side in ((x > 0.75, 1), (x < 0.25, 0))
            for across_, anchor, at in ((above, "bottom", high), (below, "top", low))
        ]
        _, side, anchor, at = min(places, key=lambda place: place[0])  # the first of those that are equally free
        notes.append(
            {
                "x": side,
                "xref": "x domain",
                "y": at,
                "text": ", ".join(words for words, _ in group),
                "xanchor": "right" if side else "left",
                "yanchor": anchor,
                "showarrow": False,
                "font": {"size": 11, "color": INK},
                "bgcolor": "rgba(255,255,255,0.7)",
            }
        )
    return notes


def _of_stretches(stretches: pd.DataFrame, unit: str) -> list[Trace]:
    """The frequency of each stretch as a line from its start to its end."""
    data = []
    for name, look, rows in _hot_and_not(stretches):
        ends = rows[[f"start_{unit}", f"end_{unit}"]].to_numpy(dtype=np.float64)
        x = np.column_stack([ends, np.full(len(rows), np.nan)]).ravel()
        line = {"color": look, "width": 3}
        more = {"hovertemplate": f"%{{x:.4g}} {unit}: %{{y:.3g}} Hz<extra>{name}</extra>", "name": name}
        y = np.repeat(rows["frequency_hz"].to_numpy(dtype=np.float64), 3)
        data.append({"type": "scatter", "mode": "lines", "x": single(x), "y": single(y), "line": line, **more})
    return data


def _of_slices(slices: pd.DataFrame, x: Floats, unit: str) -> list[Trace]:
    """The frequency of each slice, the larger the point the clearer it is."""
    path = {
        "type": "scatter",
        "mode": "lines",
        "x": single(x),
        "y": single(slices["frequency_hz"]),
        "line": {"color": GRID, "width": 1},
        "hoverinfo": "skip",
        "showlegend": False,
    }
    data: list[Trace] = [path]
    for name, look, rows in _hot_and_not(slices.assign(x=x)):
        data.append(
            {
                "type": "scatter",
                "mode": "markers",
                "name": name,
                "x": single(rows["x"]),
                "y": single(rows["frequency_hz"]),
                "marker": {"color": look, "size": single(3.0 + 6.0 * rows["share"].to_numpy()), "line": {"width": 0}},
                "customdata": single(rows["share"]),
                "hovertemplate": f"%{{x:.4g}} {unit}: %{{y:.3g}} Hz, %{{customdata:.0%}} of the band"
                f"<extra>{name}</extra>",
            }
        )
    return data


def _hot_and_not(rows: pd.DataFrame) -> list[tuple[str, str, pd.DataFrame]]:
    """Name, colour and rows of what is not hot and of what is, each where there are any."""
    is_hot = rows["hot"].to_numpy(dtype=bool)
    both = (("not hot", ACCENT, rows[~is_hot]), ("hot stretch", MISSED, rows[is_hot]))
    return [(name, colour, some) for name, colour, some in both if len(some)]


def _level(slices: pd.DataFrame, x: Floats, unit: str) -> Trace:
    """How many times the reference the rms is, slice by slice."""
    reference = slices["reference_rms"].to_numpy(dtype=np.float64)
    level = np.divide(
        slices["rms"].to_numpy(dtype=np.float64), reference, out=np.full(len(x), np.nan), where=reference > 0.0
    )
    return {
        "type": "scatter",
        "mode": "lines",
        "yaxis": "y2",
        "x": single(x),
        "y": single(level),
        "line": {"color": INK, "width": 1.4},
        "showlegend": False,
        "hovertemplate": f"%{{x:.4g}} {unit}: %{{y:.3g}} times the reference<extra></extra>",
    }


def _clearest(slices: pd.DataFrame) -> pd.DataFrame:
    """Slices that are drawn: all, or of a long track the one with the largest share in each of many equal parts."""
    if len(slices) <= MOST_SLICES:
        return slices
    edges = np.linspace(0, len(slices), MOST_SLICES + 1).astype(int)
    of = np.nan_to_num(slices["share"].to_numpy(dtype=np.float64))
    return slices.iloc[[a + int(of[a:b].argmax()) for a, b in pairwise(edges)]]


def _merged(hot: pd.DataFrame, unit: str, ends: list[float]) -> list[tuple[float, float]]:
    """Hot stretches; those closer together than an eye can tell, a thousandth of the event, are one."""
    spans: list[tuple[float, float]] = []
    for start, end in hot[[f"start_{unit}", f"end_{unit}"]].to_numpy(dtype=np.float64).tolist():
        if spans and start - spans[-1][1] < 1e-3 * (ends[1] - ends[0]):
            spans[-1] = (spans[-1][0], end)
        else:
            spans.append((start, end))
    return spans


def damage_in_hot_stretches(hot_damage: ResultTable) -> Figure:
    """Share of the damage of an event in the hot stretches of a channel, weld by weld, and that of its length.

    ``hot_damage`` are rows of one event and channel of the table of this name, the first of them on top. Where the
    bar passes the line, hot stretches hold more of the damage than of the length.
    """
    columns = ("weld", "damage_per_km", "share_inside", "length_share_inside", "intensity")
    rows = frame_of(hot_damage, "hot_damage", columns)
    inside, length = rows["share_inside"].to_numpy(dtype=np.float64), float(rows["length_share_inside"].iloc[0])
    places = np.arange(len(rows))
    bars = {
        "type": "bar",
        "orientation": "h",
        "y": places,
        "x": single(inside),
        "marker": {"color": np.where(inside > length, ACCENT, QUIET).tolist()},
        "text": [share(value) for value in inside],
        "textposition": ["inside" if value > INSIDE else "outside" for value in inside],
        "insidetextanchor": "start",
        "cliponaxis": False,
        "customdata": [[number(value) for value in row] for row in rows[["intensity", "damage_per_km"]].to_numpy()],
        "hovertemplate": "%{x:.1%} of the damage, %{customdata[0]} times as much per length as outside<br>"
        "damage of the event %{customdata[1]} per km<extra></extra>",
    }
    note = {
        "x": length,
        "y": 1,
        "yref": "paper",
        "yanchor": "bottom",
        "showarrow": False,
        "text": f"{share(length)} of the length",
    }
    return figure(
        [bars],
        height=96 + 24 * max(len(rows), 2),
        showlegend=False,
        margin={"l": 20, "r": 30, "t": 26, "b": 46},
        xaxis=axis("damage in hot stretches [%]", tickformat=".0%", range=[0.0, 1.12]),
        yaxis={
            "tickvals": places.tolist(),
            "ticktext": [in_figure(weld) for weld in rows["weld"]],
            "range": [len(rows) - 0.5, -0.5],
            "showgrid": False,
            "automargin": True,
            "ticks": "",
        },
        shapes=[upright(length, INK, 1.5, "dash")],
        annotations=[note],
    )
