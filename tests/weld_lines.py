"""Weld lines for tests."""

from dataclasses import replace

import numpy as np
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

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


def reversed_line(line):
    """Walk the same line the other way."""
    columns = ("order", "node", "xyz", "thickness", "normal", "outward", "edge_mid")
    turned = {name: getattr(line, name)[::-1] for name in columns}
    return replace(line, **turned, corner_start=line.corner_end, corner_end=line.corner_start)


def shifted(line, by):
    """Let a closed line begin ``by`` nodes later."""
    columns = ("order", "node", "xyz", "thickness", "normal", "outward", "edge_mid")
    return replace(line, **{name: np.roll(getattr(line, name), -by, axis=0) for name in columns})


def moved(line, rotation, shift):
    """Rotate and shift a line with its plate."""
    return replace(
        line,
        xyz=line.xyz @ rotation.T + shift,
        normal=line.normal @ rotation.T,
        outward=line.outward @ rotation.T,
    )


def rotations():
    """Draw rotation matrices."""
    angles = st.floats(-np.pi, np.pi)
    return st.tuples(angles, angles, angles).map(lambda three: Rotation.from_euler("xyz", three).as_matrix())


@st.composite
def lines(draw, closed=None, least=2):
    """Draw a smooth line on a plate: an arc or a ring, with linear and parabolic edges of uneven length."""
    closed = draw(st.booleans()) if closed is None else closed
    kinds = draw(st.lists(st.booleans(), min_size=max(least, 8 if closed else 1), max_size=12))
    weights = np.array(draw(st.lists(st.floats(0.3, 1.0), min_size=len(kinds), max_size=len(kinds))))
    arc = 2 * np.pi if closed else draw(st.floats(0.1, min(3.0, 1.05 * len(kinds))))
    ends = np.concatenate([[0.0], np.cumsum(weights / weights.sum() * arc)])
    at, mid = [], []
    for begin, stop, parabolic in zip(ends[:-1], ends[1:], kinds, strict=True):
        at += [begin, (begin + stop) / 2] if parabolic else [begin]
        mid += [False, True] if parabolic else [False]
    if not closed:
        at, mid = [*at, ends[-1]], [*mid, False]
    radial = np.column_stack([np.cos(at), np.sin(at), np.zeros(len(at))])
    slant = draw(st.floats(-0.5, 0.5))
    return weld_line(
        draw(st.floats(20.0, 200.0)) * radial,
        outward=radial * draw(st.sampled_from([-1.0, 1.0])) + [0.0, 0.0, slant],
        thickness=draw(st.floats(2.0, 20.0)),
        edge_mid=mid,
        closed=closed,
        end_length=draw(st.sampled_from([None, 0.0, 5.0])),
    )


def fields(line, *trailing, seed=0):
    """Random values at the nodes of a line, (n, ...)."""
    return np.random.default_rng(seed).normal(size=(line.node.size, *trailing))
