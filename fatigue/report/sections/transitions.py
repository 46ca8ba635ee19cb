"""What cycles across events do at the worst points: a table of the welds, and its caption."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from fatigue.report.result import ShownResult
from fatigue.report.sections.cells import Heading, PageTable, linked, num, percent, text

MOST = 20  # welds listed

WITH_LOOPS = (
    "Cycles across the events of each sequence, less the cycles of single events that they replace. Cycles between one "
    "sequence and another are not counted."
)
UNKNOWN_ORDER = (
    "What no order of the stints adds more than to the damage, which is not in the lives of this page: give the order "
    "in [[mission.sequence]] where it is a large part."
)


def transitions(result: ShownResult, links: Mapping[str, str]) -> dict[str, Any]:
    """Table of the cycles across events at the worst point of each detailed weld; nothing where no events join."""
    points = pd.DataFrame([result.worst(weld) for weld in result.detailed])
    name, caption = "damage_per_km_transitions", WITH_LOOPS
    if name not in points or points[name].isna().all():
        name, caption = "damage_per_km_transitions_bound", UNKNOWN_ORDER
    if name not in points or points[name].isna().all():
        return {"transitions": None, "transitions_caption": "", "sequences": []}
    with np.errstate(invalid="ignore", divide="ignore"):
        share = (points[name] / points["damage_per_km"]).to_numpy(dtype=np.float64)
    order = np.argsort(-np.nan_to_num(np.abs(share)), kind="stable")[:MOST]
    rows = tuple(
        (
            linked(row.weld, links),
            num(row.damage_per_km),
            num(getattr(row, name)),
            percent(part if np.isfinite(part) else np.nan),
            num(row.max_range_MPa),
            text(row.governing_event),
        )
        for row, part in zip(points.iloc[order].itertuples(), share[order], strict=True)
    )
    headings = (
        Heading("weld", numeric=False),
        Heading("damage", "1/km"),
        Heading("across events" if caption is WITH_LOOPS else "across events, at most", "1/km"),
        Heading("of the damage", "%"),
        Heading("largest range", "MPa"),
        Heading("governing event", numeric=False),
    )
    return {
        "transitions": PageTable("transitions", headings, rows),
        "transitions_caption": caption,
        "sequences": [
            f"{loop['name']}: {' – '.join(loop['order'])}, {1000.0 * loop['runs_per_km']:g} in 1000 km"
            for loop in result.record["mission"].get("sequences", [])
        ],
    }
