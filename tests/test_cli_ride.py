"""What the command line says of a ride, and what it refuses."""

import json

import pandas as pd
import pyarrow.parquet as pq
import pytest

from fatigue.results import RIDDEN
from fatigue.results.summary import result_summary
from fatigue.verify.recount import recount
from tests.command_line import assess, fatigue
from tests.ride.ride_case import CHANNEL, ride_case, with_channels


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    """A result without channels, with its page."""
    folder = tmp_path_factory.mktemp("cli")
    assess(ride_case().write(folder / "case"), "-o", folder / "result")
    fatigue("report", folder / "result")
    return folder / "result"


def test_no_channels_is_exit_code_3(result):
    """One line that says how to give some, for this very case."""
    done = fatigue("ride", result)
    assert done.returncode == 3
    assert done.stdout == ""
    (line,) = [line for line in done.stderr.splitlines() if line.startswith("error: ")]
    assert line.startswith("error: case.toml: no event has a channel")
    assert 'channel = [{ name = "bogie y", column = "a_bogie", unit = "m/s2"' in line


def test_the_ride_is_told_and_written(result, tmp_path):
    """Words for people, JSON for machines, tables with units, a page written again, CSV that follows the tables."""
    channels = tmp_path / "case.toml"
    own = result.parent / "case" / "with_channels.toml"
    own.write_text((result.parent / "case" / "case.toml").read_text())
    with_channels(own, CHANNEL)
    done = fatigue("ride", result, "--case", own, "--threads", "1")
    assert done.returncode == 0, done.stderr
    assert "hunting of 'bogie y': 1 hot stretch" in done.stdout
    assert "no alarm is not no damage" in done.stdout
    for name in RIDDEN:
        assert all(field.metadata[b"unit"] for field in pq.read_schema(result / f"{name}.parquet"))
    assert fatigue("report", result, "--csv").returncode == 0
    assert len(pd.read_csv(result / "hot_damage.csv")) == 2
    done = fatigue("ride", result, "--case", own, "--json")
    found = json.loads(done.stdout)
    assert found["alarm"][0]["told"] == "missed"
    assert found["alarm"][0]["first_alarm_s"] is None
    assert {"flutter", "coincidence", "alarm", "hot_damage", "comfort", "equipment", "running"} <= found.keys()
    assert recount(result, sample=2).passed
    assert result_summary(result, top=2).as_text()
    channels.write_text(own.read_text().replace("share = 1.0", "share = 1.0\nstress_factor = 2.0"))
    done = fatigue("ride", result, "--case", channels)
    assert done.returncode == 3
    assert "is not the case of this result" in done.stderr


def test_a_page_of_somebody_else_stays(result):
    """It is said, and the tables are written all the same."""
    own = with_channels(result.parent / "case" / "case.toml", CHANNEL)
    (result / "report.html").write_text("mine")
    done = fatigue("ride", result)
    assert done.returncode == 0, done.stderr
    assert "was not written by fatigue, or was changed since: it stays as it is" in done.stderr
    assert (result / "report.html").read_text() == "mine"
    assert own.exists()


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (("--threads", "0"), 2, "Invalid value for '--threads'"),
        (("--case", "none.toml"), 3, "none.toml: there is no such file"),
    ],
)
def test_mistakes_are_one_line(result, arguments, code, words):
    """Wrong usage is 2, what is not there is 3."""
    done = fatigue("ride", result, *arguments)
    assert done.returncode == code
    assert words in done.stderr


def test_a_folder_without_a_result(tmp_path):
    """Exit code 3, and the command that makes one."""
    done = fatigue("ride", tmp_path)
    assert done.returncode == 3
    assert "no finished result in this folder" in done.stderr
