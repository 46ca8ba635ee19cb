"""Paths and names in a case as other systems and editors write them."""

import unicodedata

import pytest

from fatigue.case import check_files, load_case
from fatigue.errors import CaseError, DataError
from tests.test_case import MINIMAL, OWN_CURVE


def refusal_of(tmp_path, text: str) -> str:
    """Message about a case with this text."""
    path = tmp_path / "case.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises((CaseError, DataError)) as refusal:
        check_files(load_case(path))
    return str(refusal.value)


@pytest.mark.parametrize(
    ("written", "message"),
    [
        (
            r'"C:\data\q.csv"',
            "line 3, column 14: not valid TOML: Unescaped '\\' in a string. Write / between the folders",
        ),
        (r'"C:\users\q.csv"', "line 3, column 14: not valid TOML: Invalid hex value. Write / between the folders"),
        (r'"\\server\q.csv"', "or put the path into single quotes."),
        (r'"C:\new.csv"', 'body.modes: the path "C:\\new.csv" holds a line end (\\n), as \\ begins an escape'),
        (r'"sub\temp.csv"', 'body.modes: the path "sub\\temp.csv" holds a tab (\\t), as \\ begins an escape'),
        (r"'C:\data\q.csv'", "a path of Windows. Give a path of this computer."),
        (r"'sub\modes.csv'", "Write 'sub/modes.csv'."),
        ('"sub/MODES.csv"', "Write 'sub/modes.csv'."),
        ('"sub"', "case.toml: body.modes: this is a folder with modes.csv. Give a .parquet or .csv file."),
    ],
)
def test_paths_of_another_system(tmp_path, written, message):
    """An escape in double quotes is never taken for a path; what was meant is proposed."""
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "modes.csv").touch()
    assert message in refusal_of(tmp_path, MINIMAL.replace('"modes.csv"', written))


def test_a_history_with_a_tab_in_its_path(tmp_path):
    """The key of the event is named."""
    message = refusal_of(tmp_path, MINIMAL.replace('"q_curve.parquet"', r'"runs\track.parquet"'))
    assert message.startswith("case.toml: mission.event[2].history ('curve'): the path \"runs\\track.parquet\" holds")


def test_another_syntax_error_keeps_its_remedy(tmp_path):
    """Only a backslash between quotes is taken for a path."""
    assert refusal_of(tmp_path, "title = \n").endswith("Correct the line.")


@pytest.mark.parametrize(
    ("line", "remedy"),
    [
        ("share = 1,0", "Write numbers with a decimal point, and without thousands separators."),
        ("target_km = 12 000 000", "Write numbers without thousands separators."),
        ("title = \u201ccar\u201d", "Write straight quotation marks, as a plain text editor does."),
        ("modes = modes.csv", "Put the path into quotation marks."),
    ],
)
def test_slips_of_a_text_editor(tmp_path, line, remedy):
    """Each has its own remedy."""
    assert refusal_of(tmp_path, line + "\n").endswith(remedy)


def test_event_names_in_two_spellings_are_one(tmp_path):
    """On screen the two names are the same."""
    text = MINIMAL.replace('"tangent"', '"Bögen"').replace('"curve"', f'"{unicodedata.normalize("NFD", "Bögen")}"')
    assert "is already the name of mission.event[1]" in refusal_of(tmp_path, text)


def test_curve_names_in_two_spellings(tmp_path):
    """A curve whose key has accents apart is refused with the key to write."""
    key = unicodedata.normalize("NFD", "träger")
    text = MINIMAL.replace("master-aluminium", "träger") + OWN_CURVE.replace("curves.mine", f'curves."{key}"')
    message = refusal_of(tmp_path, text)
    assert "Write 'träger'" in message
    assert "Copy the name from [curves]" in message
