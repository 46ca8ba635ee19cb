"""Element nodal forces: their balance, and their sum along whole and split lines."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.errors import DataError
from fatigue.weld.element_forces import ElementForces, balance, side_forces
from fatigue.weld.line_geometry import split_at_kinks
from tests.shell_fe import ShellModel, grid
from tests.weld_lines import straight, weld_line

WHERE = "forces.csv, weld W1"
MODES = np.array([7, 3])


def numbered(model, modes, seed=0):
    """Element forces of random displacements, with node n + 101 and element e + 1, in random order of rows."""
    rng = np.random.default_rng(seed)
    u = rng.normal(size=(len(modes), len(model.xyz), 6)) * [1, 1, 1, 0.1, 0.1, 0.1]
    force = np.stack([model.element_forces(one) for one in u])
    mode, element, corner = np.meshgrid(modes, np.arange(len(model.quads)), np.arange(4), indexing="ij")
    order = rng.permutation(mode.size)
    return ElementForces(
        mode=mode.ravel()[order],
        node=(model.quads[element, corner] + 101).ravel()[order],
        element=(element + 1).ravel()[order],
        force=force.reshape(-1, 6)[order],
    )


def plate(nx=4, ny=4):
    """A square mesh of 10 mm elements."""
    return ShellModel(*grid(10.0 * np.arange(nx + 1), 10.0 * np.arange(ny + 1)), thickness=5.0)


def touching(model, nodes):
    """Elements, from 1, that touch one of the nodes, from 101."""
    return np.flatnonzero(np.isin(model.quads + 101, nodes).any(axis=1)) + 1


def line_through(model, points, outward, **given):
    """Build the weld line through the given points of the mesh."""
    at = [int(np.argmin(np.linalg.norm(model.xyz[:, :2] - point, axis=1))) for point in points]
    return weld_line(model.xyz[at], outward=outward, node=np.array(at) + 101, **given)


def coordinates(model):
    """Coordinates by node id."""
    return {number + 101: xyz for number, xyz in enumerate(model.xyz)}


def row_sums(forces, elements, node, mode):
    """Sum the rows of some elements at one node, in one mode, by a plain loop."""
    rows = zip(forces.mode, forces.node, forces.element, forces.force, strict=True)
    return sum(f for m, n, e, f in rows if m == mode and n == node and e in elements)


def test_rows_are_kept_in_order_of_element():
    """Rows given in any order can be asked for by element."""
    forces = ElementForces(np.array([1, 1, 1]), np.array([5, 6, 7]), np.array([3, 1, 3]), np.arange(18.0).reshape(3, 6))
    assert forces.element.tolist() == [1, 3, 3]
    picked = forces.of(np.array([3, 99]))
    assert picked.node.tolist() == [5, 7]
    np.testing.assert_array_equal(picked.force[:, 0], [0, 12])


def test_stiffness_forces_are_in_balance():
    """Every element of a model in any state is in balance of forces and moments."""
    model = plate()
    found = balance(numbered(model, MODES), coordinates(model))
    assert found.element.size == 2 * len(model.quads)
    assert found.force_residual.max() < 1e-9
    assert found.moment_residual.max() < 1e-9


def test_imbalance_is_found_and_located():
    """A force or a moment in error shows in the element and mode it belongs to; coordinates tell moments apart."""
    model = plate()
    forces = numbered(model, MODES)
    row = np.flatnonzero((forces.element == 6) & (forces.mode == 3))[0]
    forces.force[row, 5] += 10 * np.abs(forces.force).max()
    assert balance(forces).force_residual.max() < 1e-9
    assert balance(forces).moment_residual is None
    found = balance(forces, coordinates(model))
    assert (found.element[found.worst], found.mode[found.worst]) == (6, 3)
    assert found.moment_residual[found.worst] == pytest.approx(1.0, rel=0.2)
    forces.force[row, 0] *= -1
    found = balance(forces)
    assert (found.element[found.worst], found.mode[found.worst]) == (6, 3)


def test_balance_has_a_floor():
    """An element that hardly strains is judged by its mode's largest one; an idle mode is in balance."""
    force = np.zeros((5, 6))
    force[:4, 0] = [1.0, -1.0, 1e-9, 0.0]
    forces = ElementForces(np.array([1, 1, 1, 1, 2]), np.arange(5), np.array([1, 1, 2, 2, 1]), force)
    np.testing.assert_allclose(balance(forces).force_residual, [0, 0, 1e-6], atol=1e-18)


