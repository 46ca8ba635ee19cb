"""The queries of the docs give what ``fatigue fleet`` gives."""

import numpy as np
import pytest

from fatigue.decide.fleet.distances import covariance_of_units
from fatigue.decide.fleet.fleet_file import load_fleet
from fatigue.decide.fleet.story import fleet
from tests.decide.fleet.fleet_case import blocks


@pytest.fixture(scope="module")
def asked(folder):
    """Database in which the queries of the page ran in turn, and the rows of those that ask."""
    duckdb = pytest.importorskip("duckdb", reason="needs the package duckdb")
    with duckdb.connect() as database, pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        answers = [database.execute(query).fetchall() for query in blocks("sql")]
        yield database, answers


@pytest.fixture(scope="module")
def found(folder, tmp_path_factory):
    """The same by ``fatigue fleet``, and its folder."""
    into = tmp_path_factory.mktemp("found")
    return fleet(folder / "fleet.toml", into=into), into


def test_damage_of_every_point_and_unit(asked, found, folder):
    """The join is the sum, events counted by number with their passes."""
    database, _ = asked
    _, into = found
    path = into / "fleet_points.parquet"
    rows = database.execute(
        f"""select a.damage_per_year, b.damage_per_year from points a
        join '{path}' b using (unit, weld, part, "order", surface)"""
    ).fetchall()
    assert len(rows) == 4 * 28
    ours, theirs = np.array(rows).T
    np.testing.assert_allclose(ours, theirs, rtol=1e-12)
    assert (theirs > 0.0).any()


def test_life_of_every_weld_and_unit(asked, found):
    """Only toes govern: the floor seam has them on top."""
    database, _ = asked
    _, into = found
    rows = database.execute(
        f"select w.life_years, f.life_years, f.surface from welds w join '{into / 'fleet_welds.parquet'}' f "
        "using (unit, weld)"
    ).fetchall()
    assert len(rows) == 8
    np.testing.assert_allclose([row[0] for row in rows], [row[1] for row in rows], rtol=1e-12)


def test_percentiles(asked, found):
    """Linear, as quantile_cont."""
    told = dict(asked[1][1])
    ours = {}
    for row in found[0].percentiles:
        if row.weld:
            ours.setdefault(row.weld, []).append(row.life_years)
    assert set(told) == {"bracket", "floor seam"}
    for weld, values in told.items():
        np.testing.assert_allclose(values, ours[weld], rtol=1e-12)


def test_covariance_shares(asked, found, folder):
    """The shares at a point are those of the closed form, and add up to 1."""
    told = dict(asked[1][2])
    assert sum(told.values()) == pytest.approx(1.0, abs=1e-12)
    database, _ = asked
    names = load_fleet(folder / "fleet.toml").names
    rows = database.execute(
        """select unit, condition, k, d from d join km using (run, event)
        where weld = 'bracket' and part = 1 and "order" = 4 and surface = 'top'"""
    ).fetchall()
    units = sorted({row[0] for row in rows})
    km, d = np.zeros((len(units), len(names))), np.zeros(len(names))
    for unit, condition, k, damage in rows:
        km[units.index(unit), names.index(condition)] = k
        d[names.index(condition)] = damage
    cov = covariance_of_units(km)
    parts = d * (cov @ d)
    np.testing.assert_allclose([told[name] for name in names], parts / parts.sum(), rtol=1e-9)
