"""Formats of files in the wrong place: how each is recognised, what it is called, the way to one that is read there.

Every signature says how sure it is: [V] seen in a genuine file or written by its own library in the tests, [D] from its
published description or the source of an open reader, [M] from memory, so that only the message hangs on it.
"""

import re
from collections.abc import Collection
from dataclasses import dataclass

_OP2 = "Request GPFORCE(PLOT) with PARAM,POST,-1 and give the .op2"
_CHANNELS = "Export time and modal coordinates as CSV"
AS_CSV = "Save the sheet as CSV (UTF-8)"
UNPACK = "Unpack it and give the file inside"
_ANSYS_FORCES = (
    "Export it with the macro that `fatigue request ansys` writes: the text is for --forces, the .cdb for --mesh"
)
_ABAQUS_FORCES = (
    "Export it with abaqus_export.py (fatigue request abaqus -o FILE), and give the text to --forces and --mesh"
)
_PANDAS = "Turn it into Parquet: python -c \"import pandas as p; p.{0}('FILE').to_parquet('FILE.parquet')\""


@dataclass(frozen=True, slots=True)
class Known:
    """A format by name, and the way out of it.

    ``starts`` are bytes at the position ``at``; ``within`` is a pattern that the head must match as well; ``zipped`` is
    a pattern of the name of a file in a ZIP archive, by which alone such a format is told; ``has_zeros``: a format that
    is told by a pattern alone may be binary.
    """

    name: str
    remedy: str
    starts: tuple[bytes, ...] = (b"",)
    at: int = 0
    within: bytes = b""
    zipped: str = ""
    has_zeros: bool = False

    @property
    def is_binary(self) -> bool:
        """Whether its first bytes tell the format, not a pattern that text anywhere in the head may have."""
        return self.zipped == "" and (self.starts != (b"",) or not self.within or self.has_zeros)

    def fits_archive(self, names: Collection[str]) -> bool:
        """Whether a ZIP archive of files of these names is of this format."""
        return self.zipped != "" and any(re.match(self.zipped, name) for name in names)

    def fits(self, head: bytes) -> bool:
        """Whether a file begins like this format."""
        if self.zipped:
            return False
        begins = head[self.at :].startswith(self.starts)
        return begins and (not self.within or re.search(self.within, head) is not None)


