"""Which welds change their verdict under which other assumptions: the table of sensitivity, read and sorted."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from fatigue.results.dictionary.sensitivity import AS_ASSESSED, BOUND, COUNTED, UNDECIDED, VARIANTS
from fatigue.results.tables import read_table, table_path


@dataclass(frozen=True, slots=True, eq=False)
class Sensitivity:
    """Every weld under every variant.

    Attributes
    ----------
    rows : the table, its variants in the order of ``VARIANTS``
    assessed : utilisation of each weld as it was assessed, largest first
    """

    rows: pd.DataFrame
    assessed: "pd.Series[float]"

    @property
    def variants(self) -> list[str]:
        """The variants that were looked at."""
        there = set(self.rows["variant"])
        return [name for name in VARIANTS if name in there]

    @property
    def flipping(self) -> list[str]:
        """Welds whose verdict changes under some variant, the one that uses up most first."""
        flips = set(self.rows.loc[self.rows["flips"], "weld"])
        return [weld for weld in self.assessed.index if weld in flips]

    def under(self, variant: str) -> pd.DataFrame:
        """Rows of one variant by their weld."""
        return self.rows[self.rows["variant"] == variant].set_index("weld")

    @property
    def changing(self) -> list[str]:
        """Variants under which some verdict changes."""
        changing = set(self.rows.loc[self.rows["flips"], "variant"])
        return [name for name in self.variants if name in changing]

    @property
    def own(self) -> dict[str, str]:
        """Variants that change nothing at any weld, and why."""
        others = set(self.rows.loc[self.rows["basis"] != AS_ASSESSED, "variant"])
        return {
            name: " / ".join(dict.fromkeys(self.under(name)["note"])) for name in self.variants if name not in others
        }

    @property
    def steady(self) -> list[str]:
        """Variants under which every verdict is known and none changes."""
        left = [*self.changing, *self.own, *self.undecided]
        return [name for name in self.variants if name not in left]

    @property
    def undecided(self) -> dict[str, pd.DataFrame]:
        """Variants under which the verdict of some welds is not known, with these rows."""
        rows = self.rows[self.rows["basis"] == UNDECIDED]
        return {name: rows[rows["variant"] == name] for name in self.variants if (rows["variant"] == name).any()}

    def of_welds(self, only: Sequence[str]) -> "Sensitivity":
        """The same of some welds."""
        rows = self.rows[self.rows["weld"].isin(only)]
        return Sensitivity(rows, self.assessed[self.assessed.index.isin(only)])

    def as_record(self) -> list[dict[str, Any]]:
        """Record for machines: every variant with its welds whose verdict changes or is not known."""
        return [self._record(name) for name in self.variants]

    def _record(self, variant: str) -> dict[str, Any]:
        """Record of one variant."""
        rows = self.under(variant).reindex(self.assessed.index)
        rows["utilisation_as_assessed"] = self.assessed
        rows = rows.reset_index(names="weld")
        keys = ["weld", "utilisation_as_assessed", "utilisation", "fulfilled", "basis", "node", "surface", "note"]
        flips, undecided = rows[rows["flips"]], rows[rows["basis"] == UNDECIDED]
        return {
            "variant": variant,
            "meaning": VARIANTS[variant],
            "changes": _records(flips[keys]),
            "undecided": _records(undecided[keys]),
            "as_assessed": self.own.get(variant),
            "welds": {
                row.weld: {"utilisation": row.utilisation, "basis": row.basis}
                for row in rows[["weld", "utilisation", "basis"]].itertuples()
            },
        }


def _records(rows: pd.DataFrame) -> list[dict[str, Any]]:
    """Rows as records, what is missing as None."""
    found = []
    for row in rows.astype(object).to_dict("records"):
        record = {str(key): None if pd.isna(value) else value for key, value in row.items()}
        found.append(record | {"node": None if record["node"] is None else int(record["node"])})
    return found


def in_words(utilisation: float, basis: str, fulfilled: Any, number: Callable[[float], str]) -> str:
    """A utilisation under a variant, with what a bound says of it; ``number`` writes it."""
    sign = {UNDECIDED: "≥ ", COUNTED: "≥ ", BOUND: "≤ " if fulfilled else "≥ "}.get(basis, "")
    return f"{sign}{number(utilisation)}"


def read_sensitivity(folder: Path, assessed: pd.DataFrame) -> Sensitivity | None:
    """The table of sensitivity of a result; None where an older version has not written it.

    ``assessed`` are the welds that were assessed, worst first.

    Raises
    ------
    DataError : the table is damaged
    """
    if not table_path(folder, "sensitivity").exists():
        return None
    rows = read_table(folder, "sensitivity").to_pandas()
    rows["note"] = rows["note"].fillna("")
    return Sensitivity(rows, assessed.set_index("weld")["utilisation"])
