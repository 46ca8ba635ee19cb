"""Mesh: what the files say arrives, and what they say wrong is told."""

import numpy as np
import pytest

from fatigue.readers.neutral.body.mesh import read_mesh
from tests.readers.neutral_tables import changed, refusal_of, without, write

NODES = {"node": [3, 1, 2, 4], "x_mm": [1.0, 0.0, 1.0, 0.0], "y_mm": [1.0, 0.0, 0.0, 1.0], "z_mm": [0.0] * 4}
ELEMENTS = {"element": [9, 8], "n1": [1, 1], "n2": [2, 2], "n3": [3, 3], "n4": [4, None], "pid": [5, None]}

SUFFIXES = pytest.mark.parametrize("suffix", [".csv", ".parquet"])


@SUFFIXES
def test_mesh(tmp_path, suffix):
    """Nodes and elements come sorted by id; corners that an element lacks are 0."""
    nodes, elements = write(tmp_path / f"n{suffix}", NODES), write(tmp_path / f"e{suffix}", ELEMENTS)
    mesh, warnings = read_mesh(nodes, elements, strict=True)
    assert warnings == []
    assert mesh.node.tolist() == [1, 2, 3, 4]
    assert mesh.xyz.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    assert mesh.element.tolist() == [8, 9]
    assert mesh.corners.tolist() == [[1, 2, 3, 0, 0, 0, 0, 0], [1, 2, 3, 4, 0, 0, 0, 0]]
    assert mesh.pid.tolist() == [0, 5]
    assert np.isnan(mesh.thickness).all()


def test_mesh_without_elements(tmp_path):
    """Nodes alone serve the balance check."""
    mesh, _ = read_mesh(write(tmp_path / "n.csv", NODES), None, strict=True)
    assert mesh.node.size == 4
    assert mesh.element.size == 0
    assert mesh.corners.shape == (0, 8)


@pytest.mark.parametrize(
    ("nodes", "elements", "message"),
    [
        (
            changed(NODES, "node", 2, 3),
            ELEMENTS,
            "n.csv: column node, row 2: node 3 repeats row 1. Keep one of the rows.",
        ),
        (changed(NODES, "x_mm", 2, None), ELEMENTS, "n.csv: column x_mm, row 2: the value is missing or NaN. Give a"),
        (
            without(NODES, "z_mm"),
            ELEMENTS,
            "n.csv: column z_mm: the column is missing. Add it; the columns are node, x",
        ),
        (
            NODES,
            without(ELEMENTS, "n3"),
            "e.csv: column n3: the column is missing. Add it; the columns are element, n1",
        ),
        (
            NODES,
            changed(ELEMENTS, "element", 2, 9),
            "e.csv: column element, row 2: element 9 repeats row 1. Keep one of",
        ),
        (
            NODES,
            changed(ELEMENTS, "n4", 1, 77),
            "e.csv: column n4, row 1: node 77 is not in n.csv. Add the node there.",
        ),
        (NODES, changed(ELEMENTS, "n1", 2, 0), "e.csv: column n1, row 2: node 0 is not in n.csv. Add the node there."),
        (
            NODES,
            changed(ELEMENTS, "n2", 2, None),
            "e.csv: column n2, row 2: the value is missing or NaN. Give a number.",
        ),
        (
            NODES,
            ELEMENTS | {"thickness_mm": [1.0, 0.0]},
            "e.csv: column thickness_mm, row 2: 0 is not above 0. Give more",
        ),
    ],
)
def test_bad_mesh(tmp_path, nodes, elements, message):
    """Ids of the mesh are unique and known."""
    found = refusal_of(read_mesh, write(tmp_path / "n.csv", nodes), write(tmp_path / "e.csv", elements))
    assert found.startswith(message)
