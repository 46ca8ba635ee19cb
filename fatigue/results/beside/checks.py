"""What the command line says of shear at the toe, and of checks beside it that are not met."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd
import pyarrow.compute as pc

from fatigue.results.json_records import json_ready
from fatigue.results.tables import read_table, table_path
from fatigue.shown import shortened

MOST = 10  # welds and checks that are named

SUMS = {
    "range": "utilisation_path_range",
    "length": "utilisation_path_length",
    "moment": "utilisation_path_mlp",
    "ASME": "utilisation_asme",
}
_CHECK = ("weld", "point", "check", "side", "component", "curve", "utilisation_stress", "fulfilled", "note")


@dataclass(frozen=True, slots=True, eq=False)
class BesideToe:
    """What is worth a line beside the normal stress at the toe.

    Attributes
    ----------
    by_model : of each weld whose verdict depends on the model of shear the toe point with the largest sum
    missed : checks that are not met, the worst place of each
    not_assessed : places at which a check has no verdict
    """

    by_model: pd.DataFrame
    missed: pd.DataFrame
    not_assessed: int

    def as_record(self) -> dict[str, Any]:
        """Record for machines."""
        return {
            "model_dependent": json_ready(self.by_model.to_dict("records")),
            "checks_missed": json_ready(self.missed.astype(object).where(self.missed.notna(), None).to_dict("records")),
            "checks_not_assessed": self.not_assessed,
        }

    def as_lines(self, number: Callable[[float], str]) -> list[str]:
        """Few lines for people; ``number`` writes a number."""
        lines = []
        if len(self.by_model):
            told = [self._sums(row, number) for row in self.by_model.to_dict("records")]
            lines.append(f"With shear the verdict depends on the model: {_some(told)}")
        if len(self.missed):
            worst = self.missed.drop_duplicates(["weld", "point", "check"])
            told = [
                f"{shortened(str(row['weld'] or row['point']))}: {row['check']} {number(row['utilisation_stress'])}"
                for row in worst.to_dict("records")
            ]
            lines.append(f"Checks beside the toe that are not met (utilisation of the stress): {_some(told)}")
        if self.not_assessed:
            lines.append(f"Checks beside the toe that are not assessed: {self.not_assessed}, see checks.parquet")
        return ["", *lines] if lines else []

    @staticmethod
    def _sums(row: dict[Any, Any], number: Callable[[float], str]) -> str:
        sums = ", ".join(f"{name} {number(row[column])}" for name, column in SUMS.items() if pd.notna(row[column]))
        return f"{shortened(str(row['weld']))} ({sums})"


def _some(told: Sequence[str]) -> str:
    """The first of some texts, and how many more there are."""
    more = len(told) - MOST
    return "; ".join(told[:MOST]) + (f"; and {more} more" if more > 0 else "")


def read_beside_toe(folder: Path, welds: Collection[str], *, every: bool) -> BesideToe:
    """Shear and checks of some welds; of ``every`` weld with the stress points that belong to none.

    Raises
    ------
    DataError : a table is damaged
    """
    columns = ["weld", "node", "surface", "multiaxial_verdict", "utilisation", *SUMS.values()]
    nodes = read_table(folder, "nodes", columns)
    of_model = nodes.filter(pc.equal(nodes["multiaxial_verdict"], "model_dependent")).to_pandas()
    of_model["largest"] = of_model[list(SUMS.values())].max(axis=1)
    of_model = of_model.sort_values("largest", ascending=False, kind="stable").drop_duplicates("weld")
    by_model = of_model[of_model["weld"].isin(welds)].drop(columns=["largest", "multiaxial_verdict"])
    if not table_path(folder, "checks").exists():
        return BesideToe(by_model, pd.DataFrame(columns=list(_CHECK)), 0)
    checks = read_table(folder, "checks", _CHECK)
    missed = checks.filter(pc.equal(checks["fulfilled"], False)).to_pandas()
    open_ = checks.filter(pc.is_null(checks["fulfilled"])).to_pandas()
    texts = [name for name in _CHECK if name not in ("utilisation_stress", "fulfilled")]
    for rows in (missed, open_):
        rows[texts] = rows[texts].fillna("")
    some = missed["weld"].isin(welds) | (every & (missed["weld"] == ""))
    missed = missed[some].sort_values("utilisation_stress", ascending=False, kind="stable")
    return BesideToe(
        by_model,
        missed.drop_duplicates(["weld", "point", "check", "side", "component", "curve"]),
        int((open_["weld"].isin(welds) | (every & (open_["weld"] == ""))).sum()),
    )
