"""Free interface with residual attachment: complete under every column of load, whatever the cut and the support."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.flexbody.condensation.completeness import flexibility_ratio
from fatigue.flexbody.condensation.free_interface import free_interface, shared_load
from fatigue.flexbody.condensation.orthonormal import orthonormal
from fatigue.flexbody.factor import FreeBody, factored, free_body
from fatigue.vehicle.frame_body import frame_structure, node_at
from tests.spring_body import NODES, SEEDS, elastic_modes, spring_body


@settings(max_examples=12)
@given(SEEDS, NODES, st.integers(1, 4), st.integers(1, 4))
def test_static_answer_is_exact_under_the_loads(seed, nodes, modes, columns):
    """Modes kept and residuals give the inertia-relief answer under each column, everywhere in the body."""
    body = free_body(spring_body(seed, nodes))
    F = np.random.default_rng(seed).standard_normal((3 * nodes, columns))
    basis = orthonormal(body.structure, free_interface(body, F, count=modes), np.inf).basis
    x = (basis.shapes / (2 * np.pi * basis.frequency) ** 2) @ (basis.shapes.T @ F)
    assert x == pytest.approx(body.elastic(F), abs=1e-8 * abs(x).max())
    assert flexibility_ratio(body, basis, F) == pytest.approx(np.ones(columns), rel=1e-8)


@settings(max_examples=12)
@given(SEEDS, NODES, st.integers(1, 4))
def test_modes_kept_are_exact(seed, nodes, modes):
    """Normal modes come out of the reduced body as they are; residuals lie above them."""
    S = spring_body(seed, nodes)
    F = np.random.default_rng(seed).standard_normal((3 * nodes, 2))
    hz, _ = elastic_modes(S)
    cut = (hz[modes - 1] + hz[modes]) / 2
    basis = orthonormal(S, free_interface(free_body(S), F, upto_hz=cut), cut).basis
    assert basis.normal.tolist() == [True] * modes + [False] * (len(basis.normal) - modes)
    assert basis.frequency[:modes] == pytest.approx(hz[:modes], rel=1e-8)
    assert basis.shapes.T @ (S.M @ basis.shapes) == pytest.approx(np.eye(len(basis.normal)), abs=1e-8)
    assert (basis.frequency[modes:] >= hz[modes] * (1 - 1e-9)).all()


@settings(max_examples=12)
@given(SEEDS, NODES)
def test_all_modes_leave_nothing(seed, nodes):
    """With all modes of the body, loads add no shape: rounding is none."""
    body = free_body(spring_body(seed, nodes))
    found = orthonormal(body.structure, free_interface(body, np.eye(3 * nodes)[:, :4], count=3 * nodes - 6), np.inf)
    assert (len(found.basis.frequency), found.dependent) == (3 * nodes - 6, 4)


@settings(max_examples=12)
@given(SEEDS, NODES, st.permutations(range(6)))
def test_any_determinate_support_gives_the_same(seed, nodes, order):
    """Three nodes held by 3, 2 and 1 displacements, whichever they are: the support bears nothing."""
    S = spring_body(seed, nodes)
    body = free_body(S)
    a, b, c = order[:3]
    rng = np.random.default_rng(seed)
    at = S.xyz[::3]
    line = at[b] - at[a]
    second = np.argsort(abs(line))[:2]  # across the line as well as may be
    normal = np.cross(line, at[c] - at[a])
    rows = [3 * a, 3 * a + 1, 3 * a + 2, *(3 * b + second), 3 * c + int(np.argmax(abs(normal)))]
    held = np.zeros(3 * nodes, dtype=bool)
    held[rows] = True
    F = rng.standard_normal((3 * nodes, 3))
    other = FreeBody(S, factored(S, held), body.rigid)
    x = body.elastic(F)
    assert other.elastic(F) == pytest.approx(x, abs=1e-7 * abs(x).max())


@pytest.mark.parametrize(
    "rows",
    [[(0, 0, 0), (0, 0, 1), (0, 0, 2), (0, 0, 3), (0, 0, 4), (0, 0, 5)],
     [(7, 2, 0), (7, 2, 1), (7, 2, 2), (-7, 10, 1), (-7, 10, 2), (3, 6, 1)],
     [(5, 2, 0), (5, 2, 1), (5, 2, 2), (-5, 2, 1), (5, 10, 2), (-2, 6, 4)]],
)  # fmt: skip
def test_frame_held_anywhere(rows):
    """One node clamped, corners, or a rotation of the roof: the frame body answers alike to rounding."""
    S = frame_structure()
    body = free_body(S)
    held = np.zeros(1080, dtype=bool)
    held[[6 * node_at(s, k) + d for s, k, d in rows]] = True
    F = np.column_stack([shared_load(S, [node_at(1, 2)], d) for d in range(6)])
    x = body.elastic(F)
    other = FreeBody(S, factored(S, held), body.rigid).elastic(F)
    assert other == pytest.approx(x, abs=1e-8 * abs(x).max())


def test_shared_load_is_a_mean_of_nodes():
    """Evenly, or by shares; the work-conjugate motion is the mean by the same shares."""
    S = spring_body(1, 6)
    F = shared_load(S, [2, 4, 5], 1)
    assert F[[4, 10, 13]].tolist() == pytest.approx([1 / 3] * 3)
    assert F.sum() == pytest.approx(1.0)
    weighed = shared_load(S, [2, 4], 2, [1.0, 3.0])
    assert weighed[[5, 11]].tolist() == [0.25, 0.75]
    assert np.count_nonzero(weighed) == 2
    twice = shared_load(S, [2, 2, 4], 0)
    assert twice[3] == pytest.approx(2 / 3)


def test_a_shared_load_is_exact_and_a_part_of_it_is_not():
    """A pattern in the columns is complete as a pattern; a force on one of its nodes alone is not in the span."""
    S = frame_structure()
    body = free_body(S)
    edge = [node_at(1, k) for k in (1, 2, 3)]
    pattern = shared_load(S, edge, 2)
    basis = orthonormal(S, free_interface(body, pattern[:, None], upto_hz=20.0), 20.0).basis
    asked = np.column_stack([pattern, *(shared_load(S, [node], 2) for node in edge)])
    ratio = flexibility_ratio(body, basis, asked)
    assert ratio[0] == pytest.approx(1.0, rel=1e-9)
    assert (ratio[1:] < 0.99).all()


def test_moments_are_loads_as_well():
    """A unit moment at a node is a column like any other."""
    S = frame_structure()
    body = free_body(S)
    F = np.column_stack([shared_load(S, [node_at(2, 4)], d) for d in (3, 4, 5)])
    basis = orthonormal(S, free_interface(body, F, upto_hz=20.0), 20.0).basis
    assert flexibility_ratio(body, basis, F) == pytest.approx(np.ones(3), rel=1e-9)


def test_bad_loads_are_refused():
    """A node that is none, a direction it has not, no nodes, no share."""
    S = spring_body(1, 6)
    with pytest.raises(ValueError, match="node 99 has no degree of freedom x"):
        shared_load(S, [1, 99], 0)
    with pytest.raises(ValueError, match="node 1 has no degree of freedom rz"):
        shared_load(S, [1], 5)
    for nodes, share in (([], None), ([1, 2], [1.0, -1.0])):
        with pytest.raises(ValueError, match="a node that bears it"):
            shared_load(S, nodes, 0, share)
