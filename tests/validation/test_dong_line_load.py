"""The consistent line load of Dong's method against closed forms.

Sources: Dong, Int. J. Fatigue 23 (2001) 865; Dong & Hong 2003; ASME VIII-2 Annex 5-A for the linear edge. The numbers
are those of the line integrals themselves.
"""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from fatigue.weld.line_geometry import arc_length, edge_nodes, edge_points, length
from fatigue.weld.line_load import line_load, line_load_matrix, treat_ends
from tests.naive_weld import edge_functions, edge_list
from tests.weld_lines import ring, straight

GAUSS, WEIGHT = np.polynomial.legendre.leggauss(30)


def work_equivalent(line, load):
    """Nodal forces int N_i f ds of a line load f(s), given as a function of arc length on straight lines."""
    nodal = np.zeros(line.node.size)
    s = arc_length(line)
    for edge in edge_list(line):
        shape, _, speed = edge_functions(line, edge)
        ds = WEIGHT * np.array([speed(xi) for xi in GAUSS])
        at = s[edge[0]] + (GAUSS + 1) / 2 * ds.sum()
        for node, N in zip(edge, shape, strict=True):
            nodal[node] += np.sum(N(GAUSS) * load(at) * ds)
    return nodal


def tributary(line):
    """Half the lengths of the edges at each node."""
    return np.asarray(line_load_matrix(line).sum(axis=1)).ravel()


def marked(line):
    """Mark every other node as a mid-side node."""
    return replace(line, edge_mid=np.arange(line.node.size) % 2 == 1)


@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("parabolic", [False, True])
def test_constant_load_on_random_spacing(closed, parabolic):
    """The load 7 comes out everywhere, also beside an edge of 1e-4 among edges of 1 to 5 mm."""
    steps = np.random.default_rng(1).uniform(1, 5, 12)
    steps[5] = 1e-4
    if parabolic:
        steps = np.repeat(steps, 2)
    if closed:
        angle = 2 * np.pi * np.concatenate([[0.0], np.cumsum(steps)[:-1]]) / steps.sum()
        line = ring(angle.size)
        line = replace(line, xyz=50 * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle]))
    else:
        line = straight(steps)
    line = marked(line) if parabolic else line
    np.testing.assert_allclose(line_load(line, 7 * tributary(line)), 7, rtol=1e-11)


def test_linear_load_on_linear_edges():
    """The load s at spacing 1, 3, 0.5, 2, 4 is exact; tributary lengths are not."""
    line = straight([1, 3, 0.5, 2, 4])
    nodal = work_equivalent(line, lambda s: s)
    np.testing.assert_allclose(line_load(line, nodal), [0, 1, 4, 4.5, 6.5, 10.5], rtol=1e-11, atol=1e-11)
    wrong = [0.3333, 1.6667, 3.1667, 5, 7.1667, 9.1667]
    np.testing.assert_allclose(nodal / tributary(line), wrong, rtol=2e-4)


def test_quadratic_load_on_parabolic_edges():
    """Linear and quadratic loads are exact on parabolic edges of any length."""
    line = marked(straight([1, 1, 3, 3, 0.5, 0.5]))
    for load in (lambda s: s, lambda s: 3 - 2 * s + s**2):
        expected = load(arc_length(line))
        np.testing.assert_allclose(line_load(line, work_equivalent(line, load)), expected, rtol=1e-10, atol=1e-10)


@pytest.mark.parametrize(
    ("steps", "load", "nodal", "divided"),
    [
        ([10, 10], [100, 100, 100], [500, 1000, 500], [100, 100, 100]),
        ([10, 10], [0, 50, 100], [83.3333, 500, 416.6667], [16.667, 50, 83.333]),
        ([5, 10, 20], [10, 40, -20, 60], [50, 175, 66.6667, 333.3333], [20, 23.333, 4.444, 33.333]),
    ],
)
def test_hand_computed_lines(steps, load, nodal, divided):
    """Three lines by hand; on the third, division by tributary lengths reads the hot end 44 % low."""
    line = straight(steps)
    np.testing.assert_allclose(line_load_matrix(line) @ np.array(load), nodal, rtol=1e-6)
    np.testing.assert_allclose(line_load(line, np.array(nodal)), load, atol=1e-4)
    np.testing.assert_allclose(np.array(nodal) / tributary(line), divided, rtol=1e-3)


