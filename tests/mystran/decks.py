"""Bulk data of shell models for NASTRAN solvers: static load cases and normal modes, with all grid point forces."""

from dataclasses import dataclass

import numpy as np

from fatigue.readers.units.systems import SYSTEMS
from tests.mystran.plates import Plates

YOUNG_MPA = 210_000.0
FRAMES = {
    7: ("CORD2R", (0.0, 0.0, 0.0), (1.0, 2.0, 3.0), (3.0, -1.0, 0.5)),
    8: ("CORD2C", (-500.0, -400.0, 0.0), (-500.0, -300.0, 700.0), (9.0, 9.0, 9.0)),
    9: ("CORD2S", (-500.0, -400.0, -300.0), (-500.0, -300.0, 700.0), (9.0, 9.0, 9.0)),
}
"""Coordinate systems: card, origin, a point on the z axis, and one in the x-z plane [mm]."""


@dataclass(frozen=True)
class Deck:
    """A run to write.

    Attributes
    ----------
    plates : model in mm, N, t, s
    sol : 101 or 103
    node_ids, shell_ids : (n,), (e,) ids of nodes and shells, any unique ones
    frames : (n,) displacement frame of every node: 0 basic, else one of FRAMES
    places : (n,) coordinate system its position is given in, likewise
    modes : how many normal modes
    units : unit system to write in
    extra : more lines of bulk data
    poisson, density : ratio of lateral contraction; mass per volume [t/mm^3]
    first_subcase : number of the first static load case
    quad : formulation of four-node shells: MIN4, MIN4T or MITC4
    """

    plates: Plates
    sol: int
    node_ids: np.ndarray
    shell_ids: np.ndarray
    frames: np.ndarray
    places: np.ndarray
    modes: int = 6
    units: str = "mm-t-s"
    extra: tuple[str, ...] = ()
    poisson: float = 0.3
    density: float = 7.85e-9
    first_subcase: int = 1
    quad: str = "MIN4"

    def text(self) -> str:
        """Return the whole input file."""
        cards = [*self._model(), *self._line_elements(), *self._loads(), *self.extra]
        return "\n".join(
            [*self._control(), "BEGIN BULK", "PARAM,POST,-1", f"PARAM,QUAD4TYP,{self.quad}", *cards, "ENDDATA", ""]
        )

    def _control(self):
        yield from (f"SOL {self.sol}", "CEND", "TITLE = JOINT", "GPFORCE(PLOT) = ALL", "DISP(PLOT) = ALL")
        if self.plates.fixed.any():
            yield "SPC = 1"
        if self.sol == 103:
            yield "METHOD = 1"
        else:
            for k in range(len(self.plates.loads)):
                yield from (f"SUBCASE {self.first_subcase + k}", f"LOAD = {101 + k}")

    def _model(self):
        """Material, frames, grids, shells and supports."""
        p, ids, system = self.plates, self.node_ids, SYSTEMS[self.units]
        pressure, density = system.force / system.length**2, system.mass / system.length**3
        for cid in sorted({*self.frames.tolist(), *self.places.tolist()} - {0}):
            card, *points = FRAMES[cid]
            yield large(card, cid, 0, *(c / system.length for point in points for c in point))
        yield large("MAT1", 1, YOUNG_MPA / pressure, "", self.poisson, self.density / density)
        for k, t in enumerate(p.thickness, start=1):
            yield large("PSHELL", k, 1, float(t) / system.length, 1, "", 1)
        for n, xyz, place, frame in zip(ids, p.xyz, self.places.tolist(), self.frames.tolist(), strict=True):
            yield large("GRID", int(n), place or "", *coordinates(xyz, place, system.length), frame or "")
        for number, pid, nodes in zip(self.shell_ids, p.pid, p.shells, strict=True):
            name = {3: "CTRIA3", 4: "CQUAD4", 8: "CQUAD8"}[len(nodes)]
            yield small(name, int(number), int(pid), *(int(ids[n]) for n in nodes))
        for n in np.flatnonzero(p.fixed):
            yield f"SPC1,1,123456,{ids[n]}"

    def _line_elements(self):
        """Bars, rigid and averaging elements, numbered beyond the shells."""
        p, ids, length = self.plates, self.node_ids, SYSTEMS[self.units].length
        first = int(self.shell_ids.max()) + 1
        if p.bars:
            yield large("PBAR", 90, 1, 100.0 / length**2, *(800.0 / length**4,) * 3)
        for number, (a, b) in enumerate(p.bars, start=first):
            yield small("CBAR", number, 90, int(ids[a]), int(ids[b]), "0.3", "0.5", "0.9")
        for number, (card, head, nodes) in enumerate(p.spiders, start=first + len(p.bars)):
            held = [int(ids[n]) for n in nodes]
            if card == "RBE2":
                yield small(card, number, int(ids[head]), 123456, *held)
            else:
                yield small(card, number, "", int(ids[head]), 123456, "1.0", 123, *held)

    def _loads(self):
        """Loads of the static cases, and the request for modes."""
        system = SYSTEMS[self.units]
        if self.sol == 103:
            yield f"EIGRL,1,,,{self.modes}"
            return
        for k, case in enumerate(self.plates.loads, start=101):
            for n, load in case.items():
                for name, part, unit in (
                    ("FORCE", load[:3], system.force),
                    ("MOMENT", load[3:], system.force * system.length),
                ):
                    if np.any(part):
                        yield large(name, k, int(self.node_ids[n]), 0, 1.0, *(float(x) / unit for x in part))


def coordinates(xyz, cid, length):
    """Coordinates of a point in a system, lengths in units of ``length`` mm, angles in degrees."""
    if not cid:
        return [float(x) / length for x in xyz]
    card, origin, on_z, in_xz = FRAMES[cid]
    z = np.subtract(on_z, origin)
    y = np.cross(z, np.subtract(in_xz, origin))
    axes = np.array([np.cross(y, z), y, z])
    a, b, c = axes / np.linalg.norm(axes, axis=1, keepdims=True) @ (xyz - origin)
    around, across = float(np.degrees(np.arctan2(b, a))), float(np.hypot(a, b))
    if card == "CORD2R":
        return [float(a) / length, float(b) / length, float(c) / length]
    if card == "CORD2C":
        return [across / length, around, float(c) / length]
    return [float(np.hypot(across, c)) / length, float(np.degrees(np.arctan2(across, c))), around]


def small(name, *fields):
    """Return a card of fields of 8 characters, continued as needed."""
    cells = [f"{f:<8}" for f in fields]
    lines = ["".join(cells[k : k + 8]) for k in range(0, len(cells), 8)]
    return "\n".join((f"{name:<8}" if k == 0 else " " * 8) + line.rstrip() for k, line in enumerate(lines))


def large(name, *fields):
    """Return a card of fields of 16 characters."""
    cells = [f"{f:<16.9E}" if isinstance(f, float) else f"{f:<16}" for f in fields]
    lines = ["".join(cells[k : k + 4]) for k in range(0, len(cells), 4)]
    heads = [f"{name + '*':<8}", *["*" + " " * 7] * (len(lines) - 1)]
    return "\n".join((head + line).rstrip() for head, line in zip(heads, lines, strict=True))


def plain(plates, sol, **options):
    """Number nodes and shells from 1 on, all in the basic frame."""
    n, e = len(plates.xyz), len(plates.shells)
    return Deck(plates, sol, np.arange(1, n + 1), np.arange(1, e + 1), np.zeros(n, int), np.zeros(n, int), **options)
