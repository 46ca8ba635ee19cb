"""What the comfort indices rest on, as it is shipped: recalled constants, and the standing of each index."""

import tomllib
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any


@cache
def comfort_data() -> Mapping[str, Any]:
    """Tables of ``comfort.toml``, each with source, edition and status."""
    return tomllib.loads(Path(__file__).with_name("comfort.toml").read_text("utf-8"))


def standing(index: str) -> str:
    """Where an index is from: its source, edition and status.

    >>> standing("sperling_line")
    'GB 5599, spectral lines; edition not seen; recalled'
    """
    data = comfort_data()[index]
    edition = data["edition"]
    return f"{data['source']}; {'edition ' * edition.startswith('not')}{edition}; {data['status']}"
