"""What a what-if gives no number of, what it counts again, bounds of points without ranges, and another case file."""

import numpy as np
import pandas as pd
import pytest

from fatigue.decide.whatif.story import whatif
from fatigue.errors import CaseError, DataError
from tests.decide.whatif.reruns import (
    Mutation,
    base_case,
    changed,
    curve,
    event,
    extra,
    inside,
    load,
    mission,
    nodes_of,
    run,
)
from tests.small_case import SmallCase


def counting(**keys: object) -> Mutation:
    """Keys of the table of counting."""

    def mutate(case: SmallCase) -> SmallCase:
        case.counting = case.counting | keys
        return case

    return mutate


@pytest.fixture(scope="module")
def straight(tmp_path_factory):
    """A result on a straight curve, with ranges of the points that decide only."""
    return run(base_case("straight"), tmp_path_factory.mktemp("straight"), histogram="worst")


@pytest.fixture(scope="module")
def joined(tmp_path_factory):
    """The same with a sequence."""
    return run(base_case("straight", sequence=True), tmp_path_factory.mktemp("joined"))


RECOUNTED = {
    "start_s": (["mission.event.noise.start_s=2.0"], event("noise", start_s=2.0)),
    "residue": (["counting.residue=half"], counting(residue="half")),
    "upsample": (["counting.upsample=4"], counting(upsample=4)),
    "mean stress": (
        ["curve.mean_stress=asme", "curve.yield_MPa=40"],
        curve(mean_stress="asme", yield_MPa=40.0),
    ),
    "by share instead of by number": (
        [
            'mission.event."load and unload".per_1000_km=3',
            'mission.event."load and unload".residue=repeat',
            "load=1.2",
        ],
        lambda case: load(1.2)(event("load and unload", per_1000_km=3, residue="repeat")(case)),
    ),
}


@pytest.mark.parametrize(("settings", "mutate"), RECOUNTED.values(), ids=RECOUNTED)
def test_what_nothing_stored_tells_has_no_number_until_it_is_counted(straight, tmp_path, settings, mutate):
    """All points are recount and without numbers, all verdicts not proven; counted again they are those of a rerun."""
    found = whatif(straight, settings)
    assert found.points["basis"].eq("recount").all()
    assert found.points[["damage_per_km", "life_km", "life_km_low", "utilisation", "load_factor"]].isna().all(axis=None)
    assert found.welds["verdict"].eq("not_proven").all()
    assert found.reasons
    again = nodes_of(run(changed(base_case("straight"), mutate), tmp_path, histogram="none"))
    counted = whatif(straight, settings, recount="all")
    toe = counted.points["toe"].to_numpy()
    assert counted.points["basis"][toe].eq("counted").all()
    np.testing.assert_allclose(counted.points["damage_per_km"][toe], again["damage_per_km"][toe], rtol=1e-9)
    np.testing.assert_allclose(counted.points["life_km"][toe], again["life_km"][toe], rtol=1e-9)
    assert counted.welds["verdict"].ne("not_proven").all()
    after = again[again["toe"]].groupby("weld")["utilisation"].max()
    found_worst = counted.welds.set_index("weld")["utilisation"]
    np.testing.assert_allclose(found_worst[after.index], after, rtol=1e-9)


def test_the_worst_of_each_weld_alone_proves_a_miss_and_no_more(straight):
    """One point of each weld is counted; a weld whose point misses is proven, the others stay open."""
    found = whatif(straight, ["counting.residue=half"], recount="worst")
    assert found.points.groupby("weld", observed=True)["basis"].apply(lambda b: b.eq("counted").sum()).eq(1).all()
    worst = found.welds.set_index("weld")
    assert worst.loc[worst["utilisation"] > 1.0, "verdict"].eq("misses").all()
    assert worst.loc[worst["utilisation"] <= 1.0, "verdict"].eq("not_proven").all()
    assert worst["life_km_low"].isna().all()
    assert worst["points_to_recount"].gt(0).all()


