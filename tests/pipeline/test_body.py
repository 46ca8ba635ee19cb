"""The small files of a case together: curves, units, what stands beside them."""

import pytest

from fatigue.case import load_case
from fatigue.errors import DataError
from fatigue.pipeline.body import conversion_file, read_body, register_file
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
