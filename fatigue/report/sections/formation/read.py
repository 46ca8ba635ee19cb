"""The tables of how resonances form, read where a diagnosis made them."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from fatigue.report.result import ShownResult, rows_of_worst_points
from fatigue.results import read_table
from fatigue.results.dictionary.resonance import FORMED
from fatigue.results.tables import table_path

SWINGS = ("resonant", "inertial")  # classes of modes that do not follow their loads


@dataclass(frozen=True, slots=True, eq=False)
class ShownFormation:
    """How resonances form.

    Attributes
    ----------
    modes : rows of ``resonance``: every mode in every event
    welds : rows of ``weld_resonance`` for the worst points of the detailed welds
    watch : rows of ``watch``, the costliest swing first; with those that relieve
    counted_from : share of the damage of a point from which a swing is counted again; None where that is not on record
    """

    modes: pd.DataFrame
    welds: pd.DataFrame
    watch: pd.DataFrame
    counted_from: float | None

    def of_weld(self, weld: str) -> "ShownFormation":
        """Rows of one weld; those of the modes are of all."""
        of = (rows[rows["weld"] == weld] for rows in (self.welds, self.watch))
        return replace(self, welds=next(of), watch=next(of))

    @property
    def costly(self) -> pd.DataFrame:
        """Swings that cost something."""
        return self.watch[self.watch["utilisation_cost"] > 0.0]

    @property
    def swinging(self) -> frozenset[int]:
        """Modes that do not follow their loads in some event."""
        return frozenset(int(mode) for mode in self.modes.loc[self.modes["class"].isin(SWINGS), "mode"])

    @property
    def damping(self) -> str:
        """What the split rests on where modes have no damping ratio of their own; empty where all have one."""
        modes = self.modes.drop_duplicates("mode")
        assumed = modes[modes["damping_source"] == "assumed"]
        without = int(modes["damping_ratio"].isna().sum())
        if len(assumed):
            ratio = f"{assumed['damping_ratio'].iloc[0]:g}"
            return f"a damping ratio of {ratio} was assumed for {len(assumed)} of {len(modes)} modes"
        return f"{without} of {len(modes)} modes have no damping ratio and are split as if it were 0" if without else ""


def read_formation(folder: Path, result: ShownResult) -> ShownFormation | None:
    """Tables of how resonances form; None where there are none, as of a diagnosis by an older version."""
    if not all(table_path(folder, name).is_file() for name in FORMED):
        return None
    said: Any = result.record.get("diagnosis") or {}
    modes, watch = (read_table(folder, name).to_pandas() for name in ("resonance", "watch"))
    return ShownFormation(
        modes=modes,
        welds=rows_of_worst_points(folder, "weld_resonance", result.assessed, result.detailed),
        watch=watch.iloc[np.argsort(watch["rank"].to_numpy(), kind="stable")],
        counted_from=said.get("swing_counted_from_damage_share"),
    )


def reason_of(value: Any) -> str:
    """Reason in a row, empty where there is none."""
    return "" if value is None or pd.isna(value) else str(value)
