"""Load spectra of a finished result: tables that agree with those of the assessment, and refusals in one line."""

import shutil

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.errors import CaseError, DataError
from fatigue.life.counting import long_rainflow
from fatigue.life.counting.rainflow import rainflow
from fatigue.life.curves import catalogue, damage_law
from fatigue.life.rule import cycle_damage, ratio_factor
from fatigue.load_spectra import recounted
from fatigue.results import LOAD_SPECTRA, read_provenance
from fatigue.spectra import spectra
from tests.small_case import THICKNESS, small_case
from tests.test_sequences import LOOP, empty_and_laden

KEY = ["weld", "part", "order", "surface"]


def sampled_case():
    """The small case, its samples counted as they are."""
    case = small_case()
    case.counting = {"upsample": 1}
    return case


@pytest.fixture(scope="module")
def assessed(tmp_path_factory):
    """Case and result, to be copied by tests that write."""
    folder = tmp_path_factory.mktemp("spectra")
    assess(load_case(sampled_case().write(folder / "case")), folder / "result", threads=1, report=False)
    return folder


@pytest.fixture(scope="module")
def found(assessed):
    """Summary and tables of the worst points."""
    summary = spectra(assessed / "result", exponents=[3.0, 5.0], threads=1)
    names = (*LOAD_SPECTRA, "nodes", "damage", "cycles")
    return summary, {name: pd.read_parquet(assessed / "result" / f"{name}.parquet") for name in names}


@pytest.fixture
def own(assessed, tmp_path):
    """A copy of case and result for one test."""
    shutil.copytree(assessed / "case", tmp_path / "case")
    shutil.copytree(assessed / "result", tmp_path / "result")
    return tmp_path


def write(folder, name, text):
    """Write a file of a test."""
    path = folder / name
    path.write_text(text)
    return path


def test_sums_are_those_of_the_assessment(found):
    """Counts, largest ranges and damage of every event, and of the mission, are those in the tables of the result."""
    _, table = found
    events = table["equivalent"].merge(table["damage"], on=[*KEY, "event"], suffixes=("", "_d"))
    assert len(events) == 2 * 3 * 2  # welds, events, exponents
    weight = events["passes_per_km"]
    np.testing.assert_allclose(events["cycles_per_km"], weight * events["cycles_per_pass"], rtol=1e-12)
    np.testing.assert_allclose(events["damage_per_km"], weight * events["damage_per_pass"], rtol=1e-12)
    assert (events["max_range_MPa"] == events["max_range_MPa_d"]).all()
    by_distance = events[events["cycles_per_km_d"].notna()]
    share = by_distance["event"].map({"sine": 0.75, "noise": 0.25})
    np.testing.assert_allclose(by_distance["cycles_per_km"], share * by_distance["cycles_per_km_d"], rtol=1e-12)
    mission = table["equivalent"].query("event == '(mission)'").merge(table["nodes"], on=KEY, suffixes=("", "_n"))
    np.testing.assert_allclose(mission["damage_per_km"], mission["damage_per_km_n"], rtol=1e-12)
    assert (mission["max_range_MPa"] == mission["max_range_MPa_n"]).all()


def test_the_equivalent_range_is_that_of_the_points(own):
    """With the first slope of the curve, which is taken unless exponents are given, and said."""
    summary = spectra(own / "result", threads=1)
    table = pd.read_parquet(own / "result" / "equivalent.parquet")
    nodes = pd.read_parquet(own / "result" / "nodes.parquet")
    mission = table.query("event == '(mission)'").merge(nodes, on=KEY, suffixes=("", "_n"))
    expected = mission["equivalent_range_2e6_MPa_n"]
    np.testing.assert_allclose(mission["equivalent_range_2e6_MPa"], expected, rtol=1e-12)
    np.testing.assert_allclose(mission["equivalent_amplitude_2e6_MPa"], 0.5 * expected, rtol=1e-12)
    assert "first slope of the curve" in summary.as_text()
    assert "3.609" in summary.as_text()


