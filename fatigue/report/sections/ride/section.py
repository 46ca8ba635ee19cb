"""What the page says of a ride, put together for its template."""

from collections.abc import Mapping
from typing import Any

from fatigue.report.sections.embed import Figures
from fatigue.report.sections.ride.hunting import (
    MOST_ROWS,
    damage_figures,
    hunting_table,
    in_one_line,
    track_figures,
)
from fatigue.report.sections.ride.read import ShownRide
from fatigue.report.sections.ride.tables import ride_tables
from fatigue.report.wording import whole

TITLES: dict[str, str] = {
    "coincidence": "Hunting beside the modes of equipment",
    "alarm": "The alarm of the bogie",
    "comfort": "Comfort",
    "equipment": "Vibration of equipment",
    "running": "Running behaviour",
    "stationarity": "Whether channels are stationary and Gaussian",
    "channels": "Channels",
}
WORDS: dict[str, str] = {
    "coincidence": "Red: hunting is closer to the mode than 1 Hz, or than twice its damping ratio times its frequency; "
    "amber: amplification above 1.5; green: neither. A flag says that hunting meets a mode of equipment, and nothing "
    "of the body, whose stress may fall where equipment takes the motion out of it.",
    "alarm": "What the rule would have said of the channel. No alarm is not no damage.",
    "comfort": "An index without its form, band and block cannot be compared with another; no grade is given.",
    "equipment": "Where a record lies beside a table. This is no test and certifies nothing.",
    "running": "In the manner of EN 14363; what limits rest on stands in their row.",
    "stationarity": "What the frequency domain assumes: mean squares that scatter no more than by chance (p not below "
    "0.01), kurtosis from 2 to 4, crest within 1.3 of that of a Gaussian record.",
    "channels": "",
}


def ride_section(ride: ShownRide | None, links: Mapping[str, str], figs: Figures) -> dict[str, Any]:
    """What the page says of a ride; ``ride`` is None where none was made."""
    if ride is None:
        return {"ride": None}
    tracks, undrawn = track_figures(ride, figs)
    damage, uncompared = damage_figures(ride, figs)
    return {
        "ride": {
            "line": in_one_line(ride),
            "points": ride.said.get("points", "the worst point of every weld"),
            "rule": _rule(ride.said.get("rules", {})),
            "hunting": hunting_table(ride, links),
            "unlisted": max(0, len(ride.channels) - MOST_ROWS),
            "tracks": tracks,
            "undrawn": undrawn,
            "damage": damage,
            "uncompared": uncompared,
            "parts": [
                {
                    "title": TITLES[part.name],
                    "words": WORDS[part.name],
                    "table": part.table,
                    "note": part.note,
                    "left_out": f"{whole(part.left_out)} more rows are in {_file_of(part.name)}."
                    if part.left_out
                    else "",
                }
                for part in ride_tables(ride)
                if part.table is not None
            ],
            "without": _without(ride),
        }
    }


def ride_warnings(ride: ShownRide | None) -> list[Mapping[str, Any]]:
    """Warnings about the channels, which stand with those of the assessment."""
    return [] if ride is None else list(ride.said.get("warnings", []))


def _rule(rules: Mapping[str, Any]) -> str:
    """When a stretch is hot, in words; empty where the provenance does not say."""
    if not {"hunting_band_hz", "hot_factor", "hot_share"} <= set(rules):
        return ""
    low, high = rules["hunting_band_hz"]
    return (
        f"A stretch is hot where the rms from {low:g} to {high:g} Hz exceeds {rules['hot_factor']:g} "
        f"times its reference and more than {100 * rules['hot_share']:.3g} % of the power lies within 0.5 Hz of one "
        "frequency, for 2.75 s at least."
    )


def _file_of(name: str) -> str:
    return "provenance.json" if name == "channels" else f"{name}.parquet"


def _without(ride: ShownRide) -> str:
    """Parts that no channel gives a row, with the role that would."""
    roles = {
        "coincidence": "coincidence ([[ride.equipment_mode]])",
        "alarm": "alarm (role bogie)",
        "comfort": "comfort (role floor)",
        "equipment": "vibration of equipment (role equipment)",
        "running": "running behaviour (role bogie or floor)",
    }
    missing = [words for name, words in roles.items() if not len(ride.tables[name])]
    return ", ".join(missing)
