"""The body of a case as its small files describe it: modes, welds, lines, curves, mesh; forces are read later."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fatigue.case import Case, check_files
from fatigue.errors import DataError, Problem, refuse
from fatigue.pipeline.rated_curves import RatedCurve, curves_of_case, rated_curves
from fatigue.readers.body import Mesh, Modes, Weld, read_mesh, read_modes, read_weld_nodes, read_welds
from fatigue.readers.line_file import LineFile, line_file
from fatigue.readers.neutral_folder import RECORD, read_record
from fatigue.readers.spare_memory import give_back
from fatigue.readers.weld_register import REGISTER, RegisterRow, read_register
from fatigue.weld.line_units import unit_problems, unit_warnings


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """One body under one case.

    ``lines`` has one line per weld, in the order of ``welds`` and not yet split at kinks; ``curves`` holds every curve
    a weld asks for; ``mesh`` serves the balance check and pictures; ``excluded`` are the lines the weld register lists
    as not assessed; ``conversion`` is what `fatigue convert` recorded, its audit included; ``warnings`` are the doubts
    about these files.
    """

    case: Case
    modes: Modes
    welds: tuple[Weld, ...]
    lines: LineFile
    curves: Mapping[str, RatedCurve]
    mesh: Mesh | None
    excluded: tuple[RegisterRow, ...]
    conversion: Mapping[str, Any] | None
    strict: bool
    warnings: tuple[Problem, ...]

    def curve_of(self, weld: Weld) -> str:
        """Key of the curve of a weld: its own, else that of the case."""
        return weld.curve or self.case.curve.name


def read_body(case: Case, *, strict: bool) -> Body:
    """Read and check the small files of a case.

    Raises
    ------
    CaseError, DataError : with every mistake found in the file at fault
    """
    check_files(case)
    files = case.body
    known_curves = curves_of_case(case)
    modes, warnings = read_modes(case.resolve(files.modes), files.ignore_modes, strict=strict)
    welds, doubts = read_welds(case.resolve(files.welds), known_curves, strict=strict)
    warnings += doubts
    curves = rated_curves(case, known_curves, welds)
    lines, doubts = _lines_on_disk(case, welds, strict=strict)
    warnings += doubts
    give_back()
    mesh: Mesh | None = None
    if files.nodes:
        elements = case.resolve(files.elements) if files.elements else None
        mesh, doubts = read_mesh(case.resolve(files.nodes), elements, strict=strict)
        warnings += doubts
    record = conversion_file(case)
    conversion = read_record(record) if record else None
    register = register_file(case)
    rows = read_register(register).values() if register else ()
    excluded = tuple(row for row in rows if row.status != "assess")
    return Body(case, modes, welds, lines, curves, mesh, excluded, conversion, strict, tuple(warnings))


def _lines_on_disk(case: Case, welds: Sequence[Weld], *, strict: bool) -> tuple[LineFile, list[Problem]]:
    """Read and check the lines of all welds; in memory they are together only here."""
    lines, doubts = read_weld_nodes(case.resolve(case.body.weld_nodes), welds, strict=strict)
    refuse(DataError, unit_problems(lines, case.body.weld_nodes))
    return line_file(lines), doubts + unit_warnings(lines, case.body.weld_nodes)


def register_file(case: Case) -> Path | None:
    """Find the register that `fatigue convert` wrote beside the welds; None where there is none."""
    return _beside_the_welds(case, REGISTER)


def conversion_file(case: Case) -> Path | None:
    """Find the record of `fatigue convert` beside the welds, with its audit; None where there is none."""
    return _beside_the_welds(case, RECORD)


def _beside_the_welds(case: Case, name: str) -> Path | None:
    path = case.resolve(case.body.welds).parent / name
    return path if path.exists() else None
