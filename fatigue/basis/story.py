"""Is the modal basis complete enough for these welds: what the modes of a case carry, and what they leave out.

Nothing here simulates and nothing is a verdict about the design: a basis is a choice, and what it leaves out is an
error of truncation. Each question is a ``Finding`` with its reasons where the case cannot answer it.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from numbers import Real
from pathlib import Path

from fatigue.basis.counted import opened
from fatigue.basis.finding import Finding
from fatigue.basis.folder import FILLED, write_basis
from fatigue.basis.loaded.flexibility import flexibility
from fatigue.basis.loaded.interface import interface
from fatigue.basis.loaded.shapes import loaded_points
from fatigue.basis.mass.findings import modal_mass
from fatigue.basis.summary import Basis
from fatigue.basis.truncation import truncation
from fatigue.basis.two_bases.compare import two_bases
from fatigue.case import Case, given_case
from fatigue.case.tables import BASIS_FILES
from fatigue.errors import CaseError, Problem, given_path, refuse
from fatigue.files.recorded import refuse_foreign
from fatigue.pipeline.solve.body import Body, read_body
from fatigue.stages import stage

ABOUT_MODES = ("no_interface_mode", "unusual_damping", "unusual_frequency")  # warnings of a body that matter here


@dataclass(frozen=True, slots=True)
class Asked:
    """What is asked of the modes: up to which frequency, damping of those that have none, and damage without some."""

    band_hz: float | None = None
    damping: float | None = None
    damage: bool = True


def basis(
    case: Case | Path | str,
    other: Case | Path | str | None = None,
    *,
    into: Path | str | None = None,
    force: bool = False,
    csv: bool = False,
    band_hz: float | None = None,
    damping: float | None = None,
    damage: bool = True,
    strict: bool = False,
) -> Basis:
    """What is found about the modal basis of a case, written into a folder where one is given.

    Parameters
    ----------
    case : the case or its file
    other : a second case, whose basis is compared with the first
    into : folder for tables, page and record; None: nothing is written
    force : overwrite files in it that are not ours
    csv : write the tables as CSV as well
    band_hz : upper end of the band that has to be complete [Hz]; by default ``upper_hz`` of the case, else the highest
        frequency of its normal modes
    damping : damping ratio of the modes without one; None: they stay without dynamic mass
    damage : count damage without the highest modes, which takes as long as an assessment
    strict : take unknown columns for errors

    Raises
    ------
    CaseError, DataError : a mistake in the case or its files, or no damping ratio; files in the way in the folder
    """
    refuse(CaseError, _no_damping(damping))
    case = given_case(case)
    compared = None if other is None else given_case(other)
    folder = None if into is None else given_path(into, "into")
    inputs = list(_inputs(case, compared))
    if folder is not None:
        refuse_foreign(folder, FILLED, force=force, inputs=inputs)
    stage("reading the body")
    body = read_body(case, strict=strict)
    against = None if compared is None else read_body(compared, strict=strict)
    findings = list(_findings(body, against, Asked(band_hz, damping, damage)))
    of_modes = [problem for problem in body.warnings if problem.code in ABOUT_MODES]
    warnings = (*of_modes, *(problem for finding in findings for problem in finding.warnings))
    found = Basis(case.title, tuple(findings), warnings)
    if folder is not None:
        stage("writing tables and page")
        written = write_basis(folder, found, list(_read_here(case, compared)), csv=csv)
        found = Basis(found.title, found.findings, found.warnings, tuple(str(folder / name) for name in written))
    return found


def _findings(body: Body, other: Body | None, asked: Asked) -> Iterator[Finding]:
    """Every question in turn."""
    stage("modal mass")
    yield from modal_mass(body, asked.band_hz, asked.damping)
    loaded = loaded_points(body)
    yield flexibility(loaded)
    yield interface(loaded)
    if not asked.damage and other is None:
        return
    with opened(body) as case:
        if asked.damage:
            yield truncation(case)
        if other is not None:
            with opened(other) as compared:
                yield from two_bases(case, compared)


def _inputs(case: Case, other: Case | None) -> Iterator[Path]:
    """Every file of the cases: none of them is overwritten."""
    for one in (case, other):
        if one is not None:
            yield from (one.path, *one.input_files().values())
    yield from _read_here(case, other)


def _read_here(case: Case, other: Case | None) -> Iterator[Path]:
    """The cases and those of their files that only this story reads."""
    for one in (case, other):
        if one is not None:
            names = [getattr(one.body, key) for key in ("modes", *BASIS_FILES)]
            yield from (path for path in (one.path, *map(one.resolve, filter(None, names))) if path.is_file())


def _no_damping(damping: float | None) -> Iterator[Problem]:
    if damping is not None and not (isinstance(damping, Real) and 0.0 < damping < 1.0):
        what = f"{damping} is no damping ratio of a mode that swings"
        yield Problem("bad_damping", "damping", what, "Give the ratio to critical damping: 1.5 % are 0.015")
