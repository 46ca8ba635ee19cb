"""Finished results beside each other, from files to tables: the same body in other guises, and what makes its lives."""

import json
import shutil

import numpy as np
import pandas as pd
import pyarrow.compute as pc
import pyarrow.parquet as pq
import pytest

from fatigue.assess import assess
from fatigue.decide.compare.said import notes, sentences
from fatigue.decide.compare.split import WHOLE
from fatigue.decide.compare.story import compare
from fatigue.decide.compare.summary import match_rows
from fatigue.diagnose import diagnose
from fatigue.errors import CaseError, DataError
from fatigue.results.dictionary.decided.compare import COMPARED
from tests.decide.compare.variants import POINT, lives, renamed, renumbered_and_reversed, result_of, sloping, turned
from tests.older_result import without_hashes
from tests.test_sequences import LOOP, empty_and_laden
from tests.unit_load_case import as_unit_load, write_with_loads

NOISE = "noise"


@pytest.fixture(scope="module")
def reference(tmp_path_factory):
    """The reference, with a diagnosis; read it, never write to it."""
    return result_of(sloping(), tmp_path_factory.mktemp("reference"), diagnosed=True)


@pytest.fixture(scope="module")
def changed(tmp_path_factory):
    """Another mission and louder noise, an event gone and another there, another limit and target; with a diagnosis."""
    case = sloping()
    case.histories["noise"] = case.histories["noise"].assign(q_1=3.0 * case.histories["noise"]["q_1"])
    case.histories["bump"] = case.histories["load"].assign(q_1=[0.0, 30.0])
    case.events[0]["share"], case.events[1]["share"] = 0.6, 0.4
    case.events[2] = {"name": "bump", "history": "bump", "per_1000_km": 3.0}
    case.mission = {"target_km": 2e6, "km_per_year": 2e5, "damage_limit": 0.5}
    return result_of(case, tmp_path_factory.mktemp("changed"), diagnosed=True)


@pytest.fixture(scope="module")
def left(tmp_path_factory):
    """The reference with weld A under another name."""
    return result_of(renamed(sloping(), {"A": "left"}), tmp_path_factory.mktemp("left"))


@pytest.fixture(scope="module")
def pair(reference, changed):
    """Both beside each other."""
    return compare([reference, changed]).pairs[0]


def totals(causes, kinds, scope):
    """Sums of what causes of some kinds add, by point and event."""
    some = causes[causes["kind"].isin(kinds) & (causes["scope"] == scope)]
    return some.groupby([*POINT, "event"], dropna=False)["log_life_ratio"].sum()


def assert_nothing_left_over(pair, has_modes):
    """Causes add up to the ratio of every point, parts to their event, to rounding."""
    ratios = {"point": pair.points, "weld": pair.welds}
    for scope, table in ratios.items():
        whole = totals(pair.causes, WHOLE, scope).groupby(POINT).sum()
        known = table.set_index(POINT)["log_life_ratio"]
        np.testing.assert_allclose(whole, known.reindex(whole.index), rtol=0, atol=1e-12)
        events = totals(pair.causes, ("event", "sequence"), scope)
        split = totals(pair.causes, ("mission", "per_pass"), scope)
        np.testing.assert_allclose(split, events.reindex(split.index), rtol=0, atol=1e-12)
        if has_modes:
            modes = totals(pair.causes, ("mode", "unit_load"), scope)
            assert set(events[events != 0.0].index) <= set(modes.index) <= set(events.index)
            np.testing.assert_allclose(modes, events.reindex(modes.index), rtol=0, atol=1e-12)


def test_lives_are_those_of_the_tables(pair, reference, changed):
    """One row for each point, lives as both results have them, the ratio that of the lives."""
    ours, theirs = lives(reference), lives(changed)
    rows = pair.points.set_index(POINT)
    assert len(rows) == len(ours) == 28
    np.testing.assert_array_equal(rows["life_km"], ours.reindex(rows.index))
    np.testing.assert_array_equal(rows["other_life_km"], theirs.reindex(rows.index))
    np.testing.assert_allclose(rows["log_life_ratio"], np.log(theirs / ours).reindex(rows.index), rtol=0, atol=1e-12)
    assert set(rows["basis"]) == {"exact"}
    assert set(rows["face"]) == {"same"}
    assert rows["comparable"].all()


