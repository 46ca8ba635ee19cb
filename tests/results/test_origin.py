"""The way from a result to its case, and whether it still is the same."""

import pytest

from fatigue.errors import DataError
from fatigue.results import (
    case_of,
    changed_inputs,
    input_register,
    is_assessed_case,
    is_same_case,
    named_case,
    way_to_case,
)

TEXT = 'title = "mine"\n'


@pytest.fixture
def case(tmp_path):
    """A case file in a folder of its own."""
    (tmp_path / "case").mkdir()
    path = tmp_path / "case" / "case.toml"
    path.write_text(TEXT)
    return path


def record_of(case, folder):
    """What a provenance says of its case."""
    return {
        "case_path": way_to_case(case, folder),
        "case_text": TEXT,
        "case_file": case.name,
        "inputs": input_register([case], case.parent),
    }


def test_a_case_is_the_same_however_it_is_spelled(case, tmp_path, monkeypatch):
    """Absolute, relative, through .., through a link to its folder or to itself; edited since or not."""
    folder = tmp_path / "result"
    folder.mkdir()
    record = record_of(case, folder)
    monkeypatch.chdir(case.parent)
    (tmp_path / "by-name").symlink_to(case.parent)
    (tmp_path / "latest.toml").symlink_to(case)
    case.write_text(TEXT + "edited = true\n")
    for spelled in ("case.toml", "./case.toml", "../case/case.toml", tmp_path / "by-name" / "case.toml", case):
        assert is_same_case(type(case)(spelled), record, folder), spelled
    assert is_same_case(tmp_path / "latest.toml", record, folder)


def test_a_case_beside_it_is_another_one(case, tmp_path):
    """Even with the same text."""
    folder = tmp_path / "result"
    folder.mkdir()
    other = case.with_name("case_9hz.toml")
    other.write_text(TEXT)
    assert not is_same_case(other, record_of(case, folder), folder)


def test_case_and_result_may_be_moved_together(case, tmp_path):
    """The way between them stays."""
    folder = case.parent / "result"
    folder.mkdir()
    record = record_of(case, folder)
    case.parent.rename(tmp_path / "archive")
    moved = tmp_path / "archive" / "case.toml"
    moved.write_text(TEXT + "edited = true\n")
    assert is_same_case(moved, record, tmp_path / "archive" / "result")


def test_a_case_that_was_moved_or_renamed_alone_is_known_by_its_text(case, tmp_path):
    """As long as nobody edits it as well; a comment changes no key."""
    folder = tmp_path / "result"
    folder.mkdir()
    record = record_of(case, folder)
    moved = case.rename(tmp_path / "renamed.toml")
    assert is_same_case(moved, record, folder)
    moved.write_text(TEXT + "# a comment\n")
    assert is_same_case(moved, record, folder)
    moved.write_text(TEXT + "edited = true\n")
    assert not is_same_case(moved, record, folder)


def test_the_way_leads_through_a_linked_result_folder(case, tmp_path):
    """A result folder on another disk, linked to: the way starts where it really is."""
    (tmp_path / "disk" / "deep").mkdir(parents=True)
    link = case.parent / "result"
    link.symlink_to(tmp_path / "disk" / "deep")
    record = record_of(case, link)
    assert case_of(record, link) == case
    assert case_of(record, tmp_path / "disk" / "deep").samefile(case)


def test_a_named_case_has_to_be_the_one_that_was_assessed(case, tmp_path):
    """Missing or edited: refused with place and remedy."""
    folder = tmp_path / "result"
    folder.mkdir()
    record = record_of(case, folder)
    assert named_case(record, case) == case
    with pytest.raises(DataError, match=r"none\.toml: there is no such file"):
        named_case(record, tmp_path / "none.toml")
    case.write_text(TEXT + "edited = true\n")
    with pytest.raises(DataError, match="is not the case of this result: its text differs"):
        named_case(record, case)


