"""The shipped car body, and tables to fill in, copied to where the user wants them."""

import shutil
from pathlib import Path

from fatigue.errors import DataError, Problem, given_path
from fatigue.files.mishaps import refused_writing
from fatigue.files.whole import staged


def write_example(folder: Path | str, *, force: bool = False) -> list[Path]:
    """Copy the shipped case and its data into a folder; return the case files.

    Raises
    ------
    DataError : the folder holds files of the same names and ``force`` is not given, or it cannot be written
    """
    folder = given_path(folder, "folder")
    _copy(_shipped("carbody"), folder, force=force)
    return sorted(folder.glob("case*.toml"))


def write_templates(folder: Path | str, *, force: bool = False) -> list[Path]:
    """Copy the tables to fill in from a standard, which hold none of its values, into a folder; return them.

    Raises
    ------
    DataError : as ``write_example``
    """
    folder = given_path(folder, "folder")
    return [folder / name for name in _copy(_shipped("templates"), folder, force=force)]


_REQUESTS = {"abaqus": "abaqus_export.py", "ansys": "ansys_export.mac", "nastran": "nastran_cards.bdf"}


def request_text(solver: str) -> str:
    """Text that asks a solver, "abaqus", "ansys" or "nastran", for element nodal forces: a script, a macro, cards."""
    return (_shipped("requests") / _REQUESTS[solver]).read_text("utf-8")


def write_request(solver: str, file: Path) -> None:
    """Write ``request_text`` to a file.

    Raises
    ------
    DataError : the file cannot be written
    """
    with refused_writing(file):
        file.write_text(request_text(solver), "utf-8")


def _copy(shipped: Path, folder: Path, *, force: bool) -> list[str]:
    """Copy the files of one folder into another, all or none; returns their names."""
    names = sorted(path.name for path in shipped.iterdir())
    taken = [name for name in names if (folder / name).exists()]
    if taken and not force:
        raise DataError(
            Problem(
                "foreign_files",
                str(folder / taken[0]),
                "is there already",
                "Give another folder, or --force to overwrite it",
            )
        )
    with staged(folder, ".example-") as stage:
        for name in names:
            with refused_writing(folder / name):
                shutil.copy2(shipped / name, stage / name)
        for file in sorted(stage.iterdir()):
            file.replace(folder / file.name)
    return names


def _shipped(name: str) -> Path:
    """Find what is shipped: inside the installed package, or beside it in a checkout."""
    package = Path(__file__).parent
    installed = package / "data" / name
    return installed if installed.is_dir() else package.parent / "data" / name
