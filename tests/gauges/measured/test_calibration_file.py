"""Calibrations: which row holds when, what they leave open, and what is wrong with them."""

from datetime import datetime

import pytest

from fatigue.errors import DataError
from fatigue.gauges.measured.calibration_file import (
    AS_IT_IS,
    calibration_warnings,
    calibrations_of,
    read_calibrations,
)
from fatigue.gauges.measured.channel_file import Channel

TWO = (
    "channel,valid_from,factor,sign_checked\nC1,2026-05-04T10:00:00+02:00,2.5,true\nC1,2026-03-01T00:00:00Z,2.0,true\n"
)


def table(tmp_path, text):
    """Read a table from its text; the file, too."""
    path = tmp_path / "calibration.csv"
    path.write_text(text)
    return read_calibrations(path)[0], path


def channel(unit="V", name="C1"):
    """A channel of a gauge."""
    return Channel(
        name, f"channels.csv: channel '{name}'", name, (("A", 1.0),), "", unit, E=7e4 if unit == "MPa" else None
    )


def test_the_row_that_held_then_is_taken(tmp_path):
    """The latest that had begun, whatever the order of the rows and the zones of the times."""
    known, path = table(tmp_path, TWO)
    for at, factor in (
        ("2026-04-01T00:00:00Z", 2.0),
        ("2026-05-04T08:00:00Z", 2.5),
        ("2026-05-04T09:59:59+02:00", 2.0),
    ):
        found = calibrations_of([channel()], known, path, datetime.fromisoformat(at))
        assert found["C1"].factor == factor


def test_one_row_holds_where_no_time_is_given(tmp_path):
    """Several do not."""
    one, path = table(tmp_path, "channel,valid_from,factor,offset\nC1,2026-05-04T10:00:00Z,2.5,3\n")
    found = calibrations_of([channel()], one, path, None)["C1"]
    assert (found.factor, found.offset, found.sign_checked) == (2.5, 3.0, False)
    two, path = table(tmp_path, TWO)
    with pytest.raises(DataError, match="has 2 calibrations, and when the records were made is not known"):
        calibrations_of([channel()], two, path, None)


def test_a_record_before_all_calibrations_is_refused(tmp_path):
    """Nothing is calibrated backwards."""
    known, path = table(tmp_path, TWO)
    with pytest.raises(DataError, match="has no calibration before 2026-03-01"):
        calibrations_of([channel()], known, path, datetime.fromisoformat("2026-02-01T00:00:00Z"))


def test_volts_without_calibration_are_refused_and_strain_is_not():
    """Exit code 3 for V and mV/V; ue and MPa are what they are, with a sign that nobody checked."""
    for unit in ("V", "mV/V"):
        with pytest.raises(DataError, match=f"is in {unit}, and has no calibration that makes strain of it"):
            calibrations_of([channel(unit)], {}, None, None)
    for unit in ("ue", "MPa"):
        assert calibrations_of([channel(unit)], {}, None, None) == {"C1": AS_IT_IS}


def test_a_calibration_of_no_channel_is_told(tmp_path):
    """A misspelled name would leave its channel without."""
    known, path = table(tmp_path, TWO)
    with pytest.raises(DataError, match=r"calibration.csv: there is no channel of strain 'C1'"):
        calibrations_of([channel("ue", "C2")], known, path, None)


def test_what_calibrations_leave_open(tmp_path):
    """Signs that nobody checked are one warning; every shunt beyond 3 % is one; empty shunts are none."""
    known, path = table(
        tmp_path,
        "channel,valid_from,factor,method,shunt_ue_expected,shunt_ue_read,sign_checked\n"
        "C1,2026-01-01T00:00:00Z,1,shunt,1000,969,true\n"
        "C2,2026-01-01T00:00:00Z,1,shunt,1000,1030,\n"
        "C3,2026-01-01T00:00:00Z,1,dead load,,,false\n",
    )
    found = calibrations_of([channel(name=name) for name in ("C1", "C2", "C3")], known, path, None)
    warnings = list(calibration_warnings(found))
    assert [warning.code for warning in warnings] == ["sign_unchecked", "shunt_off"]
    assert "2 of 3 channels was not checked: C2, C3" in warnings[0].what
    assert "C1" in warnings[1].where
    assert "0.969" in warnings[1].what


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ("C1,2026-05-04T10:00:00,1,", "'2026-05-04T10:00:00' is no time with its zone"),
        ("C1,yesterday,1,", "'yesterday' is no time with its zone. Write it as 2026-05-04T10:00:00+02:00"),
        ("C1,2026-05-04T10:00:00Z,0,", "a factor of 0"),
        ("C1,2026-05-04T10:00:00Z,,", "the value is missing"),
        ("C1,2026-05-04T10:00:00Z,1,guess", "'guess' is not one of"),
        ("C1,2026-05-04T10:00:00Z,1,\nC1,2026-05-04T12:00:00+02:00,2,", "has a calibration from"),
    ],
)
def test_mistakes_are_told(tmp_path, row, said):
    """File, row, value and what to do."""
    with pytest.raises(DataError) as caught:
        table(tmp_path, f"channel,valid_from,factor,method\n{row}\n")
    assert said in str(caught.value)
