"""The whole way: results, distances, tables; what is refused, and what is doubted."""

import json
import shutil

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from fatigue.assess import assess
from fatigue.decide.fleet import rows
from fatigue.decide.fleet.story import fleet
from fatigue.errors import DataError
from fatigue.results import write_provenance
from tests.decide.fleet.fleet_case import body, result
from tests.older_result import without_hashes
from tests.test_sequences import LOOP, empty_and_laden, weights

POINT = ["weld", "part", "order", "surface"]


def fleet_of(folder, conditions, km, more=""):
    """Fleet file of conditions (name, results, event) and rows of distances in ``folder``; returns its path."""
    lines = ['km = "km.csv"', more]
    lines += [f'[[condition]]\nname = "{n}"\nresults = "{r}"\nevent = "{e}"' for n, r, e in conditions]
    (folder / "fleet.toml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    pd.DataFrame(km).to_csv(folder / "km.csv", index=False)
    return folder / "fleet.toml"


def mission_of(folder, into, km_per_year=2e5):
    """Fleet of one unit that runs the mission of a result, sequences included."""
    record = json.loads((into / "provenance.json").read_text())["mission"]
    conditions = [(one["event"], into, one["event"]) for one in record["events"]]
    conditions += [(one["name"], into, one["name"]) for one in record["sequences"]]
    km = [
        {
            "unit": "T",
            "condition": one["event"],
            "km_per_year": None if one["share"] is None else one["share"] * km_per_year,
            "passes_per_year": None if one["share"] is not None else one["per_1000_km"] / 1000.0 * km_per_year,
        }
        for one in record["events"]
    ]
    km += [
        {"unit": "T", "condition": one["name"], "passes_per_year": one["runs_per_km"] * km_per_year}
        for one in record["sequences"]
    ]
    return fleet_of(folder, conditions, km)


@pytest.fixture(scope="module")
def looped(tmp_path_factory):
    """Result with a loop of events whose cycles across them matter."""
    folder, case = tmp_path_factory.mktemp("loop"), empty_and_laden()
    case.extra = LOOP
    assess(case.write(folder / "case"), folder / "out", threads=1, report=False)
    return folder / "out"


@pytest.mark.parametrize("which", ["sound", "looped"])
def test_a_unit_that_runs_the_mission_has_its_damage(which, folder, looped, tmp_path):
    """Every point, with events by number and a loop: 2e5 km in a year are 2e5 times the damage per km."""
    into = folder / "out" / "sound" if which == "sound" else looped
    found = fleet(mission_of(tmp_path, into), into=tmp_path / "out")
    points, nodes = pd.read_parquet(tmp_path / "out" / "fleet_points.parquet"), pd.read_parquet(into / "nodes.parquet")
    both = points.merge(nodes, on=POINT, suffixes=("", "_assessed"))
    assert len(both) == len(nodes)
    np.testing.assert_allclose(both["damage_per_year"], 2e5 * both["damage_per_km"], rtol=1e-12)
    np.testing.assert_allclose(both["life_years"], both["life_years_assessed"], rtol=1e-12)
    assert [problem.code for problem in found.warnings] == []
    welds = pd.read_parquet(into / "welds.parquet").set_index("weld")
    for row in pd.read_parquet(tmp_path / "out" / "fleet_welds.parquet").itertuples():
        assert (row.order, row.surface) == (welds.loc[row.weld, "worst_order"], welds.loc[row.weld, "worst_surface"])


def test_what_the_docs_say(folder, tmp_path):
    """Units in order of their lives, the target, percentiles, shares that add up, tables with their units."""
    found = fleet(folder / "fleet.toml", into=tmp_path / "out", csv=True)
    lives = [row.life_years for row in found.units]
    assert lives == sorted(lives)
    assert [row.rank for row in found.units] == [1, 2, 3, 4]
    assert {row.unit: row.km_per_year for row in found.units} == {"T01": 4.6e5, "T02": 4.7e5, "T03": 5e5, "T04": 4.6e5}
    assert found.units[0].governing_condition == "line A, worn wheels"
    assert all(row.fulfilled == (row.life_years >= 30.0) for row in found.units)
    assert found.fulfilled == all(row.fulfilled for row in found.units)
    whole = {row.percentile: row.life_years for row in found.percentiles if not row.weld}
    assert whole[50.0] == pytest.approx(np.median(lives), rel=1e-12)
    shares = pd.DataFrame(
        [(r.of, r.unit, r.weld, r.share) for r in found.variance], columns=["of", "unit", "weld", "s"]
    )
    sums = shares.groupby(["of", "unit", "weld"])["s"].sum()
    np.testing.assert_allclose(sums, 1.0, rtol=1e-12)
    assert set(sums.index.get_level_values("unit")) == {"", "T01", "T02", "T03", "T04"}
    names = {path.name for path in (tmp_path / "out").iterdir()}
    tables = [f"fleet_{name}" for name in ("units", "welds", "points", "percentiles", "variance")]
    assert names == {f"{name}.{kind}" for name in tables for kind in ("parquet", "csv")} | {"fleet.html", "fleet.json"}
    schema = pq.read_schema(tmp_path / "out" / "fleet_units.parquet")
    assert schema.field("km_per_year").metadata[b"unit"] == b"km/a"
    record = json.loads((tmp_path / "out" / "fleet.json").read_text())
    assert set(record["outputs"]) == names - {"fleet.json"}
    assert record["conditions"][1]["damage_cv"] == 0.15


def test_uncertainty_of_a_unit(folder, tmp_path):
    """Standard deviation of the damage of T03: 5 numbers by hand; worn wheels with no km leave no trace."""
    found = fleet(folder / "fleet.toml", into=tmp_path / "out")
    row = next(row for row in found.units if row.unit == "T03")
    damage = pd.read_parquet(folder / "out" / "sound" / "damage.parquet").set_index([*POINT, "event"])
    at = (row.weld, row.part, row.order, row.surface)
    d = [damage.loc[(*at, event), "damage_per_km"] for event in ("tangent 350", "curves 160")]
    sd = np.hypot(d[0] * 30000.0, d[1] * 60000.0)
    assert row.damage_cv == pytest.approx(sd / row.damage_per_year, rel=1e-12)
    assert "line A, worn wheels" not in found.counted_as_exact  # has its damage_cv
    assert found.counted_as_exact == ("line A, sound wheels", "line B", "loading")
    told = "Nothing says how sure the damage of line A, sound wheels, line B, loading is: it counts as exact."
    assert told in found.as_text()
    assert told[1:] in (tmp_path / "out" / "fleet.html").read_text()


def test_many_points_are_left_out(folder, tmp_path, monkeypatch):
    """A table of points and units that would be too large is none, and the rule is told."""
    monkeypatch.setattr(rows, "MOST_POINT_ROWS", 100)
    monkeypatch.setattr("fatigue.decide.fleet.story.MOST_POINT_ROWS", 100)
    found = fleet(folder / "fleet.toml", into=tmp_path / "out")
    assert not found.every_point
    assert "There is no table fleet_points" in found.as_text()
    assert not (tmp_path / "out" / "fleet_points.parquet").exists()
    assert (tmp_path / "out" / "fleet_welds.parquet").exists()


def test_screened_points_are_bounds(tmp_path):
    """Lives are at least what the bounds allow and at most those of counted points; with --exact they are between."""
    case = body(0.05)
    result(case, tmp_path / "case", tmp_path / "exact")
    path = tmp_path / "case" / "case.toml"
    assess(path, tmp_path / "screened", threads=1, report=False, share=1.0, proves_worst=False)
    km = [{"unit": "T", "condition": "c", "km_per_year": 1e5}]
    lives = {}
    for name in ("exact", "screened"):
        (tmp_path / f"of-{name}").mkdir()
        path = fleet_of(tmp_path / f"of-{name}", [("c", tmp_path / name, "curves 160")], km)
        found = fleet(path, into=tmp_path / f"of-{name}" / "out")
        welds = pd.read_parquet(tmp_path / f"of-{name}" / "out" / "fleet_welds.parquet").set_index("weld")
        lives[name] = welds
        assert [problem.code for problem in found.warnings] == (["fleet_bounds"] if name == "screened" else [])
    assert not lives["exact"]["is_bound"].any()
    assert lives["screened"]["is_bound"].any()
    assert (lives["screened"]["life_years"] <= lives["exact"]["life_years"] * (1 + 1e-12)).all()
    assert (lives["screened"]["life_years_at_most"] >= lives["exact"]["life_years"] * (1 - 1e-12)).all()


def copied(folder, tmp_path):
    """The results of the docs, to be changed."""
    shutil.copytree(folder / "out", tmp_path / "out")
    return tmp_path


def two(tmp_path, first, second, event="tangent 350", other="tangent 350"):
    """Fleet of one condition of each of two results."""
    km = [{"unit": "T", "condition": name, "km_per_year": 1e5} for name in ("a", "b")]
    return fleet_of(tmp_path, [("a", first, event), ("b", second, other)], km)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("weld", "does not have the weld floor seam of results"),
        ("order", "weld 'bracket', part 1, order 7, top of results"),
        ("shorter", "weld 'bracket' has 12 points, in results"),
        ("moved", "weld 'bracket', part 1, order 3, top"),
        ("thick", "has another plate thickness"),
        ("toe", "carries a toe in one of them only"),
        ("curve", "weld 'bracket' is on the curve 'master-steel', in results"),
        ("survival", "the curve 'master-aluminium' was used with other"),
        ("rule", "was assessed with thickness_rule = 'asme'"),
        ("limit", "used with other damage_limit"),
    ],
)
def test_results_of_something_else_are_refused(change, words, folder, tmp_path):
    """Damage of other welds, points, curves or rules is no one sum; what differs first is named."""
    case = body()
    nodes = case.weld_nodes
    of_bracket = nodes["weld"] == "bracket"
    if change == "weld":
        for name in ("welds", "weld_nodes", "nodal_forces"):
            table = getattr(case, name)
            table["weld"] = table["weld"].replace({"floor seam": "another"})
    elif change == "order":
        nodes.loc[of_bracket & (nodes["order"] == 7), "order"] = 8
    elif change == "shorter":
        gone = of_bracket & (nodes["order"] == 7)
        node = int(nodes.loc[gone, "node"].iloc[0])
        case.weld_nodes = nodes[~gone]
        case.nodal_forces = case.nodal_forces[case.nodal_forces["node"] != node]
    elif change == "moved":
        nodes.loc[of_bracket & (nodes["order"] == 3), "x_mm"] += 0.01
    elif change == "thick":
        nodes.loc[of_bracket, "thickness_mm"] = 9.0
    elif change == "toe":
        case.welds["surface"] = ["both", "both"]
    elif change == "curve":
        case.welds["curve"] = ["master-steel", "master-aluminium"]
    elif change == "survival":
        case.curve["survival"] = "mean"
    elif change == "rule":
        case.curve["thickness_rule"] = "asme"
    elif change == "limit":
        case.mission["damage_limit"] = 0.5
    other = result(case, tmp_path / "case", tmp_path / "other")
    with pytest.raises(DataError) as refused:
        fleet(two(tmp_path, folder / "out" / "sound", other))
    assert words in str(refused.value)