def test_load_under_mean_stress_is_counted_again(tmp_path):
    """The conditions of f_M do not scale, so a load gives no number; a survival level does."""
    case = base_case("straight")
    case.curve |= {"mean_stress": "asme", "yield_MPa": 40.0}
    result = run(case, tmp_path / "base")
    found = whatif(result, ["load=1.1"])
    assert found.points["basis"].eq("recount").all()
    assert "do not scale" in found.reasons[0]
    again = nodes_of(run(changed(case, load(1.1)), tmp_path / "again"))
    counted = whatif(result, ["load=1.1"], recount="all")
    toe = counted.points["toe"].to_numpy()
    np.testing.assert_allclose(counted.points["damage_per_km"][toe], again["damage_per_km"][toe], rtol=1e-9)
    survival = whatif(result, ["curve.survival=mean"])
    again = nodes_of(run(changed(case, curve(survival="mean")), tmp_path / "survival"))
    assert survival.points["basis"].eq("exact").all()
    np.testing.assert_allclose(survival.points["damage_per_km"], again["damage_per_km"], rtol=1e-12)
    assert survival.points["load_factor"].isna().all()


def test_a_factor_on_one_event_of_a_sequence_is_counted_again(joined, tmp_path):
    """What closes across events is other then; the same factor on all of its events scales it."""
    settings = ["mission.event.noise.stress_factor=1.5"]
    found = whatif(joined, settings)
    assert found.points["basis"].eq("recount").all()
    assert "in a sequence" in found.reasons[0]
    base = base_case("straight", sequence=True)
    again = nodes_of(run(changed(base, load(1.5, ["noise"])), tmp_path / "one"))
    counted = whatif(joined, settings, recount="all").points
    toe = counted["toe"].to_numpy()
    np.testing.assert_allclose(counted["damage_per_km"][toe], again["damage_per_km"][toe], rtol=1e-9)
    both = whatif(joined, [f"mission.event.{name}.stress_factor=1.5" for name in ("sine", "noise")]).points
    again = nodes_of(run(changed(base, load(1.5, ["sine", "noise"])), tmp_path / "both"))
    assert both["basis"].eq("exact").all()
    np.testing.assert_allclose(both["damage_per_km"], again["damage_per_km"], rtol=1e-12)


def test_a_sequence_left_out_adds_nothing_and_a_new_one_is_counted(joined, straight, tmp_path):
    """Without it the events are alone; a sequence that was never counted has no number."""
    path = joined.parent / "case" / "case.toml"
    without = path.with_name("without.toml")
    text = path.read_text()
    without.write_text(text[: text.index("[[mission.sequence]]")])
    found = whatif(joined, case_file=without).points
    again = nodes_of(straight)
    assert found["basis"].eq("exact").all()
    np.testing.assert_allclose(found["damage_per_km"], again["damage_per_km"], rtol=1e-12)
    other = path.with_name("other.toml")
    other.write_text(text.replace('order = ["sine", "noise", "sine"]', 'order = ["noise", "sine"]'))
    found = whatif(joined, case_file=other)
    assert found.points["basis"].eq("recount").all()
    swapped = extra('order = ["sine", "noise", "sine"]', 'order = ["noise", "sine"]')
    again = nodes_of(run(changed(base_case("straight", sequence=True), swapped), tmp_path))
    counted = whatif(joined, case_file=other, recount="all").points
    toe = counted["toe"].to_numpy()
    np.testing.assert_allclose(counted["damage_per_km"][toe], again["damage_per_km"][toe], rtol=1e-9)