def test_classes_hold_what_was_counted(found):
    """Of every event the classes add up to its cycles; so do both matrices; crossings are those of the cycles."""
    _, table = found
    by = [*KEY, "event"]
    cycles = table["equivalent"].groupby(by)["cycles_per_km"].first()
    for name in ("spectrum", "range_mean", "from_to"):
        total = table[name].groupby(by)["count_per_km"].sum()
        np.testing.assert_allclose(total, cycles, rtol=1e-12)
        assert (table[name]["count_per_km"] >= 0.0).all()
    assert (table["range_mean"]["count_per_km"] > 0.0).all()
    first = table["spectrum"].groupby(by).first()
    np.testing.assert_allclose(first["exceedance_per_1e6_km"], 1e6 * cycles, rtol=1e-12)
    margin = table["range_mean"].groupby([*by, "range_lower_MPa"])["count_per_km"].sum()
    classes = table["spectrum"].set_index([*by, "lower_MPa"])["count_per_km"]
    np.testing.assert_allclose(margin, classes[classes > 0.0].sort_index(), rtol=1e-12)


def test_all_rows_of_a_table_have_the_same_classes(found):
    """From 0 to the largest range, and from the lowest to the highest reversal, in 64 classes."""
    _, table = found
    edges = table["spectrum"].groupby([*KEY, "event"])["lower_MPa"].apply(tuple)
    assert len(set(edges)) == 1
    assert len(edges.iloc[0]) == 64
    assert table["spectrum"]["lower_MPa"].min() == 0.0
    assert table["spectrum"]["upper_MPa"].max() == table["cycles"]["range_MPa"].max()
    levels = table["level_crossings"]["level_MPa"]
    ends = table["cycles"]["mean_MPa"] + 0.5 * table["cycles"]["range_MPa"]
    assert levels.max() == pytest.approx(ends.max(), rel=1e-12)


def test_events_add_up_to_the_mission(found):
    """Weighted with their passes per km, so that the rows of all events are those of the mission."""
    _, table = found
    for name, columns in (
        ("spectrum", ["lower_MPa"]),
        ("range_mean", ["range_lower_MPa", "mean_lower_MPa"]),
        ("from_to", ["from_lower_MPa", "to_lower_MPa"]),
        ("level_crossings", ["level_MPa"]),
    ):
        value = "up_crossings_per_km" if name == "level_crossings" else "count_per_km"
        is_mission = table[name]["event"] == "(mission)"
        of_events = table[name][~is_mission].groupby([*KEY, *columns])[value].sum()
        mission = table[name][is_mission].groupby([*KEY, *columns])[value].sum()
        np.testing.assert_allclose(of_events, mission, rtol=1e-12)


def test_the_cycles_are_those_of_the_table_of_cycles(found):
    """Means and from-to of the sine at one weld, from the cycles that the assessment listed."""
    _, table = found
    listed = table["cycles"].query("weld == 'A' and event == 'load and unload'")
    one = table["from_to"].query("weld == 'A' and event == 'load and unload'").iloc[0]
    assert listed["count"].tolist() == [0.5]
    assert one["count_per_km"] == 0.5 * 0.002
    assert one["from_lower_MPa"] <= 0.0 < one["from_upper_MPa"]
    assert one["to_lower_MPa"] <= listed["range_MPa"].iloc[0] <= one["to_upper_MPa"] + 1e-9


def test_damage_equivalent_loads(found):
    """An event against 1 Hz over its pass, the mission against one cycle a km."""
    _, table = found
    rows = table["equivalent"].query("weld == 'A' and exponent == 3.0").set_index("event")
    cycles = table["cycles"].query("weld == 'A' and event == 'sine'")
    total = float((cycles["count"] * cycles["range_MPa"] ** 3).sum())
    assert rows.loc["sine", "del_MPa"] == pytest.approx((total / 12.0) ** (1 / 3), rel=1e-12)
    assert rows.loc["sine", "del_reference"] == "1 Hz"
    assert rows.loc["(mission)", "del_reference"] == "1 per km"
    assert rows.loc["(mission)", "del_MPa"] == pytest.approx(rows.loc["(mission)", "power_sum_per_km"] ** (1 / 3))


