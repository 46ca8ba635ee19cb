"""Rows of equipment: its vibration beside the table of limits, the table's edition, and why a number is empty."""

from dataclasses import fields

import numpy as np
import pytest

from fatigue.case.channels import Equipment, Ride
from fatigue.errors import CaseError, DataError
from fatigue.results import RIDDEN
from fatigue.ride.standards.equipment import EquipmentRow, equipment_rows, read_vibration_table
from fatigue.vibration.standards.environment_file import shipped_table
from tests.ride.standards.synthetic_channels import channel, noise, sine

OWN = """
edition = "own, 2026"
status = "compared by N. N."
source = "the standard in our shelf"
[class.roof]
functional_rms_m_s2 = { y = 0.4 }
"""


def converter(vibration_class="1A", mass_kg=6600.0, channel="converter y"):
    """Ride with one piece of equipment."""
    given = {"channel": channel, "class": vibration_class}
    return Ride(equipment=(Equipment(**given, mass_kg=mass_kg),))


def rows_of(values, ride, direction="y", table=None, **other):
    """Rows of one channel of equipment."""
    record = channel(values, "converter y", "equipment", direction, **other)
    return equipment_rows([record], ride, table or shipped_table())


def test_fields_are_the_columns():
    """A row is a row of the table; ``class`` is no name in Python."""
    names = [field.name.replace("vibration_class", "class") for field in fields(EquipmentRow)]
    assert names == [column.name for column in RIDDEN["equipment"]]


def test_a_sine_at_the_converter():
    """A sine of 13.7 m/s2 (1.4 g) at 9.2 Hz, 6.6 t: rms 9.69 in 2 to 60 Hz, peak 2.19 times three long-life rms."""
    (row,) = rows_of(sine(13.7, 9.2), converter())
    assert row.band_hz == "2-60"
    assert row.rms_m_s2 == pytest.approx(13.7 / np.sqrt(2), rel=1e-3)
    assert (row.limit_m_s2, row.long_life_rms_m_s2, row.shock_m_s2) == (0.37, 2.09, 30.0)
    assert row.band_limit_m_s2 == pytest.approx(np.sqrt(0.0041 * 29.893), rel=1e-3)
    assert row.peak_m_s2 == pytest.approx(13.7, rel=1e-3)
    assert row.peak_ratio == pytest.approx(13.7 / (3 * 2.09), rel=1e-3)
    assert row.asd_ratio_hz == pytest.approx(10.0)
    width = 10.0 * (10**0.05 - 10**-0.05)
    assert row.asd_ratio == pytest.approx(13.7**2 / 2 / width / 0.0041, rel=0.02)
    assert row.edition == "IEC 61373:2010, superseded by an edition of 2025; recalled"
    assert row.reason == ""


def test_a_light_piece_has_the_wide_band():
    """Without its mass a piece counts as light, and the row says so; sampled at 250 Hz its band ends at 125 Hz."""
    (row,) = rows_of(sine(1.0, 9.2), converter(mass_kg=None))
    assert row.band_hz == "5-125"
    assert row.reason == (
        "no mass_kg: the band of a piece up to 500 kg; sampled at 250 Hz: nothing is known above 125 Hz"
    )
    assert row.rms_m_s2 == pytest.approx(np.sqrt(0.5), rel=1e-3)


def test_a_channel_without_a_class_says_so():
    """The peak is there, every comparison is empty; other channels have no row."""
    (row,) = rows_of(noise(), Ride())
    assert (row.vibration_class, row.edition) == ("", "")
    assert row.reason == "no [[ride.equipment]] gives it a class"
    assert np.isnan([row.rms_m_s2, row.limit_m_s2, row.asd_ratio, row.peak_ratio]).all()
    assert row.peak_m_s2 > 1.0
    assert equipment_rows([channel(noise(), role="floor")], Ride(), shipped_table()) == []


@pytest.mark.parametrize("category", ["2", "3"])
def test_what_the_table_does_not_hold_is_empty(category):
    """Categories 2 and 3: rms of the table and the peak beside long life; no spectrum, band, density or shock."""
    (row,) = rows_of(noise(), converter(category))
    assert np.isnan([row.rms_m_s2, row.band_limit_m_s2, row.asd_ratio, row.shock_m_s2]).all()
    assert np.isfinite([row.limit_m_s2, row.long_life_rms_m_s2, row.peak_ratio]).all()
    assert "no spectrum of this class" in row.reason
    assert "not in the table: spectral density, shock" in row.reason


