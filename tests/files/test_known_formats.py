"""Files in the wrong place are told by their content, whatever their name says."""

import bz2
import gzip
import io
import lzma
import pickle
import sqlite3
import struct
import tarfile
import zipfile
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from pyarrow import feather, orc

from fatigue.case import load_case
from fatigue.errors import FatigueError
from fatigue.files.misplaced import known_format, misplaced
from fatigue.readers.foreign.read import read_coordinates, read_forces, read_model
from fatigue.readers.neutral.tables import open_table

NASTRAN = Path("data/nastran")
FRAME = pd.DataFrame({"mode": [1, 2], "frequency_hz": [1.0, 2.0]})
TABLE = pa.Table.from_pandas(FRAME)
CSV = FRAME.to_csv(index=False).encode()
OP2 = (NASTRAN / "modes_elements.op2").read_bytes()
ANSYS = bytes.fromhex(
    "64000000 00000080 0c000000 ffffffff db020200 61ed3301 ffffffff 00000000"
)  # head of a genuine .rst


def _archive(**files: bytes) -> bytes:
    with zipfile.ZipFile(buffer := io.BytesIO(), "w") as archive:
        for name, content in files.items():
            archive.writestr(name.replace("__", "/"), content)
    return buffer.getvalue()


def _written(write: Callable[[io.BytesIO], object]) -> bytes:
    write(buffer := io.BytesIO())
    return buffer.getvalue()


def _tar(buffer: io.BytesIO) -> None:
    with tarfile.open(fileobj=buffer, mode="w") as archive:
        archive.addfile(tarfile.TarInfo("q.csv"), io.BytesIO(b""))


def _stream(buffer: io.BytesIO) -> None:
    with pa.ipc.new_stream(buffer, TABLE.schema) as writer:
        writer.write_table(TABLE)


def _sqlite() -> bytes:
    with sqlite3.connect(":memory:") as base:
        base.execute("create table t (mode)")
        return base.serialize()