def test_spectra_of_the_coordinates(found, assessed):
    """Every mode by itself, in classes of its own; a mode that rests has none."""
    summary, table = found
    signals = table["signals"]
    assert signals["signal"].unique().tolist() == ["q_1", "q_2", "q_7"]
    assert set(signals["unit"]) == {"unit of the mode"}
    history = pd.read_csv(assessed / "case" / "noise.csv")["q_2"].to_numpy()[200:]
    cycles = rainflow(history, "repeat")
    rows = signals.query("signal == 'q_2' and event == 'noise'")
    per_km = 0.25 / (0.1 * 11.0)
    assert rows["count_per_km"].sum() == pytest.approx(per_km * cycles.count.sum(), rel=1e-12)
    assert rows["power_sum_per_km"].sum() == pytest.approx(per_km * np.sum(cycles.count * cycles.range**3), rel=1e-12)
    assert rows["largest"].max() == cycles.range.max()
    assert signals.query("signal == 'q_2' and event == 'sine'")["count_per_km"].sum() == 0.0
    line = next(line for line in summary.signals if line.signal == "q_7")
    assert line.del_per_km[0] == pytest.approx(line.power_sum_per_km[0] ** (1 / 3))


def test_the_record_says_how_they_were_made(found, assessed):
    """Points, classes, exponents and files are in the provenance, the tables among the outputs."""
    record = read_provenance(assessed / "result")
    assert record["load_spectra"]["exponents"] == [3.0, 5.0]
    assert record["load_spectra"]["points"] == "the worst point of every weld, 2"
    assert {f"{name}.parquet" for name in LOAD_SPECTRA} <= {entry["file"] for entry in record["outputs"]}


def test_chosen_points_and_threads_change_no_number(own):
    """Listed points give the same rows, in the order of the result, whoever counts them."""
    path = write(own, "points.csv", "weld,order,surface\nB,3,top\nA,1,top\nA,1,bottom\nA,1,top\n")
    spectra(own / "result", points=path, threads=1)
    one = {name: (own / "result" / f"{name}.parquet").read_bytes() for name in LOAD_SPECTRA}
    spectra(own / "result", points=path, threads=3)
    assert one == {name: (own / "result" / f"{name}.parquet").read_bytes() for name in LOAD_SPECTRA}
    rows = pd.read_parquet(own / "result" / "equivalent.parquet")[KEY].drop_duplicates()
    assert rows.to_numpy().tolist() == [["A", 1, 1, "top"], ["A", 1, 1, "bottom"], ["B", 1, 3, "top"]]


def test_records_of_any_length_give_the_same_rows(own, monkeypatch):
    """Counted in one go, or piece by piece as their chunks come."""
    spectra(own / "result", threads=1)
    one = {name: pd.read_parquet(own / "result" / f"{name}.parquet") for name in LOAD_SPECTRA}
    monkeypatch.setattr(recounted, "_SAMPLES_AT_ONCE", 100)
    monkeypatch.setattr(long_rainflow, "FEWEST", 7)
    spectra(own / "result", threads=1)
    for name, rows in one.items():
        pd.testing.assert_frame_equal(rows, pd.read_parquet(own / "result" / f"{name}.parquet"), rtol=1e-12)


