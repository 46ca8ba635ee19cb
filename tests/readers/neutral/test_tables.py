"""Opening tables and reading their columns: what is accepted, and what is said about everything else."""

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet as pq
import pytest

from fatigue.errors import DataError
from fatigue.readers.neutral.tables import Table, open_table


def csv(tmp_path: Path, text: str | bytes) -> Path:
    """Write a CSV file."""
    path = tmp_path / "t.csv"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


def parquet(tmp_path: Path, columns: dict[str, pa.Array]) -> Path:
    """Write a Parquet file."""
    path = tmp_path / "t.parquet"
    pq.write_table(pa.table(columns), path)
    return path


def only_problem(table: Table) -> str:
    """Message of the only problem noted."""
    assert len(table.problems) == 1
    return str(table.problems[0])


def test_missing_file(tmp_path):
    """The message shows the whole path."""
    for name in ("no.csv", "no.parquet"):
        with pytest.raises(DataError) as refusal:
            open_table(tmp_path / name)
        assert str(refusal.value) == f"{tmp_path / name}: there is no such file. Correct the path."


def test_folder(tmp_path):
    """A folder, as partitioned Parquet data is, is no table."""
    (tmp_path / "t.parquet").mkdir()
    with pytest.raises(DataError, match=r"t\.parquet: this is a folder\. Give a \.parquet or \.csv file\.$"):
        open_table(tmp_path / "t.parquet")


def test_unknown_kind_of_file(tmp_path):
    """A spreadsheet is not guessed at."""
    (tmp_path / "t.xlsx").write_bytes(b"PK")
    with pytest.raises(DataError, match=r"t\.xlsx: unknown kind of file '\.xlsx'\. Give a \.parquet or \.csv file\.$"):
        open_table(tmp_path / "t.xlsx")


def test_no_permission(tmp_path, monkeypatch):
    """A file that may not be read is refused."""
    path = csv(tmp_path, "a\n1\n")

    def denied(*_, **__):
        raise PermissionError

    monkeypatch.setattr(Path, "open", denied)
    with pytest.raises(DataError, match=r"t\.csv: may not be read\. Check its permissions\.$"):
        open_table(path)


@pytest.mark.parametrize("content", [b"", b"PAR1", b"a,b\n1,2\n", b"PAR1" + b"\0" * 50 + b"PAR1"])
def test_not_parquet(tmp_path, content):
    """A file that only has the name of a Parquet file is refused."""
    path = tmp_path / "t.parquet"
    path.write_bytes(content)
    with pytest.raises(
        DataError, match=r"^t\.parquet: cannot be read as Parquet, it is damaged or cut short \(.*\)\. Wri"
    ):
        open_table(path)


def test_truncated_parquet(tmp_path):
    """A Parquet file that lost its end is refused when it is opened."""
    path = parquet(tmp_path, {"a": pa.array(np.arange(1000.0))})
    path.write_bytes(path.read_bytes()[:-100])
    with pytest.raises(DataError, match=r"^t\.parquet: cannot be read as Parquet"):
        open_table(path)


@pytest.mark.parametrize("texts", [(), ("a",)])
def test_parquet_with_undecodable_texts(tmp_path, texts):
    """Bytes that are no UTF-8 in a text column show when it is read."""
    path = parquet(tmp_path, {"a": pa.array(["name_of_weld"] * 5)})
    path.write_bytes(path.read_bytes().replace(b"name_of_weld", b"name\xff\xfe_weld"))
    with pytest.raises(DataError, match=r"^t\.parquet: cannot be read as Parquet"):
        open_table(path, texts=texts).texts("a")


def test_parquet_with_an_undecodable_column_name(tmp_path):
    """Bytes that are no UTF-8 in a column name show when the file is opened."""
    path = tmp_path / "t.parquet"
    pq.write_table(pa.table({"column_a": pa.array([1])}), path, store_schema=False)
    path.write_bytes(path.read_bytes().replace(b"column_a", b"colu\xff\xfe_a"))
    with pytest.raises(DataError, match=r"^t\.parquet: cannot be read as Parquet"):
        open_table(path)