@pytest.mark.parametrize(
    ("name", "settings", "mutate"),
    [
        ("straight", ["curve.extension=haibach"], curve(extension="haibach")),
        ("straight", ["curve.extension=cutoff", "load=0.7"], lambda c: load(0.7)(curve(extension="cutoff")(c))),
        ("haibach", ["load=1.3"], load(1.3)),
        ("haibach", ["curve.survival=mean"], curve(survival="mean")),
        ("structural", ["load=0.8"], load(0.8)),
    ],
)
def test_points_without_ranges_lie_between_bounds(tmp_path, name, settings, mutate):
    """Of a curve with a knee a counted point without ranges has a band that holds what an assessment counts."""
    case = base_case(name)
    case.mission["target_km"] = 0.5  # all points but the worst are below a tenth of the limit
    result = run(case, tmp_path / "base", histogram="worst")
    found = whatif(result, settings).points
    again = nodes_of(run(changed(case, mutate), tmp_path / "again", histogram="none"))
    assert {"bound", "histogram"} <= set(found["basis"])
    truth = again["damage_per_km"].to_numpy()
    assert inside(found["damage_per_km_low"].to_numpy(), truth, found["damage_per_km_high"].to_numpy())
    bound = found["basis"].eq("bound")
    assert (found["damage_per_km"] == found["damage_per_km_high"])[bound].all()


@pytest.mark.parametrize(
    ("settings", "mutate"),
    [
        (["load=1.4"], load(1.4)),
        (["curve.survival=mean-3sigma"], curve(survival="mean-3sigma")),
        (["curve.extension=none"], curve(extension="none")),
        (["mission.sequence.2.per_1000_km=0.2", "curve.thickness_rule=asme"], None),
    ],
)
def test_loops_that_share_events_stay_between_bounds(tmp_path, settings, mutate):
    """Cycles across events that replace others, of events by share and by number, on a curve with a knee."""
    case = base_case("haibach", sequence=True)
    case.extra += '[[mission.sequence]]\norder = ["load and unload", "sine"]\nper_1000_km = 1.5\n'

    def fewer(case: SmallCase) -> SmallCase:
        return curve(thickness_rule="asme")(extra("per_1000_km = 1.5", "per_1000_km = 0.2")(case))

    result = run(case, tmp_path / "base")
    found = whatif(result, settings).points
    again = nodes_of(run(changed(case, mutate or fewer), tmp_path / "again", histogram="none"))
    truth = again["damage_per_km"].to_numpy()
    assert found["basis"].eq("histogram").all()
    assert inside(found["damage_per_km_low"].to_numpy(), truth, found["damage_per_km_high"].to_numpy())
    np.testing.assert_allclose(found["damage_per_km"], truth, rtol=2e-3)


def test_counted_points_on_a_curve_with_a_knee_have_no_load_factor(tmp_path):
    """Their ranges under the change are not stored; on a straight curve the factor follows from the utilisation."""
    result = run(base_case("haibach"), tmp_path)
    found = whatif(result, ["counting.residue=half"], recount="all").points
    counted = found["basis"].eq("counted")
    assert counted.any()
    assert found["load_factor"][counted].isna().all()


def test_a_large_result_has_the_load_factor_of_the_worst_point_of_each_weld(tmp_path, monkeypatch):
    """Beyond so many classes; damages, chunk by chunk, are those of a small one."""
    result = run(base_case("haibach"), tmp_path)
    small = whatif(result, ["load=1.3"])
    monkeypatch.setattr("fatigue.decide.whatif.margin.MOST_CLASSES", 10)
    monkeypatch.setattr("fatigue.life.bounds.histogram.AT_ONCE", 100)
    large = whatif(result, ["load=1.3"])
    known = large.points["load_factor"].notna()
    assert large.points[known]["weld"].tolist() == ["A", "B"]
    np.testing.assert_allclose(large.points["load_factor"][known], small.points["load_factor"][known], rtol=1e-9)
    for name in ("damage_per_km_low", "damage_per_km", "damage_per_km_high"):
        np.testing.assert_allclose(large.points[name], small.points[name], rtol=1e-12)


def screened(tmp_path, target_km: float):
    """A result whose points were settled by bounds, but for the worst of each weld."""
    case = base_case("straight")
    case.mission["target_km"] = target_km
    slope = np.linspace(1.0, 0.2, 7)
    scale = np.tile(np.repeat(slope, 3).reshape(7, 3).T.ravel(), 2)  # mode by mode along each line
    columns = ["fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"]
    case.nodal_forces[columns] = case.nodal_forces[columns].mul(scale, axis=0)
    return case, run(case, tmp_path / "base", share=0.1)


