"""What can be known about foreign force files before they are believed: sign, balance, frames, completeness.

Every check gives a traffic light, a number and a remedy. The checks need no trust in the solver: stiffness forces of an
element are in equilibrium, a mode shape does the work of its own strain energy on them, and the rows of a grid point
force balance add up to the total that the file states.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.convert.audit.grid_totals import check_totals
from fatigue.readers.convert.audit.shell_rows import elastic_modes, own_rows, shell_rows, whole_rows, without_drilling
from fatigue.readers.convert.audit.sign_proof import prove_sign
from fatigue.readers.foreign.fe.model import FeModel, to_basic
from fatigue.readers.foreign.fe.results import REQUEST, SHELL_KINDS, FeResults
from fatigue.readers.neutral.body import LOWEST_HZ
from fatigue.readers.neutral.forces.convention import Convention
from fatigue.weld.element_forces import BALANCE_RED, ElementForces, balance

Light = Literal["green", "amber", "red"]


BALANCE_GREEN = 1e-3
FREQUENCY_LIMIT = 0.01


@dataclass(frozen=True, slots=True)
class AuditRow:
    """One check: what was measured, how it is judged, and what to do about it."""

    check: str
    light: Light
    value: float | None
    finding: str
    remedy: str = ""


@dataclass(frozen=True, slots=True)
class Audit:
    """All checks of one force file, and what follows from them.

    Attributes
    ----------
    convention : sign of the forces that the checks support; None: undecided
    grounded_drilling : whether shells are out of balance by nothing but their moments about their own normals
    """

    rows: tuple[AuditRow, ...]
    convention: Convention | None
    grounded_drilling: bool = False

    @property
    def is_red(self) -> bool:
        """Whether any check failed."""
        return any(row.light == "red" for row in self.rows)


def audit(
    results: FeResults,
    model: FeModel,
    stated: Convention | None = None,
    interface_modes: Iterable[int] = (),
    simulated: dict[int, float] | None = None,
) -> Audit:
    """Judge grid point forces against their model, and against the simulation's modes.

    Parameters
    ----------
    results, model : as read, in the file's own units and displacement frames
    stated : sign convention claimed by the user
    interface_modes : modes marked as static (residual, constraint, attachment) modes
    simulated : frequency [Hz] of every mode in the simulation, where its file tells
    """
    force = to_basic(results.force, results.node, model)
    sign, convention = _sign(results, model, stated)
    balanced, grounded_drilling = _element_balance(results, model, force)
    rows = [
        balanced,
        *_frames(results, model, force),
        _nodal_totals(results, convention),
        sign,
        _completeness(results, model),
        *_interface(results, set(interface_modes)),
        *_unknown_frequencies(results, {*interface_modes, *results.static_modes}),
        *_masses(results),
        *_frequencies(results, simulated),
    ]
    return Audit(tuple(rows), convention, grounded_drilling)


def element_forces(
    results: FeResults, force: NDArray[np.floating], rows: NDArray[np.bool_] | slice = slice(None)
) -> ElementForces:
    """Put the forces (m, r, 6) of chosen rows of all modes in one table."""
    node, element = results.node[rows], results.element[rows]
    modes = results.mode.size
    return ElementForces(
        np.repeat(results.mode, node.size), np.tile(node, modes), np.tile(element, modes), force[:, rows].reshape(-1, 6)
    )


def _worst_balance(results: FeResults, model: FeModel, force: NDArray[np.floating]) -> tuple[float, int, int, int]:
    """Largest residual of any shell and mode, its element and mode, and the number of shells checked."""
    rows = shell_rows(results, model)
    if not rows.any():
        return np.nan, 0, 0, 0
    elastic = elastic_modes(results)
    results, force = replace(results, mode=results.mode[elastic]), force[elastic]
    xyz = dict(zip(model.mesh.node.tolist(), model.mesh.xyz, strict=True))
    found = balance(element_forces(results, force, rows), xyz)
    k = found.worst
    moment = 0.0 if found.moment_residual is None else float(found.moment_residual[k])
    worst = max(float(found.force_residual[k]), moment)
    return worst, int(found.element[k]), int(found.mode[k]), np.unique(results.element[rows]).size


def _element_balance(results: FeResults, model: FeModel, force: NDArray[np.floating]) -> tuple[AuditRow, bool]:
    """Judge the worst shell; also tell whether only the moments about the shells' normals are out of balance."""
    worst, element, mode, count = _worst_balance(results, model, force)
    if not count:
        return AuditRow(
            "element balance", "red", None, "no shell of the mesh has forces at all its nodes", REQUEST
        ), False
    finding = f"worst of {count} shells: element {element} in mode {mode}, {worst:.2g} of its largest force or moment"
    if worst <= BALANCE_GREEN:
        return AuditRow("element balance", "green", worst, finding), False
    rest = _worst_balance(results, model, without_drilling(force, results, model))[0]
    if rest <= BALANCE_GREEN:
        finding += f"; {rest:.2g} without their moments about their own normals, which are left out"
        remedy = (
            "The solver ties these rotations to the ground (PARAM,K6ROT in MYSTRAN): welds do not need them; set it to "
            "0 if the frequencies matter"
        )
        return AuditRow("element balance", "amber", worst, finding, remedy), True
    remedy = (
        "Give the mesh of this run with its coordinate systems (CD); request stiffness forces without inertia and "
        "damping; a damaged number looks the same"
    )
    return AuditRow("element balance", "amber" if worst <= BALANCE_RED else "red", worst, finding, remedy), False


