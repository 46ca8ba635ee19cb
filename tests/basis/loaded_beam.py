"""Loaded points of the free beam: its basis as a case would give it, with the static solution that belongs to it."""

import numpy as np
import pandas as pd

from fatigue.basis.loaded.shapes import Loaded
from fatigue.readers.neutral.body.interface_shapes import InterfaceShapes
from fatigue.readers.neutral.body.modes import Modes
from fatigue.readers.neutral.body.static_flexibility import StaticFlexibility
from tests.free_beam import Basis, FreeBeam

POINTS = {("left end", "z"): 0, ("left end", "ry"): 1, ("middle", "z"): 10, ("right end", "z"): 20}


def modes_of(basis: Basis, rigid: int = 2) -> Modes:
    """Modes of a basis behind rigid ones; those beyond the normal ones are interface modes."""
    hz = np.concatenate([np.zeros(rigid), basis.frequency])
    extra = len(basis.frequency) - basis.normal
    kind = ("rigid",) * rigid + ("normal",) * basis.normal + ("interface",) * extra
    n = len(hz)
    return Modes(np.arange(1, n + 1), hz, np.full(n, np.nan), np.ones(n), kind, np.ones(n))


def loaded_beam(beam: FreeBeam, basis: Basis, points: dict[tuple[str, str], int] = POINTS) -> Loaded:
    """Shapes of a basis and the static solution of the beam at loaded degrees of freedom."""
    dof = list(points.values())
    value = np.hstack([beam.rigid[dof], basis.shape[dof]])
    shapes = InterfaceShapes(tuple(p for p, _ in points), tuple(d for _, d in points), value)
    static = np.diag(beam.static(dof)[dof])
    solution = tuple(StaticFlexibility(*key, float(c)) for key, c in zip(points, static, strict=True))
    return Loaded(modes_of(basis), shapes, solution, "flexibility.csv")


def shapes_table(loaded: Loaded) -> pd.DataFrame:
    """The file of shapes."""
    assert loaded.shapes is not None
    rows = [
        (point, direction, mode, value)
        for point, direction, row in zip(loaded.shapes.point, loaded.shapes.direction, loaded.shapes.value, strict=True)
        for mode, value in zip(loaded.modes.mode, row, strict=True)
    ]
    return pd.DataFrame(rows, columns=["point", "direction", "mode", "value"])


def flexibility_table(loaded: Loaded) -> pd.DataFrame:
    """The file of the static solution."""
    rows = [(one.point, one.direction, one.value) for one in loaded.static]
    return pd.DataFrame(rows, columns=["point", "direction", "value_mm_per_N"])
