"""Where the channels of a ride are hot, and what that does to the welds: a table, figures, a line of page one."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from fatigue.report import figures
from fatigue.report.figures.ride import modes_drawn
from fatigue.report.sections.cells import Heading, PageTable, integer, linked, num, percent, text
from fatigue.report.sections.embed import Figures, Shown
from fatigue.report.sections.ride.read import HeardChannel, ShownRide
from fatigue.report.wording import listed, number, share, short
from fatigue.shown import few

MOST_TRACKS = 6  # drawn, those with most of their event in hot stretches
MOST_COMPARED = 4  # events and channels whose damage in hot stretches is drawn, those with most of it there
WELDS_DRAWN = 20
MOST_ROWS = 100


def hunting_table(ride: ShownRide, links: Mapping[str, str]) -> PageTable:
    """Every channel: its hot stretches, their frequency, and the weld that the event damages most."""
    rows = []
    for of in ride.channels[:MOST_ROWS]:
        worst = of.worst
        rows.append(
            (
                text(of.event),
                text(of.channel),
                integer(len(of.hot) if of.is_tracked else None),
                percent(of.length_share),
                num(of.hunting_hz),
                *(
                    (text(None), num(None), percent(np.nan), num(None))
                    if worst is None
                    else (
                        linked(worst["weld"], links),
                        num(worst["damage_per_km"]),
                        percent(worst["share_inside"]),
                        num(worst["intensity"]),
                    )
                ),
                text(of.reason),
            )
        )
    headings = (
        Heading("event", numeric=False),
        Heading("channel", numeric=False),
        Heading("hot stretches"),
        Heading("of the length", "%"),
        Heading("dominant frequency", "Hz"),
        Heading("weld the event damages most", numeric=False),
        Heading("damage there", "1/km"),
        Heading("of it in hot stretches", "%"),
        Heading("times as dense as outside", "-"),
        Heading("note", numeric=False),
    )
    return PageTable("ride-hunting", headings, tuple(rows))


def track_figures(ride: ShownRide, figs: Figures) -> tuple[list[Shown], str]:
    """Dominant frequency of the channels of bogies along their events, and words about those not drawn."""
    there = [of for of in ride.bogies if of.is_tracked]
    order = np.argsort([-of.length_share for of in there], kind="stable")[:MOST_TRACKS]
    factor = ride.said.get("rules", {}).get("hot_factor")
    drawn = [
        figs.add(
            f"ride-track-{number_}",
            figures.hunting_along_event(of.stretches, of.track if len(of.track) else None, of.modes, factor),
            _track_caption(of, factor),
            wide=True,
            of_curve=False,
        )
        for number_, of in enumerate((there[i] for i in sorted(order)), start=1)
    ]
    return drawn, _left_out(len(drawn), len(there), "tracks of channels", "flutter_track.parquet")


def _track_caption(of: HeardChannel, factor: float | None) -> str:
    hot = f"hot stretches grey, {share(of.length_share)} of the length" if len(of.hot) else "no hot stretch"
    said = [f"Dominant frequency of '{short(of.channel)}' in '{short(of.event)}': {hot}"]
    if len(of.track):
        said.append("the larger a point, the more of the power of the band lies within 0.5 Hz of it")
        level = "" if factor is None else f", dashed at {factor:g}"
        said.append(f"below, rms of the band over its reference{level}")
    else:
        said.append("the median of each stretch; no track is stored")
    frequency = (of.track if len(of.track) else of.stretches)["frequency_hz"].to_numpy(dtype=np.float64)
    named = modes_drawn(of.modes, frequency)
    if len(named):
        said.append("dashed lines are modes of equipment")
    others = of.modes[~of.modes["equipment"].isin(named["equipment"])]
    if len(others):
        names = [f"{short(str(row.equipment))} ({row.frequency_hz:.4g} Hz)" for row in others.itertuples()]
        said.append(f"not drawn: {few(names)}")
    return "; ".join(said)


def damage_figures(ride: ShownRide, figs: Figures) -> tuple[list[Shown], str]:
    """Damage in hot stretches weld by weld, of events that have both, and words about those not drawn."""
    there = [of for of in ride.bogies if of.length_share > 0.0 and of.worst is not None]
    order = np.argsort([-_most_inside(of) for of in there], kind="stable")[:MOST_COMPARED]
    drawn = [_damage_figure(there[i], place, figs) for place, i in enumerate(sorted(order), start=1)]
    return drawn, _left_out(len(drawn), len(there), "events and channels with hot stretches", "hot_damage.parquet")


def _most_inside(of: HeardChannel) -> float:
    """Largest damage in hot stretches, over what the weld may bear [1/km]."""
    return float(np.nanmax((of.welds["severity"] * of.welds["share_inside"]).to_numpy(), initial=0.0))


def _damage_figure(of: HeardChannel, place: int, figs: Figures) -> Shown:
    damaged = of.welds[of.welds["share_inside"].notna()].sort_values("severity", ascending=False, kind="stable")
    some = damaged.head(WELDS_DRAWN)
    caption = f"Damage of '{short(of.event)}' inside the hot stretches of '{short(of.channel)}' against their length, "
    caption += "the weld that it damages most on top"
    if len(damaged) > len(some):
        caption += f"; {len(some)} of {len(damaged)} welds"
    return figs.add(f"ride-damage-{place}", figures.damage_in_hot_stretches(some), caption)


def _left_out(drawn: int, there: int, what: str, table: str) -> str:
    """Words about what is not drawn of many; empty where all is."""
    return f"{drawn} of {there} {what} are drawn, the hottest; the others are in {table}." if there > drawn else ""


def in_one_line(ride: ShownRide) -> str:
    """What page one says of a ride: where hot stretches hold more of the damage than of the length; empty: nowhere.

    Of several channels it is the one whose hot stretches do most damage at the weld that the event damages most.
    Without any, it is a hot stretch that hunts close to a mode of equipment.
    """
    denser = [(of, worst) for of in ride.bogies if (worst := of.worst) is not None and _is_denser(of, worst)]
    if denser:
        of, worst = max(denser, key=lambda pair: pair[1]["severity"] * pair[1]["share_inside"])
        text_ = (
            f"{share(worst['share_inside'])} of the damage of '{short(of.event)}' at {short(worst['weld'])} lies in "
        )
        text_ += f"hot stretches of '{short(of.channel)}' ({share(of.length_share)} of its length)"
        return f"{text_}{_met(of)}{_ALARM.get(of.told, '')}"
    for of in ride.bogies:
        if len(of.hot) and (met := _met(of)):
            return f"'{short(of.channel)}' hunts in {share(of.length_share)} of '{short(of.event)}'{met}"
    return ""


_ALARM = {"missed": "; the alarm tells nothing of it", "yes": "; the alarm goes off"}


def _is_denser(of: HeardChannel, worst: "pd.Series[object]") -> bool:
    """Whether hot stretches hold more of the damage than of the length."""
    return bool(worst["share_inside"] > of.length_share > 0.0)


def _met(of: HeardChannel) -> str:
    """Modes of equipment that the hunting is close to, in words; empty: none."""
    red = of.modes[of.modes["flag"] == "red"]
    names = [f"'{short(str(row.equipment))}' ({row.frequency_hz:.4g} Hz)" for row in red.itertuples()]
    more = f" and {len(names) - 2} more" if len(names) > 2 else ""
    frequency = number(of.hunting_hz)
    return f"; hunting at {frequency} Hz is close to {listed(names[:2])}{more}" if names else ""
