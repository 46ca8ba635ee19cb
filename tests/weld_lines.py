"""Weld lines for tests."""

import numpy as np

from fatigue.weld.line import WeldLine


def weld_line(
    xyz,
    outward=(0.0, 1.0, 0.0),
    normal=(0.0, 0.0, 1.0),
    thickness=10.0,
    edge_mid=None,
    closed=False,
    end_length=None,
    node=None,
):
    """Build a line through ``xyz``, (n, 3); vectors and thickness may be given once for all nodes."""
    xyz = np.asarray(xyz, dtype=float)
    n = len(xyz)
    return WeldLine(
        weld="W1",
        part=1,
        order=np.arange(1, n + 1),
        node=np.arange(101, 101 + n) if node is None else np.asarray(node),
        xyz=xyz,
        thickness=np.array(np.broadcast_to(thickness, n), dtype=float),
        normal=np.array(np.broadcast_to(normal, (n, 3)), dtype=float),
        outward=np.array(np.broadcast_to(outward, (n, 3)), dtype=float),
        edge_mid=np.zeros(n, dtype=bool) if edge_mid is None else np.asarray(edge_mid, dtype=bool),
        closed=closed,
        end_length=end_length,
    )


def straight(steps, **given):
    """Build a straight line along x with the given distances between its nodes."""
    x = np.concatenate([[0.0], np.cumsum(steps)])
    return weld_line(np.outer(x, [1.0, 0.0, 0.0]), **given)


def ring(n, radius=100.0, **given):
    """Build a closed ring of n equal chords in the x-y plane, the plate inside it."""
    angle = 2 * np.pi * np.arange(n) / n
    radial = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(n)])
    return weld_line(radius * radial, **({"outward": radial, "closed": True} | given))
