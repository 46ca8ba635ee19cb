"""Lengths that cannot be mm are refused, those that are hardly mm are doubted, and what is welded passes."""

import numpy as np
import pytest

from fatigue.weld.line import stacked
from fatigue.weld.line_units import unit_problems, unit_warnings
from tests.weld_lines import ring, straight

FILE = "nodes.csv"


def said(find, *some):
    """Return what is found about lines, as text, one entry for each finding."""
    return [str(problem) for problem in find(stacked(some), FILE)]


@pytest.mark.parametrize(
    ("thickness", "edge"),
    [
        (0.5, 0.05),  # the thinnest sheet, on a line of a small coupon
        (0.5, 80.0),  # the same in a coarse mesh
        (1.5, 30.0),
        (3.0, 0.3),
        (8.0, 10.0),
        (40.0, 4.0),
        (100.0, 2000.0),
        (200.0, 100.0),
    ],
)
def test_what_is_welded_passes(thickness, edge):
    """Sheet, extrusions, bogie plates, on fine and coarse lines: neither refused nor doubted."""
    some = [straight([edge] * 50, thickness=thickness), ring(60, radius=edge * 10, thickness=thickness)]
    assert said(unit_problems, *some) == said(unit_warnings, *some) == []


@pytest.mark.parametrize("mm", [0.5, 1.5, 3.0, 15.0, 40.0, 100.0])
@pytest.mark.parametrize("edge_by_thickness", [0.2, 1.0, 20.0])
def test_every_plate_given_in_metres_is_refused(mm, edge_by_thickness):
    """Coordinates in mm, thickness in m: the edges give it away."""
    (problem,) = unit_problems(stacked([straight([edge_by_thickness * mm] * 9, thickness=mm / 1000.0)]), FILE)
    assert problem.code == "unit"
    assert problem.remedy == "Give thickness_mm in mm; this looks like m"


def test_a_thickness_in_metres_names_weld_node_value_and_remedy():
    """One line for the file: the first node and how many others, in other welds too."""
    sound, thin = straight([10.0] * 4), straight([10.0, 20.0, 10.0], thickness=[8.0, 0.008, 0.008, 0.008])
    assert said(unit_problems, sound, thin, ring(6, thickness=0.012)) == [
        (
            "nodes.csv: weld W1, node 102 (order 2) and 8 more: thickness_mm is 0.008 on edges of 13.3 mm, no plate is "
            "welded so thin. Give thickness_mm in mm; this looks like m."
        )
    ]
    assert said(unit_problems, straight([5.0, 5.0], thickness=[8.0, 0.02, 8.0], edge_mid=[0, 1, 0])) == [
        (
            "nodes.csv: weld W1, node 102 (order 2): thickness_mm is 0.02 on edges of 10 mm, no plate is welded so "
            "thin. Give thickness_mm in mm; this looks like m."
        )
    ]


def test_a_whole_geometry_in_metres_is_refused():
    """Edges are as long as plates are thick, but no plate is that thin."""
    assert said(unit_problems, straight([0.01] * 6, thickness=0.003)) == [
        (
            "nodes.csv: weld W1, node 101 (order 1) and 6 more: thickness_mm is 0.003 on edges of 0.01 mm, no plate is "
            "welded so thin. Give thickness_mm and coordinates in mm; both look like m."
        )
    ]


def test_a_thickness_in_micrometres_is_refused_and_the_coordinates_are_not_blamed():
    """Lines shorter than such a plate say nothing about their own unit."""
    assert said(unit_problems, straight([10.0] * 4, thickness=3000.0)) == [
        (
            "nodes.csv: weld W1, node 101 (order 1) and 4 more: thickness_mm is 3000, no plate is welded so thick. "
            "Give thickness_mm in mm; this looks like micrometres."
        )
    ]


def test_coordinates_in_metres_are_refused():
    """All lines shorter than their plates are thick; one longer line, and nothing is certain any more."""
    assert said(unit_problems, straight([0.01] * 4), straight([0.01] * 6)) == [
        (
            "nodes.csv: x_mm, y_mm, z_mm: no weld line is as long as its plate is thick; the longest, of weld W1, has "
            "0.06 mm on a plate of 10 mm. Give coordinates in mm; these look like m."
        )
    ]
    assert said(unit_problems, straight([0.01] * 4), straight([10.0])) == []


@pytest.mark.parametrize(
    ("thickness", "edge", "refused"),
    [
        (0.0149, 1.0, True),
        (0.015, 1.0, False),
        (0.05, 5.1, True),
        (0.05, 4.9, False),
        (0.1, 10.1, True),
        (0.101, 1000.0, False),
        (499.0, 200.0, False),
        (500.0, 200.0, True),
    ],
)
def test_limits_of_the_refusals(thickness, edge, refused):
    """On either side of each limit; what is not refused there is doubted."""
    line = straight([edge] * 8, thickness=thickness)
    assert len(said(unit_problems, line)) == refused
    assert refused or len(said(unit_warnings, line)) == 1


@pytest.mark.parametrize("inches_of", [0.5, 1.5, 3.0, 12.0])
def test_inches_are_not_refused(inches_of):
    """A thickness in inches may be one in mm, also in a model that is in inches throughout."""
    inches = inches_of / 25.4
    assert said(unit_problems, straight([10.0 / 25.4] * 8, thickness=inches)) == []
    assert said(unit_warnings, straight([10.0 / 25.4] * 8, thickness=inches)) != []


@pytest.mark.parametrize(("thickness", "doubted"), [(0.499, True), (0.5, False), (200.0, False), (200.1, True)])
def test_limits_of_the_warnings(thickness, doubted):
    """The doubt names place, value and what to look at; the line passes."""
    line = straight([10.0] * 40, thickness=np.where(np.arange(41) == 3, thickness, 8.0))
    message = (
        f"nodes.csv: weld W1, node 104 (order 4): thickness_mm is {thickness:g}, welded plates have 0.5 to 200 mm as a "
        "rule. Check that it is in mm, not in inches or m."
    )
    assert said(unit_problems, line) == []
    assert said(unit_warnings, line) == [message] * doubted
