"""The curves a case asks for."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from fatigue.case import load_case
from fatigue.errors import FatigueError
from fatigue.life.mission import Plan
from fatigue.pipeline.solve.body import Body, read_body
from fatigue.pipeline.solve.rated.rated_curves import AskedCurve, RatedCurve, curves_of_case, rated_curves
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


def test_scatter_makes_survival_levels(tmp_path):
    """With log10_scatter the user's curve is the mean and -2 sigma the default."""
    case = small_case()
    case.extra = OWN + "log10_scatter = 0.2\n"
    case.curve = {"name": "own"}
    rated = body_of(case, tmp_path).curves["own"]
    assert rated.survival == "mean-2sigma"
    assert rated.curve.has_scatter


THROAT = """
[curves.throat]
slopes = [3.0, 5.0]
knees_cycles = [1e7]
range_at_2e6_MPa = 36.0
applies = "throat"
source = "invented"

[curves.shear]
slopes = [5.0]
knees_cycles = [1e8]
range_at_2e6_MPa = 80.0
applies = "structural"
quantity = "shear"
source = "invented"
"""
PLAN = Plan((), target_km=1e6, km_per_year=1e5, damage_limit=0.8)


def own(folder: Path, keys: str, curve: dict[str, object] | None = None) -> RatedCurve:
    """The user's own curve with some more keys, as the case rates it."""
    case = small_case()
    case.curve = {"name": "own"} | (curve or {})
    case.extra = OWN + keys
    return body_of(case, folder).curves["own"]


def asked(folder: Path, one: AskedCurve, curve: dict[str, object] | None = None, extra: str = "") -> RatedCurve:
    """A curve that is asked for beside the toe, rated."""
    case = small_case()
    case.curve = {"name": "master-aluminium"} | (curve or {})
    case.extra = THROAT + extra
    read = load_case(case.write(folder))
    return rated_curves(read, curves_of_case(read), [one])[one.name]


@pytest.mark.parametrize(
    ("one", "message"),
    [
        (
            AskedCurve("throat", "here"),
            "here: curve 'throat' is for the stress in the throat (applies = 'throat'), not for the structural stress",
        ),
        (
            AskedCurve("iiw-steel-90", "here", "throat"),
            "(applies = 'structural'), not for the stress in the throat. Name a curve with applies = 'throat'.",
        ),
        (
            AskedCurve("iiw-steel-90", "here", "nominal"),
            "not for a nominal stress. Name a curve with applies = 'nominal'",
        ),
        (
            AskedCurve("master-steel", "here", "hot_spot"),
            "not for a hot-spot stress. Name a curve with applies = 'hot_",
        ),
        (AskedCurve("master-steel", "here", "parent"), "not for the stress in the parent metal"),
        (
            AskedCurve("shear", "here"),
            "the structural stress at the toe is asked for its normal stress. Name a curve with quantity = 'normal'.",
        ),
        (
            AskedCurve("iiw-steel-90", "here", quantity="shear"),
            "is for normal stress (quantity = 'normal'), and",
        ),
    ],
)
def test_a_curve_of_another_stress_is_refused(tmp_path: Path, one: AskedCurve, message: str) -> None:
    """The curve, the place, what it is for, and the remedy."""
    with pytest.raises(FatigueError) as refusal:
        asked(tmp_path, one)
    assert message in str(refusal.value)


@pytest.mark.parametrize(
    "one",
    [
        AskedCurve("iiw-steel-90", "here", "hot_spot"),  # the one pair of names that fits
        AskedCurve("iiw-steel-90", "here"),
        AskedCurve("master-steel", "here", "root"),
        AskedCurve("throat", "here", "root"),
        AskedCurve("throat", "here", "throat"),
        AskedCurve("shear", "here", quantity="shear"),
    ],
)
def test_a_curve_of_the_same_stress_is_rated(tmp_path: Path, one: AskedCurve) -> None:
    """Structural stress is a hot-spot stress, and the master curve may serve the root of a weld."""
    assert asked(tmp_path, one).curve.name == one.name


BENDS = 'bending_factor = "bs7608"\nbending_reference_mm = 25.0\nbending_exponent = 0.25\n'


def test_an_allowance_for_bending_needs_a_bending_ratio(tmp_path: Path) -> None:
    """The stress in a throat has none; that at a hot spot has."""
    bent = OWN.replace('"structural"', '"throat"') + BENDS
    with pytest.raises(FatigueError, match="no bending ratio of a cycle is known of the stress in the throat"):
        asked(tmp_path / "throat", AskedCurve("own", "here", "throat"), extra=bent)
    at_hot_spot = asked(tmp_path / "spot", AskedCurve("own", "here", "hot_spot"), extra=OWN + BENDS)
    assert at_hot_spot.rule.depends_on_bending


