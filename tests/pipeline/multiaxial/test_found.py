"""Verdicts by what is known of a point."""

import numpy as np
import pytest

from fatigue.pipeline.multiaxial.found import NULL, STATUSES, VERDICTS, nothing_found, verdicts

CASES = [  # status, sums by range, length, mlp and ASME, and the verdict
    ("counted", 0.9, 0.95, np.nan, 1.0, "passes"),
    ("counted", 1.0, 1.0, 1.0, 1.0, "passes"),
    ("counted", 0.9, 1.1, np.nan, 0.9, "model_dependent"),
    ("counted", 0.9, 0.95, 1.1, 0.9, "model_dependent"),
    ("counted", 0.9, 0.95, np.nan, 1.1, "model_dependent"),
    ("counted", 1.1, 1.2, np.nan, 0.9, "fails"),
    ("fails", 1.1, 1.2, np.nan, 0.9, "fails"),
    ("fails", np.nan, np.nan, np.nan, 0.9, "fails"),
    ("settled_passes", np.nan, np.nan, np.nan, 0.9, "settled_passes"),
    ("settled_passes", 0.5, 0.6, np.nan, 0.9, "passes"),
    ("settled_passes", 0.5, 1.6, np.nan, 0.9, "model_dependent"),
    ("settled_fails", np.nan, np.nan, np.nan, 1.3, "settled_fails"),
    ("settled_fails", 0.99, 1.2, np.nan, 1.3, "settled_fails"),
]


@pytest.mark.parametrize("case", CASES)
def test_verdict(case):
    """Numbers where there are some, else what settled the point; what fails by normal stress stays failed."""
    status, *sums, verdict = case
    found = nothing_found((1, 2))
    found["status"] = STATUSES.index(status)
    for name, value in zip(("range", "length", "mlp", "asme"), sums, strict=True):
        found[name] = value
    assert [VERDICTS[code] for code in verdicts(found).ravel()] == [verdict] * 2


def test_nothing_is_known_of_a_point_that_nobody_looked_at():
    """No status, no verdict, no number."""
    found = nothing_found((3,))
    assert (verdicts(found) == NULL).all()
    assert (found["shear_required"] == NULL).all()
    assert all(np.isnan(found[name]).all() for name in ("bound", "range", "length", "mlp", "asme", "normal"))