def _frames(results: FeResults, model: FeModel, force: NDArray[np.floating]) -> list[AuditRow]:
    """Check that the rotation out of the displacement frames does what it should."""
    count = int(np.isin(model.frame_node, results.node).sum())
    if not count:
        return [AuditRow("displacement frames", "green", 0.0, "all forces are in the basic frame")]
    turned = _worst_balance(results, model, force)[0]
    plain = _worst_balance(results, model, results.force)[0]
    if plain < BALANCE_GREEN < turned:
        return [
            AuditRow(
                "displacement frames",
                "red",
                float(count),
                f"{count} grids have displacement frames (CD), but only the unrotated forces balance: they are basic",
                "Write GPFORCE in the displacement frames, or remove CD from the mesh given here",
            )
        ]
    finding = f"forces of {count} grids rotated to basic: worst balance {plain:.2g} before, {turned:.2g} after"
    return [AuditRow("displacement frames", "green", float(count), finding)]


def _nodal_totals(results: FeResults, convention: Convention | None) -> AuditRow:
    """Compare the stated totals of every grid with its rows: where they follow, a checksum over every number."""
    found = check_totals(results, convention)
    if found is None:
        return AuditRow(
            "grid totals",
            "amber",
            None,
            "the file states no totals to check the rows against",
            "Rely on the element balance",
        )
    value = found.residual
    if not found.is_in_balance and (found.is_met or not found.is_checksum):
        return AuditRow(
            "grid totals",
            "red" if convention == "on_element" else "amber",
            found.rest,
            f"the solver states a rest of {found.rest:.2g} of the largest row at grid {found.rest_grid} in mode "
            f"{found.rest_mode}: its forces on the elements do not balance loads and reactions",
            "Look for elements that write no forces, inertia relief, modes that have not converged, reduced degrees of "
            "freedom; in MYSTRAN for plates with offsets (ZOFFS), whose forces it recovers wrongly",
        )
    if found.is_met:
        return AuditRow(
            "grid totals", "green", value, f"the rows of every grid {found.rule} its total within {value:.2g}"
        )
    if not found.is_checksum:
        return AuditRow(
            "grid totals",
            "amber",
            None,
            "the totals contain inertia forces that the file has no rows for (as MYSTRAN's): they are no check",
            "Rely on the element balance",
        )
    return AuditRow(
        "grid totals",
        "red",
        value,
        f"the rows of grid {found.grid} in mode {found.mode} miss their stated total by {value:.2g} of the largest row",
        "Copy the file again or repeat the run: a number is damaged, or rows are missing",
    )


def _sign(results: FeResults, model: FeModel, stated: Convention | None) -> tuple[AuditRow, Convention | None]:
    """Compare the proven sign convention with the stated one."""
    value, found, finding, contradiction, odd = prove_sign(
        results, whole_rows(results, model), shell_rows(results, model)
    )
    if found is None:
        remedy = "State the sign convention; prove it with the one-element tension patch" if stated is None else REQUEST
        return AuditRow("sign", "amber", value, f"{finding}: the sign is not proven", remedy), stated
    if stated is not None and found != stated:
        remedy = f"State {found}, or give the mode shapes of the same run"
        return AuditRow("sign", "red", value, f"{finding}: forces {found}, but {stated} is stated", remedy), found
    if contradiction:
        remedy = "Give forces and mode shapes of one run"
        return AuditRow("sign", "red", value, f"{finding}: {contradiction}", remedy), found
    if odd:
        remedy = "Look at these elements: damaged forces look so, those under a strong preload may"
        return AuditRow("sign", "amber", value, f"{finding}: forces {found}; {odd}", remedy), found
    return AuditRow("sign", "green", value, f"{finding}: forces {found}"), found


