"""Modes by Lanczos iteration against dense matrices: none missed, none twice, orthogonal, the same bytes again."""

import dataclasses

import numpy as np
import pytest
from scipy import sparse
from scipy.linalg import eigh

from fatigue.errors import DataError, NumericalError
from fatigue.flexbody import modes
from fatigue.flexbody.factor import free_body
from fatigue.flexbody.modes import free_modes, held_modes, signed
from fatigue.flexbody.shell import structure
from tests.flexbody.shells import plate, tube


@pytest.fixture(scope="module")
def square():
    """A square plate, free, whose frequencies come in pairs, and all of them [Hz], rigid ones first."""
    body = structure(plate(6, 6, 400.0, 400.0))
    w2 = eigh(body.K.toarray(), body.M.toarray(), eigvals_only=True)
    return free_body(body), np.sqrt(np.maximum(w2, 0.0)) / (2 * np.pi)


@pytest.mark.parametrize("count", [1, 4, 5, 20, 150])
def test_lowest_modes_are_all_found(square, count):
    """So many as asked for, both of each pair, without rigid motions."""
    body, exact = square
    basis = free_modes(body, count=count)
    np.testing.assert_allclose(basis.frequency, exact[6 : 6 + count], rtol=1e-8)
    assert basis.normal.all()


@pytest.mark.parametrize("between", [(10, 11), (11, 12), (17, 18), (39, 40)])
def test_modes_up_to_a_frequency_are_all_found(square, between):
    """Wherever the limit lies, below and above pairs, and below the first mode."""
    body, exact = square
    assert exact[between[1]] > 1.001 * exact[between[0]]
    limit = exact[list(between)].mean()
    assert len(free_modes(body, upto_hz=limit).frequency) == np.count_nonzero(exact[6:] <= limit)
    assert free_modes(body, upto_hz=0.5 * exact[6]).shapes.shape == (len(body.structure.node), 0)


def test_modes_have_unit_mass_and_leave_no_residual(square):
    """Phi' M Phi = 1, Phi' M R = 0, K phi = w^2 M phi."""
    body, _ = square
    basis = free_modes(body, count=12)
    M = body.structure.M
    np.testing.assert_allclose(basis.shapes.T @ (M @ basis.shapes), np.eye(12), atol=1e-11)
    assert np.abs(body.rigid.T @ (M @ basis.shapes)).max() < 1e-11
    stiff, inert = body.structure.K @ basis.shapes, M @ basis.shapes * (2 * np.pi * basis.frequency) ** 2
    assert np.abs(stiff - inert).max() < 1e-5 * np.abs(stiff).max()


def test_one_start_finds_one_of_a_pair(square, monkeypatch):
    """The question for what is left finds the other: without it the square plate would lose modes."""
    body, exact = square
    asked = []

    def counted(*arguments):
        flexible, shapes = lanczos(*arguments)
        asked.append(flexible.size)
        return flexible, shapes

    lanczos = modes.most_flexible
    monkeypatch.setattr(modes, "most_flexible", counted)
    free_modes(body, upto_hz=exact[11] + 1.0)
    assert len(asked) >= 2


def test_same_input_same_bytes(square):
    """Shapes and signs."""
    body, _ = square
    one, other = free_modes(body, count=6), free_modes(free_body(body.structure), count=6)
    assert one.shapes.tobytes() == other.shapes.tobytes()
    assert one.frequency.tobytes() == other.frequency.tobytes()


def test_signs_follow_the_first_large_component():
    """Of components above half the largest, the first is positive."""
    shapes = np.array([[0.1, -0.4, 0.0], [-1.0, 1.0, 0.0], [1.0, 0.9, 0.0]])
    assert signed(shapes).tolist() == [[-0.1, -0.4, 0.0], [1.0, 1.0, 0.0], [-1.0, 0.9, 0.0]]
    assert signed(np.zeros((3, 0))).shape == (3, 0)


@pytest.mark.parametrize("around", [2, 5], ids=["dense", "lanczos"])
def test_small_and_large_matrices_agree_with_dense_ones(around):
    """Both ways of solving, held at one end and without mass on rotations."""
    body = structure(tube(around, 2 * around, twist=0.2))
    held = body.xyz[:, 0] == 0.0
    moves = sparse.diags_array((body.direction < 3).astype(float))
    light = dataclasses.replace(body, M=sparse.csc_array(moves @ body.M @ moves))
    assert (len(held) > modes.SMALL) == (around == 5)
    free = np.flatnonzero(~held)
    K, M = (matrix[free][:, free].toarray() for matrix in (light.K, light.M))
    flexible = eigh(M, K, eigvals_only=True)[::-1]
    basis = held_modes(light, held, count=8)
    np.testing.assert_allclose(basis.frequency, 1 / (2 * np.pi * np.sqrt(flexible[:8])), rtol=1e-8)
    assert not basis.shapes[held].any()


def test_no_more_modes_than_there_are():
    """A body has as many modes as it has mass; all of them come where more are asked for."""
    body = structure(plate(2, 2))
    assert len(free_modes(free_body(body), count=1000).frequency) == len(body.node) - 6
    three = sparse.diags_array(np.isin(body.node, [1, 3, 7]) * (body.direction < 3) * 1e-3)
    assert len(free_modes(free_body(dataclasses.replace(body, M=sparse.csc_array(three))), upto_hz=1e9).frequency) == 3


def test_few_masses_on_a_large_body():
    """Lanczos iteration ends where the masses do, however many modes are asked for."""
    body = structure(plate(8, 6))
    corners = sparse.diags_array(np.isin(body.node, [1, 7, 57]) * (body.direction < 3) * 1e-3)
    light = free_body(dataclasses.replace(body, M=sparse.csc_array(corners)))
    assert len(body.node) > modes.SMALL
    for asked in ({"count": 50}, {"upto_hz": 1e9}):
        assert len(free_modes(light, **asked).frequency) == 3


def test_more_modes_than_are_sought(square, monkeypatch):
    """A limit far too high is told before memory ends."""
    body, _ = square
    monkeypatch.setattr(modes, "MOST", 20)
    with pytest.raises(NumericalError, match="more than 20 modes lie below 1e\\+06 Hz"):
        free_modes(body, upto_hz=1e6)
    monkeypatch.setattr(modes, "DENSE", 20)
    with pytest.raises(NumericalError, match="more than 20 modes are asked for"):
        free_modes(body, count=21)


@pytest.mark.parametrize(("times", "found"), [(3.0, r"K: node \d+, r?[xyz]"), (30.0, r"w\^2 = -")])
def test_negative_stiffness_is_refused(square, times, found):
    """A motion that K drives on, as buckling does: less than the body resists any, or more."""
    body, _ = square
    first = free_modes(body, count=1)
    inert = body.structure.M @ first.shapes
    K = body.structure.K - sparse.csc_array(times * (2 * np.pi * first.frequency[0]) ** 2 * inert @ inert.T)
    with pytest.raises(DataError, match=found) as error:
        free_modes(free_body(dataclasses.replace(body.structure, K=sparse.csc_array(K))), count=8)
    assert [problem.code for problem in error.value.problems] == ["not_positive"]


def test_one_question(square):
    """A count or a frequency, not both and not none."""
    body, _ = square
    with pytest.raises(ValueError, match="one of count and upto_hz"):
        free_modes(body)
