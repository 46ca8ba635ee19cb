"""The table of gauges: what it holds, and every mistake in it told with place and remedy."""

import pytest

from fatigue.errors import DataError
from fatigue.gauges.gauge_file import read_gauges

HEAD = (
    "gauge,kind,element,x_mm,y_mm,z_mm,normal_x,normal_y,normal_z,angle_deg,dir_x,dir_y,dir_z,surface,point,weld,order"
)


def read(tmp_path, *rows, head=HEAD):
    """Gauges of some rows."""
    path = tmp_path / "gauges.csv"
    path.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    return read_gauges(path)


def said(tmp_path, *rows, head=HEAD):
    """What is said of rows that are refused."""
    with pytest.raises(DataError) as refused:
        read(tmp_path, *rows, head=head)
    return str(refused.value)


def test_three_kinds_in_one_table(tmp_path):
    """Each row keeps what it says; what is empty is None."""
    gauges, warnings = read(
        tmp_path,
        "e,element,12,,,,,,,30,,,,bottom,,,",
        "p,element,,1,2,3,0,0,1,,1,0,0,,,,",
        "t,table,,,,,,,,0,,,,top,P1,,",
        "w,toe,,,,,,,,,,,,top,,W1,4",
    )
    assert warnings == []
    e, p, t, w = gauges
    assert (e.element, e.angle_deg, e.surface, e.xyz, e.direction) == (12, 30.0, "bottom", None, None)
    assert (p.xyz, p.normal, p.direction, p.element) == ((1.0, 2.0, 3.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0), None)
    assert (t.point, t.surface) == ("P1", "top")
    assert (w.weld, w.order, w.part) == ("W1", 4, None)
    assert (e.grid_length, e.transverse_sensitivity, e.cost, e.E) == (0.0, 0.0, 1.0, None)


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ("e,element,12,,,,,,,30,1,0,0,top,,,", "angle_deg and dir_x, dir_y, dir_z are both given. Keep one of them"),
        ("e,element,12,,,,,,,,,,,top,,,", "nothing says which way the grid points. Give angle_deg, or dir_x"),
        ("e,element,12,1,2,3,,,,30,,,,top,,,", "element and x_mm, y_mm, z_mm are both given"),
        ("e,element,,,,,,,,30,,,,top,,,", "nothing says where it sits"),
        ("e,element,12,,,,,,,30,,,,,,,", "nothing says which face it is on. Give surface = top or bottom"),
        ("e,element,12,,,,,,,30,,,,edge,,,", "nothing says which face it is on"),
        ("e,element,12,,,,0,0,1,30,,,,top,,,", "a normal is given for an element"),
        ("e,element,,1,2,3,,,,,1,0,0,,,,", "the outward normal is missing. Give normal_x"),
        ("e,element,,1,2,3,0,0,1,30,,,,,,,", "angle_deg is given with a place: it counts from axis x of an element"),
        ("e,element,,1,2,3,0,0,1,,1,0,0,top,,,", "surface = top is given with a place, whose normal says"),
        ("e,element,,1,,3,0,0,1,,1,0,0,,,,", "y_mm is empty, and the other two are given"),
        ("e,element,,1,2,3,0,0,0,,1,0,0,,,,", "normal_x, normal_y, normal_z are all 0"),
        ("e,element,12,,,,,,,,0,0,0,top,,,", "dir_x, dir_y, dir_z are all 0"),
        ("e,element,12,,,,,,,30,,,,top,P,W,", "point, weld mean nothing for kind element"),
        ("t,table,,,,,,,,30,,,,,P1,,", "surface is empty. Give one of top, bottom, edge"),
        ("w,toe,,,,,,,,30,,,,top,,W1,4", "angle_deg means nothing for kind toe"),
        ("w,toe,,,,,,,,,,,,top,,W1,", "weld or order is empty"),
        ("w,toe,,,,,,,,,,,,,,W1,4", "nothing says which face it is on"),
        ("a,acceleration,12,,,,,,,30,,,,top,,,", "accelerations are not read here: they need the rigid modes"),
        ("a,rosette,12,,,,,,,30,,,,top,,,", "'rosette' is not one of element, table, toe"),
        ("e,element,1.5,,,,,,,30,,,,top,,,", "1.5 is not a whole number"),
    ],
)
def test_mistakes_of_a_row_are_told(tmp_path, row, message):
    """File, gauge and row, what is wrong, what to do; in one line."""
    text = said(tmp_path, "ok,element,7,,,,,,,0,,,,top,,,", row)
    assert message in text
    assert text.startswith("gauges.csv: ")
    assert "row 2" in text


def test_mistakes_of_columns_are_told(tmp_path):
    """A name twice, materials that there are not, a sensitivity in percent, no rows at all, an unknown column."""
    twice = "g,element,7,,,,,,,0,,,,top,,,"
    assert "gauge g repeats row 1" in said(tmp_path, twice, twice)
    head = f"{HEAD},E_MPa,nu,transverse_sensitivity,grid_length_mm"
    row = "g,element,7,,,,,,,0,,,,top,,,"
    assert "one of E_MPa and nu is given alone" in said(tmp_path, f"{row},7e4,,,", head=head)
    assert "column nu, row 1: 0.5 is not in 0 to 0.5" in said(tmp_path, f"{row},7e4,0.5,,", head=head)
    assert "column E_MPa, row 1: -1 is not above 0" in said(tmp_path, f"{row},-1,0.3,,", head=head)
    assert "0.8 is beyond +-0.2. Give a ratio, not percent" in said(tmp_path, f"{row},,,0.8,", head=head)
    assert "column grid_length_mm, row 1: -3 is below 0" in said(tmp_path, f"{row},,,,-3", head=head)
    assert "the table has no rows. Write at least one row." in said(tmp_path)
    assert "column kind" in said(tmp_path, "g,1", head="gauge,element")
    _, warnings = read(tmp_path, f"{row},x", head=f"{HEAD},colour")
    assert [problem.code for problem in warnings] == ["unknown_column"]
