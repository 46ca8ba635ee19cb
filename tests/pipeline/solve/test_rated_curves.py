"""The curves a case asks for."""

import pytest

from fatigue.case import load_case
from fatigue.errors import FatigueError
from fatigue.pipeline.solve.body import read_body
from tests.small_case import small_case

OWN = """
[curves.own]
slopes = [3.0, 5.0]
knees_cycles = [1e7]
range_at_2e6_MPa = 40.0
applies = "structural"
source = "test report 7, table 2"
"""


def body_of(case, folder):
    """Read the small files of a case."""
    return read_body(load_case(case.write(folder)), strict=False)


def test_welds_may_have_curves_of_their_own(tmp_path):
    """The weld's key overrides the case; each curve keeps its own survival level."""
    case = small_case()
    case.welds["curve"] = [None, "own"]
    case.extra = OWN
    body = body_of(case, tmp_path)
    assert [body.curve_of(w).curve.name for w in body.welds] == ["master-aluminium", "own"]
    assert body.curves["master-aluminium"].survival == "mean-2sigma"
    assert body.curves["own"].survival == "as tabulated"
    assert body.curves["own"].rule.law.slopes.tolist() == [3.0, 5.0]


@pytest.mark.parametrize(
    ("curve", "weld_curve", "message"),
    [
        ({"name": "own", "survival": "mean"}, None, "'mean' is asked of curve 'own', which has no scatter"),
        ({"name": "own", "extension": "haibach"}, None, "which has its own knee at 1e+07 cycles"),
        (
            {"name": "master-steel", "mean_stress": "asme", "yield_MPa": 200.0},
            "own",
            "mean_stress = 'asme' belongs to the master curve and does not apply to curve 'own'",
        ),
        ({"name": "master-steel"}, "nobody", "nobody"),
        ({"name": "nobody"}, None, "nobody"),
    ],
)
def test_what_does_not_fit_is_refused(tmp_path, curve, weld_curve, message):
    """The curve, the place and the remedy."""
    case = small_case()
    case.curve = curve
    case.welds["curve"] = weld_curve
    case.extra = OWN
    with pytest.raises(FatigueError) as error:
        body_of(case, tmp_path)
    assert message in str(error.value)


def test_a_catalogue_curve_cannot_be_redefined(tmp_path):
    """The same key must mean the same curve in every report."""
    case = small_case()
    case.extra = OWN.replace("own", "master-steel")
    with pytest.raises(FatigueError, match="master-steel"):
        body_of(case, tmp_path)


def test_scatter_makes_survival_levels(tmp_path):
    """With log10_scatter the user's curve is the mean and -2 sigma the default."""
    case = small_case()
    case.extra = OWN + "log10_scatter = 0.2\n"
    case.curve = {"name": "own"}
    rated = body_of(case, tmp_path).curves["own"]
    assert rated.survival == "mean-2sigma"
    assert rated.curve.has_scatter