def test_parquet_that_lost_rows(tmp_path):
    """A file that holds fewer rows than it says is refused."""
    path = tmp_path / "t.parquet"
    pq.write_table(pa.table({"a": pa.array([1.0] * 77)}), path, store_schema=False, write_statistics=False)
    data = bytearray(path.read_bytes())
    footer = len(data) - 8 - int.from_bytes(data[-8:-4], "little")
    rows = data.index(b"\x16\x9a\x01", footer)  # third field of the file metadata, 77 as a zigzag varint
    data[rows + 1] += 2
    path.write_bytes(data)
    with pytest.raises(DataError, match=r"^t\.parquet: cannot be read as Parquet"):
        open_table(path).numbers("a")


def test_corrupt_parquet_data(tmp_path):
    """Damage in the values shows when the column is read."""
    path = parquet(tmp_path, {"a": pa.array(np.arange(10_000) % 7)})
    data = bytearray(path.read_bytes())
    data[4:200] = b"\xff" * 196
    path.write_bytes(data)
    with pytest.raises(DataError, match=r"^t\.parquet: cannot be read as Parquet"):
        open_table(path).integers("a")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "t.csv: the first line is empty. Write the column names there."),
        ("\na\n1\n", "t.csv: the first line is empty. Write the column names there."),
        ("a,b\n", "t.csv: the table has no rows. Write at least one row."),
        (
            "a,b\n1,2\n3\n",
            "t.csv: row 2: 1 cells in a table of 2 columns. Write one cell per column, texts with commas",
        ),
        ("a,b\n1,2\n\n3,4,5\n", "t.csv: row 2: 3 cells in a table of 2 columns. Write one cell per column"),
        (b"tr\x81ger,b\n1,2\n", "t.csv: line 1: byte 0x81 is not UTF-8. Save it as UTF-8."),
        (b"a,b\n1,x\n2,Tr\x81ger\n", "t.csv: line 3: byte 0x81 is not UTF-8. Save it as UTF-8."),
        ("a, b ,a \n1,2,3\n", "t.csv: column a: the column appears twice. Remove one of them."),
    ],
)
def test_bad_csv(tmp_path, text, message):
    """Everything that keeps a CSV file from being a table names its place."""
    with pytest.raises(DataError) as refusal:
        open_table(csv(tmp_path, text), texts=("b",))
    assert str(refusal.value).startswith(message)


@pytest.mark.parametrize("last", [b"1,\x81", b"\x81,weld", b"1,2,\x81"])
def test_undecodable_text_far_down(tmp_path, last):
    """A stray byte beyond the first block is found with its line, in any column."""
    rows = b"".join(b"%d,weld\n" % i for i in range(20_000))
    with pytest.raises(DataError, match=r"^t\.csv: line 20002: byte 0x81 is not UTF-8"):
        open_table(csv(tmp_path, b"a,b\n" + rows + last + b"\n"), texts=("b",))


def test_csv_with_an_endless_cell(tmp_path):
    """A cell beyond all bounds is told with the parser's reason."""
    with pytest.raises(
        DataError, match=r"^t\.csv: cannot be read as CSV, it is damaged or cut short \(field larger than"
    ):
        open_table(csv(tmp_path, f"a,b\n1,{'x' * 200_000},3\n"))


def test_csv_that_arrow_refuses_for_another_reason(tmp_path, monkeypatch):
    """Where every row has its cells, the reason is Arrow's."""

    def refusing(*_, **__):
        raise pa.ArrowInvalid("straddling object straddles two block boundaries\nmore")

    monkeypatch.setattr(pyarrow.csv, "read_csv", refusing)
    with pytest.raises(
        DataError, match=r"cut short \(straddling object straddles two block boundaries\)\. Write it again\.$"
    ):
        open_table(csv(tmp_path, "a,b\n1,2\n"))


def test_csv_of_an_office_program(tmp_path):
    """Byte order mark, Windows line ends, blank lines, spaces around names and values, quotes."""
    table = open_table(csv(tmp_path, '\ufeffa ,"b"\r\n 1.5,"x, y"\r\n\r\n+2, z \r\n'), texts=("b",))
    table.expect(("a", "b"), (), strict=True)
    assert table.numbers("a").tolist() == [1.5, 2.0]
    assert table.texts("b") == ["x, y", "z"]
    table.refuse()
    assert table.warnings == []


def test_names_that_look_like_numbers_stay_texts(tmp_path):
    """Weld 01 is not weld 1, and NA is a name."""
    table = open_table(csv(tmp_path, "weld\n01\n1\nNA\n"), texts=("weld",))
    assert table.texts("weld") == ["01", "1", "NA"]


