"""``vehicle.toml``: what is read is what stands there, and every mistake is told with place, value and remedy."""

import dataclasses
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.errors import CaseError
from fatigue.study.vehicle_file import keys_of, load_vehicle
from fatigue.study.vehicle_keys import KEYS, OF_SETTING
from fatigue.study.vehicle_text import vehicle_text
from fatigue.vehicle.definition import SETTINGS, Setting, Vehicle

SHIPPED = Path("data/vehicle/vehicle.toml")


def written(tmp_path, text, name="v.toml"):
    """A vehicle file with this text."""
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


def refusals(*arguments):
    """Problems of a vehicle that is refused, as (code, where, what, remedy)."""
    with pytest.raises(CaseError) as error:
        load_vehicle(*arguments)
    return [(p.code, p.where, p.what, p.remedy) for p in error.value.problems]


def test_the_shipped_file_is_the_reference_trailer():
    """Every key stands in it, with its origin, and every value is the default."""
    assert load_vehicle(SHIPPED) == Vehicle()
    text = SHIPPED.read_text(encoding="utf-8")
    assert text == vehicle_text(Vehicle())
    for table, keys in KEYS.items():
        assert f"[{table}]\n" in text
        for name, key in keys.items():
            assert f"{name} = " in text
            assert key.origin in "PSKOT"


def test_keys_are_those_of_the_vehicle():
    """Neither the vehicle nor the keys have what the other has not."""
    has = {
        f.name: [g.name for g in dataclasses.fields(getattr(Vehicle(), f.name))] for f in dataclasses.fields(Vehicle)
    }
    assert {table: list(keys) for table, keys in KEYS.items()} == has
    assert {key.split(".")[1] for key in OF_SETTING} == {f.name for f in dataclasses.fields(Setting)} - {
        "worn_conicity"
    }


def test_a_body_is_found_beside_the_file(tmp_path):
    """A relative folder begins at the file that names it; one that a study changes at the working folder."""
    (tmp_path / "body").mkdir()
    path = written(tmp_path, '[car]\nbody = "body"\n')
    assert load_vehicle(path).car.body == str(tmp_path / "body")
    assert load_vehicle(path, {"car.body": "frame"}).car.body == "frame"
    assert load_vehicle(path, {"car.body": str(tmp_path / "body")}).car.body == str(tmp_path / "body")
    (code, where, what, remedy), *more = refusals(written(tmp_path, '[car]\nbody = "bdy"\n'))
    assert (code, where, more) == ("missing_body", "v.toml: car.body", [])
    assert str(tmp_path / "bdy") in what
    assert "fatigue reduce" in remedy


def test_all_mistakes_are_told_at_once(tmp_path):
    """A file with nine mistakes is refused with nine lines, those of a study among them."""
    path = written(
        tmp_path,
        """
        speed = 3
        [conv]
        [converter]
        mass_kg = "6600"
        fe_hz = -3
        fe_h = 1
        conicity = 0.2
        damping_ratio = 1.0
        [contact]
        state = "worm"
        worn_sections_m = [[2, 1], [3], [4, 5]]
        [run]
        seed = 1.5
        speed_km_h = nan
        """,
    )
    found = refusals(path, {"conv.fe_hz": 3.0, "run.step_s": True}, "study.toml: vary[1]")
    told = {where: f"{what}. {remedy}" for _, where, what, remedy in found}
    assert len(found) == len(told) == 14
    assert "speed_km_h" in told["v.toml: speed"]
    assert "[converter]" in told["v.toml: conv"]
    assert "Give a number at least 50" in told["v.toml: converter.mass_kg"]
    assert "-3 is out of range" in told["v.toml: converter.fe_hz"]
    assert "'fe_hz'" in told["v.toml: converter.fe_h"]
    assert "[contact]" in told["v.toml: converter.conicity"]
    assert "above 0 and below 1" in told["v.toml: converter.damping_ratio"]
    assert "'worn'" in told["v.toml: contact.state"]
    assert {"v.toml: contact.worn_sections_m[1]", "v.toml: contact.worn_sections_m[2]"} <= set(told)
    assert "whole number" in told["v.toml: run.seed"]
    assert "out of range" in told["v.toml: run.speed_km_h"]
    assert "converter.fe_hz" in told["study.toml: vary[1]: conv.fe_hz"]
    assert "should be a number" in told["study.toml: vary[1]: run.step_s"]


