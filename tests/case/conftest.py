"""Loading of a case text."""

from pathlib import Path

import pytest

from fatigue.case import Case, load_case


@pytest.fixture
def load(tmp_path: Path):
    """Write a case and load it."""

    def write_and_load(text: str | bytes) -> Case:
        path = tmp_path / "case.toml"
        path.write_bytes(text.encode() if isinstance(text, str) else text)
        return load_case(path)

    return write_and_load
