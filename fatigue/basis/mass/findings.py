"""Effective modal mass and dynamic mass as findings: how much of the body the modes carry, and what is missing."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from fatigue.basis.finding import Finding
from fatigue.basis.mass.carried import Carried, carried
from fatigue.basis.mass.rows import DIRECTIONS, DynamicMass, MassSum, ModalMass, unit_of
from fatigue.basis.rules import EFFECTIVE_MASS
from fatigue.errors import Problem
from fatigue.flexbody.mass import FREE, dynamic_mass, elastic_mass, frequencies_to_look_at, summed_up_to
from fatigue.pipeline.solve.body import Body
from fatigue.report.wording import share as in_percent

Floats = NDArray[np.float64]

NO_MASS = 1e-9  # t: what rounding leaves of the participation of free-free modes where the mass is not known
TOO_LARGE = 1.01  # of the mass: it is written with two digits or more
TOO_SMALL = 1e-2  # of the mass, in all directions: kg beside t give a thousandth
NOTHING = 1e-9  # of the mass: what rounding leaves where all of it is on the boundary
CARRIERS = 3  # modes named
WORTH_NAMING = 0.01  # of the mass
BEYOND = 2.0  # bands of frequencies at which the dynamic mass is told
HEADING, BY_MODE, DYNAMIC = "Effective modal mass", "Effective mass, mode by mode", "Dynamic mass"
NOT_GIVEN = (
    "The case gives neither participation factors nor a mass matrix. Give [body] participation, of the FE run of "
    "fixed-interface modes (held where the body is loaded) with total_mass_t and inertia_t_mm2; or mass_matrix with "
    "mass_rows and mode_shapes. Free-free modes, and attachment modes made orthogonal to them, have none: their "
    "participation is 0, and an effective mass is not defined for them."
)
WHAT_FREE_MODES_NEED = (
    "Free-free elastic modes are orthogonal to rigid motions, so their participation is 0 and an effective mass is not "
    "defined. Give the participation of the fixed-interface modes of the same FE model, held where the body is loaded; "
    "or judge this basis by its flexibility at the loaded points and by the damage without its highest modes."
)


def modal_mass(body: Body, band_hz: float | None, damping: float | None) -> Iterator[Finding]:
    """Findings about the effective and the dynamic mass of the modes of a case.

    Parameters
    ----------
    band_hz : upper end of the band that has to be complete [Hz]; None: ``upper_hz`` of the case, else its highest
        normal mode
    damping : damping ratio of modes that have none; None: no dynamic mass then

    Raises
    ------
    CaseError, DataError : a mistake in the files
    """
    found = carried(body)
    if found is None:
        yield Finding("mass_sum", HEADING, notes=(NOT_GIVEN,))
        return
    if _is_free(found):
        largest = float(np.nanmax(np.abs(found.effective), initial=0.0))
        said = f"The elastic modes take no part in rigid motions: no effective mass is above {largest:.2g} t or t mm2."
        yield Finding("mass_sum", HEADING, (said,), notes=(WHAT_FREE_MODES_NEED, *found.notes), warnings=found.warnings)
        return
    band = _band(body, band_hz)
    doubts = list(_doubts(found, body))
    sums = tuple(_sum_of(found, number, band) for number in range(6))
    yield Finding("mass_sum", HEADING, tuple(_said(found, sums, band)), sums, found.notes, (*found.warnings, *doubts))
    yield Finding("modal_mass", BY_MODE, rows=tuple(_by_mode(found)))
    yield _dynamic(found, band, damping)


def _is_free(found: Carried) -> bool:
    """Whether the modes take no part in rigid motions, to rounding."""
    summed = np.nansum(found.effective, axis=0)
    limit = np.where(np.isnan(found.body), NO_MASS, FREE * np.nan_to_num(found.body))
    return bool((summed <= limit).all())


def _band(body: Body, given: float | None) -> float:
    """Upper end of the band [Hz]."""
    if given is not None:
        return given
    if body.case.spectrum.upper_hz is not None:
        return body.case.spectrum.upper_hz
    normal = body.modes.vibration_hz
    return float(normal.max() if normal.size else body.modes.frequency.max())


def _too_large(found: Carried, number: int) -> bool:
    """Whether the modes carry more than there is."""
    body, boundary = found.body[number], np.nan_to_num(found.boundary[number])
    return bool(np.nansum(found.effective[:, number]) > TOO_LARGE * (body - boundary) + NOTHING * body)


def _doubts(found: Carried, body: Body) -> Iterator[Problem]:
    """Doubts about masses that cannot be right together."""
    files = body.case.body
    where = files.participation or files.mass_matrix or ""
    wrong = [number for number in range(6) if _too_large(found, number)]
    if wrong:
        n = wrong[0]
        summed, unit = np.nansum(found.effective[:, n]), unit_of(DIRECTIONS[n])
        what = f"effective masses along {DIRECTIONS[n]} sum up to {summed:.4g} {unit}"
        what += f", above the {found.body[n]:.4g} {unit} of the body"
        what += f" less the {found.boundary[n]:.4g} of its boundary" if found.boundary[n] > 0.0 else ""
        remedy = (
            "Give masses in t and lengths in mm, factors of the shapes that modal_mass belongs to, and rotations about "
            "the centre of mass"
        )
        yield Problem("effective_mass_too_large", where, what, remedy, len(wrong))
    share = np.nansum(found.effective, axis=0) / found.body
    known = share[np.isfinite(share)]
    if known.size and known.max() < TOO_SMALL:
        what = f"the modes carry {100.0 * known.max():.3g} % of the body at most, below {100.0 * TOO_SMALL:g} %"
        yield Problem("effective_mass_small", where, what, "Check that all masses are in t: kg are 1000 times as many")


def _sum_of(found: Carried, number: int, band: float) -> MassSum:
    """What the modes carry in one direction."""
    effective, direction = found.effective[:, number], DIRECTIONS[number]
    body, boundary = float(found.body[number]), float(found.boundary[number])
    given = bool(np.isfinite(effective).any())
    summed = float(np.nansum(effective)) if given else np.nan
    in_band = float(np.nansum(summed_up_to(found.frequency, effective[:, None], band))) if given else np.nan
    reasons = []
    if not given:
        reasons.append(f"l_{direction} is not given")
    if np.isnan(body):
        reasons.append(found.no_body[number])
    too_large = _too_large(found, number)
    if too_large:
        reasons.append("the modes carry more than the body has: see the warning")
    share = np.nan if too_large else in_band / body
    movable = body - float(np.nan_to_num(boundary))  # no mode can carry the boundary
    if movable <= NOTHING * body:
        reasons.append("all of it is on the boundary")
    missing = np.nan if too_large else 1.0 - (summed + float(np.nan_to_num(boundary))) / body
    return MassSum(
        direction=direction,
        unit=unit_of(direction),
        body_mass=body,
        boundary_mass=boundary,
        summed_mass=summed,
        band_hz=band,
        mass_in_band=in_band,
        share_in_band=share,
        missing_share=missing,
        enough=None if np.isnan(share) or movable <= NOTHING * body else in_band >= EFFECTIVE_MASS.share * movable,
        carried_by=_carriers(found, number),
        reason="; ".join(reasons),
    )


def _carriers(found: Carried, number: int) -> str:
    """Modes that carry most in a direction, with their frequencies, and their shares or else their masses."""
    effective = np.nan_to_num(found.effective[:, number])
    whole = found.body[number]
    of = whole if np.isfinite(whole) and not _too_large(found, number) else np.nan
    least = WORTH_NAMING * (of if np.isfinite(of) else effective.sum())
    largest = [int(i) for i in np.argsort(-effective, kind="stable")[:CARRIERS] if effective[i] > least]
    if np.isnan(of):
        unit = unit_of(DIRECTIONS[number])
        return ", ".join(f"{found.mode[i]} ({found.frequency[i]:.4g} Hz) {effective[i]:.3g} {unit}" for i in largest)
    return ", ".join(f"{found.mode[i]} ({found.frequency[i]:.4g} Hz) {in_percent(effective[i] / of)}" for i in largest)


def _said(found: Carried, sums: tuple[MassSum, ...], band: float) -> Iterator[str]:
    """Sentences about the sums: one about the band, one for each direction, one about interface modes."""
    rule = EFFECTIVE_MASS
    yield (
        f"What the modes up to {band:.4g} Hz carry of the body. {in_percent(rule.share)} of what is not on the "
        f"boundary are taken for enough: {rule.source} ({rule.status})."
    )
    for one in sums:
        if np.isnan(one.mass_in_band):
            continue
        by = f"most by mode {one.carried_by}" if one.carried_by else "no mode carries much of it"
        if np.isnan(one.share_in_band):
            yield f"{one.direction}: {one.mass_in_band:.4g} {one.unit} in the band ({one.reason}); {by}."
            continue
        above = (one.summed_mass - one.mass_in_band) / one.body_mass
        held = (
            "" if np.isnan(one.boundary_mass) else f"{in_percent(one.boundary_mass / one.body_mass)} on the boundary, "
        )
        short = " (not enough)" if one.enough is False else ""
        yield (
            f"{one.direction}: {in_percent(one.share_in_band)} in the band{short}, {in_percent(above)} above it, {held}"
            f"{in_percent(max(0.0, one.missing_share))} in no mode; {by}."
        )
    interface = np.array([kind == "interface" for kind in found.kind])
    if interface.any() and not interface.all():
        summed = np.nansum(found.effective, axis=0)
        there = summed > 0.0
        share = np.nansum(found.effective[interface], axis=0) / np.where(there, summed, 1.0)
        told = ", ".join(f"{d} {in_percent(s)}" for d, s in zip(np.array(DIRECTIONS)[there], share[there], strict=True))
        yield f"Of what all modes carry, interface modes have: {told}."


def _by_mode(found: Carried) -> Iterator[ModalMass]:
    """Rows of all modes in the directions that are given."""
    shares = found.effective / found.body
    for number, direction in enumerate(DIRECTIONS):
        if np.isnan(found.effective[:, number]).all():
            continue
        share = shares[:, number] if not _too_large(found, number) else np.full(len(found.mode), np.nan)
        known = np.isfinite(found.body[number]) and not _too_large(found, number)
        summed = np.nancumsum(share) if known else share
        for i, mode in enumerate(found.mode.tolist()):
            yield ModalMass(
                mode=mode,
                frequency_hz=float(found.frequency[i]),
                kind=found.kind[i],
                direction=direction,
                participation=float(found.factor[i, number]),
                effective_mass=float(found.effective[i, number]),
                share=float(share[i]),
                summed_share=float(summed[i]),
            )


def _dynamic(found: Carried, band: float, damping: float | None) -> Finding:
    """Dynamic mass over frequency, of the directions that are given; or why there is none."""
    ratio = np.where(found.damping_ratio > 0.0, found.damping_ratio, np.nan if damping is None else damping)
    without = found.mode[np.isnan(ratio)]
    if without.size:
        what = (
            f"{without.size} of {found.mode.size} modes have no damping ratio, and without one a resonance is infinite"
        )
        note = f"{what}. Give damping_ratio in the modes, or --damping, for instance 0.015."
        return Finding("dynamic_mass", DYNAMIC, notes=(note,))
    f = frequencies_to_look_at(found.frequency, ratio, BEYOND * band)
    given = [n for n in range(6) if np.isfinite(found.effective[:, n]).any() and not _too_large(found, n)]
    effective = np.nan_to_num(found.effective[:, given])
    m_e = elastic_mass(f, found.frequency, ratio, effective)
    whole = dynamic_mass(f, found.frequency, ratio, effective, found.body[given])
    rows = [
        DynamicMass(
            frequency_hz=float(f[i]),
            direction=DIRECTIONS[number],
            dynamic_mass=float(abs(whole[i, column])),
            phase_deg=float(np.degrees(np.angle(whole[i, column]))),
            elastic_mass=float(abs(m_e[i, column])),
        )
        for column, number in enumerate(given)
        for i in range(len(f))
    ]
    said = []
    for column, number in enumerate(given):
        unit = unit_of(DIRECTIONS[number])
        top = int(np.abs(m_e[:, column]).argmax())
        rigid = f"{found.body[number]:.4g} {unit} at 0 Hz, " if np.isfinite(found.body[number]) else ""
        elastic = f"elastic part largest at {f[top]:.4g} Hz with {abs(m_e[top, column]):.4g} {unit}"
        said.append(f"{DIRECTIONS[number]}: {rigid}{elastic}.")
    notes = [
        "Force (moment) at the base over its acceleration: rigid mass + sum of m_eff r^2 / (1 - r^2 + 2 i zeta r)."
    ]
    if damping is not None and not (found.damping_ratio > 0.0).all():
        notes.append(f"The damping ratio of the modes without one was given as {damping:g}.")
    return Finding("dynamic_mass", DYNAMIC, tuple(said), tuple(rows), tuple(notes))
