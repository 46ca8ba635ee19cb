"""Under whose name a report is issued: read from the case as it is today, kept in the provenance with the result.

The numbers of a result are those of its hash; who signs for them may be corrected, and a revision may follow another.
The provenance keeps every identity under which documents of a result were written, in their order, each beside the
hash of the result: so the same numbers in two revisions can be told from other numbers.
"""

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fatigue.case import PEOPLE, Case, Report, load_case
from fatigue.errors import Problem
from fatigue.report.identity.template import PLAIN, Look, look_of
from fatigue.results import AddedKey, case_of, is_assessed_case

NAMES = {
    "document": "Document",
    "revision": "Revision",
    "date": "Date",
    "author": "Prepared by",
    "checker": "Checked by",
    "approver": "Approved by",
    "company": "Company",
    "vehicle": "Vehicle",
    "fe_model": "FE model",
    "mbs_model": "Multibody model",
    "track": "Track",
    "payload": "Payload",
    "wear": "State of wear",
    "standard": "Standard",
}
"""What the page calls the entries that it shows, in its order."""


@dataclass(frozen=True, slots=True)
class Identity:
    """What a report says of itself.

    ``entries`` are those given, by their keys; ``look`` is logo, colours, texts and language; ``problems`` says what
    of the look could not be found any more.
    """

    entries: Mapping[str, str]
    look: Look = PLAIN
    problems: tuple[Problem, ...] = ()

    @property
    def missing(self) -> tuple[str, ...]:
        """Names of the entries without which a report is a draft."""
        return tuple(NAMES[key] for key in PEOPLE if key not in self.entries)

    @property
    def shown(self) -> list[tuple[str, str]]:
        """Name and text of the entries to show, those that are given and those that a report must have."""
        if not self.entries:
            return []
        return [(name, self.entries.get(key, "")) for key, name in NAMES.items() if key in {*self.entries, *PEOPLE}]

    def as_record(self, result: str) -> dict[str, Any]:
        """Record for the provenance of a result with this hash."""
        return {"result": result, "report": dict(self.entries), "files": dict(self.look.files)}


def identity_of(case: Case) -> Identity:
    """Identity and look that a case gives its report; its logo and its template are opened.

    Raises
    ------
    DataError : logo or template are missing, too large, harmful or unreadable
    """
    return Identity(case.report.as_record(), look_of(case))


def found_identity(record: Mapping[str, Any], folder: Path, case_path: Path | None) -> Identity:
    """Identity of the report of a result: of its case as it is today, else as it was issued last, or assessed.

    Raises
    ------
    CaseError, DataError : the case is there, and its table ``[report]`` or a file that it names is unfit
    """
    path = case_path or case_of(record, folder)
    if is_assessed_case(record, path):
        return identity_of(load_case(path)) if _table(path.read_text(encoding="utf-8-sig")) else Identity({})
    issued: Sequence[Mapping[str, Any]] = record.get("identity", ())
    entries = dict(issued[-1]["report"]) if issued else _as_assessed(record)
    problems = [
        Problem("missing_case", record["case_file"], f"without the case there is no {key}, {name}", "Give --case CASE")
        for key in ("logo", "template")
        if (name := entries.get(key))
    ]
    return Identity(entries, PLAIN.in_language(entries.get("language")), tuple(problems))


def issued(record: Mapping[str, Any], identity: Identity) -> dict[AddedKey, Any]:
    """What the provenance is to say of the identities under which documents were written; nothing where it does.

    This one comes behind those before it, unless it is the last.
    """
    before = list(record.get("identity", ()))
    now = identity.as_record(record.get("result", ""))
    is_known = now == before[-1] if before else not identity.entries
    return {} if is_known else {"identity": [*before, now]}


def _table(text: str) -> Mapping[str, Any]:
    """The table ``[report]`` of the text of a case, as it is written."""
    table: Mapping[str, Any] = tomllib.loads(text).get("report", {})
    return table


def _as_assessed(record: Mapping[str, Any]) -> dict[str, str]:
    """Entries in the text of the case as it was assessed."""
    return Report.model_validate(_table(record["case_text"])).as_record()
