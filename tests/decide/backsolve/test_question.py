"""What may be asked, and what not."""

import pytest

from fatigue.decide.backsolve.question import question
from fatigue.errors import CaseError

EVENTS = [{"event": "a", "share": 0.7}, {"event": "b", "share": 0.3}, {"event": "n", "share": None}]
RECORD = {"mission": {"target_km": 1.2e7, "km_per_year": 5e5, "events": EVENTS}}


def test_targets():
    """That of the case, km, or years at its mileage."""
    assert question("load", None, RECORD).years == 24.0
    assert question("load", "6e6", RECORD).target_km == 6e6
    assert question("load", 6e6, RECORD).years == 12.0
    assert question("share:a", "30 years", RECORD).target_km == 1.5e7
    assert question("share:a", None, RECORD).name == "share:a"


@pytest.mark.parametrize(
    ("asked", "target", "words"),
    [
        ("mass", None, "nothing is solved for 'mass'. Give load, curve"),
        ("share", None, "nothing is solved for 'share'"),
        ("share:c", None, "the mission has no event 'c'. Give share: and one of 'a', 'b'"),
        ("share:n", None, "'n' is counted by number and has no share of the mileage"),
        ("load", "0", "'0' is no target above 0"),
        ("load", "nan", "is no target above 0"),
        ("load", "-3 years", "is no target above 0"),
        ("load", "soon", "is no target above 0. Give km, as 1.5e7, or years, as '30 years'"),
    ],
)
def test_mistakes(asked, target, words):
    """One line each."""
    with pytest.raises(CaseError) as refused:
        question(asked, target, RECORD)
    assert words in str(refused.value)


def test_only_event():
    """Without others nobody can take the rest."""
    record = {"mission": RECORD["mission"] | {"events": [{"event": "a", "share": 1.0}]}}
    with pytest.raises(CaseError, match="'a' has all of the mileage"):
        question("share:a", None, record)
