"""Stress categories are data; classes are known however they are spelt."""

import numpy as np
import pytest

from fatigue.life.quality import StressCategories, is_known_class, known_classes, shipped_categories


def test_limits_belong_to_the_category_above():
    """Low below 0.75, medium from 0.75, high from 0.9 on, whatever is infinite is high, nothing is nothing."""
    values = np.array([0.0, np.nextafter(0.75, 0), 0.75, np.nextafter(0.9, 0), 0.9, 5.0, np.inf, np.nan])
    wanted = ["low", "low", "medium", "medium", "high", "high", "high", None]
    assert shipped_categories().of(values) == wanted
    assert str(shipped_categories()) == "low < 0.75 <= medium < 0.9 <= high"


def test_shipped_limits_say_that_they_are_recalled():
    """Whoever reads them sees that the edition was not seen."""
    categories = shipped_categories()
    assert categories.status == "unverified"
    assert "not seen" in categories.source


def test_other_limits():
    """A user's own limits take their place."""
    own = StressCategories(("low", "medium", "high"), (0.5, 0.6), "house rule", "user")
    assert own.of(np.array([0.55, 0.6])) == ["medium", "high"]


@pytest.mark.parametrize("column", ["performance_class", "inspection_class"])
def test_every_known_class_is_known_in_any_spelling(column):
    """With and without prefix, blanks, hyphens and capitals."""
    for name in known_classes(column):
        for spelt in (name, name.lower(), name.replace(" ", ""), name.replace(" ", "-"), name[3:]):
            assert is_known_class(column, spelt)


@pytest.mark.parametrize("given", ["CP E", "CPD1", "CT 5", "0", "CP", "medium"])
def test_others_are_not_known(given):
    """Classes there are not, and those of the other kind."""
    assert not is_known_class("performance_class", given)
    assert not is_known_class("inspection_class", given)