def test_settings_of_the_toe_do_not_refuse_a_curve_of_another_check(tmp_path: Path) -> None:
    """A curve without scatter, or with knees, is taken as it is given where it does not serve a toe."""
    settings = {"survival": "mean-3sigma", "extension": "haibach", "mean_stress": "asme", "yield_MPa": 200.0}
    of_throat = asked(tmp_path, AskedCurve("throat", "here", "throat"), settings)
    assert of_throat.survival == "as tabulated"
    assert of_throat.rule.law.slopes.tolist() == [3.0, 5.0]
    assert (of_throat.rule.yield_MPa, of_throat.rule.mean_stress) == (None, False)
    of_shear = asked(tmp_path, AskedCurve("shear", "here", quantity="shear"), settings)
    assert of_shear.rule.law.cutoff == pytest.approx(36.5844041542, rel=1e-11)


def test_a_level_and_an_extension_hold_where_the_curve_has_a_place_for_them(tmp_path: Path) -> None:
    """A throat curve with scatter and without knees takes both."""
    extra = THROAT.partition("[curves.shear]")[0].replace("throat]", "own]").replace("[3.0, 5.0]", "[3.0]")
    extra = extra.replace("knees_cycles = [1e7]", "log10_scatter = 0.2")
    rated = asked(
        tmp_path, AskedCurve("own", "here", "throat"), {"survival": "mean-3sigma", "extension": "haibach"}, extra
    )
    assert rated.survival == "mean-3sigma"
    assert rated.rule.law.slopes.tolist() == [3.0, 5.0]


def test_partial_factors_are_on_the_range(tmp_path: Path) -> None:
    """Their product is a factor on the size; on damage it works with the power of the slope."""
    rated = own(tmp_path, "gamma_Ff = 1.1\ngamma_Mf = 1.35\n")
    assert rated.size(np.array([10.0, 40.0])).tolist() == pytest.approx([1.485, 1.485], rel=1e-15)
    assert own(tmp_path, "").size(np.array([10.0])).tolist() == [1.0]


def test_a_damage_limit_of_the_curve_is_that_of_its_welds(tmp_path: Path) -> None:
    """Left out it is that of the mission."""
    assert own(tmp_path, "damage_limit = 0.5\n").plan(PLAN).damage_limit == 0.5
    assert own(tmp_path, "").plan(PLAN) is PLAN


@pytest.mark.parametrize(
    ("keys", "curve", "message"),
    [
        (
            'mean_stress = "iiw_low"\n',
            {"mean_stress": "asme", "yield_MPa": 200.0},
            "mean_stress = 'asme' belongs to the master curve and does not apply to curve 'own'",
        ),
        (
            'bending_factor = "bs7608"\n',
            {},
            "curves.own.bending_reference_mm: the key is missing although bending_factor = 'bs7608' is given",
        ),
        ("bending_exponent = 0.25\n", {}, "0.25 is given without bending_factor. Add bending_factor = 'bs7608'"),
        ("gamma_Mf = 0.0\n", {}, "curves.own.gamma_Mf: 0.0 should be greater than 0"),
        ('thickness_effective = "L_half"\n', {}, "of its welds (A, B) have no length of their attachment"),
    ],
)
def test_allowances_that_lack_something_are_refused(
    tmp_path: Path, keys: str, curve: dict[str, object], message: str
) -> None:
    """Place, value and remedy."""
    with pytest.raises(FatigueError) as refusal:
        own(tmp_path, keys, curve)
    assert message in str(refusal.value)


def test_two_rules_for_the_mean_stress_are_refused(tmp_path: Path) -> None:
    """f(R) of the curve and f_M of the case, on a curve in dS, which has a place for both."""
    curve: dict[str, object] = {"mean_stress": "asme", "yield_MPa": 200.0}
    case = small_case()
    case.curve = {"name": "own"} | curve
    case.extra = OWN.replace('"structural"', '"dS"') + 'mean_stress = "iiw_medium"\n'
    with pytest.raises(FatigueError, match="Take one of them: they are two rules for the same effect"):
        body_of(case, tmp_path)
    case.curve = {"name": "own", "yield_MPa": 200.0}  # not even shown beside f(R)
    assert body_of(case, tmp_path).curves["own"].rule.yield_MPa is None


