"""The case brought to life: everything read, checked and solved once, before any event is counted."""

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.case import Case, CustomCurve, Event, check_distance, check_files, event_length_km
from fatigue.errors import CaseError, DataError, FatigueError, Problem, refuse
from fatigue.event_block import EventLoad, prepare_event
from fatigue.life.curves import SNCurve, catalogue, damage_law, survival_level, user_curve
from fatigue.life.history import ModalHistory, kept
from fatigue.life.mission import Pass, Plan
from fatigue.readers.body import Mesh, Modes, Weld, read_mesh, read_modes, read_weld_nodes, read_welds
from fatigue.readers.forces import read_element_forces, read_nodal_forces, read_weld_elements
from fatigue.readers.history import read_history
from fatigue.spectrum.moments import MomentMatrices, has_spectrum, moment_matrices, point_moments, segment_spectra
from fatigue.stations import RatedCurve, Stations, stations_of
from fatigue.weld.edge_type import edge_type_warnings
from fatigue.weld.element_forces import ElementForces, balance, side_forces
from fatigue.weld.line import WeldLine, split_at_kinks
from fatigue.weld.structural_stress import LineStress, assess_line

log = logging.getLogger(__name__)

FEW_SEGMENTS = 8  # below, the spectrum is an estimate from too little
SAMPLES_PER_PEAK = 20.0  # what upsample = "auto" reaches for
LARGEST_UPSAMPLE = 64
IMBALANCE = {"error": 1e-3, "warning": 1e-5}  # of the element's largest force; single precision leaves 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class Model:
    """One body under one case, ready for its events.

    ``lines`` are the solved line parts, ``stations`` the same as one table; ``curves`` holds every curve a weld asks for;
    ``mesh`` is there for pictures only.
    """

    case: Case
    modes: Modes
    welds: tuple[Weld, ...]
    lines: tuple[LineStress, ...]
    stations: Stations
    curves: Mapping[str, RatedCurve]
    mesh: Mesh | None
    strict: bool
    warnings: tuple[Problem, ...]

    @property
    def curve_of_weld(self) -> list[str]:
        """Key of the curve of every weld: its own, else that of the case."""
        return [weld.curve or self.case.curve.name for weld in self.welds]


def read_model(case: Case, *, strict: bool) -> Model:
    """Read the body of a case and solve the structural stress of all its welds for all modes at once.

    Raises
    ------
    CaseError, DataError : with every mistake found in the file at fault
    """
    check_files(case)
    body = case.body
    curves_of_case = _curves(case)
    modes, warnings = read_modes(case.resolve(body.modes), body.ignore_modes, strict=strict)
    welds, doubts = read_welds(case.resolve(body.welds), curves_of_case, strict=strict)
    warnings += doubts
    curves = _rated_curves(case, curves_of_case, welds)
    lines, doubts = read_weld_nodes(case.resolve(body.weld_nodes), welds, strict=strict)
    warnings += doubts
    mesh: Mesh | None = None
    if body.nodes:
        elements = case.resolve(body.elements) if body.elements else None
        mesh, doubts = read_mesh(case.resolve(body.nodes), elements, strict=strict)
        warnings += doubts

    if body.nodal_forces:
        path = case.resolve(body.nodal_forces)
        forces, doubts = read_nodal_forces(path, lines, modes, body.force_convention, body.ignore_modes, strict=strict)
    else:
        lines, forces, doubts = _forces_of_sides(case, welds, lines, modes, mesh, strict)
    warnings += doubts

    solved = tuple(assess_line(line, force) for line, force in zip(lines, forces, strict=True))
    for line, force, result in zip(lines, forces, solved, strict=True):
        where = f"{body.weld_nodes}: weld {line.weld}"
        warnings += edge_type_warnings(line, force, where) + _end_warnings(result, where)
    return Model(
        case=case,
        modes=modes,
        welds=welds,
        lines=solved,
        stations=stations_of(solved, [weld.name for weld in welds]),
        curves=curves,
        mesh=mesh,
        strict=strict,
        warnings=tuple(warnings),
    )


def mission_plan(model: Model) -> tuple[Plan, tuple[Problem, ...]]:
    """Read and check every record of the mission; return its passes per km and the doubts about the records."""
    warnings: list[Problem] = []
    problems: list[Problem] = []
    passes: list[Pass] = []
    for event in model.case.mission.event:
        try:
            history, doubts = _record(model, event)
        except FatigueError as error:
            problems += error.problems
            continue
        warnings += doubts + _record_warnings(model, event, history)
        passes.append(
            Pass(
                event=event.name,
                samples=history.q.shape[1],
                length=event_length_km(event, history.duration),
                share=event.share,
                per_1000_km=event.per_1000_km,
            )
        )
    refuse(DataError, problems)
    mission = model.case.mission
    return Plan(tuple(passes), mission.target_km, mission.km_per_year, mission.damage_limit), tuple(warnings)