def test_balance_refuses_unknown_nodes():
    """A node without coordinates is named."""
    forces = ElementForces(np.array([1, 1]), np.array([5, 6]), np.array([1, 1]), np.zeros((2, 6)))
    with pytest.raises(DataError) as caught:
        balance(forces, {1: np.zeros(3)})
    assert str(caught.value) == (
        "nodes: node 5 (and 1 more) has element forces and no coordinates. Add the node to the table of nodes."
    )


def test_sum_along_an_open_line():
    """Every node of the line gets the forces of all elements of the side, those beyond its ends included."""
    model = plate()
    line = line_through(model, [(20, 10), (20, 20), (20, 30)], outward=(1, 0, 0))
    forces = numbered(model, [3, 5, 7])
    side = np.array([e for e in touching(model, line.node) if model.xyz[model.quads[e - 1], 0].mean() < 20])
    assert side.size == 4
    (summed,) = side_forces((line,), side, forces, MODES, WHERE)
    expected = [[row_sums(forces, side, node, mode) for mode in MODES] for node in line.node]
    np.testing.assert_allclose(summed, expected, rtol=1e-9, atol=1e-9)


def test_single_precision_rows_are_summed_in_double():
    """Rows stored in single precision are added in double precision."""
    force = np.zeros((3, 6), dtype=np.float32)
    force[:, 0] = [1e8, 1.0, 0.0]
    forces = ElementForces(np.full(3, 7), np.array([101, 101, 102]), np.array([1, 2, 2]), force)
    (summed,) = side_forces((straight([1.0]),), np.array([1, 2]), forces, np.array([7]), WHERE)
    assert summed[0, 0, 0] == 1e8 + 1


def corner_case(inside, seed=0):
    """A 90 degree corner at (20, 20) with legs along +x and +y; the side lies inside the angle or around it."""
    model = plate()
    line = line_through(
        model, [(40, 20), (30, 20), (20, 20), (20, 30), (20, 40)], outward=(-1, -1, 0) if inside else (1, 1, 0)
    )
    centre = model.xyz[model.quads].mean(axis=1)
    within = (centre[:, 0] > 20) & (centre[:, 1] > 20)
    side = np.intersect1d(touching(model, line.node), np.flatnonzero(within if inside else ~within) + 1)
    return model, line, side, numbered(model, MODES, seed)


def element_at(model, x, y):
    """Element, from 1, with its centre at (x, y)."""
    return 1 + int(np.argmin(np.linalg.norm(model.xyz[model.quads].mean(axis=1)[:, :2] - [x, y], axis=1)))


def test_an_element_in_the_angle_is_shared_by_both_legs():
    """It has an edge on both parts: each gets half of its force at the corner."""
    _, line, side, forces = corner_case(inside=True)
    first, second = side_forces(split_at_kinks(line), side, forces, MODES, WHERE)
    (whole,) = side_forces((line,), side, forces, MODES, WHERE)
    np.testing.assert_allclose(first[-1], whole[2] / 2, rtol=1e-12)
    np.testing.assert_allclose(second[0], whole[2] / 2, rtol=1e-12)
    np.testing.assert_allclose(np.concatenate([first[:-1], second[1:]]), whole[[0, 1, 3, 4]], rtol=1e-12)


def test_elements_around_a_corner_go_to_the_nearer_leg():
    """Of the three around a corner, those along a leg belong to it and the one between them is shared."""
    model, line, side, forces = corner_case(inside=False)
    first, second = side_forces(split_at_kinks(line), side, forces, MODES, WHERE)
    corner = line.node[2]
    along_x, along_y, between = element_at(model, 25, 15), element_at(model, 15, 25), element_at(model, 15, 15)
    for k, mode in enumerate(MODES):
        shared = row_sums(forces, [between], corner, mode) / 2
        np.testing.assert_allclose(first[-1, k], row_sums(forces, [along_x], corner, mode) + shared, rtol=1e-9)
        np.testing.assert_allclose(second[0, k], row_sums(forces, [along_y], corner, mode) + shared, rtol=1e-9)


def test_an_element_apart_from_the_fan_is_shared():
    """An element that touches the corner alone, without a way to either leg, is shared half and half."""
    model, line, side, forces = corner_case(inside=False)
    side = np.setdiff1d(side, [element_at(model, 15, 25), element_at(model, 25, 15)])
    lone = np.setdiff1d(side, [element_at(model, 15, 35), element_at(model, 35, 15)])
    first, second = side_forces(split_at_kinks(line), side, forces, MODES, WHERE)
    for k, mode in enumerate(MODES):
        np.testing.assert_allclose(first[-1, k], row_sums(forces, lone, line.node[2], mode) / 2, rtol=1e-9)
    np.testing.assert_allclose(first[-1], second[0], rtol=1e-12)


