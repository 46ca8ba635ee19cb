"""How resonances form, of the whole body: which one to watch, and what the modes that matter do event by event."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from fatigue.report.result import ShownResult
from fatigue.report.sections.cells import Cell, Heading, PageTable, integer, life, linked, num, percent, text
from fatigue.report.sections.formation.read import SWINGS, ShownFormation, reason_of
from fatigue.report.sections.formation.words import follows, place
from fatigue.report.sections.why import Why
from fatigue.report.wording import listed, number, short

MOST_WATCHED = 15  # swings in the ranking
MOST_WATCHED_MODES, MOST_DAMAGING, MOST_SWINGING = 5, 5, 4  # modes that are shown
MOST_EVENTS = 5  # that are shown: those that damage most
MOST_NAMED = 12  # modes in a sentence


def formation_section(why: Why | None, result: ShownResult, links: Mapping[str, str]) -> dict[str, Any]:
    """What the page says of how resonances form; ``formation`` is None where no diagnosis does."""
    of = None if why is None else why.formation
    if why is None or of is None:
        return {"formation": None}
    shares = _largest_shares(why.attribution)
    modes, events = _modes_shown(of, shares), _events_shown(of, result)
    rows = of.modes[of.modes["mode"].isin(modes) & of.modes["event"].isin(events)]
    relieving = int((~(of.watch["utilisation_cost"] > 0.0)).sum())
    return {
        "formation": {
            "watch": _watch_table(of, links),
            "unlisted": max(0, len(of.costly) - MOST_WATCHED),
            "relieving": relieving,
            "nothing": _nothing(of),
            "unsplit": _unsplit(of),
            "modes": _mode_table(rows, modes, events, shares, result),
            "left_out": _left_out(of, modes, events),
            "reasons": _reasons(rows, len(events)),
            "classes": _classes(result.record),
            "damping": of.damping,
        }
    }


def _largest_shares(attribution: pd.DataFrame) -> dict[int, float]:
    """Of every mode the share, at the weld where it is largest, in the damage of the worst point."""
    rows = attribution[attribution["kind"] == "mode"]
    of_welds = rows.groupby(["weld", "mode"], sort=True)["share"].sum()
    largest = of_welds.groupby("mode", sort=True).max()
    return {int(mode): float(part) for mode, part in largest.items()}


def _modes_shown(of: ShownFormation, shares: Mapping[int, float]) -> list[int]:
    """Modes to be watched, those that damage most, and those that swing most; by id."""
    watched = list(dict.fromkeys(of.costly["mode"]))[:MOST_WATCHED_MODES]
    damaging = sorted((mode for mode in shares if shares[mode] > 0.0), key=lambda mode: -shares[mode])
    swings = of.modes[of.modes["class"].isin(SWINGS)]
    swing = (swings["rms_q"] * swings["dynamic_share"]).groupby(swings["mode"]).max()
    swinging = list(swing.sort_values(ascending=False, kind="stable").index[:MOST_SWINGING])
    return sorted({int(mode) for mode in [*watched, *damaging[:MOST_DAMAGING], *swinging]})


def _events_shown(of: ShownFormation, result: ShownResult) -> list[str]:
    """Events that damage the worst points most, in the order of the mission."""
    weighted = result.damage["damage_per_pass"] * result.damage["event"].map(result.passes_per_km)
    total = weighted.groupby(result.damage["weld"]).transform("sum")
    share = (weighted / total.where(total > 0.0)).groupby(result.damage["event"]).max().fillna(0.0)
    known = [str(event) for event in dict.fromkeys(of.modes["event"])]
    most = sorted(known, key=lambda event: -share.get(event, 0.0))[:MOST_EVENTS]
    return [event for event in known if event in most]


def _watch_table(of: ShownFormation, links: Mapping[str, str]) -> PageTable | None:
    """The ranking over all welds; None where no swing costs anything."""
    if of.costly.empty:
        return None
    rows = tuple(
        (
            integer(row["rank"]),
            linked(row["weld"], links),
            integer(row["mode"]),
            num(row["frequency_hz"]),
            Cell(_class(row["class"])),
            text(row["event"]),
            Cell(place(row), num(row["start_s"]).value),
            percent(row["damage_share"]),
            life(row["life_km"]),
            life(row["life_km_without"]),
            life(row["cost_km"]),
            num(row["utilisation_cost"]),
        )
        for row in of.costly.head(MOST_WATCHED).to_dict("records")
    )
    headings = (
        Heading("rank"),
        Heading("weld", numeric=False),
        Heading("mode"),
        Heading("frequency", "Hz"),
        Heading("class", numeric=False),
        Heading("event", numeric=False),
        Heading("half of it at", numeric=False),
        Heading("share of damage", "%"),
        Heading("life", "km"),
        Heading("life without", "km"),
        Heading("cost", "km"),
        Heading("utilisation it adds", "-"),
    )
    return PageTable("watch", headings, rows)


def _nothing(of: ShownFormation) -> str:
    """Why there is no ranking; empty where there is one."""
    if len(of.costly):
        return ""
    if of.welds.empty:
        return "Nothing damages, so no mode is to be watched."
    if all(map(reason_of, of.welds["reason"])):
        return "Whether a mode is to be watched could not be told."
    return f"No mode to watch at any weld: {follows(of)}."


def _unsplit(of: ShownFormation) -> list[str]:
    """Events whose stress could not be split, with the reason."""
    rows = of.welds[["event", "reason"]].drop_duplicates()
    reasons: dict[str, list[str]] = {}
    for event, reason in rows.itertuples(index=False):
        if reason_of(reason):
            reasons.setdefault(str(reason), []).append(short(str(event)))
    return [f"{_some(events)}: {reason}" for reason, events in reasons.items()]


def _mode_table(
    rows: pd.DataFrame, modes: Sequence[int], events: Sequence[str], shares: Mapping[int, float], result: ShownResult
) -> PageTable:
    """Modes by events; in a cell the class, the dynamic share, and what the mode hears and what it answers."""
    at = {(row["mode"], row["event"]): row for row in rows.to_dict("records")}
    of_record = result.record["modes"]
    kinds = dict(zip(of_record["used"], of_record["kind"], strict=True))
    frequency = {row["mode"]: row["frequency_hz"] for row in at.values()}
    cells = tuple(
        (
            integer(mode),
            num(frequency.get(mode)),
            text(kinds.get(mode)),
            percent(shares.get(mode, np.nan)),
            *(_of_mode(at[mode, event]) if (mode, event) in at else text(None) for event in events),
        )
        for mode in modes
    )
    headings = (
        Heading("mode"),
        Heading("frequency", "Hz"),
        Heading("kind", numeric=False),
        Heading("share of damage, at most", "%"),
        *(Heading(short(event), numeric=False) for event in events),
    )
    return PageTable("resonance", headings, cells)


def _of_mode(row: Mapping[str, Any]) -> Cell:
    """A mode in an event, sorted by its dynamic share."""
    said = [_class(row["class"])]
    if pd.notna(row["dynamic_share"]):
        said.append(f"{row['dynamic_share']:.2f}")
    if pd.notna(row["response_hz"]):
        said.append(f"{number(row['excitation_hz'])} → {number(row['response_hz'])} Hz")
    swings = "used" if row["class"] in SWINGS else ""
    return Cell("; ".join(said), num(row["dynamic_share"]).value, mark=swings)


def _left_out(of: ShownFormation, modes: Sequence[int], events: Sequence[str]) -> str:
    """What the table of modes leaves out."""
    others = sorted(set(of.modes["mode"].astype(int)) - set(modes))
    swinging = [mode for mode in others if mode in of.swinging]
    unseen = [short(str(event)) for event in dict.fromkeys(of.modes["event"]) if event not in events]
    said = []
    if others:
        one = len(others) == 1
        swing = (
            f"of which {_some(list(map(str, swinging)))} swing{'s' * (len(swinging) == 1)} in some event"
            if swinging
            else f"which swing{'s' * one} in no event"
        )
        said.append(f"{len(others)} other mode{'' if one else 's'}, {swing}")
    if unseen:
        said.append(f"the events {_some(unseen)}, which damage less")
    return f"Left out: {listed(said)}; see resonance.parquet." if said else ""


def _reasons(rows: pd.DataFrame, in_all: int) -> list[str]:
    """Why numbers of the table are empty: modes and events of each reason."""
    rows = rows[rows[["dynamic_share", "excitation_hz", "response_hz"]].isna().any(axis=1)]
    events: dict[tuple[int, str], list[str]] = {}
    for mode, event, reason in rows[["mode", "event", "reason"]].itertuples(index=False):
        if reason_of(reason):
            events.setdefault((int(mode), str(reason)), []).append(short(str(event)))
    modes: dict[tuple[str, tuple[str, ...]], list[str]] = {}
    for (mode, reason), where in events.items():
        modes.setdefault((reason, tuple(where)), []).append(str(mode))
    return [
        f"Mode{'s' * (len(of) > 1)} {_some(of)} in {'all these events' if 1 < in_all == len(where) else listed(where)}"
        f": {reason}."
        for (reason, where), of in modes.items()
    ]


def _classes(record: Mapping[str, Any]) -> str:
    """What the classes mean, with the thresholds on record."""
    bounds = (record.get("diagnosis") or {}).get("class_thresholds") or {}
    swings = f" ({bounds['dynamic_share']:g} of its rms or more)" if "dynamic_share" in bounds else ""
    return (
        f"Resonant: much of the motion is dynamic{swings}, and the mode moves more than its load alone would move it. "
        "Inertial: as much is dynamic, but its loads are faster than the mode, which moves less. "
        "Quasi-static: it follows its load."
    )


def _class(name: Any) -> str:
    return str(name).replace("quasi_static", "quasi-static").replace("_", " ")


def _some(names: Sequence[str]) -> str:
    """Names, of many the first."""
    more = len(names) - MOST_NAMED
    return listed([*names[:MOST_NAMED], f"{more} more"] if more > 0 else list(names))