@pytest.mark.parametrize(("n", "amplitude"), [(8, 1.0523869), (12, 1.0230490)])
def test_cosine_on_a_ring(n, amplitude):
    """On n equal edges the linear line load of cos(theta) has a closed-form amplitude."""
    line = ring(n)
    h = 2 * np.pi / n
    theta = h * np.arange(n)
    edge = length(line) / n
    nodal = np.cos(theta) * edge * 2 * (1 - np.cos(h)) / h**2  # int N cos over the two edges of a node
    np.testing.assert_allclose(line_load(line, nodal), amplitude * np.cos(theta), atol=1e-7)
    assert amplitude == pytest.approx((2 * (1 - np.cos(h)) / h**2) / ((2 + np.cos(h)) / 3), rel=1e-7)


@pytest.mark.parametrize(("parabolic", "coarse", "fine"), [(False, 0.0320, 0.00788), (True, 1.672e-3, 1.314e-4)])
def test_order_of_convergence(parabolic, coarse, fine):
    """The load sin(2 pi s) + 0.3 cos(5 pi s): the error falls with order 2 on linear, about 4 on parabolic edges."""
    errors = []
    for n in (16, 32):
        line = marked(straight(np.full(2 * n, 0.5 / n))) if parabolic else straight(np.full(n, 1 / n))
        nodal = work_equivalent(line, lambda s: np.sin(2 * np.pi * s) + 0.3 * np.cos(5 * np.pi * s))
        assert nodal.sum() == pytest.approx(0, abs=1e-12)
        assert nodal @ arc_length(line) == pytest.approx(-0.161586651, abs=1e-9)
        s = arc_length(line)
        exact = np.sin(2 * np.pi * s) + 0.3 * np.cos(5 * np.pi * s)
        errors.append(np.abs(line_load(line, nodal) - exact).max())
    np.testing.assert_allclose(errors, [coarse, fine], rtol=5e-3)


def test_a_step_at_a_node():
    """A jump of the traction reads 0.5 at its node and 13.4 % too much beside it: why lines are split at kinks."""
    line = straight([1.0] * 20)
    nodal = np.r_[0.5, np.ones(9), 0.5, np.zeros(10)]
    load = line_load(line, nodal)
    np.testing.assert_allclose(load[9:12], [1.1340, 0.5, -0.1340], atol=1e-4)
    np.testing.assert_allclose(load[12] / load[11], -0.268, atol=1e-3)


def test_a_singular_end():
    """For f = s^-1/2 on [0, 10] the plain end value grows without bound, its mean over [0, 1] tends to 2."""
    raw, treated = [], []
    for edge in (1.0, 0.5, 0.25, 0.125):
        line = straight(np.full(round(10 / edge), edge), end_length=1.0)
        s = arc_length(line)
        # int N_i s^-1/2 ds from the antiderivatives 2 s^1/2 and 2/3 s^3/2
        whole, first = 2 * np.diff(np.sqrt(s)), 2 / 3 * np.diff(s**1.5)
        right = (first - s[:-1] * whole) / edge
        load = line_load(line, np.r_[whole - right, 0] + np.r_[0, right])
        raw.append(load[0])
        treated.append(treat_ends(line, load).value[0])
    np.testing.assert_allclose(raw, [3.74, 5.29, 7.48, 10.58], rtol=2e-3)
    assert np.all(np.abs(np.array(treated[1:]) - 2) < 0.1)
    assert abs(treated[-1] - 2) < 0.02


def test_parabolic_forces_divided_by_tributary_lengths():
    """A constant load reads 0.667 and 1.333 in turn when parabolic forces are divided by half-edge lengths."""
    line = straight([1.0] * 8)
    nodal = tributary(marked(line))
    np.testing.assert_allclose(nodal[1:-1] / tributary(line)[1:-1], [4 / 3, 2 / 3] * 3 + [4 / 3], rtol=1e-12)