def test_edges_of_a_file(own):
    """Classes as they are given; what lies outside is warned of, and in no class."""
    path = write(own, "edges.csv", "range_MPa,level_MPa\n0,-200\n50,0\n80,200\n100,\n")
    summary = spectra(own / "result", edges=path, threads=1)
    rows = pd.read_parquet(own / "result" / "spectrum.parquet").query("weld == 'B' and event == '(mission)'")
    assert rows["lower_MPa"].tolist() == [0.0, 50.0, 80.0]
    assert rows["upper_MPa"].tolist() == [50.0, 80.0, 100.0]
    cycles = pd.read_parquet(own / "result" / "cycles.parquet").query("weld == 'B'")
    per_km = cycles["event"].map({"sine": 0.75 / 0.6, "noise": 0.25 / 1.1, "load and unload": 0.002}) * cycles["count"]
    reached = [1e6 * per_km[cycles["range_MPa"] >= edge].sum() for edge in (0.0, 50.0, 80.0)]
    np.testing.assert_allclose(rows["exceedance_per_1e6_km"], reached, rtol=1e-12)
    assert [problem.code for problem in summary.warnings] == ["outside_edges"]
    assert "ranges reach 112.3 MPa, the last edge is 100" in summary.warnings[0].what


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("range_MPa\n0\n5\n5\n", r"column range_MPa, row 3: the edges do not ascend: 5 follows 5"),
        ("range_MPa\n0\n5\n4\n", r"row 3: the edges do not ascend: 4 follows 5"),
        ("range_MPa\n-1\n5\n", r"row 1: -1 is below 0"),
        ("range_MPa\n5\n", r"1 edges make no classes"),
        ("range_MPa\n0\nabc\n", r"'abc' is not a number"),
        ("range_MPa,level_MPa\n0,\n1,2\n", r"column level_MPa, row 2: an edge stands below an empty cell"),
        ("edge\n0\n1\n", r"range_MPa"),
    ],
)
def test_edges_that_make_no_classes(own, text, words):
    """One line with file, column and row; nothing is written."""
    with pytest.raises(DataError, match=words):
        spectra(own / "result", edges=write(own, "edges.csv", text))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("weld,order,surface\nA,99,top\n", "points.csv: row 1: there is no point weld 'A', part 1, order 99, top"),
        ("weld,order,surface\nC,1,top\n", "there is no point weld 'C'"),
        ("weld,order,surface,part\nA,1,top,2\n", "part 2"),
        ("weld,order,surface,node\nA,1,top,101\n", "the point at this place has the node 100, not 101"),
        ("weld,order,surface\nA,1,upper\n", "'upper' is not one of top, bottom"),
        ("weld,order,surface\n", "no rows"),
        ("weld,order\nA,1\n", "surface"),
        ("weld,order,surface\n" + "A,99,top\n" * 30, "20 more rows name points"),
    ],
)
def test_points_that_are_not_there(own, text, words):
    """One line with file and row."""
    with pytest.raises(DataError, match=words):
        spectra(own / "result", points=write(own, "points.csv", text))


def test_a_point_that_never_moves(tmp_path):
    """A weld without stress has no cycles, and its rows say so."""
    case = sampled_case()
    forces = case.nodal_forces
    forces.loc[forces["weld"] == "A", ["fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"]] = 0.0
    assess(load_case(case.write(tmp_path / "case")), tmp_path / "result", threads=1, report=False)
    summary = spectra(tmp_path / "result", threads=1)
    rows = pd.read_parquet(tmp_path / "result" / "spectrum.parquet").query("weld == 'A'")
    assert len(rows) == 64 * 4
    assert (rows["count_per_km"] == 0.0).all()
    assert rows["max_MPa"].isna().all()
    assert pd.read_parquet(tmp_path / "result" / "from_to.parquet").query("weld == 'A'").empty
    still = next(point for point in summary.at_points if point.weld == "A")
    assert still.events[-1].equivalent[0].equivalent_range_2e6_MPa == 0.0
    assert still.events[-1].max_range_MPa is None
    assert "A, node" in summary.as_text()