@pytest.mark.parametrize(
    ("key", "in_another_unit"),
    [
        ("wheelset.radius_m", 460.0),  # mm
        ("converter.x_m", -3000.0),  # mm
        ("bogie.spacing_m", 17500.0),  # mm
        ("converter.fz_hz", 9000.0),  # mHz
        ("contact.f11_N", 10.0),  # MN
        ("converter.mass_kg", 6.6),  # t
    ],
)
def test_values_in_another_unit_are_out_of_range(key, in_another_unit):
    """A length in mm, a frequency in mHz or a coefficient in MN makes no vehicle."""
    with pytest.raises(CaseError, match=rf"{key}: {in_another_unit:g}.* is out of range"):
        load_vehicle(None, {key: in_another_unit})


@pytest.mark.parametrize(
    ("changed", "where"),
    [
        ({"run.dropped_s": 60.0}, "run.dropped_s"),
        ({"track.distance_m": 100.0}, "track.distance_m"),
        ({"contact.state": "worn", "contact.worn_sections_m": []}, "contact.worn_sections_m"),
        ({"contact.state": "worn", "track.distance_m": 1500.0}, "contact.state"),
        ({"bogie.wheelbase_m": 17.5}, "bogie.wheelbase_m"),
        ({"track.longest_m": 2.0}, "track.longest_m"),
    ],
)
def test_values_that_contradict_one_another_are_refused(changed, where):
    """What is fine alone and wrong together is named where it is given."""
    assert [(code, at) for code, at, _, _ in refusals(None, changed)] == [("contradiction", f"changed: {where}")]


def test_a_changed_setting_does_not_vanish_behind_the_file(tmp_path):
    """A file that states what the setting would change is told, unless the study changes that as well."""
    path = written(tmp_path, "[suspension]\nprimary_x_N_m = 120e6\n[bogie]\nwheelbase_m = 2.5\n")
    ((code, where, what, _),) = refusals(path, {"suspension.setting": "soft"})
    assert (code, where) == ("contradiction", "changed: suspension.setting")
    assert "suspension.primary_x_N_m, bogie.wheelbase_m" in what
    both = {"suspension.setting": "soft", "suspension.primary_x_N_m": 15e6, "bogie.wheelbase_m": 2.6}
    assert load_vehicle(path, both).bogie.wheelbase_m == 2.6


@pytest.mark.parametrize(
    ("content", "code"),
    [
        (b"[run]\nspeed_km_h = 3,5\n", "toml_syntax"),
        (b"[run]\ntitle = '\xff'\n", "not_utf8"),
        (b"[run]\nseed = " + b"9" * 5000, "bad_value"),
        (b"a = " + b"[" * 3000, "bad_value"),
        (b"PAR1" + bytes(40), "foreign_format"),
    ],
)
def test_what_is_no_toml_is_one_clear_line(tmp_path, content, code):
    """Damage of the file itself has its place and its remedy."""
    path = tmp_path / "v.toml"
    path.write_bytes(content)
    ((found, where, _, remedy),) = refusals(path)
    assert found == code
    assert where.startswith("v.toml")
    assert remedy


def test_a_missing_file_and_a_case_are_told_for_what_they_are(tmp_path):
    """Neither is read as a vehicle without keys."""
    assert refusals(tmp_path / "none.toml")[0][0] == "missing_file"
    assert refusals(tmp_path)[0][0] == "not_a_file"
    assert "this is a case" in refusals(Path("data/carbody/case.toml"))[0][2]
    assert load_vehicle(written(tmp_path, "")) == Vehicle()


NUMBERS = [
    f"{table}.{name}"
    for table in ("converter", "transformer", "wheelset", "suspension")
    for name, key in KEYS[table].items()
    if not key.choices
]


@given(name=st.sampled_from(NUMBERS), part=st.floats(1e-12, 0.999))
def test_what_is_written_is_read_again(tmp_path_factory, name, part):
    """The text of a vehicle is that very vehicle, to the last bit of any number."""
    table, key = name.split(".")
    value = part + max(0.0, KEYS[table][key].range.low)
    vehicle = load_vehicle(None, {name: value})
    assert keys_of(vehicle)[name] == value
    assert load_vehicle(written(tmp_path_factory.mktemp("v"), vehicle_text(vehicle))) == vehicle


@pytest.mark.parametrize("setting", SETTINGS)
def test_every_setting_can_be_asked_for(setting):
    """Settings are choices, and `all` of the modes is no number."""
    vehicle = load_vehicle(None, {"suspension.setting": setting, "car.keep_hz": "all", "contact.saturation_mu": 0.3})
    assert vehicle.suspension.setting == setting
    assert vehicle.car.keep_hz is None
    assert vehicle.contact.saturation_mu == 0.3
