"""What a reduction made, in words and as a record."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.flexbody.mass import centre_of_mass, rigid_mass, rigid_motions
from fatigue.flexbody.structure import Structure
from fatigue.readers.neutral.body.interface_shapes import DIRECTIONS
from fatigue.reduce.bases import Recipe, Reduced
from fatigue.reduce.interface import InterfacePoint
from fatigue.shown import few

Floats = NDArray[np.float64]

ENOUGH = 0.95  # of the local flexibility, as ``fatigue basis`` has it: computed on one car body, no standard


@dataclass(frozen=True, slots=True, eq=False)
class RigidBody:
    """The body as a rigid one: mass [t], centre of mass (3,) [mm], inertia (3, 3) about it [t mm2]."""

    mass_t: float
    cg_mm: Floats
    inertia_t_mm2: Floats


def rigid_body(structure: Structure) -> RigidBody:
    """Mass properties of a structure."""
    centre = centre_of_mass(rigid_mass(structure.M, rigid_motions(structure.xyz, structure.direction)))
    about = rigid_mass(structure.M, rigid_motions(structure.xyz, structure.direction, centre))
    return RigidBody(float(about[0, 0]), centre, (about[3:, 3:] + about[3:, 3:].T) / 2.0)


@dataclass(frozen=True, slots=True, eq=False)
class Reduction:
    """A body that was reduced: how, what it is, what the basis carries, and what was written."""

    folder: Path
    recipe: Recipe
    rigid: RigidBody
    points: tuple[InterfacePoint, ...]
    reduced: Reduced
    welds: tuple[str, ...]
    weld_nodes: int
    notes: tuple[str, ...]
    warnings: tuple[Problem, ...]
    files: tuple[str, ...] = ()

    @property
    def loaded(self) -> list[tuple[str, str]]:
        """Point and direction of each loaded degree of freedom (d,)."""
        return [(p.name, DIRECTIONS[d]) for p in self.points if p.is_loaded for d in p.directions]

    def as_record(self) -> dict[str, Any]:
        """What machines are told, and what ``reduce.json`` has beside hashes."""
        basis, kept = self.reduced.basis, self.reduced.kept
        normal = basis.frequency[basis.normal]
        least = int(kept.argmin())
        return {
            "basis": asdict(self.recipe),
            "modal_mass_t": 1.0,
            "normal_modes": int(basis.normal.sum()),
            "interface_modes": int((~basis.normal).sum()),
            "highest_normal_hz": float(normal.max()) if normal.size else None,
            "highest_hz": float(basis.frequency.max()),
            "dropped_above_keep_hz": self.reduced.dropped,
            "mass_t": self.rigid.mass_t,
            "cg_mm": self.rigid.cg_mm,
            "inertia_t_mm2": self.rigid.inertia_t_mm2,
            "flexibility": {
                "what": "part of the static answer to a unit load (inertia relief) that the basis has",
                "least": float(kept[least]),
                "least_at": " ".join(self.loaded[least]),
                "of_direction": {
                    " ".join(key): float(value) for key, value in zip(self.loaded, kept.tolist(), strict=True)
                },
            },
            "welds": self.welds,
            "weld_nodes": self.weld_nodes,
            "notes": self.notes,
            "warnings": [asdict(problem) for problem in self.warnings],
        }

    def as_text(self) -> str:
        """Lines for a terminal."""
        return "\n".join(self._lines())

    def _lines(self) -> list[str]:
        basis, kept = self.reduced.basis, self.reduced.kept
        normal = basis.frequency[basis.normal]
        reach = f", {normal[0]:.4g} to {normal[-1]:.4g} Hz" if normal.size else f" up to {self.recipe.cut_hz:g} Hz"
        modes = f"{normal.size} normal modes{reach}"
        others = int((~basis.normal).sum())
        modes += f", and {others} interface modes up to {basis.frequency[-1]:.4g} Hz" if others else ""
        x, y, z = self.rigid.cg_mm.tolist()
        loaded = [point for point in self.points if point.is_loaded]
        least = (
            f"least local flexibility {kept.min():.4g} of the body's, at {' '.join(self.loaded[int(kept.argmin())])}"
        )
        observed = len(self.points) - len(loaded)
        lines = [
            f"{self.recipe.name} basis: {modes}; modal mass 1 t, rigid motions left out",
            f"body: {self.rigid.mass_t:.5g} t, centre of mass at ({x:.1f}, {y:.1f}, {z:.1f}) mm",
            f"{len(loaded)} loaded points in {len(kept)} directions, {observed} observed; {least}",
        ]
        if self.welds:
            ending = "s" * (len(self.welds) != 1)
            lines.append(f"forces of {len(self.welds)} weld line{ending} at {self.weld_nodes} nodes")
        return [*lines, *(f"note: {note}" for note in self.notes), _written(self)]


def _written(done: Reduction) -> str:
    if not done.welds:
        return f"written to {done.folder}: modes and shapes of the points, and no case"
    return (
        f"written to {done.folder}: add the histories of q to its case.toml, then `fatigue check` and `fatigue assess`"
    )


def stiff_points(loaded: Sequence[tuple[str, str]], kept: Floats) -> list[Problem]:
    """Warning about loaded points where the basis is too stiff: local forces are lost to the same extent."""
    short = np.flatnonzero(kept < ENOUGH)
    if not short.size:
        return []
    worst = [f"{' '.join(loaded[i])} {kept[i]:.2g}" for i in short[np.argsort(kept[short])].tolist()]
    what = f"the basis has less than {ENOUGH:g} of the local flexibility of the body where forces enter: {few(worst)}"
    remedy = "Take --basis residual: a weld beside such a point loses its force, and its life comes out too long"
    return [Problem("stiff_points", "interface", what, remedy, int(short.size))]
