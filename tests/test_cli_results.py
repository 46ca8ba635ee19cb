"""What the command line does with a finished result: diagnose, report, verify."""

import json
import shutil
import unicodedata

import pandas as pd
import pyarrow.parquet as pq
import pytest

from tests.command_line import assess, fatigue
from tests.small_case import small_case


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    """A result of its own, to be diagnosed and reported."""
    folder = tmp_path_factory.mktemp("cli")
    assess(small_case(8.0).write(folder / "case"), "-o", folder / "result")
    return folder / "result"


def test_diagnose_says_why_and_writes_its_tables(result):
    """In words for people, as tables for everybody else; a new assessment removes what is then stale."""
    done = fatigue("-q", "diagnose", result)
    assert done.returncode == 0, done.stderr
    assert "what makes the damage" in done.stdout
    assert "lever" in done.stdout
    attribution = pd.read_parquet(result / "attribution.parquet")
    modes = attribution[attribution.kind == "mode"].groupby(["weld", "order", "surface"])["share"].sum()
    assert modes.to_numpy() == pytest.approx(1.0, rel=1e-9)
    for name in ("attribution", "track", "diagnosis", "levers"):
        assert all(f.metadata[b"unit"] for f in pq.read_schema(result / f"{name}.parquet"))
    assert json.loads(fatigue("-q", "diagnose", result, "--json", "--edges", "5,20").stdout)


def test_diagnose_refuses_senseless_edges(result):
    """Text is wrong usage; edges that do not ascend are a wrong case."""
    assert fatigue("diagnose", result, "--edges", "5;20").returncode == 2
    done = fatigue("diagnose", result, "--edges", "20,5")
    assert done.returncode == 3
    assert "does not ascend" in done.stderr


def test_report_of_a_finished_result(result):
    """Report and picture appear; the same result gives the same bytes."""
    assert fatigue("report", result, "--csv", "--force").returncode == 0
    first = (result / "report.html").read_bytes()
    assert (result / "weld_lines.vtp").exists()
    assert (result / "nodes.csv").exists()
    assert fatigue("report", result, "--csv").returncode == 3  # the tables are there already
    assert fatigue("report", result).returncode == 0
    assert (result / "report.html").read_bytes() == first


def test_a_new_assessment_removes_a_stale_diagnosis(result, tmp_path):
    """Tables of a diagnosis belong to the result they were made from."""
    shutil.copytree(result.parent, tmp_path / "copy")
    folder = tmp_path / "copy" / "result"
    (folder / "track.parquet").write_bytes(b"stale")
    assess(tmp_path / "copy" / "case" / "case.toml", "-o", folder)
    assert not (folder / "track.parquet").exists()


def test_verify_the_installation():
    """Every known value is found on this machine."""
    done = fatigue("verify")
    assert done.returncode == 0
    assert "checks passed" in done.stdout
    assert json.loads(fatigue("verify", "--json").stdout)["passed"] is True


@pytest.mark.parametrize("command", [("verify", "--results"), ("diagnose",)], ids=["verify", "diagnose"])
def test_broken_results_are_refused_in_one_line(command, result, tmp_path):
    """A wrong folder, a missing table, a truncated one: file, what is wrong, what to do; exit code 3."""
    shutil.copytree(result.parent, tmp_path / "copy")
    folder = tmp_path / "copy" / "result"

    def refusal(of) -> str:
        done = fatigue("-q", *command, of)
        assert done.returncode == 3, done.stderr
        (line,) = done.stderr.strip().splitlines()
        return line

    assert "no finished result in this folder" in refusal(tmp_path)
    path = folder / "damage.parquet"
    path.write_bytes(path.read_bytes()[:-100])
    assert "damage.parquet: was changed since it was written: it has" in refusal(folder)
    path.unlink()
    line = refusal(folder)
    assert "damage.parquet: no such result table" in line
    assert "fatigue assess" in line


def test_verify_a_result_and_find_a_spoiled_one(result, tmp_path):
    """A true result agrees; one changed life is found, with exit code 4."""
    done = fatigue("verify", "--results", result, "--all")
    assert done.returncode == 0, done.stdout
    shutil.copytree(result.parent, tmp_path / "copy")
    path = tmp_path / "copy" / "result" / "nodes.parquet"
    table = pq.read_table(path)
    lives = table.column("life_km").to_pylist()
    lives[3] *= 1.001
    at = table.schema.get_field_index("life_km")
    pq.write_table(table.set_column(at, table.schema.field(at), [lives]), path)
    done = fatigue("verify", "--results", tmp_path / "copy" / "result", "--all")
    assert done.returncode == 4
    assert "life_km" in done.stdout


def test_names_with_control_and_direction_characters(tmp_path):
    """No command sends one to the terminal or the log, or fills it with a name; tables and JSON keep the names."""
    case, evil = small_case(seconds=2.0), "A\u202eB\x1b[31m\u200b"
    for table in (case.welds, case.weld_nodes, case.nodal_forces):
        table["weld"] = table.weld.map({"A": evil, "B": "x" * 5000})
    case.events[1]["name"] = r"no\u202eise\u001b[2J\nx"
    path = case.write(tmp_path / "case")
    result = tmp_path / "result"
    runs = [
        fatigue("check", path),
        assess(path, "-o", result, "--exit-zero"),
        fatigue("show", result),
        fatigue("show", result, "--json"),
    ]
    printed = [run.stdout + run.stderr for run in runs] + [(result / "fatigue.log").read_text()]
    for text in printed:
        assert not {c for c in text if unicodedata.category(c) in ("Cc", "Cf")} - set("\n\t")
    assert r"A\u202eB\x1b[31m\u200b" in printed[2]
    assert max(map(len, printed[2].splitlines())) < 300
    assert {row["weld"] for row in json.loads(runs[3].stdout)["welds"]} == {evil, "x" * 5000}
    assert set(pq.read_table(result / "welds.parquet").column("weld").to_pylist()) == {evil, "x" * 5000}
