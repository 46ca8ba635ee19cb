"""The table of welds of a result: which were assessed, worst first, and which were not.

A weld that is listed and not assessed has no numbers. It would turn whole columns of the table into floating-point
numbers, and flags into nothing; here the columns of the assessed welds keep their types.
"""

from pathlib import Path

import numpy as np
import pandas as pd

from fatigue.results.dictionary.welds import WELDS
from fatigue.results.tables import read_table

_TYPES = {"int": np.int64, "flag": np.bool_}


def read_welds(folder: Path) -> pd.DataFrame:
    """Every weld: the assessed ones worst first, the others behind them.

    Raises
    ------
    DataError : no finished result there, or the table is damaged
    """
    welds = read_table(folder, "welds").to_pandas()
    return welds.sort_values("utilisation", ascending=False, kind="stable", na_position="last", ignore_index=True)


def assessed(welds: pd.DataFrame) -> pd.DataFrame:
    """Welds that were assessed; ids and counts are whole numbers, flags are flags."""
    types = {column.name: _TYPES[column.type] for column in WELDS if column.type in _TYPES}
    return welds[welds["status"] == "assessed"].astype(types)


def not_assessed(welds: pd.DataFrame) -> pd.DataFrame:
    """Welds that are listed with a reason and not assessed: ``weld``, ``reason`` and ``description``."""
    return welds.loc[welds["status"] != "assessed", ["weld", "reason", "description"]].fillna("").reset_index(drop=True)
