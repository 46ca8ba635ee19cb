"""What the provenance of a result says of its mission and its coordinates, as figures and tables ask for it."""

from collections.abc import Mapping
from typing import Any

Record = Mapping[str, Any]


def target_of(record: Record) -> float:
    """Mileage to be reached [km]."""
    return float(record["mission"]["target_km"])


def events_of(record: Record) -> list[dict[str, Any]]:
    """The events of the mission in its order."""
    return list(record["mission"]["events"])


def weights_of(record: Record) -> dict[str, float]:
    """Passes of every event, and runs of every sequence behind them, in one km of the mission [1/km]."""
    mission = record["mission"]
    passes = {event["event"]: float(event["passes_per_km"]) for event in mission["events"]}
    return passes | {loop["name"]: float(loop["runs_per_km"]) for loop in mission.get("sequences", [])}


def coordinates_of(record: Record) -> dict[int, str]:
    """Names of modes by their ids, and of unit loads by the numbers behind these, in the order of the tables."""
    used = [int(mode) for mode in record["modes"]["used"]]
    loads = [f"unit load {load['name']}" for load in record.get("unit_loads", ())]
    return {mode: f"mode {mode}" for mode in used} | dict(enumerate(loads, start=max(used) + 1))


def mode_names(record: Record) -> tuple[dict[int, str], dict[int, float]]:
    """Name of every mode and unit load, and the natural frequencies [Hz] of the normal modes."""
    modes, names, natural = record["modes"], coordinates_of(record), {}
    for mode, frequency, kind in zip(modes["used"], modes["frequency_hz"], modes["kind"], strict=True):
        names[mode] = f"mode {mode}, {frequency:.4g} Hz" + ("" if kind == "normal" else f", {kind}")
        if kind == "normal" and frequency > 0.0:
            natural[mode] = frequency
    return names, natural
