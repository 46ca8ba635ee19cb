"""The last recount of a result by independent code, as it lies beside it."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fatigue.results import RECOUNT
from fatigue.results.belonging import MARK
from fatigue.results.outputs import altered


def read_recount(folder: Path, record: Mapping[str, Any]) -> Mapping[str, Any] | None:
    """Outcome of the last ``fatigue verify --results`` of this very result; None where none was kept of it.

    One of another result does not count, nor one that was changed since it was written.
    """
    path = folder / RECOUNT
    if not path.is_file() or altered(folder, record, [RECOUNT]):
        return None
    try:
        kept: Mapping[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return None
    return kept if isinstance(kept, dict) and kept.get(MARK) == record.get("result") is not None else None
