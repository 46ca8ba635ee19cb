"""The exponent of pseudo-damage: as asked, or of the curve of the case; and where it is from."""

from collections.abc import Iterator
from numbers import Real

from fatigue.case import Case
from fatigue.errors import Problem
from fatigue.pipeline.solve.rated.known_curves import curves_of_case

STEEPEST = 50.0  # beyond any S-N curve: ranges in ue to this power are still numbers


def exponent_of(case: Case, asked: float | None = None) -> tuple[float, str]:
    """Exponent k of the pseudo-damage, and where it is from."""
    if asked is not None:
        return float(asked), "as asked"
    curve = curves_of_case(case)[case.curve.name]
    is_master = curve.applies == "dS" and len(curve.slopes) == 1
    return float(curve.slopes[0]), f"{'1/h' if is_master else 'first slope'} of curve '{curve.name}'"


def exponent_problems(asked: float | None) -> Iterator[Problem]:
    """What is wrong with an exponent that is asked for."""
    if asked is not None and not (isinstance(asked, Real) and 0.0 < asked <= STEEPEST):
        what = f"{asked!r} is no exponent of an S-N curve"
        yield Problem("bad_exponents", "exponent", what, f"Give a number above 0 and up to {STEEPEST:g}, such as 3.6")
