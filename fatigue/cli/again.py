"""Documents of a result that a command with new tables writes again: its page, and CSV files of such tables."""

import logging
from collections.abc import Iterable
from pathlib import Path

from fatigue.cli.known_values import known_values

log = logging.getLogger(__name__)


def write_again(folder: Path, tables: Iterable[str], *, case_file: Path | None, no_lock: bool) -> None:
    """Write the page of a result again, and its CSV files where there are some of these tables.

    What was not written by the program, or was changed since, stays as it is, and a warning says so.
    """
    from fatigue.documents import CSV, write_documents
    from fatigue.results import PAGE, is_derived, read_provenance

    record = read_provenance(folder)
    again = [PAGE] if is_derived(folder, PAGE, record) else []
    if not again and (folder / PAGE).exists():
        log.warning("%s was not written by fatigue, or was changed since: it stays as it is", folder / PAGE)
    old = [f"{table}.csv" for table in tables if (folder / f"{table}.csv").exists()]
    if old and all(is_derived(folder, name, record) for name in CSV if (folder / name).exists()):
        again += CSV
    elif old:
        log.warning("%s holds the CSV files before: some of them was changed by hand, none is replaced", folder)
    if again:
        write_documents(folder, again, case_file=case_file, verification=known_values, force=True, no_lock=no_lock)