def event_load(model: Model, event: Event) -> EventLoad:
    """Read the record of an event and compute what all stations share."""
    history, _ = _record(model, event)
    residue = model.case.residue(event)
    moments: MomentMatrices | None = None
    if has_spectrum(history, model.case.spectrum.segment_s):
        moments = moment_matrices(segment_spectra(history, model.case.spectrum.segment_s, upper_hz(model, history)))
    factor = model.case.counting.upsample
    upsample = _automatic_factor(model.stations, history, moments) if factor == "auto" else factor
    if upsample > 1:
        log.info("event '%s' is counted on a record upsampled %d times", event.name, upsample)
    return prepare_event(history, residue, event.stress_factor, upsample, moments)


def upper_hz(model: Model, history: ModalHistory) -> float:
    """Upper frequency of the spectra [Hz]: as given, else the lower of 0.4 sampling rates and 1.5 highest normal modes."""
    if model.case.spectrum.upper_hz is not None:
        return model.case.spectrum.upper_hz
    normal = [f for f, kind in zip(model.modes.frequency, model.modes.kind, strict=True) if kind == "normal"]
    return float(min(0.4 / history.step, 1.5 * max(normal, default=np.inf)))


def _record(model: Model, event: Event) -> tuple[ModalHistory, list[Problem]]:
    """Read the record of an event, cut its start-up, and check its length."""
    case = model.case
    path = case.resolve(event.history)
    whole, warnings = read_history(path, event.name, model.modes.mode, case.body.ignore_modes, strict=model.strict)
    history = kept(whole, event.start_s)
    if history.q.shape[1] < 2:
        raise CaseError(
            Problem(
                "short_record",
                f"{case.path.name}: mission.event '{event.name}': start_s",
                f"start_s = {event.start_s:g} leaves {history.q.shape[1]} samples of {path.name}, which lasts {whole.duration:g} s",
                "Cut less, or record longer",
            )
        )
    check_distance(event, history.duration, f"{case.path.name}: mission.event '{event.name}'")
    return history, warnings


def _record_warnings(model: Model, event: Event, history: ModalHistory) -> list[Problem]:
    where = f"event '{event.name}'"
    segment_s = model.case.spectrum.segment_s
    if not has_spectrum(history, segment_s):
        return [
            Problem(
                "no_spectrum",
                where,
                f"the record of {history.duration:g} s is shorter than one spectral segment of {segment_s:g} s, so there is "
                "no frequency-domain estimate",
                "Record longer or shorten segment_s if you need one",
            )
        ]
    moments = segment_spectra(replace(history, q=history.q[:1]), segment_s, upper_hz(model, history))
    if len(moments.amplitude) < FEW_SEGMENTS:
        return [
            Problem(
                "few_segments",
                where,
                f"the spectrum is an average of {len(moments.amplitude)} segments of {segment_s:g} s",
                f"Record longer, or shorten segment_s to get {FEW_SEGMENTS} segments or more",
            )
        ]
    return []


def _automatic_factor(stations: Stations, history: ModalHistory, moments: MomentMatrices | None) -> int:
    """Smallest power of 2 that gives every point ``SAMPLES_PER_PEAK`` samples per peak."""
    if moments is None:
        return 1
    stress = stations.treated
    _, _, m2, m4 = point_moments(
        np.concatenate([stress.membrane + stress.bending, stress.membrane - stress.bending]), moments
    )
    peaks_per_s = np.sqrt(np.max(np.divide(m4, m2, out=np.zeros_like(m4), where=m2 > 0.0)))
    factor = 1
    while factor / history.step < SAMPLES_PER_PEAK * peaks_per_s and factor < LARGEST_UPSAMPLE:
        factor *= 2
    return factor


def _curves(case: Case) -> dict[str, SNCurve]:
    """Catalogue and curves of the case; the case may not redefine a catalogue key."""
    shipped = catalogue()
    refuse(
        CaseError,
        (
            Problem(
                "duplicate_curve",
                f"{case.path.name}: curves.{name}",
                "is a curve of the catalogue",
                "Choose another name",
            )
            for name in case.curves
            if name in shipped
        ),
    )
    return dict(shipped) | {name: _own_curve(name, given) for name, given in case.curves.items()}


