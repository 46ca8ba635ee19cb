"""Text tables as office programs, solvers and scripts write them: read alike by every reader of tables with names."""

from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest

from fatigue.errors import DataError
from fatigue.readers.neutral.csv_columns import csv_batches
from fatigue.readers.neutral.tables import open_table
from fatigue.readers.text.layout import table_layout
from fatigue.readers.text.numbers import as_numbers, is_number, plain_number, split_fields
from fatigue.readers.text.rows import read_rows
from fatigue.verify.recount.inputs.tables import read_frame

PLAIN = "weld,x_mm,n\nTräger,1.5,7\nb,-2500.0,8\n"
DIALECTS = {
    "plain": PLAIN.encode(),
    "byte order mark": PLAIN.encode("utf-8-sig"),
    "utf-16": PLAIN.encode("utf-16"),
    "utf-16 big": b"\xfe\xff" + PLAIN.encode("utf-16-be"),
    "utf-16 without mark": PLAIN.encode("utf-16-le"),
    "cp1252": PLAIN.encode("cp1252"),
    "semicolons": PLAIN.replace(",", ";").encode(),
    "tabs": PLAIN.replace(",", "\t").encode(),
    "bars": PLAIN.replace(",", "|").encode(),
    "blanks": PLAIN.replace(",", "   ").encode(),
    "decimal commas": PLAIN.replace(",", ";").replace(".", ",").encode(),
    "German Excel": ("sep=;\r\n" + PLAIN.replace(",", ";").replace(".", ",").replace("\n", "\r\n")).encode("cp1252"),
    "Excel as Unicode text": PLAIN.replace(",", "\t").replace(".", ",").replace("\n", "\r\n").encode("utf-16"),
    "Fortran": PLAIN.replace("1.5", "0.15D+01").replace("-2500.0", "-2.5d3").encode(),
    "Fortran without letter": PLAIN.replace("1.5", "0.15+01").replace("-2500.0", "-2.5+3").encode(),
    "Fortran and commas": PLAIN.replace(",", ";").replace("1.5", "0,15D+01").replace("-2500.0", "-2,5D+3").encode(),
    "comment": ("# written today, 3 welds\n" + PLAIN).encode(),
    "comments": ("% a\n! b\n// c\n\n" + PLAIN).encode(),
    "names in the comment": ("# " + PLAIN).encode(),
    "names again": (PLAIN + "weld,x_mm,n\n").encode(),
    "names between": PLAIN.replace("b,-", "weld,x_mm,n\nb,-").encode(),
    "units": PLAIN.replace("x_mm,n\n", "x_mm,n\n,[mm],-\n").encode(),
    "units, bare": PLAIN.replace("x_mm,n\n", "x_mm,n\n-,mm,-\n").encode(),
    "blank lines": PLAIN.replace("\n", "\n\n").encode(),
    "blanks around": PLAIN.replace(",", " , ").encode(),
    "quoted": b'"weld","x_mm","n"\n"Tr\xc3\xa4ger","1.5","7"\n"b","-2500.0","8"\n',
    "decimal commas in quotation marks": PLAIN.replace("1.5", '"1,5"').replace("-2500.0", '"-2500,0"').encode(),
    "names in two lines": PLAIN.replace("x_mm", '"x_mm\n"').encode(),
    "old Mac": PLAIN.replace("\n", "\r").encode(),
    "no line end": PLAIN.rstrip().encode(),
    "utf-32": PLAIN.encode("utf-32"),
    "typographic minus": PLAIN.replace("-", "\u2212").encode(),
    "end of a file of DOS": PLAIN.encode() + b"\x1a",
    "blanks before quotation marks": PLAIN.replace("Träger,", '"Träger" , ').replace(",7", ', "7"').encode(),
}
BEHIND = {
    "rows": PLAIN.replace("7\n", "7,\n").replace("8\n", "8,\n"),
    "names": PLAIN.replace("n\n", "n,\n", 1),
    "rows and names": PLAIN.replace("\n", ",,\n"),
    "names, two of them": PLAIN.replace("n\n", "n,,\n", 1),
}


