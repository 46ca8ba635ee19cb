"""Gauges as somebody lists them: what each reads, where it sits, which way it points, what it is made of.

A row is one grid. A rosette is three rows; a bridge is a weighted sum of rows and belongs to the table of channels.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.neutral.tables import Table, open_table

Vector = tuple[float, float, float]
Given = dict[str, NDArray[np.float64]]  # numbers of a column, NaN of an empty cell

ELEMENT, TABLE, TOE = "element", "table", "toe"
KINDS = (ELEMENT, TABLE, TOE)
RESERVED = "acceleration"  # a reading that needs the rigid modes
SURFACES = ("top", "bottom", "edge")
PLACE, NORMAL, DIRECTION = ("x_mm", "y_mm", "z_mm"), ("normal_x", "normal_y", "normal_z"), ("dir_x", "dir_y", "dir_z")
TEXTS = ("gauge", "kind", "surface", "point", "weld", "group")
NUMBERS = (*PLACE, *NORMAL, *DIRECTION, "angle_deg", "thickness_mm", "E_MPa", "nu")
OTHERS = ("element", "part", "order", "grid_length_mm", "transverse_sensitivity", "cost")
NOT_OF = {  # columns that mean nothing for a kind, and are refused where they are filled
    ELEMENT: ("point", "weld", "order", "part"),
    TABLE: ("element", *PLACE, *NORMAL, "weld", "order", "part", "grid_length_mm", "thickness_mm"),
    TOE: ("element", *PLACE, *NORMAL, "angle_deg", *DIRECTION, "point", "grid_length_mm", "thickness_mm"),
}
MOST_TRANSVERSE = 0.2  # of the sensitivity along the grid; foil gauges have 0.02 and less


@dataclass(frozen=True, slots=True)
class Gauge:
    """One grid of a strain gauge, as its row says; None and "" are what it leaves out.

    Attributes
    ----------
    name, kind : of the gauge; one of ``KINDS``
    where : file and row, for messages
    element : id of the element it sits on
    xyz, normal : or a place [mm] and the outward normal of the plate there
    angle_deg : direction of the grid from axis x of the element, or of the stress point, towards its y [deg]
    direction : or a vector, of which the part in the plane counts
    surface : top, bottom or edge
    point : stress point of the case
    weld, part, order : station of a weld line; ``part`` None: the only one with this order
    grid_length : of the grid [mm], 0: the element as a whole
    transverse_sensitivity : of the grid, across over along [-]
    thickness : of the plate [mm], confirmed by hand
    E, nu : material [MPa], [-]
    group, cost : for the choice among candidates
    """

    name: str
    kind: str
    where: str
    element: int | None = None
    xyz: Vector | None = None
    normal: Vector | None = None
    angle_deg: float | None = None
    direction: Vector | None = None
    surface: str = ""
    point: str = ""
    weld: str = ""
    part: int | None = None
    order: int | None = None
    grid_length: float = 0.0
    transverse_sensitivity: float = 0.0
    thickness: float | None = None
    E: float | None = None
    nu: float | None = None
    group: str = ""
    cost: float = 1.0


def read_gauges(path: Path, *, strict: bool = False) -> tuple[tuple[Gauge, ...], list[Problem]]:
    """Read the table of gauges, and the warnings about it.

    Raises
    ------
    DataError
        a gauge twice, an unknown kind, a place or direction that is missing or given twice, a value out of its range
    """
    table = open_table(path, texts=TEXTS)
    table.expect(("gauge", "kind"), (*TEXTS[2:], *NUMBERS, *OTHERS), strict=strict)
    names, code = table.groups("gauge")
    table.unique({"gauge": code}, {"gauge": names})
    kinds, surfaces = table.texts("kind"), table.texts("surface", default="")
    _refuse_kinds(table, kinds)
    table.choices("surface", surfaces, ("", *SURFACES))
    texts = {name: table.texts(name, default="") for name in ("point", "weld", "group")}
    given = {name: table.numbers(name, default=np.nan).astype(np.float64) for name in NUMBERS}
    ids = {name: _ids(table, name) for name in ("element", "part", "order")}
    length = table.numbers("grid_length_mm", default=0.0, least=0.0)
    across = table.numbers("transverse_sensitivity", default=0.0)
    cost = table.numbers("cost", default=1.0, above=0.0)
    what = f"{across[int((np.abs(across) > MOST_TRANSVERSE).argmax())]:g} is beyond +-{MOST_TRANSVERSE:g}"
    remedy = "Give a ratio, not percent: 0.8 % are 0.008"
    table.report(np.abs(across) > MOST_TRANSVERSE, "bad_value", "transverse_sensitivity", what, remedy)
    _refuse_materials(table, given)
    table.refuse()
    gauges = tuple(
        Gauge(
            name=names[code[i]],
            kind=kinds[i],
            where=f"{path.name}: gauge '{names[code[i]]}' ({table.row_name(i)})",
            element=ids["element"][i],
            xyz=_vector(given, PLACE, i),
            normal=_vector(given, NORMAL, i),
            angle_deg=_number(given, "angle_deg", i),
            direction=_vector(given, DIRECTION, i),
            surface=surfaces[i],
            point=texts["point"][i],
            weld=texts["weld"][i],
            part=ids["part"][i],
            order=ids["order"][i],
            grid_length=float(length[i]),
            transverse_sensitivity=float(across[i]),
            thickness=_number(given, "thickness_mm", i),
            E=_number(given, "E_MPa", i),
            nu=_number(given, "nu", i),
            group=texts["group"][i],
            cost=float(cost[i]),
        )
        for i in range(table.rows)
    )
    for i, gauge in enumerate(gauges):
        filled = _filled(given, ids, texts, length, i)
        table.problems.extend(_senseless(gauge, filled))
    table.refuse()
    return gauges, table.warnings


def _refuse_kinds(table: Table, kinds: Sequence[str]) -> None:
    """Note kinds that there are not, the reserved one in words of its own."""
    reserved = np.array([kind == RESERVED for kind in kinds], dtype=np.bool_)
    what = "accelerations are not read here: they need the rigid modes of the body, which carry no element force"
    table.report(reserved, "reserved_kind", "kind", what, f"Give one of {', '.join(KINDS)}, or remove the row")
    table.choices("kind", kinds, (*KINDS, RESERVED))


def _refuse_materials(table: Table, given: Given) -> None:
    """Note moduli, thicknesses and Poisson's ratios that no material has."""
    for name in ("E_MPa", "thickness_mm"):
        low = given[name] <= 0.0
        what = f"{given[name][int(low.argmax())]:g} is not above 0"
        table.report(low, "bad_value", name, what, "Give more than 0")
    beyond = (given["nu"] < 0.0) | (given["nu"] >= 0.5)
    what = f"{given['nu'][int(beyond.argmax())]:g} is not in 0 to 0.5"
    table.report(beyond, "bad_value", "nu", what, "Give Poisson's ratio of the material")


