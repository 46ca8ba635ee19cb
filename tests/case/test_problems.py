"""What is said about the mistakes of a case file, in the words of the file."""

import math
import unicodedata

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.case import check_files, load_case
from fatigue.errors import CaseError, DataError
from tests.case.case_text import MINIMAL, OWN_CURVE


@pytest.mark.parametrize("table", ["body", "curve", "mission"])
def test_missing_table(load, table):
    """Each table that has no default is asked for by name."""
    kept = [part for part in MINIMAL.split("\n\n") if not part.strip().startswith((f"[{table}", f"[[{table}"))]
    with pytest.raises(CaseError) as refusal:
        load("\n\n".join(kept))
    assert str(refusal.value) == f"case.toml: {table}: the key is missing. Give a [{table}] table."


@pytest.mark.parametrize(
    ("events", "message"),
    [
        ("event = []", "mission.event: [] is empty. Give one [[mission.event]] table per operating condition."),
        ("event = 3", "mission.event: 3 should be a valid list. Give one [[mission.event]] table per"),
        ("event = [3]", "mission.event[1]: 3 should be a table. Give one [[mission.event]] table per"),
        (
            'event = {name = "a"}',
            "mission.event: {'name': 'a'} should be a valid list. Give one [[mission.event]] table",
        ),
        ("", "mission.event: the key is missing. Give one [[mission.event]] table per operating condition."),
    ],
)
def test_no_list_of_events(load, events, message):
    """A mission needs at least one event, as an array of tables."""
    with pytest.raises(CaseError) as refusal:
        load(MINIMAL[: MINIMAL.index("[[")] + events)
    assert str(refusal.value).startswith("case.toml: " + message)


def test_all_mistakes_at_once(load):
    """Mistakes in different tables do not hide one another, nor those of the events as a whole."""
    text = (
        MINIMAL.replace('"on_element"', '"on_both"')
        .replace("master-aluminium", "mastr-aluminium")
        .replace("target_km = 1.2e7", "target_km = -1")
        .replace("speed_km_h", "speed")
        .replace('name = "load"', 'name = "curve"')
        .replace("share = 0.25", "share = 0.2")
    )
    with pytest.raises(CaseError) as refusal:
        load(text + "[counting]\nupsample = 3\n")
    found = [(problem.code, problem.where.removeprefix("case.toml: ")) for problem in refusal.value.problems]
    assert sorted(found) == sorted(
        [
            ("bad_value", "body.force_convention"),
            ("unknown_curve", "curve.name"),
            ("bad_value", "counting.upsample"),
            ("bad_value", "mission.target_km"),
            ("unknown_key", "mission.event[1].speed ('tangent')"),
            ("duplicate", "mission.event[3].name"),
            ("shares", "mission.event.share"),
        ]
    )


def test_only_events_counted_by_number(load):
    """Without any share there is no sum to check."""
    start, *events = MINIMAL.split("[[mission.event]]")
    assert load(f"{start}[[mission.event]]{events[2]}").mission.event[0].per_1000_km == 1.5


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[body]\nmodes = = 3\n", "case.toml: line 2, column 9: not valid TOML: Invalid value. Correct the line."),
        (
            "[body]\nmodes = 'a'\nmodes = 'b'\n",
            "case.toml: line 3, column 12: not valid TOML: Cannot overwrite a value.",
        ),
        ("[body]\n\nmodes = 'a", "case.toml: line 3: not valid TOML: "),
        (
            b"# Tr\xe4ger\n" + MINIMAL.encode(),
            "case.toml: line 1: the byte 0xe4 is not UTF-8 text. Save the file as UTF-8.",
        ),
    ],
)
def test_not_toml(load, text, message):
    """A syntax error names its line and column."""
    with pytest.raises(CaseError) as refusal:
        load(text)
    assert str(refusal.value).startswith(message)


@pytest.mark.parametrize(("band", "items"), [("[9]", "1 item, at least 2"), ("[4, 12, 20]", "3 items, at most 2")])
def test_lists_of_another_length(load, band, items):
    """The items that are there and those that are wanted are counted; none is lost where only the length is wrong."""
    with pytest.raises(CaseError) as refusal:
        load(MINIMAL + f"\n[ride]\nhunting_band_hz = {band}\n")
    assert f"ride.hunting_band_hz: {band} has {items} are wanted. Give a list of the two edges" in str(refusal.value)


def test_long_values_are_cut(load):
    """A message never repeats a page of text."""
    with pytest.raises(CaseError) as refusal:
        load(MINIMAL.replace('"on_element"', f'"{"x" * 500}"'))
    assert '"' + "x" * 56 + "... should be" in str(refusal.value)


@settings(deadline=None, max_examples=50)
@given(st.lists(st.floats(0.01, 1.0), min_size=1, max_size=6), st.floats(-1e-5, 1e-5))
def test_shares_are_accepted_within_the_tolerance(tmp_path_factory, weights, excess):
    """Shares that sum to 1 within 1e-6 pass, others do not."""
    shares = [weight / math.fsum(weights) for weight in weights]
    shares[0] += excess
    total = math.fsum(shares)
    events = [
        f'[[mission.event]]\nname = "e{i}"\nhistory = "q"\nspeed_km_h = 100\nshare = {share!r}\n'
        for i, share in enumerate(shares)
    ]
    path = tmp_path_factory.mktemp("case") / "case.toml"
    path.write_text(MINIMAL[: MINIMAL.index("[[")] + "".join(events))
    if abs(total - 1) <= 1e-6 and max(shares) <= 1:
        assert [event.share for event in load_case(path).mission.event] == shares
    else:
        with pytest.raises(CaseError):
            load_case(path)


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
