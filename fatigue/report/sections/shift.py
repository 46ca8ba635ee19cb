"""What a shift study, where one was made, says on the page: life against the setting of the mode, its limits."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from fatigue.report import figures, wording
from fatigue.report.result import ShownResult
from fatigue.report.sections.embed import Figures
from fatigue.results import read_table

WORST_DRAWN, MOVING_DRAWN = 2, 3  # welds with the shortest lives, and of the others those that depend most on it
_COLUMNS = ["weld", "frequency_hz", "damping_ratio", "life_km", "is_as_assessed", "is_worst_of_weld"]


def shift_study(folder: Path, result: ShownResult, figs: Figures) -> dict[str, Any]:
    """Figure and words of a shift study; None where there is none."""
    said = result.record.get("shift_study")
    if not said or not (folder / "shift.parquet").is_file():
        return {"shift": None}
    table = read_table(folder, "shift", _COLUMNS).to_pandas()
    table = table[table["is_worst_of_weld"]]
    lives = table.groupby("weld", sort=False)["life_km"].agg(["min", "max"])
    lives = lives.sort_values("min", kind="stable")
    with np.errstate(invalid="ignore"):
        spread = (lives["max"] / lives["min"]).fillna(1.0)[WORST_DRAWN:].sort_values(ascending=False, kind="stable")
    welds = [*lives.index[:WORST_DRAWN], *spread.index[:MOVING_DRAWN]]
    fig = figures.life_against_setting(table, welds, result.target_km)
    caption = f"Life of the worst points of welds against the setting of mode {said['mode']}: {said['method']}"
    return {
        "shift": {"figure": figs.add("shift", fig, caption), "words": _words(said), "limits": said.get("limits", "")}
    }


def _words(said: Mapping[str, Any]) -> str:
    """Say which mode was moved, where, and what was counted."""
    assumed = " (assumed: the modes have none)" if said.get("damping_is_assumed") else ""
    events = wording.listed([str(event) for event in said.get("events", ())])
    return (
        f"Mode {said['mode']} at {said['frequency_hz']:.5g} Hz with the damping ratio {said['damping_ratio']:.3g}"
        f"{assumed} is moved in {events}. Counted again: {said['points']}."
    )


def shift_warnings(record: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Warnings about the shift study, which stand with those of the assessment."""
    return list((record.get("shift_study") or {}).get("warnings", []))
