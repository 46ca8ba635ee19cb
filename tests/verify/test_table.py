"""The verification table: every known value is met, and a value that is not would be seen."""

import json
from dataclasses import replace

import numpy as np
import pytest

from fatigue.results import json_ready
from fatigue.verify.check import Check, VerificationTable
from fatigue.verify.table import verification_table

CHECK = Check("topic", "case", "stress", "MPa", expected=10.0, found=10.0, tolerance=1e-6, source="by hand")


@pytest.fixture(scope="module")
def table() -> VerificationTable:
    """Compute the table once."""
    return verification_table()


def test_every_known_value_is_met(table):
    """All checks pass on this machine."""
    assert table.passed, [check for check in table.checks if not check.passed]


def test_the_table_covers_the_whole_computation(table):
    """Each stage from line loads to the mission has its checks, each with a source, and no case is there twice."""
    topics = ["line load", "weld end", "structural stress", "master curve", "curves", "rainflow", "spectrum", "mission"]
    assert list(dict.fromkeys(check.topic for check in table.checks)) == topics
    assert all(check.source for check in table.checks)
    keys = [(check.topic, check.case, check.quantity) for check in table.checks]
    assert len(set(keys)) == len(keys) > 80


@pytest.mark.parametrize(
    ("expected", "found", "tolerance", "passed"),
    [
        (10.0, 10.00001, 1e-6, True),
        (10.0, 10.00002, 1e-6, False),
        (-10.0, 10.0, 1e-6, False),
        (0.0, 1e-7, 1e-6, True),
        (0.0, 2e-6, 1e-6, False),
        (10.0, np.nan, 1e-6, False),
        (10.0, np.inf, 1e-6, False),
    ],
)
def test_a_check_compares_relatively_or_absolutely_at_zero(expected, found, tolerance, passed):
    """The tolerance is relative, absolute where 0 is expected; what is no number never passes."""
    assert replace(CHECK, expected=expected, found=found, tolerance=tolerance).passed is passed


def test_the_text_tells_what_is_wrong():
    """One line for each check with unit and values, and the verdict below."""
    good = VerificationTable((CHECK,))
    assert good.passed
    assert good.as_text().splitlines()[-1] == "all 1 checks passed"
    bad = VerificationTable((CHECK, replace(CHECK, found=10.5)))
    assert not bad.passed
    heading, right, wrong, _, verdict = bad.as_text().splitlines()
    assert heading.split() == ["topic", "case", "quantity", "expected", "found", "difference", "allowed"]
    assert right.endswith("ok")
    assert wrong.split() == ["topic", "case", "stress", "10", "MPa", "10.5", "5.0e-02", "1e-06", "WRONG"]
    assert verdict == "1 of 2 checks FAILED"


def test_the_record_is_for_machines(table):
    """Every check is a record with its difference and result, and JSON can say it."""
    record = json.loads(json.dumps(json_ready(table.as_record()), allow_nan=False))
    assert record["passed"] is True
    assert len(record["checks"]) == len(table.checks)
    first = table.checks[0]
    assert record["checks"][0] == {
        "topic": first.topic,
        "case": first.case,
        "quantity": first.quantity,
        "unit": first.unit,
        "expected": first.expected,
        "found": first.found,
        "tolerance": first.tolerance,
        "source": first.source,
        "difference": first.difference,
        "passed": True,
    }
