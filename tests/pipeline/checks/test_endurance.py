"""Endurance between static load cases at weld toes: the worked case, and what each row says."""

import numpy as np
import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.pipeline.checks.endurance import weld_endurance
from fatigue.pipeline.solve.model import read_model
from fatigue.results import read_table
from tests.compared_case import CASES, LINES, MODES, write_case

FILES = '[checks]\nstatic_cases = "cases.csv"\nendurance_lines = "lines.csv"\n'


def check(cases="ride", **keys):
    """Table of an endurance check."""
    lines = [f"{key} = {value!r}".replace("'", '"') for key, value in keys.items()]
    return "\n".join(["[[checks.endurance]]", f'cases = "{cases}"', *lines, ""])


def rows_of(folder, *checks, order=2, **files):
    """Rows of some checks at the middle node."""
    path = write_case(folder, FILES + "".join(checks), **files)
    rows = weld_endurance(read_model(path))
    return rows[rows["order"] == order]


def row(rows, component, surface="top"):
    """The one row of a component on a surface."""
    (found,) = rows[(rows["component"] == component) & (rows["surface"] == surface)]
    return found


def states(surface="top"):
    """Stress across the weld and shear of the three states, by hand."""
    p = 1.0 if surface == "top" else -1.0
    per_unit = np.array([(m + p * b, s + p * t) for m, b, s, t, _ in MODES.values()])
    return np.array([(0, 0, 1), (1, 0.5, 1), (-2, 1, 1)]) @ per_unit


def test_the_worked_case(tmp_path):
    """Two alternating loads about a static one: range, R, allowed amplitude and utilisation across the weld."""
    rows = rows_of(tmp_path, check(perp="across", shear="sheared"))
    found = row(rows, "perp")
    np.testing.assert_allclose(found["range_max_MPa"], 70.8, rtol=1e-10)
    np.testing.assert_allclose(found["R"], -0.661971830986, rtol=1e-10)
    np.testing.assert_allclose(found["amplitude_MPa"], 35.4, rtol=1e-10)
    np.testing.assert_allclose(found["allowed_amplitude_MPa"], 56.5495207668, rtol=1e-9)
    np.testing.assert_allclose(found["utilisation_stress"], 0.626, rtol=1e-9)
    np.testing.assert_allclose(found["plane_range_MPa"], 98.575453334, rtol=1e-9)
    assert found["governing_event"] == "+pitch +roll / -pitch -roll"
    assert found["fulfilled"] == 1
    assert np.isnan(found["damage_per_km"])


def test_each_component_has_its_own_corners(tmp_path):
    """On the bottom the loads add up otherwise for shear than across, and a combination takes one pair of corners."""
    rows = rows_of(tmp_path, check(perp="across", shear="sheared", limit=1.0))
    perp, shear, both = (row(rows, one, "bottom") for one in ("perp", "shear", "combination"))
    assert perp["governing_event"] == "+pitch -roll / -pitch +roll"
    assert shear["governing_event"] == "+pitch +roll / -pitch -roll"
    assert both["value"] < perp["utilisation_stress"] ** 2 + shear["utilisation_stress"] ** 2
    assert both["value"] >= max(perp["utilisation_stress"], shear["utilisation_stress"]) ** 2
    np.testing.assert_allclose(both["utilisation_stress"], np.sqrt(both["value"]))
    assert "without the stress along the weld" in both["note"]
    assert both["curve"] == "across + sheared"


def test_states_are_compared_in_all_pairs(tmp_path):
    """Of three states the farthest two decide, with the R of these two."""
    rows = rows_of(tmp_path, check("stops", perp="across", shear="sheared"))
    for surface in ("top", "bottom"):
        normal, shear = states(surface).T
        found = row(rows, "perp", surface)
        np.testing.assert_allclose(found["range_max_MPa"], normal.max() - normal.min())
        np.testing.assert_allclose(found["R"], normal.min() / normal.max())
        np.testing.assert_allclose(row(rows, "shear", surface)["range_max_MPa"], shear.max() - shear.min())
        in_plane = np.stack([normal, np.sqrt(3.0) * shear], axis=-1)
        farthest = max(np.linalg.norm(a - b) for a in in_plane for b in in_plane)
        np.testing.assert_allclose(found["plane_range_MPa"], farthest)
    assert row(rows, "perp")["governing_event"] == "full / braking"


def test_the_static_load_is_in_the_stress_ratio(tmp_path):
    """Without it the mean is 0, and the same range is allowed more."""
    with_it = row(rows_of(tmp_path / "a", check(perp="across")), "perp")
    without = CASES.replace("dead,static,ride,1,,,1\n", "")
    bare = row(rows_of(tmp_path / "b", check(perp="across"), cases=without), "perp")
    assert with_it["range_max_MPa"] == pytest.approx(bare["range_max_MPa"])
    assert bare["R"] == pytest.approx(-1.0)
    assert bare["allowed_amplitude_MPa"] == pytest.approx(60.0)
    assert bare["utilisation_stress"] < with_it["utilisation_stress"]


def test_a_cycle_above_the_table_is_not_assessed(tmp_path):
    """Beyond the last row of the line there is no verdict, and the note says why and how much it is at most."""
    cases = "case,kind,group,q_1\nmean,static,ride,3\nsmall,alternating,ride,0.3\n"
    found = row(rows_of(tmp_path, check(perp="across"), cases=cases), "perp")
    assert found["fulfilled"] == -1
    assert np.isnan(found["utilisation_stress"])
    assert np.isnan(found["allowed_amplitude_MPa"])
    assert (
        found["note"] == f"outside table: R is above that of the last row; u is at most {16.5 * 3.3 / 126.31578947:.4g}"
    )


