"""What a weld page says of how its stress forms, and where on the track a swing does its damage."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from fatigue.report.sections.formation.read import ShownFormation, reason_of
from fatigue.report.wording import life_km, number, short


def of_one_weld(of: ShownFormation) -> str:
    """One line about the worst point of a weld, in the event that damages it most; empty where nothing is known.

    ``of`` holds the rows of that weld only.
    """
    if of.welds.empty:
        return ""
    row = of.welds.loc[of.welds["damage_per_km"].idxmax()]
    line = (
        f"In {short(str(row['event']))} the stress moves mostly at {number(row['dominant_hz'])} Hz; "
        f"damage {number(row['damage_per_km'])} per km, of its quasi-static part alone "
        f"{number(row['damage_per_km_quasi_static'])}, of its dynamic part alone "
        f"{number(row['damage_per_km_dynamic'])} (they do not add up)."
    )
    if pd.isna(row["dominant_hz"]):
        line = line.replace("the stress moves mostly at – Hz", "the stress has no dominant frequency")
    reason = reason_of(row["reason"])
    if reason:
        return f"{line} Not available: {reason}."
    damping = of.damping
    return f"{line} {_watched(of)}" + (f" Note: {damping}." if damping else "")


def _watched(of: ShownFormation) -> str:
    """The costliest swing at a weld."""
    if of.costly.empty:
        return f"No mode to watch: {follows(of)}."
    row = of.costly.iloc[0]
    swing = (
        f"Watch mode {row['mode']} ({number(row['frequency_hz'])} Hz, {str(row['class']).replace('_', '-')}) in "
        f"{short(str(row['event']))}, half of its swing's damage at {place(row)}"
    )
    if not row["cost_km"] <= 1e300:  # infinite: nothing else damages
        return f"{swing}: nothing would damage the point if it followed its load."
    return f"{swing}: costs {life_km(row['cost_km'])}, {life_km(row['life_km_without'])} if it followed its load."


def follows(of: ShownFormation) -> str:
    """Why no mode is to be watched."""
    some = "much" if of.counted_from is None else f"{100.0 * of.counted_from:g} %"
    return f"none owes {some} of the damage to its swing, the modes follow their loads"


def place(row: "Mapping[str, Any] | pd.Series[Any]") -> str:
    """Stretch of the track that holds half of what a swing does: by km, or by time without distance."""
    unit = "s" if pd.isna(row["start_km"]) else "km"
    first, last = f"{row[f'start_{unit}']:.1f}", f"{row[f'end_{unit}']:.1f}"
    return f"km {first} to {last}" if unit == "km" else f"{first} to {last} s"
