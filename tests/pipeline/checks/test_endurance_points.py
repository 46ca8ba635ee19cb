"""Endurance between static load cases at stress points, and at points whose stress is given as it is."""

import numpy as np
import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.errors import CaseError
from fatigue.life.endurance.haigh import endurance_line
from fatigue.life.endurance.pairs import worst_pairs
from fatigue.pipeline.checks.endurance import point_endurance
from fatigue.pipeline.solve.body import read_body
from fatigue.pipeline.solve.point_stress import point_stress
from fatigue.results import read_table
from tests.compared_case import CASES, LINES, compared_case
from tests.stress_point_case import curve_text, point, stresses, write_points

FILES = '[checks]\nstatic_cases = "cases.csv"\nendurance_lines = "lines.csv"\n'
TENSORS = {1: (17.01, 4.335, 3.335), 2: (-2.335, 5.335, 6.335), 3: (6.67, 1.0, 0.5)}
EDGE = {1: (20.0, 0.0, 0.0), 2: (5.0, 0.0, 0.0), 3: (1.0, 0.0, 0.0)}
AT_POINTS = """case,kind,group,point,sx_MPa,sy_MPa,txy_MPa
empty,state,stops,free,10,5,2
empty,state,stops,a,10,5,2
full,state,stops,free,-40,20,-12
full,state,stops,a,-40,20,-12
"""


def check(**keys):
    """Table of an endurance check at points."""
    lines = [f"{key} = {value!r}".replace("'", '"') for key, value in keys.items()]
    return "\n".join(["[[checks.endurance]]", *lines, ""])


def written(folder, *checks, cases=CASES):
    """The case file with a hot spot of two surfaces and one on an edge."""
    case = compared_case(curve_text("points", 90.0) + FILES + "".join(checks))
    points = [point("a", weld="W", thickness_mm=6.0), point("e", "hot_spot_b")]
    below = {mode: -np.array(tensor) for mode, tensor in TENSORS.items()}
    some = [
        stresses("a", TENSORS, (2.4, 6.0), ("top",)),
        stresses("a", below, (2.4, 6.0), ("bottom",)),
        stresses("e", EDGE, (5.0, 15.0), ("edge",)),
    ]
    path = write_points(case, folder, points, some)
    (folder / "cases.csv").write_text(cases, encoding="utf-8")
    (folder / "lines.csv").write_text(LINES, encoding="utf-8")
    return path


def rows_of(folder, *checks, cases=CASES):
    """Rows of endurance checks at the points."""
    body = read_body(load_case(written(folder, *checks, cases=cases)), strict=False)
    return point_endurance(body, point_stress(body)[0])


def test_all_three_components_at_a_hot_spot(tmp_path):
    """Stress across the weld, along it and shear, at both surfaces, and their combination at one pair of corners."""
    rows = rows_of(
        tmp_path,
        check(cases="ride", points=["a"], perp="across", par="along", shear="sheared", limit=1.1, kappa=[0.0, 1.0]),
    )
    assert rows["surface"].tolist() == ["top", "bottom"] * 4
    assert set(rows["point"]) == {"a"}
    assert set(rows["weld"]) == {"W"}
    per_unit = np.array([TENSORS[mode] for mode in (1, 2, 3)]) * 1.0  # the same at all distances: 1.67 - 0.67 = 1
    reach = 4.0 * np.abs(per_unit[:2]).sum(axis=0)
    top = rows[rows["surface"] == "top"]
    np.testing.assert_allclose(top["range_max_MPa"][:3], reach, rtol=1e-12)
    low, high = per_unit[2] - reach / 2, per_unit[2] + reach / 2
    np.testing.assert_allclose(top["R"][:3], low / high, rtol=1e-12)
    signs = np.array([(a, b) for a in (-2, 2) for b in (-2, 2)])
    states = per_unit[2] + signs @ per_unit[:2]
    lines = [
        endurance_line("a", "perp", np.array([-1, 0, 0.5]), np.array([60, 1200 / 13, 2400 / 19])),
        endurance_line("b", "par", np.array([-1.0, 0]), np.array([60, 1200 / 13])),
        endurance_line("c", "shear", np.array([-1, 0.5]), np.array([35.0, 70.0])),
    ]
    np.testing.assert_allclose(top["value"][3], worst_pairs(states[None], lines, [0.0, 1.0]).value[0], rtol=1e-9)
    assert top["limit_value"][3] == 1.1
    assert top["note"][3].startswith("u_perp ")
    assert "line forces" not in top["note"][3]


