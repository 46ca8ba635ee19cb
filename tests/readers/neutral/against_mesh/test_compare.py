"""Weld tables that contradict the mesh are told, once for each weld and kind; those that agree with it are not."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.readers.neutral.against_mesh import mesh_warnings
from fatigue.weld.line import stacked
from tests.readers.neutral.against_mesh.plates import NAMES, mesh, tee, told, weld_of
from tests.weld_lines import moved, ring, rotations, weld_line

TEE = tee()
LINE = weld_of(TEE)


def turned_about_line(line, degrees, at=slice(None)):
    """Turn normals of a line along x about it."""
    normal = line.normal.copy()
    normal[at] = [0.0, -np.sin(np.radians(degrees)), np.cos(np.radians(degrees))]
    return replace(line, normal=normal)


def test_tables_of_one_mesh_agree():
    """The line of the base plate and that of the wall, seen with either face on top and from either end."""
    wall = replace(LINE, thickness=np.full(11, 6.0), normal=LINE.outward, outward=np.tile([0.0, 0, -1], (11, 1)))
    upside_down = replace(LINE, normal=-LINE.normal)
    assert told(TEE, LINE, wall, upside_down)[0] == []


@given(rotations(), st.floats(-1e5, 1e5))
@settings(deadline=None, max_examples=20)
def test_rounding_to_single_precision_is_no_difference(rotation, shift):
    """Wherever the body stands; the positions of one table are rounded as a single-precision file rounds them."""
    line = moved(LINE, rotation, np.full(3, shift))
    body = replace(TEE, xyz=(TEE.xyz @ rotation.T + shift).astype(np.float32).astype(float))
    assert told(body, line)[0] == []


@pytest.mark.parametrize(
    ("factor", "word"),
    [
        (1.5, "1.5 times as long here."),
        (0.001, "0.001 times as long here; the weld table looks like m."),
        (1000.0, "1000 times as long here; nodes.csv looks like m."),
        (1 / 25.4, "0.03937 times as long here; the weld table looks like inches."),
        (25.4, "25.4 times as long here; nodes.csv looks like inches."),
    ],
)
def test_scaled_coordinates(factor, word):
    """Both places are named, the factor, and the unit that it fits."""
    codes, texts = told(TEE, replace(LINE, xyz=factor * LINE.xyz))
    assert codes == ["moved_in_mesh"]
    assert texts[0].startswith("weld_nodes.csv: weld W1, node ")
    assert f"; the line is {word}" in texts[0]


def test_a_line_that_lies_elsewhere_keeps_its_shape():
    """Shifted, turned or mirrored; and one node that is astray has no shape to tell of."""
    shifted = replace(LINE, xyz=LINE.xyz + np.array([0.0, 3.0, 0.0]))
    codes, texts = told(TEE, shifted)
    assert codes == ["moved_in_mesh"]
    assert (
        "x, y, z are 0, 3, 0 mm and in nodes.csv 0, 0, 0 mm, 3 mm apart; the line has the same shape there" in texts[0]
    )
    astray = LINE.xyz.copy()
    astray[4] += [0.0, 1.0, 0.0]
    codes, texts = told(TEE, replace(LINE, xyz=astray))
    assert codes == ["moved_in_mesh"]
    assert "order 5): x, y, z are 40, 1, 0 mm and in nodes.csv 40, 0, 0 mm, 1 mm apart. Give" in texts[0]


def test_a_hundredth_of_an_edge_is_let_pass():
    """Coordinates written with one decimal are no other coordinates; two hundredths are told."""
    assert told(TEE, replace(LINE, xyz=LINE.xyz + np.array([0.0, 0.09, 0.0])))[0] == []
    assert told(TEE, replace(LINE, xyz=LINE.xyz + np.array([0.0, 0.2, 0.0])))[0] == ["moved_in_mesh"]


def test_nodes_that_the_mesh_does_not_have():
    """They are counted, and nothing else is said of them."""
    node = LINE.node.copy()
    node[[2, 5]] += 10_000
    codes, texts = told(TEE, replace(LINE, node=node))
    assert codes == ["not_in_mesh"]
    assert "and 1 more: the node is not in nodes.csv" in texts[0]


def test_another_thickness():
    """Twice the plate, told with both numbers; the thickness of the plate upon it, or the mean of two, is let pass."""
    codes, texts = told(TEE, replace(LINE, thickness=np.full(11, 16.0)))
    assert codes == ["other_thickness"]
    assert "thickness_mm is 16, and 6 and 8 in elements.csv where shells touch the node" in texts[0]
    for thickness in (8.004, 6.0, 7.0):
        assert told(TEE, replace(LINE, thickness=np.full(11, thickness)))[0] == []


def test_thickness_in_inches_is_called_so():
    """Where the factor fits; without a wall there is one thickness to compare with, and any factor is told."""
    _, texts = told(TEE, replace(LINE, thickness=np.full(11, 8.0 / 25.4)))
    assert "0.03937 times as much; thickness_mm looks like inches" in texts[0]
    alone = replace(TEE, thickness=np.where(TEE.thickness == 6.0, np.nan, TEE.thickness))
    _, texts = told(alone, replace(LINE, thickness=np.full(11, 20.0)))
    assert "(element " in texts[0]
    assert "), 2.5 times as much. Correct" in texts[0]


def test_a_confirmed_thickness_is_let_pass():
    """Only as it was confirmed."""
    thick = replace(LINE, thickness=np.full(11, 16.0))
    assert told(TEE, thick, confirmed={"W1": (16.0,)})[0] == []
    assert told(TEE, thick, confirmed={"W1": (12.0,)})[0] == ["other_thickness"]
    assert told(TEE, thick, confirmed={"W2": (16.0,)})[0] == ["other_thickness"]


def test_a_mesh_that_knows_no_thickness_is_silent():
    """As is one without elements."""
    thick = replace(LINE, thickness=np.full(11, 16.0))
    assert told(replace(TEE, thickness=np.full_like(TEE.thickness, np.nan)), thick)[0] == []
    none = np.zeros(0, dtype=np.int64)
    bare = replace(TEE, element=none, pid=none, corners=np.zeros((0, 8), dtype=np.int64), thickness=np.zeros(0))
    assert told(bare, turned_about_line(thick, 56.0))[0] == []
    assert told(bare, replace(LINE, xyz=1.5 * LINE.xyz))[0] == ["moved_in_mesh"]


def test_the_worst_weld_of_a_kind_comes_first():
    """However the welds are ordered; each has one warning of a kind."""
    some = [replace(LINE, thickness=np.full(11, t)) for t in (9.0, 40.0, 8.0, 16.0)]
    codes, texts = told(TEE, *some)
    assert codes == ["other_thickness"] * 3
    assert [text.split(",")[0][-2:] for text in texts] == ["W2", "W4", "W1"]


@pytest.mark.parametrize(("degrees", "off"), [(40.0, 40), (56.0, 56), (-56.0, 34)])
def test_normals_turned_about_the_weld(degrees, off):
    """All of them alike, which the line alone cannot show: no plate is in the plane they give, a wall is near."""
    codes, texts = told(TEE, turned_about_line(LINE, degrees))
    assert codes == ["normal_off_plate"]
    assert f"is turned about the line by {off} degrees against the plane that the normal gives" in texts[0]


def test_a_normal_between_two_facets_is_let_pass():
    """Up to 30 degrees, below which shells are one plate."""
    assert told(TEE, turned_about_line(LINE, 29.0))[0] == []


def test_a_tube_of_facets_is_silent():
    """A weld round a tube of twelve facets, and one along it with the normal between two facets."""
    angle = np.radians(30.0 * np.arange(12))
    rings = [np.column_stack([50 * np.cos(angle), 50 * np.sin(angle), np.full(12, z)]) for z in (0.0, 20.0, 40.0)]
    number = np.arange(36).reshape(3, 12)
    quads = np.stack([number[:-1], np.roll(number[:-1], -1, 1), np.roll(number[1:], -1, 1), number[1:]], axis=-1)
    tube = mesh(np.vstack(rings), quads.reshape(-1, 4) + 1, np.full(24, 5.0))
    radial = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(12)])
    round_it = ring(12, 50.0, normal=radial, outward=np.tile([0.0, 0, -1], (12, 1)), thickness=5.0, node=1 + number[0])
    along = weld_line(
        tube.xyz[number[:, 0]], normal=[1.0, 0, 0], outward=[0.0, 1, 0], thickness=5.0, node=1 + number[:, 0]
    )
    assert told(tube, round_it, along)[0] == []


def test_an_outward_vector_into_the_plate():
    """At the edge of a plate the vector can point one way only."""
    edge = np.flatnonzero(np.abs(TEE.xyz[:, 1] + 20) < 1e-9)
    edge = edge[np.argsort(TEE.xyz[edge, 0])]
    line = weld_line(TEE.xyz[edge], outward=[0.0, -1, 0], thickness=8.0, node=TEE.node[edge])
    assert told(TEE, line)[0] == []
    codes, texts = told(TEE, replace(line, outward=-line.outward))
    assert codes == ["outward_into_plate"]
    assert "and 10 more: the outward vector points into the nearest shell of elements.csv" in texts[0]
    assert told(TEE, replace(line, outward=-line.outward), knows_sides=True)[0] == []


def test_blocks_of_lines_say_what_all_say(monkeypatch):
    """Lines are compared some at a time."""
    lines = [replace(LINE, weld=f"W{i}", thickness=np.full(11, 8.0 + i % 3)) for i in range(7)]
    whole = mesh_warnings(stacked(lines), TEE, NAMES, {}, knows_sides=False)
    monkeypatch.setattr("fatigue.readers.neutral.against_mesh.compare.NODES_AT_ONCE", 25)
    assert mesh_warnings(stacked(lines), TEE, NAMES, {}, knows_sides=False) == whole
    assert len(whole) == 4
