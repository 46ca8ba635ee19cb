"""The types of the public names as a user's own type checker sees them."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]

SCRIPT = '''
from pathlib import Path
from typing import assert_type

import fatigue
from fatigue.assess import Assessment, assess
from fatigue.case import Case
from fatigue.diagnose import diagnose
from fatigue.errors import FatigueError
from fatigue.life.counting.rainflow import Cycles
from fatigue.report import figures
from fatigue.report.page import write_report
from fatigue.results.summary import Summary


def main(case_file: str, folder: Path) -> None:
    """Use paths and texts alike."""
    assert_type(fatigue.load_case(case_file), Case)
    assert_type(assess(case_file, str(folder), report=False), Assessment)
    assert_type(assess(fatigue.load_case(Path(case_file)), folder), Assessment)
    assert_type(fatigue.result_summary(str(folder)), Summary)
    assert_type(fatigue.rainflow([0.0, 3.0, -1.0], "repeat"), Cycles)
    assert_type(fatigue.__version__, str)
    assert_type(write_report(str(folder), case_file), Path)
    print(fatigue.check_case(case_file), fatigue.recount(str(folder), case_file=case_file), diagnose(str(folder)))
    result: fatigue.Result = fatigue.open_result(str(folder), case_file=case_file)
    assert_type(result, fatigue.Result)
    result.history("W", 3, event="tangent", instants="file").to_csv("history.csv")
    result.cycles("W", node=17, surface="top").describe()
    result.figure("sn", "W").show()
    assert_type(result.fulfilled, bool)
    figures.weld_lives(fatigue.read_table(folder, "welds"), 1e7)
    try:
        fatigue.rainflow([0.0], "never")  # wrong
        fatigue.read_table(3, "nodes")  # wrong
        fatigue.nothing()  # wrong
        result.figure("picture")  # wrong
        result.history("W", "3")  # wrong
    except FatigueError as error:
        print(error)
'''


def test_a_script_of_a_user_is_checked_strictly(tmp_path):
    """Its five mistakes are found, and nothing else."""
    path = tmp_path / "script.py"
    path.write_text(SCRIPT)
    command = [sys.executable, "-m", "mypy", str(path)]  # settings of the house: one cache, which neither spoils
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    found = [line for line in done.stdout.splitlines() if ": error:" in line]
    wrong = [number for number, line in enumerate(SCRIPT.splitlines(), start=1) if line.endswith("# wrong")]
    assert [int(line.removeprefix(str(path)).split(":")[1]) for line in found] == wrong, done.stdout
