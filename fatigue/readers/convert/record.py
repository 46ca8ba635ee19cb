"""What a conversion writes down for later: what it read and found, the lines of its welds, and how it was called."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from fatigue.errors import Problem
from fatigue.files.hashes import sha256
from fatigue.readers.convert.audit.audit import Audit
from fatigue.readers.convert.loads.names import UnitLoad
from fatigue.readers.convert.option_fields import words_of
from fatigue.readers.convert.options import ConvertOptions
from fatigue.readers.neutral.forces.convention import Convention
from fatigue.readers.neutral.register.conversion import COMMAND, LINES
from fatigue.readers.neutral.register.weld_register import RegisterRow


def conversion_record(
    options: ConvertOptions,
    inputs: Iterable[Path],
    convention: Convention,
    audit: Audit,
    warnings: Iterable[Problem],
    welds: Sequence[RegisterRow],
    loads: Sequence[UnitLoad],
) -> dict[str, Any]:
    """What ``convert.json`` holds besides the hashes of the files that were written."""
    return {
        "inputs": {str(path): sha256(path) for path in inputs},
        "convention": convention,
        "audit": [_plain(asdict(row)) for row in audit.rows],
        "remarks": [str(problem) for problem in warnings],
        "unit_loads": [load_record(load) for load in loads],
        LINES: _lines_of_welds(welds),
        COMMAND: words_of(options),
    }


def load_record(load: UnitLoad) -> dict[str, Any]:
    """What a unit load is, and what it was made of."""
    return {
        "name": load.name,
        "unit": load.unit,
        "is_unit_known": load.is_unit_known,
        "amount": load.amount,
        "subcase": load.case.subcase,
        "file": load.case.source,
        **asdict(load.case.heading),
    }


def _lines_of_welds(rows: Sequence[RegisterRow]) -> dict[str, dict[str, float | None]]:
    """Lines of every weld that is assessed, with the thickness confirmed for each."""
    welds: dict[str, dict[str, float | None]] = {}
    for row in rows:
        if row.status == "assess":
            welds.setdefault(row.weld, {})[row.line] = row.thickness if row.confirmed else None
    return welds


def _plain(row: dict[str, object]) -> dict[str, object]:
    """Audit row for JSON, which knows no NaN and no infinity."""
    value = row["value"]
    return {**row, "value": value if isinstance(value, float) and math.isfinite(value) else None}