def test_missing_columns_are_listed_with_those_present(tmp_path):
    """All missing columns are named at once."""
    table = open_table(csv(tmp_path, "a,x_m\n1,2\n"))
    with pytest.raises(DataError) as refusal:
        table.expect(("a", "x_mm", "y_mm"), (), strict=False)
    assert str(refusal.value) == (
        "t.csv: column x_mm: the column is missing. Add it; the columns are a, x_m.\n"
        "t.csv: column y_mm: the column is missing. Add it; the columns are a, x_m."
    )


def test_unknown_columns(tmp_path):
    """An unknown column is a warning, or an error where strict; a misspelt optional one is recognised."""
    path = csv(tmp_path, "a,zzz,sacle\n1,2,3\n")
    table = open_table(path)
    table.expect(("a",), ("scale",), strict=False)
    assert [str(warning) for warning in table.warnings] == [
        "t.csv: column zzz: the column is unknown and not read. Remove it.",
        "t.csv: column sacle: the column is unknown and not read. Rename it to 'scale'.",
    ]
    table.refuse()
    table = open_table(path)
    table.expect(("a",), ("scale",), strict=True)
    with pytest.raises(DataError, match=r"zzz.*\n.*sacle"):
        table.refuse()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a\n1\n\nx\n", "t.csv: column a, row 2: 'x' is not a number. Give a number."),
        ("a\n1\n2_000\n", "t.csv: column a, row 2: '2_000' is not a number. Give a number."),
        ("a,b\n1,\n,1\n", "t.csv: column a, row 2: the value is missing or NaN. Give a number."),
        ("a,b\n1,\nNaN,\n", "t.csv: column a, row 2: the value is missing or NaN. Give a number."),
        ("a\n1\nNaN\n2\nnan\n", "t.csv: column a, row 2: the value is missing or NaN (and 1 more row). Give a number."),
        ("a,b\n,1\n,1\n,1\n", "t.csv: column a, row 1: the value is missing or NaN (and 2 more rows). Give a number."),
        ("a\n1\ninf\n", "t.csv: column a, row 2: inf is not finite. Give a finite number."),
        ("a\n1\n2\n-inf\n", "t.csv: column a, row 3: -inf is not finite. Give a finite number."),
        ("a\ntrue\nfalse\n", "t.csv: column a, row 1: True is not a number. Give a number."),
        ("a\n2020-01-01\n", "t.csv: column a, row 1: datetime.date(2020, 1, 1) is not a number. Give a number."),
    ],
)
def test_bad_numbers(tmp_path, text, message):
    """A number that is none is told with row and value."""
    table = open_table(csv(tmp_path, text))
    assert table.numbers("a").shape == (table.rows,)
    assert only_problem(table) == message
    with pytest.raises(DataError):
        table.refuse()


@pytest.mark.parametrize(
    ("array", "expected"),
    [
        (pa.array([1.5, 2.5], pa.float32()), np.array([1.5, 2.5], np.float32)),
        (pa.array([1.5, 2.5], pa.float64()), np.array([1.5, 2.5])),
        (pa.array(np.array([1.5, 2.5], np.float16)), np.array([1.5, 2.5])),
        (pa.array([1, 2], pa.int8()), np.array([1.0, 2.0])),
        (pa.array([1.5, 2.5]).dictionary_encode(), np.array([1.5, 2.5])),
        (pa.array([1, 2], pa.uint64()), np.array([1.0, 2.0])),
    ],
)
def test_numbers_of_parquet(tmp_path, array, expected):
    """Single precision stays single, everything else becomes double."""
    table = open_table(parquet(tmp_path, {"a": array}))
    values = table.numbers("a")
    table.refuse()
    assert values.dtype == expected.dtype
    np.testing.assert_array_equal(values, expected)
    assert table.single_precision(["a"]) == (values.dtype == np.float32)


