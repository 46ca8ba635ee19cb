"""The foreign formats that are read, one entry each: recognition, reading, refusals and help are made of them.

A new format is one entry at the end of ``FORMATS``; its name and signature are those of an entry of
``files.known_formats.OWN``. ``ForeignFormat("tdms", TDMS.name, ending=".tdms", place=6, signature=TDMS,
extra=Extra("nptdms", "NI TDMS input"), reads={CHANNELS: Reader("channels.tdms.read_tdms", ".tdms", ".tdms")})`` is
a binary one; a text, as an Abaqus deck, has ``looks_like="abaqus.deck.is_deck"`` in place of ``signature``. A format of
``CHANNELS`` gives modal coordinates, too: ``channels.coordinates`` finds them among the groups that it reads.
"""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import Any

from fatigue.files.known_formats import (
    ADAMS,
    ANSYS_TEXT,
    CDB,
    DECK,
    EXPORT,
    HDF5,
    INP,
    MATLAB,
    MATLAB_73,
    MDF,
    NPY,
    NPZ,
    OP2,
    PARQUET,
    PUNCH,
    RPC,
    TDMS,
    UNIVERSAL,
    WORKBOOK,
    Known,
)


@dataclass(frozen=True, slots=True)
class Content:
    """What files may hold: its name in messages, the option it is given to, and the code of a file without it."""

    name: str
    option: str
    code: str


FORCES = Content("grid point forces", "--forces", "no_forces")
MESH = Content("mesh", "--mesh", "no_mesh")
STRESSES = Content("shell stresses", "--stresses", "no_stresses")
COORDINATES = Content("modal coordinates", "--coordinates", "no_coordinates")
CHANNELS = Content("channels", "fatigue channels", "no_channels")


@dataclass(frozen=True, slots=True)
class Reader:
    """The function that reads one content of a format, imported when it is first needed.

    Attributes
    ----------
    function : where it is, below ``fatigue.readers.foreign``
    called : the format in messages, as one that may be given instead
    in_help : the format in the help of the option; empty where it is not named there
    """

    function: str
    called: str
    in_help: str = ""

    def load(self) -> Callable[..., Any]:
        """Import the function."""
        return _imported(self.function)


@dataclass(frozen=True, slots=True)
class Extra:
    """A package that only one format needs, and what needs it."""

    package: str
    needed_for: str


@dataclass(frozen=True, slots=True)
class ForeignFormat:
    """One foreign format.

    Attributes
    ----------
    key : its short name in messages
    name : what a file of the format is called
    ending : its name in the list of all formats
    place : its place in that list, lowest first; of equal ones in the order of ``FORMATS``
    reads : readers by what they read
    signature : how a binary format begins
    looks_like : function that tells the format of a text by its beginning, below ``fatigue.readers.foreign``
    extra : package that has to be installed
    belongs : to what a file is given besides the options of its contents, or when
    """

    key: str
    name: str
    ending: str
    place: int
    reads: Mapping[Content, Reader]
    signature: Known | None = None
    looks_like: str = ""
    extra: Extra | None = None
    belongs: str = ""

    @property
    def is_plain_text(self) -> bool:
        """Whether nothing tells the format but that it is a text, and none of the others."""
        return self.signature is None and not self.looks_like

    @property
    def home(self) -> str:
        """Where a file of the format belongs."""
        return " or ".join(content.option for content in self.holds if content != CHANNELS) + self.belongs

    @property
    def holds(self) -> dict[Content, Reader]:
        """Readers by what files may hold: among channels there may be modal coordinates."""
        among = {COORDINATES: self.reads[CHANNELS]} if CHANNELS in self.reads else {}
        return among | dict(self.reads)

    def fits_bytes(self, head: bytes) -> bool:
        """Whether a binary file begins like this format."""
        return self.signature is not None and self.signature.fits(head)

    def fits_archive(self, names: Collection[str]) -> bool:
        """Whether a ZIP archive of files of these names is of this format."""
        return self.signature is not None and self.signature.fits_archive(names)

    def fits_text(self, head: str) -> bool:
        """Whether a text begins like this format."""
        return self.is_plain_text or (self.looks_like != "" and bool(_imported(self.looks_like)(head)))


