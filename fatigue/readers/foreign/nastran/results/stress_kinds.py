"""Element types of NASTRAN stress tables: what shells they are, and at how many points their stress is given."""

from dataclasses import dataclass

from fatigue.errors import Problem

STRAIN_BITS, MATERIAL_BIT = 2 | 8, 16
"""Of the stress code: strains, and results in the material system. Bit 1, von Mises or maximum shear, changes nothing
here; bit 4 tells fibres from curvatures in tables of strains."""


@dataclass(frozen=True, slots=True)
class StressKind:
    """Name of a shell, and the number of points with stresses besides its centre."""

    name: str
    corners: int

    @property
    def words(self) -> int:
        """Words of a row of real numbers: ids, and for every point two fibres of eight words, or nine with its grid."""
        return 17 if not self.corners else 2 + 17 * (1 + self.corners)


STRESS_KINDS = {
    33: StressKind("QUAD4", 0),
    74: StressKind("TRIA3", 0),
    227: StressKind("TRIAR", 0),
    228: StressKind("QUADR", 0),
    144: StressKind("QUAD4", 4),
    64: StressKind("QUAD8", 4),
    82: StressKind("QUADR", 4),
    75: StressKind("TRIA6", 3),
    70: StressKind("TRIAR", 3),
}
"""Homogeneous shells by the element type of OP2 tables (MSC Nastran DMAP Programmer's Guide, tables OES and OEF)."""

LAYERED = {95: "QUAD4", 96: "QUAD8", 97: "TRIA3", 98: "TRIA6", 232: "QUADR", 233: "TRIAR"}
"""Layered shells, whose tables hold the stresses of plies."""

LAYERED_WHY = "it is layered, and the stress of a ply is not that of the surface of a plate"


def wrong_system(where: str) -> Problem:
    """Refusal of stresses in the material system, whose angles are not read."""
    what = "the stresses are in the material system (PARAM,OMID,YES), not in the axes of the elements"
    return Problem("material_system", where, what, "Run with PARAM,OMID,NO")


def strains(where: str) -> Problem:
    """Refusal of strains where stresses are expected."""
    return Problem("strains", where, "the table holds strains", "Request STRESS")
