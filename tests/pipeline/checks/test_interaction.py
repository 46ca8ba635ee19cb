"""Damage sums of normal stress and of shear at a toe, combined by the rules of the codes."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.pipeline.checks.interaction import weld_interaction
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.run.work import ScreeningOptions, open_work
from fatigue.pipeline.solve.body import read_body
from fatigue.pipeline.solve.weld_groups import one_group
from fatigue.results import read_table
from tests.compared_case import compared_case

RULES = """
[[checks.interaction]]
rule = "en1993"

[[checks.interaction]]
rule = "iiw"
cv = 0.5
damage_limit = 0.5

[[checks.interaction]]
rule = "en1999"
damage_limit = 0.5
"""


def opened(folder, case, share=0.0):
    """The work of a case, its model and its result."""
    body = read_body(load_case(case.write(folder)), strict=False)
    plan, _ = mission_plan(body)
    work = open_work(one_group(body, folder), plan, ScreeningOptions(share, proves_worst=False), folder, threads=1)
    return work, *work.group(0)


def rows_of(work, model, result, plan=None):
    """Rows of all interactions by rule, those of the middle node on top and bottom."""
    rows = weld_interaction(model, result, work.loads, plan or work.plan)
    return {rule: rows[(rows["component"] == rule) & (rows["order"] == 2)] for rule in ("en1993", "iiw", "en1999")}


@pytest.fixture(scope="module")
def counted(tmp_path_factory):
    """The worked case, counted."""
    return opened(tmp_path_factory.mktemp("interaction"), compared_case(RULES))


def test_the_worked_case(counted):
    """Damage sums, utilisations and both kinds of sums, on top."""
    rows = rows_of(*counted)
    en1993, iiw, en1999 = (rows[rule][0] for rule in ("en1993", "iiw", "en1999"))
    np.testing.assert_allclose(en1993["normal_part"], 0.495172456504, rtol=1e-8)
    np.testing.assert_allclose(en1993["shear_part"], 0.0212113061893, rtol=1e-8)
    np.testing.assert_allclose(en1993["value"], 0.516383762694, rtol=1e-8)
    np.testing.assert_allclose(np.sqrt(iiw["normal_part"]), 0.996771223894, rtol=1e-8)
    np.testing.assert_allclose(np.sqrt(iiw["shear_part"]), 0.532279184031, rtol=1e-8)
    np.testing.assert_allclose(iiw["value"], 1.27687400254, rtol=1e-8)
    assert (en1993["limit_value"], iiw["limit_value"], en1999["limit_value"]) == (1.0, 0.5, 0.5)
    assert (en1993["fulfilled"], iiw["fulfilled"], en1999["fulfilled"]) == (1, 0, 0)
    assert en1993["surface"] == "top"
    assert en1993["governing_event"] == "track"
    assert en1993["curve"] == "fillet-36 + shear-28"


def test_the_comparison_value_matters(counted, tmp_path):
    """The same squares meet 1.5 and not 1: they are compared as they are, not as damage sums."""
    both = "".join(f'\n[[checks.interaction]]\nrule = "iiw"\ncv = {cv}\ndamage_limit = 0.5\n' for cv in (1.0, 1.5))
    work, model, result = opened(tmp_path, compared_case(both))
    rows = rows_of(work, model, result)["iiw"]
    top = rows[rows["surface"] == "top"]
    assert top["fulfilled"].tolist() == [0, 1]
    np.testing.assert_allclose(top["utilisation_stress"] ** 2 * top["limit_value"], top["value"])


def test_a_limit_is_in_the_utilisation_once(counted):
    """U is 1 / the factor up to which the damage sum stays within the limit, and its square is not divided again."""
    rows = rows_of(*counted)
    straight = rows["en1993"]["normal_part"] / 0.5
    np.testing.assert_allclose(rows["iiw"]["normal_part"], straight ** (2.0 / 3.0), rtol=1e-8)


def test_the_limit_of_the_mission_has_no_part_in_it(tmp_path, counted):
    """A rule has its own limit, and the mission another one."""
    case = compared_case(RULES)
    case.mission["damage_limit"] = 0.25
    before, after = rows_of(*counted), rows_of(*opened(tmp_path, case))
    for rule in before:
        for name in ("value", "normal_part", "shear_part", "utilisation_stress", "limit_value", "damage_limit"):
            np.testing.assert_allclose(after[rule][name], before[rule][name], rtol=1e-9)


def with_stress_times(case, factor):
    """The case with all stresses times a factor."""
    case.events = [event | {"stress_factor": factor} for event in case.events]
    return case


@pytest.mark.parametrize("normal", ["fillet-36", "knee-36"])
def test_the_factor_on_all_stresses_meets_the_target(tmp_path, normal):
    """With all stresses times 1 / utilisation a rule is met; on one slope each, exactly."""
    one = rows_of(*opened(tmp_path / "one", compared_case(RULES, normal)))
    for rule in ("en1993", "iiw", "en1999"):
        u = float(one[rule]["utilisation_stress"][0])
        just = rows_of(*opened(tmp_path / rule, with_stress_times(compared_case(RULES, normal), (1 - 1e-6) / u)))[rule]
        assert just["fulfilled"][0] == 1
        assert just["utilisation_stress"][0] <= 1.0
        if rule == "iiw":
            np.testing.assert_allclose(just["value"][0], just["limit_value"][0], rtol=1e-3)


def test_verdict_and_utilisation_agree(tmp_path):
    """The stress utilisation is above 1 exactly where a rule is not met, cut-offs and knees included."""
    for number, factor in enumerate((0.6, 0.9, 1.0, 1.05, 1.4, 2.0)):
        case = with_stress_times(compared_case(RULES, "knee-36"), factor)
        for rows in rows_of(*opened(tmp_path / str(number), case)).values():
            assert ((rows["utilisation_stress"] > 1.0) == (rows["fulfilled"] == 0)).all()


@pytest.mark.parametrize("normal", ["fillet-36", "knee-36"])
def test_screened_points_are_counted_again(tmp_path, normal):
    """Where bounds stood for counting at the toe, the damage sums are those of the count."""
    case = compared_case(RULES, normal)
    case.mission["target_km"] = 15.0
    before = rows_of(*opened(tmp_path / "counted", case))
    work, model, result = opened(tmp_path / "screened", case, share=1.0)
    assert result.tier.any()
    for rule, rows in rows_of(work, model, result).items():
        for name in ("value", "normal_part", "shear_part", "utilisation_stress"):
            np.testing.assert_allclose(rows[name], before[rule][name], rtol=1e-9, err_msg=f"{rule} {name}")


def test_shear_keeps_its_sign(counted):
    """The range of a shear that changes its sign is its whole way, not that of its magnitude."""
    work, model, result = counted
    stress = model.stations.treated
    tau = stress.in_plane_shear[1] + stress.twist_shear[1]
    (load,) = (load for load in work.loads if load.counted.event == "track")
    history = tau @ load.counted.q
    reach = history.max() - history.min()
    assert reach > np.abs(history).max() - np.abs(history).min()
    damage = 150_000 * (reach / 28.0) ** 5 / 2e6  # of its one range above the cut-off
    np.testing.assert_allclose(rows_of(work, model, result)["en1993"]["shear_part"][0], damage, rtol=1e-8)


def test_only_the_welds_it_names(tmp_path):
    """A weld without a shear curve has no row, and a list of welds leaves the others out."""
    case = compared_case('\n[[checks.interaction]]\nrule = "en1993"\nwelds = ["V"]\n')
    case.welds = case.welds.loc[[0, 0, 0]].assign(weld=["W", "V", "U"], curve_shear=["shear-28", "shear-28", None])
    moved = [case.weld_nodes.assign(weld=w, node=case.weld_nodes.node + 100 * i) for i, w in enumerate("WVU")]
    forces = [case.nodal_forces.assign(weld=w, node=case.nodal_forces.node + 100 * i) for i, w in enumerate("WVU")]
    for i, nodes in enumerate(moved):
        nodes["y_mm"] = 500.0 * i
    case.weld_nodes, case.nodal_forces = _joined(moved, forces)
    work, model, result = opened(tmp_path / "some", case)
    assert set(weld_interaction(model, result, work.loads, work.plan)["weld"]) == {"V"}
    case.extra = case.extra.replace('welds = ["V"]\n', "")
    work, model, result = opened(tmp_path / "all", case)
    assert set(weld_interaction(model, result, work.loads, work.plan)["weld"]) == {"V", "W"}


def _joined(*tables):
    return [pd.concat(some, ignore_index=True) for some in tables]


def test_what_a_reader_finds_in_the_table(tmp_path):
    """Status, edition and life follow from the curves and the sums; only rules of damage sums have a life."""
    path = compared_case(RULES).write(tmp_path)
    assess(path, tmp_path / "out", threads=1, report=False)
    table = read_table(tmp_path / "out", "checks").to_pandas()
    top = table[(table.order == 2) & (table.surface == "top")].set_index("component")
    assert set(top.check) == {"interaction"}
    assert set(top.curve_status) == {"user"}
    np.testing.assert_allclose(top.life_km["en1993"], 1500.0 / 0.516383762694, rtol=1e-8)
    np.testing.assert_allclose(top.life_km["en1999"], 750.0 / 0.516383762694, rtol=1e-8)
    assert np.isnan(top.life_km["iiw"])
    assert np.isnan(top.damage_sum["iiw"])


def test_a_plan_of_another_target_scales_the_sums(counted):
    """Damage sums are those at target_km."""
    work, model, result = counted
    twice = rows_of(work, model, result, replace(work.plan, target_km=3000.0))
    np.testing.assert_allclose(twice["en1993"]["value"], 2.0 * rows_of(*counted)["en1993"]["value"])


def test_a_named_method_of_shear_is_not_counted_twice(tmp_path, counted):
    """Where the assessment has shear in its damage, the normal stress is counted by itself for the rule."""
    case = compared_case('[multiaxial]\nmethod = "range"\n' + RULES)
    work, model, result = opened(tmp_path, case)
    assert (result.mission.damage_per_km[1] > counted[2].mission.damage_per_km[1]).any()
    before = rows_of(*counted)
    for rule, rows in rows_of(work, model, result).items():
        for name in ("value", "normal_part", "shear_part", "utilisation_stress"):
            np.testing.assert_allclose(rows[name], before[rule][name], rtol=1e-9, err_msg=f"{rule} {name}")


def test_partial_factors_are_on_the_ranges(tmp_path, counted):
    """Factors of 1.1 and 1.2 on the ranges are 1.1^3 and 1.2^5 in the damage, cut-off aside."""
    case = compared_case(RULES)
    for curve, key in (("fillet-36", "gamma_Ff = 1.1"), ("shear-28", "gamma_Mf = 1.2")):
        case.extra = case.extra.replace(f"[curves.{curve}]", f"[curves.{curve}]\n{key}")
    after, before = rows_of(*opened(tmp_path, case))["en1993"], rows_of(*counted)["en1993"]
    np.testing.assert_allclose(after["normal_part"], 1.1**3 * before["normal_part"], rtol=1e-9)
    np.testing.assert_allclose(after["shear_part"][0], 1.2**5 * before["shear_part"][0], rtol=1e-9)


def test_the_limit_of_a_curve_is_not_that_of_a_rule(tmp_path, counted):
    """A damage limit of a curve is for its own sum; a rule has its own."""
    case = compared_case(RULES)
    case.extra = case.extra.replace("[curves.fillet-36]", "[curves.fillet-36]\ndamage_limit = 0.3")
    after, before = rows_of(*opened(tmp_path, case)), rows_of(*counted)
    for rule in before:
        for name in ("value", "utilisation_stress", "limit_value"):
            np.testing.assert_allclose(after[rule][name], before[rule][name], rtol=1e-9, err_msg=f"{rule} {name}")
