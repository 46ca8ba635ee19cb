"""Hot spots and all points on the page: what stands there is what the tables hold."""

import numpy as np
import pandas as pd
import pytest

from fatigue.report.page import report_page
from fatigue.report.sections.places.section import extent
from tests.report.reading import Page, inflated
from tests.report.tiny_result import Recipe, write_result


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Result of a ring and open lines, on one face of which no toe is."""
    return write_result(tmp_path_factory.mktemp("spots"), Recipe(closed=True, toes="top", stations=7))


def test_all_points_are_in_the_page(page, result_folder):
    """Every row of the table of nodes, in single precision, with names as indices."""
    nodes = pd.read_parquet(result_folder / "nodes.parquet")
    read = inflated(page.points)
    for name in ("arc_length_mm", "utilisation", "load_factor", "max_range_MPa", "dirlik_ratio"):
        np.testing.assert_array_equal(read[name], nodes[name].to_numpy(dtype=np.float32))
    np.testing.assert_array_equal(read["node"], nodes["node"])
    assert [page.points["welds"][i] for i in read["weld"]] == nodes["weld"].tolist()
    assert [page.points["events"][i] for i in read["event"]] == nodes["governing_event"].tolist()
    np.testing.assert_array_equal((read["flags"] & 1) == 1, nodes["surface"] == "bottom")
    np.testing.assert_array_equal((read["flags"] & 2) == 0, nodes["toe"])
    assert len(page.tables["hot-spots"][1:]) == np.count_nonzero(read["flags"] & 8)


def test_the_figure_in_space_shows_rows_of_them(folder):
    """One row for each drawn point, gaps between lines included: node and place of the worse face."""
    page = Page(report_page(folder))
    read, nodes = inflated(page.points), pd.read_parquet(folder / "nodes.parquet")
    drawn = np.cumsum(read["drawn_steps"])
    of_ring = [*range(7), 0, 0]  # closed, and the gap behind it
    expected = [1000 * w + s for w in (1, 2) for s in of_ring]
    assert nodes["node"].to_numpy()[drawn].tolist() == expected
    assert set(nodes["surface"].to_numpy()[drawn]) == {"top"}


def test_without_damage_there_are_none(tmp_path):
    """And the page says so."""
    page = Page(report_page(write_result(tmp_path, Recipe(level=0.0, stations=2))))
    assert page.tables["worst-ten"][1:] == []
    assert "Nothing damages, so there are none." in page.words


def test_unverified_curves_are_marked(tmp_path):
    """Lives of hot spots carry the word; the script knows the welds."""
    page = Page(report_page(write_result(tmp_path, Recipe(curve_status="unverified", stations=2))))
    assert all("(unverified)" in row[5] for row in page.tables["hot-spots"][1:])
    assert page.points["unverified"] == ["W1 bracket", "W2 hanger"]


@pytest.mark.parametrize(
    ("span", "words"), [((0.0, 0.0), "0"), ((24.6, 374.6), "25 – 375"), ((750.0, 50.0), "750 – 50")]
)
def test_extents_are_whole_millimetres(span, words):
    """A single station has one number; a stretch through the start of a ring begins behind its end."""
    assert extent(*span) == words
