"""Each variant at the stations of a curve: what is known of it in closed form, or why it changes nothing there."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fatigue.life.rule import CycleRule
from fatigue.pipeline.multiaxial.found import MODELS, STATUSES
from fatigue.pipeline.multiaxial.method import DECIDING
from fatigue.pipeline.sensitivity import notes
from fatigue.pipeline.sensitivity.closed import (
    KNEE,
    LEVEL,
    LIMIT,
    Floats,
    Varied,
    first_slope,
    first_slope_bound,
    scaled,
    steepened,
    stronger,
    survival_factor,
    with_haibach,
    with_law,
)
from fatigue.pipeline.sensitivity.sampling import OtherSampling
from fatigue.pipeline.sensitivity.toes import Toes
from fatigue.quotient import quotient
from fatigue.spectrum.trust import sampling_loss, vertex_sampling_loss

TIMES_EXPECTED = 2.0  # the loss by sampling that its samples per peak let expect of a point


def varied(name: str, toes: Toes, sampling: OtherSampling) -> Varied | int:
    """A variant at the stations of a curve, or the code of the note why it changes nothing."""
    if name == sampling.variant:
        return _sampled(toes, sampling)
    return CLOSED[name](toes)


def _shear_path_range(toes: Toes) -> Varied | int:
    """Normal stress and shear by the range of their path: counted at the points that no bound settles."""
    if toes.case.multiaxial.method == "range":
        return notes.ASKED_FOR
    assert toes.shear is not None
    normal, of_path = toes.shear["normal"], toes.shear["range"]
    settled = toes.shear["status"] == STATUSES.index("settled_passes")
    return Varied(
        exact=np.where(np.isnan(of_path), np.nan, np.fmax(normal, of_path)),
        upper=np.where(settled, np.fmax(normal, np.minimum(toes.shear["bound"], 1.0)), np.inf),
        lower=np.where(toes.counted, normal, 0.0),
        note=notes.SHEAR_LEFT,
        tells_counted=True,
    )


def _shear_asme(toes: Toes) -> Varied | int:
    """Shear combined as in ASME VIII-2 5.5.5.3; an upper bound where one stands for counting."""
    if toes.case.multiaxial.method == "asme":
        return notes.ASKED_FOR
    assert toes.shear is not None
    value = np.fmax(toes.shear["normal"], toes.shear["asme"])
    known = toes.counted & ~np.isnan(toes.shear["asme"])
    return Varied(np.where(known, value, np.nan), np.where(np.isnan(value), np.inf, value))


def _raw_end(toes: Toes) -> Varied | int:
    """Without the end treatment: counted where it matters."""
    if not toes.stress.raw_ends.rows.size:
        return notes.NO_END
    raw = quotient(toes.plan.target_km, toes.mission.life_km_raw_end)
    known = toes.counted & ~np.isnan(toes.mission.life_km_raw_end)
    treated = np.ones(len(toes.rows), dtype=np.bool_)
    treated[toes.stress.raw_ends.rows] = False
    if toes.case.multiaxial.method in DECIDING:  # raw ends were counted by normal stress alone
        exact = np.where(treated[:, None], toes.utilisation, np.nan)
        lower = np.where(known & ~treated[:, None], raw, 0.0)
        return Varied(exact, np.full_like(raw, np.inf), note=notes.SHEAR_DECIDES, lower=lower)
    upper = np.where(treated[:, None], toes.utilisation, toes.raw_end_bound)
    return Varied(np.where(known, raw, np.nan), upper)


def _asme_thickness(toes: Toes) -> Varied | int:
    rated, law = toes.rated, toes.rated.rule.law
    if rated.curve.applies != "dS":
        return notes.NO_DS
    if rated.thickness_rule == "asme":
        return notes.ASKED_FOR
    size = replace(rated, thickness_rule="asme").size(toes.thickness)
    factor = (size / toes.stress.size)[:, None]
    return _larger(toes, factor, rated.rule, size, straight=law.is_straight)


def _survival(toes: Toes) -> Varied | int:
    rated = toes.rated
    if not rated.curve.has_scatter:
        return notes.NO_SCATTER
    if rated.survival == LEVEL:
        return notes.ASKED_FOR
    factor = survival_factor(rated)
    rule = with_law(rated.rule, stronger(rated.rule.law, factor))
    return _larger(toes, np.full((len(toes.rows), 1), factor), rule, None, straight=rule.law.is_straight)


def _larger(toes: Toes, factor: Floats, rule: CycleRule, size: Floats | None, *, straight: bool) -> Varied:
    """Equivalent ranges times a factor (n, 1): in closed form on one slope, else bounded."""
    law = toes.rated.rule.law
    if straight:
        return scaled(toes.utilisation, factor ** float(law.slopes[0]), toes.counted)
    upper = np.minimum(
        steepened(toes.utilisation, factor, law),
        _all_on_first_slope(toes) * factor ** float(law.slopes[0]),
    )
    lower = np.where(toes.counted & (factor >= 1.0), toes.utilisation, 0.0)
    return Varied(np.full_like(toes.utilisation, np.nan), upper, rule, size, lower=lower)


def _haibach(toes: Toes) -> Varied | int:
    rated, curve = toes.rated, toes.case.curve
    if rated.curve.knees_cycles:
        return notes.OWN_KNEES
    if curve.extension == "haibach" and curve.knee_cycles == KNEE:
        return notes.ASKED_FOR
    upper = toes.utilisation if rated.rule.law.is_straight else _all_on_first_slope(toes)
    return Varied(np.full_like(upper, np.nan), upper, with_law(rated.rule, with_haibach(rated.rule.law)))


def _no_knee(toes: Toes) -> Varied | int:
    rated = toes.rated
    rule = with_law(rated.rule, first_slope(rated.rule.law))
    upper = _all_on_first_slope(toes)
    if rated.curve.knees_cycles:
        return notes.OWN_KNEES
    lower = np.where(toes.counted, toes.utilisation, 0.0)
    return Varied(np.full_like(upper, np.nan), upper, rule, lower=lower)


def _damage_limit(toes: Toes) -> Varied | int:
    if toes.plan.damage_limit == LIMIT:
        return notes.ASKED_FOR
    return scaled(toes.utilisation, toes.plan.damage_limit / LIMIT, toes.counted)


def _sampled(toes: Toes, sampling: OtherSampling) -> Varied | int:
    """Records sampled otherwise.

    A sample between others widens cycles of a count by ranges, or adds one, and narrows none; so what is counted
    without it is at most what is counted with it, where a wider cycle damages more. f(R) leaves it so, f_M does not.
    The bending ratio, which every cycle has of its own reversals, may change its damage by ``ratios``.
    """
    if sampling.changes_nothing:
        return notes.NOT_UPSAMPLED
    rule, is_vertex = toes.rated.rule, toes.case.counting.reversals == "vertex"
    k = float(rule.law.slopes.max())
    of_bending, of_membrane = rule.ratio_factor(np.array([1.0, 0.0]))
    ratios = float(of_bending / of_membrane) ** k
    widens = not rule.mean_stress and not (rule.law.cutoff > 0.0 and rule.depends_on_bending)
    unknown = np.full_like(toes.utilisation, np.nan)
    if sampling.variant == "upsample_auto":
        loss = (vertex_sampling_loss if is_vertex else sampling_loss)(toes.samples_per_peak, k)
        upper = toes.utilisation / np.maximum(1.0 - TIMES_EXPECTED * loss, 0.1)
        lower = _of_ranges(toes) / ratios if widens else np.zeros_like(upper)
        return Varied(unknown, upper, rule, note=notes.EXPECTED, lower=lower)
    upper = _of_ranges(toes) * ratios
    if toes.case.multiaxial.method in MODELS:
        upper = np.fmax(upper, _path_of_fewer_samples(toes))
    return Varied(unknown, upper, rule, note=notes.NOTHING if widens and not is_vertex else notes.EXPECTED)


def _of_ranges(toes: Toes) -> Floats:
    """Utilisation (n, 2) by what is counted by ranges: all of it, or the normal stress beside a path that decides."""
    if toes.case.multiaxial.method not in MODELS:
        return toes.utilisation
    assert toes.shear is not None
    return np.asarray(np.where(toes.toe, toes.shear["normal"], toes.utilisation))


def _path_of_fewer_samples(toes: Toes) -> Floats:
    """Utilisation (n, 2) that no path through some of the samples exceeds: its length and ranges are not larger.

    The bound T1 by length and ranges is one of the sum by range without cycles across events; others have none.
    """
    assert toes.shear is not None
    bound = toes.shear["bound"]
    if toes.case.multiaxial.method != "range" or toes.plan.loops:
        return np.full_like(bound, np.inf)
    return np.asarray(np.where(np.isnan(bound), np.inf, bound))


def _all_on_first_slope(toes: Toes) -> Floats:
    """Utilisation (n, 2) of all cycles on the first slope; +inf where shear decides: no ranges of it are kept."""
    if toes.case.multiaxial.method in DECIDING:
        return np.full_like(toes.utilisation, np.inf)
    return first_slope_bound(toes.mission.equivalent_range, toes.stress.size, toes.rated.rule, toes.plan)


CLOSED: dict[str, Callable[[Toes], Varied | int]] = {
    "shear_path_range": _shear_path_range,
    "shear_asme": _shear_asme,
    "raw_end": _raw_end,
    "asme_thickness": _asme_thickness,
    "survival_3sigma": _survival,
    "haibach_1e7": _haibach,
    "no_knee": _no_knee,
    "damage_limit_0.5": _damage_limit,
}