def test_conditioning():
    """Scaled to a unit diagonal, A has eigenvalues in [0.5, 1.5] (linear) and [0.5, 1.25] (parabolic)."""
    steps = np.random.default_rng(2).uniform(0.01, 5, 30)
    for line, upper in ((straight(steps), 1.5), (marked(straight(np.repeat(steps, 2))), 1.25)):
        A = line_load_matrix(line).toarray()
        scale = np.sqrt(np.diag(A))
        eigenvalues = np.linalg.eigvalsh(A / np.outer(scale, scale))
        assert eigenvalues.min() >= 0.5 - 1e-12
        assert eigenvalues.max() <= upper + 1e-12


@pytest.mark.parametrize(("parabolic", "column"), [(False, 2), (True, 3)])
def test_solid_faces_collapse_to_the_line(parabolic, column):
    """Forces of 8- and 20-node brick faces, summed over the thickness, are the line's own work-equivalent forces.

    The stress is a polynomial in z of any order times one in s that the line can represent; three uneven layers.
    """
    stations = np.array([0.0, 2.0, 5.0, 6.0])
    layers = np.array([-5.0, -2.0, 1.5, 5.0])
    rng = np.random.default_rng(3)
    along, through = rng.normal(size=column), rng.normal(size=5)

    def sigma(s, z):
        return np.polynomial.polynomial.polyval(s, along) * np.polynomial.polynomial.polyval(z, through)

    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    middles = np.array([[0, -1], [1, 0], [0, 1], [-1, 0]])
    places = np.concatenate([corners, middles]) if parabolic else corners
    xi, zeta = (grid.ravel() for grid in np.meshgrid(GAUSS, GAUSS))
    weight = np.outer(WEIGHT, WEIGHT).ravel()
    force, moment = {}, {}
    for s0, s1 in pairwise(stations):
        for z0, z1 in pairwise(layers):
            s, z = (s0 + s1) / 2 + xi * (s1 - s0) / 2, (z0 + z1) / 2 + zeta * (z1 - z0) / 2
            traction = sigma(s, z) * weight * (s1 - s0) * (z1 - z0) / 4
            for N, (a, b) in zip(_face_shape(xi, zeta, parabolic), places, strict=True):
                key = (s0 + s1) / 2 + a * (s1 - s0) / 2
                height = (z0 + z1) / 2 + b * (z1 - z0) / 2
                force[key] = force.get(key, 0) + N @ traction
                moment[key] = moment.get(key, 0) + height * (N @ traction)
    at = np.array(sorted(force))
    line = straight(np.diff(at))
    line = marked(line) if parabolic else line
    nodal = np.array([[force[key], moment[key]] for key in at])
    profile = 5 * WEIGHT * np.polynomial.polynomial.polyval(5 * GAUSS, through)
    lever = [profile.sum(), profile @ (5 * GAUSS)]
    expected = np.outer(np.polynomial.polynomial.polyval(at, along), lever)
    np.testing.assert_allclose(line_load(line, nodal), expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())


def _face_shape(xi, zeta, parabolic):
    """Shape functions of a 4-node or an 8-node serendipity face."""
    corners = [(1 + a * xi) * (1 + b * zeta) / 4 for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    if not parabolic:
        return corners
    signs = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    corners = [N * (a * xi + b * zeta - 1) for N, (a, b) in zip(corners, signs, strict=True)]
    middles = [
        (1 - xi**2) * (1 - zeta) / 2,
        (1 + xi) * (1 - zeta**2) / 2,
        (1 - xi**2) * (1 + zeta) / 2,
        (1 - xi) * (1 - zeta**2) / 2,
    ]
    return [*corners, *middles]


def test_a_linear_edge_has_its_middle_in_the_centre():
    """The one-formula treatment of both kinds of edge rests on this."""
    line = straight([1, 3, 2, 2], edge_mid=[0, 0, 0, 1, 0])
    assert edge_nodes(line)[:, 1].tolist() == [-1, -1, 3]
    np.testing.assert_allclose(edge_points(line)[:, 1, 0], [0.5, 2.5, 6.0], rtol=1e-14)
