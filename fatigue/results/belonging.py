"""Which result a file belongs to: everything written of a result carries its hash or stands in a list that does.

A result has a hash of everything its numbers depend on: case, inputs, program, and what was counted. Equal hashes mean
equal tables. Parquet tables, HTML, PDF, ParaView file and workbook carry it; CSV files cannot without breaking
their readers, so ``exports.json`` names it once and lists the SHA-256 of every document. The provenance has the
SHA-256 of tables and documents alike, see ``outputs``.
"""

import json
import re
import zipfile
import zlib
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from fatigue.errors import DataError, Problem, refuse
from fatigue.files.hashes import sha256
from fatigue.results.columns import ASSESSED, DIAGNOSED, OPTIONAL, TABLES
from fatigue.results.dictionary.bench import BENCHED
from fatigue.results.dictionary.load_spectra import LOAD_SPECTRA
from fatigue.results.dictionary.resonance import FORMED
from fatigue.results.dictionary.ride import RIDDEN
from fatigue.results.dictionary.shift import SHIFTED
from fatigue.results.json_records import write_json
from fatigue.results.outputs import altered
from fatigue.results.provenance import hashes_on_record

PICTURE = "weld_lines.vtp"
BODY = "body.vtp"
PAGE = "report.html"
PRINT = "report.pdf"
WORKBOOK = "nodes.xlsx"
RECOUNT = "recount.json"  # outcome of the last recount
CSV_TABLES = (
    "nodes",
    "damage",
    "cycles",
    "welds",
    "histogram",
    "band",
    "sensitivity",
    "checks",
    "path_cycles",
    *LOAD_SPECTRA,
    *BENCHED,
    *RIDDEN,
    *SHIFTED,
)
DOCUMENTS: tuple[str, ...] = (PICTURE, BODY, PAGE, PRINT, WORKBOOK, RECOUNT, *(f"{table}.csv" for table in CSV_TABLES))
LIST = "exports.json"
MARK = "fatigue-result"  # before the hash in documents that are text; the name of a property in the workbook
_MARKED = re.compile(rb"fatigue-result.{1,60}?\b([0-9a-f]{32})\b", re.DOTALL)
_ENDS = 4096  # bytes at either end of a document that are searched for the mark
_PROPERTIES = "docProps/custom.xml"  # of a workbook
_EDITED = (WORKBOOK, *(f"{table}.csv" for table in CSV_TABLES))  # what people write into and keep


def marked(result: str) -> str:
    """Words that carry the hash of a result in a comment of a document; none for a result without."""
    return f"{MARK}: {result}" if result else ""


def carried(path: Path) -> str | None:
    """Hash of the result that a table or document carries; None where it carries none."""
    try:
        if path.suffix == ".parquet":
            return (pq.read_metadata(path).metadata or {}).get(b"result", b"").decode() or None
        if path.suffix == ".xlsx":
            with zipfile.ZipFile(path) as book:
                return _mark_in(book.read(_PROPERTIES))
        with path.open("rb") as file:
            head = file.read(_ENDS)
            file.seek(max(0, path.stat().st_size - _ENDS))
            return _mark_in(head) or _mark_in(file.read())
    except (OSError, KeyError, ValueError, MemoryError, zipfile.BadZipFile, zlib.error, pa.ArrowException):
        return None


def _mark_in(content: bytes) -> str | None:
    found = _MARKED.search(content)
    return found[1].decode() if found else None


def listed(folder: Path) -> Mapping[str, str]:
    """SHA-256 of every document as it was written, by its name, from the list in a result folder."""
    files: Mapping[str, str] = _list_in(folder).get("files", {})
    return files


