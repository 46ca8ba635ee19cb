"""Mistakes in paths and names, told before anything heavy is imported in the words of those who read the files."""

import difflib
from collections.abc import Iterable
from pathlib import Path

from fatigue.errors import CaseError, DataError, Problem, refuse
from fatigue.files.naming import missing_case, missing_case_of_result, missing_file, missing_foreign_file


def refuse_missing_case(path: Path) -> None:
    """Refuse a case file that is not there, as ``fatigue.case.load_case`` does."""
    if path.is_dir() or not path.exists():
        raise CaseError(missing_case(path))


def refuse_missing_result(folder: Path, case_file: Path | None = None, *, no_lock: bool = False) -> None:
    """Refuse a folder without result, or a missing case file named for it; complete a publication that was cut off."""
    if (folder / ".fatigue-publish").exists():
        from fatigue.results.lock import settle_folder

        settle_folder(folder, no_lock=no_lock)
    if not (folder / "provenance.json").exists():
        from fatigue.results.provenance import read_provenance

        read_provenance(folder)
    if case_file is not None and not case_file.is_file():
        raise DataError(missing_case_of_result(case_file))


def missing_foreign(*paths: Path) -> Iterable[Problem]:
    """Name FE and simulation files that are not there, as ``fatigue.readers.foreign.read.recognise`` does."""
    for path in paths:
        try:
            path.open("rb").close()
        except (FileNotFoundError, NotADirectoryError, IsADirectoryError):
            yield missing_foreign_file(path)
        except OSError as error:
            yield Problem("unreadable", str(path), f"the file cannot be read ({error.strerror})", "Check the path")


def missing_tables(*paths: Path | None) -> Iterable[Problem]:
    """Name tables that are not there, as ``fatigue.readers.neutral.files.open_columns`` does."""
    for path in paths:
        if path is not None and (path.is_dir() or not path.exists()):
            yield missing_file(path)


def refuse_unknown_units(**systems: str) -> None:
    """Refuse names of unit systems that there are not."""
    from fatigue.readers.units.systems import unit_system

    for where, name in systems.items():
        unit_system(name, where.replace("_", " "))


def refuse_unknown_curve(name: str) -> None:
    """Refuse an S-N curve that is not in the catalogue: a new case has no others."""
    from fatigue.life.curves import catalogue

    if name not in (known := catalogue()):
        near = difflib.get_close_matches(name, known, n=1)
        remedy = f"Write {near[0]!r}" if near else f"Name one of {', '.join(sorted(known))}"
        raise CaseError(Problem("unknown_curve", "--curve", f"there is no curve {name!r}", remedy))


def refuse_foreign_conversion(folder: Path, *, force: bool, keep_case: bool) -> None:
    """Refuse to convert into a file, or into a folder with files of somebody else, as the conversion does later."""
    if force or not folder.exists() or (folder.is_dir() and not any(folder.iterdir())):
        return
    from fatigue.readers.convert.folder import RECORD, TABLES, check_folder

    case = () if keep_case else ("case.toml",)
    check_folder(folder, [*TABLES, "welds_register.csv", *case, RECORD], "welds_register.csv")


def refuse_existing(path: Path | None, *, force: bool, what: str, remedy: str) -> None:
    """Refuse to write over a file that is there already."""
    if path is not None and path.exists() and not force:
        raise DataError(Problem("foreign_file", str(path), what, remedy))


def refuse_all(problems: Iterable[Problem]) -> None:
    """Refuse what is bad data, all of it at once."""
    refuse(DataError, problems)