@pytest.fixture(params=DIALECTS, name="path")
def in_every_dialect(request, tmp_path):
    """One table in every dialect."""
    path = tmp_path / "t.csv"
    path.write_bytes(DIALECTS[request.param])
    return path


def test_tables(path):
    """Neutral tables give the same names and numbers in every dialect."""
    table = open_table(path, texts=("weld",))
    table.expect(("weld", "x_mm", "n"), (), strict=True)
    assert table.texts("weld") == ["Träger", "b"]
    assert table.numbers("x_mm").tolist() == [1.5, -2500.0]
    assert table.integers("n").tolist() == [7, 8]
    table.refuse()
    assert table.row_name(0) == "row 1"


def test_rows_of_texts(path):
    """A register gives the same cells in every dialect, its numbers with a decimal point."""
    if b"[mm]" in path.read_bytes() or b",mm," in path.read_bytes():
        pytest.skip("registers have no row of units")
    names, rows = read_rows(path, numbers=("x_mm",))
    assert names == ("weld", "x_mm", "n")
    assert [row.cells["weld"] for row in rows] == ["Träger", "b"]
    assert [float(row.cells["x_mm"]) for row in rows] == [1.5, -2500.0]
    assert [row.number for row in rows] == [1, 2]


@pytest.mark.parametrize("content", BEHIND.values(), ids=BEHIND)
def test_separators_behind(tmp_path, content):
    """Separators behind rows or names alone hold nothing."""
    path = tmp_path / "t.csv"
    path.write_text(content, encoding="utf-8")
    table = open_table(path, texts=("weld",))
    table.expect(("weld", "x_mm", "n"), (), strict=True)
    assert table.integers("n").tolist() == [7, 8]
    table.refuse()
    assert [row.cells["n"] for row in read_rows(path)[1]] == ["7", "8"]
    assert read_frame(path)["n"].tolist() == [7, 8]


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_names_of_texts_in_a_comment(tmp_path, separator):
    """A table without numbers whose names stand in the comment above."""
    path = tmp_path / "t.csv"
    path.write_text(separator.join(["# weld", "surface\nb", '"a,b,c"\nd', "top\n"]), encoding="utf-8")
    assert open_table(path, texts=("weld", "surface")).texts("surface") == ["a,b,c", "top"]
    assert read_frame(path)["surface"].tolist() == ["a,b,c", "top"]


def test_batches(path):
    """Large tables of forces are read in pieces in every dialect without repeated names."""
    if path.read_bytes().count(b"x_mm") > 1:
        pytest.skip("read as a whole")
    kinds = {"weld": pa.string(), "x_mm": pa.float64(), "n": pa.int64()}
    table = pa.Table.from_batches(csv_batches(path, table_layout(path, ("weld",)), kinds))
    assert table.column("x_mm").to_pylist() == [1.5, -2500.0]
    assert table.column("n").to_pylist() == [7, 8]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("sep=;\na,b\n1,2\n", "t.csv: line 2: the file declares sep=;, and its columns are separated by ','. Correct"),
        ("a;b\n1,5;2.5\n", "t.csv: numbers are written with points (2.5) and with commas (1,5). Write one decimal"),
        ("a,b\n0,5,1,5\n", "t.csv: row 1: 4 cells in a table of 2 columns: commas stand between the columns and"),
        ("a,b\n0,1\n0,1,1,5\n", "t.csv: row 2: 4 cells in a table of 2 columns: commas stand between the columns and"),
        ("a,b\n0,5,1\n", "t.csv: row 1: 3 cells in a table of 2 columns: commas stand between the columns and"),
        ("a;b\n1;2;3\n", "t.csv: row 1: 3 cells in a table of 2 columns. Write one cell per column"),
        (
            "x_mm,b\n[m],-\n1,2\n",
            "t.csv: column x_mm, row of units: the unit is [m], and the column is one of mm. Conv",
        ),
        ("time_s,q_1\nms,-\n1,2\n", "t.csv: column time_s, row of units: the unit is ms, and the column is one of s."),
        ("time_s,q_1\ns,m\n1,2\n", "t.csv: column q_1, row of units: the unit is m, and the column is one of mm, or m"),
        (
            'a,b\n1,"1,234"\n2,"5,678"\n',
            "t.csv: 1,234 may have a decimal comma or a thousands separator. Write points,",
        ),
        ('a,b\n1.5,"1,234.5"\n', "t.csv: column b, row 1: '1,234.5' is not a number."),
        ("a,b\n1,\x00\n", "t.csv: line 2: a NUL byte stands in the text; the file is damaged or not a text. Write the"),
        ("", "t.csv: the first line is empty. Write the column names there."),
        ("# only\n# comments\n", "t.csv: the first line is empty. Write the column names there."),
        ("ä,b\n1,2\n".encode() + b"3,\xe4\n", "t.csv: line 3: byte 0xe4 is not UTF-8. Save it as UTF-8."),
        (
            "a,b\n1,2\n".encode("utf-16")[:-1],
            "t.csv: line 2: the text ends within a letter of UTF-16. Save it as UTF-8.",
        ),
    ],
)
def test_contradictions(tmp_path, text, message):
    """What a file states twice in different ways, and what cannot be read, is refused with its place."""
    path = tmp_path / "t.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(DataError) as refusal:
        table = open_table(path)
        table.numbers("b")
        table.refuse()
    assert str(refusal.value).startswith(message)


