"""The table of distances: what is read, and every mistake with its row."""

import numpy as np
import pytest

from fatigue.decide.fleet.distances import correlation_matrix, covariance_of_units, read_distances
from fatigue.decide.fleet.fleet_file import Correlation
from fatigue.errors import CaseError, DataError

NAMES = ("a", "b")
MIXED = np.array([False, True])
BY_KM = np.array([False, False])
HEAD = "unit,condition,km_per_year,passes_per_year"


def read(tmp_path, rows, by_number=MIXED, head=HEAD):
    """Distances of a table of these rows."""
    path = tmp_path / "km.csv"
    path.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    return read_distances(path, NAMES, by_number)


def test_units_in_the_order_of_the_table(tmp_path):
    """Rows in any order; passes are not km; without deviations there are none."""
    found, warnings = read(tmp_path, ["T2,b,,7", "T1,a,10,", "T2,a,20,0", "T1,b,0,0"])
    assert found.units == ("T2", "T1")
    assert found.distance.tolist() == [[20.0, 7.0], [10.0, 0.0]]
    assert found.km.tolist() == [20.0, 10.0]
    assert found.deviation is None
    assert warnings == ()


def test_deviations(tmp_path):
    """An empty one is 0."""
    found, _ = read(tmp_path, ["T,a,10,1", "T,b,20,"], BY_KM, "unit,condition,km_per_year,km_per_year_sd")
    assert found.deviation.tolist() == [[1.0, 0.0]]


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        (["T,a,1,", "T,b,,1", "T,a,2,"], "unit T, condition a repeats row 1"),
        (["T,a,1,"], "unit 'T' has no row for the condition 'b'. Add it, with 0 where the unit never runs under it"),
        (["T,a,-1,", "T,b,,1"], "column km_per_year, row 1: -1 is below 0. Give at least 0"),
        (["T,a,1,", "T,b,,-3"], "column passes_per_year, row 2: -3 is below 0"),
        (["T,a,1,", "T,b,5,"], "column km_per_year, row 2: the condition is counted by number. Give passes_per_year"),
        (["T,a,1,2", "T,b,,1"], "column passes_per_year, row 1: the condition is counted by km. Give km_per_year"),
        (["T,a,,", "T,b,,1"], "column km_per_year, row 1: the value is missing or NaN"),
        (["T,a,0,", "T,b,,0"], "unit 'T' runs nowhere: all its distances are 0"),
        (["T,a,1,", "T,bb,,1"], "'bb' is not one of the conditions of the fleet. Write 'b'"),
        (["T,a,x,", "T,b,,1"], "'x' is not a number"),
        ([",a,1,", "T,b,,1"], "the text is missing"),
        (["T,a,inf,", "T,b,,1"], "is not finite"),
    ],
)
def test_mistakes(tmp_path, rows, words):
    """Each names the row and the value."""
    with pytest.raises(DataError) as refused:
        read(tmp_path, rows)
    assert words in str(refused.value)


def test_missing_column(tmp_path):
    """Passes are asked for only where a condition is counted by number."""
    head = "unit,condition,km_per_year"
    with pytest.raises(DataError, match="passes_per_year"):
        read(tmp_path, ["T,a,1", "T,b,1"], MIXED, head)
    found, _ = read(tmp_path, ["T,a,1", "T,b,1"], BY_KM, head)
    assert found.distance.tolist() == [[1.0, 1.0]]


def test_correlations():
    """A matrix that no distances can have is refused."""
    pairs = [("a", "b", -0.9), ("b", "c", -0.9), ("a", "c", -0.9)]
    given = [Correlation(conditions=(one, two), rho=rho) for one, two, rho in pairs]
    with pytest.raises(CaseError, match=r"fleet\.toml: correlation: no distances can be correlated like this"):
        correlation_matrix(("a", "b", "c"), given, "fleet.toml")
    assert correlation_matrix(("a", "b", "c"), given[:1], "f")[1, 0] == -0.9


def test_covariance_over_units():
    """That of numpy, n - 1."""
    km = np.random.default_rng(1).random((5, 3))
    np.testing.assert_allclose(covariance_of_units(km), np.cov(km.T), rtol=1e-12)