def test_nothing_moves_at_all(tmp_path):
    """Even then there are classes, one MPa of them."""
    case = sampled_case()
    for name, history in case.histories.items():
        case.histories[name] = history.assign(q_1=1.0, q_2=2.0, q_7=0.0)
    assess(load_case(case.write(tmp_path / "case")), tmp_path / "result", threads=1, report=False)
    spectra(tmp_path / "result", classes=4, threads=1)
    rows = pd.read_parquet(tmp_path / "result" / "spectrum.parquet")
    assert sorted(set(rows["upper_MPa"])) == [0.25, 0.5, 0.75, 1.0]
    assert (rows["count_per_km"] == 0.0).all()


def test_factors_and_upsampling_are_those_of_the_assessment(tmp_path):
    """A stress factor, upsampling, a knee and an event of half cycles: damage and ranges stay those of the tables."""
    case = small_case(seconds=4.0)
    case.counting = {"upsample": 2}
    case.curve = {"name": "master-aluminium", "extension": "haibach", "knee_cycles": 1e6}
    case.events[1] |= {"stress_factor": 1.3, "residue": "half"}
    assess(load_case(case.write(tmp_path / "case")), tmp_path / "result", threads=1, report=False)
    spectra(tmp_path / "result", threads=1)
    rows = pd.read_parquet(tmp_path / "result" / "equivalent.parquet")
    damage = pd.read_parquet(tmp_path / "result" / "damage.parquet")
    both = rows.merge(damage, on=[*KEY, "event"], suffixes=("", "_d"))
    np.testing.assert_allclose(both["damage_per_km"], both["passes_per_km"] * both["damage_per_pass"], rtol=1e-12)
    assert (both["max_range_MPa"] == both["max_range_MPa_d"]).all()
    crossings = pd.read_parquet(tmp_path / "result" / "level_crossings.parquet")
    assert (crossings["up_crossings_per_km"] >= 0.0).all()


def test_cycles_across_events_are_listed_with_those_they_replace(tmp_path):
    """A loop has its rows, replaced cycles below 0, so that the mission is that of the points."""
    case = empty_and_laden()
    case.extra = LOOP
    assess(load_case(case.write(tmp_path / "case")), tmp_path / "result", threads=1, report=False)
    summary = spectra(tmp_path / "result", threads=1)
    names = (*LOAD_SPECTRA, "nodes", "damage")
    table = {name: pd.read_parquet(tmp_path / "result" / f"{name}.parquet") for name in names}
    both = table["equivalent"].merge(table["damage"], on=[*KEY, "event"], suffixes=("", "_d"))
    loop = both.query("event == '(sequence 1)'")
    assert len(loop) == 2
    np.testing.assert_allclose(both["damage_per_km"], both["passes_per_km"] * both["damage_per_pass"], rtol=1e-9)
    np.testing.assert_allclose(both["cycles_per_km"], both["passes_per_km"] * both["cycles_per_pass"], atol=1e-12)
    np.testing.assert_allclose(loop["max_range_MPa"], loop["max_range_MPa_d"], rtol=1e-12)
    assert set(loop["del_reference"]) == {"1 per run"}
    mission = table["equivalent"].query("event == '(mission)'").merge(table["nodes"], on=KEY, suffixes=("", "_n"))
    for column in ("damage_per_km", "max_range_MPa", "equivalent_range_2e6_MPa"):
        np.testing.assert_allclose(mission[column], mission[f"{column}_n"], rtol=1e-12)
    spectrum = table["spectrum"]
    assert (spectrum.query("event == '(sequence 1)'")["count_per_km"] < 0.0).any()
    assert (spectrum.query("event == '(mission)'")["count_per_km"] >= 0.0).all()
    assert (table["range_mean"].query("event == '(mission)'")["count_per_km"] > 0.0).all()
    crossings = table["level_crossings"].query("event == '(mission)'")["up_crossings_per_km"]
    assert (crossings >= -1e-12).all()
    assert "(sequence 1)" in summary.as_text()


