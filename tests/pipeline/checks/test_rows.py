"""Rows of checks are one array, whatever the width of their texts, and survive on disk and in a table."""

import io

import numpy as np

from fatigue.pipeline.checks.rows import check_rows, joined
from fatigue.pipeline.tables.checks import check_table_rows


def some_rows():
    """Three rows of two checks."""
    throats = check_rows(
        2,
        check="throat_perp",
        weld=np.array(["a", "a long name"]),
        part=1,
        order=np.array([3, 4]),
        damage_per_km=np.array([1e-7, 0.0]),
        damage_sum=np.array([0.1, 0.0]),
        damage_limit=0.5,
        fulfilled=np.array([1, 1]),
    )
    return joined([throats, check_rows(1, check="hot_spot", point="p", note="no stress")])


def test_rows_of_several_checks_survive_on_disk():
    """Texts of any width stand side by side, and come back as they were."""
    rows = some_rows()
    assert rows["weld"].tolist() == ["a", "a long name", ""]
    file = io.BytesIO()
    np.savez(file, rows=rows)
    again = np.load(io.BytesIO(file.getvalue()))["rows"]
    assert again.dtype == rows.dtype
    assert again.tobytes() == rows.tobytes()


def test_rows_of_the_table_have_what_follows():
    """Life is the limit over the damage per km, infinite without damage; what is not assessed is empty."""
    columns = check_table_rows(some_rows(), {})
    assert columns["life_km"][0] == 0.5 / 1e-7
    assert columns["life_km"][1] == np.inf
    assert np.isnan(columns["life_km"][2])
    assert columns["utilisation_damage"][0] == 0.2
    assert columns["fulfilled"].to_pylist() == [True, True, None]
    assert columns["part"].to_pylist() == [1, 1, None]
    assert columns["point"].to_pylist() == [None, None, "p"]