def test_renumbered_and_reordered_welds_match(folder, tmp_path):
    """The order of the welds in the tables and the numbers of nodes do not matter: weld, part, order and face do."""
    case = body()
    case.welds = case.welds.iloc[::-1]
    for name in ("weld_nodes", "nodal_forces"):
        table = getattr(case, name)
        setattr(case, name, table.assign(node=table["node"] + 5000).iloc[::-1])
    other = result(case, tmp_path / "case", tmp_path / "other")
    fleet(two(tmp_path, folder / "out" / "sound", other), into=tmp_path / "out")
    points = pd.read_parquet(tmp_path / "out" / "fleet_points.parquet")
    damage = pd.read_parquet(folder / "out" / "sound" / "damage.parquet").query("event == 'tangent 350'")
    both = points.merge(damage, on=POINT)
    np.testing.assert_allclose(both["damage_per_year"], 2e5 * both["damage_per_km"], rtol=1e-9)


def test_bad_conditions(folder, tmp_path):
    """An event that a result does not have, a folder without result, one that was edited."""
    sound = folder / "out" / "sound"
    with pytest.raises(DataError) as refused:
        fleet(two(tmp_path, sound, sound, other="tangnt 350"))
    assert "condition[2].event ('b'): the result" in str(refused.value)
    assert "has no event 'tangnt 350'. It has 'tangent 350', 'curves 160', 'load and unload'" in str(refused.value)
    with pytest.raises(DataError, match="nothing"):
        fleet(two(tmp_path, sound, tmp_path / "nothing"))
    shutil.copytree(sound, tmp_path / "edited")
    with (tmp_path / "edited" / "damage.parquet").open("ab") as file:
        file.write(b" ")
    with pytest.raises(DataError, match="was changed since it was written"):
        fleet(two(tmp_path, sound, tmp_path / "edited"))


