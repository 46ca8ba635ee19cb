"""What the modes of a case carry of rigid motions of their boundary: by participation factors or a mass matrix."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.basis.mass.rows import DIRECTIONS
from fatigue.errors import CaseError, Problem
from fatigue.flexbody.mass import (
    boundary_mass,
    centre_of_mass,
    effective_mass,
    modal_mass_matrix,
    participation,
    rigid_mass,
    rigid_motions,
)
from fatigue.pipeline.solve.body import Body
from fatigue.readers.neutral.body.mass_matrix import MassRows, read_mass_matrix, read_mass_rows, read_mode_shapes
from fatigue.readers.neutral.body.modes import LOWEST_HZ, Modes
from fatigue.readers.neutral.body.participation import read_participation
from fatigue.shown import few

Floats = NDArray[np.float64]

SAME_MASS = 0.01  # relative: masses in a case are written with two digits or more
SAME_DIRECTIONS = 1e-3  # relative: a body has one mass, whatever the direction
ORTHOGONAL = 1e-3  # of the modal masses: shapes are written with four digits or more
NO_INERTIA = 1e-12  # of the largest moment of inertia: what rounding leaves of a straight row of masses
STILL = 1e-6  # of the largest displacement: a boundary that was held
NAMED = 8


@dataclass(frozen=True, slots=True, eq=False)
class Carried:
    """Elastic modes whose participation is known, in the order of their frequencies.

    Attributes
    ----------
    mode, frequency, kind, damping_ratio : (p,) as in ``Modes``
    factor : (p, 6) participation factors [t, t mm], about the centre of mass; NaN where not given
    effective : (p, 6) effective masses [t, t mm2]; NaN likewise
    body : (6,) mass and moments of inertia of the body [t, t mm2]; NaN where not known
    boundary : (6,) of it, what moves with the boundary and no mode; NaN where not known
    no_body : (6,) why the mass or inertia of the body is not known, where it is not
    notes, warnings : what was assumed; what is doubtful
    """

    mode: NDArray[np.int64]
    frequency: Floats
    kind: tuple[str, ...]
    damping_ratio: Floats
    factor: Floats
    effective: Floats
    body: Floats
    boundary: Floats
    no_body: tuple[str, ...]
    notes: tuple[str, ...]
    warnings: tuple[Problem, ...]


def carried(body: Body) -> Carried | None:
    """What the modes of a case carry; None where the case gives neither participation factors nor a mass matrix.

    Raises
    ------
    DataError : a mistake in the files
    CaseError : the mass matrix and ``total_mass_t`` contradict each other
    """
    if body.case.body.participation is not None:
        return _by_factors(body)
    return _by_matrix(body) if body.case.body.mass_matrix is not None else None


def _by_factors(body: Body) -> Carried:
    case, files, modes = body.case, body.case.body, body.modes
    path = case.resolve(files.participation or "")
    given, warnings = read_participation(path, modes, files.ignore_modes, strict=body.strict)
    own = np.searchsorted(modes.mode, given.mode)
    mass = modes.modal_mass[own]
    total = np.nan if files.total_mass_t is None else files.total_mass_t
    inertia = (np.nan,) * 3 if files.inertia_t_mm2 is None else files.inertia_t_mm2
    lumped = np.nan if files.boundary_mass_t is None else files.boundary_mass_t
    all_one = bool((mass == 1.0).all())
    notes = [
        "Participation factors and modal_mass are taken as of the same shapes"
        + (", of modal mass 1 t each" if all_one else "")
        + "; the sign and the scale of a shape do not count then. Rotations are about the centre of mass."
    ]
    scaled = modes.mode[own][modes.scale[own] != 1.0]
    if scaled.size:
        notes.append(
            f"The scale of {_named(scaled)} is for forces and is not applied to participation factors: both it and "
            "modal_mass would change, and the effective mass stays."
        )
    for number, direction in enumerate(DIRECTIONS):
        column = given.factor[:, number]
        empty = np.isnan(column) & ~np.isnan(column).all()
        if empty.any():
            notes.append(f"l_{direction} of {_named(given.mode[empty])} is empty and counts as nothing.")
    return _carried(
        modes,
        own,
        given.factor,
        mass,
        np.array([total] * 3 + list(inertia)),
        np.array([lumped] * 3 + [np.nan] * 3),
        ("total_mass_t is not given",) * 3 + ("inertia_t_mm2 is not given",) * 3,
        notes,
        warnings,
    )


def _by_matrix(body: Body) -> Carried:
    case, files, modes = body.case, body.case.body, body.modes
    matrix, table, shape_file = (
        case.resolve(name or "") for name in (files.mass_matrix, files.mass_rows, files.mode_shapes)
    )
    M = read_mass_matrix(matrix)
    rows, warnings = read_mass_rows(table, M.shape[0], matrix.name, body.mesh, strict=body.strict)
    found, shapes, of_shapes = read_mode_shapes(shape_file, rows, modes, files.ignore_modes, strict=body.strict)
    centre = centre_of_mass(rigid_mass(M, rigid_motions(rows.xyz, rows.direction)))
    R = rigid_motions(rows.xyz, rows.direction, centre)
    whole = np.diag(rigid_mass(M, R)).copy()
    _refuse_other_mass(files.total_mass_t, whole[:3].mean(), f"{case.path.name}: body.total_mass_t", matrix.name)
    lumped = boundary_mass(M, R, rows.held) if rows.held.any() else np.full(6, np.nan)
    of_modes = modal_mass_matrix(M, shapes)
    mass = np.diag(of_modes).copy()
    notes = [
        f"Participation factors are Phi' M R of {matrix.name}, modal masses Phi' M Phi.",
        f"Rotations are about the centre of mass at x, y, z = {', '.join(f'{x:.5g}' for x in centre)} mm.",
    ]
    massless = mass <= 0.0
    if massless.any():
        notes.append(f"No mass moves in {_named(found[massless])}: left out.")
    own = np.searchsorted(modes.mode, found)
    other = ~massless & (np.abs(mass - modes.modal_mass[own]) > SAME_MASS * modes.modal_mass[own])
    if other.any():
        notes.append(f"modal_mass of {_named(found[other])} is another than that of the shapes, and is not used here.")
    if not rows.held.any():
        notes.append("No row of the mass matrix is held, so nothing says what of the mass is on the boundary.")
    warnings = [*warnings, *of_shapes, *_doubts(rows, shapes, whole, of_modes, found, (matrix.name, shape_file.name))]
    there = ~massless
    factor = participation(M, shapes, R)
    whole[:3][whole[:3] <= 0.0] = np.nan
    whole[3:][whole[3:] <= NO_INERTIA * whole[3:].max()] = np.nan
    no_body = ("the matrix has no mass along it",) * 3 + ("the body has no inertia about it",) * 3
    return _carried(modes, own[there], factor[there], mass[there], whole, lumped, no_body, notes, warnings)


def _carried(
    modes: Modes,
    own: NDArray[np.int64],
    factor: Floats,
    mass: Floats,
    whole: Floats,
    boundary: Floats,
    no_body: tuple[str, ...],
    notes: list[str],
    warnings: list[Problem],
) -> Carried:
    """Those of the modes that swing, by frequency; ``own`` are their places in ``modes``."""
    elastic = (np.array(modes.kind)[own] != "rigid") & (modes.frequency[own] > LOWEST_HZ)
    if not elastic.all():
        notes.append(f"Rigid {_named(modes.mode[own][~elastic])} carries the body as a whole and is not summed.")
    absent = np.setdiff1d(np.arange(len(modes.mode)), own)
    if absent.size:
        notes.append(f"Nothing is given of {_named(modes.mode[absent])}: what they carry is among what is missing.")
    order = np.flatnonzero(elastic)[np.argsort(modes.frequency[own][elastic], kind="stable")]
    at = own[order]
    return Carried(
        mode=modes.mode[at],
        frequency=modes.frequency[at],
        kind=tuple(modes.kind[i] for i in at),
        damping_ratio=modes.damping_ratio[at],
        factor=factor[order],
        effective=effective_mass(factor[order], mass[order]),
        body=whole,
        boundary=boundary,
        no_body=no_body,
        notes=tuple(notes),
        warnings=tuple(warnings),
    )


def _refuse_other_mass(given: float | None, found: float, where: str, matrix: str) -> None:
    """Refuse a mass in the case that is not the one of the matrix: t and kg, as a rule."""
    if given is None or abs(found - given) <= SAME_MASS * given:
        return
    what = f"{given:g} t is given, and {matrix} has {found:.5g}"
    remedy = "Give the matrix in t, t mm and t mm2, as N, mm and s ask for; or correct total_mass_t"
    raise CaseError(Problem("contradiction", where, what, remedy))


def _doubts(
    rows: MassRows,
    shapes: Floats,
    whole: Floats,
    of_modes: Floats,
    mode: NDArray[np.int64],
    files: tuple[str, str],
) -> list[Problem]:
    """Doubts about a mass matrix and the shapes in its rows."""
    found, (matrix, shape_file) = [], files
    low, high = float(whole[:3].min()), float(whole[:3].max())
    if high - low > SAME_DIRECTIONS * high:
        what = f"the mass is {', '.join(f'{m:.5g}' for m in whole[:3])} t along x, y, z"
        remedy = "Check that the matrix has all degrees of freedom and that mass_rows says what they are"
        found.append(Problem("mass_directions", matrix, what, remedy))
    scale = np.sqrt(np.where(np.diag(of_modes) > 0.0, np.diag(of_modes), np.inf))
    beside = np.abs(of_modes / np.outer(scale, scale))
    np.fill_diagonal(beside, 0.0)
    if beside.size and beside.max() > ORTHOGONAL:
        i, j = np.unravel_index(int(beside.argmax()), beside.shape)
        what = (
            f"modes {mode[i]} and {mode[j]} share {beside.max():.3g} of their modal mass, above {ORTHOGONAL:g}, so "
            "that effective masses do not sum up to that of the body"
        )
        remedy = "Give orthogonal modes, and the shapes and the matrix of the same model"
        found.append(Problem("modes_not_orthogonal", shape_file, what, remedy))
    at_held = np.abs(shapes[rows.held & (rows.direction < 3)]).max(initial=0.0)
    largest = np.abs(shapes[rows.direction < 3]).max(initial=0.0)
    if at_held > STILL * largest:
        what = f"the boundary moves by {at_held / largest:.3g} of the largest displacement although it is held"
        remedy = "Give the fixed-interface modes, or the rows that were held where the modes were computed"
        found.append(Problem("boundary_moves", shape_file, what, remedy))
    return found


def _named(modes: NDArray[np.int64]) -> str:
    """Modes in words: ``mode 7``, ``modes 7, 8 and 3 more``."""
    return f"mode{'s' * (modes.size > 1)} {few([str(m) for m in modes.tolist()], NAMED)}"
