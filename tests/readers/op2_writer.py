"""Write OP2 files for tests: any word size and byte order, any damage a test needs."""

import struct


class Op2Writer:
    """Collects the bytes of an OP2 file."""

    def __init__(self, word=4, order="<", header=True):
        self.word, self.order, self.data = word, order, b""
        self.int, self.real = ("i", "f") if word == 4 else ("q", "d")
        if header:
            self.marker(3)
            self.record(self.ints(1, 2, 24))
            self.marker(7)
            self.record(self.text("NASTRAN FORT TAPE ID CODE - ", 7))
            self.marker(2)
            self.record(self.text("TEST", 2))
            self.marker(-1)
            self.marker(0)

    def ints(self, *values):
        """Whole numbers, one word each."""
        return struct.pack(f"{self.order}{len(values)}{self.int}", *values)

    def reals(self, *values):
        """Real numbers, one word each."""
        return struct.pack(f"{self.order}{len(values)}{self.real}", *values)

    def text(self, text, words):
        """Text of four characters a word."""
        raw = text.ljust(4 * words).encode()
        return b"".join(raw[k : k + 4].ljust(self.word) for k in range(0, len(raw), 4))

    def record(self, data):
        """A Fortran record."""
        length = struct.pack(f"{self.order}i", len(data))
        self.data += length + data + length

    def marker(self, value):
        """A record of one word."""
        self.record(self.ints(value))

    def table(self, name, records, code=101):
        """A table of logical records, each cut into chunks of at most 1000 words."""
        self.marker(2)
        self.record(self.text(name, 2))
        self.marker(-1)
        self.marker(7)
        self.record(self.ints(code, 0, 0, 0, 0, 0, 0))
        for level, data in enumerate([self.text(name, 2), *records], start=2):
            for value in (-level, 1, 0):
                self.marker(value)
            size = 1000 * self.word
            for first in range(0, len(data), size):
                chunk = data[first : first + size]
                self.marker(len(chunk) // self.word)
                self.record(chunk)
        for value in (-level - 1, 1, 0, 0):
            self.marker(value)

    def identification(self, approach, code, mode, words, subcase=1, device=1, eigenvalue=0.0, label=""):
        """The 146 words that precede a data record."""
        head = self.ints(10 * approach + device, code, 0, subcase, mode) + self.reals(eigenvalue)
        return head + self.ints(0, 0, 1, words, *[0] * 40) + self.text(label, 96)

    def forces(self, rows, device=1):
        """Rows (node, element, name, six values)."""
        return b"".join(
            self.ints(10 * node + device, element) + self.text(name, 2) + self.reals(*force)
            for node, element, name, force in rows
        )

    def shape(self, rows, device=1):
        """Rows (node, six values) of a mode shape."""
        return b"".join(self.ints(10 * node + device, 1) + self.reals(*values) for node, values in rows)

    def close(self):
        """All bytes with the end mark."""
        self.marker(0)
        return self.data


def modal_op2(results, word=4, order="<"):
    """An OP2 file of FeResults: eigenvalues, mode shapes and forces of all modes."""
    writer = Op2Writer(word, order)
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
    return writer.close()
