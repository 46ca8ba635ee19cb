"""Foreign formats are told by their content, and refused where what they need is missing."""

import sys
from pathlib import Path

import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.read import read_forces, recognise


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
    assert recognise(path).key == "bdf"


def test_binary_files_are_no_text(tmp_path):
    """A file with zeros within is none."""
    path = tmp_path / "a.bdf"
    path.write_bytes(b"GRID,1\0GRID,2\n")
    with pytest.raises(DataError, match="unknown binary format"):
        recognise(path)


def test_missing_h5py_is_told(monkeypatch):
    """Without h5py the message says what to install."""
    monkeypatch.setitem(sys.modules, "h5py", None)
    with pytest.raises(DataError, match=r'Run: pip install "h5py>=[\d.]+"'):
        read_forces(Path("data/nastran/modes_elements.h5"), None)
