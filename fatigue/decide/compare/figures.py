"""Figures of a comparison: ratios of lives weld by weld, and what they are made of."""

import math
from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from fatigue.decide.compare.pairs import WELD, Pair
from fatigue.decide.compare.split import EVENT, LIMIT, MISSION, MODE, PER_PASS, SEQUENCE, UNIT_LOAD
from fatigue.decide.compare.words import coordinate, mode_names
from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.figures.style import GRID, MISSED, QUIET, SERIES, axis, event_colours, figure, upright
from fatigue.report.wording import in_figure, life_km

MOST_WELDS = 30  # drawn, those whose life changes most; the table has all
MOST_CAUSED = 12  # welds whose causes are drawn
MOST_MODES = 6
ROW_PX = 26
MARKS = ("circle", "diamond", "square", "triangle-up", "cross", "x")
LEAST, MOST = math.log(1.25), math.log(1e6)  # how far the axis goes to either side of 1
TICKS = (1.1, 1.2, 1.5, 2.0, 3.0, 5.0, 10.0, 30.0, 100.0, 1e3, 1e4, 1e5, 1e6)
ROUNDING = 1e-9  # of a log ratio: no bar
APART = 0.19  # of the reach of an axis, between two ticks


def ratio_figure(pairs: Sequence[Pair]) -> Figure | None:
    """Life ratio of each weld, a mark for every other result; None where no ratio is finite.

    Open marks: the weld meets its target in one of the two only.
    """
    tables = {pair.other.letter: pair.welds[np.isfinite(pair.welds["log_life_ratio"])] for pair in pairs}
    largest: dict[str, float] = {}
    first: dict[str, float] = {}
    for table in tables.values():
        for weld, log in zip(table["weld"], table["log_life_ratio"], strict=True):
            largest[weld] = max(largest.get(weld, 0.0), abs(log))
            first.setdefault(weld, log)
    if not largest:
        return None
    drawn = sorted(sorted(largest, key=lambda weld: -largest[weld])[:MOST_WELDS], key=lambda weld: first[weld])
    data = [_marks(letter, number, table, drawn) for number, (letter, table) in enumerate(tables.items())]
    return figure(
        data,
        height=100 + ROW_PX * len(drawn),
        margin={"l": 24, "r": 16, "t": 40, "b": 50},
        xaxis=_ratio_axis("life there / life in A [-]", max(largest.values())),
        yaxis=_weld_axis(drawn),
        shapes=[upright(0.0, QUIET, dash="solid")],
        showlegend=True,
    )


def _marks(letter: str, number: int, table: pd.DataFrame, welds: Sequence[str]) -> Trace:
    place = {weld: row for row, weld in enumerate(welds)}
    shown = table[table["weld"].isin(welds)]
    colour, mark = SERIES[number % len(SERIES)], MARKS[number % len(MARKS)]
    facts = [
        [in_figure(row.weld), f"{row.life_ratio:.3g}", life_km(row.life_km), life_km(row.other_life_km),
         {"lost": ", misses its target now", "gained": ", meets its target now"}.get(row.flip, "")]
        for row in shown.itertuples(index=False)
    ]  # fmt: skip
    return {
        "type": "scatter",
        "mode": "markers",
        "name": f"{letter} over A",
        "x": np.clip(shown["log_life_ratio"], -MOST, MOST),
        "y": [place[weld] for weld in shown["weld"]],
        "marker": {
            "size": 9,
            "color": colour,
            "symbol": [f"{mark}-open" if flip else mark for flip in shown["flip"]],
            "line": {"width": 2, "color": [MISSED if flip == "lost" else colour for flip in shown["flip"]]},
        },
        "customdata": facts,
        "hovertemplate": "%{customdata[0]}: %{customdata[1]} times%{customdata[4]}<br>%{customdata[2]}, then "
        "%{customdata[3]}<extra></extra>",
    }


def event_figure(pair: Pair) -> Figure | None:
    """What events add to the log ratio of the welds that change most, stacked; None without causes.

    Plain: the damage of a pass, or all of an event that cannot be split; hatched: how often it occurs.
    """
    rows = pair.causes[
        (pair.causes["scope"] == WELD) & pair.causes["kind"].isin((LIMIT, SEQUENCE, EVENT, MISSION, PER_PASS))
    ]
    parts = rows[rows["kind"].isin((MISSION, PER_PASS))].set_index(["weld", "event"]).index
    whole = rows["kind"].isin((EVENT, SEQUENCE)) & pd.MultiIndex.from_frame(rows[["weld", "event"]]).isin(parts)
    rows = rows[~whole & (rows["log_life_ratio"].abs() > ROUNDING)]
    colour = event_colours(list(dict.fromkeys([*pair.first.passes, *pair.other.passes])))
    names = {LIMIT: "damage limit", MISSION: ", how often"}
    labelled = rows.assign(
        label=np.where(
            rows["kind"] == LIMIT, names[LIMIT], rows["event"] + np.where(rows["kind"] == MISSION, names[MISSION], "")
        ),
        hatch=np.where(rows["kind"] == MISSION, "/", ""),
        colour=rows["event"].map(colour).fillna(QUIET),
    )
    return _stacked(pair, labelled)


