"""The rules of the house: lint, format, types, direction of imports, spelling, and what the start-up may cost."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


def run(*command: str) -> subprocess.CompletedProcess[str]:
    """Run a tool of this environment at the root of the project."""
    return subprocess.run([sys.executable, *command], cwd=ROOT, capture_output=True, text=True, check=False)


@pytest.mark.parametrize(
    "command",
    [
        ("-m", "ruff", "check", "."),
        ("-m", "ruff", "format", "--check", "."),
        ("-m", "mypy"),
        ("-c", "from importlinter.cli import lint_imports_command as c; c()"),
        (
            "-m",
            "codespell_lib",
            "fatigue",
            "tests",
            "README.md",
            "CHANGELOG.md",
            "CONTRIBUTING.md",
            "docs",
            "data/carbody/README.md",
        ),
    ],
    ids=["lint", "format", "types", "imports", "spelling"],
)
def test_house_rule(command):
    """Every tool is content."""
    done = run(*command)
    assert done.returncode == 0, done.stdout + done.stderr


def test_importing_the_package_and_asking_for_help_stay_cheap():
    """Neither ``import fatigue`` nor ``fatigue --help`` loads numba, pandas, plotly, pyarrow, pydantic or scipy."""
    heavy = "{'numba', 'pandas', 'plotly', 'pyarrow', 'pydantic', 'scipy', 'numpy'}"
    code = (
        "import sys, fatigue, fatigue.cli\n"
        "try:\n    fatigue.cli.cli.main(['--help'], standalone_mode=False)\nexcept SystemExit: pass\n"
        f"assert not {heavy} & set(sys.modules), {heavy} & set(sys.modules)"
    )
    done = run("-c", code)
    assert done.returncode == 0, done.stderr


def test_files_stay_readable():
    """One file per idea: none of the package grows beyond 450 lines."""
    long = {p.name: n for p in (ROOT / "fatigue").rglob("*.py") if (n := len(p.read_text().splitlines())) > 450}
    assert not long


def test_folders_stay_readable():
    """One room, one subject: no folder of the package holds more than 16 files, ``__init__`` included."""
    folders = {p.parent for p in (ROOT / "fatigue").rglob("*.py")}
    crowded = {f.name: n for f in folders if (n := len(list(f.glob("*.py")))) > 16}
    assert not crowded


def test_tests_mirror_the_package():
    """A folder of tests is named for the room it tests; sources, damaged files, a solver, benchmarks are apart."""
    apart = {"validation", "fuzz", "mutation", "mystran", "benchmarks"}
    folders = {p.parent.relative_to(ROOT / "tests") for p in (ROOT / "tests").rglob("test_*.py")}
    assert not [
        str(f)
        for f in folders
        if f.parts[:1] not in {(name,) for name in apart} and not (ROOT / "fatigue" / f).is_dir()
    ]