def test_loops_need_their_passes(looped, tmp_path):
    """A loop run more often than an event of it is refused; one left out is a warning."""
    path = mission_of(tmp_path, looped)
    km = pd.read_csv(tmp_path / "km.csv")
    assert weights(empty_and_laden())["load"] == 1.5e-3  # as often as the loop
    km.loc[km["condition"] == "load", "passes_per_year"] = 299.0
    km.to_csv(tmp_path / "km.csv", index=False)
    with pytest.raises(DataError) as refused:
        fleet(path)
    told = str(refused.value)
    assert "condition '(sequence 1)': unit 'T' runs it 300 times a year" in told
    assert "takes 300 passes of the event 'load'; the unit has 299" in told
    path = fleet_of(tmp_path, [("c", looped, "laden")], [{"unit": "T", "condition": "c", "km_per_year": 1.0}])
    (told,) = fleet(path).warnings
    assert told.code == "fleet_transitions"
    assert "(sequence 1), are in no condition and in no sum" in told.what


def test_results_of_two_versions(folder, tmp_path):
    """They are summed, with a warning that names them."""
    other = copied(folder, tmp_path) / "out" / "worn"
    record = json.loads((other / "provenance.json").read_text())
    record["software"]["fatigue"] = "0.0.9"
    write_provenance(other, record)
    found = fleet(two(tmp_path, folder / "out" / "sound", other))
    assert [problem.code for problem in found.warnings] == ["fleet_versions"]
    assert "0.0.9" in found.warnings[0].what


