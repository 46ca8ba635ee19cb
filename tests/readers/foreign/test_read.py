"""Foreign formats are told by their content, and refused where what they need is missing."""

import sys
from pathlib import Path

import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.histories.mcf import read_mcf
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


def test_missing_files(tmp_path):
    """Missing, empty and unknown binary files are named."""
    for read in (read_mcf, recognise):
        with pytest.raises(DataError, match=r"none\.mcf"):
            read(tmp_path / "none.mcf")
    (tmp_path / "empty").touch()
    with pytest.raises(DataError, match="empty"):
        recognise(tmp_path / "empty")
    (tmp_path / "binary").write_bytes(b"abc\0def")
    with pytest.raises(DataError, match="unknown binary"):
        recognise(tmp_path / "binary")


def test_formats_by_content():
    """Real files are recognised by content."""
    folder = Path("data/nastran")
    names = {"modes_elements.op2": "op2", "modes_elements.h5": "h5", "modes_elements.bdf": "bdf", "geom.inc": "bdf"}
    assert {name: recognise(folder / name).key for name in names} == names
