"""The body for ParaView against the mesh of the case."""

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.report.files.body import write_body
from tests.report.files.test_vtp import arrays
from tests.report.tiny_result import Recipe, write_result


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Result of a case with two quadrilaterals at right angles."""
    root = tmp_path_factory.mktemp("body")
    return write_result(root, Recipe(mesh=True, stations=2))


def test_shells_are_the_polygons_of_the_file(folder):
    """Corners in the order of the elements, ids of nodes and elements, coordinates in mm, and no field."""
    found, piece = arrays(write_body(folder))
    assert piece["NumberOfPolys"] == "2"
    np.testing.assert_array_equal(found["node"], [1, 2, 3, 4, 5, 6])
    np.testing.assert_array_equal(found["element"], [1, 2])
    np.testing.assert_array_equal(found["offsets"], [4, 8])
    np.testing.assert_array_equal(found["node"][found["connectivity"]], [1, 2, 3, 4, 1, 2, 5, 6])
    np.testing.assert_array_equal(found["Points"][[1, 4]], [[1000.0, 0.0, 0.0], [1000.0, 0.0, 300.0]])
    assert set(found) == {"Points", "connectivity", "offsets", "node", "element"}


def test_triangles_have_three_corners_and_only_used_nodes_are_there(folder, monkeypatch):
    """A zero in place of the fourth corner ends a triangle; what no shell uses is left out."""
    from dataclasses import replace  # noqa: PLC0415

    from fatigue.report.inputs import FoundInputs  # noqa: PLC0415

    whole = FoundInputs.mesh

    def with_a_triangle(inputs):
        mesh = whole(inputs)
        corners = mesh.corners.copy()
        corners[1, 2:4] = [5, 0]
        return replace(mesh, corners=corners)

    monkeypatch.setattr(FoundInputs, "mesh", with_a_triangle)
    found, _ = arrays(write_body(folder))
    np.testing.assert_array_equal(found["node"], [1, 2, 3, 4, 5])
    np.testing.assert_array_equal(found["offsets"], [4, 7])
    np.testing.assert_array_equal(found["node"][found["connectivity"]], [1, 2, 3, 4, 1, 2, 5])


def test_a_case_without_a_mesh_is_told(tmp_path):
    """And which keys it lacks."""
    with pytest.raises(DataError, match=r"no nodes and elements.*body\.nodes and body\.elements"):
        write_body(write_result(tmp_path, Recipe(stations=2)))


def test_a_mesh_that_has_changed_is_not_drawn(tmp_path):
    """It is not that of the result any more."""
    folder = write_result(tmp_path, Recipe(mesh=True, stations=2))
    with (tmp_path / "nodes.csv").open("a") as file:
        file.write("7,0,0,900\n")
    with pytest.raises(DataError, match=r"nodes\.csv: has changed since the assessment"):
        write_body(folder)