BINARY = (
    # packed files and their like
    Known("a gzip archive", "Unpack it: gunzip", (b"\x1f\x8b",)),  # [V]
    Known("a bzip2 archive", "Unpack it: bunzip2", (b"BZh",)),  # [V]
    Known("an xz archive", "Unpack it: unxz", (b"\xfd7zXZ\0",)),  # [V]
    Known("a Zstandard archive", "Unpack it: unzstd", (b"\x28\xb5\x2f\xfd",)),  # [V]
    Known("an LZ4 archive", UNPACK, (b"\x04\x22\x4d\x18",)),  # [D]
    Known("a 7-Zip archive", UNPACK, (b"7z\xbc\xaf\x27\x1c",)),  # [D]
    Known("a RAR archive", UNPACK, (b"Rar!\x1a\x07",)),  # [D]
    Known("a Unix compress archive", "Unpack it: uncompress", (b"\x1f\x9d",)),  # [D]
    Known("a tar archive", UNPACK, (b"ustar",), at=257),  # [V]
    # tables and arrays of other programs
    Known("an Arrow or Feather file", _PANDAS.format("read_feather"), (b"ARROW1", b"FEA1")),  # [V], [D]
    Known("an Arrow stream", "Write it as Parquet", (b"\xff\xff\xff\xff",), within=rb"(?s)^.{4}[^\0].{2}\0\x10\0\0\0"),
    Known("an encrypted Parquet file", "Write it without encryption", (b"PARE",)),  # [D]
    Known("an ORC file", _PANDAS.format("read_orc"), (b"ORC",)),  # [V]
    Known("an Avro file", "Write it as Parquet", (b"Obj\x01",)),  # [D]
    Known("an SQLite database", "Write its table as CSV or Parquet", (b"SQLite format 3\0",)),  # [V]
    Known("a Python pickle", _PANDAS.format("read_pickle"), tuple(bytes((0x80, p)) for p in (2, 3, 4, 5))),  # [V]
    Known("a netCDF file", "Write its variables as CSV or Parquet", (b"CDF\x01", b"CDF\x02", b"CDF\x05")),  # [D]
    # measured and simulated channels
    Known("an index of an NI TDMS file (.tdms_index)", "Give the .tdms beside it", (b"TDSh",)),  # [D]
    Known("an ASAM MDF file that was not finalised", "Finalise it (asammdf: MDF(FILE).save)", (b"UnFinMF ",)),  # [D]
    # results of other solvers
    Known(
        "an ANSYS result file (.rst)", _ANSYS_FORCES, (b"d\0\0\0\0\0\0\x80\x0c\0\0\0", b"\0\0\0d\x80\0\0\0\0\0\0\x0c")
    ),
    Known("an ANSYS binary file", _ANSYS_FORCES, (b"d\0\0\0\0\0\0\x80", b"\0\0\0d\x80\0\0\0")),  # both [V], little end
    Known("an Abaqus results file (.fil)", _ABAQUS_FORCES, within=rb"(?s)^.{12}\x81\x07\0\0"),  # [D] record 1921 first
    Known("an Abaqus output database (.odb)", _ABAQUS_FORCES, (b"HKSRD",)),  # [M]
    Known("a NASTRAN matrix file (.op4)", _OP2, within=rb"(?s)^(?:\x18\0\0\0.{16}[A-Z]|\0\0\0\x18.{16}[A-Z])"),  # [V]
    Known("a NASTRAN matrix file (.op4)", _OP2, within=rb"(?s)^(?:\x30\0\0\0.{32}[A-Z]|\0\0\0\x30.{32}[A-Z])"),  # [V]
    # pictures, documents, programs
    Known("a PDF document", "Give the table itself as CSV", (b"%PDF-",)),  # [V]
    Known("a picture", "Give the table itself as CSV", (b"\x89PNG\r\n", b"\xff\xd8\xff", b"GIF8", b"II*\0", b"MM\0*")),
    Known("a program", "Give the data that it writes", (b"\x7fELF", b"MZ\x90\0")),  # [D]
)
"""Binary formats, the first that fits counts."""

HINTS = (
    Known(
        "an OP2 file whose first bytes are damaged",
        "Copy it again in binary mode",
        within=rb"NASTRAN FORT TAPE ID CODE",
    ),
    Known("Altair H3D results", _OP2, within=rb"(?i)altair|^.{0,16}H3D"),  # [M]
    Known("an Adams modal neutral file (.mnf)", f"It holds no element forces. {_OP2}", within=rb"(?i)adams|\bMNF\b"),
    Known("Simpack results (.sbr)", f"{_CHANNELS} in the post-processor", within=rb"(?i)simpack"),  # [M]
    Known("Abaqus results", _ABAQUS_FORCES, within=rb"(?i)abaqus|^.{0,16}HKS"),  # [M]
    Known("a NASTRAN database (.xdb, .master)", _OP2, within=rb"(?i)nastran"),  # [M]
)
"""Names of programs near the beginning of a binary file that no signature fits."""

SUFFIXES = {
    ".h3d": HINTS[1],
    ".mnf": HINTS[2],
    ".sbr": HINTS[3],
    ".odb": HINTS[4],
    ".fil": HINTS[4],
    ".xdb": HINTS[5],
    ".master": HINTS[5],
    ".dball": HINTS[5],
    ".dac": Known("an nCode DAC channel", _CHANNELS),
    ".res": Known("Adams results (.res)", "Write them as XML: RESULTS/XRF"),
    ".req": Known("Adams requests (.req)", _CHANNELS),
    ".t16": Known("Marc results", "Write the nodal forces of the weld elements as a CSV of element_forces"),
    ".stl": Known("an STL surface", "Give the NASTRAN deck (.bdf): a surface has no elements with thickness"),
}
"""What the name of a binary file says that nothing in it tells."""

