"""A stiffness matrix in few digits resists rigid motions, which tells how wrong its lowest frequency is."""

import dataclasses

import numpy as np
import pytest
from scipy import sparse

from fatigue.flexbody.factor import free_body
from fatigue.flexbody.modes import free_modes
from fatigue.flexbody.rounding import few_digits, rigid_frequency
from fatigue.flexbody.shell import structure
from tests.flexbody.shells import plate, tube


def in_digits(body, digits):
    """A structure whose K was written in a few digits."""
    K = body.K.copy()
    K.data = np.array([float(f"{value:.{digits - 1}e}") for value in K.data])
    return dataclasses.replace(body, K=sparse.csc_array((K + K.T) / 2))


def lowest(body):
    """Lowest elastic frequency [Hz]."""
    return float(free_modes(free_body(body), count=1).frequency[0])


@pytest.mark.parametrize("mesh", [plate(12, 9), tube(8, 10)], ids=["plate", "tube"])
def test_digits_of_a_matrix(mesh):
    """The estimate is right to the order of magnitude; a matrix in double precision is silent."""
    body = structure(mesh)
    exact = lowest(body)
    assert few_digits(body, exact, "K.mtx") == []
    assert rigid_frequency(body) < 1e-3 * exact
    for digits in (6, 7):
        rounded = in_digits(body, digits)
        error, estimate = abs(lowest(rounded) / exact - 1.0), (rigid_frequency(rounded) / exact) ** 2 / 2
        assert 0.02 < error / estimate < 50.0
    (warning,) = few_digits(in_digits(body, 6), exact, "K.mtx")
    assert warning.code == "few_digits"
    assert warning.where == "K.mtx"
    assert "in place of 0" in warning.what
