"""What a diagnosis, where one was made, says of the points shown in detail: modes, bands, track, levers, verdicts."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from fatigue.report.result import ShownResult, rows_of_worst_points
from fatigue.report.sections.formation.read import ShownFormation, read_formation

TABLES = ("attribution", "track", "diagnosis", "levers")


@dataclass(frozen=True, slots=True, eq=False)
class Why:
    """Rows of the diagnosis for the worst points of the detailed welds; an empty table where there is none.

    ``formation`` is how resonances form; None in a diagnosis by an older version.
    """

    attribution: pd.DataFrame
    track: pd.DataFrame
    diagnosis: pd.DataFrame
    levers: pd.DataFrame
    formation: ShownFormation | None

    def of_weld(self, weld: str) -> "Why":
        """Rows of one weld."""
        tables = self.attribution, self.track, self.diagnosis, self.levers
        attribution, track, diagnosis, levers = (rows[rows["weld"] == weld] for rows in tables)
        formation = None if self.formation is None else self.formation.of_weld(weld)
        return Why(attribution, track, diagnosis, levers, formation)

    def reasons(self) -> list[tuple[str, str, str]]:
        """Event, verdict on the frequency domain and its reason in words."""
        rows = self.diagnosis[["event", "verdict", "reason"]]
        return [(str(event), str(verdict), str(reason)) for event, verdict, reason in rows.itertuples(index=False)]


def read_why(folder: Path, result: ShownResult) -> Why | None:
    """Tables of a diagnosis, read; None where the result was not diagnosed."""
    if not all((folder / f"{name}.parquet").is_file() for name in TABLES):
        return None
    found = {name: rows_of_worst_points(folder, name, result.assessed, result.detailed) for name in TABLES}
    for name in ("attribution", "levers"):  # older versions have no unit loads
        if "unit_load" not in found[name]:
            found[name] = found[name].assign(unit_load=None)
    formation = read_formation(folder, result)
    return Why(found["attribution"], found["track"], found["diagnosis"], found["levers"], formation)


def mode_shares(why: Why) -> pd.DataFrame:
    """Share of each mode and unit load in the damage over all events, largest first.

    Columns ``mode``, ``unit_load`` (each empty where it is the other), ``share``, ``resonant_share``.
    """
    rows = why.attribution[why.attribution["kind"].isin(["mode", "unit_load"])]
    by = rows.groupby(["mode", "unit_load"], dropna=False, sort=True)
    shares = by[["share", "resonant_share"]].sum(min_count=1).reset_index().astype({"mode": "Int64"})
    return shares.iloc[np.argsort(-shares["share"].abs().to_numpy(), kind="stable")]


def band_shares(why: Why) -> pd.DataFrame:
    """Share of each frequency band in the damage over all events: ``low_hz``, ``high_hz`` (NaN: no end), ``share``.

    Events too short for bands, which have one band without ends, are left out.
    """
    bands = why.attribution[why.attribution["kind"] == "band"]
    bands = bands[(bands["low_hz"] > 0.0) | bands["high_hz"].notna()]
    return bands.groupby(["low_hz", "high_hz"], dropna=False, sort=True)["share"].sum().reset_index()


def exponents(why: Why) -> Mapping[str, float]:
    """Exponents d ln(life) / d ln of load, of plate thickness through its stress, of thickness through the rule."""
    rows: Any = why.attribution[why.attribution["kind"].isin(["load", "thickness", "thickness_rule"])]
    return {str(kind): float(total) for kind, total in rows.groupby("kind")["life_exponent"].sum().items()}
