"""Records as JSON: what it can say of numbers that are none."""

import json

import numpy as np

from fatigue.results.json_records import json_ready, write_json


def test_json_has_no_infinities(tmp_path):
    """Infinite, NaN and numpy values become what JSON can say."""
    record = {"a": np.float64(np.inf), "b": [np.nan, np.int64(3)], 4: np.array([1.0, -np.inf]), "c": np.bool_(True)}
    assert json_ready(record) == {"a": None, "b": [None, 3], "4": [1.0, None], "c": True}
    write_json(tmp_path / "x.json", record)
    assert json.loads((tmp_path / "x.json").read_text())["a"] is None
