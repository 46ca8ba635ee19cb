"""Columns of solid faces collapse to the consistent forces of the line: any traction, uneven layers, any order."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.weld.line import LineStack, WeldLine, stacked
from fatigue.weld.line_load import line_load, line_load_matrix
from fatigue.weld.solid.columns import Columns, SolidWeld, collapsed, columns_at, columns_of, unfolded
from fatigue.weld.structural_stress import assess_line

GAUSS, WEIGHT = np.polynomial.legendre.leggauss(8)


def face(s, z, traction, quadratic):
    """Nodes (N, 2) of a meshed face, station of each, and the consistent forces, (N,), of a traction(s, z) on it."""
    at, force, station = {}, [], []
    if quadratic:
        half = lambda x: np.insert(x.astype(float), range(1, len(x)), (x[1:] + x[:-1]) / 2)  # noqa: E731
        s, z = half(s), half(z)
    step = 2 if quadratic else 1
    for i in range(len(s)):
        for k in range(len(z)):
            if not (quadratic and i % 2 and k % 2):  # a face of 8 nodes has none in its middle
                at[i, k] = len(station)
                station.append(i)
                force.append(0.0)
    for i in range(0, len(s) - 1, step):
        for k in range(0, len(z) - 1, step):
            for u, a in zip(GAUSS, WEIGHT, strict=True):
                for v, b in zip(GAUSS, WEIGHT, strict=True):
                    w, h = (s[i + step] - s[i]) / 2, (z[k + step] - z[k]) / 2
                    load = a * b * w * h * traction(s[i] + w * (1 + u), z[k] + h * (1 + v))
                    for (p, q), value in shapes(u, v, quadratic).items():
                        force[at[i + p, k + q]] += value * load
    nodes = sorted(at, key=at.get)
    return np.array([(s[i], z[k]) for i, k in nodes]), np.array(station), np.array(force)


def shapes(u, v, quadratic):
    """Shape functions of a face by the place of the node."""
    corner = {(p, q): (1 + x * u) * (1 + y * v) / 4 for p, x in ((0, -1), (1, 1)) for q, y in ((0, -1), (1, 1))}
    if not quadratic:
        return corner
    sign = {0: -1, 2: 1}
    found = {(2 * p, 2 * q): n * (sign[2 * p] * u + sign[2 * q] * v - 1) for (p, q), n in corner.items()}
    found |= {(1, q): (1 - u * u) * (1 + sign[q] * v) / 2 for q in (0, 2)}
    return found | {(p, 1): (1 + sign[p] * u) * (1 - v * v) / 2 for p in (0, 2)}


def line_and_columns(place, station, quadratic, thickness):
    """Line along x at mid-thickness, and its columns, of nodes (N, 2) at (s, z)."""
    n = station.max() + 1
    s = np.array([place[station == i, 0][0] for i in range(n)])
    xyz = np.column_stack([place[:, 0], 0 * place[:, 0], place[:, 1]])
    size = np.bincount(station)
    order = np.argsort(station, kind="stable")
    begin = np.append(0, np.cumsum(size))
    node = 100 + order
    line = WeldLine(
        weld="toe",
        part=1,
        order=np.arange(n),
        node=node[begin[1:] - 1],
        xyz=np.column_stack([s, 0 * s, 0 * s]),
        thickness=np.full(n, thickness),
        normal=np.tile([0.0, 0, 1], (n, 1)),
        outward=np.tile([0.0, 1, 0], (n, 1)),
        edge_mid=(np.arange(n) % 2 == 1) if quadratic else np.zeros(n, dtype=bool),
        closed=False,
        end_length=0.0,
    )
    return line, Columns(begin, node, xyz[order]), order


def resultants(line, sigma, t, degree):
    """Consistent nodal values, (n,), of int sigma dz and of int z sigma dz on the line, by quadrature edge by edge."""
    point, weight = np.polynomial.legendre.leggauss(degree)
    matrix, s = np.zeros((2, line.node.size)), line.xyz[:, 0]
    corner = np.flatnonzero(~line.edge_mid)
    for a, b in pairwise(corner):
        for xi, w in zip(point, weight, strict=True):
            here = s[a] + (s[b] - s[a]) * (1 + xi) / 2
            linear, parabolic = [(1 - xi) / 2, (1 + xi) / 2], [xi * (xi - 1) / 2, 1 - xi * xi, xi * (xi + 1) / 2]
            shape = linear if b - a == 1 else parabolic
            z = t / 2 * point
            values = np.array([sigma(here, one) for one in z])
            f, m = t / 2 * weight @ values, t / 2 * weight @ (z * values)
            for k, value in enumerate(shape):
                matrix[:, a + k] += np.array([f, m]) * value * w * (s[b] - s[a]) / 2
    return matrix


cuts = st.lists(st.floats(0.1, 10.0), min_size=1, max_size=4)


@settings(max_examples=30, deadline=None)
@given(along=cuts, through=cuts, numbers=st.lists(st.floats(-2, 2), min_size=12, max_size=12), quadratic=st.booleans())
def test_a_column_is_the_consistent_force_of_any_traction(along, through, numbers, quadratic):
    """Arbitrary sigma(s, z), any uneven layers: the collapsed forces are those of the line, to round-off."""
    s, z = np.append(0.0, np.cumsum(along)), np.append(0.0, np.cumsum(through))
    t = z[-1]
    z -= t / 2
    length = s[-1]

    def sigma(at_s, at_z):
        return sum(c * (at_s / length) ** (i % 4) * (2 * at_z / t) ** (i // 4) for i, c in enumerate(numbers))

    place, station, force = face(s, z, sigma, quadratic)
    line, columns, order = line_and_columns(place, station, quadratic, t)
    nodal = np.zeros((len(force), 1, 6))
    nodal[:, 0, 1] = force[order]
    found = collapsed(columns, line.xyz, nodal)[:, 0]
    f, m = resultants(line, sigma, t, 12)
    assert np.abs(found[:, 1] - f).max() < 1e-12 * (1 + t * length)
    assert np.abs(found[:, 3] + m).max() < 1e-12 * (1 + t * t * length)
    assert np.abs(found[:, [0, 2, 4, 5]]).max() < 1e-12 * (1 + t * t * length)


@pytest.mark.parametrize("quadratic", [False, True])
def test_stress_of_a_linear_traction_is_exact(quadratic):
    """Membrane 3 + s, bending 2 - s at the top: read back at every station, from three uneven layers."""
    t = 8.0
    s, z = np.array([0.0, 2, 3, 7]), np.array([-4.0, -3, 1, 4])
    place, station, force = face(s, z, lambda x, y: 3 + x + (2 - x) * y / 4, quadratic)
    line, columns, order = line_and_columns(place, station, quadratic, t)
    nodal = np.zeros((len(force), 1, 6))
    nodal[:, 0, 1] = force[order]
    found = assess_line(line, collapsed(columns, line.xyz, nodal)).raw
    assert np.allclose(found.membrane[:, 0], 3 + line.xyz[:, 0], rtol=0, atol=1e-11)
    assert np.allclose(found.bending[:, 0], 2 - line.xyz[:, 0], rtol=0, atol=1e-11)


def random_columns(seed):
    """A line of five stations with columns of two to four nodes, forces with moments, three modes."""
    rng = np.random.default_rng(seed)
    size = rng.integers(2, 5, 5)
    begin = np.append(0, np.cumsum(size))
    station = np.repeat(np.arange(5), size)
    place = np.column_stack([station * 3.0, np.concatenate([np.linspace(-4, 4, k) for k in size])])
    line, columns, _ = line_and_columns(place, station, False, 8.0)
    return line, columns, rng.normal(size=(begin[-1], 3, 6)), rng


def test_rotating_the_model_rotates_nothing_that_is_read():
    """Stress stays, whatever the orientation and place of the model in space."""
    line, columns, forces, rng = random_columns(1)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turn *= np.linalg.det(turn)
    moved = rng.normal(size=3) * 100
    there = replace(line, xyz=line.xyz @ turn.T + moved, normal=line.normal @ turn.T, outward=line.outward @ turn.T)
    rotated = np.concatenate([forces[..., :3] @ turn.T, forces[..., 3:] @ turn.T], axis=-1)
    at = replace(columns, xyz=columns.xyz @ turn.T + moved)
    ours = assess_line(line, collapsed(columns, line.xyz, forces)).raw
    theirs = assess_line(there, collapsed(at, there.xyz, rotated)).raw
    assert np.allclose(ours.membrane, theirs.membrane, atol=1e-11)
    assert np.allclose(ours.bending, theirs.bending, atol=1e-11)


def test_order_within_a_column_and_names_of_nodes_do_not_matter():
    """Nodes of a column in any order, under any numbers, give the same force."""
    line, columns, forces, rng = random_columns(2)
    mixed = np.concatenate([rng.permutation(np.arange(a, b)) for a, b in pairwise(columns.begin)])
    other = Columns(columns.begin, columns.node[mixed] + 7, columns.xyz[mixed])
    assert np.allclose(
        collapsed(columns, line.xyz, forces), collapsed(other, line.xyz, forces[mixed]), rtol=1e-13, atol=1e-13
    )


def test_splitting_a_layer_keeps_force_and_moment():
    """One layer or two under the same linear traction: the same forces on the line."""
    found = []
    for z in ([-4.0, 4], [-4.0, 1, 4]):
        place, station, force = face(np.array([0.0, 5, 7]), np.array(z), lambda x, y: 1 + x * y, False)
        line, columns, order = line_and_columns(place, station, False, 8.0)
        nodal = np.zeros((len(force), 1, 6))
        nodal[:, 0, 1] = force[order]
        found.append(collapsed(columns, line.xyz, nodal))
    assert np.allclose(*found, atol=1e-12)


def test_columns_of_a_stack_with_a_shell_line_among_solid_ones():
    """A shell station is a column of its own node, and its forces come back bit for bit."""
    line, columns, forces, rng = random_columns(3)
    shell = replace(line, weld="shell", xyz=line.xyz + 50.0, node=line.node + 1000)
    lines: LineStack = stacked([shell, line])
    along = np.argsort(line.node)
    sizes = np.diff(columns.begin)[along]
    rows = np.concatenate([np.arange(columns.begin[i], columns.begin[i + 1]) for i in along])
    weld = SolidWeld(line.node[along], Columns(np.append(0, np.cumsum(sizes)), columns.node[rows], columns.xyz[rows]))
    assert np.array_equal(columns_at(line, weld).node, columns.node)
    together = columns_of(lines, {"toe": weld})
    loaded = unfolded(lines, together)
    assert np.array_equal(loaded.node, np.append(shell.node, columns.node))
    assert loaded.begin.tolist() == [0, 5, 5 + columns.node.size]
    assert loaded.weld == ("shell", "toe")
    of_shell = rng.normal(size=(5, 3, 6))
    found = collapsed(together, lines.xyz, np.concatenate([of_shell, forces]))
    assert np.array_equal(found[:5], of_shell)
    assert np.array_equal(found[5:], collapsed(columns, line.xyz, forces))


def test_single_precision_forces_are_summed_in_double():
    """Forces of a column in bending all but cancel: what is left has the precision of double sums."""
    columns = Columns(np.array([0, 3]), np.arange(3), np.array([[0, 0, -1.0], [0, 0, 0], [0, 0, 1.0]]))
    forces = np.zeros((3, 1, 6), np.float32)
    forces[:, 0, 1] = [1e7, 1.0, -1e7]
    assert collapsed(columns, np.zeros((1, 3)), forces)[0, 0, 1] == 1.0


def test_line_load_of_collapsed_forces_is_that_of_the_matrix():
    """``A f = F`` takes collapsed forces as it takes those of shells."""
    line, columns, forces, _ = random_columns(4)
    nodal = collapsed(columns, line.xyz, forces)
    assert np.allclose(np.einsum("ij,jmc->imc", line_load_matrix(line).toarray(), line_load(line, nodal)), nodal)
