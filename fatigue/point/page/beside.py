"""Checks beside the normal stress at the toe that a result made at the place of a point: throats, shear, endurance."""

from pathlib import Path

import numpy as np
import pandas as pd

from fatigue.point.found import Station
from fatigue.report.checks import KEY, ShownChecks
from fatigue.report.of_record import Record
from fatigue.results import read_rows, refuse_mixed, rows_of_welds
from fatigue.results.tables import table_path

CHECKS = "checks"


def checks_at(folder: Path, record: Record, station: Station) -> ShownChecks:
    """The checks at a station, those that use up most first; none where the case asks for none.

    Raises
    ------
    DataError : the table is damaged, or not as it was written
    """
    if not table_path(folder, CHECKS).exists():
        return ShownChecks(pd.DataFrame(), 0)
    refuse_mixed(folder, record, (CHECKS,), (CHECKS,))
    of_weld = read_rows(folder, CHECKS, rows_of_welds(folder, CHECKS, [station.weld])[station.weld]).to_pandas()
    rows = of_weld[(of_weld["part"] == station.part) & (of_weld["order"] == station.order)].copy()
    rows[list(KEY)] = rows[list(KEY)].fillna("")
    fulfilled = rows["fulfilled"]
    rows["places"] = 1
    rows["missed"] = (fulfilled == False).fillna(False).astype(int)  # noqa: E712 - nor is one that was not assessed
    rows["not_assessed"] = fulfilled.isna().astype(int)
    used = rows["utilisation_stress"].to_numpy(dtype=np.float64, na_value=-1.0)
    return ShownChecks(rows.iloc[np.argsort(-used, kind="stable")], 0)
