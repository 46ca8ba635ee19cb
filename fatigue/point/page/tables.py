"""Tables of the page of a point: its most damaging cycles, both domains event by event, all numbers of its row."""

from collections.abc import Collection

import numpy as np
import pandas as pd

from fatigue.point.page.gathered import Gathered
from fatigue.report.of_record import weights_of
from fatigue.report.sections.cells import Cell, Heading, PageTable, num, percent, text, verdict
from fatigue.report.wording import NOT_AVAILABLE, number
from fatigue.results import NODES

MOST_CYCLES = 12


def worst_cycles(found: Gathered) -> pd.DataFrame:
    """The most damaging cycles of all events, with ``share`` of the damage of the point and the rank.

    A cycle counts as often as its event; those that a sequence replaces and merged ones are left out.
    """
    rows = found.cycles[(found.cycles["count"] > 0.0) & found.cycles["start_s"].notna()]
    weights = rows["event"].map(weights_of(found.record)).astype(float)
    total = float(found.counted["damage_per_km"])
    per_km = rows["damage"] * weights
    share = per_km / total if total > 0.0 else 0.0 * per_km
    ranked = rows.assign(share=share).sort_values(["share", "range_MPa"], ascending=False, kind="stable")
    return ranked.head(MOST_CYCLES).reset_index(drop=True)


def cycle_table(found: Gathered) -> PageTable:
    """The most damaging cycles with their instants."""
    rows = tuple(
        (
            Cell(str(rank), float(rank)),
            text(row.event),
            num(row.start_s),
            num(row.end_s),
            num(row.range_MPa),
            num(row.mean_MPa),
            num(row.bending_ratio),
            num(row.equivalent_range_dS),
            num(row.count_),
            percent(row.share),
        )
        for rank, row in enumerate(_renamed(worst_cycles(found)).itertuples(), start=1)
    )
    unit = "MPa mm^(−0.222)" if found.record["curves"][found.weld["curve"]]["applies"] == "dS" else "MPa"
    headings = (
        Heading("rank"),
        Heading("event", numeric=False),
        Heading("from", "s"),
        Heading("to", "s"),
        Heading("range", "MPa"),
        Heading("mean", "MPa"),
        Heading("bending ratio", "-"),
        Heading("equivalent range", unit),
        Heading("count", "-"),
        Heading("share of damage", "%"),
    )
    return PageTable("worst-cycles", headings, rows)


def _renamed(cycles: pd.DataFrame) -> pd.DataFrame:
    """The same without columns that ``itertuples`` would take for methods of a tuple."""
    return cycles.rename(columns={"count": "count_"})


def leading_events(found: Gathered, most: int) -> list[str]:
    """The events that damage most, in the order of the mission."""
    weights = found.damage["event"].map(weights_of(found.record)).astype(float)
    damage = (found.damage["damage_per_pass"] * weights).to_numpy()
    return [str(event) for event in found.damage["event"].iloc[np.sort(np.argsort(-damage, kind="stable")[:most])]]


def domains_table(found: Gathered, events: Collection[str]) -> PageTable:
    """Damage of some events by rainflow and by both estimates, and whether these may be trusted."""
    weights = weights_of(found.record)
    judged = dict(zip(found.why.diagnosis["event"], found.why.diagnosis["verdict"], strict=True))
    rows = []
    for row in found.damage[found.damage["event"].isin(events)].itertuples():
        often = weights[row.event]
        ratio = row.damage_dirlik_per_pass / row.damage_same_ratio_per_pass if row.damage_same_ratio_per_pass else None
        rows.append(
            (
                Cell(row.event),
                num(often * row.damage_per_pass),
                num(often * row.damage_same_ratio_per_pass),
                num(often * row.damage_dirlik_per_pass),
                num(often * row.damage_tb_per_pass),
                num(ratio),
                text(str(judged.get(row.event, "")).replace("_", " ")),
            )
        )
    headings = (
        Heading("event", numeric=False),
        Heading("rainflow", "1/km"),
        Heading("rainflow, one bending ratio", "1/km"),
        Heading("Dirlik", "1/km"),
        Heading("Tovo-Benasciutti", "1/km"),
        Heading("Dirlik / rainflow", "-"),
        Heading("trust in Dirlik", numeric=False),
    )
    return PageTable("both-domains", headings, tuple(rows))


def number_table(found: Gathered) -> PageTable:
    """Every number of the row in ``nodes.parquet`` with its meaning; what was counted now beside bounds."""
    rows = []
    for column in NODES:
        stored = found.stored.get(column.name)
        cells = [Cell(column.name), _value(stored)]
        if found.is_screened:
            cells.append(_value(found.counted.get(column.name)) if column.name in found.counted.index else text(None))
        rows.append((*cells, Cell(column.unit.replace("-", NOT_AVAILABLE)), Cell(column.meaning)))
    beside = [Heading("counted now", numeric=False)] if found.is_screened else []
    headings = (
        Heading("column", numeric=False),
        Heading("bound in the result" if found.is_screened else "value", numeric=False),
        *beside,
        Heading("unit", numeric=False),
        Heading("meaning", numeric=False),
    )
    return PageTable("numbers", headings, tuple(rows), "Find a number")


def _value(value: object) -> Cell:
    if value is None or pd.isna(value):
        return text(None)
    if isinstance(value, str):
        return text(value)
    if isinstance(value, bool) or str(getattr(value, "dtype", "")) == "bool":
        return Cell("yes" if value else "no")
    if str(getattr(value, "dtype", "")).startswith("int") or isinstance(value, int):
        return Cell(str(value))
    return Cell(number(value))


def verdict_cell(found: Gathered) -> Cell:
    """Whether the point meets the target; no verdict of a face without toe."""
    return verdict(found.row["fulfilled"]) if found.row["toe"] else Cell("no toe")
