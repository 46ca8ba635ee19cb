"""Each foreign format is one entry, of which all that is said about it is made."""

import inspect

import pytest

from fatigue.files.extras import REQUIREMENTS
from fatigue.files.known_formats import OWN
from fatigue.readers.foreign.formats import (
    CHANNELS,
    COORDINATES,
    FORCES,
    FORMATS,
    MESH,
    STRESSES,
    all_formats,
    formats_called,
)

PARAMETERS = {
    FORCES: ["path", "subcase", "interface", "loads"],
    MESH: ["path"],
    COORDINATES: ["path", "columns", "time_column"],
    STRESSES: ["path", "wanted"],
    CHANNELS: ["path"],
}


def test_no_two_formats_are_told_alike():
    """Keys, names and endings differ; one format alone is what no signature tells."""
    for told in ("key", "name", "ending"):
        assert len({getattr(form, told) for form in FORMATS}) == len(FORMATS), told
    assert [form.key for form in FORMATS if form.is_plain_text] == ["text"]
    assert not [form.key for form in FORMATS if form.signature and form.looks_like]


@pytest.mark.parametrize("form", FORMATS, ids=lambda form: form.key)
def test_an_entry_leads_to_its_readers(form):
    """Every function is there and takes what it is called with; a package that it needs has a version to install."""
    assert form.reads
    if form.extra is not None:
        pytest.importorskip(form.extra.package)
    for content, reader in form.reads.items():
        assert list(inspect.signature(reader.load()).parameters) == PARAMETERS[content]
    assert not form.looks_like or form.fits_text("nothing at all") is False
    assert form.extra is None or form.extra.package in REQUIREMENTS


@pytest.mark.parametrize("form", [form for form in FORMATS if not form.is_plain_text], ids=lambda form: form.key)
def test_a_format_that_is_read_is_known_where_it_is_not(form):
    """Given for a table of a case, it is told by the same name and by the same first bytes."""
    known = [own for own in OWN if own.name.startswith(form.name)]
    assert known
    assert form.signature is None or form.signature in known


def test_what_messages_say_of_the_formats():
    """The usual one first, all of them in one list."""
    assert formats_called(FORCES) == (
        "an .op2, an MSC .h5, a punch file, the text of the export script or the text of the ANSYS macro"
    )
    assert formats_called(MESH) == (
        "the deck (.bdf, .dat), the MSC .h5, an Abaqus .inp, the text of the export script or an ANSYS .cdb"
    )
    assert formats_called(STRESSES) == ("an .op2 or an MSC .h5")
    assert formats_called(COORDINATES) == (
        "a text table, punch (SDISPLACEMENT), .parquet, .mcf, an RPC III .rsp, .uff, .mf4, .tdms, .npy, .npz, "
        ".mat, MATLAB 7.3, .xlsx or Adams .res (XML)"
    )
    assert all_formats() == (
        ".op2, MSC .h5, .pch, .bdf, .inp, the text of the export script, the text of the ANSYS macro, .cdb, .mcf,"
        " .parquet, a text table, .npy, .npz, .mat, MATLAB 7.3, .xlsx, .res, .rsp, .uff, .mf4 or .tdms"
    )