def test_causes_leave_nothing_over(pair):
    """Limit, mission, louder noise, an event gone and one more: all of the ratio, modes signed."""
    assert_nothing_left_over(pair, has_modes=True)
    weld = pair.causes[pair.causes["scope"] == "weld"].drop_duplicates(["weld", "kind", "event"])
    assert set(weld["kind"]) == {"limit", "event", "mission", "per_pass", "mode"}
    limit = weld[weld["kind"] == "limit"]
    assert limit["log_life_ratio"].to_numpy() == pytest.approx([np.log(0.5)] * 2, rel=1e-12)
    assert limit["value"].tolist() == [1.0] * 2
    assert limit["other_value"].tolist() == [0.5] * 2
    mission = pair.causes[(pair.causes["kind"] == "mission") & (pair.causes["event"] == NOISE)]
    assert mission["other_value"].to_numpy() / mission["value"].to_numpy() == pytest.approx(0.4 / 0.25, rel=1e-12)
    only = pair.causes[pair.causes["event"].isin(["load and unload", "bump"])]
    assert set(only["kind"]) == {"event", "mode"}
    assert (only.loc[only["event"] == "bump", "value"] == 0.0).all()
    assert (only.loc[only["event"] == "load and unload", "other_value"] == 0.0).all()


def test_a_louder_mode_is_found_by_name(pair):
    """Noise of mode 1 was made louder: its damage per pass and this mode carry the loss of the event."""
    some = pair.causes[(pair.causes["scope"] == "weld") & (pair.causes["event"] == NOISE)]
    modes = some[some["kind"] == "mode"].groupby("weld")
    assert (modes.apply(lambda rows: rows.loc[rows["log_life_ratio"].idxmin(), "mode"]) == 1).all()
    assert (some.loc[some["kind"] == "per_pass", "log_life_ratio"] < 0.0).all()
    assert pair.welds["cause_event"].tolist() == [NOISE] * 2
    for said in pair.welds["why"]:
        assert "its damage per pass in A, most of it by mode 1 (5 Hz)" in said
        assert "the damage limit is 0.5 instead of 1" in said


def test_what_else_differs_is_told(pair):
    """Limit, target, shares, events and the louder record, each with where it shows."""
    found = {one.what: (one.value, one.other_value, one.sits_in) for one in pair.differences}
    assert found["damage limit"] == ("1", "0.5", "limit")
    assert found["target_km"] == ("1000000", "2000000", "the verdict only")
    assert found["share, noise"] == ("0.25", "0.4", "mission")
    assert found["events of A only"] == ("load and unload", "–", "event")
    assert found["events of B only"] == ("–", "bump", "event")
    assert found["record, noise"] == ("noise.csv", "noise.csv, another content", "per_pass")
    assert "record, sine" not in found
    assert not any("curve" in what or "modes" in what for what in found)


@pytest.mark.parametrize(
    "change", [renumbered_and_reversed, turned, lambda case: turned(renumbered_and_reversed(case))]
)
def test_the_same_body_in_another_guise(reference, tmp_path, change):
    """Other node ids, lines run the other way, normals turned: every point meets itself, all ratios are 1."""
    other = result_of(change(sloping()), tmp_path)
    (pair,) = compare([reference, other]).pairs
    assert len(pair.points) == 28
    assert np.abs(pair.points["log_life_ratio"]).max() < 1e-9
    assert pair.points["distance_mm"].max() == 0.0
    assert pair.points["comparable"].all()
    is_turned = change is not renumbered_and_reversed
    assert set(pair.points["face"]) == {"swapped" if is_turned else "same"}
    assert (pair.points["surface"] != pair.points["other_surface"]).all() == is_turned
    assert (pair.points["toe"] == pair.points["other_toe"]).all()
    assert not pair.welds["worst_moved"].any()
    assert_nothing_left_over(pair, has_modes=False)
    assert ("Normals are turned at 14 of 14 stations" in " ".join(notes(pair))) == is_turned


