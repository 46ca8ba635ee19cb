"""Foreign formats are told by their content."""

import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.formats import recognise


@pytest.mark.parametrize(
    "data",
    [
        b"GRID,1\n",
        b"  include 'a.inc'\n",
        b'INCLUDE"a.inc"\n',
        b"$ only\nCORD2R,1\n",
        b"begin,bulk\n",
        b"PSHELL  1\n",
        b"GRID,1\n\x1a",
        b"GRID,1\n\x1a\0\0",
        "GRID,1\n".encode("utf-16"),
    ],
)
def test_bulk_data(tmp_path, data):
    """Decks of all kinds, with the end marks of old systems, in two bytes for each letter."""
    path = tmp_path / "a.bdf"
    path.write_bytes(data)
    assert recognise(path) == "bdf"


def test_binary_files_are_no_text(tmp_path):
    """A file with zeros within is none."""
    path = tmp_path / "a.bdf"
    path.write_bytes(b"GRID,1\0GRID,2\n")
    with pytest.raises(DataError, match="unknown binary format"):
        recognise(path)
