"""Factors of K, and the free body held at six rows: what it answers, and what is refused with its place."""

import dataclasses

import numpy as np
import pytest
from scipy import sparse

from fatigue.errors import DataError
from fatigue.flexbody.factor import FreeBody, factored, free_body, support
from fatigue.flexbody.mass import rigid_motions
from fatigue.flexbody.shell import structure
from fatigue.flexbody.structure import Structure
from tests.flexbody.shells import plate, together, tube


@pytest.fixture(scope="module")
def body():
    """A half tube of warped quads."""
    return structure(tube(6, 5, twist=0.2))


def test_factors_solve(body):
    """K u = f on the free rows, 0 on those held."""
    held = body.xyz[:, 0] == 0.0
    loads = np.random.default_rng(0).normal(size=(len(held), 3))
    u = factored(body, held).solve(loads)
    assert not u[held].any()
    np.testing.assert_allclose((body.K @ u)[~held], loads[~held], atol=1e-8)
    assert factored(body, np.ones_like(held)).solve(loads).tolist() == np.zeros_like(loads).tolist()


def test_inertia_relief(body):
    """Loads and inertia are in balance: K u = P' f, u orthogonal to rigid motions, whatever the support."""
    free = free_body(body)
    np.testing.assert_allclose(free.rigid.T @ (body.M @ free.rigid), np.eye(6), atol=1e-12)
    loads = np.random.default_rng(1).normal(size=(len(body.node), 2))
    u = free.elastic(loads)
    M_R = body.M @ free.rigid
    balanced = loads - M_R @ (free.rigid.T @ loads)
    np.testing.assert_allclose(body.K @ u, balanced, atol=1e-8)
    assert np.abs(M_R.T @ u).max() < 1e-12 * np.abs(u).max()
    at_the_end = np.flatnonzero((body.xyz[:, 0] == 400.0) & (body.node == body.node[-1]))
    held = np.zeros(len(body.node), dtype=bool)
    held[at_the_end] = True  # all six of one node
    other = FreeBody(body, factored(body, held), free.rigid).elastic(loads)
    np.testing.assert_allclose(other, u, atol=1e-8 * np.abs(u).max())


def test_support_holds_and_stresses_nothing(body):
    """Six displacements of firm rows far apart; no reaction under balanced loads."""
    rows = support(body)
    R = rigid_motions(body.xyz, body.direction)[rows]
    assert len(set(rows.tolist())) == 6
    assert (body.direction[rows] < 3).all()
    assert np.linalg.cond(R / [1, 1, 1, 100, 100, 100]) < 50.0
    free = free_body(body)
    u = free.elastic(np.random.default_rng(2).normal(size=(len(body.node), 1)))
    held = free.factor.solve(body.K @ u)
    assert np.abs((body.K @ held - body.K @ u)[rows]).max() < 1e-8 * np.abs(body.K @ u).max()


def beam_in_a_line():
    """A beam of two nodes along x: nodes on a line, which only rotations can hold about it."""
    EI, EA, GJ, L = 1e6, 1e5, 8e5, 100.0
    K = np.zeros((12, 12))
    K[np.ix_([0, 6], [0, 6])] = EA / L * np.array([[1, -1], [-1, 1]])
    K[np.ix_([3, 9], [3, 9])] = GJ / L * np.array([[1, -1], [-1, 1]])
    bend = EI / L**3 * np.array([[12, 6 * L, -12, 6 * L], [0, 4 * L**2, -6 * L, 2 * L**2], [0, 0, 12, -6 * L], [0] * 4])
    bend[3, 3] = 4 * EI / L
    bend = bend + np.triu(bend, 1).T
    for rows, sign in (([1, 5, 7, 11], 1), ([2, 4, 8, 10], -1)):
        turned = np.diag([1, sign, 1, sign])
        K[np.ix_(rows, rows)] = turned @ bend @ turned
    M = np.diag([1e-3] * 3 + [1.0] * 3 + [1e-3] * 3 + [1.0] * 3)
    xyz = np.repeat([[0.0, 0, 0], [L, 0, 0]], 6, axis=0)
    node, direction = np.repeat([1, 2], 6), np.tile(np.arange(6), 2)
    return Structure(sparse.csc_array(K), sparse.csc_array(M), node, direction, xyz)


