"""What is to be said of a point before its numbers: what it is not, what stands in place of a number, its band."""

from collections.abc import Iterator

import numpy as np
import pandas as pd

from fatigue.point.page.checked import is_decided_by_shear
from fatigue.point.page.gathered import Gathered
from fatigue.report.merged_cycles import MOST_ROWS
from fatigue.report.sections.beside.life_band import band_facts
from fatigue.report.wording import LONGEST, life_km, number, share, short, whole


def notes_of(found: Gathered) -> tuple[str, ...]:
    """Sentences about a point, the most important first."""
    return tuple(_notes(found))


def _notes(found: Gathered) -> Iterator[str]:
    row, weld = found.row, found.weld
    if not row["toe"]:
        yield (
            f"The {found.surface} face carries no weld toe here: it has numbers, but never governs a verdict, "
            "an exit code or the life of its weld"
        )
    if found.is_screened:
        yield from _screened(found)
    if is_decided_by_shear(found):
        method = found.record["rules"]["multiaxial"]["method"]
        of_normal = float(found.counted["utilisation"])
        yield (
            f"The case has shear decide (method {method}): life and utilisation are the worse of both, cycles and "
            f"shares are of the normal stress alone, whose utilisation is {number(of_normal)}"
        )
    yield from _shown(found)
    if row["summed_corner"]:
        yield "At a corner whose nodal forces are one sum of both legs: the stress is of neither leg, and unbounded"
    elif row["at_corner"]:
        yield "At a corner of the weld line"
    if row["at_end"]:
        yield "In the treated zone of a weld end: line force and moment are means over the end length"
    yield from _beside_the_worst(found, weld)
    if found.cycle_rows > MOST_ROWS:
        yield (
            f"Of {whole(found.cycle_rows)} cycles those that are alike are drawn as one; damage and sums are of each "
            "cycle by itself"
        )
    yield from _too_short(found)


def _too_short(found: Gathered) -> Iterator[str]:
    """Whether the damage of the event that is shown scatters from record to record."""
    rows = found.why.diagnosis
    rows = rows[(rows["event"] == found.event) & (rows["verdict"] != "not_assessed")]
    if len(rows) and bool(rows["record_too_short"].iloc[0]) and found.row["damage_per_km"] > 0.0:
        scatter = rows["damage_cov"].iloc[0]
        much = "by an amount that is not known" if pd.isna(scatter) else f"by {share(scatter)}"
        yield (
            f"The record of {short(found.event)} is short: the damage scatters {much} from one record of its length "
            "to the next (standard deviation)"
        )


def _screened(found: Gathered) -> Iterator[str]:
    """What the bound of the result was, and what counting gives."""
    bound, damage = float(found.stored["damage_per_km"]), float(found.counted["damage_per_km"])
    yield (
        f"The result did not count this point: a bound ({found.stored['screened']}) settled it, with a damage of at "
        f"most {number(bound)} per km and a life of at least {life_km(found.stored['life_km'])}"
    )
    times = f", so that the bound is {number(bound / damage)} times as much" if damage > 0.0 else ""
    yield f"Counted now, its damage is {number(damage)} per km{times}"


def _beside_the_worst(found: Gathered, weld: pd.Series) -> Iterator[str]:
    """Where the weld is worst, unless it is here."""
    worst = (weld["worst_part"], weld["worst_order"], weld["worst_surface"])
    if worst == (found.station.part, found.station.order, found.surface):
        yield "The worst point of its weld"
        return
    part = f"part {weld['worst_part']}, " if weld["parts"] > 1 else ""
    place = f"{part}order {weld['worst_order']}, node {weld['worst_node']}, {weld['worst_surface']} face"
    times = float(found.row["life_km"]) / float(weld["life_km"])
    ratio = f"; the life here is {number(times)} times as long" if np.isfinite(times) else ""
    yield f"The weld is worst at {place}: {life_km(weld['life_km'])}{ratio}"


def _shown(found: Gathered) -> Iterator[str]:
    """Whose record is shown, where it is not that of the governing event."""
    governing = found.row["governing_event"]
    if found.row["damage_per_km"] == 0.0:
        yield f"Nothing damages this point; shown is the record of {short(found.event)}"
        return
    if governing == found.event:
        return
    events = [event["event"] for event in found.record["mission"]["events"]]
    across = "" if governing in events else ": cycles across events, which have no record of their own"
    parts = found.why.attribution
    of_event = parts.loc[(parts["kind"] == "event") & (parts["event"] == found.event), "share"].sum()
    yield (
        f"Shown is the record of {short(found.event)}, {share(of_event)} of the damage; {short(str(governing))} "
        f"governs{across}"
    )


def facts_of_band(found: Gathered) -> list[tuple[str, str]]:
    """Facts about the band of a life that is not beyond all numbers."""
    return [] if found.row["life_km"] > LONGEST else band_facts(found.bands, found.row)