def test_states_turned_round_are_read_turned_round(tmp_path):
    """The bottom has the opposite stress: compression there is tension here, and shear is the same."""
    rows = rows_of(tmp_path, check(cases="stops", points=["a"], perp="across", shear="sheared"))
    perp, shear = rows[rows["component"] == "perp"], rows[rows["component"] == "shear"]
    np.testing.assert_allclose(perp["amplitude_MPa"][0], perp["amplitude_MPa"][1])
    assert perp["R"][0] == pytest.approx(1.0 / perp["R"][1])
    np.testing.assert_allclose(shear["utilisation_stress"][0], shear["utilisation_stress"][1])


def test_an_edge_has_stress_along_it_alone(tmp_path):
    """A line for it is compared; lines of other components are refused there."""
    rows = rows_of(tmp_path / "a", check(cases="ride", points=["e"], perp="across"))
    assert rows["surface"].tolist() == ["edge"]
    np.testing.assert_allclose(rows["range_max_MPa"], 4.0 * 25.0)
    path = written(tmp_path / "b", check(cases="ride", points=["a", "e"], perp="across", shear="sheared"))
    with pytest.raises(
        CaseError, match=r"endurance\[1\]\.points: 'e' is on the edge of a plate, which has stress along"
    ):
        read_body(load_case(path), strict=False)


def test_stresses_as_they_are(tmp_path):
    """A group with a column of points needs no modal stress; a point of no other table has a row, too."""
    rows = rows_of(tmp_path, check(cases="stops", points=["free", "a"], perp="across", par="along"), cases=AT_POINTS)
    assert rows["point"].tolist() == ["free", "a"] * 2
    assert rows["weld"].tolist() == ["", "W"] * 2
    np.testing.assert_allclose(rows["range_max_MPa"], [50.0, 50.0, 15.0, 15.0])
    np.testing.assert_allclose(rows["R"][:2], [-4.0, -4.0])
    np.testing.assert_allclose(rows["utilisation_stress"][:2], 25.0 / 60.0)
    assert set(rows["governing_event"]) == {"empty / full", "full / empty"}


def test_stresses_as_they_are_without_stress_points(tmp_path):
    """The table of static cases alone is enough for endurance at points, beside a mission at the welds."""
    case = compared_case(FILES + check(cases="stops", points=["free"], perp="across", shear="sheared", limit=1.0))
    path = case.write(tmp_path)
    (tmp_path / "cases.csv").write_text(AT_POINTS, encoding="utf-8")
    (tmp_path / "lines.csv").write_text(LINES, encoding="utf-8")
    assess(path, tmp_path / "out", threads=1, report=False)
    table = read_table(tmp_path / "out", "checks").to_pandas()
    assert table.component.tolist() == ["perp", "shear", "combination"]
    assert set(table.point) == {"free"}
    assert table.weld.isna().all()
    assert table.value[2] == pytest.approx((table.utilisation_stress[:2] ** 2).sum())


def test_a_thickness_rule_needs_the_thickness(tmp_path):
    """A curve with one serves stress points, whose thickness is known, and no others."""
    thick = curve_text("thick", 90.0, slopes=(3.0, 5.0), knees=(5e6, 1e8))
    thick += "thickness_reference_mm = 3.0\nthickness_exponent = 0.2\n"
    text = thick + '[checks]\nstatic_cases = "cases.csv"\n'
    for number, (names, refused) in enumerate(((["a"], False), (["a", "free"], True))):
        folder = tmp_path / str(number)
        path = written(folder, check(cases="stops", points=names, curve="thick"), cases=AT_POINTS)
        path.write_text(path.read_text().replace(FILES, text), encoding="utf-8")
        if refused:
            with pytest.raises(CaseError, match="curve 'thick' has a thickness rule, and 'free' no thickness"):
                read_body(load_case(path), strict=False)
            continue
        body = read_body(load_case(path), strict=False)
        rows = point_endurance(body, point_stress(body)[0])
        np.testing.assert_allclose(rows["utilisation_stress"], 50.0 * 2.0**0.2 / (90.0 * 0.40471316447), rtol=1e-9)
