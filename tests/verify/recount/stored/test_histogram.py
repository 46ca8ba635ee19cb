"""Classes of ranges of the recount beside classes made by hand."""

import numpy as np
import pandas as pd
import pytest

from fatigue.verify.recount.anew.mission import RecountEvent
from fatigue.verify.recount.anew.point import OnePass
from fatigue.verify.recount.stored.compare import TOLERANCE
from fatigue.verify.recount.stored.histogram import histogram_rows

KEY = ("A", 1, 10, "top")
RANGES, COUNTS = np.array([53.0, 53.1, 0.0002, 7.0]), np.array([1.0, 0.5, 2.0, 1.0])


def one_pass(rho=0.0, counts=COUNTS):
    """A pass with four cycles, whose equivalent ranges are twice the ranges."""
    rows = {"range_MPa": RANGES, "equivalent_range_dS": 2.0 * RANGES, "count": counts}
    cycle_bounds = {"range_MPa": rho, "equivalent_range_dS": 2.0 * rho}
    nothing = np.zeros(0)
    return OnePass({}, nothing, nothing, nothing, nothing, rows, {"cycles_per_pass": 0.0}, cycle_bounds)


def table(k=3.0, counts=COUNTS):
    """The classes of both kinds: 64 per decade from 0.001 on."""
    found = []
    for kind, x in (("S", RANGES), ("dS", 2.0 * RANGES)):
        bins = np.maximum(np.floor(64 * np.log10(x / 1e-3)), 0).astype(int)
        for b in np.unique(bins):
            n, ranges = counts[bins == b], x[bins == b]
            found.append({"kind": kind, "bin": b, "count_per_pass": n.sum(), "power_sum_per_pass": n @ ranges**k})
    return pd.DataFrame(found)


def wrong(found, rho=0.0, counts=COUNTS, *, of_loop=False):
    """Columns that differ."""
    rows = histogram_rows(KEY, RecountEvent("e", 1.0, 1.0), one_pass(rho, counts), 3.0, found, of_loop=of_loop)
    return {
        name
        for row in rows
        for name in row.found
        if abs(row.found[name] - row.expected[name]) > TOLERANCE * row.scale[name] + row.bounds.get(name, 0.0)
    }


def test_classes_made_by_hand_agree():
    """Two ranges of one class, one below the lowest edge, and none of the others."""
    assert wrong(table()) == set()
    assert len(table()) == 6


@pytest.mark.parametrize("column", ["count_per_pass", "power_sum_per_pass"])
@pytest.mark.parametrize("row", range(6))
def test_a_small_error_in_any_class_is_found(column, row):
    """By a hundred-thousandth of itself."""
    found = table()
    found.loc[row, column] *= 1.00001
    assert wrong(found) == {column}


def test_rows_that_are_missing_moved_or_of_no_class_are_found():
    """Nothing of the table is left aside."""
    both = {"count_per_pass", "power_sum_per_pass"}
    assert wrong(table()[1:]) == both
    assert wrong(table().assign(bin=table()["bin"] + 1)) == both
    assert wrong(pd.concat([table(), table()[:1].assign(kind="s")])) == {"bin"}
    assert wrong(pd.concat([table(), table()[:1].assign(bin=512)])) == {"bin"}
    assert wrong(table()[:0]) == both


def test_a_range_at_an_edge_may_be_on_either_side():
    """As far as rounding reaches, and no further."""
    edge = 1e-3 * 10 ** (303 / 64)
    near = table()
    rows = (near["kind"] == "S") & (near["bin"] == 302)
    assert rows.sum() == 1
    shifted = near.assign(bin=near["bin"] + rows)
    apart = edge - 53.1
    assert wrong(shifted, rho=0.5 * apart) == {"count_per_pass", "power_sum_per_pass"}
    assert wrong(shifted, rho=edge - 53.0 + 1e-9) == set()


def test_rounding_that_reaches_over_several_classes_leaves_all_of_them_open():
    """Also those between the ends of its reach and the class of the range."""
    near = table()
    rows = (near["kind"] == "S") & (near["bin"] == 246)
    assert rows.sum() == 1
    for by in (-4, -2, 2, 4):
        moved = near.assign(bin=near["bin"] + by * rows)
        assert wrong(moved, rho=0.01) == {"count_per_pass", "power_sum_per_pass"}
        assert wrong(moved, rho=7.0 * (10 ** (5 / 64) - 1)) == set()


def test_cycles_that_a_loop_replaces_count_less_than_nothing():
    """A small error in them is found as in any other, what rounding leaves of two that cancel is none."""
    counts = np.array([-1.0, 0.5, 2.0, -1.0])
    found = table(counts=counts)
    assert wrong(found, counts=counts, of_loop=True) == set()
    for row in range(6):
        for column in ("count_per_pass", "power_sum_per_pass"):
            spoiled = found.copy()
            spoiled.loc[row, column] *= 1.00001
            assert wrong(spoiled, counts=counts, of_loop=True) == {column}
    assert wrong(found[:-1], counts=counts, of_loop=True) == {"count_per_pass", "power_sum_per_pass"}
    left = pd.DataFrame({"kind": "S", "bin": [334], "count_per_pass": 0.0, "power_sum_per_pass": -1.9e-9})
    assert wrong(pd.concat([found, left]), counts=counts, of_loop=True) == set()
    assert wrong(pd.concat([found, left]), counts=counts) == {"power_sum_per_pass"}