def _ids(table: Table, name: str) -> list[int | None]:
    """Whole numbers of a column, None of an empty cell."""
    there = ~np.isnan(table.numbers(name, default=np.nan))
    values = table.integers(name, default=0)
    return [value if filled else None for value, filled in zip(values.tolist(), there.tolist(), strict=True)]


def _number(given: Given, name: str, i: int) -> float | None:
    value = float(given[name][i])
    return None if math.isnan(value) else value


def _vector(given: Given, names: tuple[str, ...], i: int) -> Vector | None:
    """Vector of three columns; None where all are empty, with NaN for what is missing of one."""
    x, y, z = (float(given[name][i]) for name in names)
    return None if math.isnan(x) and math.isnan(y) and math.isnan(z) else (x, y, z)


def _filled(
    given: Given, ids: dict[str, list[int | None]], texts: dict[str, list[str]], length: NDArray[np.floating], i: int
) -> set[str]:
    """Columns in which a row has something."""
    filled = {name for name, values in given.items() if not math.isnan(values[i])}
    filled |= {name for name, values in ids.items() if values[i] is not None}
    filled |= {name for name, values in texts.items() if values[i]}
    return filled | ({"grid_length_mm"} if length[i] else set())


def _senseless(gauge: Gauge, filled: set[str]) -> list[Problem]:
    """What is missing of a row, or contradicts itself."""

    def problem(what: str, remedy: str) -> Problem:
        return Problem("bad_gauge", gauge.where, what, remedy)

    found = []
    if strays := [name for name in NOT_OF[gauge.kind] if name in filled]:
        what = f"{', '.join(strays)} {'mean' if len(strays) > 1 else 'means'} nothing for kind {gauge.kind}"
        found.append(problem(what, "Leave it empty, or give another kind"))
    for names, vector in ((PLACE, gauge.xyz), (NORMAL, gauge.normal), (DIRECTION, gauge.direction)):
        if vector is not None and any(math.isnan(value) for value in vector):
            lacking = next(name for name, value in zip(names, vector, strict=True) if math.isnan(value))
            found.append(problem(f"{lacking} is empty, and the other two are given", f"Give {', '.join(names)}"))
        elif vector is not None and names is not PLACE and not any(vector):
            found.append(problem(f"{', '.join(names)} are all 0", "Give a vector that has a direction"))
    if (gauge.E is None) != (gauge.nu is None):
        found.append(problem("one of E_MPa and nu is given alone", "Give both of one material, or neither"))
    if found:
        return found
    if gauge.angle_deg is not None and gauge.direction is not None:
        found.append(problem("angle_deg and dir_x, dir_y, dir_z are both given", "Keep one of them"))
    elif gauge.kind != TOE and gauge.angle_deg is None and gauge.direction is None:
        found.append(problem("nothing says which way the grid points", "Give angle_deg, or dir_x, dir_y, dir_z"))
    return found + {ELEMENT: _of_element, TABLE: _of_table, TOE: _of_toe}[gauge.kind](gauge, problem)


