"""What a setting is, and the case it makes; what two cases differ in."""

import pytest

from fatigue.decide.whatif.asked import Asked, TwoCases, two_cases
from fatigue.decide.whatif.difference import Difference, differences
from fatigue.errors import CaseError
from tests.decide.whatif.reruns import base_case


@pytest.fixture
def record(tmp_path):
    """As much of a provenance as a case is found by, for a case with a sequence."""
    path = base_case("straight", sequence=True).write(tmp_path / "case")
    return {"case_path": "../case/case.toml", "case_text": path.read_text(), "inputs": []}


def made(record, tmp_path, *settings: str, drop: tuple[str, ...] = ()) -> TwoCases:
    """The two cases of some settings."""
    return two_cases(record, tmp_path / "result", Asked(settings, drop))


@pytest.mark.parametrize(
    "setting",
    [
        'mission.event."load and unload".per_1000_km=7',
        "mission.event.load and unload.per_1000_km=7.0",
        "mission.event.'load and unload'.per_1000_km = 7",
        "mission.event.load and unload.per_1000_km=7",
    ],
)
def test_a_key_is_read_with_and_without_quotes(record, tmp_path, setting):
    """All of them lead to the same number of the same event, and to nothing else."""
    cases = made(record, tmp_path, setting)
    found = differences(record, cases.base, cases.changed)
    key = ("mission", "event", "load and unload", "per_1000_km")
    assert found.keys == (Difference(key, 2.0, 7.0, "mission"),)
    assert found.words == ('mission.event."load and unload".per_1000_km from 2 to 7',)


def test_load_is_beside_the_case(record, tmp_path):
    """It is no key, and changes no key."""
    cases = made(record, tmp_path, "load=1.25")
    assert cases.load == 1.25
    assert differences(record, cases.base, cases.changed).words == ()


def test_texts_lists_and_numbers_keep_their_kind(record, tmp_path):
    """A text needs no quotes, a list is one of TOML, a whole number is a number."""
    cases = made(record, tmp_path, "curve.survival=mean", "curves.own.slopes=[4.0]", "curves.own.knees_cycles=[]")
    assert cases.changed.curve.survival == "mean"
    assert cases.changed.curves["own"].slopes == (4.0,)
    kinds = {one.name: one.kind for one in differences(record, cases.base, cases.changed).keys}
    assert kinds == {"curve.survival": "curve", "curves.own.slopes": "curve", "curves.own.knees_cycles": "curve"}


def test_all_mistakes_are_told_at_once(record, tmp_path):
    """Two keys that lead nowhere and an event that is not there."""
    with pytest.raises(CaseError) as refused:
        made(record, tmp_path, "mission.event.x.share=1", "load=fast", drop=("tunnel",))
    assert [problem.code for problem in refused.value.problems] == ["unknown_event", "bad_value", "unknown_event"]


def test_a_sequence_has_a_number_and_an_event_is_dropped(record, tmp_path):
    """The number is that of the order in the file."""
    cases = made(record, tmp_path, "mission.sequence.1.per_1000_km=0", drop=("load and unload",))
    found = differences(record, cases.base, cases.changed)
    assert [one.kind for one in found.keys] == ["mission"]
    assert found.dropped == ("load and unload",)
    assert found.words[-1] == "event 'load and unload' dropped"


def test_texts_of_a_curve_and_the_title_are_no_knobs_and_do_no_harm(record, tmp_path):
    """They stand beside the numbers; every other key is refused by its name."""
    cases = made(record, tmp_path, "title=other", "curves.own.source=elsewhere", "curve.yield_MPa=300")
    assert differences(record, cases.base, cases.changed).words == ()
    cases = made(record, tmp_path, "spectrum.upper_hz=50")
    with pytest.raises(CaseError, match=r"spectrum\.upper_hz: a change from not given to 50 is no knob"):
        differences(record, cases.base, cases.changed)