TEXT = (
    Known("a Git LFS pointer", "Fetch the file itself: git lfs pull", (b"version https://git-lfs",)),  # [V]
    Known("an RTF document", "Give the table itself as CSV", (b"{\\rtf",)),  # [D]
    Known("a PostScript document", "Give the table itself as CSV", (b"%!PS",)),  # [D]
    Known("a web page", "Fetch the file itself, not the page about it", within=rb"(?i)^\s*<(?:!doctype html|html)"),
    Known(
        "an Excel table as XML", AS_CSV, within=rb"(?s)^\s*<\?xml.*urn:schemas-microsoft-com:office:spreadsheet"
    ),  # [D]
    Known("a VTK picture", "Give the NASTRAN deck (.bdf)", within=rb"(?s)^(?:# vtk DataFile|\s*(?:<\?xml.*)?<VTKFile)"),
    Known("an XML file", "Give the table itself as CSV", within=rb"(?s)^\s*<\?xml(?!.*<Results[^>]*xrf)"),  # [V]
    Known(
        "a JSON file",
        "Give a table as CSV or Parquet",
        within=rb'^\s*(?:\{\s*["}]|\[\s*(?:\{|\[\s*["\d-]|["\d-][^\]\n]*,))',
    ),
    Known(
        "an ASCII OP2 file", "Write it binary: FORM=UNFORMATTED in ASSIGN OUTPUT2", within=rb"NASTRAN FORT TAPE ID CODE"
    ),
    Known(
        "a NASTRAN print file (.f06)",
        _OP2,
        within=rb"(?m)^(?!\s*\$).*(?:N A S T R A N|G R I D   P O I N T   F O R C E|MYSTRAN Version)",
    ),
    Known(
        "a NASTRAN print file (.f06)",
        _OP2,
        within=rb"(?m)^(?!\s*\$).*(?:R E A L   E I G E N|E I G E N V E C T O R   N)",
    ),  # [V], [D]
    Known(
        "a text matrix file of NASTRAN (.op4)", _OP2, within=rb"^[ \d-]{31}\d\w{1,8} *(?:1P,\d+[ED]\d+\.\d+)?\s*\n"
    ),  # [V]
    Known("an LS-DYNA deck", "Write the mesh as a NASTRAN deck", within=rb"(?im)^\*KEYWORD"),  # [D]
    Known("Abaqus results as text (.fil)", _ABAQUS_FORCES, within=rb"^\*I +\d+I +\d?1921"),  # [D]
    Known("an STL surface", "Give the NASTRAN deck (.bdf)", within=rb"(?i)^\s*solid\b[^\n]*\n\s*facet normal"),  # [D]
    Known("a STEP file", "Give the NASTRAN deck (.bdf)", within=rb"^ISO-10303-21;"),  # [D]
    Known(
        "an Adams model (.adm)", "Export results, not the model", within=rb"(?im)^(?:PART|MARKER|FLEX_BODY)/\d+"
    ),  # [D]
)
"""Text formats, the first that fits counts."""


PARQUET = Known("a Parquet table", "Name it .parquet where it is a table of a case", (b"PAR1",))
HDF5 = Known("an HDF5 file", "Give it to fatigue convert if MSC Nastran wrote it", (b"\x89HDF\r\n\x1a\n",))
OP2 = Known(
    "a NASTRAN OP2 file",
    "Give it to fatigue convert --forces",
    (b"\x04\0\0\0", b"\x08\0\0\0", b"\0\0\0\x04", b"\0\0\0\x08"),
)
MCF = Known(
    "an ANSYS file of modal coordinates (.mcf)",
    "Give it to fatigue convert --coordinates",
    within=rb"(?ims)^\s*Number of Modes\s*:?\s*\d+\s*$.*^\s*(?:Time|Freq\w*)\s+Coordinates",
)
PUNCH = Known(
    "a NASTRAN punch file", "Give it to fatigue convert --forces", within=rb"(?m)^\$(?:TITLE|SUBCASE ID|GRID POINT)"
)
DECK = Known(
    "a NASTRAN deck",
    "Give it to fatigue convert --mesh",
    within=rb"(?im)^\s*(?:BEGIN BULK|CEND|GRID[*, ]|CQUAD4|CTRIA3)",
)
_CASE = Known(
    "a case (case.toml)",
    "Give it to fatigue check or fatigue assess",
    within=rb"(?ms)^\s*\[body\]\s*$.*^\s*\[\[?\w+(?:\.\w+)*\]\]?\s*$",
)
_REGISTER = Known(
    "a weld register", "Give it to --register", within=rb"^(?=[^\n]*\bweld\b)(?=[^\n]*\bline\b)[^\n]*\bstatus\b"
)