def _completeness(results: FeResults, model: FeModel) -> AuditRow:
    """Compare the shells of the mesh with those that have force rows."""
    mesh = model.mesh
    listed = np.unique(results.element[results.of_element])
    is_shell = results.of_element & (
        np.isin(results.kind, sorted(SHELL_KINDS)) | np.isin(results.element, mesh.element)
    )
    stray = np.unique(results.element[is_shell & ~own_rows(results, model)[1]])
    if stray.size:
        return AuditRow(
            "completeness",
            "red",
            float(stray.size),
            f"{stray.size} shells have forces and are not in the mesh with these nodes, element {stray[0]} the first",
            "Give the mesh of the run that wrote the forces",
        )
    full = np.unique(results.element[shell_rows(results, model)]).size
    some = np.intersect1d(listed, mesh.element).size
    finding = f"{full} of {mesh.element.size} shells have forces at all their nodes"
    if some > full:
        finding += f", {some - full} at some nodes only"
    remedies = []
    if full < mesh.element.size:
        remedies.append("Welds at the other shells are left out; widen the GPFORCE set if they matter")
    has_forces = np.array([force[results.of_element].any() for force in results.force])
    silent = results.mode[(results.frequency > LOWEST_HZ) & ~has_forces]
    if silent.size:
        finding += f"; in {silent.size} modes with a frequency all forces are zero, mode {silent[0]} the first"
        remedies.append("Repeat the run if these modes bend the welds")
    return AuditRow(
        "completeness", "amber" if remedies else "green", full / mesh.element.size, finding, "; ".join(remedies)
    )


def _interface(results: FeResults, marked: set[int]) -> list[AuditRow]:
    """Local welds lose nearly all of their force without static modes of the interface loads."""
    if results.analysis == "static":
        return []
    count = len(marked & set(results.mode.tolist()))
    if count:
        return [
            AuditRow(
                "interface modes", "green", float(count), f"{count} of {results.mode.size} modes are interface modes"
            )
        ]
    return [
        AuditRow(
            "interface modes",
            "amber",
            0.0,
            "no mode is marked as an interface (residual, constraint, attachment) mode",
            "Name them (--interface-modes); without them brackets and hangers lose most of their force",
        )
    ]


def _unknown_frequencies(results: FeResults, marked: set[int]) -> list[AuditRow]:
    """Modes of vibration have a frequency; static subcases have none by nature."""
    if results.analysis == "static":
        return []
    is_unknown = np.isnan(results.frequency) & ~np.isin(results.mode, sorted(marked))
    if not is_unknown.any():
        return []
    count, first = int(is_unknown.sum()), int(results.mode[is_unknown][0])
    return [
        AuditRow(
            "frequencies",
            "red",
            float(count),
            f"{count} of {results.mode.size} modes have no frequency, mode {first} the first: there is no eigenvalue "
            "summary, and no eigenvalue stands beside their shapes or forces",
            "Request DISPLACEMENT(PLOT) or the eigenvalue summary (LAMA) in the same file, or name modes that are "
            "static by nature as interface modes",
        )
    ]


def _masses(results: FeResults) -> list[AuditRow]:
    """Report the generalised masses, which a simulation may have normalised otherwise."""
    mass = results.modal_mass[np.isfinite(results.modal_mass)]
    if not mass.size:
        return []
    low, high = float(mass.min()), float(mass.max())
    if abs(low - 1) < 1e-3 and abs(high - 1) < 1e-3:
        return [AuditRow("generalised mass", "green", 1.0, "all modes have unit generalised mass")]
    return [
        AuditRow(
            "generalised mass",
            "amber",
            high,
            f"generalised masses from {low:.4g} to {high:.4g}",
            "Give the simulation's generalised masses if it normalises otherwise",
        )
    ]


def _frequencies(results: FeResults, simulated: dict[int, float] | None) -> list[AuditRow]:
    """Compare the frequencies of both sides mode by mode."""
    if not simulated:
        return []
    pairs = [
        (int(m), f, simulated[int(m)])
        for m, f in zip(results.mode, results.frequency, strict=True)
        if int(m) in simulated
    ]
    misses = [(abs(s - f) / max(f, LOWEST_HZ), m, f, s) for m, f, s in pairs if f > LOWEST_HZ]
    if not misses:
        return [
            AuditRow("frequency match", "amber", None, "no mode has a frequency on both sides", "Compare them by hand")
        ]
    worst, mode, ours, theirs = max(misses)
    finding = f"mode {mode}: {ours:.4g} Hz in the forces, {theirs:.4g} Hz in the simulation, worst of {len(misses)}"
    if worst <= FREQUENCY_LIMIT:
        return [AuditRow("frequency match", "green", worst, finding)]
    return [
        AuditRow(
            "frequency match", "red", worst, finding, "Map the coordinates to the right modes, or use one modal basis"
        )
    ]
