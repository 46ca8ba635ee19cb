"""The report: one HTML page that needs nothing but itself, made from a finished result folder."""

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from threadpoolctl import threadpool_limits

from fatigue.errors import DataError, Problem, given_path
from fatigue.files.mishaps import refused_writing
from fatigue.report import figures
from fatigue.report.checks import read_checks
from fatigue.report.figures.scene import BodyOutline
from fatigue.report.identity.identity import Identity, found_identity, issued
from fatigue.report.identity.section import identity_section
from fatigue.report.inputs import FoundInputs, find_inputs
from fatigue.report.page_text import page_text
from fatigue.report.result import ShownResult, read_result
from fatigue.report.sections import body as body_sections
from fatigue.report.sections import method, tables
from fatigue.report.sections.beside.checks import beside
from fatigue.report.sections.beside.life_band import bands_of, life_band_section
from fatigue.report.sections.beside.sensitivity import sensitivity
from fatigue.report.sections.beside.shear import shear
from fatigue.report.sections.checks import recomputed
from fatigue.report.sections.curves import curve_sections, figure_mark, marked, of_toes
from fatigue.report.sections.details import weld_details
from fatigue.report.sections.embed import Figures
from fatigue.report.sections.evidence.section import SIGNS, WORDS, evidence
from fatigue.report.sections.evidence.warnings import grouped
from fatigue.report.sections.formation.section import formation_section
from fatigue.report.sections.load_spectra import read_load_spectra, spectra_warnings, spectra_words
from fatigue.report.sections.places.paper import all_passed, on_paper
from fatigue.report.sections.places.section import places
from fatigue.report.sections.point.detail import Detail
from fatigue.report.sections.ride.read import read_ride
from fatigue.report.sections.ride.section import ride_section, ride_warnings
from fatigue.report.sections.shift import shift_study, shift_warnings
from fatigue.report.sections.transitions import transitions
from fatigue.report.sections.unit_loads import load_table
from fatigue.report.sections.weld import weld_page
from fatigue.report.sections.why import read_why
from fatigue.results import PAGE, enlist, read_provenance, row_count

log = logging.getLogger(__name__)

MOST_DETAILED = 40  # welds with their own figures; the others have their rows and their lines
MOST_STATIONS = 100_000  # on the lines that are drawn; beyond, only lines of the worst welds are
MOST_LISTED = 2000  # welds in the register of the page


def write_report(
    folder: Path | str,
    case_path: Path | str | None = None,
    verification: Sequence[Mapping[str, Any]] = (),
    into: Path | None = None,
) -> Path:
    """Write ``report.html`` beside the tables of a finished result, and log what had to be left out.

    The same result and inputs give the same bytes.

    Parameters
    ----------
    folder : where the tables and ``provenance.json`` are
    case_path : the case of the result, by default where its provenance says. Histories, for stress excerpts and
        spectra, and the mesh are found by it and checked by their hashes; what is gone or has changed is left out of
        the page, with the reason.
    verification : checks of the installed program to be shown, each with ``topic, case, quantity, unit, expected,
        found, difference, tolerance, source, passed``
    into : another folder to write to; the page is not listed among the documents of the result then

    Raises
    ------
    DataError : no finished result in the folder
    """
    folder = given_path(folder, "folder")
    path = (into or folder) / PAGE
    record = read_provenance(folder)
    identity = found_identity(record, folder, None if case_path is None else given_path(case_path, "case_path"))
    page = report_page(folder, case_path, verification, identity)
    with refused_writing(path):  # a path need not be UTF-8
        path.write_text(page, encoding="utf-8", errors="backslashreplace", newline="\n")
    if into is None:
        enlist(folder, path, said=issued(record, identity))
    return path


