"""A copy of the tree in which one file after the other is spoilt, and what its tests say."""

import ast
import importlib
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
import traceback
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Literal

import coverage
import pytest
from numba.core import config

from tests.mutation.mutants import Mutant

ROOT = Path(__file__).parents[2]
DATE = 1_000_000_000  # from which the dates of files are counted, far in the past: machine code has to be younger
MEMORY, FILE = 12 << 30, 1 << 30  # bytes that a mutant may take
LOOPS = ("weld", "life", "spectrum")  # rooms with machine code
IN_CODE = ("compiled", "inlined", "overload", "intrinsic")  # what makes machine code of a function
LOADED = ("scipy.linalg", "scipy.signal", "scipy.special", "pandas", "pyarrow.parquet", "pydantic", "hypothesis")
Verdict = Literal["killed", "hang", "survived"]


@dataclass(frozen=True, slots=True)
class Tree:
    """Folder of the copy, of the machine code of the sound tree, and of that which one mutant uses."""

    root: Path
    sound_code: Path
    used_code: Path


def copy_of_tree(folder: Path) -> Tree:
    """The files of this checkout in a folder, what is not in version control yet included."""
    for name in LOADED:  # once for all mutants: each is tried in a fork
        importlib.import_module(name)
    listed = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    names = subprocess.run(listed, cwd=ROOT, capture_output=True, text=True, check=True).stdout.split("\0")
    tree = Tree(folder / "tree", folder / "sound_code", folder / "used_code")
    changed: list[str] = []
    for name in filter(None, names):
        source, target = ROOT / name, tree.root / name
        if source.is_file() and not (target.exists() and target.read_bytes() == source.read_bytes()):
            target.parent.mkdir(parents=True, exist_ok=True)
            _write(target, source.read_bytes())
            changed.append(name)
    if any(name.startswith("fatigue/") for name in changed):
        shutil.rmtree(tree.sound_code, ignore_errors=True)
    for known in folder.glob("reached_*.json") if changed else ():  # what an earlier run found holds no longer
        known.unlink()
    tree.sound_code.mkdir(exist_ok=True)
    return tree


def _write(path: Path, content: bytes) -> None:
    """Write a file under a date that its content makes: compiled code is told by date and size alone."""
    path.write_bytes(content)
    date = DATE + zlib.crc32(content) % 10**8
    os.utime(path, (date, date))


def files_by_line(tree: Tree, room: str, silent_s: float) -> dict[str, dict[int, list[str]]]:
    """Run the tests of a room on the sound tree: the test files that reach each line of each module.

    The run compiles the loops. It is made once for a copy; a failure ends the program.
    """
    kept = tree.root.with_name(f"reached_{room}.json")
    if not kept.exists():
        data = tree.root / ".coverage"
        measured = [f"--cov=fatigue/{room}", "--cov-context=test", "--cov-report=", f"tests/{room}"]
        if _run(tree, tree.sound_code, measured, silent_s) != "survived":
            raise SystemExit(f"tests/{room} fails without any mutant: {tree.root / 'said.txt'}")
        found = coverage.CoverageData(str(data))
        found.read()
        reached = {
            str(Path(path).relative_to(tree.root.resolve())): {
                line: sorted({context.split("::")[0] for context in contexts if context})
                for line, contexts in found.contexts_by_lineno(path).items()
            }
            for path in found.measured_files()
        }
        kept.write_text(json.dumps(reached))
        data.unlink()
    stored = json.loads(kept.read_text())
    return {module: {int(line): files for line, files in lines.items()} for module, lines in stored.items()}


@cache
def sound_nearby(tree: Tree, module: str, silent_s: float) -> list[list[str]]:
    """Test files near a module; the first of them pass on the sound tree."""
    files = nearby(tree.root, module)
    if _run(tree, tree.sound_code, files[0], silent_s) != "survived":
        raise SystemExit(f"{files[0]} fail without any mutant: {tree.root / 'said.txt'}")
    return files


def tried(tree: Tree, mutant: Mutant, selection: list[list[str]], silent_s: float) -> Verdict:
    """What the tests say of a mutant, one selection of files after the other."""
    shutil.rmtree(tree.used_code, ignore_errors=True)
    shutil.copytree(tree.sound_code, tree.used_code)
    _remove_code_that_contains(tree, mutant.module)
    verdict: Verdict = "survived"
    with _spoilt(tree.root / mutant.module, mutant.text):
        for files in selection:
            verdict = _run(tree, tree.used_code, files, silent_s)
            if verdict != "survived":
                break
    _remove_code_that_contains(tree, mutant.module)  # what is left was compiled of sound files
    shutil.copytree(tree.used_code, tree.sound_code, dirs_exist_ok=True)
    return verdict


def stages(root: Path, module: str, reaching: list[str] | None) -> list[list[str]]:
    """Test files of a mutant: that of its module by itself, then all that reach it, nearest first; None: the room."""
    room, *inner = Path(module).relative_to("fatigue").parts
    near = Path("tests", room, *inner)
    everywhere = sorted(str(p.relative_to(root)) for p in (root / "tests" / room).rglob("test_*.py"))
    own = [f for f in everywhere if Path(f).name == f"test_{near.name}" and near.is_relative_to(Path(f).parent)]
    others = [f for f in everywhere if f not in own and (reaching is None or f in reaching)]
    others.sort(key=lambda f: -len(os.path.commonpath([f, near])))
    return [files for files in (own, others) if files]


