"""What a result rests on: its record, the hashes of its inputs, the versions of the software."""

import json
import platform
from collections.abc import Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from fatigue import __version__
from fatigue.errors import DataError, Problem, given_path
from fatigue.files.hashes import sha256

PROVENANCE = "provenance.json"  # a folder without it holds no finished result
JOURNAL = ".fatigue-publish"  # says that a finished result is being put in place, see `fatigue.results.publish`


def read_provenance(folder: Path | str) -> dict[str, Any]:
    """Read ``provenance.json`` of a result folder.

    Raises
    ------
    DataError : the folder holds no finished result
    """
    folder = given_path(folder, "folder")
    path = folder / PROVENANCE
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        what, remedy = "no finished result in this folder", "Run `fatigue assess CASE -o DIR` first and give its DIR"
        if (folder / JOURNAL).exists():
            what = "no finished result in this folder: a new one was being put in place when the program was stopped"
            remedy = "Run the same `fatigue assess` again, or `fatigue show`, which completes it"
        raise DataError(Problem("no_result", str(folder), what, remedy)) from None
    except (json.JSONDecodeError, UnicodeDecodeError, OSError) as error:
        problem = Problem("damaged_result", str(path), f"cannot be read ({error})", "Run the assessment again")
        raise DataError(problem) from None
    if not isinstance(record, dict) or record.get("program") != "fatigue":
        raise DataError(
            Problem("no_result", str(path), "was not written by fatigue", "Give a folder that `fatigue assess` wrote")
        )
    return record


def input_register(paths: Sequence[Path], root: Path) -> list[dict[str, Any]]:
    """Name, size and SHA-256 of every input file, so that a result can be traced to its inputs."""
    return [{"file": _relative(path, root), "bytes": path.stat().st_size, "sha256": sha256(path)} for path in paths]


def software_versions() -> dict[str, str]:
    """Versions of the program and of what its numbers rest on."""
    packages = ("numpy", "scipy", "numba", "pyarrow", "pandas", "rainflow")
    found = {"fatigue": __version__, "python": platform.python_version()}
    for package in packages:
        try:
            found[package] = version(package)
        except PackageNotFoundError:  # an optional peer that is not installed has no say in the numbers
            continue
    return found


def _relative(path: Path, root: Path) -> str:
    """Name a file as its case does, ``root / name`` is where it is: also through links and from another folder."""
    for path_there, root_there in ((path, root), (path.resolve(), root.resolve())):
        if path_there.is_relative_to(root_there):
            return path_there.relative_to(root_there).as_posix()
    return path.as_posix()  # an input elsewhere on the disk keeps its full path
