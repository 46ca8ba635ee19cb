"""The throats of fillet welds in the neutral format: which welds are checked at their root, and their sections."""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, TypeAlias, cast

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.neutral.tables import Table, open_table
from fatigue.shown import few
from fatigue.weld.line import WeldLine
from fatigue.weld.throat import Lever, Side, Throat, lap_throat, tee_throat

Joint: TypeAlias = Literal["tee", "lap", "custom"]
Combination: TypeAlias = Literal["direction", "path"]
JOINTS = ("tee", "lap", "custom")
SIDES: dict[str, tuple[Side, ...]] = {"both": ("top", "bottom"), "top": ("top",), "bottom": ("bottom",)}
LEVERS = ("throats", "t")
COMBINATIONS = ("direction", "path")
REQUIRED = ("weld", "joint", "sides", "throat_mm", "line_offset_mm", "curve", "curve_shear", "ended_plate")
SECTION = ("angle_deg", "root_y_mm", "root_z_mm")  # of a custom joint
OPTIONAL = ("penetration_mm", *SECTION, "lever", "combination", "curve_root")
SMALLEST_THROAT = 1.0  # mm
LARGEST_THROAT = 1.5  # of the thickness of the plate that ends
DEEPEST = 0.5  # of the thickness, penetration
NAMED = 5  # welds in a warning


@dataclass(frozen=True, slots=True)
class WeldThroat:
    """The fillet welds along one weld line, at the plate that ends there, and the curves of their stresses.

    ``throat`` (penetration included), ``penetration``, ``line_offset``, ``root_y`` and ``root_z`` in mm, the last two
    and ``angle_deg`` as in ``fatigue.weld.throat``, of a custom joint only. ``curve`` is for the normal and shear
    stress across the weld, counted in their critical direction or as a path, ``curve_shear`` for the shear stress along
    it, ``curve_root`` for the structural stress of the throat, None: not assessed.
    """

    weld: str
    joint: Joint
    sides: tuple[Side, ...]
    throat: float
    penetration: float
    line_offset: float
    angle_deg: float
    root_y: float
    root_z: float
    lever: Lever
    combination: Combination
    curve: str
    curve_shear: str
    curve_root: str | None

    def section(self, thickness: NDArray[np.float64]) -> Throat:
        """The throat at plates of some thickness (n,) [mm]."""
        if self.joint == "custom":
            like = np.ones_like(thickness)
            return Throat(self.throat, self.angle_deg, self.root_y * like, self.root_z * like)
        of_joint = tee_throat if self.joint == "tee" else lap_throat
        return of_joint(thickness, self.throat, self.penetration, self.line_offset)


def read_throats(path: Path, welds: Collection[str], *, strict: bool) -> tuple[dict[str, WeldThroat], list[Problem]]:
    """Throats by the name of their weld; ``welds`` are the names there are.

    Raises
    ------
    DataError : the mistakes of the table
    """
    table = open_table(
        path, texts=("weld", "joint", "sides", "lever", "combination", "curve", "curve_shear", "curve_root")
    )
    table.expect(REQUIRED, OPTIONAL, strict=strict)
    names, code = table.groups("weld")
    table.known("weld", names, code, welds, "the welds")
    table.unique({"weld": code}, {"weld": names})
    joint, sides = table.texts("joint"), table.texts("sides")
    table.choices("joint", joint, JOINTS)
    table.choices("sides", sides, tuple(SIDES))
    lever = table.texts("lever", default="throats")
    table.choices("lever", lever, LEVERS)
    combination = table.texts("combination", default="direction")
    table.choices("combination", combination, COMBINATIONS)
    throat = table.numbers("throat_mm", least=SMALLEST_THROAT)
    penetration = table.numbers("penetration_mm", default=0.0, least=0.0)
    offset = table.numbers("line_offset_mm")
    section = [table.numbers(name, default=np.nan) for name in SECTION]
    curve, curve_shear = table.texts("curve"), table.texts("curve_shear")
    curve_root = table.texts("curve_root", default="")
    _refuse_other_plates(table)
    _refuse_misfits(table, np.array(joint), np.array(sides), np.array(lever))
    table.refuse()
    angle, root_y, root_z = section
    throats = {
        names[code[i]]: WeldThroat(
            weld=names[code[i]],
            joint=cast(Joint, joint[i]),
            sides=SIDES[sides[i]],
            throat=float(throat[i]),
            penetration=float(penetration[i]),
            line_offset=float(offset[i]),
            angle_deg=float(angle[i]),
            root_y=float(root_y[i]),
            root_z=float(root_z[i]),
            lever=cast(Lever, lever[i]),
            combination=cast(Combination, combination[i]),
            curve=curve[i],
            curve_shear=curve_shear[i],
            curve_root=curve_root[i] or None,
        )
        for i in range(table.rows)
    }
    return throats, [*table.warnings, *_offset_warnings(path.name, throats)]


def _refuse_other_plates(table: Table) -> None:
    """Refuse a row that does not say that the forces are those of the plate that ends: nothing else can tell."""
    ends = table.flags("ended_plate", default=False)
    what = "the cut is not said to be through the plate that ends at the weld"
    remedy = (
        "Give true where the forces of this weld are those of the plate that ends there, the web of a tee or the plate "
        "that is lapped; else let the weld be assessed on that plate, or remove the row"
    )
    table.report(~ends, "not_ended", "ended_plate", what, remedy)