def test_what_does_not_alternate_at_a_point_passes(tmp_path):
    """Loads that make no stress of a component leave it at rest."""
    cases = "case,kind,group,q_1,q_3\none,state,stops,0,1\nother,state,stops,0,1\n"
    found = row(rows_of(tmp_path, check("stops", perp="across"), cases=cases), "perp")
    assert (found["utilisation_stress"], found["fulfilled"], found["amplitude_MPa"]) == (0.0, 1, 0.0)
    assert np.isnan(found["allowed_amplitude_MPa"])


@pytest.mark.parametrize(
    ("curve", "endured", "said"),
    [
        ("knee-36", 36.0 * 0.40471316447, "cut-off"),  # 3 to 5e6, 5 to 1e8
        ("bend-36", 36.0 * 0.584803547643, "last knee"),  # 3 to 1e7, 5 on
    ],
)
def test_the_range_that_a_curve_endures(tmp_path, curve, endured, said):
    """The range of the worst pair over the cut-off of a curve, or over its last knee where it has none."""
    bend = "\n[curves.bend-36]\nslopes = [3.0, 5.0]\nknees_cycles = [1e7]\nrange_at_2e6_MPa = 36.0\n"
    bend += 'applies = "structural"\nsource = "invented"\n'
    only = '[checks]\nstatic_cases = "cases.csv"\n'
    path = write_case(tmp_path, bend + only + check(curve=curve))
    rows = weld_endurance(read_model(path))
    found = row(rows[rows["order"] == 2], "perp")
    np.testing.assert_allclose(found["utilisation_stress"], 70.8 / endured, rtol=1e-9)
    assert said in found["note"]
    assert found["fulfilled"] == 0


def test_a_curve_of_shear_is_for_the_shear(tmp_path):
    """Its cut-off is compared with the range of shear."""
    only = '[checks]\nstatic_cases = "cases.csv"\n'
    path = write_case(tmp_path, only + check(curve="shear-28"))
    rows = weld_endurance(read_model(path))
    found = row(rows[rows["order"] == 2], "shear")
    np.testing.assert_allclose(found["utilisation_stress"], 39.6 / (28.0 * 0.457305051927), rtol=1e-9)


def test_factors_on_cases_and_amounts(tmp_path):
    """A factor of -1 turns an alternating case round and changes nothing but its name's sign."""
    turned = CASES.replace("roll,alternating,ride,2,", "roll,alternating,ride,-2,")
    before = rows_of(tmp_path / "a", check(perp="across", shear="sheared", limit=1.0))
    after = rows_of(tmp_path / "b", check(perp="across", shear="sheared", limit=1.0), cases=turned)
    for name in ("range_max_MPa", "R", "utilisation_stress", "value", "plane_range_MPa"):
        np.testing.assert_allclose(after[name], before[name], err_msg=name)
    assert row(after, "perp")["governing_event"] == "+pitch -roll / -pitch +roll"


def test_what_a_reader_finds_in_the_table(tmp_path):
    """Rows stand in the table with the edition of their line; nothing of the assessment changes by them."""
    path = write_case(tmp_path, FILES + check(perp="across", shear="sheared", limit=1.0))
    assess(path, tmp_path / "out", threads=1, report=False)
    table = read_table(tmp_path / "out", "checks").to_pandas()
    assert set(table.check) == {"endurance"}
    assert len(table) == 3 * 2 * 3
    assert set(table.edition) == {"invented"}
    assert set(table.curve_status) == {"user"}
    assert table.life_km.isna().all()
    assert table.damage_sum.isna().all()
    bare = write_case(tmp_path / "bare")
    assess(bare, tmp_path / "bare_out", threads=1, report=False)
    one, other = (read_table(folder, "nodes") for folder in (tmp_path / "out", tmp_path / "bare_out"))
    assert one.equals(other)
    assert not (tmp_path / "bare_out" / "checks.parquet").exists()


def test_a_toe_on_one_face_has_rows_on_that_face(tmp_path):
    """A face without a toe is not checked."""
    path = write_case(tmp_path, FILES + check(perp="across"))
    (tmp_path / "welds.csv").write_text("weld,surface\nW,bottom\n", encoding="utf-8")
    assert set(weld_endurance(read_model(path))["surface"]) == {"bottom"}


def test_lines_that_no_weld_is_checked_by_cost_nothing(tmp_path):
    """Lines and groups beyond those of the checks may be in the files."""
    path = write_case(tmp_path, FILES + check(perp="across"), lines=LINES + "other,par,-1,5,e,c\nother,par,0,6,e,c\n")
    assert load_case(path)
    assert len(weld_endurance(read_model(path))) == 6


def test_partial_factors_and_the_stress_ratio_are_in_the_design_range(tmp_path):
    """Gamma multiplies the range; f(R) of low residual stress divides it, with the static load in R."""
    of_curve = "\n[curves.low-36]\nslopes = [3.0, 5.0]\nknees_cycles = [1e7]\nrange_at_2e6_MPa = 36.0\n"
    of_curve += 'applies = "structural"\nsource = "invented"\ngamma_Ff = 1.1\nmean_stress = "iiw_low"\n'
    only = '[checks]\nstatic_cases = "cases.csv"\n'
    path = write_case(tmp_path, of_curve + only + check(curve="low-36"))
    rows = weld_endurance(read_model(path))
    found = row(rows[rows["order"] == 2], "perp")
    f = 1.2 + 0.4 * 0.661971830986
    np.testing.assert_allclose(found["utilisation_stress"], 1.1 * 70.8 / f / (36.0 * 0.584803547643), rtol=1e-9)
