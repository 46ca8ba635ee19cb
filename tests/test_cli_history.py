"""``fatigue history`` as a user meets it: what it prints and writes, exit codes, and its mistakes."""

import json

import pandas as pd
import pytest

from fatigue.cli.commands.history import ENDINGS
from fatigue.point.formats import FORMATS
from tests.command_line import fatigue
from tests.point.cases import cornered, plain, result_of


@pytest.fixture(scope="module")
def corner(tmp_path_factory):
    """Result of a weld in two parts."""
    folder = tmp_path_factory.mktemp("corner")
    return result_of(cornered(folder / "case"), folder / "result")


def test_it_writes_and_says_what(small_result, tmp_path):
    """The file, the point, the extremes of every event, the columns; stages on stderr."""
    done = fatigue("history", small_result, "--weld", "A", "--order", 3, "-o", tmp_path / "a.csv")
    assert done.returncode == 0, done.stderr
    table = pd.read_csv(tmp_path / "a.csv")
    lines = done.stdout.splitlines()
    assert lines[0] == f"{tmp_path / 'a.csv'}: {len(table)} samples of 3 events at the instants that were counted"
    assert lines[1] == "Weld A, part 1, order 3, node 102; stresses in MPa"
    assert lines[3].split() == [
        "event", "samples", "from_s", "to_s", "upsample",
        "top_min", "top_max", "top_range", "bottom_min", "bottom_max", "bottom_range",
    ]  # fmt: skip
    assert lines[4].split()[:2] == ["sine", "2400"]
    largest = pd.read_parquet(small_result / "damage.parquet").query("weld == 'A' and order == 3 and surface == 'top'")
    assert float(lines[4].split()[7]) == pytest.approx(largest["max_range_MPa"].iloc[0], rel=1e-3)
    assert lines[-2] == "Columns: " + ", ".join(table.columns)
    assert "writing the history: done in" in done.stderr


def test_for_machines_and_in_silence(small_result, tmp_path):
    """The same as a record; with -q nothing on stderr."""
    done = fatigue("-q", "history", small_result, "--weld", "B", "--json", "-o", tmp_path / "a.parquet")
    found = json.loads(done.stdout)
    assert done.stderr == ""
    assert (found["weld"], found["part"], found["node"], found["toe"]) == (
        "B",
        1,
        found["node"],
        {"top": True, "bottom": False},
    )
    assert (
        found["samples"] == len(pd.read_parquet(tmp_path / "a.parquet")) == sum(e["samples"] for e in found["events"])
    )
    assert found["columns"][:3] == ["event", "time_s", "membrane_MPa"]


def test_a_face_without_toe_is_told(small_result, tmp_path):
    """It keeps its history all the same."""
    done = fatigue("history", small_result, "--weld", "B", "--order", 2, "-o", tmp_path / "a.csv")
    assert "(no weld toe on the bottom face)" in done.stdout


def test_a_part_where_two_share_the_order(corner, tmp_path):
    """Is asked for, and taken."""
    given = ("history", corner, "--weld", "A", "--order", 4, "-o", tmp_path / "a.csv")
    done = fatigue(*given)
    assert done.returncode == 3
    assert (
        "error: weld 'A': the parts 1, 2 share the order 4, at a corner where the line is split. Give the"
        in done.stderr
    )
    assert fatigue(*given, "--part", 2).returncode == 0


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (("--weld", "A", "-o", "a.xlsx"), 2, "'a.xlsx' does not end in .csv, .parquet, .mat."),
        (("--weld", "A"), 2, "Missing option '-o'"),
        (("-o", "a.csv"), 2, "Missing option '--weld'"),
        (("--weld", "A", "--order", "x", "-o", "a.csv"), 2, "'x' is not a valid integer"),
        (("--weld", "A", "--instants", "all", "-o", "a.csv"), 2, "'all' is not one of 'counted', 'file'"),
        (("--weld", "AA", "-o", "a.csv"), 3, "the result has no weld 'AA'. Name 'A'."),
        (("--weld", "A", "--order", "12", "-o", "a.csv"), 3, "weld 'A': has no order 12. Take one of its orders"),
        (("--weld", "A", "--event", "sin", "-o", "a.csv"), 3, "the mission has no event 'sin'. Name 'sine'."),
        (("--weld", "A", "--case", "no.toml", "-o", "a.csv"), 3, "no.toml: there is no such file"),
    ],
)
def test_mistakes(small_result, tmp_path, arguments, code, words):
    """In one line, with the right exit code, and no file."""
    done = fatigue("history", small_result, *arguments, cwd=tmp_path)
    assert (done.returncode, done.stdout) == (code, "")
    assert words in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_folder_without_result_and_a_file_in_the_way(small_result, tmp_path):
    """Both are told before anything is read."""
    done = fatigue("history", tmp_path, "--weld", "A", "-o", "a.csv")
    assert done.returncode == 3
    assert "no finished result in this folder" in done.stderr
    (tmp_path / "a.csv").write_text("mine")
    given = ("history", small_result, "--weld", "A", "-o", tmp_path / "a.csv")
    done = fatigue(*given)
    assert done.returncode == 3
    assert "a.csv: is there already. Give another file with -o, or --force to overwrite it." in done.stderr
    assert (tmp_path / "a.csv").read_text() == "mine"
    assert fatigue(*given, "--force").returncode == 0


def test_inputs_that_changed(tmp_path):
    """Are refused, as the history would be of something else."""
    folder = result_of(plain(2.0).write(tmp_path / "case"), tmp_path / "result")
    forces = tmp_path / "case" / "nodal_forces.csv"
    forces.write_text(forces.read_text() + "\n")
    done = fatigue("history", folder, "--weld", "A", "-o", tmp_path / "a.csv")
    assert done.returncode == 3
    assert "nodal_forces.csv" in done.stderr
    assert not (tmp_path / "a.csv").exists()


def test_the_command_knows_the_formats():
    """Those that are written."""
    assert tuple(FORMATS) == ENDINGS
