"""Welds that were not assessed take nothing from the types of the others."""

import numpy as np
import pandas as pd

from fatigue.results.columns import WELDS
from fatigue.results.weld_table import assessed, not_assessed

NUMBER = {"int": 3, "flag": True, "float": 0.5}


def welds() -> pd.DataFrame:
    """One assessed weld, and one that is listed with a reason only."""
    one = {column.name: NUMBER.get(column.type, "text") for column in WELDS} | {"weld": "A", "status": "assessed"}
    other = dict.fromkeys(one) | {"weld": "B", "status": "excluded", "reason": "ground"}
    return pd.DataFrame([one, other])


def test_assessed_welds_keep_whole_numbers_and_flags():
    """Beside a row without numbers pandas makes floats of whole numbers and objects of flags."""
    found = assessed(welds())
    assert found["weld"].tolist() == ["A"]
    types = {"int": np.int64, "flag": np.bool_, "float": np.float64}
    for column in WELDS:
        assert found[column.name].dtype == types.get(column.type, found[column.name].dtype), column.name
    assert welds()["worst_node"].dtype == np.float64
    assert found["worst_node"].tolist() == [3]


def test_other_welds_have_reason_and_description():
    """A description that nobody gave is an empty text."""
    assert not_assessed(welds()).to_dict("records") == [{"weld": "B", "reason": "ground", "description": ""}]