def test_a_class_that_is_not_there_is_refused():
    """With its place and the classes that are there."""
    with pytest.raises(CaseError, match=r"equipment\[1\]\.class \('converter y'\): there is no class '1C'.*1A, 1B"):
        rows_of(noise(), converter("1C"))


def test_a_table_of_your_own(tmp_path):
    """Its own edition and status, in the row; what it does not hold is empty."""
    (tmp_path / "own.toml").write_text(OWN, "utf-8")
    table = read_vibration_table(tmp_path / "own.toml")
    (row,) = rows_of(noise(), converter("roof"), table=table)
    assert row.edition == "own, 2026; compared by N. N."
    assert row.limit_m_s2 == 0.4
    assert np.isnan(row.long_life_rms_m_s2)
    (row,) = rows_of(noise(), converter("roof"), direction="z", table=table)
    assert np.isnan(row.limit_m_s2)
    assert "not in the table: functional rms" in row.reason
    assert read_vibration_table(None) is shipped_table()


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (None, "there is no such file"),
        (b"edition = ", "not valid TOML"),
        (b"edition = '\xff'", "not UTF-8"),
        (OWN.replace("roof", "roof.limits").encode(), "own.toml: class.roof: limits: unknown key"),
        (OWN.replace("status", "stat").encode(), "own.toml: stat: unknown key 'stat'.*Write 'status'"),
    ],
)
def test_files_that_are_no_table(tmp_path, content, message):
    """Each is refused with its name."""
    file = tmp_path / "own.toml"
    if content is not None:
        file.write_bytes(content)
    with pytest.raises(DataError, match=message) as refused:
        read_vibration_table(file)
    assert refused.value.exit_code == 3
    assert "own.toml" in str(refused.value)


def test_a_folder_is_no_table(tmp_path):
    """Said in words."""
    with pytest.raises(DataError):
        read_vibration_table(tmp_path)


def test_a_short_record_names_what_it_does_not_resolve():
    """Five seconds: third octaves up to 4 Hz are not looked at."""
    (row,) = rows_of(sine(1.0, 9.2, 5.0), converter())
    assert "5 s resolve no third octave up to 3.98 Hz" in row.reason
    assert row.asd_ratio_hz == pytest.approx(10.0)


def test_a_record_without_a_period_of_its_band_has_no_rms():
    """0.4 s from 2 Hz on."""
    (row,) = rows_of(noise(duration=0.4), converter())
    assert np.isnan([row.rms_m_s2, row.asd_ratio]).all()
    assert row.reason == "the record of 0.4 s is shorter than a period of 2 Hz"


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("duration", [0.02, 0.1, 1.0, 30.0])
@pytest.mark.parametrize("values", ["zeros", "constant", "noise"])
@pytest.mark.parametrize("rate", [3.0, 100.0, 1000.0])
@pytest.mark.parametrize("category", ["1A", "2"])
def test_no_number_is_empty_without_a_reason(duration, values, rate, category):
    """Nothing, a constant and noise at any rate: numbers, or why there are none, and no warning of numpy."""
    given = {"zeros": np.zeros, "constant": lambda n: np.full(n, 9.81)}
    samples = max(1, round(duration * rate))
    made = noise(duration=samples / rate, rate=rate) if values == "noise" else given[values](samples)
    (row,) = rows_of(made, converter(category), rate=rate)
    assert row.reason or np.isfinite([row.rms_m_s2, row.asd_ratio, row.peak_ratio]).all()
    assert values == "noise" or row.peak_m_s2 < 1e-9


def test_a_channel_that_is_no_acceleration():
    """Limits mean nothing to it."""
    (row,) = rows_of(noise(), converter(), is_acceleration=False)
    assert "it is no acceleration" in row.reason
    assert np.isnan([row.rms_m_s2, row.peak_m_s2, row.asd_ratio, row.peak_ratio]).all()
