"""Does what was counted now agree with the result: the row of the point, its cycles, the shares of its damage."""

from collections.abc import Iterator

import numpy as np
import pandas as pd

from fatigue.pipeline.multiaxial.method import DECIDING
from fatigue.point.page.gathered import Gathered
from fatigue.report.of_record import weights_of
from fatigue.report.sections.checks import Recomputed
from fatigue.results import DAMAGE, NODES

SMALL = 1e-3  # of the largest of its kind
BY_METHOD = ("damage_per_km", "life_km", "life_years", "utilisation", "load_factor")  # of a point that shear decides


def checks_of(found: Gathered) -> list[Recomputed]:
    """Every comparison of what was counted now with what is known."""
    return list(_checks(found))


def is_decided_by_shear(found: Gathered) -> bool:
    """Whether the case has shear decide, so that the numbers of the result are not those of the normal stress."""
    return not found.is_screened and found.record["rules"].get("multiaxial", {}).get("method") in DECIDING


def _checks(found: Gathered) -> Iterator[Recomputed]:
    damage = float(found.counted["damage_per_km"])
    if found.is_screened:
        bound = float(found.stored["damage_per_km"])
        above = max(0.0, damage / bound - 1.0) if bound > 0.0 else float(damage > 0.0)
        yield Recomputed("damage counted now, above the bound of the result", above)
    else:
        left_out = BY_METHOD if is_decided_by_shear(found) else ()
        names = [
            c.name for c in NODES if c.type == "float" and c.name in found.counted.index and c.name not in left_out
        ]
        of_nodes = _largest(found.counted[names], found.stored[names])
        yield Recomputed("nodes.parquet, its numbers counted again", of_nodes)
        names = [c.name for c in DAMAGE if c.type == "float"]
        pairs = zip(found.damage.iterrows(), found.damage_stored.iterrows(), strict=True)
        of_events = max(_largest(now[names], before[names]) for (_, now), (_, before) in pairs)
        yield Recomputed("damage.parquet, its numbers counted again", of_events)
    cycles = found.cycles
    one_by_one = float((cycles["damage"] * cycles["event"].map(weights_of(found.record)).astype(float)).sum())
    yield Recomputed("damage, from its cycles one by one", _difference(one_by_one, damage))
    shared = float(found.evidence.attribution.damage[0])
    yield Recomputed("damage, shared out to events", _difference(shared, damage))
    parts = found.why.attribution
    modes = float(parts.loc[parts["kind"].isin(["mode", "unit_load"]), "damage_per_km"].sum())
    yield Recomputed("damage, shared out to modes and unit loads", _difference(modes, damage))
    now, before = (None if of is None else of.of(*found.key) for of in (found.bands_counted, found.bands_stored))
    if now is not None and before is not None and not found.is_screened:
        pairs_of_ends = ((now.low_km, before.low_km), (now.high_km, before.high_km))
        ends = max(0.0 if np.isnan(a) and np.isnan(b) else _difference(a, b) for a, b in pairs_of_ends)
        yield Recomputed("band.parquet, both ends of the band of load", ends)
    if found.diagnosis is not None and len(found.diagnosis.attribution):
        before = found.diagnosis.attribution
        off = (
            np.abs(parts["share"].to_numpy() - before["share"].to_numpy()) if len(parts) == len(before) else np.ones(1)
        )
        yield Recomputed("shares of the damage, in the diagnosis of the result", float(np.nanmax(off)))


def _largest(now: pd.Series, before: pd.Series) -> float:
    """Largest relative difference of numbers of which the result has one.

    Stresses and damages are compared with the largest range and the damage where they are small beside these: a mean
    of 1e-15 MPa is rounding.
    """
    scale = {"MPa": now.get("max_range_MPa", 0.0), "damage": now.filter(like="damage_per").abs().max()}
    found = 0.0
    for name, value in now.items():
        if pd.notna(before[name]):
            of = next((size for part, size in scale.items() if part in str(name)), 0.0)
            found = max(found, _difference(float(value), float(before[name]), SMALL * float(of)))
    return found


def _difference(found: float, known: float, least: float = 0.0) -> float:
    """Relative difference, of small numbers relative to ``least``; 0 of equal infinities."""
    if found == known:
        return 0.0
    scale = max(abs(found), abs(known), least)
    return abs(found - known) / scale if np.isfinite(scale) else np.inf