def test_a_loop_is_counted_as_its_record_in_one_piece(tmp_path):
    """Events and the loop add up to the spectra of one record with all passes in their order, run after run."""
    case = empty_and_laden()
    case.extra = LOOP
    rates = {"sine": 1.5, "load": 1.5, "laden": 1.5, "unload": 1.5}
    case.events = [
        {"name": name, "history": name, "per_1000_km": rate, "residue": "half" if "load" in name else "repeat"}
        for name, rate in rates.items()
    ]
    whole = empty_and_laden()
    pieces = [whole.histories[name].drop(columns="time_s") for name in rates]
    joined = pd.concat(pieces, ignore_index=True)
    joined.insert(0, "time_s", 0.005 * np.arange(len(joined)))
    whole.histories = {"all": joined}
    whole.events = [{"name": "all", "history": "all", "per_1000_km": 1.5, "residue": "repeat"}]
    tables = []
    for name, one in (("loop", case), ("whole", whole)):
        assess(load_case(one.write(tmp_path / name / "case")), tmp_path / name / "result", threads=1, report=False)
        spectra(tmp_path / name / "result", threads=1, exponents=[3.0])
        read = {of: pd.read_parquet(tmp_path / name / "result" / f"{of}.parquet") for of in LOAD_SPECTRA}
        tables.append({of: rows.query("event == '(mission)'") for of, rows in read.items()})
    loop, one = tables
    for name, value in (("spectrum", "count_per_km"), ("level_crossings", "up_crossings_per_km")):
        np.testing.assert_allclose(loop[name][value], one[name][value], atol=1e-12)
    for name in ("range_mean", "from_to"):
        assert len(loop[name]) == len(one[name])
        np.testing.assert_allclose(loop[name].iloc[:, 6:], one[name].iloc[:, 6:], rtol=1e-9, atol=1e-12)
    numbers = ["equivalent_range_2e6_MPa", "cycles_per_km", "max_range_MPa", "damage_per_km", "bending_ratio"]
    np.testing.assert_allclose(loop["equivalent"][numbers], one["equivalent"][numbers], rtol=1e-9)


def test_a_measured_spectrum_stands_beside_the_mission(own):
    """Its counts per km, and its damage on the curve of the point with the ratio that is given."""
    path = write(
        own, "measured.csv", "weld,order,surface,range_MPa,count,bending_ratio\nA,1,top,100,20,0.4\nA,1,top,150,5,0.4\n"
    )
    summary = spectra(own / "result", compare=path, compare_km=50.0, threads=1)
    rows = pd.read_parquet(own / "result" / "equivalent.parquet").set_index(["weld", "event"])
    row = rows.loc[("A", "(measured)")]
    law = damage_law(catalogue()["master-aluminium"], "mean-2sigma", "none", 1e7)
    dS = np.array([100.0, 150.0]) * THICKNESS ** (1.6 / 7.2) / ratio_factor(0.4)
    assert row["damage_per_km"] == pytest.approx(np.array([0.4, 0.1]) @ cycle_damage(dS, law), rel=1e-12)
    assert (row["cycles_per_km"], row["max_range_MPa"], row["bending_ratio"]) == (0.5, 150.0, pytest.approx(0.4))
    assert ("B", "(measured)") not in rows.index
    assert [problem.code for problem in summary.warnings] == ["measured_point"]
    assert "says nothing of 1 of the 2 points" in summary.warnings[0].what
    spectrum = pd.read_parquet(own / "result" / "spectrum.parquet")
    assert spectrum["upper_MPa"].max() == 150.0
    listed = spectrum.query("event == '(measured)'")
    assert listed["count_per_km"].sum() == pytest.approx(0.5)
    assert listed["exceedance_per_1e6_km"].iloc[0] == pytest.approx(0.5e6)
    record = read_provenance(own / "result")["load_spectra"]
    assert record["files"]["compare"]["file"] == "measured.csv"
    assert record["compare_km"] == 50.0


