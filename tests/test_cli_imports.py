"""What a command does not need it does not import: of the large packages, those that take most of a short run."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.small_case import small_case

ROOT = Path(__file__).parents[1]
RUN = """
import json, sys
from tests.command_line import fatigue
done = fatigue(*json.loads(sys.argv[1]))
print(json.dumps([done.returncode, done.stderr, sorted(sys.modules)]))
"""
NUMBERS = {"numba", "scipy"}
PAGES = {"plotly", "jinja2"}
SELDOM = {"matplotlib", "scipy.optimize", "scipy.stats", "scipy.signal", "scipy.interpolate", "xlsxwriter", "h5py"}


def imported(*arguments):
    """Modules that a command leaves in a process of its own."""
    done = subprocess.run(
        [sys.executable, "-c", RUN, json.dumps([str(argument) for argument in arguments])],
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=True,
    )
    code, said, modules = json.loads(done.stdout)
    assert code in (0, 1), said
    return set(modules)


def test_show_reads_tables_and_nothing_else(small_result):
    """No loops are compiled or loaded, no case is read."""
    assert not imported("show", small_result) & (NUMBERS | PAGES | SELDOM | {"pydantic", "email"})


@pytest.mark.parametrize("command", ["check", "assess"])
def test_numbers_without_pages(command, tmp_path):
    """A case is checked and assessed without what draws figures or fits curves."""
    case = small_case(seconds=6.0).write(tmp_path / "case")
    more = () if command == "check" else ("-o", tmp_path / "result", "--no-report")
    assert not imported("-q", command, case, *more) & (PAGES | SELDOM)


def test_a_report_does_without_the_objects_of_plotly(small_result, tmp_path):
    """Of plotly it takes the script only: its objects, which check every attribute, are for notebooks and tests."""
    folder = shutil.copytree(small_result, tmp_path / "result")
    assert not imported("-q", "report", folder) & (SELDOM | {"plotly.graph_objs", "plotly.graph_objects", "narwhals"})