def test_without_the_files_faces_are_assumed(reference, tmp_path):
    """Where a case was edited nothing tells the normals: faces of one name, and every row says so."""
    other = result_of(renumbered_and_reversed(sloping()), tmp_path)
    table = other.parent / "case" / "weld_nodes.csv"
    table.write_text(table.read_text() + "\n", encoding="utf-8")
    (pair,) = compare([reference, other]).pairs
    assert set(pair.points["face"]) == {"face_assumed"}
    assert "B: weld_nodes.csv is not there any more, or was changed" in pair.face_assumed
    (other.parent / "case" / "case.toml").unlink()
    (pair,) = compare([reference, other]).pairs
    assert "case.toml is not there any more" in pair.face_assumed
    assert "Faces of one name are taken for one face" in " ".join(notes(pair))


def test_equal_weld_tables_need_no_files(reference, changed, tmp_path):
    """Both results read the same tables of welds, so nothing has turned, though a folder stands alone now."""
    alone = shutil.copytree(changed, tmp_path / "alone")
    (pair,) = compare([reference, alone]).pairs
    assert set(pair.points["face"]) == {"same"}


def test_renamed_welds(reference, left, tmp_path):
    """Proposed by their lines, used when accepted, or named by a table; without either the rest is compared."""
    (pair,) = compare([reference, left]).pairs
    assert pair.welds["weld"].tolist() == ["B"]
    assert "A = left (0 mm). Take them with --accept-proposed" in " ".join(notes(pair))
    (accepted,) = compare([reference, left], accept_proposed=True).pairs
    of_map = tmp_path / "map.csv"
    of_map.write_text("weld_a,weld_b\nA,left\n", encoding="utf-8")
    (mapped,) = compare([reference, left], weld_map=of_map).pairs
    for found, by in ((accepted, "geometry"), (mapped, "map")):
        assert dict(zip(found.welds["weld"], found.welds["matched_by"], strict=True)) == {"A": by, "B": "name"}
        assert np.abs(found.points["log_life_ratio"]).max() == 0.0
        assert set(found.points["face"]) == {"same"}


def test_a_map_crosses_names(reference, tmp_path):
    """What the table says comes before equal names: A there is B here."""
    of_map = tmp_path / "map.csv"
    of_map.write_text("weld_a,weld_b\nA,B\nB,A\n", encoding="utf-8")
    other = shutil.copytree(reference, tmp_path / "copy")
    (pair,) = compare([reference, other], weld_map=of_map).pairs
    assert pair.matched.other == {"A": "B", "B": "A"}
    assert not pair.points["comparable"].any()
    assert (pair.causes["scope"] == "weld").all()
    assert "28 of 28 matched points are further apart" in " ".join(notes(pair))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "weld_a,weld_b\nA,left\nX,B\n",
            "column weld_a, row 2: there is no weld 'X' in result A. Name one of its welds: A, B",
        ),
        ("weld_a,weld_b\nA,lefd\n", "column weld_b, row 1: there is no weld 'lefd' in result B. Write 'left'"),
        (
            "weld_a,weld_b\nA,left\nB,left\n",
            "column weld_b, row 2: weld 'left' stands in row 1 as well. Keep one of the rows",
        ),
        ("weld_a,weld_b\nA,left\nA,B\n", "column weld_a, row 2: weld 'A' stands in row 1 as well"),
        ("weld_a\nA\n", "column weld_b"),
        ("weld_a,weld_b,weld_c\nA,left,x\n", "weld_c"),
        ("weld_a,weld_b\nA,\n", "the text is missing"),
    ],
)
def test_a_wrong_map(reference, left, tmp_path, text, words):
    """File, row, value and what to do."""
    of_map = tmp_path / "map.csv"
    of_map.write_text(text, encoding="utf-8")
    with pytest.raises(DataError) as refused:
        compare([reference, left], weld_map=of_map)
    assert words in str(refused.value)