def test_another_encoding_is_a_doubt(tmp_path):
    """A file in Windows-1252 is read, with a warning that names the letter it was taken for, however far down."""
    path = tmp_path / "t.csv"
    for rows in (0, 50_000):
        path.write_bytes(b"a,b\n" + b"weld,1\n" * rows + b"Tr\xe4ger,2\n")
        table = open_table(path, texts=("a",))
        assert table.texts("a")[-1] == "Träger"
        (warning,) = table.warnings
        assert warning.where == f"t.csv: line {rows + 2}"
        assert warning.what == "byte 0xe4 is not UTF-8; the file is read as Windows-1252, where it is 'ä'"


def test_what_the_head_does_not_show(tmp_path):
    """Exponents of Fortran and repeated names far beyond the head of the file; rows keep their numbers."""
    path = tmp_path / "t.csv"
    body = "w,1.5\n" * 60_000
    path.write_text("a,x\n" + body + "w,1.0D+03\na,x\nw,1.0-02\n")
    table = open_table(path, texts=("a",))
    assert table.numbers("x")[-2:].tolist() == [1000.0, 0.01]
    assert table.row_name(60_001) == "row 60003"
    for number in ("1,5", "1.5", "0,15D+01", "0.15D+01", "15D-1"):
        path.write_text("a;x\n" + "w;1\n" * 60_000 + f"w;{number}\n")
        assert open_table(path, texts=("a",)).numbers("x")[-1] == 1.5
    path.write_text("a,x\n" + "w,1\n" * 60_000 + "w,0.15D+01\n")
    assert open_table(path, texts=("a",)).numbers("x")[-1] == 1.5


def test_a_plain_table_is_read_by_arrow_from_the_file(tmp_path):
    """No copy of a plain table is made, whatever its size."""
    path = tmp_path / "t.csv"
    path.write_text("a,x\nw,1.5\n")
    layout = table_layout(path, ("a",))
    assert (layout.encoding, layout.separator, layout.fortran) == ("utf-8", ",", False)
    assert (layout.names, layout.first, layout.line, layout.units) == (("a", "x"), 1, 1, ())


@pytest.mark.parametrize(
    ("text", "decimal", "value"),
    [
        ("1.0D+03", ".", 1000.0),
        ("-1.5d-2", ".", -0.015),
        ("1.0+03", ".", 1000.0),
        ("1.-103", ".", 1e-103),
        (".5", ".", 0.5),
        ("+7", ".", 7.0),
        ("1,5E3", ",", 1500.0),
        ("1,0Q+03", ",", 1000.0),
    ],
)
def test_numbers(text, decimal, value):
    """A number of any program, one by one and as a column."""
    assert is_number(text, decimal)
    assert float(plain_number(text, decimal)) == value
    assert as_numbers(pa.chunked_array([[text, f" {text} ", "", None]]), decimal).to_pylist() == [
        value,
        value,
        None,
        None,
    ]


