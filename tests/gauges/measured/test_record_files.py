"""Records: opened at an exact ratio, read as they are, and how far they ran."""

import numpy as np
import pandas as pd
import pytest

from fatigue.errors import DataError
from fatigue.gauges.measured.channel_file import Channel
from fatigue.gauges.measured.record_files import distances, open_records

A = Channel("C1", "channels.csv: channel 'C1'", "SG 1", (("A", 1.0),), "", "ue")
SPEED = Channel("V", "channels.csv: channel 'V'", "v", (), "speed", "m/s")
ODOMETER = Channel("O", "channels.csv: channel 'O'", "odo", (), "odometer", "m")


def record(path, rate=250.0, samples=500, **columns):
    """A record with a ramp and whatever else."""
    t = np.arange(samples) / rate
    table = pd.DataFrame({"time_s": t + 7.0, "SG 1": t} | columns)
    (table.to_csv if path.suffix == ".csv" else table.to_parquet)(path, index=False)
    return path


def test_samples_are_read_as_they_are(tmp_path):
    """Empty cells and infinities are no mistake of a measurement: they are missing samples."""
    x = np.arange(500.0)
    x[[3, 9]] = np.nan, np.inf
    for suffix in ("csv", "parquet"):
        (one,), warnings = open_records([record(tmp_path / f"r.{suffix}", **{"SG 1": x})], [A], 200.0)
        assert (one.samples, one.start, str(one.ratio)) == (500, 7.0, "4/5")
        assert one.rate_hz == pytest.approx(250.0)
        np.testing.assert_array_equal(one.read(A), x)
        assert warnings == []


def test_mistakes_of_all_records_are_told_at_once(tmp_path):
    """A column that is not there, a rate without ratio, times that go backwards, one file twice."""
    good, other = record(tmp_path / "good.csv"), record(tmp_path / "other.csv", rate=251.003, samples=50_000)
    pd.DataFrame({"time_s": [0.0, 0.1, 0.05], "SG 1": 0.0}).to_csv(tmp_path / "back.csv", index=False)
    pd.DataFrame({"time_s": [0.0, 0.1, 0.2], "SG1": 0.0}).to_csv(tmp_path / "named.csv", index=False)
    with pytest.raises(DataError) as caught:
        open_records([good, good, other, tmp_path / "back.csv", tmp_path / "named.csv"], [A], 200.0)
    said = str(caught.value)
    assert "good.csv: is given twice" in said
    assert "other.csv: is sampled at 251.003 Hz, and the simulation at 200 Hz" in said, said
    assert "back.csv: column time_s, row 2: the time goes from 0 to 0.1 s" in said
    assert "named.csv: column SG 1" in said


def test_a_text_among_samples_is_told(tmp_path):
    """An overload word of a logger is a value that somebody has to look at."""
    path = record(tmp_path / "r.csv", samples=3, **{"SG 1": ["1", "OVER", "2"]})
    (one,), _ = open_records([path], [A], 250.0)
    with pytest.raises(DataError, match=r"column SG 1, row 2: 'OVER' is not a number"):
        one.read(A)


def test_a_foreign_format_is_told_with_the_way_out(tmp_path):
    """TDMS and MDF are known by their first bytes."""
    for name, head, said in (("r.tdms", b"TDSm", "NI TDMS"), ("r.mf4", b"MDF     4.10", "ASAM MDF")):
        (tmp_path / name).write_bytes(head + bytes(range(256)) * 20)
        with pytest.raises(DataError) as caught:
            open_records([tmp_path / name], [A], 200.0)
        assert said in str(caught.value)