def test_an_unequal_fan():
    """With four elements between the legs each leg gets two, whatever their size."""
    angle = np.radians([0, 20, 90, 250, 270])
    spokes = 10 * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    quads = np.array([[0, 1 + k, 6 + k, 2 + k] for k in range(4)])
    rows = [(node, element + 1) for element, quad in enumerate(quads) for node in quad]
    node, element = np.array(rows).T
    force = np.random.default_rng(0).normal(size=(16, 6))
    forces = ElementForces(np.full(16, 7), node, element, force)
    line = weld_line([spokes[0], [0, 0, 0], spokes[-1]], outward=(1, -1, 0), node=[1, 0, 5])
    first, second = side_forces(split_at_kinks(line), np.arange(1, 5), forces, np.array([7]), WHERE)
    np.testing.assert_allclose(first[-1, 0], row_sums(forces, [1, 2], 0, 7), rtol=1e-12)
    np.testing.assert_allclose(second[0, 0], row_sums(forces, [3, 4], 0, 7), rtol=1e-12)


@given(st.booleans(), st.integers(0, 100))
@settings(deadline=None, max_examples=15)
def test_parts_add_up_to_the_whole(inside, seed):
    """Inside and around a corner, the parts of a split line together carry what the whole line carries."""
    _, line, side, forces = corner_case(inside, seed)
    parts = side_forces(split_at_kinks(line), side, forces, MODES, WHERE)
    (whole,) = side_forces((line,), side, forces, MODES, WHERE)
    np.testing.assert_allclose(sum(part.sum(axis=0) for part in parts), whole.sum(axis=0), rtol=1e-9, atol=1e-7)


def test_a_closed_square_is_split_into_its_sides():
    """Around a square hole every side gets its own elements, half of those at its corners, and nothing is lost."""
    model = plate(6, 6)
    points = [(20, 20), (30, 20), (40, 20), (40, 30), (40, 40), (30, 40), (20, 40), (20, 30)]
    line = line_through(model, points, outward=[(30 - x, 30 - y, 0) for x, y in points], closed=True)
    centre = model.xyz[model.quads].mean(axis=1)
    hole = (np.abs(centre[:, :2] - 30) < 10).all(axis=1)
    side = np.setdiff1d(touching(model, line.node), np.flatnonzero(hole) + 1)
    forces = numbered(model, MODES)
    parts = side_forces(split_at_kinks(line), side, forces, MODES, WHERE)
    (whole,) = side_forces((line,), side, forces, MODES, WHERE)
    assert [part.shape for part in parts] == [(3, 2, 6)] * 4
    np.testing.assert_allclose(np.sum(parts, axis=(0, 1)), whole.sum(axis=0), rtol=1e-9, atol=1e-7)
    np.testing.assert_allclose(parts[3][-1] + parts[0][0], whole[0], rtol=1e-9)


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (
            lambda rows, side: (rows, np.append(side, [98, 99])),
            (
                "forces.csv, weld W1: element 98 (and 1 more) of the assessed side has no forces. "
                "Request the element forces of the whole side."
            ),
        ),
        (
            lambda rows, side: (rows, side[:1]),
            (
                "forces.csv, weld W1: no element of the assessed side touches node 113 (and 1 more) of the line. "
                "Complete weld_elements."
            ),
        ),
        (
            lambda rows, side: (rows.rows((rows.node != 112) | (rows.mode != 3) | (rows.element != side[0])), side),
            (
                "forces.csv, weld W1, element 5, node 112, mode 3: no row of element forces. "
                "Request the forces of every mode."
            ),
        ),
        (
            lambda rows, side: (rows.rows(rows.mode != 3), side),
            (
                "forces.csv, weld W1, element 5, node 112, mode 3: no row of element forces (and 5 more). "
                "Request the forces of every mode."
            ),
        ),
        (
            lambda rows, side: (rows.rows(np.repeat(np.arange(rows.node.size), 2)), side),
            (
                "forces.csv, weld W1, element 5, node 112, mode 7: more than one row of element forces "
                "(and 11 more). Keep one row per mode, element and node."
            ),
        ),
    ],
)
def test_refusals(spoil, message):
    """Missing elements, nodes and rows and repeated rows are refused with their place and the remedy."""
    model = plate()
    line = line_through(model, [(20, 10), (20, 20), (20, 30)], outward=(1, 0, 0))
    side = np.array([e for e in touching(model, line.node) if model.xyz[model.quads[e - 1], 0].mean() < 20])
    forces, elements = spoil(numbered(model, MODES).of(side), side)
    with pytest.raises(DataError) as caught:
        side_forces((line,), elements, forces, MODES, WHERE)
    assert message == str(caught.value)
