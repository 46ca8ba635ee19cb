"""The outcome of a recount kept beside the result, with the hash of the result it is of."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fatigue.results import RECOUNT, read_provenance, relist, software_versions, write_json
from fatigue.results.belonging import MARK
from fatigue.results.lock import locked
from fatigue.results.publish import publish, staging_in
from fatigue.verify.recount.stored.compare import Recount


def outcome(found: Recount, result: str) -> dict[str, Any]:
    """Record of a recount of the result with this hash; the same recount gives the same record."""
    record = found.as_record()
    del record["folder"]
    return {"program": "fatigue", MARK: result, "software": software_versions(), **record}


def keep(folder: Path, found: Recount, record: Mapping[str, Any]) -> None:
    """Put the outcome of a recount beside the result whose provenance ``record`` was read before it.

    An older result, which has no hash, keeps none: nothing would tell what it is of.

    Raises
    ------
    DataError : the folder cannot be written, another run is writing to it, or it holds another result by now
    """
    if not record.get("result"):
        return
    with locked(folder), staging_in(folder) as staging:
        if read_provenance(folder).get("result") == record["result"]:
            write_json(staging / RECOUNT, outcome(found, record["result"]))
            relist(folder, staging, [staging / RECOUNT])
            publish(staging, folder)