def test_three_ways_to_a_distance(tmp_path):
    """As given, by an odometer, by a speed: 250 m in 2 s at 125 m/s, a step for every sample."""
    t = np.arange(500) / 250.0
    columns = {"v": 125.0, "odo": 40_000.0 + 125.0 * t}
    opened, _ = open_records([record(tmp_path / "r.csv", **columns)], [A], 250.0)
    given = distances(opened, {"speed": SPEED}, 0.25)
    by_speed = distances(opened, {"speed": SPEED}, None)
    by_odometer = distances(opened, {"speed": SPEED, "odometer": ODOMETER}, None)
    for found in (given, by_speed, by_odometer):
        np.testing.assert_allclose(found.km[0], 0.25 / 500)
        assert found.total == pytest.approx(0.25)
        assert found.warnings == ()
    assert [one.source for one in (given, by_speed, by_odometer)] == [
        "0.25 km as given",
        "channel 'V' (speed)",
        "channel 'O' (odometer)",
    ]


def test_a_given_distance_is_shared_by_time(tmp_path):
    """Two records, one twice as long."""
    paths = [record(tmp_path / "a.csv"), record(tmp_path / "b.csv", samples=1000)]
    opened, _ = open_records(paths, [A], 250.0)
    found = distances(opened, {}, 3.0)
    assert [one.sum() for one in found.km] == pytest.approx([1.0, 2.0])


def test_doubts_about_a_distance(tmp_path):
    """Missing speeds and an odometer that goes backwards are warnings; a train that stands has no distance."""
    v = np.full(500, 10.0)
    v[100:150] = np.nan
    odo = np.concatenate([np.arange(250.0), np.arange(250.0)])
    opened, _ = open_records([record(tmp_path / "r.csv", v=v, odo=odo, zero=0.0)], [A], 250.0)
    by_speed, by_odometer = (distances(opened, {c.reserved: c}, None) for c in (SPEED, ODOMETER))
    assert [w.code for w in (*by_speed.warnings, *by_odometer.warnings)] == ["distance_gaps", "odometer_backwards"]
    assert "50 of 500 samples" in by_speed.warnings[0].what
    standing = Channel("V", "channels.csv: channel 'V'", "zero", (), "speed", "m/s")
    with pytest.raises(DataError, match="the records ran 0 km by channel 'V'"):
        distances(opened, {"speed": standing}, None)


def test_no_distance_is_refused(tmp_path):
    """Every number is per km: it is never guessed."""
    opened, _ = open_records([record(tmp_path / "r.csv", v=np.nan)], [A], 250.0)
    with pytest.raises(DataError, match="how far the records ran is not known, and every number is per km"):
        distances(opened, {}, None)
    with pytest.raises(DataError, match="the column has no value"):
        distances(opened, {"speed": SPEED}, None)


def test_units_that_a_record_states_are_compared_with_those_of_the_channels(tmp_path):
    """In the name of a column, in a row below the names, or nowhere; other spellings of the same are the same."""
    volts = Channel("C1", "channels.csv: channel 'C1'", "SG [V]", (("A", 1.0),), "", "ue")
    strain = Channel("C1", "channels.csv: channel 'C1'", "SG [µm/m]", (("A", 1.0),), "", "ue")
    path = record(tmp_path / "r.csv", **{"SG [V]": 1.0, "SG [µm/m]": 2.0})
    with pytest.raises(DataError, match=r"r.csv: column SG \[V\]: the unit is V, and channel 'C1' is in ue"):
        open_records([path], [volts], 250.0)
    open_records([path], [strain], 250.0)
    left = Channel("C1", "channels.csv: channel 'C1'", "SG (left)", (("A", 1.0),), "", "ue")
    open_records([record(tmp_path / "left.csv", **{"SG (left)": 1.0})], [left], 250.0)
    (tmp_path / "rows.csv").write_text("time_s,SG 1,v\ns,mV/V,km/h\n0,1,5\n0.004,2,5\n0.008,3,5\n")
    with pytest.raises(DataError, match=r"the unit is mV/V, and channel 'C1' is in ue"):
        open_records([tmp_path / "rows.csv"], [A], 250.0)
    raw = Channel("C1", "channels.csv: channel 'C1'", "SG 1", (("A", 1.0),), "", "mV/V")
    (one,), warnings = open_records([tmp_path / "rows.csv"], [raw], 250.0)
    assert one.read(raw).tolist() == [1.0, 2.0, 3.0]
    assert warnings == []
