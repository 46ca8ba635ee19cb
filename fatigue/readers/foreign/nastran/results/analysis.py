"""The solution types of NASTRAN by the numbers that OP2 and HDF5 files share, and the refusal of all but two."""

from fatigue.errors import Problem
from fatigue.readers.foreign.fe.results import REQUEST

STATIC, MODES = 1, 2
ANALYSES = {
    STATIC: "static",
    MODES: "real eigenvalues",
    3: "differential stiffness",
    4: "differential stiffness",
    5: "frequency response",
    6: "transient response",
    7: "buckling (pre-buckling)",
    8: "buckling (post-buckling)",
    9: "complex eigenvalues",
    10: "nonlinear statics",
    11: "geometric nonlinear statics",
    12: "contran",
}
BUCKLING = (7, 8)


def wrong_analysis(where: str, number: int, found: str = "forces") -> Problem:
    """Say of which solution the forces or shapes are; buckling shapes have a load factor, no frequency."""
    remedy = REQUEST
    if number in BUCKLING:
        remedy = "Buckling shapes (SOL 105) are no modes of vibration: give the modal run, SOL 103 with GPFORCE"
    name = f"{ANALYSES[number]} (analysis type {number})" if number in ANALYSES else f"analysis type {number}"
    return Problem("wrong_analysis", where, f"the {found} belong to a solution of {name}", remedy)