_TABLE = "Give it to fatigue convert --coordinates, or write it as a table: fatigue channels FILE -o TABLE.parquet"
TDMS = Known("an NI TDMS file", _TABLE, (b"TDSm",))  # [V]
MDF = Known("an ASAM MDF file (.mf4, .mdf, .dat)", _TABLE, (b"MDF     ",))  # [V]
UNIVERSAL = Known(
    "a universal file (.unv, .uff)", _TABLE, within=rb"^ {4}-1 *\r?\n {0,5}\d{1,5}b?[ \r\n]", has_zeros=True
)  # [V]
RPC = Known("an RPC III file (.rsp, .drv)", _TABLE, (b"FORMAT\0",), within=rb"^FORMAT\0+ *(?:BINARY|ASCII)")  # [V]
CDB = Known(
    "an ANSYS archive (.cdb)",
    "Give it to fatigue convert --mesh",
    within=rb"(?im)^(?:NBLOCK,|EBLOCK,|/PREP7|/COM,)",
)  # [V]
ANSYS_TEXT = Known(
    "a text of the ANSYS macro", "Give it to fatigue convert --forces", within=rb"\Afatigue export \d+ +ANSYS\b"
)
EXPORT = Known("a text of the export script", "Give it to --forces and --mesh", within=rb"\Afatigue export \d")  # [V]
INP = Known(
    "an Abaqus deck (.inp)",
    "Give it to fatigue convert --mesh",
    within=rb"(?i)\A(?:\s*\*\*[^\n]*\n|\s*\n)*\s*\*\s*(?:heading|node|element|part|assembly|include|preprint|shell|solid|nset|elset)",
)  # [V] by CalculiX
ADAMS = Known("Adams results (.res, XML)", _TABLE, within=rb"(?s)^\s*<\?xml.*<Results[^>]*xrf")  # [V]
NPY = Known("a NumPy array (.npy)", _TABLE, (b"\x93NUMPY",))  # [V]
NPZ = Known("a NumPy archive (.npz)", _TABLE, zipped=r".*\.npy$")  # [V]
MATLAB = Known(
    "a MATLAB file",
    _TABLE,
    within=rb"(?s)^(?:.{124}(?:\0\x01IM|\x01\0MI)"
    rb"|[\0-\x34]\0\0\0.{8}[\0\x01]\0\0\0[\x02-\x40]\0\0\0[A-Za-z]\w*\0"
    rb"|\0\0(?:\x03[\xe8-\xff]|\x04[\0-\x1c]).{8}\0\0\0[\0\x01]\0\0\0[\x02-\x40][A-Za-z]\w*\0)",
    has_zeros=True,
)  # [V] of version 5 to 7, whose first 116 bytes are any text; of version 4, little and big end
MATLAB_73 = Known("a MATLAB 7.3 file", _TABLE, (b"\0\x02IM", b"\x02\0MI"), at=124)  # [V]
WORKBOOK = Known("an Excel workbook (.xlsx)", f"{AS_CSV}, or: fatigue channels FILE -o TABLE.csv", zipped=r"xl/")  # [V]

OWN = (
    *(PARQUET, HDF5, OP2, MCF, PUNCH, DECK, _CASE, _REGISTER),
    *(TDMS, MDF, UNIVERSAL, RPC, NPY, NPZ, MATLAB, MATLAB_73, WORKBOOK, ADAMS, ANSYS_TEXT, EXPORT, INP, CDB),
)
"""Formats that are read, and where; ``readers.foreign.formats`` names its entries by these."""

ZIPPED = (
    (r"content\.xml$", Known("an OpenDocument file (.ods)", AS_CSV)),  # [D]
    (r"(word|ppt)/", Known("an Office document", "Give the table itself as CSV")),  # [D]
    (r"modelDescription\.xml$", Known("a simulation unit (.fmu)", _CHANNELS)),  # [D]
)
"""What a ZIP archive is, by the name of a file in it."""
