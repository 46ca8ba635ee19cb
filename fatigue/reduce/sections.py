"""What the shells of a model are made of, by property; values in other units are told by what no material has."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.neutral.tables import Table, open_table

Floats = NDArray[np.float64]

REQUIRED = ("pid", "thickness_mm", "E_MPa", "nu", "rho_t_mm3")
OPTIONAL = ("bending_thickness_mm", "nsm_t_mm2")

STIFFEST = 1.5e6  # MPa: diamond has 1.1e6
SOFTEST = 1.0  # MPa: rubber; metals in GPa are told by HARD
HARD = 300.0  # a table whose stiffest E is below it is one of metals in GPa, or of no body that carries
DENSEST = 2.3e-8  # t/mm3: osmium
UNITS_OF_E = {1e6: "Pa", 1e-3: "GPa"}  # times MPa
UNITS_OF_RHO = {1e12: "kg/m3", 1e9: "g/cm3", 1e3: "kg/mm3"}  # times t/mm3
METAL_E, METAL_RHO = (4e4, 2.2e5), (1.7e-9, 9e-9)  # MPa, t/mm3: magnesium to steel


@dataclass(frozen=True, slots=True, eq=False)
class Sections:
    """Sections by property id, ascending ``pid`` (p,); the others are (p,) as of ``ShellMesh``."""

    pid: NDArray[np.int64]
    thickness: Floats
    bending_thickness: Floats
    E: Floats
    nu: Floats
    rho: Floats
    nsm: Floats


def read_sections(path: Path, *, strict: bool) -> tuple[Sections, list[Problem]]:
    """Read ``pid, thickness_mm, E_MPa, nu, rho_t_mm3`` and, where present, ``bending_thickness_mm, nsm_t_mm2``.

    A property without bending thickness bends as its thickness.

    Raises
    ------
    DataError : a thickness not above 0, E or a density that no material has in these units
    """
    table = open_table(path)
    table.expect(REQUIRED, OPTIONAL, strict=strict)
    pid = table.integers("pid")
    thickness = table.numbers("thickness_mm", above=0.0).astype(np.float64)
    bending = table.numbers("bending_thickness_mm", default=np.nan, above=0.0).astype(np.float64)
    E = table.numbers("E_MPa", above=0.0).astype(np.float64)
    nu = table.numbers("nu").astype(np.float64)
    rho = table.numbers("rho_t_mm3", least=0.0).astype(np.float64)
    nsm = table.numbers("nsm_t_mm2", default=0.0, least=0.0).astype(np.float64)
    table.unique({"pid": pid})
    wrong = ~((nu > -1.0) & (nu < 0.5))
    what = f"{nu[int(wrong.argmax())]:g} is no Poisson's ratio"
    table.report(wrong, "bad_value", "nu", what, "Give a number above -1 and below 0.5, of metals 0.3")
    if not table.spoilt:
        table.problems += _implausible(table, E, rho, nsm)
    table.refuse()
    bending = np.where(np.isnan(bending), thickness, bending)
    by_id = np.argsort(pid)
    found = (pid, thickness, bending, E, nu, rho, nsm)
    return Sections(*(values[by_id] for values in found)), table.warnings


def _implausible(table: Table, E: Floats, rho: Floats, nsm: Floats) -> Iterator[Problem]:
    """Refusals of a stiffness or density that no material has."""
    soft, stiff = E < SOFTEST, E > STIFFEST
    if E.max() < HARD:
        soft = E <= E.max()
    for wrong, said in ((stiff, "stiffer than diamond"), (soft, "softer than any material that carries a body")):
        if wrong.any():
            row = int(wrong.argmax())
            unit = _unit(float(E[row]), METAL_E, UNITS_OF_E)
            what = f"{E[row]:g} MPa is {said}{unit}"
            yield Problem("other_unit", table.where("E_MPa", row), what, "Give E in MPa: of steel 210000")
            break
    dense = rho > DENSEST
    if dense.any():
        row = int(dense.argmax())
        unit = _unit(float(rho[row]), METAL_RHO, UNITS_OF_RHO)
        what = f"{rho[row]:g} t/mm3 is denser than any material{unit}"
        yield Problem("other_unit", table.where("rho_t_mm3", row), what, "Give t/mm3: of steel 7.85e-9")
    if not np.any(rho + nsm > 0.0):
        what = "no property has mass"
        yield Problem("no_mass", table.where("rho_t_mm3"), what, "Give densities in t/mm3, of steel 7.85e-9")


def _unit(value: float, metals: tuple[float, float], units: dict[float, str]) -> str:
    """Say which unit would make a metal of the value; empty where none does."""
    for factor, unit in units.items():
        if metals[0] <= value / factor <= metals[1]:
            return f"; in {unit} it would be {value / factor:.3g}"
    return ""
