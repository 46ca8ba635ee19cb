"""Endurance between static load cases, at weld toes and at stress points."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.case import EnduranceCheck
from fatigue.life.endurance.haigh import (
    COMPONENTS,
    EnduranceLine,
    allowed_amplitudes,
    mirrored,
    stress_ratio,
    utilisations,
)
from fatigue.life.endurance.pairs import WorstPairs, plane_range, signed_utilisations, worst_pairs
from fatigue.life.endurance.zonotope import Signs, corner_signs, corners, diameter, extremes
from fatigue.pipeline.checks.case_stress import CaseStress, stress_at_points, stress_at_welds
from fatigue.pipeline.checks.rows import NOT_ASSESSED, CheckRows, check_rows, joined
from fatigue.pipeline.solve.body import Body
from fatigue.pipeline.solve.compared_cases import endurance_range, looks_at_welds
from fatigue.pipeline.solve.model import Model
from fatigue.pipeline.solve.rated.rated_curves import RatedCurve
from fatigue.readers.neutral.endurance.static_cases import CaseGroup
from fatigue.readers.neutral.points.modal_stresses import PointStress

Floats = NDArray[np.float64]

IN_PLANE = np.array([1.0, np.sqrt(3.0)])  # of normal stress and shear in their plane
AT_ONCE = 2**20  # stresses of corners in memory
OUTSIDE = "outside table: R is above that of the last row"
WITHOUT_PAR = "without the stress along the weld, which line forces do not have"


def weld_endurance(model: Model) -> CheckRows:
    """Rows of the endurance checks at the weld toes of some welds: across the weld, and shear."""
    checks = [check for check in model.case.checks.endurance if looks_at_welds(check)]
    return joined([_rows_of(model.body, check, stress_at_welds(model, check), WITHOUT_PAR) for check in checks])


def point_endurance(body: Body, stress: PointStress | None) -> CheckRows:
    """Rows of the endurance checks at points; ``stress`` is that of the stress points, None without them."""
    checks = [check for check in body.case.checks.endurance if check.points]
    return joined([_rows_of(body, check, stress_at_points(body, stress, check)) for check in checks])


def _rows_of(body: Body, check: EnduranceCheck, stress: CaseStress, note: str = "") -> CheckRows:
    """Rows of one check of a body."""
    curve = None if check.curve is None else body.curves[check.curve]
    return endurance_rows(check, body.compared.lines_of(check), curve, stress, note)


def endurance_rows(
    check: EnduranceCheck,
    lines: Sequence[EnduranceLine],
    curve: RatedCurve | None,
    stress: CaseStress,
    note: str = "",
) -> CheckRows:
    """Rows of one endurance check at n points: of each line and of the curve, then of the combination of the lines.

    ``note`` is what a reader of the combination has to know.
    """
    if not len(stress):
        return joined([])
    common = dict(stress.place) | {"check": "endurance", "plane_range_MPa": _plane_range(stress)}
    rows = [_line_rows(line, stress, common) for line in lines]
    if curve is not None:
        rows.append(_curve_rows(curve, stress, common))
    if check.limit is not None:
        rows.append(_combined_rows(check.limit, check.kappa, lines, stress, common, note))
    return joined(rows)


def _line_rows(line: EnduranceLine, stress: CaseStress, common: Mapping[str, Any]) -> CheckRows:
    """Amplitude of the worst cycle of a component over what its line allows."""
    minimum, maximum, names = _worst_cycle(stress, COMPONENTS.index(line.component), line)
    u, inside = utilisations(line, minimum, maximum)
    amplitude = 0.5 * (maximum - minimum)
    with np.errstate(divide="ignore", invalid="ignore"):
        kappa = 0.5 * (maximum + minimum) / amplitude
    return check_rows(
        len(stress),
        **common,
        component=line.component,
        curve=line.name,
        range_max_MPa=maximum - minimum,
        R=stress_ratio(minimum, maximum),
        amplitude_MPa=amplitude,
        allowed_amplitude_MPa=np.where(amplitude > 0.0, allowed_amplitudes(line, kappa), np.nan),
        utilisation_stress=np.where(inside, u, np.nan),
        fulfilled=np.where(inside, u <= 1.0, NOT_ASSESSED),
        governing_event=names,
        note=["" if has_it else f"{OUTSIDE}; u is at most {most:.4g}" for most, has_it in zip(u, inside, strict=True)],
    )


def _curve_rows(rated: RatedCurve, stress: CaseStress, common: Mapping[str, Any]) -> CheckRows:
    """Design range of the worst cycle over the cut-off of a curve, or over its last knee.

    Where the curve allows for the stress ratio the widest cycle is still the worst one: no cycle inside it is worse.
    """
    component = COMPONENTS.index("perp" if rated.curve.quantity == "normal" else "shear")
    minimum, maximum, names = _worst_cycle(stress, component)
    of_ratio = rated.rule.mean_stress_factor(minimum, maximum)
    u = rated.size(stress.thickness) * (maximum - minimum) / of_ratio / endurance_range(rated)
    of = "cut-off" if rated.rule.law.cutoff > 0.0 else "last knee"
    return check_rows(
        len(stress),
        **common,
        component=COMPONENTS[component],
        curve=rated.curve.name,
        range_max_MPa=maximum - minimum,
        R=stress_ratio(minimum, maximum),
        amplitude_MPa=0.5 * (maximum - minimum),
        utilisation_stress=u,
        fulfilled=u <= 1.0,
        governing_event=names,
        note=f"range over the {of} of the curve",
    )


def _combined_rows(
    limit: float,
    kappa: Sequence[float],
    lines: Sequence[EnduranceLine],
    stress: CaseStress,
    common: Mapping[str, Any],
    note: str,
) -> CheckRows:
    """Combination of the components at the pair of cases, or of corners, where it is largest."""
    worst, one, other, names = _worst_pair(stress, lines, kappa)
    u = signed_utilisations(one, other, lines)
    asked = [COMPONENTS.index(line.component) for line in lines]
    texts = [", ".join(f"u_{COMPONENTS[c]} {value[c]:.4g}" for c in asked) for value in u]
    said = [
        text if inside else f"{OUTSIDE} of a line; the value is at most {most:.4g} by {text}"
        for text, most, inside in zip(texts, worst.value, worst.inside, strict=True)
    ]
    notes = ["; ".join(filter(None, [one, note])) for one in said]
    return check_rows(
        len(stress),
        **common,
        component="combination",
        curve=" + ".join(line.name for line in lines),
        value=np.where(worst.inside, worst.value, np.nan),
        limit_value=limit,
        utilisation_stress=np.where(worst.inside, np.sqrt(worst.value / limit), np.nan),
        fulfilled=np.where(worst.inside, worst.value <= limit, NOT_ASSESSED),
        governing_event=names,
        note=notes,
    )


def _worst_cycle(stress: CaseStress, c: int, line: EnduranceLine | None = None) -> tuple[Floats, Floats, list[str]]:
    """Least and largest stress (n,) of the worst cycle of a component, and the cases that make them.

    Alternating loads all go from one end to the other: any other cycle of theirs lies inside this one.
    """
    group, n = stress.group, np.arange(len(stress))
    if group.kind == "alternating":
        minimum, maximum, signs = extremes(stress.static[:, c], stress.loads[:, :, c])
        one, other = _corner_names(group, signs), _corner_names(group, -signs)
    else:
        values = stress.loads[:, :, c]
        pair = np.stack([values.argmin(axis=1), values.argmax(axis=1)], axis=1)
        if line is not None:
            pair = worst_pairs(stress.loads, [line]).pair
        low_first = values[n, pair[:, 0]] <= values[n, pair[:, 1]]
        low, high = np.where(low_first, pair.T, pair.T[::-1])
        minimum, maximum = values[n, low], values[n, high]
        one, other = [group.cases[i] for i in high], [group.cases[i] for i in low]
    if COMPONENTS[c] == "shear":
        swapped = -minimum > maximum
        minimum, maximum = mirrored(minimum, maximum)
        ends = [(b, a) if turned else (a, b) for a, b, turned in zip(one, other, swapped, strict=True)]
    else:
        ends = list(zip(one, other, strict=True))
    return minimum, maximum, [f"{a} / {b}" for a, b in ends]


def _worst_pair(
    stress: CaseStress, lines: Sequence[EnduranceLine], kappa: Sequence[float]
) -> tuple[WorstPairs, Floats, Floats, list[str]]:
    """Worst pair of states or corners at n points, the stress (n, 3) of both, and their names."""
    group, n = stress.group, len(stress)
    k = len(group.cases)
    states_each = k if group.kind == "state" else 2**k
    step = max(1, AT_ONCE // states_each)
    parts, ends = [], []
    for first in range(0, n, step):
        some = slice(first, first + step)
        loads = stress.loads[some]
        states = loads if group.kind == "state" else corners(stress.static[some], loads)
        found = worst_pairs(states, lines, kappa)
        parts.append(found)
        ends.append(np.take_along_axis(states, found.pair[:, :, None], axis=1))
    worst = WorstPairs(*(np.concatenate([getattr(p, name) for p in parts]) for name in ("value", "pair", "inside")))
    both = np.concatenate(ends)
    if group.kind == "state":
        names = [f"{group.cases[i]} / {group.cases[j]}" for i, j in worst.pair]
    else:
        signs = corner_signs(k)
        one, other = (_corner_names(group, signs[worst.pair[:, i]]) for i in (0, 1))
        names = [f"{a} / {b}" for a, b in zip(one, other, strict=True)]
    return worst, both[:, 0], both[:, 1], names


def _corner_names(group: CaseGroup, signs: Signs) -> list[str]:
    """Corners of alternating loads in words, of signs (n, k): ``+pitch -roll``."""
    return [" ".join(f"{'+' if s > 0 else '-'}{name}" for s, name in zip(of, group.cases, strict=True)) for of in signs]


def _plane_range(stress: CaseStress) -> Floats:
    """Largest distance (n,) of two cases or corners in the plane of normal stress and sqrt(3) shear [MPa]."""
    in_plane = stress.loads[:, :, [0, 2]] * IN_PLANE
    return plane_range(in_plane) if stress.group.kind == "state" else diameter(in_plane)[0]
