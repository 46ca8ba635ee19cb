"""The picture of a point: its rows, and the PNG that a browser draws."""

import struct

import pytest

from fatigue.errors import DataError
from fatigue.point.page.picture import CAPTION, FOOT, HEAD, LINE, picture_page
from fatigue.point.page.story import point
from fatigue.report.files.browser import find_browser


def test_two_columns_of_known_heights(results, gathered):
    """Every part has its height, so that the picture ends where the page ends."""
    page, height = picture_page(gathered(results("plain"), "A", order=3))
    rows = page.split('<div class="row">')[1:]
    plots = [row.count('class="plot"') for row in rows]
    assert all(count == 2 for count in plots[:-1])
    heights = [int(row.split("height:")[1].split("px")[0]) for row in rows]
    lines = page.split('<ul class="plain">')[1].split("</ul>")[0].count("<li>")
    assert lines > 1
    assert height == HEAD + LINE * lines + FOOT + sum(heights) + CAPTION * len(rows)
    assert "staticPlot: true" in page


@pytest.mark.browser
def test_a_browser_draws_it(results, tmp_path):
    """A PNG 1600 px wide, as high as the page, and not blank."""
    try:
        find_browser()
    except DataError as error:
        pytest.skip(str(error))
    found = point(results("plain"), "A", order=3, output=tmp_path / "picture.PNG")
    picture = (tmp_path / "picture.PNG").read_bytes()
    assert picture.startswith(b"\x89PNG")
    assert struct.unpack(">II", picture[16:24])[0] == 1600
    assert struct.unpack(">II", picture[16:24])[1] > 1500
    assert len(picture) > 100_000
    assert str(found.file).endswith("picture.PNG")
    assert [path.name for path in tmp_path.iterdir()] == ["picture.PNG"]