def test_the_cycles_of_the_mission_measured_do_what_the_mission_does(own):
    """A point's own cycles given back as measured: the same power sums, the same damage but for the one ratio."""
    cycles = pd.read_parquet(own / "result" / "cycles.parquet").query("weld == 'A' and event == 'sine'")
    path = own / "measured.csv"
    cycles[["range_MPa", "count", "bending_ratio"]].to_csv(path, index=False, float_format="%.17g")
    points = write(own, "points.csv", "weld,order,surface\nA,1,top\n")
    spectra(own / "result", points=points, compare=path, compare_km=0.6 / 0.75, threads=1)
    rows = pd.read_parquet(own / "result" / "equivalent.parquet").set_index("event")
    for column in ("power_sum_per_km", "cycles_per_km", "damage_per_km", "equivalent_range_2e6_MPa", "bending_ratio"):
        assert rows.loc["(measured)", column] == pytest.approx(rows.loc["sine", column], rel=1e-12), column


@pytest.mark.parametrize(
    ("text", "codes"),
    [
        ("range_MPa,count\n100,5\n", ["measured_point", "measured_ratio"]),
        ("range_MPa,count,bending_ratio\n100000,5,0\n", ["measured_point", "measured_unit"]),
        ("range_MPa,count,bending_ratio\n0.1,5,0\n", ["measured_point", "measured_unit"]),
        ("range_MPa,count,bending_ratio,place\n100,5,0,x\n", ["unknown_column", "measured_point"]),
    ],
)
def test_doubts_about_a_measured_spectrum_are_told_once(own, text, codes):
    """Where it was measured, its ratio, its unit."""
    summary = spectra(own / "result", compare=write(own, "m.csv", text), compare_km=1.0, threads=1)
    assert [problem.code for problem in summary.warnings] == codes
    assert read_provenance(own / "result")["load_spectra"]["warnings"][0]["code"] == codes[0]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("range_MPa,count\n-5,1\n", "-5 is below 0"),
        ("range_MPa,count\n5,-1\n", "-1 is below 0"),
        ("range_MPa,count\n5,\n", "missing or NaN"),
        ("range_MPa,count,bending_ratio\n5,1,1.2\n", "ratio is above 1"),
        ("range_MPa,count\n", "no rows"),
        ("range_MPa\n5\n", "count"),
        ("weld,order,surface,range_MPa,count\nA,2,top,5,1\n", "none of its points is among those chosen"),
        ("weld,order,surface,range_MPa,count\nX,2,top,5,1\n", "there is no point weld 'X'"),
    ],
)
def test_measured_spectra_that_make_no_sense(own, text, words):
    """One line with file, column, row and value."""
    with pytest.raises(DataError, match=words):
        spectra(own / "result", compare=write(own, "m.csv", text), compare_km=1.0)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"classes": 0}, "classes: 0 is no number of classes"),
        ({"classes": 1000}, "Give 1 to 256"),
        ({"exponents": []}, "are no exponents"),
        ({"exponents": [3.0, -1.0]}, "are no exponents"),
        ({"compare": "m.csv"}, "what distance"),
        ({"compare_km": 3.0}, "nothing to compare"),
        ({"compare": "m.csv", "compare_km": -3.0}, "-3.0 km is no distance"),
        ({"threads": 0}, "no number of threads"),
    ],
)
def test_senseless_arguments_are_refused(tmp_path, options, words):
    """Before anything is read."""
    with pytest.raises(CaseError, match=words):
        spectra(tmp_path, **options)


def test_inputs_that_changed_are_refused(own):
    """The cycles would be those of another case."""
    path = own / "case" / "sine.csv"
    path.write_text(path.read_text().replace("0.0,", "0.1,", 1))
    with pytest.raises(DataError, match="has changed since the assessment"):
        spectra(own / "result")


def test_an_unfinished_folder_and_a_damaged_table_are_refused(own):
    """No finished result there, or not as it was written."""
    with pytest.raises(DataError, match="no finished result"):
        spectra(own)
    path = own / "result" / "nodes.parquet"
    path.write_bytes(path.read_bytes()[:-10])
    with pytest.raises(DataError, match="was changed since it was written"):
        spectra(own / "result")