def test_no_weld_in_common(reference, tmp_path):
    """Both registers in a line, and both ways out."""
    other = result_of(renamed(sloping(2.0), {"A": "left", "B": "right"}), tmp_path)
    with pytest.raises(DataError) as refused:
        compare([reference, other])
    said = str(refused.value)
    assert "there A, B, here left, right" in said
    assert "take the 2 whose lines lie on each other with --accept-proposed" in said
    assert len(compare([reference, other], accept_proposed=True).pairs[0].welds) == 2


def test_sequences_take_part(tmp_path):
    """What a loop adds is a cause of its own, in one result or in both, also where it relieves."""
    case = empty_and_laden()
    plain = result_of(case, tmp_path / "plain", diagnosed=True)
    results = {}
    for runs in (0.5, 1.5):
        case = empty_and_laden()
        case.extra = LOOP.replace("1.5", str(runs))
        results[runs] = result_of(case, tmp_path / str(runs), diagnosed=True)
    found = compare([plain, results[1.5], results[0.5]])
    for pair in (*found.pairs, *compare([results[1.5], results[0.5]]).pairs, *compare([results[0.5], plain]).pairs):
        assert_nothing_left_over(pair, has_modes=True)
        assert "sequence" in set(pair.causes["kind"])
    often = compare([results[1.5], results[0.5]]).pairs[0].causes
    often = often[often["event"] == "(sequence 1)"]
    assert (often.loc[often["kind"] == "mission", "log_life_ratio"] > 0.0).all()
    assert often.loc[often["kind"] == "per_pass", "log_life_ratio"].to_numpy() == pytest.approx(0.0, abs=1e-14)
    appears = found.pairs[0].causes
    assert set(appears.loc[appears["event"] == "(sequence 1)", "kind"]) == {"sequence", "mode"}


def test_without_a_diagnosis_causes_end_at_events(reference, changed, tmp_path):
    """No modes, and the reason is said; an older result opens all the same."""
    bare = shutil.copytree(changed, tmp_path / "bare")
    for name in ("attribution", "track", "diagnosis", "levers", "resonance", "weld_resonance", "watch"):
        (bare / f"{name}.parquet").unlink(missing_ok=True)
    without_hashes(bare)
    (pair,) = compare([reference, bare]).pairs
    assert_nothing_left_over(pair, has_modes=False)
    assert not pair.causes["kind"].isin(["mode", "unit_load"]).any()
    assert "Causes go as far as events: no diagnosis of B" in " ".join(notes(pair))
    assert pair.welds["cause_by"].tolist() == [""] * 2


def test_a_diagnosis_of_other_damage_is_left_out(reference, changed, tmp_path):
    """Modes that do not add up to the damage of the result are not scaled to it: they are left out, and said."""
    odd = without_hashes(shutil.copytree(changed, tmp_path / "odd"))
    table = pq.read_table(odd / "attribution.parquet")
    place = table.schema.get_field_index("damage_per_km")
    doubled = pd.Series(table["damage_per_km"].to_pandas() * 1.01)
    pq.write_table(
        table.set_column(place, table.schema.field(place), [doubled.to_numpy()]), odd / "attribution.parquet"
    )
    (pair,) = compare([reference, odd]).pairs
    some = pair.causes[pair.causes["kind"] == "mode"]
    assert set(some["event"]) <= {"load and unload"}  # B has not this event, so that only A has to tell of it
    assert_nothing_left_over(pair, has_modes=False)


def test_points_that_nothing_damages(reference, tmp_path):
    """Both endless: ratio 1; one of them: infinite, and no causes."""
    case = sloping(2.0)
    for name, table in case.histories.items():
        case.histories[name] = table.assign(q_1=0.0, q_2=0.0, q_7=0.0)
    still = result_of(case, tmp_path)
    (pair,) = compare([reference, still]).pairs
    assert (pair.points["log_life_ratio"] == np.inf).all()
    assert pair.causes.empty
    assert (pair.welds["why"] == "").all()
    assert "28 points are damaged in one of the results only" in " ".join(notes(pair))
    assert list(sentences(pair))
    (back,) = compare([still, reference]).pairs
    assert (back.points["log_life_ratio"] == -np.inf).all()
    again = shutil.copytree(still, tmp_path / "again")
    (none,) = compare([still, again]).pairs
    assert (none.points["log_life_ratio"] == 0.0).all()
    assert (none.points["life_ratio"] == 1.0).all()


