"""The cycles of a loop of events as they should be, beside those in the table: what closes, and what is replaced.

A cycle that closes and the same one that is replaced say nothing: both sides are compared without such pairs.
"""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.verify.recount.anew.across_events.sequence import Net
from fatigue.verify.recount.anew.mission import RecountEvent
from fatigue.verify.recount.anew.point import OnePass
from fatigue.verify.recount.layout import Key
from fatigue.verify.recount.stored.compare import Row
from fatigue.verify.recount.stored.rows import NEGLIGIBLE, SMALL, place

Columns = dict[str, NDArray[np.float64]]

SAME = 1e-8  # of the largest range: cycles whose ranges and means are as close are one and the same
OF_INSTANTS = ("start_s", "end_s", "start_event", "end_event")


def loop_rows(
    key: Key, event: RecountEvent, one: OnePass, net: Net, found: pd.DataFrame, events: Sequence[str]
) -> Iterator[Row]:
    """The cycles of a loop at one point as two rows: those that close, and those that are replaced.

    As in ``rows.cycle_row`` each column is sorted, and the value that differs most is compared. ``events`` are their
    names by number.
    """
    number = {name: float(i) for i, name in enumerate(events)}
    ours: Columns = one.rows | {
        name: net.event[at].astype(float) for name, at in (("start_event", net.start), ("end_event", net.end))
    }
    theirs: Columns = {name: found[name].to_numpy() for name in one.rows}
    theirs |= {name: found[name].map(number).fillna(-1.0).to_numpy(float) for name in ("start_event", "end_event")}
    size = max(one.quantities["max_range_MPa"], float(np.max(theirs["range_MPa"], initial=0.0)))
    a, b = (_without_pairs(_in_order(side), size) for side in (ours, theirs))
    exact = one.cycle_bounds["delta"] * 2.0 <= NEGLIGIBLE * size
    for sign, what in ((1.0, "what closes"), (-1.0, "what is replaced")):
        some = [_of_sign(side, sign, NEGLIGIBLE * size) for side in (a, b)]
        if exact:
            yield _row(f"{place(key)}, event '{event.name}', {what}", some[0], some[1], size, one)


def _in_order(columns: Columns) -> Columns:
    """The same with the instants of each cycle in the order of events and time.

    A loop has no beginning: which of the two reversals of its cycles comes first depends on where counting begins.
    """
    first, last = ((columns[f"{end}_event"], columns[f"{end}_s"]) for end in ("start", "end"))
    turned = (first[0] > last[0]) | ((first[0] == last[0]) & (first[1] > last[1]))
    swapped = {"start_event": "end_event", "end_event": "start_event", "start_s": "end_s", "end_s": "start_s"}
    return columns | {name: np.where(turned, columns[other], columns[name]) for name, other in swapped.items()}


def _row(where: str, ours: Columns, theirs: Columns, size: float, one: OnePass) -> Row:
    expected, stored, scale = {}, {}, {}
    for name, column in ours.items():
        least = SMALL * size if name == "bending_ratio" else 0.0
        a, b = (np.sort(side[name][side["range_MPa"] > least]) for side in (ours, theirs))
        if not len(a) and not len(b):
            continue
        if len(a) != len(b):
            a, b = np.array([float(len(a))]), np.array([float(len(b))])
        worst = int(np.abs(a - b).argmax())
        expected[name], stored[name], scale[name] = float(a[worst]), float(b[worst]), float(np.abs(a).max())
        assert len(column) == len(ours["range_MPa"])
    if "mean_MPa" in scale:
        scale["mean_MPa"] = max(scale["mean_MPa"], size)
    bounds = dict.fromkeys(OF_INSTANTS, np.inf if one.cycle_bounds["ties"] else 0.0)
    return Row(where, stored, expected, scale, bounds=bounds)


def _of_sign(columns: Mapping[str, NDArray[np.float64]], sign: float, least: float) -> Columns:
    some = (np.sign(columns["count"]) == sign) & (columns["range_MPa"] > least)
    return {name: column[some] for name, column in columns.items()}


def _without_pairs(columns: Columns, size: float) -> Columns:
    """Cycles of the same range and mean as one, which has the sum of their counts and damages; none of sum 0."""
    if not len(columns["count"]) or size == 0.0:
        return columns
    level = np.round(np.stack([columns["range_MPa"], columns["mean_MPa"]]) / (SAME * size))
    _, at, which = np.unique(level, axis=1, return_index=True, return_inverse=True)
    merged: Columns = {name: column[at] for name, column in columns.items()}
    for name in ("count", "damage"):
        merged[name] = np.bincount(which.ravel(), columns[name]).astype(np.float64)
    left = np.abs(merged["count"]) > 1e-9
    return {name: column[left] for name, column in merged.items()}