def report_page(
    folder: Path | str,
    case_path: Path | str | None = None,
    verification: Sequence[Mapping[str, Any]] = (),
    identity: Identity | None = None,
) -> str:
    """Return the page as text; see ``write_report``. ``identity`` is by default the one that is found by the case."""
    folder = given_path(folder, "folder")
    case_path = None if case_path is None else given_path(case_path, "case_path")
    result = read_result(folder, MOST_DETAILED, MOST_STATIONS)
    record = result.record
    identity = found_identity(record, folder, case_path) if identity is None else identity
    inputs = find_inputs(record, folder, case_path)
    missing: list[Problem] = []
    details, steps = _details(result, inputs, missing)
    body = _body(inputs, missing)
    why, spectra, checks = read_why(folder, result), read_load_spectra(folder, result), read_checks(folder)
    ridden = read_ride(folder, result)
    for problem in missing:
        log.warning("the report lacks something: %s", problem)
    for problem in inputs.outdated:
        log.warning("the report may be outdated: %s", problem)
    links = {weld: f"weld-{i}" for i, weld in enumerate(result.detailed, start=1)}
    unverified, bands = of_toes(result), bands_of(result)
    paper = on_paper(result, unverified)
    lines = body_sections.drawn_lines(result)
    figs = Figures(mark=figure_mark(unverified, len(result.assessed)))
    recounted = recomputed(result)
    context = {
        "title": record["title"],
        "version": record["software"]["fatigue"],
        "record": record,
        "result": record.get("result", ""),
        "missing": missing,
        "outdated": inputs.outdated,
        **identity_section(identity, record),
        "head": _head(result),
        "assumptions": method.assumptions(record),
        "warnings": grouped(
            [*record["warnings"], *spectra_warnings(spectra), *ride_warnings(ridden), *shift_warnings(record)]
        ),
        **curve_sections(result),
        "worst_welds": marked(tables.weld_table(result.assessed, links), unverified),
        **life_band_section(result, bands, links),
        **sensitivity(result, links),
        "places": places(result, lines, links, unverified),
        # figures are numbered in the order of these lines, the order of the page
        "weld_lives": body_sections.lives(result, figs),
        **body_sections.where(result, lines, body, figs),
        **body_sections.causes(result, why, figs),
        **transitions(result, links),
        **formation_section(why, result, links),
        **ride_section(ridden, links, figs),
        **shift_study(folder, result, figs),
        "pages": [
            weld_page(result, weld, details.get(weld), why, spectra, checks, bands, figs, links[weld], paper.welds)
            for weld in result.detailed
        ],
        **shear(result, links),
        **beside(result, checks, links),
        "spectra_words": spectra_words(spectra),
        **body_sections.domains(result, figs),
        "assessed": len(result.assessed),
        "paper": paper,
        "undetailed": len(result.assessed) - len(result.detailed),
        "undrawn": len(result.assessed) - len(result.drawn),
        "register": marked(tables.register_table(_listed(result), links), unverified),
        "unlisted": max(0, len(result.assessed) - MOST_LISTED),
        "events": tables.event_table(result.events, record["rules"]["residue"], steps),
        "gravity": tables.gravity_table(record.get("gravity", [])),
        "modes": tables.mode_table(record["modes"]),
        "unit_loads": load_table(record.get("unit_loads", ())),
        "rules": method.rules(record),
        "checks": recounted,
        "evidence": evidence(result, recounted, verification),
        "evidence_signs": SIGNS,
        "evidence_words": WORDS,
        "verification": tables.verification_table(verification),
        "verified": all_passed(verification),
        "inputs": tables.input_table(record["inputs"]),
        "audit": tables.audit_table(record.get("conversion")),
    }
    return page_text("fatigue.report", "report.html", context, figs, identity.look.language)


def _details(
    result: ShownResult, inputs: FoundInputs, missing: list[Problem]
) -> tuple[dict[str, Detail], dict[str, float]]:
    """What the records say of each detailed weld, and the step of each record; or a note why not."""
    try:
        with threadpool_limits(limits=1, user_api="blas"):  # products are small, and the same on any processor
            return weld_details(result, inputs)
    except DataError as error:
        missing += error.problems
        return {}, {}


def _body(inputs: FoundInputs, missing: list[Problem]) -> BodyOutline | None:
    """Outline of the mesh, or a note why not (unless the whole case is gone, which is noted already)."""
    try:
        mesh = inputs.mesh()
    except DataError as error:
        missing += [problem for problem in error.problems if problem.code != "missing_case"]
        return None
    return None if mesh is None else figures.body_outline(mesh.node, mesh.xyz, mesh.corners[:, :4])


def _head(result: ShownResult) -> dict[str, Any]:
    """What the first lines of the page say."""
    welds = result.assessed
    mission = result.record["mission"]
    missed = int((~welds["fulfilled"]).sum())
    return {
        "fulfilled": missed == 0,
        "missed": missed,
        "welds": len(welds),
        "left_out": len(result.welds) - len(welds),
        "has_candidates": any(map(tables.is_candidate, result.welds["reason"])),
        "points": result.toes,
        "points_in_all": row_count(result.folder, "nodes"),
        "worst": welds.iloc[0],
        "load_factor": welds["load_factor"].min(),
        "undamaged": not np.isfinite(welds.iloc[0]["life_km"]),
        "target_km": mission["target_km"],
        "target_years": mission["target_km"] / mission["km_per_year"],
        "km_per_year": mission["km_per_year"],
    }


def _listed(result: ShownResult) -> pd.DataFrame:
    """Welds of the register that have a row: the worst, and those that are not assessed."""
    listed = (np.arange(len(result.welds)) < MOST_LISTED) | (result.welds["status"] != "assessed")
    return result.welds[listed]
