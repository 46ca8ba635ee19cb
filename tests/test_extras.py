"""What the program is called on a package index, and what it says where an optional package is missing."""

import builtins
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from benchmarks import peers
from fatigue.errors import DataError
from fatigue.files.extras import REQUIREMENTS, install_command
from fatigue.pipeline.run.cluster import cluster_executor

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
FOREIGN = re.compile(r"pip3?[ \t]+install[^\n&|;]*?[ \t\"'`=]fatigue(?![\w.-])|(?<![\w-])fatigue\[\w")


def texts():
    """Every text file of the project and its content."""
    try:
        listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
        paths = [ROOT / name for name in listed.splitlines()]
    except (OSError, subprocess.CalledProcessError):  # an unpacked archive
        paths = [p for p in ROOT.rglob("*") if p.is_file() and not any(part.startswith(".") for part in p.parts)]
    for path in paths:
        try:
            yield path, path.read_text(encoding="utf-8")
        except (UnicodeDecodeError, FileNotFoundError):
            continue


def test_hints_have_the_bounds_of_the_project():
    """One list in the code, one in pyproject.toml; they do not drift apart."""
    optional = PROJECT["optional-dependencies"]
    wanted = {r for extra, requirements in optional.items() if extra not in ("dev", "docs") for r in requirements}
    assert set(REQUIREMENTS.values()) == wanted
    assert all(re.split("[<>=!~]", requirement)[0] == name for name, requirement in REQUIREMENTS.items())


def test_the_readme_has_the_bounds_of_the_project():
    """Every requirement that the README gives to pip is one of the list."""
    said = re.findall(r'"([\w-]+>=[\w.]+)"', (ROOT / "README.md").read_text(encoding="utf-8"))
    assert {"h5py", "xlsxwriter", "distributed"} <= {requirement.split(">=")[0] for requirement in said}
    assert set(said) <= set(REQUIREMENTS.values())


def test_hints_are_made_in_one_place():
    """No module of the package writes its own hint."""
    makers = [p.name for p in (ROOT / "fatigue").rglob("*.py") if "pip install" in p.read_text(encoding="utf-8")]
    assert makers == ["extras.py"]


def test_the_distribution_is_not_the_one_of_somebody_else():
    """The name is free on the package index; the extra for developers names this distribution."""
    assert PROJECT["name"] == "modal-weld-fatigue"
    assert PROJECT["scripts"] == {"fatigue": "fatigue.__main__:main"}
    own = [r for r in PROJECT["optional-dependencies"]["dev"] if "[" in r]
    assert own == [f"{PROJECT['name']}[cluster,docs,excel,matlab,nastran,recorders]"]


def test_no_text_fetches_the_package_of_somebody_else():
    """Neither code nor documentation tells pip to install the name that is taken."""
    found = [f"{path.name}: {hit[0]}" for path, text in texts() if (hit := FOREIGN.search(text))]
    assert not found


def test_a_missing_cluster_package_is_told(monkeypatch):
    """Before anything is read: the package and the command that installs it."""
    plain = builtins.__import__

    def without(name, *args, **kwargs):
        if name.startswith("distributed"):
            raise ImportError(name)
        return plain(name, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", without)
    with (
        pytest.raises(
            DataError, match=re.escape(f"distributed is not installed. Run: {install_command('distributed')}")
        ),
        cluster_executor("tcp://localhost:8786"),
    ):
        pass


@pytest.mark.parametrize("name", ["pyyeti.cyclecount", "FLife"])
def test_a_missing_package_of_the_benchmarks_is_told(name, monkeypatch):
    """Of a module in a package, too: the command that installs the package."""
    monkeypatch.setitem(sys.modules, name, None)
    package = name.split(".")[0]
    with pytest.raises(SystemExit, match=re.escape(f"{package} is missing: {install_command(package)}")):
        peers._peer(name)


@pytest.mark.parametrize(
    ("text", "is_foreign"),
    [
        ("pip " + "install fatigue", True),
        ("pip " + "install -U fatigue>=1", True),
        ("pip " + "install 'fatigue", True),
        ("fatigue" + "[nastran]", True),
        ("pip " + "install -e . && fatigue assess", False),
        ("pip " + "install modal-weld-fatigue", False),
        (install_command("h5py"), False),
    ],
)
def test_what_counts_as_foreign(text, is_foreign):
    """The search above finds what it should."""
    assert bool(FOREIGN.search(text)) == is_foreign