def _of_element(gauge: Gauge, problem: "_Say") -> list[Problem]:
    """What is wrong with the place of a gauge on an element."""
    found = []
    if gauge.element is not None and gauge.xyz is not None:
        found.append(problem("element and x_mm, y_mm, z_mm are both given", "Keep one of them"))
    elif gauge.element is None and gauge.xyz is None:
        found.append(problem("nothing says where it sits", "Give element, or x_mm, y_mm, z_mm and a normal"))
    elif gauge.element is not None:
        if gauge.normal is not None:
            found.append(problem("a normal is given for an element", "Say surface = top or bottom instead"))
        if gauge.surface not in ("top", "bottom"):
            found.append(problem("nothing says which face it is on", "Give surface = top or bottom"))
    else:
        if gauge.normal is None:
            found.append(problem("the outward normal is missing", "Give normal_x, normal_y, normal_z of the face"))
        if gauge.angle_deg is not None:
            what = "angle_deg is given with a place: it counts from axis x of an element that is yet to be found"
            found.append(problem(what, "Give dir_x, dir_y, dir_z"))
        if gauge.surface:
            what = f"surface = {gauge.surface} is given with a place, whose normal says which face it is"
            found.append(problem(what, "Leave surface empty"))
    return found


def _of_table(gauge: Gauge, problem: "_Say") -> list[Problem]:
    """What is wrong with a gauge at a stress point."""
    return [] if gauge.surface else [problem("surface is empty", f"Give one of {', '.join(SURFACES)}")]


def _of_toe(gauge: Gauge, problem: "_Say") -> list[Problem]:
    """What is wrong with a stand-in at a weld toe."""
    found = []
    if not gauge.weld or gauge.order is None:
        found.append(problem("weld or order is empty", "Give the weld and the order of the node along it"))
    if gauge.surface not in ("top", "bottom"):
        found.append(problem("nothing says which face it is on", "Give surface = top or bottom"))
    return found


_Say = Callable[[str, str], Problem]
