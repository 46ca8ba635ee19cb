"""The small case with the mass of a chain along x: one held mass, three that swing, so every number follows by hand."""

from pathlib import Path

import numpy as np
import pandas as pd
from scipy import sparse
from scipy.io import mmwrite

from tests.small_case import SmallCase, small_case

MASS, HELD = 2.0, 1.5  # t: of each of the three, of the one on the boundary
TOTAL = 3 * MASS + HELD
MODES = (1, 2, 7)
K = 1e4  # N/mm


def chain():
    """Frequencies (3,) [Hz] and mass-normalised shapes (3, 3) of three masses on springs, one end held."""
    stiffness = K * np.array([[2.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]])
    w2, shapes = np.linalg.eigh(stiffness / MASS)
    return np.sqrt(w2) / (2 * np.pi), shapes / np.sqrt(MASS)


def by_factors(folder: Path, **columns: object) -> SmallCase:
    """Case whose chain is given by participation factors; ``columns`` replace some."""
    case = _case()
    _, shapes = chain()
    table = pd.DataFrame({"mode": MODES, "l_x": MASS * shapes.sum(axis=0)})
    folder.mkdir(parents=True, exist_ok=True)
    table.assign(**columns).to_csv(folder / "participation.csv", index=False)
    case.body |= {"participation": "participation.csv", "total_mass_t": TOTAL, "boundary_mass_t": HELD}  # type: ignore[dict-item]
    return case


def by_matrix(folder: Path, kind: str = "mtx") -> SmallCase:
    """Case whose chain is given by a mass matrix of three directions at four nodes and its shapes along x."""
    case = _case()
    masses, nodes = np.repeat([HELD, MASS, MASS, MASS], 3), np.arange(10, 14)
    folder.mkdir(parents=True, exist_ok=True)
    write_matrix(folder, np.diag(masses), kind)
    rows = pd.DataFrame({"row": np.arange(1, 13), "node": np.repeat(nodes, 3), "direction": list("xyz") * 4})
    rows = rows.assign(x_mm=np.repeat([0.0, 500.0, 1000.0, 1500.0], 3), y_mm=20.0, z_mm=-300.0, held=rows.node == 10)
    rows.sample(frac=1.0, random_state=3).to_csv(folder / "mass_rows.csv", index=False)
    _, shapes = chain()
    at = [
        pd.DataFrame({"mode": mode, "node": nodes, "ux_mm": np.append(0.0, shapes[:, i]), "uy_mm": 0.0, "uz_mm": 0.0})
        for i, mode in enumerate(MODES)
    ]
    pd.concat(at).to_csv(folder / "mode_shapes.csv", index=False)
    case.body |= {
        "mass_matrix": f"mass.{kind}",
        "mass_rows": "mass_rows.csv",
        "mode_shapes": "mode_shapes.csv",
        "total_mass_t": TOTAL,  # type: ignore[dict-item]
    }
    return case


def write_matrix(folder: Path, matrix: np.ndarray, kind: str = "mtx") -> None:
    """Write ``mass.mtx`` or ``mass.npz``."""
    if kind == "mtx":
        mmwrite(folder / "mass.mtx", sparse.coo_array(matrix))
    else:
        sparse.save_npz(folder / "mass.npz", sparse.csc_array(matrix))


def _case() -> SmallCase:
    case = small_case()
    case.modes["frequency_hz"] = chain()[0]
    return case