def test_changed_inputs_are_found_beside_a_renamed_case(case, tmp_path):
    """The case itself may have another name; what it names must be beside it, unchanged."""
    (case.parent / "q.csv").write_text("1")
    record = record_of(case, tmp_path) | {"inputs": input_register([case, case.parent / "q.csv"], case.parent)}
    renamed = case.rename(case.with_name("renamed.toml"))
    assert not changed_inputs(record, renamed)
    (case.parent / "q.csv").write_text("2")
    (problem,) = changed_inputs(record, renamed)
    assert problem.what == "has changed since the assessment"


def test_inputs_outside_the_case_folder_are_found_from_anywhere(case, tmp_path, monkeypatch):
    """Named as the case names them, whatever folder the program was started in."""
    (tmp_path / "q.csv").write_text("1")
    monkeypatch.chdir(tmp_path)
    relative = type(case)("case/case.toml")
    (entry,) = input_register([relative.parent / "../q.csv"], relative.parent)
    assert entry["file"] == "../q.csv"
    assert (case.parent / entry["file"]).is_file()


ASSESSED = """title = "mine"
[body]
modes = "modes.csv"
[mission]
target_km = 1e6
[[mission.event]]
name = "a"
share = 0.5
[[mission.event]]
name = "b"
share = 0.5
"""
LATER = {
    "a channel": ASSESSED + "[[mission.event.channel]]\nname = 'bogie'\ncolumn = 'q_1'\n",
    "a channel inline": ASSESSED.replace('name = "a"', 'name = "a"\nchannel = [{ name = "bogie" }]'),
    "rules of a ride": ASSESSED + "[ride.alarm]\ncycles = 10\n[[ride.equipment_mode]]\nname = 'converter'\n",
    "participation": ASSESSED.replace("[mission]", 'participation = "l.csv"\ntotal_mass_t = 30.0\n[mission]'),
    "a comment": "# mine\n" + ASSESSED,
    "another order": ASSESSED.replace('name = "a"\nshare = 0.5', 'share = 0.5\nname = "a"'),
    "a byte order mark": "\ufeff" + ASSESSED,
}
EDITED = {
    "a share": ASSESSED.replace("0.5", "0.4", 1),
    "a whole number": ASSESSED.replace("1e6", "1000000"),
    "another event": ASSESSED + "[[mission.event]]\nname = 'c'\n",
    "a channel of the mission": ASSESSED.replace("target_km", "channel = 'x'\ntarget_km"),
    "an unknown table": ASSESSED + "[rides]\n",
    "the order of the events": ASSESSED.replace('"a"', '"c"').replace('"b"', '"a"').replace('"c"', '"b"'),
    "no TOML": ASSESSED + "[ride\n",
    "a list for a table": ASSESSED.replace('[body]\nmodes = "modes.csv"', "[[body]]\n"),
}


@pytest.fixture
def record(case, tmp_path):
    """What a provenance says of the longer case."""
    case.write_text(ASSESSED)
    return record_of(case, tmp_path) | {"case_text": ASSESSED}


@pytest.mark.parametrize("edit", LATER)
def test_what_no_assessment_reads_may_come_later(record, case, edit):
    """Channels, rules of a ride, what a basis is compared with, comments: the case is the one that was assessed."""
    case.write_text(LATER[edit], encoding="utf-8")
    assert is_assessed_case(record, case)
    assert named_case(record, case) == case
    assert not changed_inputs(record, case)


@pytest.mark.parametrize("edit", EDITED)
def test_what_an_assessment_reads_makes_another_case(record, case, edit):
    """Whatever may change a number, and whatever is no case."""
    case.write_text(EDITED[edit], encoding="utf-8")
    assert not is_assessed_case(record, case)
    assert [problem.code for problem in changed_inputs(record, case)] == ["changed_input"]


def test_channels_may_go_as_they_came(record, case):
    """A result that was assessed with channels is of the same case without them."""
    assert is_assessed_case(record | {"case_text": LATER["a channel"]}, case)


def test_a_named_case_that_is_no_toml_is_not_called_another_case(case, tmp_path):
    """A decimal comma, typed beside a channel later, is a slip of syntax; its line is named."""
    record = record_of(case, tmp_path / "result")
    case.write_text(TEXT + "[ride.alarm]\nthreshold_m_s2 = 7,5\n")
    with pytest.raises(DataError, match=r"not valid TOML: .*line 3"):
        named_case(record, case)