def test_bounds_make_ratios_one_sided(reference, tmp_path):
    """Screened points of B: at least; of A: at most; of both: unknown. None of them has causes."""
    screened = without_hashes(shutil.copytree(reference, tmp_path / "screened"))
    table = pq.read_table(screened / "nodes.parquet")
    tier = np.where(np.array(table["order"]) == 3, "modal bound", "")
    place = table.schema.get_field_index("screened")
    pq.write_table(table.set_column(place, "screened", [tier.tolist()]), screened / "nodes.parquet")
    for folders, basis in (((reference, screened), "at_least"), ((screened, reference), "at_most")):
        (pair,) = compare(folders).pairs
        bounded = pair.points["order"] == 3
        assert set(pair.points.loc[bounded, "basis"]) == {basis}
        assert set(pair.points.loc[~bounded, "basis"]) == {"exact"}
        assert not (pair.causes["order"] == 3).any()
    other = shutil.copytree(screened, tmp_path / "other")
    (pair,) = compare([screened, other]).pairs
    assert set(pair.points.loc[pair.points["order"] == 3, "basis"]) == {"unknown"}
    assert pair.points.loc[pair.points["order"] == 3, "log_life_ratio"].isna().all()
    assert "4 of 28 ratios are one-sided or unknown" in " ".join(notes(pair))


def test_many_points_have_causes_at_their_worst_only(reference, changed, monkeypatch):
    """Beyond so many rows: the worst points of both, and what is left out is said."""
    monkeypatch.setattr("fatigue.decide.compare.pairs.MOST_ROWS", 10)
    (pair,) = compare([reference, changed]).pairs
    assert not pair.every_point
    some = pair.causes[pair.causes["scope"] == "point"].drop_duplicates(POINT)
    assert 2 <= len(some) <= 4
    assert_nothing_left_over(pair, has_modes=True)
    assert "those of all points would be more than" in " ".join(notes(pair))


def test_verdicts_flip_with_life_or_target(reference, tmp_path):
    """A weld that meets its target in one of them only is told, also where only the target moved."""
    shortest = float(lives(reference).min())
    results = {}
    for name, target in (("near", 0.999 * shortest), ("far", 1.001 * shortest)):
        case = sloping()
        case.mission = case.mission | {"target_km": target}
        results[name] = result_of(case, tmp_path / name)
    (pair,) = compare([results["near"], results["far"]]).pairs
    lost = pair.welds[pair.welds["flip"] == "lost"]
    assert len(lost) == 1
    assert (pair.welds["log_life_ratio"] == 0.0).all()
    assert f"1 weld meets the target in A and misses it in B: {lost['weld'].iloc[0]}." in list(sentences(pair))
    (back,) = compare([results["far"], results["near"]]).pairs
    assert sorted(back.welds["flip"]) == ["", "gained"]


def test_curves_and_rules_that_differ(reference, tmp_path):
    """Another survival level and upsampling sit in the damage of a pass, and are listed."""
    case = sloping()
    case.curve["survival"] = "mean-3sigma"
    case.counting["upsample"] = 2
    other = result_of(case, tmp_path)
    (pair,) = compare([reference, other]).pairs
    found = {one.what: (one.value, one.other_value, one.sits_in) for one in pair.differences}
    assert found["survival"] == ("mean-2sigma", "mean-3sigma", "per_pass")
    assert found["upsample"] == ("1", "2", "per_pass")
    assert found["upsampled, noise"] == ("1", "2", "per_pass")
    assert (pair.points["log_life_ratio"] < 0.0).all()
    assert_nothing_left_over(pair, has_modes=False)


