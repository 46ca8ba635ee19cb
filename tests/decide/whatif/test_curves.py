"""Welds with curves of their own, strength factors, damage limits of curves and attachments, beside assessments."""

import numpy as np
import pandas as pd
import pytest

from fatigue.decide.whatif.story import whatif
from fatigue.errors import CaseError, DataError
from fatigue.results import read_provenance, write_provenance
from tests.decide.whatif.reruns import base_case, changed, curve, extra, inside, mission, nodes_of, run

FACTORS = """curve,factor,role,value,clause,edition
master-aluminium,gamma,strength,1.1,1,1
master-steel,gamma,strength,1.3,1,1
own,sum,limit,0.5,1,1
"""


@pytest.fixture
def two_curves():
    """Weld A has the curve of the case, weld B its own one in structural stress."""
    case = base_case("straight")
    case.welds = case.welds.assign(curve=["", "own"], attachment_mm=[6.0, 8.0])
    return case


def beside(case, mutate, settings, folder):
    """Points of a what-if, and damage and utilisation of the assessment of the changed case."""
    result = run(case, folder / "base")
    again = nodes_of(run(changed(case, mutate), folder / "again", histogram="none"))
    found = whatif(result, settings)
    truth = again["damage_per_km"].to_numpy()
    points = found.points
    assert inside(points["damage_per_km_low"].to_numpy(), truth, points["damage_per_km_high"].to_numpy())
    exact = points["basis"].eq("exact").to_numpy()
    np.testing.assert_allclose(points["utilisation"][exact], again["utilisation"][exact], rtol=1e-12)
    return points, again


def test_another_curve_of_the_case_is_that_of_the_welds_that_name_none(two_curves, tmp_path):
    """Weld B keeps its own curve and its damage; weld A gets the new one."""
    points, again = beside(two_curves, curve(name="master-steel"), ["curve.name=master-steel"], tmp_path)
    of_b = points["weld"].eq("B").to_numpy()
    assert points["basis"][of_b].eq("exact").all()
    assert points["basis"][~of_b].eq("histogram").all()
    np.testing.assert_allclose(points["damage_per_km"][~of_b], again["damage_per_km"][~of_b], rtol=1e-3)


def test_another_curve_needs_the_welds_as_they_were(two_curves, tmp_path):
    """Which welds name a curve is not stored; a table of welds that has changed since is refused."""
    result = run(two_curves, tmp_path)
    (tmp_path / "case" / "welds.csv").write_text("weld\nA\nB\n")
    with pytest.raises(DataError, match=r"welds\.csv.*has changed since the assessment"):
        whatif(result, ["curve.name=master-steel"])
    assert whatif(result, ["mission.target_km=1e3"]).points["basis"].eq("exact").all()


def test_survival_moves_every_curve_with_scatter(two_curves, tmp_path):
    """The straight one exactly, the one with a knee between its bounds."""
    points, _ = beside(two_curves, curve(survival="mean"), ["curve.survival=mean"], tmp_path)
    assert points["basis"][points["weld"] == "A"].eq("exact").all()
    assert points["basis"][points["weld"] == "B"].eq("histogram").all()


def test_strength_factors_go_with_their_curves(two_curves, tmp_path):
    """Factors of the table are on the range of the new curve as well, and on the damage limit."""
    for name in ("base", "again"):
        (tmp_path / name / "case").mkdir(parents=True)
        (tmp_path / name / "case" / "factors.csv").write_text(FACTORS)
    two_curves.extra += '\n[checks]\nstrength_factors = "factors.csv"\n'
    points, again = beside(two_curves, curve(name="master-steel"), ["curve.name=master-steel"], tmp_path)
    np.testing.assert_allclose(points["utilisation"], again["utilisation"], rtol=1e-3)