def _list_in(folder: Path) -> dict[str, Any]:
    try:
        record = json.loads((folder / LIST).read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return {}
    is_ours = isinstance(record, dict) and record.get("program") == "fatigue" and isinstance(record.get("files"), dict)
    return record if is_ours else {}


def write_list(folder: Path, documents: Iterable[Path], result: str, known: Mapping[str, str] | None = None) -> Path:
    """Write the list of documents of a result, and return its path; ``known`` are others, by their SHA-256."""
    files = dict(known or {}) | {path.name: sha256(path) for path in documents}
    write_json(folder / LIST, {"program": "fatigue", "result": result, "files": dict(sorted(files.items()))})
    return folder / LIST


def listed_of(folder: Path, result: str) -> Mapping[str, str]:
    """SHA-256 of every document in the list, where the list is of this result; else none."""
    return listed(folder) if _list_in(folder).get("result") == result else {}


def is_derived(folder: Path, name: str, record: Mapping[str, Any] | None) -> bool:
    """Whether the program wrote a file of a result folder, and nobody has changed it since.

    ``record`` is the provenance of the result in the folder, None without one. What cannot be told is not ours: a
    document counts when the list has it as it is, page, print and picture also when no list has them and they carry the
    hash of a result. A table is ours unless it is a sound table of somebody else.
    """
    path = folder / name
    if not path.exists():
        return False
    if name in (f"{table}.parquet" for table in TABLES):
        return _is_ours_or_damaged(path, known=record is not None)
    if name not in DOCUMENTS:
        return record is not None
    on_record = (record and hashes_on_record(record)) or {}
    known = on_record if name in on_record else listed(folder)
    if name in known:
        return path.is_file() and known[name] == sha256(path)
    if record is not None and "result" not in record:  # written before documents were listed
        return name in (PAGE, PICTURE)
    return name not in _EDITED and carried(path) is not None


def refuse_foreign(folder: Path, tables: Iterable[str], record: Mapping[str, Any]) -> None:
    """Refuse tables in a result folder that are about to be written and that the program did not write.

    Raises
    ------
    DataError : every file of these names that belongs to somebody else
    """
    refuse(
        DataError,
        (
            Problem("foreign_files", str(path), "is there already and was not written by fatigue", "Move it away")
            for path in (folder / f"{name}.parquet" for name in tables)
            if path.exists() and not is_derived(folder, path.name, record)
        ),
    )


def _is_ours_or_damaged(path: Path, *, known: bool) -> bool:
    try:
        metadata = pq.read_metadata(path).metadata or {}
    except (OSError, pa.ArrowException):
        return known
    return metadata.get(b"program") == b"fatigue" and metadata.get(b"table") == path.stem.encode()


def strangers(
    folder: Path, record: Mapping[str, Any], names: Iterable[str] | None = None, read: Iterable[str] | None = None
) -> list[Problem]:
    """Name every table and document of a result folder that does not belong to the result of this provenance.

    ``names`` are the files looked at, by default all that the program may have written; ``read`` those of them whose
    content is compared with the hashes on record, by default all.
    """
    wanted = tuple(names or (*(f"{table}.parquet" for table in TABLES), *DOCUMENTS, LIST))
    changed = altered(folder, record, wanted if read is None else read)
    return [problem for name in wanted for problem in _strange(folder, name, record, changed.get(name, ""))]


def _strange(folder: Path, name: str, record: Mapping[str, Any], change: str) -> Iterator[Problem]:
    path, result = folder / name, record.get("result")
    is_there = path.exists()
    remedy = _REMEDY[name] if is_there else "Put it back, or run `fatigue assess` again"
    if not is_there and name not in _NEEDED:
        return
    held = carried(path) if is_there else None
    if held is not None and held != result:
        ours = str(result)[:12] if result else "which has no hash"
        what = f"belongs to the result {held[:12]}, not to that of provenance.json, {ours}"
        yield Problem("other_result", str(path), what, remedy)
    elif change:
        yield Problem("damaged_result", str(path), change, remedy)
    elif not is_there or _is_as_listed(folder, name, record):
        return
    elif result is None or path.suffix == ".parquet":  # written before there were hashes, or by somebody else's hand:
        return  # its numbers are checked by the recount
    elif not path.is_file():
        yield Problem("damaged_result", str(path), "is no file", remedy)
    elif (known := listed_of(folder, result).get(name)) != sha256(path):
        what = "was changed since it was written" if known else "was not written of this result"
        yield Problem("other_result", str(path), what, remedy)


def _is_as_listed(folder: Path, name: str, record: Mapping[str, Any]) -> bool:
    """Whether a file that is as it was written needs no look into the list of documents."""
    of_list = _list_in(folder).get("result")
    return name == LIST or (hashes_on_record(record) is not None and of_list in (None, record.get("result")))


_AGAIN = "Run the assessment again"
_REMEDY = {
    **{f"{table}.parquet": _AGAIN for table in ASSESSED | OPTIONAL},
    **{f"{table}.parquet": "Run `fatigue diagnose` again, or remove it" for table in DIAGNOSED | FORMED},
    **{f"{table}.parquet": "Run `fatigue spectra` again, or remove it" for table in LOAD_SPECTRA},
    **{f"{table}.parquet": "Run `fatigue bench` again, or remove it" for table in BENCHED},
    **{f"{table}.parquet": "Run `fatigue ride` again, or remove it" for table in RIDDEN},
    **{f"{table}.parquet": "Run `fatigue shift` again, or remove it" for table in SHIFTED},
    **dict.fromkeys((*DOCUMENTS, LIST), "Write it again with `fatigue report`, or remove it"),
    RECOUNT: "Run `fatigue verify --results` again, or remove it",
}
_NEEDED = {f"{table}.parquet" for table in ASSESSED}  # documents, diagnosis, ranges and spectra may be missing


def refuse_mixed(
    folder: Path,
    record: Mapping[str, Any],
    tables: Iterable[str] = tuple(TABLES),
    read: Iterable[str] | None = None,
) -> None:
    """Refuse a folder some of whose tables are of another result, or not as they were written.

    ``read`` are the tables that are about to be read and therefore hashed, by default all of them.

    Raises
    ------
    DataError : all tables that belong to another result than this provenance, were changed, or are missing
    """
    hashed = None if read is None else [f"{table}.parquet" for table in read]
    refuse(DataError, strangers(folder, record, [f"{table}.parquet" for table in tables], hashed))
