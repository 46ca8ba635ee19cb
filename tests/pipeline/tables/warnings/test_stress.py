"""Stress ranges beyond any metal, and next to nothing: told with point, event, instants and mode, refused never."""

import pytest

from fatigue.assess import assess
from tests.small_case import small_case

NEW = {"stress_beyond_metal", "hardly_any_stress"}


def warnings_of(tmp_path, change, **options):
    """Tell the warnings about stress ranges of an assessed small case in which something is changed."""
    case = small_case()
    change(case)
    done = assess(case.write(tmp_path / "case"), tmp_path / "out", threads=1, report=False, **options)
    return [warning for warning in done.warnings if warning.code in NEW]


def forces_times(factor):
    """Change that multiplies all forces."""

    def change(case):
        columns = [name for name in case.nodal_forces if name[0] in "fm" and name != "mode"]
        case.nodal_forces[columns] *= factor

    return change


def test_usual_stress_is_silent(tmp_path):
    """Ranges of 100 MPa."""
    assert warnings_of(tmp_path, lambda case: None) == []


def test_forces_a_thousand_times_too_large(tmp_path):
    """The worst point, its event, two instants and the mode that makes most of it; the units as remedy."""
    (problem,) = warnings_of(tmp_path, forces_times(1000.0))
    assert problem.code == "stress_beyond_metal"
    assert problem.where == "weld B"
    assert problem.count == 28
    assert (
        "no metal bears 3000: node 200, top face, event 'noise', from 8.095 s to 3.33 s, mode 1 makes" in problem.what
    )
    assert problem.remedy.startswith("Check the units")


@pytest.mark.parametrize("value", [-1e5, 1e30, 1e60])
def test_one_damaged_sample(tmp_path, value):
    """The sample is told with its instant and its column, however large it is; numpy warns of nothing."""

    def change(case):
        case.histories["noise"].loc[777, "q_2"] = value

    (problem,) = warnings_of(tmp_path, change)
    assert "mode 2 makes 100% of it" in problem.what
    assert "the sample at 3.885 s stands alone" in problem.what
    assert "q_2 there in noise.csv" in problem.remedy


def test_a_screened_point_is_not_judged_by_its_bound(tmp_path):
    """What was counted is told also where most points are settled by bounds."""
    (problem,) = warnings_of(tmp_path, forces_times(1000.0), share=0.1)
    assert "node 200" in problem.what


def test_forces_ten_thousand_times_too_small(tmp_path):
    """A body without any stress to speak of is told as well."""
    (problem,) = warnings_of(tmp_path, forces_times(1e-4))
    assert problem.code == "hardly_any_stress"
    assert "above 0.011 MPa" in problem.what
