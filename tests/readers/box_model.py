"""A box of four walls on a plate, whose weld turns by 90 degrees at its corners, as an FE run delivers it."""

from functools import cache

import numpy as np

from tests.readers.tee_model import Tee, _results
from tests.shell_fe import ShellModel, grid, joined

LOW, HIGH, TOP = 30.0, 60.0, 20.0


@cache
def box(walls: int = 4, modes: int = 3) -> Tee:
    """A plate of 100 x 90 x 8 mm, fixed at two edges, with so many walls of 30 x 20 x 6 mm round a square on it."""
    base = grid(np.linspace(0, 100, 11), np.linspace(0, 90, 10))
    uv, quads = grid(np.linspace(LOW, HIGH, 4), np.linspace(0, TOP, 3))
    u, z = uv[:, 0], uv[:, 1]
    sides = [
        (u, np.full(len(u), LOW)),
        (np.full(len(u), HIGH), u),
        (u, np.full(len(u), HIGH)),
        (np.full(len(u), LOW), u),
    ]
    shells = [(np.column_stack([x, y, z]), quads) for x, y in sides[:walls]]
    xyz, quads = joined(base, *shells)
    thickness = np.where(np.arange(len(quads)) < len(base[1]), 8.0, 6.0)
    model = ShellModel(xyz, quads, thickness)
    fixed = np.zeros((len(xyz), 6), bool)
    fixed[(xyz[:, 0] < 1) | (xyz[:, 0] > 99)] = True
    frequency, shape = model.modes(modes, fixed)
    force = np.stack([model.element_forces(u) for u in shape])
    turned = np.zeros(0, np.int64)
    return Tee(model, frequency, shape, force, turned, _results(model, frequency, shape, force, turned))


def corner_nodes(walls: int = 4) -> list[list[int]]:
    """Grids along each wall on the plate, in order of their place on the way round."""
    xyz = box(walls).model.xyz
    found = []
    for number in range(walls):
        across, along = (1, 0) if number % 2 == 0 else (0, 1)
        level = (LOW, HIGH, HIGH, LOW)[number]
        at = (abs(xyz[:, across] - level) < 1e-9) & (xyz[:, 2] == 0)
        at &= (xyz[:, along] > LOW - 1e-9) & (xyz[:, along] < HIGH + 1e-9)
        rows = sorted(np.flatnonzero(at).tolist(), key=lambda row: xyz[row, along])
        found.append([row + 1 for row in (rows if number < 2 else rows[::-1])])
    return found