FOREIGN = {
    "a gzip archive": lambda: gzip.compress(CSV),
    "a bzip2 archive": lambda: bz2.compress(CSV),
    "an xz archive": lambda: lzma.compress(CSV),
    "a Zstandard archive": lambda: pa.compress(CSV, "zstd", asbytes=True),
    "a tar archive": lambda: _written(_tar),
    "a ZIP archive": lambda: _archive(q=CSV),
    "a ZIP archive, or an Excel workbook, cut short": lambda: _archive(q=CSV)[:40],
    "an OpenDocument file (.ods)": lambda: _archive(mimetype=b"", **{"content.xml": b""}),
    "a simulation unit (.fmu)": lambda: _archive(**{"modelDescription.xml": b""}),
    "an old Excel workbook (.xls)": lambda: (
        b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(504) + "Workbook".encode("utf-16-le")
    ),
    "an Arrow or Feather file": lambda: _written(lambda buffer: feather.write_feather(TABLE, buffer)),
    "an Arrow stream": lambda: _written(_stream),
    "an ORC file": lambda: _written(lambda buffer: orc.write_table(TABLE, buffer)),
    "an SQLite database": _sqlite,
    "a Python pickle": lambda: pickle.dumps({"mode": [1]}),
    "an ANSYS result file (.rst)": lambda: ANSYS + bytes(400),
    "an ANSYS binary file": lambda: ANSYS[:8] + b"\x04" + ANSYS[9:] + bytes(400),
    "an Abaqus results file (.fil)": lambda: struct.pack("<iqq", 4096, 9, 1921) + bytes(100),
    "Abaqus results as text (.fil)": lambda: b"*I 18I 41921A8  2023    A820-Nov-2D 0.1\n",
    "a NASTRAN matrix file (.op4)": lambda: struct.pack("<5i8si", 24, 3, 3, 2, 2, b"KXX     ", 24) + bytes(40),
    "a text matrix file of NASTRAN (.op4)": lambda: b"      31      25       2       2RMAT    1P,3D21.14\n       2\n",
    "an ASAM MDF file that was not finalised": lambda: b"UnFinMF 4.10    TGT 15.0" + bytes(100),
    "an index of an NI TDMS file (.tdms_index)": lambda: b"TDSh\x0e\0\0\0" + bytes(100),
    "an ASCII OP2 file": lambda: b"       3\n       1       2      24\n       7\nNASTRAN FORT TAPE ID CODE - \n",
    "a NASTRAN print file (.f06)": lambda: b"1\n0        N A S T R A N    E X E C U T I V E\n GRID 1\n CEND\n",
    "an LS-DYNA deck": lambda: b"$ by hand\n*KEYWORD\n*NODE\n",
    "an Adams model (.adm)": lambda: b"!ADAMS/View model\nPART/1, GROUND\n",
    "an STL surface": lambda: b"solid body\n facet normal 0 0 1\n",
    "a STEP file": lambda: b"ISO-10303-21;\nHEADER;\n",
    "an XML file": lambda: b'<?xml version="1.0"?>\n<a/>\n',
    "a web page": lambda: b"<!DOCTYPE html>\n<html>404</html>\n",
    "a JSON file": lambda: b'{"mode": [1, 2]}\n',
    "a PDF document": lambda: b"%PDF-1.7\n1 0 obj\n",
    "a Git LFS pointer": lambda: b"version https://git-lfs.github.com/spec/v1\noid sha256:12\n",
}
UNKNOWN = {
    "perhaps Altair H3D results": ("x.bin", b"\x01\x02\0\0 Altair HyperWorks\0" + bytes(50)),
    "perhaps an Adams modal neutral file (.mnf)": ("x.bin", b"\0\0\0\x01 MSC.ADAMS/Flex\0" + bytes(50)),
    "perhaps Simpack results (.sbr)": ("x.sbr", b"\x01\0\0\0\x07" + bytes(50)),
    "perhaps Abaqus results": ("x.odb", b"\x01\0\0\0\x07" + bytes(50)),
    "perhaps an OP2 file whose first bytes are damaged": ("x.op2", b"\x04\0\0\n" + OP2[4:400]),
    "it begins with nothing but zeros": ("x.op2", bytes(1000)),
    "an unknown binary format": ("x.op2", b"\x07\0\x03" * 30),
}


def refusals(folder: Path, data: bytes) -> dict[str, str]:
    """What every place that reads a file says about the bytes, whatever the name they are given."""
    readers: dict[str, tuple[str, Callable[[Path], object]]] = {
        "csv": ("x.csv", lambda path: open_table(path).expect(("mode", "frequency_hz"), (), strict=False)),
        "parquet": ("x.parquet", lambda path: open_table(path).expect(("mode", "frequency_hz"), (), strict=False)),
        "forces": ("x.op2", lambda path: read_forces(path, None)),
        "mesh": ("x.bdf", read_model),
        "coordinates": ("x.txt", lambda path: read_coordinates(path, None, None)),
        "case": ("case.toml", load_case),
    }
    said = {}
    for place, (name, read) in readers.items():
        (folder / name).write_bytes(data)
        try:
            read(folder / name)
        except FatigueError as error:
            said[place] = str(error)
    return said


@pytest.mark.parametrize("name", FOREIGN)
def test_what_is_not_read_is_named_everywhere(tmp_path, name):
    """One line with the name of the format and the way out, for tables, forces, mesh, coordinates and case alike."""
    said = refusals(tmp_path, FOREIGN[name]())
    assert len(said) == 6
    for message in said.values():
        assert f": this is {name}. " in message
        assert "\n" not in message
    assert len({message.split(f": this is {name}. ")[1] for message in said.values()}) == 1


