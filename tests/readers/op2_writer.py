"""Write OP2 files for tests: any word size and byte order, the ways of several solvers, any damage a test needs."""

import struct
from dataclasses import dataclass


@dataclass(frozen=True)
class Dialect:
    """How a solver writes what may be written in several ways.

    ``date``: words of the date in the header, 0: none; ``label_version`` and ``table_version``: words of the version
    records after the label and after table names, 0: none; ``versioned``: the only tables that have one, None: all;
    ``chunk``: words of a chunk; ``jump``: what record numbers skip; ``full_words``: 8 characters in a 64-bit word.
    """

    date: int = 3
    label_version: int = 0
    table_version: int = 0
    versioned: tuple = None
    chunk: int = 1000
    jump: int = 0
    full_words: bool = False


PLAIN = Dialect()
MSC_2014 = Dialect(label_version=6, table_version=6)
OPTISTRUCT = Dialect(chunk=10, jump=2)
STRESS_TYPES = {
    ("QUAD4", 0): 33, ("TRIA3", 0): 74, ("QUADR", 0): 228, ("TRIAR", 0): 227, ("QUAD4", 4): 144, ("QUAD8", 4): 64,
    ("QUADR", 4): 82, ("TRIA6", 3): 75, ("TRIAR", 3): 70,
}  # fmt: skip
"""Element type of stress tables by name of the shell and number of corners with stresses."""


