"""The event and the cycles that damage a point most."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from fatigue.report.of_record import Record, events_of, weights_of

OF_CYCLES = ("event", "start_s", "end_s", "count", "damage")


def leading_event(damage: pd.DataFrame, record: Record) -> str | None:
    """The event that damages a point most in a km, of those with a record: no sequence; None where there is none.

    ``damage`` has a row of each event with its ``damage_per_pass``.
    """
    rows = damage[damage["event"].isin([event["event"] for event in events_of(record)])]
    per_km = rows["damage_per_pass"] * rows["event"].map(weights_of(record)).astype(float)
    return None if per_km.empty else str(rows.loc[per_km.idxmax(), "event"])


def most_damaging(cycles: pd.DataFrame, event: str | None, most: int) -> Sequence[tuple[float, float]]:
    """Instants of the most damaging cycles of an event [s], the worst first; none where its cycles are not kept.

    ``cycles`` has the columns ``OF_CYCLES`` of the table of cycles.
    """
    cycles = cycles[cycles["event"] == event]
    each = (cycles["damage"] / cycles["count"]).to_numpy()
    worst = cycles.iloc[np.argsort(-each, kind="stable")[:most]]
    return [(float(start), float(end)) for start, end in zip(worst["start_s"], worst["end_s"], strict=True)]
