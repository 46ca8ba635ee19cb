"""Decks as files: INCLUDE in every spelling, encodings, sections, and blocks beside the model."""

import gzip

import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.nastran.deck.bdf import read_bdf
from fatigue.readers.foreign.nastran.deck.lines import read_deck

GRIDS = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\n"
QUAD = GRIDS + "PSHELL,1,1,2.,1,,1\nCQUAD4,1,1,1,2,3,4\n"


def texts(path) -> list[str]:
    """Bulk data lines."""
    return [line for _, _, line in read_deck(path).bulk]


@pytest.fixture
def tree(tmp_path, monkeypatch):
    """Write files in folders, with the first as the root deck; an environment variable names the folder of parts."""

    def write(files):
        for name, content in files.items():
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        return tmp_path / next(iter(files))

    monkeypatch.setenv("PARTS", str(tmp_path / "parts"))
    monkeypatch.setenv("DOS_DRIVE_Q", str(tmp_path))
    return write


@pytest.mark.parametrize(
    ("statement", "file"),
    [
        ("INCLUDE 'b.inc'", "b.inc"),
        ("include b.inc", "b.inc"),
        ("INCLUDE'b.inc' $ comment", "b.inc"),
        ("INCLUDE b.inc $ comment", "b.inc"),
        ('  Include  "b.inc"', "b.inc"),
        ("INCLUDE = b.inc", "b.inc"),
        ("INCLUDE,'b.inc'", "b.inc"),
        ("INCLUDE 'a $5 b.inc' $ comment", "a $5 b.inc"),
        ("INCLUDE a b.inc", "a b.inc"),
        ("INCLUDE sub/\\deep\\b.inc", "sub/deep/b.inc"),
        ("INCLUDE '.\\sub\\b.inc'", "sub/b.inc"),
        ("INCLUDE 'SUB/B.INC'", "Sub/b.Inc"),
        ("INCLUDE 'sub/\n  deep/\n  b.inc'", "sub/deep/b.inc"),
        ("INCLUDE sub /deep /'b c.inc'", "sub/deep/b c.inc"),
        ("INCLUDE sub,\n$ a comment\n'/deep' /b.inc", "sub/deep/b.inc"),
        ("INCLUDE PARTS:b.inc", "parts/b.inc"),
        ("INCLUDE 'parts:deep\\b.inc'", "parts/deep/b.inc"),
        ("INCLUDE '$PARTS/b.inc'", "parts/b.inc"),
        ("INCLUDE ${PARTS}/b.inc", "parts/b.inc"),
        ("INCLUDE %PARTS%/b.inc", "parts/b.inc"),
        ("INCLUDE Q:\\sub\\b.inc", "sub/b.inc"),
        ("INCLUDE b.inc", "b.inc.gz"),
    ],
)
def test_spellings_of_include(tree, statement, file):
    """Quotation marks, comments, lines, slashes, letter case, logical symbols, variables, drives, gzip."""
    content = gzip.compress(b"GRID,9\n") if file.endswith(".gz") else "GRID,9\n"
    root = tree({"a.bdf": f"GRID,1\n{statement}\nGRID,2\n", file: content})
    assert texts(root) == ["GRID,1", "GRID,9", "GRID,2"]


def test_an_umlaut_in_a_name(tree):
    """A deck in one byte for each letter names a file with an umlaut."""
    root = tree({"a.bdf": "$ L\xe4nge\nINCLUDE 'tr\xe4ger.inc'\n".encode("latin-1"), "träger.inc": "GRID,9\n"})
    assert texts(root) == ["GRID,9"]


