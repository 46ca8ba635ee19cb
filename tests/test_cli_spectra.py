"""What the command line says of load spectra, and what it refuses."""

import json

import pandas as pd
import pyarrow.parquet as pq
import pytest

from fatigue.results import LOAD_SPECTRA
from tests.command_line import assess, fatigue
from tests.small_case import small_case


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    """A result of its own, with its page."""
    folder = tmp_path_factory.mktemp("cli")
    assess(small_case().write(folder / "case"), "-o", folder / "result")
    fatigue("report", folder / "result")
    return folder / "result"


def test_spectra_are_told_written_and_drawn(result, tmp_path):
    """Words for people, JSON for machines, tables, figures on the page, CSV that follows the tables."""
    (tmp_path / "m.csv").write_text("range_MPa,count\n60,10\n")
    page = (result / "report.html").read_text(encoding="utf-8")
    done = fatigue("spectra", result, "--threads", "1")
    assert done.returncode == 0, done.stderr
    assert "load spectra of the worst point of every weld, 2, 64 classes" in done.stdout
    assert "(mission)" in done.stdout
    for name in LOAD_SPECTRA:
        assert all(f.metadata[b"unit"] for f in pq.read_schema(result / f"{name}.parquet"))
    new = (result / "report.html").read_text(encoding="utf-8")
    assert "weld-1-load-spectrum" in new
    assert "weld-1-load-spectrum" not in page
    assert fatigue("report", result, "--csv").returncode == 0
    assert len(pd.read_csv(result / "spectrum.csv")) == 2 * 4 * 64
    options = ("--classes", "8", "--exponents", "3,5", "--compare", tmp_path / "m.csv", "--compare-km", "10")
    done = fatigue("spectra", result, *options, "--json")
    found = json.loads(done.stdout)
    assert [event["event"] for event in found["at_points"][0]["events"]][-2:] == ["(mission)", "(measured)"]
    assert found["exponents"] == [3.0, 5.0]
    assert [warning["code"] for warning in found["warnings"]] == ["measured_point", "measured_ratio"]
    assert done.stderr.count("names no point") == 1
    assert len(pd.read_csv(result / "spectrum.csv")) == 2 * 5 * 8
    assert (result / "report.html").read_text(encoding="utf-8").count("m.csv</bdi>: names no point") == 2
    assert "damage of (measured) / (mission)" in fatigue("spectra", result, *options).stdout
    assert fatigue("verify", "--results", result, "--sample", "2").returncode == 0
    assert fatigue("show", result).returncode in {0, 1}


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        (("--classes", "0"), 2, "Invalid value for '--classes'"),
        (("--exponents", "3;5"), 2, "is not a list of numbers"),
        (("--exponents", "0"), 2, "is not a list of numbers"),
        (("--compare", "m.csv"), 2, "--compare and --compare-km belong together"),
        (("--compare-km", "5"), 2, "--compare and --compare-km belong together"),
        (("--points", "none.csv"), 3, "none.csv: there is no such file"),
        (("--edges", "none.csv"), 3, "none.csv: there is no such file"),
    ],
)
def test_mistakes_are_one_line(result, options, code, words):
    """Wrong usage is 2, what is not there is 3."""
    done = fatigue("spectra", result, *options)
    assert done.returncode == code
    assert words in done.stderr


def test_a_folder_without_result(tmp_path):
    """Nothing to list."""
    done = fatigue("spectra", tmp_path)
    assert done.returncode == 3
    assert "no finished result in this folder" in done.stderr
