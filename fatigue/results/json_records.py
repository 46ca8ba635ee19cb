"""Records of a result as JSON, in which infinite and missing numbers are null."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from fatigue.files.mishaps import refused_writing


def write_json(path: Path | str, record: Mapping[str, Any]) -> None:
    """Write a record as UTF-8 JSON; infinite and missing numbers become null.

    Bytes of a path that are no UTF-8, lone surrogates in Python, are written as JSON escapes, which give them back.

    Raises
    ------
    DataError : the disk is full or the place cannot be written
    """
    text = json.dumps(json_ready(record), indent=2, ensure_ascii=False, allow_nan=False)
    with refused_writing(path):
        Path(path).write_text(text + "\n", encoding="utf-8", errors="backslashreplace")


def json_ready(value: Any) -> Any:
    """Turn numpy scalars, arrays and non-finite numbers into what JSON can say (null for infinite life)."""
    if isinstance(value, Mapping):
        return {str(k): json_ready(v) for k, v in value.items()}
    if isinstance(value, np.ndarray | list | tuple):
        return [json_ready(v) for v in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not np.isfinite(value):
        return None
    return value