FORMATS = (
    ForeignFormat(
        "text",
        "a text table",
        ending="a text table",
        place=7,
        reads={
            COORDINATES: Reader("histories.text.read_text_history", "a text table", "CSV, text"),
            CHANNELS: Reader("channels.tables.table.read_text_channels", "a text table", "CSV, text"),
        },
        belongs=" if it holds them",
    ),
    ForeignFormat(
        "bdf",
        DECK.name,
        ending=".bdf",
        place=4,
        reads={MESH: Reader("nastran.deck.bdf.read_bdf", "the deck (.bdf, .dat)", "BDF")},
        looks_like="nastran.deck.lines.is_deck",
    ),
    ForeignFormat(
        "op2",
        OP2.name,
        ending=".op2",
        place=1,
        reads={
            FORCES: Reader("nastran.results.op2.read_op2", "an .op2", "OP2"),
            STRESSES: Reader("nastran.results.op2_stresses.read_op2_stresses", "an .op2", "OP2"),
        },
        signature=OP2,
    ),
    ForeignFormat(
        "h5",
        HDF5.name,
        ending="MSC .h5",
        place=2,
        reads={
            FORCES: Reader("nastran.results.h5.read_h5", "an MSC .h5", "MSC .h5"),
            MESH: Reader("nastran.results.h5.read_h5_model", "the MSC .h5", "the same MSC .h5"),
            STRESSES: Reader("nastran.results.h5_stresses.read_h5_stresses", "an MSC .h5", "MSC .h5"),
        },
        signature=HDF5,
        extra=Extra("h5py", "MSC HDF5 input"),
    ),
    ForeignFormat(
        "punch",
        PUNCH.name,
        ending=".pch",
        place=3,
        reads={
            FORCES: Reader("nastran.results.punch.read_punch", "a punch file", "punch"),
            CHANNELS: Reader("nastran.results.solution_punch.read_solution_punch", "punch (SDISPLACEMENT)", "punch"),
        },
        looks_like="nastran.results.punch.is_punch",
    ),
    ForeignFormat(
        "parquet",
        PARQUET.name,
        ending=".parquet",
        place=6,
        reads={
            COORDINATES: Reader("histories.text.read_parquet_history", ".parquet"),
            CHANNELS: Reader("channels.tables.table.read_parquet_channels", ".parquet"),
        },
        signature=PARQUET,
        belongs=", or, if it is a table of a case, to case.toml",
    ),
    ForeignFormat(
        "mcf",
        "an ANSYS file of modal coordinates",
        ending=".mcf",
        place=5,
        reads={
            COORDINATES: Reader("histories.mcf.read_mcf", ".mcf", ".mcf"),
            CHANNELS: Reader("channels.tables.table.read_mcf_channels", ".mcf", ".mcf"),
        },
        looks_like="histories.mcf.is_mcf",
    ),
    ForeignFormat(
        "rpc",
        RPC.name,
        ending=".rsp",
        place=9,
        reads={CHANNELS: Reader("channels.rpc.read_rpc", "an RPC III .rsp", ".rsp")},
        signature=RPC,
    ),
    ForeignFormat(
        "universal",
        UNIVERSAL.name,
        ending=".uff",
        place=9,
        reads={CHANNELS: Reader("channels.universal.read_universal", ".uff", ".uff")},
        signature=UNIVERSAL,
        extra=Extra("pyuff", "universal file input"),
    ),
    ForeignFormat(
        "mdf",
        MDF.name,
        ending=".mf4",
        place=9,
        reads={CHANNELS: Reader("channels.mdf.read_mdf", ".mf4", ".mf4")},
        signature=MDF,
        extra=Extra("asammdf", "ASAM MDF input"),
    ),
    ForeignFormat(
        "tdms",
        TDMS.name,
        ending=".tdms",
        place=9,
        reads={CHANNELS: Reader("channels.tdms.read_tdms", ".tdms", ".tdms")},
        signature=TDMS,
        extra=Extra("nptdms", "NI TDMS input"),
    ),
    ForeignFormat(
        "npy",
        NPY.name,
        ending=".npy",
        place=8,
        reads={CHANNELS: Reader("channels.arrays.read_npy", ".npy")},
        signature=NPY,
    ),
    ForeignFormat(
        "npz",
        NPZ.name,
        ending=".npz",
        place=8,
        reads={CHANNELS: Reader("channels.arrays.read_npz", ".npz", ".npz")},
        signature=NPZ,
    ),
    ForeignFormat(
        "mat",
        MATLAB.name,
        ending=".mat",
        place=8,
        reads={CHANNELS: Reader("channels.matlab.read_matlab", ".mat", ".mat")},
        signature=MATLAB,
    ),
    ForeignFormat(
        "mat73",
        MATLAB_73.name,
        ending="MATLAB 7.3",
        place=8,
        reads={CHANNELS: Reader("channels.matlab_73.read_matlab_73", "MATLAB 7.3")},
        signature=MATLAB_73,
        extra=Extra("h5py", "MATLAB 7.3 input"),
    ),
    ForeignFormat(
        "xlsx",
        WORKBOOK.name,
        ending=".xlsx",
        place=8,
        reads={CHANNELS: Reader("channels.tables.workbook.read_workbook", ".xlsx", ".xlsx")},
        signature=WORKBOOK,
        extra=Extra("python_calamine", "Excel input"),
    ),
    ForeignFormat(
        "res",
        ADAMS.name,
        ending=".res",
        place=8,
        reads={CHANNELS: Reader("adams.results_xml.read_adams_results", "Adams .res (XML)", "Adams .res")},
        looks_like="adams.results_xml.is_adams_results",
    ),
    ForeignFormat(
        "inp",
        INP.name,
        ending=".inp",
        place=4,
        reads={MESH: Reader("abaqus.deck.read_inp", "an Abaqus .inp", "Abaqus .inp")},
        looks_like="abaqus.keywords.is_deck",
    ),
    ForeignFormat(
        "export",
        EXPORT.name,
        ending="the text of the export script",
        place=4,
        reads={
            FORCES: Reader("export.read.read_export", "the text of the export script", "text of the export script"),
            MESH: Reader("export.read.read_export_model", "the text of the export script", "text of the export script"),
        },
        looks_like="export.layout.is_export",
    ),
    ForeignFormat(
        "ansys",
        ANSYS_TEXT.name,
        ending="the text of the ANSYS macro",
        place=4,
        reads={
            FORCES: Reader("ansys.forces.read_ansys_forces", "the text of the ANSYS macro", "text of the ANSYS macro")
        },
        looks_like="ansys.forces.is_ansys_export",
    ),
    ForeignFormat(
        "cdb",
        CDB.name,
        ending=".cdb",
        place=4,
        reads={MESH: Reader("ansys.archive.read_archive", "an ANSYS .cdb", "ANSYS .cdb")},
        looks_like="ansys.archive.is_archive",
    ),
)
"""From the usual to the special: messages name them in this order, a file is recognised in the reverse one."""


def formats_called(content: Content) -> str:
    """Formats that hold a content, as messages call them."""
    return one_of([form.holds[content].called for form in FORMATS if content in form.holds])


def formats_in_help(content: Content, last: str = " or ") -> str:
    """Formats that hold a content, as the help of its option calls them."""
    return one_of([reader.in_help for form in FORMATS if (reader := form.holds.get(content)) and reader.in_help], last)


def all_formats() -> str:
    """All formats that are read, in one sentence."""
    return one_of([form.ending for form in sorted(FORMATS, key=lambda form: form.place)])


def one_of(words: list[str], last: str = " or ") -> str:
    """Choice of words: ``a, b or c``."""
    return last.join(filter(None, [", ".join(words[:-1]), words[-1]]))


def _imported(function: str) -> Callable[..., Any]:
    module, _, name = function.rpartition(".")
    found: Callable[..., Any] = getattr(import_module(f"fatigue.readers.foreign.{module}"), name)
    return found
