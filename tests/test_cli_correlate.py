"""``fatigue gauges correlate``: from files to verdicts, tables and exit code, and every bad input with its message."""

import json

import numpy as np
import pandas as pd
import pytest

from tests.command_line import fatigue
from tests.gauges.correlated.measured_case import EVENT, KM, measured_case


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Case, gauges, channels and a sound record."""
    made = measured_case(tmp_path_factory.mktemp("case"))
    made.channels()
    made.record()
    return made


def correlate(made, *more, channels="channels.csv", record="ride.parquet", km=KM, event=EVENT):
    """Call the command in the folder of the case."""
    distance = [] if km is None else ["--km", km]
    files = ["--gauges", "gauges.csv", "--channels", channels, "--records", record]
    return fatigue("gauges", "correlate", "case.toml", *files, "--event", event, *distance, *more, cwd=made.folder)


def test_a_sound_record_ends_with_0_and_says_what_it_rests_on(made, tmp_path):
    """Verdicts, case line, band, distance, k and files on stdout; doubts on stderr."""
    done = correlate(made, "-o", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    for said in (
        "C1",
        "good",
        "Damage ratio over 3 judged gauges",
        "geometric mean 1",
        "k = 3.6085",
        "0 to below 18 Hz",
    ):
        assert said in done.stdout
    assert "sign of 3 of 3 channels was not checked" in done.stderr
    assert (tmp_path / "out" / "correlation.html").exists()
    assert list((tmp_path / "out").glob("*.csv")) == []


def test_a_case_behind_the_records_is_told_where_it_belongs(made, tmp_path):
    """What follows ``--records FILE`` is a record."""
    files = ["--gauges", "gauges.csv", "--channels", "channels.csv", "--event", EVENT, "-o", tmp_path / "out"]
    done = fatigue(
        "gauges", "correlate", "--records", "ride.parquet", "b.parquet", "case.toml", *files, cwd=made.folder
    )
    assert done.returncode == 2
    assert "CASE stands first" in done.stderr


def test_several_records_follow_the_option(made, tmp_path):
    """``--records a b`` and ``--records a --records b`` are the same; tables as CSV, JSON for machines."""
    made.record("second")
    one = correlate(made, "second.parquet", "-o", tmp_path / "one", "--json", "--csv", km=2 * KM)
    two = correlate(made, "--records", "second.parquet", "-o", tmp_path / "two", "--json", km=2 * KM)
    first, second = json.loads(one.stdout), json.loads(two.stdout)
    for said in (first, second):
        said.pop("written")
    assert first == second
    assert first["agrees"] is True
    assert first["gauges"][0]["km"] == pytest.approx(2 * KM)
    assert first["gauges"][0]["lag_s"] is None
    table = pd.read_csv(tmp_path / "one" / "correlation.csv")
    assert table["verdict"].tolist() == ["good"] * 3


def test_a_poor_gauge_and_a_wrong_sign_end_with_1(made, tmp_path):
    """Everything is written all the same."""
    made.record("poor", strain=made.strain * np.array([[1.0], [1.4], [1.0]]))
    made.record("flipped", strain=made.strain * np.array([[1.0], [1.0], [-1.0]]))
    poor = correlate(made, "-o", tmp_path / "poor", record="poor.parquet")
    assert poor.returncode == 1
    assert "poor" in poor.stdout
    flipped = correlate(made, "-o", tmp_path / "sign", "--align", "lag", "--max-lag", "0.1", record="flipped.parquet")
    assert flipped.returncode == 1
    assert "sign" in flipped.stdout
    assert correlate(made, "-o", tmp_path / "not", record="flipped.parquet").returncode == 0
    assert (tmp_path / "sign" / "correlation.parquet").exists()


def test_a_second_run_replaces_the_first(made, tmp_path):
    """The folder is ours; without --csv the earlier CSV files go."""
    correlate(made, "-o", tmp_path, "--csv")
    assert (tmp_path / "correlation.csv").exists()
    assert correlate(made, "-o", tmp_path).returncode == 0
    assert not (tmp_path / "correlation.csv").exists()


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (["--band", "5"], "'5' is no band such as 0.5:60, in Hz"),
        (["--band", "a:b"], "'a:b' is no band"),
        (["--band", "-1:5"], "'-1:5' is no band"),
        (["--recorded-at", "2026-05-04T10:00"], "is no time with its zone"),
        (["--km", "0"], "0.0 is not in the range x>0.0"),
        (["--max-lag", "nan"], "is not a finite number"),
        (["--align", "both"], "is not one of"),
    ],
)
def test_wrong_usage_ends_with_2(made, tmp_path, more, said):
    """Before anything is read."""
    done = correlate(made, "-o", tmp_path / "out", *more)
    assert done.returncode == 2
    assert said in done.stderr
    assert not (tmp_path / "out").exists()


def with_channels(**columns):
    """A table of channels with a mistake."""
    return lambda made: {"channels": made.channels("spoilt", **columns).name}


def with_record(**changed):
    """A record with a mistake."""
    return lambda made: {"record": made.record("spoilt", **changed).name}


def with_text(made):
    """A record in which a logger wrote a word."""
    words = ["1", "OVR", *["2"] * 998]
    table = {"time_s": np.arange(1000) / 200.0, "C1": words, "C2": 0.0, "C3": 0.0}
    pd.DataFrame(table).to_csv(made.folder / "spoilt.csv", index=False)
    return {"record": "spoilt.csv"}


def with_tdms(made):
    """A record in the format of a logger."""
    (made.folder / "spoilt.tdms").write_bytes(b"TDSm" + bytes(range(256)) * 8)
    return {"record": "spoilt.tdms"}


BACKWARDS = np.arange(2200) / 200.0 * np.where(np.arange(2200) == 1500, 0.5, 1.0)
SPOILT = {
    "spoilt.csv: column gauge, row 2: names no gauge": with_channels(gauge=["G1", "", "G3"]),
    "there is no gauge 'G22'. Write 'G2'": with_channels(gauge=["G1", "G22", "G3"]),
    "ride.parquet: column SG2: the column is missing": with_channels(file_column=["C1", "SG2", "C3"]),
    "channel 'C2' (row 2): is in V, and has no calibration": with_channels(unit=["ue", "V", "ue"]),
    "channel 'C2' (row 2): is in MPa, and the modulus": with_channels(unit=["ue", "MPa", "ue"]),
    "is sampled at 200.0123 Hz, and the simulation at 200 Hz": with_record(rate=200.0123),
    "column time_s, row 1501: the time goes from 7.495 to 3.75 s": with_record(time_s=BACKWARDS),
    "spoilt.csv: column C1, row 2: 'OVR' is not a number": with_text,
    "an NI TDMS file": with_tdms,
    "how far the records ran is not known, and every number is per km. Give --km": lambda _: {"km": None},
    "the mission has no event 'nosie'. It has 'sine'": lambda _: {"event": "nosie"},
    "gone.parquet": lambda _: {"record": "gone.parquet"},
    "there is no common band: it would go from 30 to 18 Hz": lambda _: {"more": ["--band", "30:"]},
}


@pytest.mark.parametrize("said", SPOILT)
def test_bad_input_ends_with_3_in_one_line_and_writes_nothing(made, tmp_path, said):
    """File, place, value and remedy."""
    changed = SPOILT[said](made)
    done = correlate(made, "-o", tmp_path / "out", *changed.pop("more", []), **changed)
    assert done.returncode == 3, done.stderr
    assert said in done.stderr
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "out").exists()
