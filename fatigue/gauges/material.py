"""What the plate under a gauge is made of: from the row of the gauge, else from the table of properties of the case.

Nothing is assumed. A thickness that is not that of a homogeneous plate, of a layered, sandwich or equivalent-bending
section, is refused unless the row of the gauge confirms one by hand, as it is for welds.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from fatigue.errors import DataError, Problem
from fatigue.gauges.gauge_file import Gauge
from fatigue.readers.neutral.tables import open_table

ROUNDED = 1e-3  # relative: as somebody may write a thickness down


@dataclass(frozen=True, slots=True)
class Material:
    """Elastic constants [MPa], [-]."""

    E: float
    nu: float


@dataclass(frozen=True, slots=True)
class Section:
    """Material of a property and its thickness for membrane and for bending [mm], NaN where the table has none."""

    material: Material
    thickness: float
    bending: float


@dataclass(frozen=True, slots=True)
class Properties:
    """Sections by property id, and the name of their file; nothing where the case names none."""

    file: str = ""
    sections: Mapping[int, Section] = field(default_factory=dict)

    @property
    def only_material(self) -> Material | None:
        """The material of all properties, None where they have several or there are none."""
        found = {section.material for section in self.sections.values()}
        return found.pop() if len(found) == 1 else None


def read_properties(path: Path, *, strict: bool) -> tuple[Properties, list[Problem]]:
    """Read ``pid, E_MPa, nu`` and, where present, ``thickness_mm`` and ``bending_thickness_mm``.

    Raises
    ------
    DataError : a property twice, a constant that no material has
    """
    table = open_table(path)
    table.expect(
        ("pid", "E_MPa", "nu"), ("thickness_mm", "bending_thickness_mm", "rho_t_mm3", "nsm_t_mm2"), strict=strict
    )
    pid = table.integers("pid")
    table.unique({"pid": pid})
    E, nu = table.numbers("E_MPa", above=0.0), table.numbers("nu", least=0.0)
    table.report(nu >= 0.5, "bad_value", "nu", f"{nu.max(initial=0.0):g} is not below 0.5", "Give Poisson's ratio")
    thickness = table.numbers("thickness_mm", default=np.nan, above=0.0)
    bending = table.numbers("bending_thickness_mm", default=np.nan, above=0.0)
    table.refuse()
    rows = zip(pid.tolist(), E.tolist(), nu.tolist(), thickness.tolist(), bending.tolist(), strict=True)
    sections = {one: Section(Material(e, n), t, b) for one, e, n, t, b in rows}
    return Properties(path.name, sections), table.warnings


def material_of(gauge: Gauge, properties: Properties, pid: int | None) -> Material:
    """Material under a gauge; ``pid``: property of the element it sits on, None where it sits on none.

    Raises
    ------
    DataError : it is known from nowhere
    """
    if gauge.E is not None and gauge.nu is not None:
        return Material(gauge.E, gauge.nu)
    if pid is None and properties.only_material is not None:
        return properties.only_material
    if pid is not None and pid in properties.sections:
        return properties.sections[pid].material
    if not properties.file:
        what = "E_MPa and nu are known from nowhere"
    elif pid is None:
        what = f"E_MPa and nu are empty, and {properties.file} has several materials"
    else:
        what = f"E_MPa and nu are empty, and property {pid} is not in {properties.file}"
    remedy = "Give them in the row, or name the table of properties in the case: properties under [body]"
    raise DataError(Problem("no_material", gauge.where, what, remedy))


def thickness_of(gauge: Gauge, properties: Properties, element: int, pid: int, own: float, doubt: str = "") -> float:
    """Thickness of the plate under a gauge on an element [mm]: confirmed by hand, else ``own``, else its property's.

    ``doubt``: why the mesh says that its thickness is not that of a plate; empty: it does not.

    Raises
    ------
    DataError : there is none, or the section is no homogeneous plate
    """
    if gauge.thickness is not None:
        return gauge.thickness
    remedy = "Move the gauge, or confirm the thickness of the plate there: thickness_mm in its row"
    if doubt:
        what = f"the stress of the surface of element {element} does not follow from its forces: {doubt}"
        raise DataError(Problem("layered", gauge.where, what, remedy))
    section = properties.sections.get(pid)
    in_bending = np.nan if section is None else section.bending
    found = section.thickness if np.isnan(own) and section is not None else own
    if np.isnan(found):
        raise DataError(Problem("no_thickness", gauge.where, f"element {element} has no thickness", remedy))
    if abs(in_bending - found) > ROUNDED * found:
        what = f"element {element}, property {pid}, is {found:g} mm thick and bends as {in_bending:g} mm: it is no "
        what += "homogeneous plate, and the stress of its surface does not follow from its forces"
        raise DataError(Problem("layered", gauge.where, what, remedy))
    return float(found)
