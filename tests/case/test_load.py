"""A case file is read whole or refused; lengths of events, and the schema."""

import json
from pathlib import Path

import pytest

from fatigue.case import Case, case_schema, check_distance, check_files, event_length_km, load_case
from fatigue.errors import CaseError, DataError
from tests.case.case_text import MINIMAL, OWN_CURVE

jsonschema = pytest.importorskip("jsonschema")


def test_text_and_paths_are_kept(load, tmp_path):
    """The case remembers its text, its file and where its inputs are."""
    text = "# a comment\n" + MINIMAL
    case = load(text)
    assert case.text == text
    assert case.path == tmp_path / "case.toml"
    files = case.input_files()
    assert list(files) == [
        "body.modes",
        "body.welds",
        "body.weld_nodes",
        "body.nodal_forces",
        "mission.event[1].history",
        "mission.event[2].history",
        "mission.event[3].history",
    ]
    assert files["mission.event[2].history"] == tmp_path / "q_curve.parquet"


def test_byte_order_mark_and_windows_line_ends(load):
    """A file saved by a Windows editor reads the same."""
    assert load(b"\xef\xbb\xbf" + MINIMAL.replace("\n", "\r\n").encode()).curve.name == "master-aluminium"


def test_empty_file(load):
    """An empty file lacks every table that has no default."""
    with pytest.raises(CaseError) as refusal:
        load("")
    assert [problem.where for problem in refusal.value.problems] == [
        "case.toml: body",
        "case.toml: curve",
        "case.toml: mission",
    ]


def test_missing_case_file(tmp_path):
    """A path without file is refused, not raised as an error of the system."""
    with pytest.raises(CaseError, match=r"nowhere\.toml: there is no such file\. Give the path of a case\.toml\.$"):
        load_case(tmp_path / "nowhere.toml")


def test_folder_instead_of_case_file(tmp_path):
    """A folder is not searched for a case."""
    with pytest.raises(CaseError, match=r"this is a folder\. Give the path of the case\.toml in it\.$"):
        load_case(tmp_path)


def test_unreadable_case_file(tmp_path, monkeypatch):
    """A file that may not be read is refused with the reason of the system."""
    (tmp_path / "case.toml").write_text(MINIMAL)

    def denied(_: Path) -> bytes:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "read_bytes", denied)
    with pytest.raises(CaseError, match=r"cannot be read \(Permission denied\)\. Check its permissions\.$"):
        load_case(tmp_path / "case.toml")


def test_missing_inputs_are_listed_together(load, tmp_path):
    """Every file the case names and nobody has is listed."""
    (tmp_path / "welds.csv").write_text("weld\n")
    with pytest.raises(DataError) as refusal:
        check_files(load(MINIMAL))
    assert [problem.where for problem in refusal.value.problems] == [
        "case.toml: body.modes",
        "case.toml: body.weld_nodes",
        "case.toml: body.nodal_forces",
        "case.toml: mission.event[1].history",
        "case.toml: mission.event[2].history",
        "case.toml: mission.event[3].history",
    ]
    assert "q_tangent.parquet. Correct the path." in str(refusal.value)


def test_length_of_an_event(load):
    """Speed times duration, or the length given; an event counted by number has none."""
    tangent, curve, number = load(MINIMAL).mission.event
    for event in (tangent, curve, number):
        check_distance(event, 36.0, "here")
    assert event_length_km(tangent, 36.0) == pytest.approx(3.5)
    assert event_length_km(curve, 36.0) == 3
    assert event_length_km(number, 36.0) is None


@pytest.mark.parametrize(
    ("length", "fits"), [(3.5, True), (3.5034, True), (3.4966, True), (3.504, False), (3.496, False)]
)
def test_length_against_speed(load, length, fits):
    """Length and speed have to agree to 1e-3; the length then decides."""
    event = load(MINIMAL.replace("speed_km_h = 350.0", f"speed_km_h = 350.0\nlength_km = {length}")).mission.event[0]
    assert event_length_km(event, 36.0) == length
    if fits:
        check_distance(event, 36.0, "here")
        return
    with pytest.raises(CaseError) as refusal:
        check_distance(event, 36.0, "here")
    assert str(refusal.value) == (
        f"here: length_km = {length:g} of event 'tangent' is not speed_km_h = 350 times the duration of 36 s, 3.5 km. "
        "Correct one of them or leave one out."
    )


def test_schema_accepts_what_the_models_accept(load):
    """The JSON Schema says the same as the models, and every key is described."""
    schema = case_schema()
    case = load(MINIMAL + OWN_CURVE)
    content = json.loads(case.model_dump_json(exclude_none=True))
    assert Case.model_validate_json(json.dumps(content)).text == ""
    jsonschema.Draft202012Validator(schema).validate(content)
    content["mission"]["target_km"] = -1
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.Draft202012Validator(schema).validate(content)
    for table in (schema, *schema["$defs"].values()):
        for key, value in table["properties"].items():
            assert value.get("description"), key


def test_every_table_tells_what_it_lacks(load):
    """A missing key of a table inside a table is named as any other."""
    with pytest.raises(CaseError, match=r"checks\.stress_category\.high_from: the key is missing"):
        load(MINIMAL + '\n[checks.stress_category]\nmedium_from = 0.7\nsource = "mine"\n')
