"""The shipped car body, copied to where the user wants it."""

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
    folder, shipped = given_path(folder, "folder"), _shipped()
    taken = [path.name for path in sorted(shipped.iterdir()) if (folder / path.name).exists()]
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
        for file in sorted(shipped.iterdir()):
            with refused_writing(folder / file.name):
                shutil.copy2(file, stage / file.name)
        for file in sorted(stage.iterdir()):
            file.replace(folder / file.name)
    return sorted(folder.glob("case*.toml"))


def _shipped() -> Path:
    """Find the example: inside the installed package, or beside it in a checkout."""
    package = Path(__file__).parent
    installed = package / "data" / "carbody"
    return installed if installed.is_dir() else package.parent / "data" / "carbody"
