"""Ids keep their last digit, whatever the column they stand in; numbers may be rounded."""

from decimal import Decimal

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from fatigue.errors import CaseError
from fatigue.readers.convert.mode_list import mode_list
from fatigue.readers.neutral.body.mesh import read_mesh
from fatigue.readers.neutral.body.modes import read_modes
from fatigue.readers.neutral.body.welds import read_welds
from fatigue.readers.neutral.tables import Table, open_table
from fatigue.verify.recount.inputs.tables import read_frame, read_rows_where
from tests.readers import neutral_tables as neutral

BIG = 2**53 + 1  # the first whole number that a float cannot hold
LARGEST = 2**63 - 1
POINT = "Store whole numbers up to 9223372036854775807 without point and exponent."


def stored(tmp_path, column: pa.Array | str) -> Table:
    """A table of one column ``a``: text as CSV, an array as Parquet."""
    path = tmp_path / ("t.csv" if isinstance(column, str) else "t.parquet")
    if isinstance(column, str):
        path.write_text(f"a\n{column}\n", encoding="utf-8")
    else:
        pq.write_table(pa.table({"a": column}), path)
    return open_table(path)


@pytest.mark.parametrize(
    ("column", "expected"),
    [
        (pa.array([BIG, -BIG, LARGEST, -LARGEST - 1]), [BIG, -BIG, LARGEST, -LARGEST - 1]),
        (pa.array([5, LARGEST], pa.uint64()), [5, LARGEST]),
        (pa.array([1, 2**32 - 1], pa.uint32()), [1, 2**32 - 1]),
        (pa.array([-128, 127], pa.int8()), [-128, 127]),
        (pa.array([Decimal(BIG), Decimal(2)], pa.decimal128(20, 0)), [BIG, 2]),
        (pa.array([Decimal("12.00"), Decimal("13.00")], pa.decimal256(50, 2)), [12, 13]),
        (pa.array([1, BIG]).dictionary_encode(), [1, BIG]),
        (pa.array([str(BIG), "7"]), [BIG, 7]),
        (pa.array([str(BIG), "7"]).dictionary_encode(), [BIG, 7]),
        (pa.array([12.0, -3.0]), [12, -3]),
        (f"{BIG}\n-{BIG}\n{LARGEST}", [BIG, -BIG, LARGEST]),
        (f'"{BIG}"\n"12"', [BIG, 12]),
        ("12.0\n1e3\n-4", [12, 1000, -4]),
        ("007\n +8", [7, 8]),
    ],
)
def test_ids_are_exact(tmp_path, column, expected):
    """Integers of every width, decimals, texts and floats that are whole numbers."""
    table = stored(tmp_path, column)
    assert table.integers("a").tolist() == expected
    table.refuse()


@pytest.mark.parametrize(
    ("column", "message"),
    [
        (pa.array([1, 2**63], pa.uint64()), "row 2: 9223372036854775808 is beyond the largest id, 9223372036854775807"),
        (
            pa.array([Decimal(10) ** 25], pa.decimal128(30, 0)),
            "row 1: 10000000000000000000000000 is beyond the largest",
        ),
        (pa.array([Decimal("1.0"), Decimal("2.5")], pa.decimal128(9, 1)), "row 2: 2.5 is not a whole number"),
        (pa.array([12.0, 12.5]), "row 2: 12.5 is not a whole number. Give a whole number."),
        (
            pa.array([1.0, 2.0**53]),
            f"row 2: 9007199254740992 is too large for a floating-point column to hold exactly. {POINT}",
        ),
        (pa.array([2**24], pa.float32()), "row 1: 16777216 is too large for a floating-point column to hold exactly"),
        (pa.array([BIG, None]), "row 2: the value is missing or NaN. Give a number."),
        (pa.array(["12", "12.0"]), "row 1: '12' is not a number. Give a number."),
        (pa.array([True, False]), "row 1: True is not a number. Give a number."),
        (f"{BIG}\n1e3", f"row 1: 9007199254740992 is too large for a floating-point column to hold exactly. {POINT}"),
        (
            "1\n9223372036854775808",
            f"row 2: 9223372036854775808 is too large for a floating-point column to hold exactly. {POINT}",
        ),
        ("12\n12a", "row 2: '12a' is not a number. Give a number."),
        ("1 000\n2", "row 1: '1 000' is not a number. Give a number."),
    ],
)
def test_ids_that_are_not_exact_are_refused(tmp_path, column, message):
    """What may have been rounded, has a fraction, or does not fit into 64 bits."""
    table = stored(tmp_path, column)
    assert table.integers("a").dtype == np.int64
    assert [
        str(problem).removeprefix(f"{table.path.name}: column a, ")[: len(message)] for problem in table.problems
    ] == [message]