def test_damage_limit_of_a_curve_and_of_the_mission(two_curves, tmp_path):
    """A curve with a limit of its own keeps it when that of the mission changes."""
    two_curves.extra = two_curves.extra.replace("log10_scatter", "damage_limit = 0.7\nlog10_scatter")
    points, again = beside(two_curves, mission(damage_limit=0.5), ["mission.damage_limit=0.5"], tmp_path)
    np.testing.assert_allclose(points["life_km"], again["life_km"], rtol=1e-12)
    result = tmp_path / "base" / "result"
    found = whatif(result, ["curves.own.damage_limit=0.3"]).points
    again = nodes_of(
        run(changed(two_curves, extra("damage_limit = 0.7", "damage_limit = 0.3")), tmp_path / "own", histogram="none")
    )
    assert found["basis"].eq("exact").all()
    np.testing.assert_allclose(found["life_km"], again["life_km"], rtol=1e-12)


def test_thickness_by_half_the_attachment(two_curves, tmp_path):
    """The length of the attachment of each weld comes from the result."""
    keys = "thickness_reference_mm = 2.0\nthickness_exponent = 0.3\n"
    two_curves.extra = two_curves.extra.replace("log10_scatter", keys + "log10_scatter")
    half = extra("log10_scatter", 'thickness_effective = "L_half"\nlog10_scatter')
    points, again = beside(two_curves, half, ["curves.own.thickness_effective=L_half"], tmp_path)
    of_b = points["weld"].eq("B").to_numpy()
    assert points["basis"][of_b].eq("histogram").all()
    ratio = again["damage_per_km"][of_b] / nodes_of(tmp_path / "base" / "result")["damage_per_km"][of_b]
    assert (ratio < 0.9).all()
    np.testing.assert_allclose(points["damage_per_km"][of_b], again["damage_per_km"][of_b], rtol=2e-3)


def test_what_a_new_curve_asks_of_a_cycle_is_not_stored(two_curves, tmp_path):
    """The bending ratio has bounds, the stress ratio of a cycle has none."""
    result = run(two_curves, tmp_path)
    found = whatif(result, ["curves.own.mean_stress=iiw_low"]).points
    of_b = found["weld"].eq("B")
    assert found["basis"][of_b].eq("recount").all()
    assert found["basis"][~of_b].eq("exact").all()
    keys = ["curves.own.bending_factor=bs7608", "curves.own.bending_reference_mm=25", "curves.own.bending_exponent=0.2"]
    found = whatif(result, keys).points
    assert found["basis"][of_b].eq("histogram").all()
    assert (found["damage_per_km_low"] < found["damage_per_km_high"])[of_b & found["damage_per_km"].gt(0.0)].all()


def test_a_curve_without_a_place_for_what_is_asked_is_refused(two_curves, tmp_path):
    """An extension of a curve that has knees, f_M on structural stress: as in an assessment."""
    result = run(two_curves, tmp_path)
    with pytest.raises(CaseError, match="which has its own knee"):
        whatif(result, ["curve.extension=haibach"])
    with pytest.raises(CaseError, match="belongs to the master curve"):
        whatif(result, ["curve.mean_stress=asme", "curve.yield_MPa=200"])


def test_a_curve_that_is_another_one_by_now_is_refused(two_curves, tmp_path):
    """Constants of the program that differ from those on record say nothing about the result."""
    result = run(two_curves, tmp_path)
    record = read_provenance(result)
    record["curves"]["master-aluminium"]["used"]["log_constants"] = [27.9]
    write_provenance(result, record)
    with pytest.raises(DataError, match="'master-aluminium' of this version is another one"):
        whatif(result, ["load=1.1"])


def test_tables_are_read_by_key(two_curves, tmp_path):
    """Histogram rows find their point whatever its part, order and face; all have ranges with --histogram all."""
    result = run(two_curves, tmp_path)
    found = whatif(result, ["load=1.01", "curve.survival=mean-1sigma"]).points
    stored = pd.read_parquet(result / "nodes.parquet")
    for name in ("weld", "part", "node", "order", "surface"):
        assert found[name].astype(str).tolist() == stored[name].astype(str).tolist()
    assert not found["basis"].eq("bound").any()
