"""The S-N curve of a weld once more, from the case text and from constants copied here a second time."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import gamma, gammainc, gammaincc

Floats = NDArray[np.float64]

# ASME VIII-2 Annex 3-F, Table 3-F.11M: h, and C at the mean and at one, two and three sigma below it
LEVELS = ("mean", "mean-1sigma", "mean-2sigma", "mean-3sigma")
MASTER = {
    "master-steel": (0.31950, (19930.2, 16629.7, 13875.7, 11577.9)),
    "master-aluminium": (0.27712, (3495.13, 2845.42, 2316.48, 1885.87)),
}


@dataclass(frozen=True, slots=True, eq=False)
class Given:
    """A curve as its source gives it: ranges at ``reference_cycles`` for each survival level, or for the only one."""

    slopes: tuple[float, ...]
    knees_cycles: tuple[float, ...]
    reference_cycles: float
    ranges: Mapping[str, float]
    applies: str
    thickness_reference: float | None
    thickness_exponent: float


@dataclass(frozen=True, slots=True)
class Allowed:
    """What a curve allows for beside its thickness rule, by default nothing.

    Attributes
    ----------
    on_range : partial factors and those of the table of strength factors, on every range
    half_attachment : half the length of the attachment is the thickness where it is the smaller one
    bending : reference thickness [mm] and exponent of the allowance for bending of BS 7608; None: there is none
    ratio_at_0 : f(R) at R = 0 between its plateaus; None: high residual stress, where it is 1
    own_limit : damage limit of the curve; None: that of the mission
    on_limit : factor of the table on the damage limit
    """

    on_range: float = 1.0
    half_attachment: bool = False
    bending: tuple[float, float] | None = None
    ratio_at_0: float | None = None
    own_limit: float | None = None
    on_limit: float = 1.0


@dataclass(frozen=True, slots=True, eq=False)
class RecountCurve:
    """A curve in log-log axes: slope of each segment and one point (ln cycles, ln range) on it, ranges at the knees.

    Ranges below ``cutoff`` do no damage. ``on_equivalent`` tells curves in dS from those in structural stress, whose
    thickness rule is ``(t / reference)^exponent`` for t above the reference; the rule of dS has the exponent 2/9.
    """

    slopes: tuple[float, ...]
    points: tuple[tuple[float, float], ...]
    knees: tuple[float, ...]
    cutoff: float
    on_equivalent: bool
    thickness_reference: float | None
    thickness_exponent: float
    thickness_limits: tuple[float, float]
    allowed: Allowed = Allowed()

    def limit(self, mission: Mapping[str, Any]) -> float:
        """Largest Miner sum allowed on this curve."""
        own = self.allowed.own_limit
        return float((mission.get("damage_limit", 1.0) if own is None else own) * self.allowed.on_limit)

    @property
    def is_straight(self) -> bool:
        """Whether one slope serves all ranges."""
        return len(self.slopes) == 1 and self.cutoff == 0.0

    def damage(self, x: Floats) -> Floats:
        """Damage 1/N of a cycle of each range."""
        log_cycles = np.full(len(x), np.inf)
        with np.errstate(divide="ignore"):
            log_x = np.log(x)
        for j, (k, (log_n, log_s)) in enumerate(zip(self.slopes, self.points, strict=True)):
            above = x >= (self.knees[j] if j < len(self.knees) else 0.0)
            here = above & (x >= self.cutoff) & np.isinf(log_cycles)
            log_cycles[here] = log_n + k * (log_s - log_x[here])
        return np.asarray(np.exp(-log_cycles))

    def mean_damage(self, scale: float, shape: float) -> float:
        """Mean damage of cycles whose ranges exceed x with probability ``exp(-(x / scale)^shape)``."""
        if scale == 0.0:
            return 0.0
        total = 0.0
        upper = np.inf
        for j, (k, (log_n, log_s)) in enumerate(zip(self.slopes, self.points, strict=True)):
            lower = max(self.knees[j] if j < len(self.knees) else 0.0, self.cutoff)
            a = 1.0 + k / shape
            from_u, to_u = (lower / scale) ** shape, (upper / scale) ** shape
            below, above = gammainc(a, to_u) - gammainc(a, from_u), gammaincc(a, from_u) - gammaincc(a, to_u)
            share = above if from_u > a else below  # the one that does not cancel
            total += float(np.exp(k * (np.log(scale) - log_s) - log_n) * gamma(a) * share)
            upper = lower
        return total

    def bending_factor(self, r: Floats) -> Floats:
        """Divisor of the range for each bending ratio."""
        if self.allowed.bending is not None:
            return np.asarray(1.0 + 0.18 * r**1.4)  # BS 7608
        return ratio_factor(r) if self.on_equivalent else np.ones_like(r)

    def stress_ratio_factor(self, a: Floats, b: Floats) -> Floats:
        """f(R) of IIW, the divisor of the range of each cycle between two stresses, by their mean over amplitude.

        R = (kappa - 1) / (kappa + 1), so that neither compression nor a maximum of 0 is a case of its own.
        """
        if self.allowed.ratio_at_0 is None:
            return np.ones_like(a)
        low, high = np.minimum(a, b), np.maximum(a, b)
        with np.errstate(divide="ignore", invalid="ignore"):
            kappa = (low + high) / (high - low)
            R = np.where(kappa > 0.0, 1.0 - 2.0 / (kappa + 1.0), -1.0)
        return np.asarray(np.clip(self.allowed.ratio_at_0 - 0.4 * R, 1.0, self.allowed.ratio_at_0 + 0.4))

    def convex_damage(self, x: Floats) -> Floats:
        """Damage that is convex in the range and nowhere below that of the curve: its first slope for all ranges.

        Where a slope is flatter than one before it, the largest damage of all slopes.
        """
        steepens = all(a <= b for a, b in pairwise(self.slopes))
        straight = [
            replace(self, slopes=(k,), points=(point,), knees=(), cutoff=0.0).damage(x)
            for k, point in zip(self.slopes, self.points, strict=True)
        ]
        return straight[0] if steepens else np.max(straight, axis=0)

    def size_factor(self, thickness: float, attachment: float = np.inf) -> float:
        """Factor on every range: of the plate thickness [mm], an attachment of some length [mm] on it, and the rest."""
        factor = self.allowed.on_range
        if self.allowed.bending is not None:
            reference, exponent = self.allowed.bending
            factor *= (thickness / reference) ** exponent
        if self.on_equivalent:
            return float(factor * np.clip(thickness, *self.thickness_limits) ** (2.0 / 9.0))
        if self.allowed.half_attachment and attachment < 2.0 * thickness:
            thickness = attachment / 2.0
        if self.thickness_reference is None or thickness <= self.thickness_reference:
            return float(factor)
        return float(factor * (thickness / self.thickness_reference) ** self.thickness_exponent)


def curve_named(
    name: str, case: Mapping[str, Any], record: Mapping[str, Any], factors: Sequence[Mapping[str, Any]] = ()
) -> RecountCurve:
    """Curve as the case asks for it, with the rows of its table of strength ``factors``.

    Master curves come from this module, curves of the case from its text; what else the catalogue holds, and what a
    case keeps of a curve that it changes, is taken from the provenance, which lists slopes, knees and ranges.
    """
    asked = case["curve"]
    own = case.get("curves", {}).get(name)
    line_is_own = own is not None and {"slopes", "range_at_2e6_MPa"} <= own.keys()
    if name in MASTER and not line_is_own:
        h, ranges = MASTER[name]
        given = Given((1.0 / h,), (), 1.0, dict(zip(LEVELS, ranges, strict=True)), "dS", None, 0.0)
    elif own is not None and line_is_own:
        listed = record.get("curves", {}).get(name, {})  # of what a changed curve of the catalogue keeps
        keeps = ("applies", "thickness_reference_mm", "thickness_exponent")
        given = _own({key: listed[key] for key in keeps if key in listed} | dict(own))
    else:
        given = _listed(record["curves"][name])
    level = asked.get("survival", "mean-2sigma") if len(given.ranges) > 1 else next(iter(given.ranges))
    points, knees = _through(given.ranges[level], given.reference_cycles, given.slopes, given.knees_cycles)
    slopes, cutoff = given.slopes, knees[-1] if len(knees) == len(given.slopes) else 0.0
    extension = asked.get("extension", "none") if not given.knees_cycles else "none"
    if extension != "none":  # of a curve of one slope: the others are refused
        (k,), ((log_n, log_s),) = slopes, points
        log_knee = np.log(asked.get("knee_cycles", 1e7))
        log_range = log_s - (log_knee - log_n) / k
        if extension == "haibach":
            slopes, points = (k, 2.0 * k - 1.0), ((log_n, log_s), (log_knee, log_range))
            knees = (float(np.exp(log_range)),)
        else:
            cutoff = float(np.exp(log_range))
    return RecountCurve(
        slopes=slopes,
        points=points,
        knees=knees[: len(slopes) - 1],
        cutoff=cutoff,
        on_equivalent=given.applies == "dS",
        thickness_reference=given.thickness_reference,
        thickness_exponent=given.thickness_exponent,
        thickness_limits=(16.0, 150.0) if asked.get("thickness_rule", "actual") == "asme" else (0.0, np.inf),
        allowed=_allowed(own or {}, [row for row in factors if row["curve"] == name]),
    )


def origin_of(name: str, case: Mapping[str, Any], record: Mapping[str, Any]) -> tuple[str, str]:
    """Status and edition of a curve: of the case by its text, else as the provenance lists it."""
    own = case.get("curves", {}).get(name)
    if own is None or not {"slopes", "range_at_2e6_MPa", "applies", "source"} <= own.keys():  # all or part of it listed
        listed = record["curves"][name]
        return str(listed.get("status", "")), str(listed.get("edition", ""))
    return own.get("status", "user"), own.get("edition", "")


def _allowed(own: Mapping[str, Any], factors: Sequence[Mapping[str, Any]]) -> Allowed:
    """Allowances of a curve of the case, and what the rows of its table make of ranges and limit."""
    of_role = {
        role: float(np.prod([row["value"] for row in factors if row["role"] == role]))
        for role in ("stress", "strength", "limit")
    }
    bends = own.get("bending_factor", "none") == "bs7608"
    return Allowed(
        on_range=own.get("gamma_Ff", 1.0) * own.get("gamma_Mf", 1.0) * of_role["stress"] / of_role["strength"],
        half_attachment=own.get("thickness_effective", "t") == "L_half",
        bending=(own["bending_reference_mm"], own["bending_exponent"]) if bends else None,
        ratio_at_0={"iiw_low": 1.2, "iiw_medium": 0.9}.get(own.get("mean_stress", "none")),
        own_limit=own.get("damage_limit"),
        on_limit=of_role["limit"],
    )


def ratio_factor(r: Floats) -> Floats:
    """``I(r)^(1/m)`` of ASME VIII-2 5.5.5.2, load controlled."""
    return np.asarray(np.polyval([-0.17, -0.364, 1.23], r) / np.polyval([-0.178, -0.306, 1.007], r))


def _own(own: Mapping[str, Any]) -> Given:
    """Curve of the case, described by its range at 2e6 cycles."""
    slopes, knees = tuple(own["slopes"]), tuple(own.get("knees_cycles", ()))
    k = slopes[_segment_at(2e6, slopes, knees)]
    ranges = {"as tabulated": own["range_at_2e6_MPa"]}
    if "log10_scatter" in own:
        per_sigma = 10.0 ** (own["log10_scatter"] / k)
        ranges = {level: own["range_at_2e6_MPa"] / per_sigma**sigmas for sigmas, level in enumerate(LEVELS)}
    thickness = own.get("thickness_reference_mm"), own.get("thickness_exponent", 0.0)
    return Given(slopes, knees, 2e6, ranges, own["applies"], *thickness)


def _listed(listed: Mapping[str, Any]) -> Given:
    """Curve as the provenance lists it."""
    return Given(
        slopes=tuple(listed["slopes"]),
        knees_cycles=tuple(listed["knees_cycles"]),
        reference_cycles=listed["reference_cycles"],
        ranges=listed["reference_range"],
        applies=listed["applies"],
        thickness_reference=listed["thickness_reference_mm"],
        thickness_exponent=listed["thickness_exponent"],
    )


def _segment_at(cycles: float, slopes: tuple[float, ...], knees_cycles: tuple[float, ...]) -> int:
    return min(sum(knee < cycles for knee in knees_cycles), len(slopes) - 1)


def _through(
    range_: float, cycles: float, slopes: tuple[float, ...], knees_cycles: tuple[float, ...]
) -> tuple[tuple[tuple[float, float], ...], tuple[float, ...]]:
    """Point on every segment and range at every knee, found by walking along the curve from one point of it."""
    start = _segment_at(cycles, slopes, knees_cycles)
    points = {start: (np.log(cycles), np.log(range_))}
    knees = {}
    for j in range(start, len(knees_cycles)):  # towards more cycles
        log_n, log_s = points[j]
        knees[j] = log_s - (np.log(knees_cycles[j]) - log_n) / slopes[j]
        points[j + 1] = (np.log(knees_cycles[j]), knees[j])
    for j in range(start, 0, -1):  # towards fewer
        log_n, log_s = points[j]
        knees[j - 1] = log_s + (log_n - np.log(knees_cycles[j - 1])) / slopes[j]
        points[j - 1] = (np.log(knees_cycles[j - 1]), knees[j - 1])
    return tuple(points[j] for j in range(len(slopes))), tuple(float(np.exp(knees[j])) for j in sorted(knees))