def test_screened_points_stay_bounds_until_they_reach_what_decides(tmp_path):
    """An exact knob keeps a bound one; where it reaches a tenth of the limit there is no number and no verdict."""
    case, result = screened(tmp_path, 20.0)
    nodes = nodes_of(result)
    is_screened = nodes["screened"].ne("").to_numpy()
    assert 0 < is_screened.sum() < len(nodes)
    found = whatif(result, ["mission.km_per_year=2e3", "mission.target_km=21.0"]).points
    assert found["basis"][is_screened].eq("bound").all()
    assert found["damage_per_km_low"][is_screened].eq(0.0).all()
    again = nodes_of(run(changed(case, mission(target_km=21.0)), tmp_path / "all", share=0.0))
    truth = again["damage_per_km"].to_numpy()
    assert inside(found["damage_per_km_low"].to_numpy(), truth, found["damage_per_km_high"].to_numpy(), 1e-9)
    far = whatif(result, ["mission.target_km=2000.0"])
    toe = (is_screened & nodes["toe"]).to_numpy()
    assert far.points["basis"][toe].eq("recount").any()
    left = far.welds[far.welds["points_to_recount"] > 0]
    assert (left["verdict"].eq("not_proven") | left["utilisation_low"].gt(1.0)).all()
    counted = whatif(result, ["mission.target_km=2000.0"], recount="all")
    rows = counted.points["basis"].eq("counted").to_numpy()
    assert rows.any()
    np.testing.assert_allclose(counted.points["damage_per_km"][rows], truth[rows], rtol=1e-9)
    knee = whatif(result, ["curve.extension=haibach"]).points
    again = nodes_of(run(changed(case, curve(extension="haibach")), tmp_path / "knee", share=0.0))
    known = knee["basis"].ne("recount").to_numpy()
    low, high = (knee[f"damage_per_km_{end}"].to_numpy()[known] for end in ("low", "high"))
    assert inside(low, again["damage_per_km"].to_numpy()[known], high, 1e-9)


def test_a_result_without_ranges_has_exact_knobs_only(tmp_path):
    """A knee asks for ranges; where there are none the command says how to have them."""
    result = run(base_case("straight"), tmp_path, histogram="none")
    assert whatif(result, ["load=1.1"]).points["basis"].eq("exact").all()
    with pytest.raises(DataError, match=r"no histogram of ranges.*--histogram worst or all"):
        whatif(result, ["curve.extension=haibach"])


def test_shear_that_decides_leaves_only_what_does_not_change_the_damage(tmp_path):
    """Another target is exact; a share is counted again, but not here."""
    case = base_case("straight")
    case.extra += '\n[multiaxial]\nmethod = "range"\n'
    result = run(case, tmp_path)
    assert whatif(result, ["mission.target_km=1e3"]).points["basis"].eq("exact").all()
    settings = ["mission.event.sine.share=0.5", "mission.event.noise.share=0.5"]
    found = whatif(result, settings).points
    assert found["basis"][found["toe"]].eq("recount").all()
    with pytest.raises(DataError, match="shear decides"):
        whatif(result, settings, recount="all")


