"""Places of nodes come from K alone where nothing else says them, and where K cannot tell that is said."""

import numpy as np
import pytest
from scipy import sparse

from fatigue.errors import DataError
from fatigue.flexbody.places import places_by_stiffness
from fatigue.flexbody.shell import structure
from fatigue.vehicle.frame_body import frame_structure
from tests.flexbody.shells import plate


@pytest.mark.parametrize("body", [frame_structure, lambda: structure(plate(6, 4))], ids=["beams", "shells"])
def test_places_are_those_of_the_mesh(body):
    """Measured from the first node that has all six rows."""
    of = body()
    xyz, origin = places_by_stiffness(of.K, of.node, of.direction, "dof.csv")
    true = of.xyz - of.xyz[of.node == origin][0]
    assert np.abs(xyz - true).max() < 1e-9 * np.ptp(of.xyz)


def test_two_displacements_of_a_node_are_enough():
    """A node moves along x and y: both rotations about z, and those about x and y, tell its three coordinates."""
    of = structure(plate(6, 4))
    last = of.node.max()
    keep = (of.node != last) | (of.direction < 2)
    drop = ~keep  # condensed statically, so that the rest is still a free body
    K = of.K.toarray()
    K = K[np.ix_(keep, keep)] - K[np.ix_(keep, drop)] @ np.linalg.solve(K[np.ix_(drop, drop)], K[np.ix_(drop, keep)])
    xyz, _ = places_by_stiffness(sparse.csc_array(K), of.node[keep], of.direction[keep], "dof.csv")
    true = of.xyz[keep] - of.xyz[0]
    assert np.abs(xyz - true).max() < 1e-6 * np.ptp(of.xyz)


def broken(what):
    """K and rows of a plate from which places cannot be found."""
    of = structure(plate(6, 4))
    K, node, direction = of.K.tolil(), of.node, of.direction
    if what == "held":
        K[-4, -4] += K[-4, -4]
    elif what == "two parts":
        K = sparse.block_diag([of.K, of.K])
        node, direction = np.concatenate([node, node + 1000]), np.tile(direction, 2)
    else:
        keep = direction < 3
        K, node, direction = of.K[keep][:, keep], node[keep], direction[keep]
    return sparse.csc_array(K), node, direction


@pytest.mark.parametrize(
    ("what", "words"),
    [("held", "held or loose"), ("two parts", "not joined"), ("no rotations", "no node has all six")],
)
def test_what_cannot_be_told_is_refused(what, words):
    """The refusal says why, and that places may be given."""
    with pytest.raises(DataError, match=words) as refusal:
        places_by_stiffness(*broken(what), "dof.csv")
    assert "dof.csv: x_mm, y_mm, z_mm" in str(refusal.value)
    assert "Give x_mm, y_mm, z_mm here, or a table nodes in the folder" in str(refusal.value)