def test_folders_that_are_not_ours(folder, tmp_path):
    """Neither a result nor somebody else's file is written over."""
    sound = copied(folder, tmp_path) / "out" / "sound"
    path = two(tmp_path, sound, sound)
    with pytest.raises(DataError, match="is one of the results that are read"):
        fleet(path, into=sound)
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "fleet.html").write_text("mine")
    with pytest.raises(DataError, match="was not written by fatigue fleet"):
        fleet(path, into=tmp_path / "mine")
    fleet(path, into=tmp_path / "mine", force=True)
    fleet(path, into=tmp_path / "mine")


def test_error_of_the_band(tmp_path):
    """Without damage_cv the standard error is that of the band, where the mission is the one event."""
    case = body()
    case.events = [case.events[1] | {"share": 1.0}]
    into = result(case, tmp_path / "case", tmp_path / "one")
    band = pd.read_parquet(into / "band.parquet").set_index(POINT)
    km = [{"unit": "T", "condition": "c", "km_per_year": 1e5}]
    found = fleet(fleet_of(tmp_path, [("c", into, "curves 160")], km))
    (row,) = found.units
    se = band.loc[(row.weld, row.part, row.order, row.surface), "se_load"]
    assert se > 0.0
    assert row.damage_cv == pytest.approx(se, rel=1e-12)
    assert found.counted_as_exact == ()
    assert "counts as exact" not in found.as_text()


def test_older_results(folder, tmp_path, caplog):
    """A result without hashes is summed, with a warning that nothing tells whether it is as it was written."""
    other = without_hashes(copied(folder, tmp_path) / "out" / "worn")
    found = fleet(two(tmp_path, folder / "out" / "sound", other))
    assert len(found.units) == 1
    assert "no hashes on record" in caplog.text