def test_another_case_file_is_read_key_by_key(straight, tmp_path):
    """Whatever differs is a knob or is refused; files in another folder are the same by their content."""
    path = straight.parent / "case" / "case.toml"
    folder = tmp_path / "copy"
    folder.mkdir()
    for file in path.parent.glob("*"):
        (folder / file.name).write_bytes(file.read_bytes())
    text = path.read_text().replace("share = 0.75", "share = 0.25")
    text = text.replace("share = 0.25\nstart", "share = 0.75\nstart")
    (folder / "case.toml").write_text(text.replace('title = "small case"', 'title = "another"'))
    by_file = whatif(straight, case_file=folder / "case.toml")
    by_keys = whatif(straight, ["mission.event.sine.share=0.25", "mission.event.noise.share=0.75"])
    pd.testing.assert_frame_equal(by_file.points, by_keys.points)
    assert by_file.changes == by_keys.changes
    noise = pd.read_csv(folder / "noise.csv")
    noise.assign(q_1=2.0 * noise.q_1).to_csv(folder / "noise.csv", index=False)
    found = whatif(straight, case_file=folder / "case.toml")
    assert found.points["basis"].eq("recount").all()
    assert "mission.event.noise.history" in found.reasons[0]
    (folder / "case.toml").write_text(
        text
        + '\n[multiaxial]\nmethod = "off"\n[checks.stress_category]\nmedium_from = 0.7\nhigh_from = 0.9\nsource = "x"\n'
    )
    with pytest.raises(CaseError) as refused:
        whatif(straight, case_file=folder / "case.toml")
    assert {problem.code for problem in refused.value.problems} == {"no_knob"}
    names = " ".join(problem.where for problem in refused.value.problems)
    assert "multiaxial.method" in names
    assert "checks.stress_category.medium_from" in names


BAD = [
    (["mission.event.sine.share=0.9"], "sum to 1.15, not to 1"),
    (["mission.event.sime.share=0.9"], "no table of the name 'sime'.*Write 'sine'"),
    (["spectrum.segment_s=2.0"], "spectrum.segment_s: a change from 1 to 2 is no knob"),
    (["mission.targetkm=1.0"], "unknown key"),
    (["curve.survival=median"], "survival"),
    (["curve.name=steel"], "there is no curve 'steel'"),
    (["load=-1"], "no factor on stresses"),
    (["load"], "no setting KEY=VALUE"),
    (["mission.target_km=2000.0"], "value that the result was computed with"),
    ([], "nothing is asked"),
    (["mission.event.sine.stints_per_1000_km=5"], "stints_per_1000_km: a change from not given to 5 is no knob"),
    (["mission.event.sine.length_km=10"], "is not speed_km_h"),
]


@pytest.mark.parametrize(("settings", "words"), BAD)
def test_what_makes_no_sense_is_refused_by_name(straight, settings, words):
    """Shares that do not sum to 1, unknown events and keys, and keys that the result says nothing about."""
    with pytest.raises(CaseError, match=words):
        whatif(straight, settings)


def test_events_that_cannot_be_dropped(joined):
    """One that is not there, and one that a sequence needs."""
    with pytest.raises(CaseError, match=r"no event 'tunnel'.*It has 'sine', 'noise'"):
        whatif(joined, drop=["tunnel"])
    with pytest.raises(CaseError, match="is in a sequence"):
        whatif(joined, drop=["noise"])
    with pytest.raises(CaseError, match=r"it is passed .* times"):
        whatif(joined, ["mission.sequence.1.per_1000_km=1e6"])
    with pytest.raises(CaseError, match=r"has no table '2'.*Write 1"):
        whatif(joined, ["mission.sequence.2.per_1000_km=1"])


def test_a_new_event_and_a_changed_input_are_refused(straight, tmp_path):
    """Nothing of an event that was not there was counted; a file that has changed since is not counted again."""
    path = straight.parent / "case" / "case.toml"
    more = path.with_name("more.toml")
    more.write_text(path.read_text() + '[[mission.event]]\nname = "new"\nhistory = "load.csv"\nper_1000_km = 1.0\n')
    with pytest.raises(CaseError, match=r"mission.event 'new': is an event that the result does not have"):
        whatif(straight, case_file=more)
    result = run(base_case("straight"), tmp_path)
    (tmp_path / "case" / "noise.csv").write_text("time_s,q_1,q_2,q_7\n0,1,1,1\n1,2,2,2\n")
    with pytest.raises(DataError, match="has changed since the assessment"):
        whatif(result, ["counting.residue=half"], recount="all")