def test_nested_includes_beside_the_root_or_the_including_file(tree):
    """Either place will do; where both hold a file and they differ, the doubt is said and the nearer one is read."""
    root = tree({"a.bdf": "INCLUDE 'sub/b.inc'\n", "sub/b.inc": "INCLUDE 'c.inc'\n", "c.inc": "GRID,1\n"})
    assert texts(root) == ["GRID,1"]
    root = tree({"a.bdf": "INCLUDE 'sub/b.inc'\n", "sub/c.inc": "GRID,1\n"})
    assert read_deck(root).warnings == ()
    root = tree({"a.bdf": "INCLUDE 'sub/b.inc'\n", "sub/c.inc": "GRID,2\n"})
    assert texts(root) == ["GRID,2"]
    (warning,) = read_deck(root).warnings
    assert warning.code == "two_includes"
    assert f"{root.parent}/sub/c.inc or {root.parent}/c.inc, which differ; the first is read" in warning.what
    assert warning.where == f"{root.parent}/sub/b.inc, line 1"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("GRID,1\nINCLUDE 'none.inc'\n", r"a\.bdf, line 2: INCLUDE 'none.inc' is not found, looked for .*none\.inc"),
        ("INCLUDE 'open\n", "line 1: the file name has no end"),
        ("INCLUDE  $ nothing\n", "line 1: INCLUDE names no file"),
        ("INCLUDE\n'b.inc'\n", "line 1: INCLUDE names no file"),
        ("INCLUDE 'b.inc\n" + 99 * "GRID    1       2\n" + "INCLUDE 'c.inc'\n", "line 1: the file name has no end"),
        (f"INCLUDE '{300 * 'x'}'\n", "line 1: .* is not found"),
        ("INCLUDE HERE:b.inc\n", "line 1: .* needs the logical symbol HERE, which is not set"),
        ("INCLUDE 'D:\\models\\b.inc'\n", "line 1: INCLUDE 'D:.* names a drive of Windows. Set .*DOS_DRIVE_D"),
        ("INCLUDE 'a.bdf'\n", "line 1: the file .* includes itself"),
        ("INCLUDE 'folder'\n", "line 1: INCLUDE 'folder' is not found"),
        ("INCLUDE 'zero.inc'\n", "line 1: .*zero.inc is a binary file"),
        ("BEGIN SUPER=1\n", "superelements"),
        ("SOL 101\nCEND\nSET 1 = 1,2\nGRID,1\n", "line 2: CEND stands here and no BEGIN BULK anywhere"),
        ("SOL 101\nCEND\nBEGIN BULK\nGRID,1\nBEGIN BULK SUPER=2\n", "line 5: .*superelements"),
        ("BEGIN BULK\nBEGIN,FEMODEL,door\n", "parts"),
        ("BEGIN BULK\nBEGIN STRANGE\n", "unknown block"),
    ],
)
def test_refusals(tree, text, words):
    """One line for each mistake, with the including file and line."""
    root = tree({"a.bdf": text, "folder/x": "", "zero.inc": b"GRID,1\0\0GRID,2\n"})
    with pytest.raises(DataError, match=words):
        read_deck(root)


def test_all_missing_includes_are_named(tree):
    """A deck without its parts says which, not only the first."""
    with pytest.raises(DataError) as error:
        read_deck(tree({"a.bdf": "INCLUDE 'x.inc'\nINCLUDE 'y.inc'\nINCLUDE 'sub/z.inc'\n", "sub/q": ""}))
    assert [problem.where[-6:] for problem in error.value.problems] == ["line 1", "line 2", "line 3"]


def test_includes_of_the_control_sections(tree):
    """They may be missing, as weld lines need no more of them than SETs; the note names them."""
    deck = "INCLUDE 'SSSALTERDIR:alter.v2001'\nSOL 103\nINCLUDE 'sets.inc'\nCEND\nINCLUDE 'case.inc'\nBEGIN BULK\n"
    root = tree({"a.bdf": deck + QUAD, "case.inc": "SET 5 = 1,\n 2\n"})
    model = read_bdf(root)
    assert model.node_sets[5].tolist() == [1, 2]
    assert [r.code for r in model.warnings] == ["control_include", "control_include"]
    assert "SSSALTERDIR" in model.warnings[0].what


