"""What is added to a finished result: tables of a later command, documents, and the record that lists them.

A command that adds tables reads ``finished_result``, prepares its work, and writes the tables while it is ``adding``.
"""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from threadpoolctl import threadpool_limits

from fatigue.results.belonging import DOCUMENTS, listed_of, refuse_foreign, refuse_mixed, write_list
from fatigue.results.folder import result_log
from fatigue.results.lock import locked, settle_folder
from fatigue.results.outputs import recorded
from fatigue.results.provenance import AddedKey, hashes_on_record, read_provenance, refuse_another, write_provenance
from fatigue.results.publish import publish, staging_in
from fatigue.results.tables import TableWriter, table_writer


def finished_result(folder: Path, tables: Iterable[str], read: Iterable[str], *, no_lock: bool) -> dict[str, Any]:
    """Provenance of a finished result whose ``tables`` are its own; those to ``read`` are as they were written.

    Raises
    ------
    DataError : another run is writing to the folder, it holds no finished result, or a table belongs to another one
    """
    settle_folder(folder, no_lock=no_lock)
    record = read_provenance(folder)
    refuse_mixed(folder, record, tables, read)
    return record


@dataclass(frozen=True, slots=True)
class Addition:
    """Tables on their way into the ``folder`` of a result, whose hash is ``result``.

    They wait in ``tables``; files that are needed meanwhile go to ``scratch``.
    """

    folder: Path
    result: str
    scratch: Path
    tables: Path

    def table(self, name: str) -> AbstractContextManager[TableWriter]:
        """Open a table for writing, some rows at a time."""
        return table_writer(self.tables, name, self.result)

    def publish(self, said: Mapping[AddedKey, Any] | None = None) -> None:
        """Put the tables beside those of the result, all or none; ``said`` is what the provenance has of them.

        Raises
        ------
        DataError : a file cannot be replaced
        """
        relist(self.folder, self.tables, sorted(self.tables.iterdir()), said)
        publish(self.tables, self.folder)


@contextmanager
def adding(folder: Path, record: Mapping[str, Any], tables: Iterable[str], *, no_lock: bool) -> Iterator[Addition]:
    """Hold the folder of a finished result, log there, and add tables of these names once they are published.

    ``record`` is the provenance as it was read before. BLAS has one thread meanwhile: points are counted side by side.

    Raises
    ------
    DataError : another run is writing to the folder or has replaced the result, or a table there is somebody else's
    """
    with (
        locked(folder, no_lock=no_lock),
        result_log(folder),
        threadpool_limits(limits=1, user_api="blas"),
        staging_in(folder) as staging,
    ):
        refuse_another(folder, record)
        refuse_foreign(folder, tables, record)
        finished = staging / "tables"
        finished.mkdir()
        yield Addition(folder, str(record.get("result", "")), staging, finished)


def enlist(folder: Path, *documents: Path, said: Mapping[AddedKey, Any] | None = None) -> None:
    """Add documents just written to the list of the result folder they are in, and to its provenance.

    ``said`` are entries of the provenance about them.

    Raises
    ------
    DataError : another run is writing to the folder, or its record was changed
    """
    with locked(folder), staging_in(folder) as staging:
        relist(folder, staging, documents, said)
        publish(staging, folder)


def relist(folder: Path, staging: Path, written: Iterable[Path], said: Mapping[AddedKey, Any] | None = None) -> None:
    """Write to ``staging`` what a result folder says of its outputs once files just written are among them.

    ``said`` are entries of the provenance about them.
    """
    record = read_provenance(folder) | dict(said or {})
    result, new = record.get("result", ""), list(written)
    if documents := [path for path in new if path.name in DOCUMENTS]:
        new.append(write_list(staging, documents, result, listed_of(folder, result)))
    if hashes_on_record(record) is not None:  # an older result stays without
        write_provenance(staging, recorded(record, new))