def test_half_the_length_of_an_attachment_is_its_thickness(tmp_path: Path) -> None:
    """Where that is at most the plate; each weld by its own length."""
    case = small_case()
    case.curve = {"name": "own"}
    keys = 'thickness_reference_mm = 5.0\nthickness_exponent = 0.3\nthickness_effective = "L_half"\n'
    case.extra, case.welds["attachment_mm"] = OWN + keys, [12.0, 40.0]
    body = body_of(case, tmp_path)
    assert [weld.attachment for weld in body.welds] == [12.0, 40.0]
    size = body.curves["own"].size(np.array([8.0, 8.0]), np.array([12.0, 40.0]))
    np.testing.assert_allclose(size, [(6 / 5) ** 0.3, (8 / 5) ** 0.3], rtol=1e-15)
    short, long = (body.curve_of(weld) for weld in body.welds)
    np.testing.assert_allclose([short.size(np.array([8.0])), long.size(np.array([8.0]))], size[:, None], rtol=1e-15)
    assert (short.size_exponent(8.0), long.size_exponent(8.0)) == (0.0, 0.3)


def test_a_thin_plate_on_a_curve_with_an_allowance_for_bending_is_told(tmp_path: Path) -> None:
    """Below its reference thickness the allowance makes a plate stronger than its curve: 8 mm under 25 mm, 1.33."""
    case = small_case()
    case.curve = {"name": "own"}
    case.extra = OWN + 'bending_factor = "bs7608"\nbending_reference_mm = 25.0\nbending_exponent = 0.25\n'
    body = body_of(case, tmp_path)
    (warning,) = [one for one in body.warnings if one.code == "thin_for_bending"]
    assert "by up to 1.33 for the thickness: A (8 mm), B (8 mm)" in warning.what
    assert body.curves["own"].size(np.array([50.0])) == pytest.approx([2.0**0.25])
    assert body.curves["own"].size_exponent(50.0) == 0.25


def factors(folder: Path, rows: list[dict[str, object]], extra: str = OWN) -> Body:
    """The small body with a table of strength factors."""
    case = small_case()
    case.curve = {"name": "own"}
    case.extra = '[checks]\nstrength_factors = "factors.csv"\n' + extra
    folder.mkdir(exist_ok=True)
    pd.DataFrame(rows).to_csv(folder / "factors.csv", index=False)
    return body_of(case, folder)


def a_factor(**changed: object) -> dict[str, object]:
    """A row of a table of strength factors."""
    row = {"curve": "own", "factor": "quality", "role": "strength", "value": 0.8, "clause": "7.3", "edition": "2025"}
    return row | changed


def test_factors_of_a_table_are_on_range_and_limit(tmp_path: Path) -> None:
    """Stress roles multiply the range, strength roles divide it, a limit multiplies the damage limit."""
    rows = [
        a_factor(),
        a_factor(factor="inspection", value=1.25, role="stress", note="as agreed"),
        a_factor(factor="damage", role="limit", value=0.5),
        a_factor(curve="iiw-steel-90", factor="other", value=3.0),
    ]
    rated = factors(tmp_path, rows).curves["own"]
    assert rated.size(np.array([10.0])).tolist() == pytest.approx([1.25 / 0.8])
    assert rated.plan(PLAN).damage_limit == 0.4
    assert [(one.factor, one.clause, one.note) for one in rated.factors][1] == ("inspection", "7.3", "as agreed")


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"value": None}, "factors.csv: column value, row 1: the value is missing or NaN"),
        ({"clause": None}, "factors.csv: column clause, row 1: the text is missing"),
        ({"edition": None}, "factors.csv: column edition, row 1: the text is missing"),
        ({"role": "weakness"}, "factors.csv: column role, row 1:"),
        ({"value": 0.0}, "factors.csv: column value, row 1: 0 is not above 0"),
        ({"curve": "wno"}, "'wno'"),
    ],
)
def test_a_bad_table_of_factors_is_refused(tmp_path: Path, changed: dict[str, object], message: str) -> None:
    """File, column, row, value."""
    with pytest.raises(FatigueError) as refusal:
        factors(tmp_path, [a_factor(**changed), a_factor(factor="other")])
    assert message in str(refusal.value)


def test_a_factor_is_given_once_for_a_curve(tmp_path: Path) -> None:
    """Twice the same name would be a product nobody meant."""
    with pytest.raises(FatigueError, match="curve own, factor quality repeats row 1"):
        factors(tmp_path, [a_factor(), a_factor(value=0.9)])


def test_a_cut_off_beside_factors_is_told(tmp_path: Path) -> None:
    """EN 17149-3 knows no endurance limit; without factors a cut-off is silent."""
    with_cutoff = OWN.replace("knees_cycles = [1e7]", "knees_cycles = [5e6, 1e8]")
    (warning,) = [one for one in factors(tmp_path, [a_factor()], with_cutoff).warnings if "cutoff" in one.code]
    assert "'own' have" not in warning.what
    assert "EN 17149-3" in warning.what
    assert not [one for one in factors(tmp_path, [a_factor()]).warnings if "cutoff" in one.code]
