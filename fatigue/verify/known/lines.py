"""Weld lines whose line load and stress are known in closed form."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.check import Check
from fatigue.weld.line import WeldLine
from fatigue.weld.line_load import line_load, treat_ends
from fatigue.weld.structural_stress import assess_line

Floats = NDArray[np.float64]
DONG = "closed form; method: Dong, Int. J. Fatigue 23 (2001) 865"
ROUNDING = 1e-9


def line_checks() -> Iterator[Check]:
    """Checks of line loads, weld ends and structural stress."""
    yield from _constant_loads()
    yield from _polynomial_loads()
    yield from _rings_and_steps()
    yield from _weld_ends()
    yield from _plates()


def _line(xyz: Floats, *, closed: bool = False, edge_mid: bool = False, end_length: float = 0.0) -> WeldLine:
    """Line of a plate 10 mm thick with its top towards z, from which y points out; on a ring the radius does."""
    n = len(xyz)
    return WeldLine(
        weld="known",
        part=1,
        order=np.arange(1, n + 1),
        node=np.arange(1, n + 1),
        xyz=xyz,
        thickness=np.full(n, 10.0),
        normal=np.tile([0.0, 0.0, 1.0], (n, 1)),
        outward=xyz.copy() if closed else np.tile([0.0, 1.0, 0.0], (n, 1)),
        edge_mid=np.arange(n) % 2 == 1 if edge_mid else np.zeros(n, dtype=bool),
        closed=closed,
        end_length=end_length,
    )


def _straight(s: Floats, *, edge_mid: bool = False, end_length: float = 0.0) -> WeldLine:
    return _line(np.outer(s, [1.0, 0.0, 0.0]), edge_mid=edge_mid, end_length=end_length)


def _ring(n: int, radius: float) -> WeldLine:
    angle = 2 * np.pi * np.arange(n) / n
    return _line(radius * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle]), closed=True)


def _linear_forces(load: Floats, lengths: Floats) -> Floats:
    """Nodal forces of a load that is linear along every edge: l/6 [[2, 1], [1, 2]]."""
    forces = np.zeros_like(load)
    for i, length in enumerate(lengths):
        j = (i + 1) % len(load)
        forces[i] += length / 6 * (2 * load[i] + load[j])
        forces[j] += length / 6 * (load[i] + 2 * load[j])
    return forces


def _parabolic_forces(load: Floats, lengths: Floats) -> Floats:
    """Nodal forces of a load that is quadratic along every edge: l/30 [[4, 2, -1], [2, 16, 2], [-1, 2, 4]]."""
    forces = np.zeros_like(load)
    for i, length in enumerate(lengths):
        at = [2 * i, 2 * i + 1, (2 * i + 2) % len(load)]
        forces[at] += length / 30 * np.array([[4, 2, -1], [2, 16, 2], [-1, 2, 4]]) @ load[at]
    return forces


def _constant_loads() -> Iterator[Check]:
    """Checks of a load of 7 N/mm on edges of 1e-4 to 5 mm, linear and parabolic, open and closed."""
    lengths = np.array([2.0, 1e-4, 5.0, 1.3, 0.7, 3.1])
    s = np.concatenate([[0.0], np.cumsum(lengths)])
    halves = np.concatenate([[0.0], np.cumsum(np.repeat(lengths / 2, 2))])
    hexagon = 4.0 * np.column_stack([np.cos(s[:6]), np.sin(s[:6]), 0 * s[:6]])
    chords = np.linalg.norm(np.roll(hexagon, -1, axis=0) - hexagon, axis=1)
    with_mids = np.stack([hexagon, (hexagon + np.roll(hexagon, -1, axis=0)) / 2], axis=1).reshape(-1, 3)
    for case, line, forces in (
        ("linear, open", _straight(s), _linear_forces(np.full(7, 7.0), lengths)),
        ("parabolic, open", _straight(halves, edge_mid=True), _parabolic_forces(np.full(13, 7.0), lengths)),
        ("linear, closed", _line(hexagon, closed=True), _linear_forces(np.full(6, 7.0), chords)),
        (
            "parabolic, closed",
            _line(with_mids, closed=True, edge_mid=True),
            _parabolic_forces(np.full(12, 7.0), chords),
        ),
    ):
        worst = float(np.abs(line_load(line, forces) - 7.0).max())
        yield _load(f"constant 7 N/mm, {case}", "largest error", 0.0, worst)


def _polynomial_loads() -> Iterator[Check]:
    lengths = np.array([1.0, 3.0, 0.5, 2.0, 4.0])
    s = np.concatenate([[0.0], np.cumsum(lengths)])
    found = line_load(_straight(s), _linear_forces(s, lengths))
    yield _load("f = s, uneven linear edges", "largest error", 0.0, float(np.abs(found - s).max()))
    s = np.concatenate([[0.0], np.cumsum(np.repeat(lengths / 2, 2))])
    found = line_load(_straight(s, edge_mid=True), _parabolic_forces(s**2, lengths))
    yield _load("f = s^2, uneven parabolic edges", "largest error", 0.0, float(np.abs(found - s**2).max()))
    found = line_load(_straight(np.array([0.0, 5.0, 15.0, 35.0])), np.array([50.0, 175.0, 200 / 3, 1000 / 3]))
    for at, expected in enumerate((10.0, 40.0, -20.0, 60.0)):
        yield _load("edges 5, 10, 20; F 50, 175, 66.7, 333.3", f"f at node {at + 1}", expected, float(found[at]))


def _rings_and_steps() -> Iterator[Check]:
    for n, amplitude in ((8, 1.0523869), (12, 1.0230490)):
        h = 2 * np.pi / n
        line = _ring(n, h / (2 * np.sin(h / 2)))  # chords of length h
        forces = h * np.cos(h * np.arange(n)) * 2 * (1 - np.cos(h)) / h**2
        found = float(line_load(line, forces)[0])
        yield _load(f"ring of {n} edges, f = cos(angle)", "amplitude", amplitude, found, 5e-8)
    load = line_load(_straight(np.arange(41.0)), np.concatenate([np.zeros(20), [0.5], np.ones(19), [0.5]]))
    jump = (2 - np.sqrt(3)) / 2
    for at, name, expected in ((20, "at the step", 0.5), (21, "node after", 1 + jump), (19, "node before", -jump)):
        yield _load("step from 0 to 1 at a node", name, expected, float(load[at]))


def _weld_ends() -> Iterator[Check]:
    """Checks of means of f = s over end zones that do not end at a node."""
    s = np.array([0.0, 1.0, 4.0, 4.5, 6.5, 10.5])
    ends = treat_ends(_straight(s, end_length=2.5), s.copy()).value
    short = treat_ends(_straight(np.array([0.0, 7.0]), end_length=10.0), np.array([0.0, 7.0])).value
    for case, quantity, expected, found in (
        ("f = s on 10.5 mm, zone 2.5 mm", "first node", 1.25, ends[0]),
        ("f = s on 10.5 mm, zone 2.5 mm", "second node, 1 mm in", 1.25, ends[1]),
        ("f = s on 10.5 mm, zone 2.5 mm", "middle node, kept", 4.0, ends[2]),
        ("f = s on 10.5 mm, zone 2.5 mm", "last node", 9.25, ends[5]),
        ("line of 7 mm, zone 10 mm", "first node, capped at half", 1.75, short[0]),
    ):
        yield Check(
            "weld end", case, quantity, "N/mm", expected, float(found), ROUNDING, "closed form: mean over the zone"
        )


def _plates() -> Iterator[Check]:
    """Checks on plates whose stress statics decides, in a frame turned away from the axes."""
    axis = np.array([1.0, 2.0, 2.0]) / 3
    K = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    turn = np.eye(3) + np.sin(0.7) * K + (1 - np.cos(0.7)) * K @ K
    s = np.array([0.0, 4.0, 5.0, 11.0])
    tributary = np.array([2.0, 2.5, 3.5, 3.0])[:, None]  # of a constant load
    straight = _straight(s)
    line = WeldLine(
        "known", 1, straight.order, straight.node, straight.xyz @ turn.T, straight.thickness, straight.normal @ turn.T,
        straight.outward @ turn.T, straight.edge_mid, closed=False, end_length=None,
    )  # fmt: skip
    tension, cantilever = np.zeros((2, 6))
    tension[1] = 100.0  # N/mm towards the weld
    cantilever[2], cantilever[3] = -2.0, -2.0 * -60.0  # 2 N/mm upwards at 60 mm from the line
    for case, load, membrane, bending in (
        ("plate in tension, 100 N/mm, t = 10", tension, 10.0, 0.0),
        ("cantilever, 2 N/mm upwards at 60 mm, t = 10", cantilever, 0.0, -7.2),
    ):
        both = np.concatenate([turn @ load[:3], turn @ load[3:]])
        stress = assess_line(line, (tributary * both)[:, None, :]).treated
        yield _stress(case, "membrane stress", membrane, float(stress.membrane[1, 0]))
        yield _stress(case, "bending stress, top", bending, float(stress.bending[0, 0]))
    ring = _ring(12, 100.0)
    radial = ring.xyz / 100.0
    chord = np.linalg.norm(ring.xyz[1] - ring.xyz[0])
    forces = np.zeros((12, 1, 6))
    forces[:, 0, :3] = _linear_forces(10.0 * radial, np.full(12, chord))
    smallest = float(assess_line(ring, forces).treated.membrane.min())
    yield _stress("ring of 12 edges, radial 10 N/mm", "membrane stress, smallest", 1.0, smallest)


def _load(case: str, quantity: str, expected: float, found: float, tolerance: float = ROUNDING) -> Check:
    return Check("line load", case, quantity, "N/mm", expected, found, tolerance, DONG)


def _stress(case: str, quantity: str, expected: float, found: float) -> Check:
    return Check("structural stress", case, quantity, "MPa", expected, found, ROUNDING, "statics; ASME VIII-2 5.5.5.2")
