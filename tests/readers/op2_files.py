"""Small OP2 files of a row or two."""

from fatigue.readers.foreign.nastran.results.op2 import read_op2
from tests.readers.op2_writer import Op2Writer

ROW = (1, 1, "QUAD4", [1.0, 2.0, 3.0, 4.0, 5.0, 6.0])


def one_mode(writer, name="OGPFB1", **head):
    """Add a table of forces of one mode."""
    writer.table(name, [writer.identification(2, 19, head.pop("mode", 1), 10, **head), writer.forces([ROW])])


def read_back(path, *add):
    """Read a 64-bit file to which each of the functions added a table."""
    writer = Op2Writer(8)
    for function in add:
        function(writer)
    path.write_bytes(writer.close())
    return read_op2(path)