@pytest.mark.parametrize(
    "frame",
    [
        "{}",
        "BEGIN BULK\n{}ENDDATA\n",
        "SOL 103\nCEND\nBEGIN BULK\n{}ENDDATA 58e050da\n",
        "NASTRAN SYSTEM(151)=1\nINIT MASTER(S)\nASSIGN OUTPUT2='x.op2'\nSOL SEMODES\nCEND\nbegin   bulk\n{}enddata",
        "$$ OptiStruct\nFORMAT OP2\nSUBCASE 1\n  METHOD(STRUCTURE) = 2\nBEGIN BULK\n$HMNAME COMP 1\n{}ENDDATA\n",
        "SOL 101\nCOMPILE SUBDMAP=X\nBEGIN $\nALTER 2\nCEND\nBEGIN BULK\n{}",
        "SOL 101\nCEND\nBEGIN BULK SUPER=0\n{}ENDDATA\n",
        "BEGIN,BULK\nECHOOFF\n{}ECHOON\n",
    ],
)
def test_frames_of_a_deck(tree, frame):
    """Pure bulk data and the control sections of several solvers."""
    assert read_bdf(tree({"a.bdf": frame.format(QUAD)})).mesh.element.tolist() == [1]


@pytest.mark.parametrize(
    "data",
    [
        QUAD.replace("\n", "\r\n").encode(),
        QUAD.replace("\n", "\r").encode(),
        b"\xef\xbb\xbf" + QUAD.encode(),
        QUAD.encode() + b"\x1a",
        QUAD.encode() + b"\x1a\0\0\0",
        QUAD.encode("utf-16"),
        ("$ \xdcber\n" + QUAD).encode("latin-1"),
        ("$ a\u2028b\x85c\x0bd\n" + QUAD).encode(),
        QUAD.replace("GRID,3", "\f\nGRID,3").replace("GRID,4", "\fGRID,4").encode(),
        QUAD.lower().encode(),
        QUAD.replace("\n", "   $ comment, with commas\n\n  \n$\n").encode(),
        ("# one\n// two\n" + QUAD).encode(),
    ],
)
def test_bytes_of_a_deck(tree, data):
    """Line ends, byte order marks, marks of the end, encodings, odd separators in comments, form feeds."""
    model = read_bdf(tree({"a.bdf": data}))
    assert (model.mesh.element.tolist(), model.mesh.node.tolist()) == ([1], [1, 2, 3, 4])
    assert model.warnings == ()


def test_sections_in_included_files(tree):
    """BEGIN BULK and ENDDATA may stand in an included file; what follows ENDDATA is not read, and that is said."""
    root = tree({"a.bdf": "SOL 101\nCEND\nINCLUDE 'b.inc'\n", "b.inc": "SET 1 = 2\nBEGIN BULK\n" + QUAD})
    assert read_bdf(root).node_sets[1].tolist() == [2]
    files = {"a.bdf": "INCLUDE 'b.inc'\nGRID,9\n$\nINCLUDE 'none.inc'\nENDDATA\n", "b.inc": QUAD + "ENDDATA\n"}
    (warning,) = read_bdf(tree(files)).warnings
    assert (warning.code, warning.count) == ("after_enddata", 2)
    assert warning.where.endswith("b.inc, line 7")


@pytest.mark.parametrize(
    "block",
    [
        "BEGIN AUXMODEL=1\nGRID,1,,7.,7.,7.\nCQUAD4,9,1,1,2,3,4\n",
        "BEGIN BULK ARBMODEL=3\nGRID,1,,7.,7.,7.\nPOINT,1\n",
        "BEGIN,HYPRBEAM,square\nGRIDS,1,0.,0.\nCSEC2,10,100,1,2\nEND,HYPRBEAM\n",
    ],
)
def test_blocks_beside_the_model(tree, block):
    """Auxiliary models and beam sections are left out with a note, and do not touch the model."""
    after = "GRID,9,,5.,5.,5.\n" if "END," in block else ""
    model = read_bdf(tree({"a.bdf": "BEGIN BULK\n" + QUAD + block + after}))
    assert model.mesh.node.tolist() == [1, 2, 3, 4] + [9] * bool(after)
    assert [(r.code, r.count) for r in model.warnings] == [("block_left_out", 2)]
