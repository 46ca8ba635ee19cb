"""Checks beside the normal stress at the toe, read for the page: of each weld and stress point the row that decides."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from fatigue.results import read_rows, read_table
from fatigue.results.tables import table_path

KEY = ("weld", "point", "check", "side", "component", "curve")  # rows of one check differ in their place only
MOST_CHECKS = 5000  # rows of the page, those that use up most


@dataclass(frozen=True, slots=True, eq=False)
class ShownChecks:
    """The row of each check that decides, of all places where it was made.

    Attributes
    ----------
    rows : columns of ``checks.parquet``, and ``places``, ``missed`` and ``not_assessed``: of how many places it is the
        worst, at how many the check is not met, and at how many it has no verdict
    left_out : checks that are left out because there are too many
    """

    rows: pd.DataFrame
    left_out: int

    def __bool__(self) -> bool:
        """Whether there are any."""
        return len(self.rows) > 0

    def of_weld(self, weld: str) -> pd.DataFrame:
        """The rows of a weld, those with the largest utilisation first."""
        return self.rows[self.rows["weld"] == weld]

    @property
    def apart(self) -> pd.DataFrame:
        """The rows of stress points, of a weld or of none."""
        return self.rows[self.rows["part"].isna() & (self.rows["point"] != "") & (self.rows["check"] != "endurance")]

    @property
    def endurance(self) -> pd.DataFrame:
        """The rows of endurance between static load cases."""
        return self.rows[self.rows["check"] == "endurance"]


def read_checks(folder: Path) -> ShownChecks:
    """The checks of a result; none where the case asks for none.

    Raises
    ------
    DataError : the table is damaged
    """
    if not table_path(folder, "checks").exists():
        return ShownChecks(pd.DataFrame(), 0)
    found = read_table(folder, "checks", [*KEY, "utilisation_stress", "fulfilled"]).to_pandas()
    keys = found[list(KEY)].fillna("").astype(str)
    number = keys.groupby(list(KEY), sort=False).ngroup().to_numpy()
    used = found["utilisation_stress"].to_numpy(dtype=np.float64, na_value=-1.0)
    order = np.lexsort((np.arange(len(used)), -used, number))
    decides = order[np.flatnonzero(np.diff(number[order], prepend=-1))]  # the first row of each check
    fulfilled = found["fulfilled"]
    missed = np.bincount(number, (fulfilled == False).to_numpy(dtype=float))  # noqa: E712  (missing ones are neither)
    without = np.bincount(number, fulfilled.isna().to_numpy(dtype=float))
    kept = decides[np.argsort(-used[decides], kind="stable")][:MOST_CHECKS]
    rows = read_rows(folder, "checks", kept).to_pandas()
    rows[list(KEY)] = rows[list(KEY)].fillna("")
    rows["places"] = np.bincount(number)[number[kept]]
    rows["missed"], rows["not_assessed"] = missed[number[kept]].astype(int), without[number[kept]].astype(int)
    return ShownChecks(rows, len(decides) - len(kept))