@pytest.mark.parametrize(
    ("array", "message"),
    [
        (pa.array(["1.5", "2"]), "t.parquet: column a, row 1: '1.5' is not a number. Give a number."),
        (pa.array([1.0, None]), "t.parquet: column a, row 2: the value is missing or NaN. Give a number."),
        (pa.array([1, None, 3]), "t.parquet: column a, row 2: the value is missing or NaN. Give a number."),
        (
            pa.array([1.0, float("inf")], pa.float32()),
            "t.parquet: column a, row 2: inf is not finite. Give a finite number.",
        ),
        (pa.nulls(2), "t.parquet: column a, row 1: the value is missing or NaN (and 1 more row). Give a number."),
        (pa.array([[1.0], [2.0]]), "t.parquet: column a, row 1: [1.0] is not a number. Give a number."),
    ],
)
def test_bad_numbers_of_parquet(tmp_path, array, message):
    """Parquet columns of the wrong kind are told like those of CSV."""
    table = open_table(parquet(tmp_path, {"a": array}))
    table.numbers("a")
    assert only_problem(table) == message


def test_bounds(tmp_path):
    """A bound that a value misses is named with the value."""
    table = open_table(csv(tmp_path, "a\n0\n-1.5\n-2\n"))
    table.numbers("a", least=0.0)
    assert only_problem(table) == "t.csv: column a, row 2: -1.5 is below 0 (and 1 more row). Give at least 0."
    table = open_table(csv(tmp_path, "a\n1\n0\n"))
    table.numbers("a", above=0.0)
    assert only_problem(table) == "t.csv: column a, row 2: 0 is not above 0. Give more than 0."


def test_defaults(tmp_path):
    """Empty cells and absent columns take the default."""
    table = open_table(csv(tmp_path, "a,b,c,d\n1,,x,\n,2,,true\n"), texts=("c",))
    assert table.numbers("a", default=7.0).tolist() == [1.0, 7.0]
    assert table.integers("b", default=7).tolist() == [7, 2]
    assert table.texts("c", default="y") == ["x", "y"]
    assert table.flags("d", default=False).tolist() == [False, True]
    assert table.numbers("e", default=7.0).tolist() == [7.0, 7.0]
    assert table.integers("e", default=7).tolist() == [7, 7]
    assert table.texts("e", default="y") == ["y", "y"]
    assert table.flags("e", default=True).tolist() == [True, True]
    table.refuse()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a\n1\n2.5\n", "t.csv: column a, row 2: 2.5 is not a whole number. Give a whole number."),
        ("a\n1\n1e20\n", "t.csv: column a, row 2: 100000000000000000000 is too large for a floating-point column to"),
        ("a\n1\ntwo\n", "t.csv: column a, row 2: 'two' is not a number. Give a number."),
        ("a,b\n1,1\n,1\n", "t.csv: column a, row 2: the value is missing or NaN. Give a number."),
    ],
)
def test_bad_integers(tmp_path, text, message):
    """Ids are whole numbers."""
    table = open_table(csv(tmp_path, text))
    assert table.integers("a").dtype == np.int64
    assert only_problem(table).startswith(message)


def test_integers_stored_as_floating_point(tmp_path):
    """Whole numbers are accepted from floating-point columns as long as those can hold them exactly."""
    table = open_table(parquet(tmp_path, {"a": pa.array([1.0, 2.0**24]), "b": pa.array([1.0, 2.0**25], pa.float32())}))
    assert table.integers("a").tolist() == [1, 2**24]
    table.refuse()
    table.integers("b")
    assert only_problem(table).startswith(
        "t.parquet: column b, row 2: 33554432 is too large for a floating-point column"
    )


def test_large_ids_are_exact(tmp_path):
    """Ids beyond 2^53 keep their last digit."""
    table = open_table(csv(tmp_path, f"a\n{2**53 + 1}\n"))
    assert table.integers("a").tolist() == [2**53 + 1]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("true\nfalse", [True, False]),
        ("1\n0", [True, False]),
        ("True\n FALSE ", [True, False]),
        ("1.0\n0", [True, False]),
    ],
)
def test_flags(tmp_path, text, expected):
    """Truth values in the spellings of the usual programs."""
    table = open_table(csv(tmp_path, f"a\n{text}\n"))
    assert table.flags("a", default=False).tolist() == expected
    table.refuse()


@pytest.mark.parametrize("text", ["true\nmaybe", "1\n2", "0\n0.5"])
def test_bad_flags(tmp_path, text):
    """Anything else is refused."""
    table = open_table(csv(tmp_path, f"a\n{text}\n"))
    table.flags("a", default=False)
    value = text.split("\n")[1]
    assert only_problem(table) == f"t.csv: column a, row 2: {value} is not a flag. Give true or false."


