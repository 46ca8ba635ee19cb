"""The documents of a finished result as a story: page, picture, print, workbook and CSV, put in place together.

Nothing is counted again: a document shows the tables of the result, and what it needs of the inputs. Files in the way
are refused before the first is written, and what cannot be written here is named while the others are. All that are
written lie aside until the last is finished, and replace the old ones in one step.
"""

import logging
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fatigue.errors import DataError, Problem, refuse
from fatigue.report.files.body import write_body
from fatigue.report.files.browser import find_browser
from fatigue.report.files.export import write_csv
from fatigue.report.files.pdf import print_pdf
from fatigue.report.files.vtp import write_vtp
from fatigue.report.files.workbook.book import refuse_without_xlsxwriter, write_xlsx
from fatigue.report.identity.identity import found_identity, issued
from fatigue.report.page import write_report
from fatigue.results import (
    BODY,
    CSV_TABLES,
    DOCUMENTS,
    PAGE,
    PICTURE,
    PRINT,
    WORKBOOK,
    case_of,
    is_derived,
    marked,
    named_case,
    read_provenance,
    refuse_another,
    refuse_mixed,
    relist,
)
from fatigue.results.lock import locked, settle_folder
from fatigue.results.publish import publish, staging_in
from fatigue.stages import stage

log = logging.getLogger(__name__)

AGAIN = (PAGE, PICTURE)  # written again without being asked
CSV = tuple(f"{table}.csv" for table in CSV_TABLES)


@dataclass(frozen=True, slots=True)
class Documents:
    """What was written, and why something asked for was not."""

    written: tuple[Path, ...]
    problems: tuple[Problem, ...]


def missing_extras(wanted: Collection[str]) -> dict[str, Problem]:
    """Documents that cannot be written here, and what they lack; quick, before any work is done."""
    tests: dict[str, Callable[[], object]] = {WORKBOOK: refuse_without_xlsxwriter, PRINT: find_browser}
    return dict(found for name, test in tests.items() if name in wanted for found in _failed(name, test))


def write_documents(
    folder: Path,
    wanted: Collection[str] = AGAIN,
    *,
    case_file: Path | None = None,
    verification: Callable[[], Sequence[Mapping[str, Any]]] = tuple,
    force: bool = False,
    no_lock: bool = False,
    bom: bool = False,
) -> Documents:
    """Write documents of a finished result, all that can be written; in one step they replace the ones there.

    A document that cannot be written here is warned of before the work begins, and told once more by what is returned.

    Parameters
    ----------
    folder : the result folder
    wanted : names of documents, of ``fatigue.results.DOCUMENTS``
    case_file : the case of the result, by default where its provenance says
    verification : computes the checks of the program that the page shows
    force : replace documents that are there already, also those that fatigue did not write
    no_lock : for a file system without locks, see ``fatigue.assess``
    bom : begin CSV files with a byte order mark, for Excel

    Raises
    ------
    DataError : no finished result, tables of different results, another case, a logo or template that is unfit, or
        files in the way
    CaseError : the case has been edited since, and its table ``[report]`` is wrong
    """
    settle_folder(folder, no_lock=no_lock)
    record = read_provenance(folder)
    refuse_mixed(folder, record)
    case_file = case_of(record, folder) if case_file is None else named_case(record, case_file)
    refuse(DataError, _in_the_way(folder, wanted, record, case_file, force=force))
    identity = issued(record, found_identity(record, folder, case_file))
    missing = missing_extras(wanted)
    for problem in missing.values():
        log.warning("%s Going on with the others.", problem)
    with locked(folder, no_lock=no_lock), staging_in(folder) as staging:
        refuse_another(folder, record)
        checks = verification() if PAGE in wanted else ()
        writers: dict[str, Callable[[], object]] = {
            PAGE: lambda: write_report(folder, case_file, checks, staging),
            PICTURE: lambda: write_vtp(folder, staging),
            BODY: lambda: write_body(folder, case_file, staging),
            WORKBOOK: lambda: write_xlsx(folder, staging),
            CSV[0]: lambda: write_csv(folder, staging, bom=bom),
            PRINT: lambda: _print(folder, staging, record.get("result", "")),
        }
        for name in (name for name in writers if name in wanted and name not in missing):
            stage("writing %s", "CSV files" if name in CSV else name)
            missing.update(_failed(name, writers[name]))
        files = [staging / name for name in DOCUMENTS if (staging / name).exists()]
        relist(folder, staging, files, identity)
        publish(staging, folder)
    return Documents(tuple(folder / path.name for path in files), tuple(missing.values()))


def _failed(name: str, do: Callable[[], object]) -> Iterator[tuple[str, Problem]]:
    try:
        do()
    except DataError as error:
        if error.problems[0].code == "cannot_write":
            raise  # no other document can be written either
        yield name, error.problems[0]


def _print(folder: Path, staging: Path, result: str) -> None:
    page = staging / PAGE if (staging / PAGE).exists() else folder / PAGE
    print_pdf(page, staging / PRINT, marked(result))


def _in_the_way(
    folder: Path, wanted: Collection[str], record: Mapping[str, Any], case_file: Path, *, force: bool
) -> Iterator[Problem]:
    """Problems of files that must not be overwritten: inputs of the case never, other files not without force."""
    inputs = [path for known in record["inputs"] if (path := case_file.parent / known["file"]).exists()]
    for name in wanted:
        path = folder / name
        if not path.exists():
            continue
        if any(path.samefile(given) for given in inputs):
            remedy = "Assess into a folder of its own, where it is not in the way"
            yield Problem("input_in_the_way", str(path), "is an input of the case", remedy)
        elif not force and name not in AGAIN:
            yield Problem("foreign_files", str(path), "is there already", "Use --force to write it again")
        elif not force and not is_derived(folder, name, record):
            what = "was not written by fatigue, or was changed since"
            yield Problem("foreign_files", str(path), what, "Move it away, or use --force to overwrite it")