def test_a_mission_alone_is_all_mission(reference, tmp_path):
    """Other shares of the same records: what events add is how often they occur, and the sum of it the ratio."""
    case = sloping()
    case.events[0]["share"], case.events[1]["share"] = 0.2, 0.8
    other = result_of(case, tmp_path)
    causes = compare([reference, other]).pairs[0].causes
    assert np.abs(causes.loc[causes["kind"] == "per_pass", "log_life_ratio"]).max() < 1e-14
    mission = causes[causes["kind"] == "mission"].groupby(["scope", *POINT])["log_life_ratio"].sum()
    ratio = np.log(lives(other) / lives(reference))
    np.testing.assert_allclose(mission["point"], ratio.reindex(mission["point"].index), rtol=0, atol=1e-12)


def test_unit_loads_take_part(tmp_path):
    """A mode given as a unit load adds what it added as a mode, by its name; modes stay what they are."""
    found = []
    for as_load in (False, True):
        folders = []
        for factor in (1.0, 1.5):
            case = sloping()
            table = case.histories["noise"]
            case.histories["noise"] = table.assign(q_2=factor * table["q_2"])
            folder = tmp_path / f"{as_load}{factor}"
            if as_load:
                write_with_loads(case, folder / "case", as_unit_load(case, 2, "wind"))
                assess(folder / "case" / "case.toml", folder / "result", threads=1, report=False)
                diagnose(folder / "result")
                folders.append(folder / "result")
            else:
                folders.append(result_of(case, folder, diagnosed=True))
        (pair,) = compare(folders).pairs
        assert_nothing_left_over(pair, has_modes=True)
        found.append(pair.causes)
    of_mode = found[0][found[0]["mode"] == 2].set_index(["scope", *POINT, "event"])["log_life_ratio"]
    of_load = found[1][found[1]["unit_load"] == "wind"].set_index(["scope", *POINT, "event"])["log_life_ratio"]
    assert len(of_load) == len(of_mode) > 0
    assert set(found[1].loc[found[1]["unit_load"].notna(), "kind"]) == {"unit_load"}
    np.testing.assert_allclose(of_load, of_mode.reindex(of_load.index), rtol=1e-6, atol=1e-9)


def test_welds_that_only_one_result_assesses(reference, tmp_path):
    """Named with the side they are on; the rest is compared."""
    case = sloping()
    for table in ("welds", "weld_nodes", "nodal_forces"):
        rows = getattr(case, table)
        setattr(case, table, rows[rows["weld"] == "A"])
    other = result_of(case, tmp_path)
    (pair,) = compare([reference, other]).pairs
    assert pair.welds["weld"].tolist() == ["A"]
    assert "Only A has 1 weld: B." in list(notes(pair))
    table = match_rows(pair)
    assert table.loc[table["weld"] == "B", "note"].tolist() == ["no partner"]
    (back,) = compare([other, reference], into=tmp_path / "out").pairs
    assert "no partner" in (tmp_path / "out" / "compare.html").read_text(encoding="utf-8")
    assert pd.read_parquet(tmp_path / "out" / "compare_matches.parquet")["weld"].isna().tolist() == [False, True]
    assert "Only B has 1 weld: B." in list(notes(back))


def test_a_diagnosis_of_some_points_is_said(reference, changed, tmp_path):
    """Modes stand where both diagnoses tell of a point, as in large jobs; the others end at events."""
    some = without_hashes(shutil.copytree(changed, tmp_path / "some"))
    table = pq.read_table(some / "attribution.parquet")
    pq.write_table(table.filter(pc.less(table["order"], 3)), some / "attribution.parquet")
    (pair,) = compare([reference, some]).pairs
    modes = pair.causes[(pair.causes["kind"] == "mode") & pair.causes["other_value"].ne(0.0)]
    assert set(modes["order"]) == {1, 2}
    assert_nothing_left_over(pair, has_modes=False)
    gone = pair.causes[(pair.causes["event"] == "load and unload") & (pair.causes["kind"] == "mode")]
    assert set(gone["order"]) == set(range(1, 8))  # of an event that B has not A alone has to tell


