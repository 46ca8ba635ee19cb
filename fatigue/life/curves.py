"""S-N curves: the catalogue, a user's own, and the damage law one assessment draws from them."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import CaseError, Problem
from fatigue.life.allowances import ALLOWANCE_KEYS, NOTHING, Allowances

Applies = Literal["structural", "dS", "nominal", "hot_spot", "throat", "parent"]
Quantity = Literal["normal", "shear"]
CurveStatus = Literal["verified", "user", "unverified"]
Survival = Literal["mean", "mean-1sigma", "mean-2sigma", "mean-3sigma"]
Extension = Literal["none", "haibach", "cutoff"]
ThicknessRule = Literal["actual", "asme"]

DEFAULT_SURVIVAL: Survival = "mean-2sigma"
TABULATED = "as tabulated"
SHIPPED = "cross-checked"  # status of the shipped curves: recalled, compared with each other and with publications
SIGMAS_BELOW_MEAN: dict[str, int] = {"mean": 0, "mean-1sigma": 1, "mean-2sigma": 2, "mean-3sigma": 3}


@dataclass(frozen=True, slots=True)
class SNCurve:
    """A published or user-given S-N curve in stress ranges, straight segments in log-log axes.

    Attributes
    ----------
    name : key in the catalogue or in the case
    applies : "dS", the equivalent structural stress range of the master curve [MPa mm^-0.222], "structural", the
        structural stress range itself [MPa], or the range [MPa] of another stress
    slopes : k of each segment of N = A / range**k, from few cycles to many
    knees_cycles : cycles where the next segment begins; as many knees as slopes: no damage beyond the last one
    reference_cycles : cycles at which ``reference_range`` holds
    reference_range : range at the reference cycles for each survival level, or for "as tabulated" only
    thickness_reference, thickness_exponent : f = (t / reference)**exponent on the range, t above the reference [mm]
    source : where the numbers come from, edition and clause
    edition, clause : of the source
    status : what the numbers rest on; the shipped ones were compared with each other and with publications
    quantity : the stress it is for, "normal" or "shear"
    allowances : what stands between a stress range and the range the curve is entered with
    damage_limit : the allowed damage sum on this curve; None: that of the mission
    checked_by, checked_on : who compared the numbers with the source, and when
    """

    name: str
    applies: Applies
    slopes: tuple[float, ...]
    knees_cycles: tuple[float, ...]
    reference_cycles: float
    reference_range: Mapping[str, float]
    source: str
    thickness_reference: float | None = None
    thickness_exponent: float = 0.0
    edition: str = ""
    clause: str = ""
    status: str = "user"
    quantity: Quantity = "normal"
    allowances: Allowances = NOTHING
    damage_limit: float | None = None
    checked_by: str = ""
    checked_on: str = ""

    @property
    def has_scatter(self) -> bool:
        """Whether survival levels can be told apart."""
        return TABULATED not in self.reference_range


@dataclass(frozen=True, slots=True, eq=False)
class DamageLaw:
    """Damage of one cycle as a function of its equivalent range x: ``d(x) = x**k / A`` between knees.

    Attributes
    ----------
    slopes : (s,) k of each segment, from large ranges to small ones
    log_constants : (s,) ln A of each segment
    knees : (s - 1,) equivalent range at which segment j ends and segment j + 1 begins, descending
    cutoff : equivalent range strictly below which a cycle does no damage; 0: every cycle damages
    """

    slopes: NDArray[np.float64]
    log_constants: NDArray[np.float64]
    knees: NDArray[np.float64]
    cutoff: float

    @property
    def is_straight(self) -> bool:
        """One slope for all cycles: damage then scales with load**k exactly."""
        return len(self.slopes) == 1 and self.cutoff == 0.0


def user_curve(
    name: str,
    slopes: tuple[float, ...],
    knees_cycles: tuple[float, ...],
    range_at_2e6: float,
    applies: Applies,
    source: str,
    log10_scatter: float | None = None,
    thickness_reference: float | None = None,
    thickness_exponent: float = 0.0,
    edition: str = "",
    clause: str = "",
    status: str = "user",
) -> SNCurve:
    """Describe a curve by its range at 2e6 cycles, as European classes are.

    With ``log10_scatter``, the standard deviation of log10 N, ``range_at_2e6`` [MPa] is the mean curve and the survival
    levels follow from it at constant slope; without, the curve has the one level its source gives it.
    """
    reference_cycles = 2e6
    k = slopes[_segment(knees_cycles, len(slopes), reference_cycles)]
    if log10_scatter is None:
        ranges = {TABULATED: range_at_2e6}
    else:
        ranges = {level: range_at_2e6 * 10 ** (-s * log10_scatter / k) for level, s in SIGMAS_BELOW_MEAN.items()}
    return SNCurve(
        name=name,
        applies=applies,
        slopes=slopes,
        knees_cycles=knees_cycles,
        reference_cycles=reference_cycles,
        reference_range=ranges,
        source=source,
        thickness_reference=thickness_reference,
        thickness_exponent=thickness_exponent,
        edition=edition,
        clause=clause,
        status=status,
    )


@cache
def catalogue() -> Mapping[str, SNCurve]:
    """Read the curves shipped with the program, each with edition, clause and source, from ``curves.toml``."""
    with (Path(__file__).parent / "curves.toml").open("rb") as file:
        tables = tomllib.load(file)
    return MappingProxyType({name: _shipped(name, table) for name, table in tables.items()})


def _shipped(name: str, table: Mapping[str, Any]) -> SNCurve:
    """Curve of a table of ``curves.toml``, of which the keys are those of ``[curves.<name>]`` in a case."""
    source = f"{table['source']}, edition {table['edition']}, {table['clause']}"
    if "C" in table:  # master curve, N = (C / dS)**(1 / h): C is the range at one cycle
        curve = SNCurve(
            name=name,
            applies="dS",
            slopes=(1.0 / table["h"],),
            knees_cycles=(),
            reference_cycles=1.0,
            reference_range=table["C"],
            source=source,
        )
    else:
        curve = user_curve(
            name=name,
            slopes=tuple(table["slopes"]),
            knees_cycles=tuple(table["knees_cycles"]),
            range_at_2e6=table["range_at_2e6_MPa"],
            applies=table.get("applies", "structural"),
            source=source,
            log10_scatter=table.get("log10_scatter"),
            thickness_reference=table.get("thickness_reference_mm"),
            thickness_exponent=table.get("thickness_exponent", 0.0),
        )
    return replace(
        curve,
        edition=table["edition"],
        clause=table["clause"],
        status=table.get("status", SHIPPED),
        quantity=table.get("quantity", "normal"),
        allowances=Allowances(**{ours: table[key] for key, ours in ALLOWANCE_KEYS.items() if key in table}),
        damage_limit=table.get("damage_limit"),
        checked_by=table.get("checked_by", ""),
        checked_on=table.get("checked_on", ""),
    )


def survival_level(curve: SNCurve, survival: Survival | None) -> str:
    """Name the survival level used: as asked; mean-2sigma, or the only one there is, when nothing is asked.

    Raises
    ------
    CaseError : a level is asked of a curve without scatter
    """
    if survival is None:
        return DEFAULT_SURVIVAL if curve.has_scatter else TABULATED
    if not curve.has_scatter:
        raise CaseError(
            Problem(
                "survival",
                "curve.survival",
                f"'{survival}' is asked of curve '{curve.name}', which has no scatter",
                "Give log10_scatter with the curve, or leave survival out to use the curve as tabulated",
            )
        )
    return survival


def damage_law(curve: SNCurve, survival: Survival | None, extension: Extension, knee_cycles: float) -> DamageLaw:
    """Turn a curve at one survival level, with its extension, into the damage of a cycle.

    Knees stay at their number of cycles and move in stress with the survival level. ``haibach`` continues below the
    stress at ``knee_cycles`` with slope 2 k - 1 (Haibach 1970); ``cutoff`` ends damage there. Cycles above that stress
    have the damage that they have without extension, on whichever side of the knee the reference cycles lie.

    Raises
    ------
    CaseError : survival level without scatter, or an extension of a curve that has its own knees
    """
    level = survival_level(curve, survival)
    law = _law_of(curve, level)
    if extension == "none":
        return law
    if curve.knees_cycles:
        raise CaseError(
            Problem(
                "extension",
                "curve.extension",
                f"'{extension}' is asked of curve '{curve.name}', which has its own knee at "
                f"{curve.knees_cycles[0]:g} cycles",
                'Set extension = "none", or give the curve without knees',
            )
        )
    (k,), (log_a,), log_knee = law.slopes, law.log_constants, np.log(knee_cycles)
    knee = np.exp((log_a - log_knee) / k)
    if extension == "cutoff":
        return DamageLaw(law.slopes, law.log_constants, law.knees, float(knee))
    k_below = 2.0 * k - 1.0
    log_a_below = log_knee + k_below * (log_a - log_knee) / k
    return DamageLaw(np.array([k, k_below]), np.array([log_a, log_a_below]), np.array([knee]), 0.0)


def _law_of(curve: SNCurve, level: str) -> DamageLaw:
    """Damage law of a curve as it is given: from the segment that holds the reference cycles to the others."""
    log_knees = np.log(np.asarray(curve.knees_cycles, dtype=np.float64))
    k = np.asarray(curve.slopes, dtype=np.float64)
    log_a = np.empty(len(k))
    reference = _segment(curve.knees_cycles, len(k), curve.reference_cycles)
    log_a[reference] = np.log(curve.reference_range[level] ** k[reference]) + np.log(curve.reference_cycles)
    for j in range(reference, len(k) - 1):  # continuity at each knee: ln A_j - k_j ln S = ln N_knee on both sides
        log_a[j + 1] = log_knees[j] + k[j + 1] * (log_a[j] - log_knees[j]) / k[j]
    for j in range(reference, 0, -1):
        log_a[j - 1] = log_knees[j - 1] + k[j - 1] * (log_a[j] - log_knees[j - 1]) / k[j]
    segment = np.arange(len(log_knees))
    knee_ranges = np.exp((log_a[segment] - log_knees) / k[segment])
    cutoff = float(knee_ranges[-1]) if len(log_knees) == len(k) else 0.0
    return DamageLaw(slopes=k, log_constants=log_a, knees=knee_ranges[: len(k) - 1], cutoff=cutoff)


def _segment(knees_cycles: tuple[float, ...], segments: int, cycles: float) -> int:
    """Index of the segment in which a number of cycles lies."""
    return min(sum(cycles > knee for knee in knees_cycles), segments - 1)
