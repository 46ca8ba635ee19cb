"""What is doubtful about the curves of a case: told once for each kind, with the curves and welds it is about."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from fatigue.case import Case
from fatigue.errors import Problem
from fatigue.life.allowances import bending_thickness
from fatigue.pipeline.solve.rated.rated_curves import RatedCurve
from fatigue.readers.neutral.body.welds import Weld
from fatigue.shown import few
from fatigue.weld.line import LineStack


def unverified_problems(case: Case, welds: Sequence[Weld], curves: Mapping[str, RatedCurve]) -> Iterator[Problem]:
    """Refusals of curves in use whose numbers nobody has compared with their source."""
    of_toes = {weld.curve or case.curve.name for weld in welds}
    for name, rated in curves.items():
        if rated.is_unverified and (name in of_toes or name != case.curve.name):
            what = f"curve '{name}' is unverified: nobody has compared its numbers with their source"
            remedy = f"Compare them and set status and checked_by under [curves.{name}], or take another curve"
            yield Problem("not_verified", case.path.name, what, remedy)


def unverified_warnings(case: Case, welds: Sequence[Weld], curves: Mapping[str, RatedCurve]) -> list[Problem]:
    """One warning that names the unverified curves in use, and how many welds have their lives from them."""
    found = [name for name, rated in curves.items() if rated.is_unverified]
    of_toes = [weld.name for weld in welds if (weld.curve or case.curve.name) in found]
    found = [name for name in found if of_toes or name != case.curve.name]
    if not found:
        return []
    what = f"{few([repr(name) for name in found])}: numbers that nobody has compared with their source; the lives of "
    what += f"{len(of_toes)} of {len(welds)} welds rest on them"
    remedy = "Compare them with your copy of the edition, then say so by status and checked_by under [curves]"
    return [Problem("unverified_curve", f"{case.path.name}: curves", what, remedy, len(found))]


def cutoff_warnings(case: Case, curves: Mapping[str, RatedCurve]) -> list[Problem]:
    """A curve with a cut-off beside a table of factors: EN 17149-3 knows no endurance limit."""
    some = [f"'{name}'" for name, rated in curves.items() if rated.factors and rated.rule.law.cutoff > 0.0]
    if not some:
        return []
    what = f"{len(some)} of the curves ({few(some)}) have factors of this table and a cut-off, below which nothing "
    what += "damages; EN 17149-3, whose factors such a table holds, knows no endurance limit"
    remedy = "Give the curve one knee less than slopes, so that the last slope goes on"
    where = f"{case.checks.strength_factors}: column curve"
    return [Problem("cutoff_with_factors", where, what, remedy, len(some))]


def thin_plate_warnings(lines: LineStack, rated: Sequence[RatedCurve], file: str) -> list[Problem]:
    """Plates thinner than the reference of an allowance for bending, which then makes stronger than its curve.

    ``rated`` are the curves of the lines, one each.
    """
    least = np.minimum.reduceat(lines.thickness, lines.begin[:-1])
    gain = np.array([bending_thickness(t, one.curve.allowances) for t, one in zip(least, rated, strict=True)])
    thin = np.flatnonzero(gain < 1.0)
    if not thin.size:
        return []
    thin = thin[np.argsort(gain[thin], kind="stable")]
    shown = few([f"{lines.weld[i]} ({least[i]:g} mm)" for i in thin])
    what = "plates are thinner than bending_reference_mm of their curve, and bending_factor divides "
    what += f"ranges there by up to {1.0 / gain[thin[0]]:.3g} for the thickness: {shown}"
    remedy = "Check that the edition allows it below its reference thickness, or give bending_exponent = 0"
    return [Problem("thin_for_bending", f"{file}: column thickness_mm", what, remedy, int(thin.size))]
