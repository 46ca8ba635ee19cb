"""Checks that are to decide, and that nothing makes."""

import pytest

from fatigue.check import check_case
from fatigue.errors import FatigueError
from tests.checks_case import write_checks_case


def test_a_check_that_counts_has_a_point(tmp_path):
    """A kind of stress point that counts and that the table lacks is refused with place and remedy."""
    path = write_checks_case(tmp_path)
    text = path.read_text().replace('counts = ["throat_perp"]', 'counts = ["hot_spot", "nominal"]')
    path.write_text(text)
    with pytest.raises(FatigueError) as refused:
        check_case(path)
    (problem,) = refused.value.problems
    assert str(problem) == (
        "case.toml: checks.counts: 'nominal' is to decide, but stress_points.csv has no point of kind nominal. "
        "Add such a point, or remove 'nominal'."
    )
