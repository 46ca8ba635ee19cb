"""Numbers of one run: lives of its welds, and what reads as one number of its ride and of what makes the damage."""

from collections.abc import Iterator
from math import isnan, nan
from pathlib import Path
from statistics import median

import numpy as np
import pandas as pd

from fatigue.results import assessed, read_rows, read_table, read_welds
from fatigue.ride.summary import RideSummary
from fatigue.study.quantities import LIFE, Number
from fatigue.why.findings import Diagnosis

DAMAGE = "damage_per_km"
OF_WELDS = ((LIFE, "km"), ("utilisation", ""), ("load_factor", ""), ("stress_utilisation", ""))
BEYOND = "the life is infinite: no cycle damages"
POINT = ["weld", "part", "node", "order", "surface"]


def weld_numbers(variant: str, seed: int, result: Path) -> Iterator[Number]:
    """Numbers of the worst point of each weld, and of the worst of all welds; damage event by event of several."""
    welds = assessed(read_welds(result))
    for quantity, unit in OF_WELDS:
        values = welds[quantity].astype(float)
        pick = np.nanmin if quantity in (LIFE, "load_factor") else np.nanmax
        every = values.to_numpy()
        worst = float(pick(every)) if every.size and not np.isnan(every).all() else nan
        for weld, value in (("", worst), *zip(welds["weld"], values, strict=True)):
            yield Number(variant, seed, quantity, weld, float(value), unit, _why_none(float(value)))
    yield from _damage_of_events(variant, seed, result, welds)


def _damage_of_events(variant: str, seed: int, result: Path, welds: pd.DataFrame) -> Iterator[Number]:
    """Damage per km of each event at the worst point of each weld, where there are several events."""
    nodes = read_table(result, "nodes", POINT).to_pandas()
    worst = welds[["weld", "worst_part", "worst_node", "worst_order", "worst_surface"]].set_axis(POINT, axis=1)
    rows = nodes.reset_index().merge(worst, on=POINT)["index"].to_numpy(np.int64)
    if rows.size == 0:
        return
    count = read_table(result, "damage", ["event"]).num_rows // len(nodes)
    at = np.sort((rows[:, None] * count + np.arange(count)).ravel())
    table = read_rows(result, "damage", at, ["weld", "event", DAMAGE]).to_pandas()
    table = table[table[DAMAGE].notna()]
    if table["event"].nunique() < 2:
        return
    for event, of_event in table.groupby("event", sort=False):
        quantity = f"{DAMAGE}@{event}"
        yield Number(variant, seed, quantity, "", float(of_event[DAMAGE].max()), "1/km")
        for row in of_event.itertuples():
            yield Number(variant, seed, quantity, row.weld, float(row.damage_per_km), "1/km")


def _why_none(value: float) -> str:
    if isnan(value):
        return "the assessment has none"
    return BEYOND if value == np.inf else ""


def ride_numbers(variant: str, seed: int, found: RideSummary) -> Iterator[Number]:
    """Numbers of the channels of a ride: hunting, the alarm, comfort, equipment, coincidence."""
    several = len(found.events) > 1

    def number(quantity: str, row: object, channel: str, value: float, unit: str) -> Number:
        name = f"{quantity}/{channel}" + (f"@{row.event}" if several else "")  # type: ignore[attr-defined]
        return Number(variant, seed, name, "", value, unit, _reason(value, row))

    tables = found.tables
    for event, channel in dict.fromkeys((row.event, row.channel) for row in tables["flutter"]):
        rows = [row for row in tables["flutter"] if (row.event, row.channel) == (event, channel)]
        hot = [row for row in rows if row.hot]
        whole = sum(row.end_s - row.start_s for row in rows)
        share = sum(row.end_s - row.start_s for row in hot) / whole if whole > 0.0 else nan
        had = [row.frequency_hz for row in hot or rows if not isnan(row.frequency_hz)]
        yield number("hunting_hz", rows[0], channel, median(had) if had else nan, "Hz")
        yield number("hot_share", rows[0], channel, nan if isnan(rows[0].rms) else share, "")
    for row in tables["alarm"]:
        yield number("alarms", row, row.channel, nan if row.alarms is None else float(row.alarms), "")
        yield number("alarm_peak", row, row.channel, row.peak_m_s2, "m/s2")
        yield number("hot_damage_share", row, row.channel, row.damage_share_inside_hot, "")
    for row in tables["comfort"]:
        form = "_line" if row.form == "line" else ""
        yield number(f"{row.index}{form}", row, row.channel, row.value, "")
    for row in tables["equipment"]:
        yield number("equipment_rms", row, row.channel, row.rms_m_s2, "m/s2")
    for row in tables["coincidence"]:
        yield number("amplification", row, f"{row.equipment}/{row.channel or '-'}", row.amplification, "")
        yield number("coherence", row, f"{row.equipment}/{row.channel or '-'}", row.coherence, "")


def _reason(value: float, row: object) -> str:
    given = getattr(row, "reason", None)
    return (given or "the ride has none") if isnan(value) else ""


def diagnosis_numbers(variant: str, seed: int, found: Diagnosis) -> Iterator[Number]:
    """Numbers of what makes the damage at the worst point of each weld."""
    for one in found.findings:
        mode = next((m for m in one.modes if m.mode is not None), None)
        yield Number(variant, seed, "event_share", one.weld, one.event_share, "")
        if mode is not None:
            yield Number(variant, seed, "largest_mode_share", one.weld, mode.share, "")
            yield Number(variant, seed, "largest_mode_hz", one.weld, _had(mode.frequency_hz), "Hz")
            yield Number(variant, seed, "life_exponent", one.weld, mode.life_exponent, "")
        yield Number(variant, seed, "half_damage_part", one.weld, one.half_damage_part, "")
        dominant = _had(one.dominant_hz)
        yield Number(variant, seed, "dominant_hz", one.weld, dominant, "Hz", "no spectrum" if isnan(dominant) else "")


def _had(value: float | None) -> float:
    return nan if value is None else float(value)
