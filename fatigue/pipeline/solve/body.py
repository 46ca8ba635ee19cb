"""The body of a case as its small files describe it: modes, welds, lines, curves, mesh; forces are read later."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.case import Case, case_warnings, check_files
from fatigue.errors import DataError, Problem, refuse
from fatigue.files.look_alike import name_warnings
from fatigue.pipeline.solve.check_curves import path_problems, point_curves, throat_curves
from fatigue.pipeline.solve.compared_cases import Compared, endurance_curves, read_compared, refuse_wrong_checks
from fatigue.pipeline.solve.curve_warnings import cutoff_warnings, thin_plate_warnings, unverified_warnings
from fatigue.pipeline.solve.rated_curves import (
    RatedCurve,
    asked_curves,
    attachment_problems,
    curves_of_case,
    rated_curves,
)
from fatigue.readers.convert.folder import RECORD, read_record
from fatigue.readers.neutral.against_mesh import TableNames, mesh_warnings
from fatigue.readers.neutral.body.classes import class_warnings
from fatigue.readers.neutral.body.columns import read_columns
from fatigue.readers.neutral.body.coordinates import Coordinates
from fatigue.readers.neutral.body.lines import checked_lines, read_lines
from fatigue.readers.neutral.body.mesh import Mesh, read_mesh
from fatigue.readers.neutral.body.modes import Modes, read_modes
from fatigue.readers.neutral.body.strength_factors import StrengthFactor, read_strength_factors
from fatigue.readers.neutral.body.throats import WeldThroat, assessed_throats, check_throats, read_throats
from fatigue.readers.neutral.body.welds import Weld, read_welds
from fatigue.readers.neutral.line_file import LineFile, line_file
from fatigue.readers.neutral.points.beside_welds import assessed_names, compared_with_welds
from fatigue.readers.neutral.points.stress_points import StressPoints, read_stress_points
from fatigue.readers.neutral.register.conversion import convert_record
from fatigue.readers.neutral.register.register_file import open_register
from fatigue.readers.neutral.register.registered import Registered, registered, unregistered
from fatigue.readers.neutral.register.registered_lines import Joints, registered_lines, unconfirmed_thickness
from fatigue.readers.neutral.register.registered_solids import NO_SOLIDS, Solids, registered_solids
from fatigue.readers.neutral.register.weld_register import REGISTER, RegisterRow
from fatigue.readers.neutral.spare_memory import give_back
from fatigue.weld.line_units import unit_problems, unit_warnings
from fatigue.weld.warnings.summed_corners import summed_corners


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """One body under one case.

    ``welds`` are those to assess, as the weld register has them; ``in_tables`` all welds, as the tables have them.
    ``register`` tells which are which, ``joints`` where lines of one name were joined. ``lines`` has one line per weld,
    in the order of ``welds`` and not yet split at kinks; ``solids`` has the columns of those of solid elements;
    ``curves`` holds every curve a weld asks for; ``throats`` are those of the welds that have one, by their names;
    ``compared`` static load cases and endurance lines; ``points`` are the stress points, None without them; ``mesh``
    serves the balance check and pictures; ``conversion`` is what
    ``fatigue convert`` recorded, its audit included; ``warnings`` are about these files.
    """

    case: Case
    modes: Modes
    welds: tuple[Weld, ...]
    in_tables: tuple[Weld, ...]
    register: Registered
    joints: Joints
    lines: LineFile
    curves: Mapping[str, RatedCurve]
    throats: Mapping[str, WeldThroat]
    compared: Compared
    mesh: Mesh | None
    conversion: Mapping[str, Any] | None
    strict: bool
    warnings: tuple[Problem, ...]
    points: StressPoints | None = None
    solids: Solids = NO_SOLIDS

    @property
    def nodes_of_forces(self) -> NDArray[np.int64]:
        """Position of each line's first node among all that forces are given at, (k + 1,): blocks are cut by it."""
        return self.solids.begin(self.lines)

    @property
    def coordinates(self) -> Coordinates:
        """Modes and unit loads: what the stress of the body is a sum over."""
        return Coordinates(self.modes, tuple(load.name for load in self.case.body.unit_load))

    @property
    def excluded(self) -> tuple[RegisterRow, ...]:
        """Rows of the register that are not assessed."""
        return self.register.left_out

    def curve_of(self, weld: Weld) -> RatedCurve:
        """Curve of a weld: its own, else the curve of the case."""
        return self.curves[weld.curve or self.case.curve.name].at(weld)