def mode_figure(pair: Pair) -> Figure | None:
    """What modes and unit loads add, over all events, at the welds that change most; None without a diagnosis."""
    rows = pair.causes[(pair.causes["scope"] == WELD) & pair.causes["kind"].isin((MODE, UNIT_LOAD))]
    if not (rows["log_life_ratio"].abs() > ROUNDING).any():
        return None
    names = mode_names(pair.first.record)
    labels = [coordinate(mode, load, names) for mode, load in zip(rows["mode"], rows["unit_load"], strict=True)]
    rows = rows.assign(label=labels).groupby(["weld", "label"], sort=False, as_index=False)["log_life_ratio"].sum()
    drawn = _changing(pair)
    size = rows[rows["weld"].isin(drawn)].groupby("label")["log_life_ratio"].agg(lambda some: some.abs().sum())
    kept = size.sort_values(ascending=False).index[:MOST_MODES].tolist()
    rows = rows.assign(label=rows["label"].where(rows["label"].isin(kept), "all others"))
    rows = rows.groupby(["weld", "label"], sort=False, as_index=False)["log_life_ratio"].sum()
    colour: Mapping[str, str] = dict(zip([*kept, "all others"], [*SERIES[: len(kept)], QUIET], strict=True))
    order = {label: number for number, label in enumerate(colour)}
    rows = rows.sort_values("label", key=lambda labels: labels.map(order), kind="stable")
    return _stacked(pair, rows.assign(hatch="", colour=rows["label"].map(colour)))


def _changing(pair: Pair) -> list[str]:
    """Welds whose causes are drawn: those whose life changes most, from the largest loss to the largest gain."""
    welds = pair.welds[np.isfinite(pair.welds["log_life_ratio"])]
    most = welds.loc[welds["log_life_ratio"].abs().sort_values(ascending=False).index[:MOST_CAUSED]]
    found: list[str] = most.sort_values("log_life_ratio")["weld"].tolist()
    return found


def _stacked(pair: Pair, rows: pd.DataFrame) -> Figure | None:
    """Bars of ``weld``, ``label``, ``colour``, ``hatch`` and ``log_life_ratio``, and a mark at their sum."""
    drawn = [weld for weld in _changing(pair) if weld in set(rows["weld"])]
    rows = rows[rows["weld"].isin(drawn)]
    if rows.empty:
        return None
    place = {weld: row for row, weld in enumerate(drawn)}
    data: list[Trace] = []
    for label, some in rows.groupby("label", sort=False):
        first = some.iloc[0]
        facts = [
            [in_figure(weld), f"{math.exp(log):.3g}"]
            for weld, log in zip(some["weld"], some["log_life_ratio"], strict=True)
        ]
        data.append(
            {
                "type": "bar",
                "orientation": "h",
                "name": in_figure(str(label)),
                "x": some["log_life_ratio"].to_numpy(),
                "y": [place[weld] for weld in some["weld"]],
                "width": 0.66,
                "marker": {"color": first["colour"], "pattern": {"shape": first["hatch"]}, "line": {"width": 0}},
                "customdata": facts,
                "hovertemplate": f"%{{customdata[0]}}, {in_figure(str(label))}: x %{{customdata[1]}}<extra></extra>",
            }
        )
    total = rows.groupby("weld")["log_life_ratio"].sum().reindex(drawn)
    data.append(
        {
            "type": "scatter",
            "mode": "markers",
            "name": "in all",
            "x": total.to_numpy(),
            "y": list(range(len(drawn))),
            "marker": {"symbol": "diamond", "size": 9, "color": "#ffffff", "line": {"width": 2, "color": "#1c2530"}},
            "customdata": [[in_figure(weld), f"{math.exp(log):.3g}"] for weld, log in total.items()],
            "hovertemplate": "%{customdata[0]}, in all: x %{customdata[1]}<extra></extra>",
        }
    )
    sides = [
        rows[sign * rows["log_life_ratio"] > 0.0].groupby("weld")["log_life_ratio"].sum().abs().max()
        for sign in (1, -1)
    ]
    return figure(
        data,
        height=110 + ROW_PX * len(drawn) + 18 * (rows["label"].nunique() // 3),
        margin={"l": 24, "r": 16, "t": 60, "b": 50},
        barmode="relative",
        xaxis=_ratio_axis("factor on the life [-]", float(np.nanmax([*sides, LEAST]))),
        yaxis=_weld_axis(drawn),
        shapes=[
            upright(0.0, QUIET, dash="solid"),
            *({"type": "line", "xref": "paper", "x0": 0, "x1": 1, "y0": row + 0.5, "y1": row + 0.5,
               "line": {"color": GRID, "width": 1}} for row in range(len(drawn) - 1)),
        ],
    )  # fmt: skip


def _ratio_axis(title: str, reach: float) -> Trace:
    """Axis of log ratios, its ticks written as factors."""
    reach = min(max(1.15 * reach, LEAST), MOST)
    steps: list[float] = []
    for tick in TICKS:
        if APART * reach <= math.log(tick) - math.log(steps[-1] if steps else 1.0) and math.log(tick) <= reach:
            steps.append(tick)
    ticks = [*(-math.log(t) for t in steps[::-1]), 0.0, *(math.log(t) for t in steps)]
    words = [*(f"1/{t:g}" if t >= 2.0 else f"{1.0 / t:.2g}" for t in steps[::-1]), "1", *(f"{t:g}" for t in steps)]
    return axis(title, range=[-reach, reach], tickvals=ticks, ticktext=words)


def _weld_axis(welds: Sequence[str]) -> Trace:
    return axis(
        "",
        tickvals=list(range(len(welds))),
        ticktext=[in_figure(weld, 26) for weld in welds],
        range=[len(welds) - 0.4, -0.6],
        automargin=True,
        showgrid=False,
    )