def _refuse_misfits(table: Table, joint: NDArray[np.str_], sides: NDArray[np.str_], lever: NDArray[np.str_]) -> None:
    """Refuse what does not go with the joint or the sides of a row."""
    custom = joint == "custom"
    what = "both does not go with joint lap: a plate is lapped on one of its faces"
    table.report((joint == "lap") & (sides == "both"), "contradiction", "sides", what, "Give top or bottom")
    what = "the lever t does not go with a weld on one side, which has no couple"
    one = (sides == "top") | (sides == "bottom")
    table.report((lever == "t") & one, "contradiction", "lever", what, "Leave it empty")
    for name in SECTION:
        given = ~np.isnan(table.numbers(name, default=np.nan))
        what, remedy = "the value is given although joint is not custom", "Leave it empty, or give joint custom"
        table.report(given & ~custom, "contradiction", name, what, remedy)
        what = "the value is missing although joint is custom"
        table.report(~given & custom, "missing_value", name, what, "Give the angle and the root of the section")
    angle = table.numbers("angle_deg", default=0.0)
    what = f"{_first(angle, np.abs(angle) > 90.0):g} is not from -90 to 90"
    remedy = "Give the angle from y', out of the plate, to the normal of the section: 45 at a tee, -45 at a lap joint"
    table.report(np.abs(angle) > 90.0, "bad_value", "angle_deg", what, remedy)
    for name, why in {
        "penetration_mm": "the root of a custom joint is given by root_y_mm and root_z_mm",
        "line_offset_mm": "root_y_mm of a custom joint is measured from the line and contains it",
    }.items():
        values = table.numbers(name, default=0.0)
        what = f"{_first(values, custom & (values != 0.0)):g} is given, but {why}"
        table.report(custom & (values != 0.0), "contradiction", name, what, "Give 0")


def _offset_warnings(file: str, throats: Mapping[str, WeldThroat]) -> list[Problem]:
    """Warning about tees whose root plane lies beyond the line: as a rule the line is on it, or inside the base."""
    beyond = [one for one in throats.values() if one.joint == "tee" and one.line_offset > 0.0]
    if not beyond:
        return []
    what = (
        f"{beyond[0].line_offset:g} puts the surface of the base plate beyond the line, seen from the plate that ends; "
        "as a rule the line is on this surface (0) or inside the base plate (below 0)"
    )
    what += f" ({len(beyond)} welds)" if len(beyond) > 1 else ""
    remedy = "Give y of the surface minus y of the line, y out of the plate that ends"
    where = f"{file}: weld {beyond[0].weld}: line_offset_mm"
    return [Problem("line_offset", where, what, remedy, len(beyond))]


def assessed_throats(
    throats: Mapping[str, WeldThroat], assessed: Collection[str], file: str
) -> tuple[dict[str, WeldThroat], list[Problem]]:
    """Throats of the welds that are assessed, and the warning about the others."""
    others = [name for name in throats if name not in assessed]
    warnings = []
    if others:
        what = f"not assessed by the weld register, so are their throats: {few(others, NAMED)}"
        remedy = "Change the status in the weld register, or remove the rows"
        warnings = [Problem("throat_not_assessed", f"{file}: column weld", what, remedy, len(others))]
    return {name: throat for name, throat in throats.items() if name in assessed}, warnings


def check_throats(throats: Mapping[str, WeldThroat], lines: Iterable[WeldLine], file: str) -> None:
    """Refuse throats that do not fit the thinnest place of the plate of their weld.

    Raises
    ------
    DataError : all of them
    """
    problems: list[Problem] = []
    for line in lines:
        if (throat := throats.get(line.weld)) is not None:
            problems += _misfits(throat, float(line.thickness.min()), f"{file}: weld {line.weld}")
    refuse(DataError, problems)


def _misfits(throat: WeldThroat, thickness: float, where: str) -> list[Problem]:
    found = []
    if throat.throat > LARGEST_THROAT * thickness:
        what = f"{throat.throat:g} is above {LARGEST_THROAT:g} times the thickness of {thickness:g} mm"
        remedy = "Give the throat, not the leg, in mm, or correct the thickness of the plate"
        found.append(Problem("bad_value", f"{where}: throat_mm", what, remedy))
    if throat.penetration > DEEPEST * thickness:
        what = f"{throat.penetration:g} is above half the thickness of {thickness:g} mm"
        remedy = "Give how far the root lies past the surface of the plate, in mm"
        found.append(Problem("bad_value", f"{where}: penetration_mm", what, remedy))
    if not found and len(throat.sides) == 2:
        _, z_c = throat.section(np.array([thickness])).centroid
        if z_c[0] <= 0.0:
            what = f"the centroid of the throat lies {z_c[0]:g} mm above the mid-surface: two welds have no lever"
            remedy = "Give the root of the weld on the top side; that on the bottom is its mirror image"
            found.append(Problem("bad_value", f"{where}: root_z_mm", what, remedy))
    return found


def _first(values: NDArray[np.float64], bad: NDArray[np.bool_]) -> float:
    return float(values[bad.argmax()]) if bad.size else 0.0