def read_body(case: Case, *, strict: bool) -> Body:
    """The body of a case, its small files read and checked.

    Raises
    ------
    CaseError, DataError : with every mistake found in the file at fault
    """
    check_files(case)
    files = case.body
    known_curves = curves_of_case(case)
    modes, warnings = read_modes(case.resolve(files.modes), files.ignore_modes, strict=strict)
    register = register_file(case)
    in_tables, of_welds = read_welds(case.resolve(files.welds), None if register else known_curves, strict=strict)
    warnings += of_welds
    plan = unregistered(in_tables)
    if register:
        conversion = convert_record(conversion_file(case))
        plan = registered(open_register(register, strict=strict), in_tables, conversion, known_curves)
    warnings += plan.warnings
    warnings += class_warnings(plan.welds, plan.file or files.welds)
    names = (weld.name for weld in (*in_tables, *plan.welds))
    warnings += case_warnings(case) + name_warnings(f"{files.welds}: column weld", names, "welds")
    throats, of_throats = _throats(case, in_tables, plan, strict=strict)
    points, of_points = _points(case, plan, in_tables, known_curves, strict=strict)
    warnings += of_throats + of_points
    factors: tuple[StrengthFactor, ...] = ()
    if case.checks.strength_factors is not None:
        table = case.resolve(case.checks.strength_factors)
        factors, of_factors = read_strength_factors(table, known_curves, strict=strict)
        warnings += of_factors
    of_checks = [*throat_curves(case, throats), *point_curves(points), *endurance_curves(case, known_curves)]
    curves = rated_curves(case, known_curves, [*asked_curves(case, plan.welds), *of_checks], factors)
    refuse(DataError, (*attachment_problems(case, plan.welds, curves), *path_problems(case, throats, curves)))
    warnings += unverified_warnings(case, plan.welds, curves) + cutoff_warnings(case, curves)
    loads = tuple(load.name for load in case.body.unit_load)
    compared, of_compared = read_compared(case, Coordinates(modes, loads), known_curves, strict=strict)
    refuse_wrong_checks(case, plan.welds, points, compared, curves)
    mesh: Mesh | None = None
    of_mesh: list[Problem] = []
    if files.nodes:
        elements = case.resolve(files.elements) if files.elements else None
        mesh, of_mesh = read_mesh(case.resolve(files.nodes), elements, strict=strict)
    welds, lines, joints, solids, of_lines = _lines_on_disk(case, in_tables, plan, curves, mesh, strict=strict)
    warnings += of_compared + of_lines + of_mesh
    if throats:
        check_throats(throats, lines, str(files.weld_throats))
    if points:
        of_frames, doubts = compared_with_welds(points, lines)
        refuse(DataError, of_frames)
        warnings += doubts
    give_back()
    record = conversion_file(case)
    return Body(
        case=case,
        modes=modes,
        welds=welds,
        in_tables=in_tables,
        register=plan,
        joints=joints,
        lines=lines,
        curves=curves,
        throats=throats,
        compared=compared,
        mesh=mesh,
        conversion=read_record(record) if record else None,
        strict=strict,
        warnings=tuple(warnings),
        points=points,
        solids=solids,
    )


def _throats(
    case: Case, in_tables: Sequence[Weld], plan: Registered, *, strict: bool
) -> tuple[dict[str, WeldThroat], list[Problem]]:
    """Throats of the welds to assess, and the warnings about the table."""
    file = case.body.weld_throats
    if file is None:
        return {}, []
    assessed = {weld.name for weld in plan.welds}
    known = assessed | {weld.name for weld in in_tables} | {row.weld for row in plan.left_out}
    throats, warnings = read_throats(case.resolve(file), known, strict=strict)
    some, of_others = assessed_throats(throats, assessed, file)
    return some, [*warnings, *of_others]


def _points(
    case: Case, plan: Registered, in_tables: Sequence[Weld], curves: Collection[str], *, strict: bool
) -> tuple[StressPoints | None, list[Problem]]:
    """The stress points of a case, and the warnings about their table; their welds as they are assessed."""
    if case.body.stress_points is None:
        return None, []
    others = [*(weld.name for weld in in_tables), *(row.weld for row in plan.left_out)]
    welds = assessed_names(plan.names, others)
    return read_stress_points(case.resolve(case.body.stress_points), welds, curves, strict=strict)


def _lines_on_disk(
    case: Case,
    in_tables: Sequence[Weld],
    plan: Registered,
    curves: Mapping[str, RatedCurve],
    mesh: Mesh | None,
    *,
    strict: bool,
) -> tuple[tuple[Weld, ...], LineFile, Joints, Solids, list[Problem]]:
    """Lines of all welds to assess, read and checked, also by the mesh; only here they are in memory together."""
    path = case.resolve(case.body.weld_nodes)
    lines, warnings = read_lines(path, in_tables, plan.names, strict=strict)
    solids = NO_SOLIDS
    if case.body.weld_columns is not None:
        of_tables, of_columns = read_columns(case.resolve(case.body.weld_columns), lines, mesh, strict=strict)
        solids = registered_solids(of_tables, plan)
        warnings += of_columns
    welds: tuple[Weld, ...] = plan.welds
    joints: Joints = {}
    if plan.file:
        warnings += unconfirmed_thickness(lines, plan)
        welds, lines, joints = registered_lines(lines, plan, summed=case.body.nodal_forces is not None)
    warnings += checked_lines(lines, path.name)
    refuse(DataError, unit_problems(lines, case.body.weld_nodes))
    warnings += unit_warnings(lines, case.body.weld_nodes)
    rated = [curves[weld.curve or case.curve.name] for weld in welds]
    warnings += thin_plate_warnings(lines, rated, path.name)
    if case.body.nodal_forces is not None:
        warnings += summed_corners(lines, [float(one.rule.law.slopes[0]) for one in rated], path.name)
    if mesh is not None:
        names = TableNames(path.name, Path(case.body.nodes or "").name, Path(case.body.elements or "").name)
        knows_sides = case.body.weld_elements is not None
        shells = solids.others(lines)
        warnings += mesh_warnings(shells, mesh, names, plan.confirmed, knows_sides=knows_sides)
    return welds, line_file(lines), joints, solids, warnings


def register_file(case: Case) -> Path | None:
    """The weld register that the case names, else the one beside the welds; None where there is none."""
    named = case.body.weld_register
    return _beside_the_welds(case, REGISTER) if named is None else case.resolve(named)


def conversion_file(case: Case) -> Path | None:
    """The record of ``fatigue convert`` beside the welds, with its audit; None where there is none."""
    return _beside_the_welds(case, RECORD)


def _beside_the_welds(case: Case, name: str) -> Path | None:
    path = case.resolve(case.body.welds).parent / name
    return path if path.exists() else None