@pytest.mark.parametrize(
    "text", ["1-2", "2024-11-29", "1.2.3", "1,234.5", "12:30", "1.5x", "D+3", "1_000", "0x10", "٣"]
)
def test_what_is_no_number(text):
    """Dates, thousands separators, words."""
    for decimal in (".", ","):
        assert not is_number(text, decimal)
        assert plain_number(text, decimal) == text
        assert as_numbers(pa.chunked_array([[text]]), decimal) is None


@pytest.mark.parametrize(
    ("line", "separator", "fields"),
    [
        ('"a, b",c', ",", ["a, b", "c"]),
        ("a;;b;;", ";", ["a", "", "b"]),
        ("'t' \"q 1\"  x", None, ["t", "q 1", "x"]),
        ("  1\t 2  ", None, ["1", "2"]),
        ("", ",", []),
    ],
)
def test_fields(line, separator, fields):
    """Quotation marks, empty cells, blanks."""
    assert split_fields(line, separator) == fields


def test_rows_that_do_not_fit(tmp_path):
    """A register with a cell too many or a column named twice names row and line."""
    path = tmp_path / "r.csv"
    path.write_text("weld,line\na,b\n\na,b,c\n")
    with pytest.raises(DataError, match=r"r\.csv: row 2, line 4: 3 cells in a table of 2 columns"):
        read_rows(path)
    path.write_text("weld,weld\na,b\n")
    with pytest.raises(DataError, match=r"r\.csv: line 1: column weld appears twice"):
        read_rows(path)
    with pytest.raises(DataError, match=r"none\.csv: it cannot be read"):
        read_rows(Path(tmp_path / "none.csv"))


def test_exact_numbers(tmp_path):
    """Numbers are read to the last digit in every dialect."""
    values = np.random.default_rng(3).standard_normal(200)
    path = tmp_path / "t.csv"
    for sign in ".,":
        path.write_text("x;n\n" + "".join(f"{v!r};1\n".replace(".", sign) for v in values.tolist()))
        assert np.array_equal(open_table(path).numbers("x"), values)


def test_decimal_signs_in_remarks(tmp_path):
    """What stands in a column of texts says nothing of the decimal sign."""
    path = tmp_path / "r.csv"
    path.write_text("weld;thickness_mm;description\na;8,5;2.5\nb;8;t = 3,5 mm\n")
    _, rows = read_rows(path, numbers=("thickness_mm",))
    assert [row.cells["thickness_mm"] for row in rows] == ["8.5", "8"]
    assert [row.cells["description"] for row in rows] == ["2.5", "t = 3,5 mm"]


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("*HEADING\nweld test\n*NODE\n1, 0., 0., 0.\n", "an Abaqus deck"),
        ("/COM,ANSYS\n/PREP7\nNBLOCK,6,SOLID\n(3i9,6e21.13e3)\n", "an ANSYS archive"),
        ("BEGIN BULK\nGRID,1,,0.,0.,0.\n", "a NASTRAN deck"),
    ],
)
def test_a_register_that_is_another_text(tmp_path, text, name):
    """Decks and archives are named, whatever their cells look like."""
    (tmp_path / "r.csv").write_text(text)
    with pytest.raises(DataError, match=f"this is {name}"):
        read_rows(tmp_path / "r.csv")


@pytest.mark.parametrize("text", ["weld,x_mm\na,\nweld,x_mm\nb,\n", "weld , x_mm\na ,  \nb ,  \n"])
def test_a_column_of_empty_cells(tmp_path, text):
    """Empty cells are numbers that are missing, with the names again among them or blanks in them."""
    (tmp_path / "t.csv").write_text(text)
    table = open_table(tmp_path / "t.csv", texts=("weld",))
    assert table.numbers("x_mm", default=7.0).tolist() == [7.0, 7.0]
    table.refuse()
