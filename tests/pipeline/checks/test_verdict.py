"""Verdicts of welds by their checks: the worst by stress, what fails, and what has no verdict."""

import numpy as np
import pytest

from fatigue.pipeline.checks.rows import check_rows, joined, no_rows
from fatigue.pipeline.checks.verdict import Decisive, fails, verdicts


def some():
    """Throats of two welds, a hot spot that names one of them, and one that names none."""
    return joined(
        [
            check_rows(
                3,
                check="throat_perp",
                weld=np.array(["a", "a", "b"]),
                utilisation_stress=np.array([0.5, 1.2, 0.9]),
                damage_sum=np.array([0.1, 1.8, 0.7]),
                fulfilled=np.array([1, 0, 1]),
            ),
            check_rows(1, check="hot_spot", weld="b", point="p", utilisation_stress=0.95, fulfilled=1),
            check_rows(1, check="parent", point="q", utilisation_stress=3.0, fulfilled=0),
            check_rows(1, check="throat_root", weld="b", note="no curve_root"),
        ]
    )


def test_worst_check_is_that_with_the_largest_stress_utilisation():
    """Rows of other welds, and rows without one, are passed over; a weld without rows has nothing."""
    found = verdicts(some(), ["b", "a", "c"], [])
    assert found.worst == ["hot_spot", "throat_perp", ""]
    np.testing.assert_array_equal(found.utilisation, [0.95, 1.2, np.nan])
    assert found.not_assessed.tolist() == [1, 0, 0]
    assert not found.failed.any()


def test_damage_does_not_order_checks():
    """A third power of stress has the larger damage sum and the smaller utilisation: the utilisation decides."""
    rows = joined(
        [
            check_rows(1, check="throat_perp", weld="a", utilisation_stress=1.2, damage_sum=1.728, fulfilled=0),
            check_rows(1, check="throat_par", weld="a", utilisation_stress=1.15, damage_sum=2.011, fulfilled=0),
        ]
    )
    assert verdicts(rows, ["a"], []).worst == ["throat_perp"]


@pytest.mark.parametrize(
    ("counts", "failed", "fulfilled"),
    [((), [], True), (("throat_perp",), ["a"], False), (("hot_spot",), [], True), (("parent",), [], False)],
)
def test_only_checks_that_count_fail_a_weld(counts, failed, fulfilled):
    """A check that counts fails its weld; one at a point without a weld fails the assessment alone."""
    rows = some()
    found = verdicts(rows, ["a", "b"], counts)
    assert [weld for weld, bad in zip("ab", found.failed, strict=True) if bad] == failed
    decisive = Decisive()
    decisive.add(rows, counts)
    decisive.add(no_rows(), counts)
    decisive.add(np.empty(0), counts)  # of a group of a case without checks
    assert decisive.fulfilled is fulfilled
    assert fails(rows, counts).any() != fulfilled


def test_what_counts_and_is_not_assessed_is_told_once():
    """One warning for each such check, with its welds and the first reason."""
    decisive = Decisive()
    for _ in range(3):
        decisive.add(some(), ["throat_root", "throat_perp"])
    (warning,) = decisive.warnings("case.toml")
    assert (warning.code, warning.where, warning.count) == ("check_not_assessed", "case.toml: checks.counts", 1)
    assert "throat_root counts, but is not assessed at b: no curve_root" in warning.what
