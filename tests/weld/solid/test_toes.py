"""Re-entrant edges of a skin."""

import numpy as np
import pytest

from fatigue.weld.detection import topology
from fatigue.weld.solid.skin import skin_of
from fatigue.weld.solid.toes import TOE, toes
from tests.solid_meshes import Solids, tee


def places(solids):
    """Ends of all toes, as y and z, and their properties."""
    topo = topology(skin_of(solids.mesh()).mesh)
    found = toes(topo)
    assert {kind for kind, _ in found.values()} <= {TOE}
    ends = topo.mesh.xyz[topo.ends[list(found)]]
    assert (ends[:, 0, 1:] == ends[:, 1, 1:]).all()
    return {(tuple(yz), pids) for yz, (_, pids) in zip(ends[:, 0, 1:].tolist(), found.values(), strict=True)}, len(
        found
    )


def test_a_tee_has_toes_at_the_foot_of_its_upright():
    """Three edges on either side, and none at outer corners."""
    assert places(tee()) == ({((27.0, 10.0), (1, 2)), ((33.0, 10.0), (1, 2))}, 6)


def test_welds_have_toes_on_both_plates():
    """Wedges at 45 degrees: base plate and weld, weld and upright."""
    assert places(tee(wedge=4.0))[0] == {
        *(((y, 10.0), (1, 3)) for y in (23.0, 37.0)),
        *(((y, 14.0), (2, 3)) for y in (27.0, 33.0)),
    }


@pytest.mark.parametrize(("degrees", "number"), [(29.0, 0), (31.0, 1), (-40.0, 0)])
def test_a_bend_of_less_than_30_degrees_is_no_toe(degrees, number):
    """Nor is one outwards."""
    solids = Solids().block([0, 1], [0, 1, 2], [0, 1])
    slope = np.tan(np.radians(degrees))
    mesh = solids.mesh(move=lambda x: np.add(x, (0, 0, slope * max(x[1] - 1, 0))))
    topo = topology(skin_of(mesh).mesh)
    upper = [edge for edge in toes(topo) if topo.mesh.xyz[topo.ends[edge], 2].min() > 0.5]
    assert len(upper) == number


@pytest.mark.parametrize("segments", [8, 12, 16])
def test_a_bore_has_no_toes(segments):
    """However coarse its round."""
    angle = np.radians(np.arange(segments) * 360 / segments)
    solids = Solids()
    for a, b in zip(angle, np.roll(angle, -1), strict=True):
        flat = [(8.0, a), (20.0, a), (20.0, b), (8.0, b)]
        nodes = [(r * np.cos(t), r * np.sin(t), h) for h in (0.0, 5.0) for r, t in flat]
        solids.elements.append((1, [solids.node(n) for n in nodes]))
    assert not toes(topology(skin_of(solids.mesh()).mesh))