def test_everything_is_written(reference, changed, tmp_path):
    """Every table with unit and meaning of its columns, the page and the record; the results stay as they are."""
    before = {path.name: path.read_bytes() for path in reference.iterdir()}
    found = compare([reference, changed], into=tmp_path / "out", csv=True)
    for name, columns in COMPARED.items():
        table = pq.read_table(tmp_path / "out" / f"{name}.parquet")
        assert table.column_names == [column.name for column in columns]
        assert all(field.metadata[b"unit"] and field.metadata[b"description"] for field in table.schema)
        assert len(pd.read_csv(tmp_path / "out" / f"{name}.csv")) == table.num_rows
    page = (tmp_path / "out" / "compare.html").read_text(encoding="utf-8")
    for said in ("Who gains, who loses, and why", "damage limit", "noise", "Which weld is which"):
        assert said in page
    record = json.loads((tmp_path / "out" / "compare.json").read_text(encoding="utf-8"))
    assert record["program"] == "fatigue compare"
    assert record["results"][1]["shortest_life_km"] == pytest.approx(float(found.results[1].welds["life_km"].min()))
    assert {path.name: path.read_bytes() for path in reference.iterdir()} == before
    matches = pd.read_parquet(tmp_path / "out" / "compare_matches.parquet")
    assert matches["points"].tolist() == matches["comparable_points"].tolist() == [14, 14]


def test_the_same_bytes_again(reference, changed, tmp_path):
    """Tables depend on the results alone."""
    for name in ("one", "two"):
        compare([reference, changed], into=tmp_path / name)
    for name in COMPARED:
        files = [(tmp_path / one / f"{name}.parquet").read_bytes() for one in ("one", "two")]
        assert files[0] == files[1]


def test_where_shear_decides_there_are_no_causes(tmp_path):
    """The larger sum of shear is no sum of events: causes of it would not add up to the ratio of the lives."""
    results = []
    for name, shear in (("a", 3.0), ("b", 3.9)):
        case = sloping()
        case.nodal_forces["fx_N"] += shear * case.nodal_forces[["fy_N", "fz_N"]].abs().max(axis=1)
        case.extra = '[multiaxial]\nmethod = "range"\n'
        results.append(result_of(case, tmp_path / name))
    (pair,) = compare(results).pairs
    assert 0 < pair.by_shear < len(pair.points)
    told = pair.causes.loc[pair.causes["scope"] == "point", POINT].drop_duplicates()
    assert len(told) + pair.by_shear == len(pair.points)
    assert_nothing_left_over(pair, has_modes=False)
    assert f"Shear decides at {pair.by_shear} points" in " ".join(notes(pair))


def test_too_few_or_the_same_twice(reference):
    """One line each."""
    with pytest.raises(CaseError, match="1 result is given"):
        compare([reference])
    with pytest.raises(CaseError, match="is given twice, as A and as B"):
        compare([reference, reference.parent / "." / reference.name])


def test_a_copy_is_the_same_result(reference, tmp_path):
    """Compared, and said to be the same."""
    (pair,) = compare([reference, shutil.copytree(reference, tmp_path / "copy")]).pairs
    assert (pair.points["log_life_ratio"] == 0.0).all()
    assert "B is the same result as A" in " ".join(notes(pair))


def test_the_folder_of_a_result_is_no_output(reference, changed):
    """What is compared stays as it is."""
    with pytest.raises(DataError, match="is one of the results"):
        compare([reference, changed], into=changed)


def test_a_damage_table_of_other_rows_is_refused(reference, changed, tmp_path):
    """Rows that are not those of the points and events of the result."""
    odd = without_hashes(shutil.copytree(changed, tmp_path / "odd"))
    table = pq.read_table(odd / "damage.parquet")
    pq.write_table(table.take(np.arange(table.num_rows)[::-1]), odd / "damage.parquet")
    with pytest.raises(DataError, match="its rows are not those of the points and events"):
        compare([reference, odd])