def _own_curve(name: str, given: CustomCurve) -> SNCurve:
    return user_curve(
        name=name,
        slopes=given.slopes,
        knees_cycles=given.knees_cycles,
        range_at_2e6=given.range_at_2e6_MPa,
        applies=given.applies,
        source=given.source,
        log10_scatter=given.log10_scatter,
        thickness_reference=given.thickness_reference_mm,
        thickness_exponent=given.thickness_exponent or 0.0,
    )


def _rated_curves(case: Case, curves: Mapping[str, SNCurve], welds: Sequence[Weld]) -> dict[str, RatedCurve]:
    """Every curve a weld asks for at the survival level and with the extension of the case."""
    asked = {case.curve.name: f"{case.path.name}: curve.name"}
    asked |= {weld.curve: f"{case.body.welds}: weld {weld.name}: curve" for weld in welds if weld.curve}
    rated: dict[str, RatedCurve] = {}
    problems: list[Problem] = []
    for name, where in asked.items():
        if name not in curves:
            known = ", ".join(sorted(curves))
            problems.append(
                Problem(
                    "unknown_curve",
                    where,
                    f"there is no curve '{name}'",
                    f"Choose one of {known}, or add [curves.{name}]",
                )
            )
            continue
        curve = curves[name]
        if case.curve.mean_stress == "asme" and curve.applies != "dS":
            problems.append(
                Problem(
                    "mean_stress",
                    where,
                    f"mean_stress = 'asme' belongs to the master curve and does not apply to curve '{name}'",
                    'Set mean_stress = "none", or use a curve in dS',
                )
            )
            continue
        try:
            law = damage_law(curve, case.curve.survival, case.curve.extension, case.curve.knee_cycles)
        except CaseError as error:
            problems += [replace(p, where=f"{case.path.name}: {p.where}") for p in error.problems]
            continue
        rated[name] = RatedCurve(curve, survival_level(curve, case.curve.survival), law)
    refuse(CaseError, problems)
    return rated


def _forces_of_sides(
    case: Case, welds: Sequence[Weld], lines: Sequence[WeldLine], modes: Modes, mesh: Mesh | None, strict: bool
) -> tuple[tuple[WeldLine, ...], tuple[NDArray[np.float64], ...], list[Problem]]:
    """Split lines at their kinks and sum the element forces of the assessed side per part."""
    body = case.body
    assert body.element_forces is not None
    assert body.weld_elements is not None
    path = case.resolve(body.element_forces)
    forces, warnings = read_element_forces(path, modes, body.force_convention, body.ignore_modes, strict=strict)
    sides, doubts = read_weld_elements(case.resolve(body.weld_elements), welds, strict=strict)
    warnings += doubts + _checked_balance(path, forces, mesh)
    parts: list[WeldLine] = []
    summed: list[NDArray[np.float64]] = []
    for line in lines:
        split = split_at_kinks(line)
        parts += split
        summed += side_forces(split, sides[line.weld], forces, modes.mode, f"{path.name}: weld {line.weld}")
    return tuple(parts), tuple(summed), warnings


def _checked_balance(path: Path, forces: ElementForces, mesh: Mesh | None) -> list[Problem]:
    """Refuse element forces out of equilibrium; mention those further off than single precision explains."""
    xyz = None if mesh is None else dict(zip(mesh.node.tolist(), mesh.xyz, strict=True))
    found = balance(forces, xyz)
    residual = (
        found.force_residual
        if found.moment_residual is None
        else np.maximum(found.force_residual, found.moment_residual)
    )
    worst = int(residual.argmax())
    if residual[worst] <= IMBALANCE["warning"]:
        return []
    problem = Problem(
        "imbalance",
        f"{path.name}: element {found.element[worst]}, mode {found.mode[worst]}",
        f"forces and moments are out of balance by {residual[worst]:.2g} of the largest",
        "Export static element forces only (no inertia), of all corners, in global axes",
    )
    if residual[worst] > IMBALANCE["error"]:
        raise DataError(problem)
    return [problem]


def _end_warnings(solved: LineStress, where: str) -> list[Problem]:
    if not solved.unresolved.any():
        return []
    nodes = ", ".join(str(node) for node in solved.line.node[solved.unresolved])
    return [
        Problem(
            "end_unresolved",
            where,
            f"the edge at the end node {nodes} is longer than the length of the end treatment",
            "Refine the mesh at the weld end, or read the end value as one of a single edge",
        )
    ]