def test_nodes_on_a_line_are_held_by_a_rotation():
    """Displacements cannot hold a beam about its own axis; a rotation does."""
    beam = beam_in_a_line()
    rows = support(beam)
    assert 3 in beam.direction[rows]
    moment = np.zeros((12, 1))
    moment[[3, 9], 0] = [-1.0, 1.0]
    assert free_body(beam).elastic(moment)[[3, 9], 0] == pytest.approx([-100.0 / 8e5 / 2, 100.0 / 8e5 / 2])


def at(body, **changes):
    """A structure with something changed."""
    return dataclasses.replace(body, **changes)


def entry(matrix, row, column, value):
    """A matrix with one value changed."""
    changed = matrix.tolil(copy=True)
    changed[row, column] = value
    return sparse.csc_array(changed)


def without_node(body, node):
    """K with a node whose mass nothing holds."""
    keep = sparse.diags_array((body.node != node).astype(float))
    return sparse.csc_array(keep @ body.K @ keep)


@pytest.mark.parametrize(
    ("change", "code", "said"),
    [
        (lambda b: at(b, K=entry(b.K, 3, 9, 1e9)), "not_symmetric", "K: node 1, rx with node 2, rx"),
        (lambda b: at(b, M=entry(b.M, 3, 9, 1e9)), "not_symmetric", "M: node 1, rx with node 2, rx"),
        (lambda b: at(b, K=entry(b.K, 6, 6, np.nan)), "bad_value", "K: node 2, x: nan is not finite"),
        (lambda b: at(b, K=b.K + sparse.diags_array(np.where(b.node == 5, 1e3, 0.0))), "grounded", "K: node 5"),
        (lambda b: at(b, node=b.node[::-1], xyz=b.xyz[::-1]), "grounded", "in their order"),
        (lambda b: at(b, M=b.M * 0.0), "no_mass", "M: the mass of the body against a rigid motion x is 0"),
        (lambda b: at(b, K=without_node(b, 7)), "grounded", "resists a rigid motion"),
    ],
    ids=["K", "M", "nan", "held", "rows", "no mass", "node"],
)
def test_no_free_body(body, change, code, said):
    """One line that names the place."""
    with pytest.raises(DataError) as error:
        free_body(change(body))
    assert [problem.code for problem in error.value.problems] == [code]
    assert said in str(error.value)


def test_two_parts_are_told_by_the_smaller():
    """Which node lies in it, and how many."""
    apart = structure(together(plate(4, 4), plate(2, 1), [1000.0, 0, 0]))
    with pytest.raises(DataError, match=r"node 1001: the body is in 2 parts .* has 6 of its nodes"):
        free_body(apart)


def test_a_hinge_is_told():
    """A plate held along one edge against displacements alone turns about it: a node that moves is named."""
    hinged = structure(plate(4, 3))
    edge = (hinged.xyz[:, 0] == 0.0) & (hinged.direction < 3)
    with pytest.raises(DataError, match="a part of the body moves freely here") as error:
        factored(hinged, edge)
    assert int(error.value.problems[0].where.split()[2].rstrip(",")) > 4  # none of those held
    with pytest.raises(DataError, match="a part of the body moves freely"):
        factored(hinged, np.zeros_like(edge))


def test_a_row_without_stiffness_is_told(body):
    """As an unused rotation of a node is."""
    empty = at(body, K=without_node(body, 20))
    with pytest.raises(DataError, match="node 20, x: its stiffness is 0, so nothing holds it"):
        factored(empty, body.xyz[:, 0] == 0.0)
