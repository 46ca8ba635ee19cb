"""Points compared with the lines of their welds: e1 across the weld, and not far from it."""

import numpy as np
import pandas as pd
import pytest

from fatigue.readers.convert.options import Density
from fatigue.readers.convert.stresses.points import OF_EDGE_MM, OF_THICKNESS
from fatigue.readers.neutral.body.lines import read_lines
from fatigue.readers.neutral.body.welds import Weld
from fatigue.readers.neutral.line_file import line_file
from fatigue.readers.neutral.points.beside_welds import assessed_names, compared_with_welds
from fatigue.readers.neutral.points.stress_points import read_stress_points
from fatigue.weld.beside.hot_spot import EDGE, FACE, matching_set
from tests.readers.neutral_tables import WELD_NODES, write
from tests.stress_point_case import point


@pytest.fixture(scope="module")
def lines(tmp_path_factory):
    """A straight seam of 200 mm along x, and a closed ring of 10 mm around the origin, 5 mm above it."""
    columns = dict(WELD_NODES)
    columns["x_mm"] = [0.0, 100.0, 200.0, *columns["x_mm"][3:]]
    path = write(tmp_path_factory.mktemp("lines") / "n.csv", columns)
    welds = [Weld(name, name == "ring", "both", None, None, "") for name in ("seam", "ring")]
    return line_file(read_lines(path, welds, {"seam", "ring"}, strict=True)[0])


def compared(folder, lines, *rows):
    """Refusals and doubts of some points, and their table."""
    pd.DataFrame(list(rows)).to_csv(folder / "p.csv", index=False)
    welds = {name: name for name in ("seam", "ring", "gone")}
    points, _ = read_stress_points(folder / "p.csv", welds, {"points"}, strict=True)
    return compared_with_welds(points, lines)


def at(x, y, weld="seam", angle=90.0, kind="hot_spot_a", name="P", **more):
    """A point whose e1 has an angle [deg] with the x axis."""
    e1 = {"e1_x": float(np.cos(np.deg2rad(angle))), "e1_y": float(np.sin(np.deg2rad(angle)))}
    return point(name, kind, weld, x_mm=float(x), y_mm=float(y), **e1, **more)


@pytest.mark.parametrize("angle", [90.0, -90.0, 31.0, 149.0, 270.0])
def test_e1_across_the_weld(tmp_path, lines, angle):
    """From 30 deg on the planes within 60 deg of e1 have the one across the weld among them: nothing is said."""
    assert compared(tmp_path, lines, at(100, 5, angle=angle)) == ([], [])


@pytest.mark.parametrize("angle", [0.0, 29.0, -29.0, 180.0])
def test_e1_along_the_weld(tmp_path, lines, angle):
    """The first of such hot spots is refused, with the number of others."""
    (refusal,), doubts = compared(tmp_path, lines, at(100, 5, angle=angle), at(60, 5, angle=angle, name="Q"))
    assert refusal.where == "p.csv: point P: e1"
    assert f"e1 is along weld seam ({min(abs(angle), 180 - abs(angle)):.0f} deg from its line)" in refusal.what
    assert "so is e1 of 1 more points" in refusal.what
    assert refusal.count == 2
    assert doubts == []


def test_at_the_end_of_a_weld_e1_may_have_any_direction(tmp_path, lines):
    """The toe runs around the end of a weld; the line of a closed one has no end."""
    assert compared(tmp_path, lines, at(205, 0, angle=0.0), at(-8, 3, angle=0.0, name="Q")) == ([], [])
    refusals, _ = compared(tmp_path, lines, at(7, 7, "ring", -45.0, z_mm=5.0), at(7, 7, "ring", 45.0, name="Q"))
    assert [refusal.where for refusal in refusals] == ["p.csv: point P: e1"]


def test_nominal_stress_along_a_weld_is_told(tmp_path, lines):
    """There are classes for stress along a weld, so that it is a doubt and no mistake."""
    refusals, (doubt,) = compared(tmp_path, lines, at(100, 50, angle=0.0, kind="nominal"))
    assert refusals == []
    assert doubt.code == "stress_along_weld"
    assert "the nominal stress sx of point P is along weld seam" in doubt.what


def test_hot_spots_far_from_their_weld(tmp_path, lines):
    """Beyond ten thicknesses, and 100 mm, the worst is named with the number of others; nominal stress may be far."""
    rows = [at(100, 99), at(100, 130, name="Q"), at(100, 5000, name="R"), at(100, 900, kind="nominal", name="S")]
    refusals, (doubt,) = compared(tmp_path, lines, *rows, at(100, 199, name="T", thickness_mm=20.0))
    assert refusals == []
    assert doubt.code == "far_from_weld"
    assert doubt.where == "p.csv: point R"
    assert "5e+03 mm from the line of weld seam, above 100 mm" in doubt.what
    assert doubt.what.endswith("so are 1 more")
    assert doubt.count == 2


def test_parent_metal_and_welds_that_are_not_assessed_are_passed_over(tmp_path, lines):
    """Points without a direction of their own, and those of welds without a line, are not compared."""
    rows = [at(100, 5, "gone", 0.0), at(100, 5, "seam", 0.0, "parent", "Q"), at(100, 5, "seam", 0.0, "hot_spot_b", "R")]
    assert compared(tmp_path, lines, *rows) == ([], [])


def test_names_of_welds():
    """A weld may be named as it is assessed, which goes first, or as in the tables; others keep their name."""
    names = assessed_names({"line 1": "bracket", "line 2": "bracket", "line 3": "line 1"}, ["gone", "line 2"])
    assert names == {"gone": "gone", "line 2": "bracket", "line 1": "line 1", "line 3": "line 1", "bracket": "bracket"}


@pytest.mark.parametrize("density", ["fine", "quadratic", "coarse"])
def test_read_outs_of_a_conversion_are_those_of_the_rules(density: Density):
    """What a conversion reads from FE stresses is a set of read-outs here."""
    assert matching_set(FACE, 7.0 * np.array(OF_THICKNESS[density]), 7.0) is not None
    assert matching_set(EDGE, np.array(OF_EDGE_MM[density]), 7.0) is not None
