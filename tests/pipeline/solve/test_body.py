"""The small files of a case together: curves, units, what stands beside them."""

import pytest

from fatigue.case import load_case
from fatigue.errors import DataError
from fatigue.pipeline.solve.body import conversion_file, read_body, register_file
from tests.small_case import small_case


def test_body_of_the_small_case(tmp_path):
    """Lines in the order of the welds, nothing excluded, nothing converted."""
    body = read_body(load_case(small_case().write(tmp_path)), strict=True)
    assert [line.weld for line in body.lines] == ["A", "B"]
    assert body.excluded == ()
    assert body.conversion is None
    assert register_file(body.case) is conversion_file(body.case) is None


def test_coordinates_in_metres_are_refused(tmp_path):
    """All lines shorter than their plates are thick: the unit is wrong, and the message says which it looks like."""
    case = small_case()
    case.weld_nodes[["x_mm", "y_mm", "z_mm"]] /= 1000.0
    with pytest.raises(DataError) as error:
        read_body(load_case(case.write(tmp_path)), strict=False)
    assert str(error.value) == (
        "weld_nodes.csv: x_mm, y_mm, z_mm: no weld line is as long as its plate is thick; the longest, of weld A, has "
        "0.06 mm on a plate of 8 mm. Give coordinates in mm; these look like m."
    )


@pytest.mark.parametrize(
    ("factor", "message"),
    [
        (
            1e-3,
            (
                "weld_nodes.csv: weld A, node 100 (order 1) and 13 more: thickness_mm is 0.008 on edges of 10 mm, no "
                "plate is welded so thin. Give thickness_mm in mm; this looks like m."
            ),
        ),
        (
            1e3,
            (
                "weld_nodes.csv: weld A, node 100 (order 1) and 13 more: thickness_mm is 8000, no plate is welded so "
                "thick. Give thickness_mm in mm; this looks like micrometres."
            ),
        ),
    ],
)
def test_a_thickness_that_is_not_in_mm_is_refused(tmp_path, factor, message):
    """The thickness is blamed, not the coordinates that are judged by it."""
    case = small_case()
    case.weld_nodes["thickness_mm"] *= factor
    with pytest.raises(DataError) as error:
        read_body(load_case(case.write(tmp_path)), strict=False)
    assert str(error.value) == message


def test_an_unusual_thickness_is_a_warning_of_the_body(tmp_path):
    """Inches are possible mm: the case is read, and the warning travels with it."""
    case = small_case()
    case.weld_nodes.loc[case.weld_nodes.weld == "B", "thickness_mm"] /= 25.4
    body = read_body(load_case(case.write(tmp_path)), strict=False)
    assert [str(warning) for warning in body.warnings if warning.code == "unusual_thickness"] == [
        (
            "weld_nodes.csv: weld B, node 200 (order 1) and 6 more: thickness_mm is 0.314961, welded plates have 0.5 "
            "to 200 mm as a rule. Check that it is in mm, not in inches or m."
        )
    ]