def test_flags_of_parquet(tmp_path):
    """Boolean columns with empty cells take the default there."""
    table = open_table(parquet(tmp_path, {"a": pa.array([True, None, False])}))
    assert table.flags("a", default=True).tolist() == [True, True, False]


@pytest.mark.parametrize(
    "array",
    [
        pa.array(["b", "a ", "b"]),
        pa.array(["b", "a", "b"], pa.large_string()),
        pa.array(["b", "a", "b"]).dictionary_encode(),
        pa.chunked_array([pa.array(["b"]).dictionary_encode(), pa.array(["a", "b"]).dictionary_encode()]),
    ],
)
def test_groups(tmp_path, array):
    """Texts come sorted and trimmed, however they are stored."""
    for texts in ((), ("a",)):
        names, code = open_table(parquet(tmp_path, {"a": array}), texts=texts).groups("a")
        assert names == ("a", "b")
        assert code.tolist() == [1, 0, 1]


def test_groups_hold_no_unused_text(tmp_path):
    """A dictionary may list texts that no row has."""
    array = pa.DictionaryArray.from_arrays(pa.array([2, 0], pa.int8()), pa.array(["a", "b", "c"]))
    names, code = open_table(parquet(tmp_path, {"a": array})).groups("a")
    assert names == ("a", "c")
    assert code.tolist() == [1, 0]


def test_whole_numbers_serve_as_names(tmp_path):
    """A weld named by a number in a Parquet file is that number as text."""
    assert open_table(parquet(tmp_path, {"a": pa.array([5, 3])})).texts("a") == ["5", "3"]


@pytest.mark.parametrize(
    ("array", "message"),
    [
        (pa.array(["x", None]), "t.parquet: column a, row 2: the text is missing. Give a text."),
        (pa.array(["x", " "]), "t.parquet: column a, row 2: the text is missing. Give a text."),
        (pa.nulls(1), "t.parquet: column a, row 1: the text is missing. Give a text."),
        (pa.array([1.5]), "t.parquet: column a, row 1: 1.5 is not text. Give text."),
        (pa.array([b"\xe4"]), "t.parquet: column a, row 1: b'\\xe4' is not text. Give text."),
    ],
)
def test_bad_texts(tmp_path, array, message):
    """A missing name or one of the wrong kind is told with its row."""
    table = open_table(parquet(tmp_path, {"a": array}))
    table.texts("a")
    assert only_problem(table) == message


def test_duplicates(tmp_path):
    """A repeated key names both rows and the key as the file spells it."""
    table = open_table(csv(tmp_path, "weld,node\nB,1\nA,2\nA,1\nA,2\nB,1\n"), texts=("weld",))
    names, code = table.groups("weld")
    table.unique({"weld": code, "node": table.integers("node")}, {"weld": names})
    assert only_problem(table) == (
        "t.csv: column weld, node, row 4: weld A, node 2 repeats row 2. Keep one of the rows."
    )


def test_problems_of_several_columns_are_raised_together(tmp_path):
    """A table is read to its end before it is refused."""
    table = open_table(csv(tmp_path, "a,b\nx,1\n2,\n"))
    table.numbers("a")
    table.integers("b")
    with pytest.raises(DataError, match=r"column a, row 1.*\n.*column b, row 2"):
        table.refuse()


def test_nothing_follows_from_a_spoilt_column(tmp_path):
    """A text among the numbers is the only thing told about its column and what depends on it."""
    table = open_table(csv(tmp_path, "a\nx\n1\n1\n"))
    table.unique({"a": table.numbers("a", above=5.0).astype(int)})
    assert only_problem(table) == "t.csv: column a, row 1: 'x' is not a number. Give a number."


def test_unknown_and_missing_texts(tmp_path):
    """Every unknown text is told once, with the nearest known one; every missing one too."""
    table = open_table(csv(tmp_path, "a\nseem\nzz\nseem\n"))
    names, code = table.groups("a")
    table.known("a", names, code, ("seam", "ring"), "the welds")
    table.complete("a", names, ("seam", "seem"), "nodes")
    assert [str(problem) for problem in table.problems] == [
        "t.csv: column a, row 1: 'seem' is not one of the welds. Write 'seam'.",
        "t.csv: column a, row 2: 'zz' is not one of the welds. Add it to the welds or remove its rows.",
        "t.csv: column a: a 'seam' has no nodes. Add its nodes.",
    ]
