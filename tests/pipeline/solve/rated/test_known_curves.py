"""Curves of the catalogue, as they are and as a case changes them."""

from pathlib import Path

import pytest

from fatigue.case import load_case
from fatigue.errors import FatigueError
from fatigue.life.curves import SNCurve, catalogue
from fatigue.pipeline.solve.rated.known_curves import curves_of_case
from tests.small_case import small_case


def changed(folder: Path, name: str, keys: str) -> SNCurve:
    """A curve of the catalogue with some keys of a case."""
    case = small_case()
    case.extra = f"[curves.{name}]\n{keys}\n"
    return curves_of_case(load_case(case.write(folder)))[name]


def test_what_the_catalogue_rests_on() -> None:
    """Curves for toes were compared with each other; those for throats are recalled and marked."""
    by_use = {applies: {c.status for c in catalogue().values() if c.applies == applies} for applies in ("dS", "throat")}
    assert by_use == {"dS": {"cross-checked"}, "throat": {"unverified"}}
    assert {c.status for c in catalogue().values() if c.applies == "structural"} == {"cross-checked"}


def test_factors_do_not_verify_a_curve(tmp_path: Path) -> None:
    """A partial factor leaves the word where it is; another line is the user's."""
    assert changed(tmp_path / "a", "iiw-throat-steel-36", "gamma_Mf = 1.25").status == "unverified"
    assert changed(tmp_path / "b", "iiw-throat-steel-36", "range_at_2e6_MPa = 30.0").status == "user"


@pytest.mark.parametrize(
    ("name", "keys"),
    [
        ("iiw-steel-90", "range_at_2e6_MPa = 80.0"),
        ("iiw-steel-90", "slopes = [3.0, 22.0]"),
        ("iiw-steel-90", "knees_cycles = [1e7, 1e9]"),
        ("iiw-steel-90", "thickness_reference_mm = 25.0\nthickness_exponent = 0.2"),
        ("iiw-steel-90", "gamma_Mf = 1.15"),
        ("iiw-steel-90", "damage_limit = 0.5"),
        ("iiw-steel-90", 'mean_stress = "iiw_low"'),
        ("master-steel", "gamma_Mf = 1.15"),
        ("master-steel", 'slopes = [3.2]\nrange_at_2e6_MPa = 150.0\nlog10_scatter = 0.2\nsource = "mine"'),
    ],
)
def test_any_other_number_makes_it_the_users(tmp_path: Path, name: str, keys: str) -> None:
    """What is not given stays that of the catalogue."""
    curve, shipped = changed(tmp_path, name, keys), catalogue()[name]
    assert curve.status == "user"
    assert curve != shipped
    assert curve.applies == shipped.applies
    assert curve.edition == shipped.edition


def test_what_is_not_given_stays(tmp_path: Path) -> None:
    """The line of a master curve to the last bit, the class of the others."""
    curve, shipped = changed(tmp_path, "master-steel", "gamma_Mf = 1.15"), catalogue()["master-steel"]
    assert (curve.slopes, curve.reference_range) == (shipped.slopes, shipped.reference_range)
    curve = changed(tmp_path, "iiw-steel-90", "slopes = [3.0, 22.0]")
    assert curve.slopes == (3.0, 22.0)
    assert curve.knees_cycles == (1e7,)
    assert dict(curve.reference_range) == {"as tabulated": 90.0}
    assert curve.thickness_exponent == 0.3


def test_the_same_numbers_stay_cross_checked(tmp_path: Path) -> None:
    """Repeating them changes nothing; a user who compared them with his copy may say so."""
    same = "range_at_2e6_MPa = 90.0\nslopes = [3.0, 5.0]\nknees_cycles = [1e7]\n"
    assert changed(tmp_path, "iiw-steel-90", same).status == "cross-checked"
    seen = changed(tmp_path, "iiw-steel-90", 'status = "verified"\nchecked_by = "AB"\nchecked_on = "2026-05-31"\n')
    assert (seen.status, seen.checked_by, seen.checked_on) == ("verified", "AB", "2026-05-31")


def test_another_number_stays_unverified_where_the_case_says_so(tmp_path: Path) -> None:
    """The weaker word of the two."""
    assert changed(tmp_path, "iiw-steel-90", 'range_at_2e6_MPa = 80.0\nstatus = "unverified"').status == "unverified"


@pytest.mark.parametrize(
    ("name", "keys", "message"),
    [
        (
            "iiw-steel-90",
            'gamma_Mf = 1.1\nstatus = "verified"',
            "of which a number is changed. Give the curve another name",
        ),
        ("iiw-steel-90", "slopes = [3.0, 5.0, 9.0]", "1 knees do not go with 3 slopes; the catalogue gives what"),
        ("master-steel", "slopes = [3.0]", "slopes of a curve of the catalogue that has no range at 2e6 cycles"),
        ("master-steel", 'quantity = "shear"', "'shear' is given for a curve in dS"),
        (
            "master-steel",
            'bending_factor = "bs7608"\nbending_reference_mm = 25.0\nbending_exponent = 0.25',
            "which has I(r) of the bending ratio already",
        ),
    ],
)
def test_what_makes_no_curve_is_refused(tmp_path: Path, name: str, keys: str, message: str) -> None:
    """With the place and the remedy."""
    with pytest.raises(FatigueError) as refusal:
        changed(tmp_path, name, keys)
    assert message in str(refusal.value)
    assert f"case.toml: curves.{name}" in str(refusal.value)