@pytest.mark.parametrize("finding", UNKNOWN)
def test_unknown_binary_files(tmp_path, finding):
    """Without a signature a program's name in the file speaks, then its own name; both are guesses."""
    name, data = UNKNOWN[finding]
    (tmp_path / name).write_bytes(data)
    with pytest.raises(FatigueError, match=r"an unknown binary format") as refusal:
        read_forces(tmp_path / name, None)
    assert finding in str(refusal.value)
    assert "unknown binary format" in refusals(tmp_path, data)["case"]


@pytest.mark.parametrize(
    ("data", "place", "words"),
    [
        (
            (NASTRAN / "geom.inc").read_bytes(),
            "forces",
            "this is a NASTRAN deck (format bdf), which holds no grid point forces",
        ),
        ((NASTRAN / "geom.inc").read_bytes(), "coordinates", "Give it to --mesh, and to --coordinates a text table"),
        ((NASTRAN / "geom.inc").read_bytes(), "case", "this is a NASTRAN deck. Give it to fatigue convert --mesh."),
        (OP2, "mesh", "this is a NASTRAN OP2 file (format op2), which holds no mesh. Give it to --forces"),
        (OP2, "csv", "this is a NASTRAN OP2 file. Give it to fatigue convert --forces."),
        (OP2, "case", "this is a NASTRAN OP2 file. Give it to fatigue convert --forces."),
        (_written(lambda b: pq.write_table(TABLE, b)), "csv", "this is a Parquet table. Name it .parquet"),
        (_written(lambda b: pq.write_table(TABLE, b)), "case", "this is a Parquet table."),
        (
            _written(lambda b: pq.write_table(TABLE, b)),
            "forces",
            "this is a Parquet table (format parquet), which holds",
        ),
        (
            b"[body]\nmodes = 'm'\n[curve]\nname = 'c'\n",
            "forces",
            "this is a case (case.toml), which holds no grid point",
        ),
        (b"[body]\nmodes = 'm'\n[curve]\nname = 'c'\n", "coordinates", "Give it to fatigue check or fatigue assess"),
        (b"[body]\nmodes = 'm'\n[curve]\nname = 'c'\n", "csv", "this is a case (case.toml). Give it to fatigue check"),
        (b"weld,line,status\na,T-1,assess\n", "csv", "this is a weld register. Give it to --register."),
        (
            b"weld,line,status\na,T-1,assess\n",
            "coordinates",
            "this is a weld register, which holds no modal coordinates",
        ),
        (b"time,q_1\n0,1\n1,2\n", "forces", "Give it to --coordinates if it holds them, and to --forces an .op2"),
    ],
)
def test_swapped_files(tmp_path, data, place, words):
    """A sound file in the wrong place: what it is, and where it belongs."""
    assert words in refusals(tmp_path, data)[place]


def test_sound_files_are_not_mistaken(tmp_path):
    """Nothing that is read here looks like anything else."""
    for path in (*NASTRAN.glob("*.op2"), *NASTRAN.glob("*.h5"), *NASTRAN.glob("*.bdf"), *NASTRAN.glob("*.inc")):
        assert known_format(path) is None
    for k, text in enumerate(
        [
            "time,q_1\n0,1\n",
            "-1 2\n 58 3\n",
            "Modal Coordinates\nNumber of Modes: 2\n",
            "$ N A S T R A N  deck of a wagon\nGRID,1\n",
            "weld,line,status,description\na,T-1,assess,MYSTRAN\n",
            "mode;frequency_hz\n1;2,5\n",
            "title = '{x}'\n[body]\n[[mission.event]]\n",
        ]
    ):
        (tmp_path / f"{k}").write_text(text)
        assert known_format(tmp_path / f"{k}") is None
    (tmp_path / "wide.txt").write_bytes("time;q_1\n0;1\n".encode("utf-16-le"))
    assert misplaced(tmp_path / "wide.txt", "") is None
    assert known_format(tmp_path / "none") is None
