"""Names and paths as they are given: what was meant where accents, letter case or the system of a path differ."""

import difflib
import re
import unicodedata
from dataclasses import replace
from pathlib import Path, PureWindowsPath

from fatigue.errors import Problem

PARTS_SHOWN = 3  # files of a folder named in a message

_DRIVE = re.compile(r"^[A-Za-z]:[\\/]")
_ADDRESS = re.compile(r"^[a-z][a-z0-9+.-]+:/{1,3}", re.IGNORECASE)
_JOIN = (
    'Join them: python -c "import pyarrow.dataset as d, pyarrow.parquet as p; '
    "p.write_table(d.dataset('{0}', format='parquet').to_table(), '{0}-joined.parquet')\", and give that file"
)


def composed(text: str) -> str:
    """Trimmed text in which a letter and its accent are one character (NFC), however the file spells them.

    macOS writes file names with letter and accent apart (NFD); on screen both look the same.
    """
    return unicodedata.normalize("NFC", text.strip())


def control_characters(text: str) -> str:
    r"""Say which control character a path holds: in TOML ``"C:\temp"`` is a tab; empty if it holds none."""
    names = {"\t": r"a tab (\t)", "\n": r"a line end (\n)", "\b": r"a backspace (\b)", "\f": r"a form feed (\f)"}
    names |= {"\r": r"a carriage return (\r)"}
    return next((names.get(c, f"the character {c!r}") for c in text if ord(c) < 32), "")


def missing_file(
    path: Path,
    where: str = "",
    *,
    base: Path | None = None,
    code: str = "missing_file",
    wanted: str = "a .parquet or .csv file",
) -> Problem:
    """Say what is in the place of a file that is not there: a folder, another spelling, a path of another system.

    Parameters
    ----------
    where : the place that names the file; empty: the path itself
    base : the folder that relative paths in that place begin at
    wanted : what to give instead of a folder
    """
    place = where or str(path)
    if path.is_dir():
        return _folder(path, place, wanted)
    what, remedy = _instead(path, _as_written(path, base), base)
    return Problem(code, place, (f"there is no file {path}" if where else "there is no such file") + what, remedy)


def missing_case(path: Path) -> Problem:
    """Say what is in the place of a case file that is not there."""
    if path.is_dir():
        return Problem("not_a_file", str(path), "this is a folder", "Give the path of the case.toml in it")
    found = missing_file(path)
    return replace(found, remedy="Give the path of a case.toml") if found.remedy == "Correct the path" else found


def missing_case_of_result(path: Path) -> Problem:
    """Say what is in the place of a case file that is named for a result and is not there."""
    what, remedy = "there is no such file", "Correct the path after --case"
    if path.is_dir():
        what, remedy = "this is a folder", "Give the path of the case.toml in it"
    return Problem("missing_case", str(path), what, remedy)


def missing_foreign_file(path: Path) -> Problem:
    """Say what is in the place of an FE or simulation file that is not there."""
    return missing_file(path, code="unreadable", wanted="the file itself")


def _instead(path: Path, given: Path, base: Path | None) -> tuple[str, str]:
    """Say what is peculiar about a path that leads nowhere, and what to do about it."""
    if path.is_symlink():
        return f": it is a link to {path.readlink()}, which is gone", "Give the file itself"
    if control := control_characters(str(path)):
        return f", a path with {control} in it", "Write / between folders, or put the path into single quotes"
    if found := _other_spelling(path, given):
        written = str(_as_written(found, base))
        if unicodedata.normalize("NFC", written) == unicodedata.normalize("NFC", str(given)):
            return (
                "",
                f"Rename {found.name!r}: its accents are separate characters there, or here, as macOS writes them",
            )
        return "", f"Write {written!r}"
    windows = bool(_DRIVE.search(str(given))) and not path.drive
    names = _names_in(base or path.parent) if windows else _names_in(path.parent)
    near = difflib.get_close_matches(PureWindowsPath(path).name, names, n=1)
    there = f"; {near[0]!r} is there" if near else ""
    if windows or _ADDRESS.search(str(given)):
        return ", a path of Windows" if windows else ", an address", f"Give a path of this computer{there}"
    return "" if path.parent.is_dir() else f", nor a folder {path.parent}", f"Correct the path{there}"


def _as_written(path: Path, base: Path | None) -> Path:
    """Spell a path as the place that names it does: relative to ``base`` where it lies in there."""
    return path.relative_to(base) if base is not None and path.is_relative_to(base) else path


def _folder(path: Path, place: str, wanted: str) -> Problem:
    """Describe a folder that stands where a file should; parts of a table are what Spark and Dask write."""
    files = [file for file in sorted(path.rglob("*")) if file.is_file()]
    parts = [file for file in files if file.suffix == ".parquet" and not file.name.startswith((".", "_"))]
    if parts or any(file.name == "_SUCCESS" for file in files):
        kind = f"{len(parts)} Parquet part{'s' if len(parts) != 1 else ''}, as Spark and Dask write"
        remedy = _JOIN.format(path) if parts else "Write the table again, into one file"
        return Problem("not_a_file", place, f"this is a folder of {kind}, not a file", remedy)
    shown = ", ".join(str(file.relative_to(path)) for file in files[:PARTS_SHOWN])
    inside = f" with {shown}{' ...' if len(files) > PARTS_SHOWN else ''}" if files else ""
    return Problem("not_a_file", place, f"this is a folder{inside}", f"Give {wanted}")


def _other_spelling(path: Path, given: Path) -> Path | None:
    """Find the file that is meant: another letter case or normal form, backslashes, a home folder not written out."""
    candidates = [path, Path(str(path).replace("\\", "/"))]
    if str(given).startswith("~"):
        candidates.append(Path(str(given).replace("\\", "/")).expanduser())
    return next((found for candidate in candidates if (found := _alike(candidate)) is not None), None)


def _alike(path: Path) -> Path | None:
    """Find a path whose parts are those of ``path`` but for letter case, blanks around them and normal form."""
    if path.exists():
        return path
    if path.parent == path:
        return None
    parent = _alike(path.parent)
    if parent is None or not parent.is_dir():
        return None
    wanted = composed(path.name).casefold()
    return next((parent / name for name in _names_in(parent) if composed(name).casefold() == wanted), None)


def _names_in(folder: Path) -> list[str]:
    """Names in a folder, none where it cannot be listed."""
    try:
        return sorted(entry.name for entry in folder.iterdir())
    except OSError:
        return []