def test_empty_cells_among_large_ids_take_the_default(tmp_path):
    """A triangle has no fourth node; its column is no less exact for that."""
    assert stored(tmp_path, pa.array([BIG, None])).integers("a", default=0).tolist() == [BIG, 0]
    path = tmp_path / "t.csv"
    path.write_text(f"a,b\n{BIG},1\n,2\n")
    assert open_table(path).integers("a", default=7).tolist() == [BIG, 7]


@pytest.mark.parametrize("column", [pa.array([BIG, 1]), pa.array([BIG, 1], pa.uint64()), f"{BIG}\n1"])
def test_numbers_are_rounded(tmp_path, column):
    """A quantity written as a large whole number is read as the nearest float."""
    table = stored(tmp_path, column)
    assert table.numbers("a").tolist() == [float(BIG), 1.0]
    table.refuse()


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_large_ids_in_every_table(tmp_path, suffix):
    """Modes, nodes, orders and elements, in both formats."""
    modes = neutral.write(tmp_path / f"m{suffix}", {"mode": [BIG, BIG + 1], "frequency_hz": [1.0, 2.0]})
    assert read_modes(modes, (), strict=False)[0].mode.tolist() == [BIG, BIG + 1]
    welds = read_welds(neutral.write(tmp_path / f"w{suffix}", neutral.WELDS), {"master-steel"}, strict=False)[0]
    columns = neutral.WELD_NODES | {name: [v + BIG for v in neutral.WELD_NODES[name]] for name in ("node", "order")}
    lines, _ = neutral.read_weld_nodes(neutral.write(tmp_path / f"n{suffix}", columns), welds, strict=False)
    assert lines.node.tolist() == columns["node"]
    assert lines.order.tolist() == columns["order"]
    nodes = {"node": [BIG + k for k in range(4)], **{f"{a}_mm": [0.0, 1.0, 1.0, 0.0] for a in "xyz"}}
    corners = {"n1": [BIG, BIG], "n2": [BIG + 1, BIG + 2], "n3": [BIG + 2, BIG + 3], "n4": [BIG + 3, None]}
    mesh, _ = read_mesh(
        neutral.write(tmp_path / f"k{suffix}", nodes),
        neutral.write(tmp_path / f"e{suffix}", {"element": [BIG, BIG + 1]} | corners),
        strict=False,
    )
    assert mesh.element.tolist() == [BIG, BIG + 1]
    assert mesh.corners[:, :4].tolist() == [[BIG, BIG + 1, BIG + 2, BIG + 3], [BIG, BIG + 2, BIG + 3, 0]]


@pytest.mark.parametrize("written", ["12", "12.0", "1.2e1", f"{BIG}"])
def test_the_recount_reads_the_same_ids(tmp_path, written):
    """The independent reader takes ids as the program does, and leaves columns alone that nobody asks for."""
    path = tmp_path / "n.csv"
    path.write_text(f"node,x_mm,comment,\n{written},1.5,by hand,\n")
    frame = read_frame(path)
    assert frame["node"].tolist() == open_table(path).integers("node").tolist()
    assert frame["x_mm"].tolist() == [1.5]
    assert frame["comment"].tolist() == ["by hand"]
    assert len(read_rows_where(path, "node", frame["node"].tolist())) == 1


@pytest.mark.parametrize("text", ["99999999999999999999", "²", "5-3", "1-999999999999", "", "1-", "9" * 5000])
def test_mode_lists_on_the_command_line(text):
    """Numbers no id can have and ranges that run backwards are refused, not crashed on."""
    with pytest.raises(CaseError, match="is no mode or range"):
        mode_list(text)