class Op2Writer:
    """Collects the bytes of an OP2 file."""

    def __init__(self, word=4, order="<", header=True, dialect=PLAIN):
        self.word, self.order, self.data, self.dialect = word, order, b"", dialect
        self.int, self.real = ("i", "f") if word == 4 else ("q", "d")
        if header:
            self.header()

    def header(self):
        """Date, tape identification and label; a run begins with it."""
        if self.dialect.date:
            self.marker(3)
            self.record(self.ints(*[1, 2, 24][: self.dialect.date]))
        self.marker(7)
        self.record(self.text("NASTRAN FORT TAPE ID CODE - ", 7))
        self.marker(2)
        self.record(self.text("TEST", 2))
        self.version(self.dialect.label_version)
        self.marker(-1)
        self.marker(0)

    def version(self, words):
        """A version record, if it has words."""
        if words:
            self.marker(words)
            self.record(self.text("20141   0", words))

    def ints(self, *values):
        """Whole numbers, one word each."""
        return struct.pack(f"{self.order}{len(values)}{self.int}", *values)

    def reals(self, *values):
        """Real numbers, one word each."""
        return struct.pack(f"{self.order}{len(values)}{self.real}", *values)

    def text(self, text, words):
        """Text of four characters a word."""
        raw = text.ljust(4 * words)[: 4 * words].encode("latin-1")
        if self.word == 8 and self.dialect.full_words:
            return raw.ljust(8 * words)
        return b"".join(raw[k : k + 4].ljust(self.word) for k in range(0, len(raw), 4))

    def record(self, data):
        """A Fortran record."""
        length = struct.pack(f"{self.order}i", len(data))
        self.data += length + data + length

    def marker(self, value):
        """A record of one word."""
        self.record(self.ints(value))

    def table(self, name, records, code=101):
        """A table of logical records, each cut into chunks."""
        self.marker(2)
        self.record(self.text(name, 2))
        if self.dialect.versioned is None or name in self.dialect.versioned:
            self.version(self.dialect.table_version)
        self.marker(-1)
        self.marker(7)
        self.record(self.ints(code, 0, 0, 0, 0, 0, 0))
        level = 1
        for data in [self.text(name, 2), *records]:
            level += 1 + (self.dialect.jump if level > 3 else 0)
            for value in (-level, 1, 0):
                self.marker(value)
            size = self.dialect.chunk * self.word
            for first in range(0, len(data), size):
                chunk = data[first : first + size]
                self.marker(len(chunk) // self.word)
                self.record(chunk)
        for value in (-level - 1, 1, 0, 0):
            self.marker(value)

    def identification(
        self,
        approach,
        code,
        mode,
        words,
        subcase=1,
        device=1,
        eigenvalue=0.0,
        label="",
        own=(0.0, 0.0),
        thermal=0,
        element=0,
        form=1,
        stress=0,
    ):
        """The 146 words that precede a data record; ``label`` fills title, subtitle and label, 128 characters each.

        ``element``, ``form`` and ``stress`` are the type of element, 1 for real numbers, and the code of stresses.
        """
        head = self.ints(10 * approach + device, code, element, subcase, mode) + self.reals(eigenvalue)
        own_words = self.reals(own[0]) + self.ints(0) + self.reals(own[1])
        head += self.ints(0, 0, form, words, stress, 0, -1) + own_words + self.ints(*[0] * 6, thermal, *[0] * 27)
        fields = [label[k : k + 128].ljust(128) for k in (0, 128, 256)]
        return head + b"".join(self.text(field, 32) for field in fields)

    def forces(self, rows, device=1):
        """Rows (node, element, name, six values)."""
        return b"".join(
            self.ints(10 * node + device, element) + self.text(name, 2) + self.reals(*force)
            for node, element, name, force in rows
        )

    def shape(self, rows, device=1):
        """Rows (node, six values) of a mode shape."""
        return b"".join(self.ints(10 * node + device, 1) + self.reals(*values) for node, values in rows)

    def stresses(self, block, device=1):
        """Rows of a ``StressBlock``: with corners each point has its grid, and the centre the number of corners."""
        data = b""
        for k, element in enumerate(block.element.tolist()):
            data += self.ints(10 * element + device) + (self.text("CEN/", 1) if block.has_corners else b"")
            for p, node in enumerate(block.node[k].tolist()):
                if block.has_corners:
                    data += self.ints(node or block.node.shape[1] - 1)
                for fibre, stress in zip(block.fibre[k, p].tolist(), block.stress[k, p].tolist(), strict=True):
                    data += self.reals(fibre, *stress, 45.0, *[max(map(abs, stress))] * 3)
        return data

    def stress_table(self, blocks, name="OES1X1", **head):
        """Add a table of stress blocks; ``head`` overrides what their identification says."""
        records = []
        for block in blocks:
            corners = block.node.shape[1] - 1
            element = STRESS_TYPES[block.kind, corners]
            own = {"subcase": block.subcase, "eigenvalue": block.eigenvalue, "element": element, "stress": 1} | head
            words = 17 if not corners else 2 + 17 * (1 + corners)
            approach = own.pop("approach", 2 if block.mode else 1)
            records += [
                self.identification(approach, own.pop("code", 5), block.mode, own.pop("words", words), **own),
                self.stresses(block),
            ]
        self.table(name, records)

    def close(self):
        """All bytes with the end mark."""
        self.marker(0)
        return self.data


def modal_op2(results, word=4, order="<", dialect=PLAIN):
    """An OP2 file of FeResults: eigenvalues, mode shapes and forces of all modes."""
    return modal_tables(Op2Writer(word, order, dialect=dialect), results).close()


def modal_tables(writer, results):
    """Add tables of FeResults: eigenvalues, mode shapes and forces of all modes."""
    lama = b""
    for k, mode in enumerate(results.mode.tolist()):
        omega = 2 * 3.141592653589793 * float(results.frequency[k])
        lama += writer.ints(mode, mode)
        lama += writer.reals(omega**2, omega, results.frequency[k], results.modal_mass[k], omega**2)
    writer.table("LAMA", [writer.identification(2, 6, 0, 7), lama])
    shapes, forces = [], []
    for k, mode in enumerate(results.mode.tolist()):
        shapes += [
            writer.identification(2, 7, mode, 8),
            writer.shape(zip(results.shape_node.tolist(), results.shape[k].tolist(), strict=True)),
        ]
        rows = zip(
            results.node.tolist(),
            results.element.tolist(),
            results.kind.tolist(),
            results.force[k].tolist(),
            strict=True,
        )
        forces += [writer.identification(2, 19, mode, 10), writer.forces(rows)]
    if results.shape_node.size:
        writer.table("OUGV1", shapes)
    writer.table("OGPFB1", forces)
    return writer