def nearby(root: Path, module: str) -> list[list[str]]:
    """Test files of a module by itself, then those of its room that import it; where there is neither, its folder's."""
    near = Path("tests", *Path(module).relative_to("fatigue").parts)
    every = [f for files in stages(root, module, None) for f in files]
    own = [f for f in every if Path(f).name == f"test_{near.name}" and near.is_relative_to(Path(f).parent)]
    name = ".".join(Path(module).with_suffix("").parts).removesuffix(".__init__")
    users = [f for f in every if f not in own and name in _imported(root / f)]
    folder = next(p for p in near.parents if any((root / p).glob("test_*.py")))
    found = [files for files in (own, users) if files]
    return found or [[f for f in every if Path(f).parent == folder]]


def reaching(path: Path, line: int, reached: dict[int, list[str]]) -> list[str] | None:
    """Give the test files that reach the function of a line; None for machine code and what all files load."""
    around = [n for n in ast.walk(ast.parse(path.read_text())) if isinstance(n, ast.FunctionDef)]
    around = [n for n in around if n.lineno <= line <= (n.end_lineno or 0)]
    if not around or any(mark in ast.unparse(d) for n in around for d in n.decorator_list for mark in IN_CODE):
        return None
    if line < around[-1].body[0].lineno or any(mark in path.read_text() for mark in ("llvmlite", "numba.extending")):
        return None
    lines = range(around[-1].body[0].lineno, (around[-1].end_lineno or 0) + 1)
    return sorted({f for n in lines for f in reached.get(n, [])})


@contextmanager
def _spoilt(path: Path, text: str) -> Iterator[None]:
    """Hold a mutant in place of a file."""
    sound = path.read_bytes()
    try:
        _write(path, text.encode())
        yield
    finally:
        _write(path, sound)


def _run(tree: Tree, code: Path, selection: list[str], silent_s: float) -> Verdict:
    """Run tests in a fork until one fails; without a word for ``silent_s`` seconds they are ended."""
    shutil.rmtree(tree.root / ".hypothesis", ignore_errors=True)  # examples found with another mutant
    said = tree.root / "said.txt"
    said.write_bytes(b"")
    child = os.fork()
    if child == 0:
        _test(tree.root, code, selection, said)
    size, since, status = 0, time.monotonic(), None
    try:
        while not (ended := os.waitpid(child, os.WNOHANG))[0]:
            time.sleep(0.05)
            if said.stat().st_size != size:
                size, since = said.stat().st_size, time.monotonic()
            if time.monotonic() - since > silent_s:
                return "hang"
        status = os.waitstatus_to_exitcode(ended[1])
    finally:  # also where somebody interrupts the program
        if status is None:
            os.killpg(child, signal.SIGKILL)
            os.waitpid(child, 0)
    return "survived" if status in (0, 5) else "killed"  # 5: no test there


def _test(root: Path, code: Path, selection: list[str], said: Path) -> None:
    """Become a process that tests the tree, and end."""
    status = 1
    try:
        os.setsid()
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_FSIZE, (FILE, FILE))
        out = os.open(said, os.O_WRONLY | os.O_APPEND)
        os.dup2(out, 1)
        os.dup2(out, 2)
        os.chdir(root)
        os.environ |= {"PYTHONPATH": str(root), "NUMBA_CACHE_DIR": str(code)}
        config.CACHE_DIR = str(code)
        for name in [n for n in sys.modules if n.split(".")[0] in ("tests", "fatigue")]:
            del sys.modules[name]
        sys.path[:] = [str(root), *(p for p in sys.path if p and Path(p).resolve() != ROOT)]
        quietly = ["-W", "ignore::pytest.PytestAssertRewriteWarning"]  # plugins are loaded before
        asked = ["-x", "-q", "-p", "no:cacheprovider", "--hypothesis-seed=0", *quietly, *selection]
        status = int(pytest.main(asked))
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


def _remove_code_that_contains(tree: Tree, module: str) -> None:
    """Remove the machine code of a module and of all that import it: numba looks only at the file of the function."""
    imports = _imports_of_loops(tree)
    names = {path: ".".join(path.relative_to(tree.root).with_suffix("").parts) for path in imports}
    stale = {tree.root / module}
    while more := {p for p, seen in imports.items() if p not in stale and seen & {names.get(s) for s in stale}}:
        stale |= more
    for path in stale:
        for kept in tree.used_code.glob(f"{path.parent.name}_*/{path.stem}.*"):
            kept.unlink()


@cache
def _imports_of_loops(tree: Tree) -> dict[Path, set[str]]:
    """Give the modules that each file of the rooms with machine code imports."""
    return {path: _imported(path) for room in LOOPS for path in (tree.root / "fatigue" / room).rglob("*.py")}


def _imported(path: Path) -> set[str]:
    """Give the modules that a file names in its imports."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    return found
