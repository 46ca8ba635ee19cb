"""What happens to files: bits flip, ends are lost, blocks and lines move, editors and spreadsheets save them anew."""

import random
import re
from collections.abc import Callable

Damage = Callable[[bytes, random.Random], bytes]

NUMBER = re.compile(rb"[-+]?\d+(?:\.\d*)?(?:[eEdD][-+]?\d+)?")
INSTEAD = (
    *(
        b"nan",
        b"NaN",
        b"inf",
        b"-inf",
        b"1e400",
        b"-1e400",
        b"1e-400",
        b"",
        b"x",
        b"-",
        b"?",
        b"#N/A",
        b"1,5",
        b"1.5.2",
    ),
    *(b"0x1F", b"1_000", b"99999999999999999999", b"-1", b"0", b"1e3", b"12.0", b"2.5", b"1.0D+03", b"1.0+3", b"TRUE"),
    *(
        "\u0661\u0662".encode(),
        "\u2212".encode() + b"1",
        "1\u00a0000".encode(),
        b"'12'",
        b'"12"',
        b"9" * 400,
        b"$",
    ),
)
SEPARATORS = b",;\t "


def flip(data: bytes, rng: random.Random) -> bytes:
    """Some bits."""
    changed = bytearray(data)
    for _ in range(rng.choice((1, 1, 2, 8))):
        changed[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    return bytes(changed)


def overwrite(data: bytes, rng: random.Random) -> bytes:
    """A block of zeros, of noise, or of another part of the file."""
    first, length = _block(data, rng)
    noise = (bytes(length), rng.randbytes(length), (data[rng.randrange(len(data)) :] + data)[:length])
    return data[:first] + rng.choice(noise) + data[first + length :]


def cut_end(data: bytes, rng: random.Random) -> bytes:
    """The end, as of a transfer that broke off."""
    return data[: rng.randrange(len(data))]


def cut_start(data: bytes, rng: random.Random) -> bytes:
    """The beginning."""
    return data[rng.randrange(len(data)) :]


def remove(data: bytes, rng: random.Random) -> bytes:
    """A block."""
    first, length = _block(data, rng)
    return data[:first] + data[first + length :]


def insert(data: bytes, rng: random.Random) -> bytes:
    """Bytes that do not belong there."""
    at, length = rng.randrange(len(data) + 1), rng.choice((1, 1, 4, 50))
    return data[:at] + rng.choice((bytes(length), rng.randbytes(length), b"\r", b"\n", b"\xff" * length)) + data[at:]


def duplicate(data: bytes, rng: random.Random) -> bytes:
    """A block twice."""
    first, length = _block(data, rng)
    return data[: first + length] + data[first:]


def swap(data: bytes, rng: random.Random) -> bytes:
    """Two neighbouring blocks in the wrong order."""
    a, b, c = sorted(rng.randrange(len(data) + 1) for _ in range(3))
    return data[:a] + data[b:c] + data[a:b] + data[c:]


def number(data: bytes, rng: random.Random) -> bytes:
    """One number of a text becomes something else."""
    found = list(NUMBER.finditer(data))
    if not found:
        return flip(data, rng)
    first, end = rng.choice(found).span()
    return data[:first] + rng.choice(INSTEAD) + data[end:]


def lines_removed(data: bytes, rng: random.Random) -> bytes:
    """Some lines."""
    lines = data.splitlines(keepends=True)
    at = rng.randrange(len(lines))
    return b"".join(lines[:at] + lines[at + rng.choice((1, 1, 3)) :])


def line_doubled(data: bytes, rng: random.Random) -> bytes:
    """A line twice, there or at the end."""
    lines = data.splitlines(keepends=True)
    at = rng.randrange(len(lines))
    return b"".join([*lines[: at + 1], lines[at], *lines[at + 1 :]] if rng.random() < 0.7 else [*lines, lines[at]])


def lines_swapped(data: bytes, rng: random.Random) -> bytes:
    """Two lines in each other's place."""
    lines = data.splitlines(keepends=True)
    a, b = rng.randrange(len(lines)), rng.randrange(len(lines))
    lines[a], lines[b] = lines[b], lines[a]
    return b"".join(lines)


def line_joined(data: bytes, rng: random.Random) -> bytes:
    """A line end is lost."""
    ends = [k for k, byte in enumerate(data) if byte == 10]
    at = rng.choice(ends) if ends else 0
    return data[:at] + data[at + 1 :]


def field_changed(data: bytes, rng: random.Random) -> bytes:
    """A separator is lost, doubled, or another one."""
    found = [k for k, byte in enumerate(data) if byte in SEPARATORS]
    if not found:
        return flip(data, rng)
    at = rng.choice(found)
    return data[:at] + rng.choice((b"", data[at : at + 1] * 2, b",", b";", b"\t")) + data[at + 1 :]


def saved_anew(data: bytes, rng: random.Random) -> bytes:
    """Another encoding, other line ends, what an editor or a spreadsheet leaves behind."""
    text = data.decode("latin-1")
    lines = text.splitlines()
    ways: tuple[Callable[[], bytes], ...] = (
        lambda: data.replace(b"\n", b"\r\n"),
        lambda: data.replace(b"\n", b"\r"),
        lambda: b"\xef\xbb\xbf" + data,
        lambda: text.encode("utf-16"),
        lambda: text.encode("utf-16-le"),
        lambda: text.encode("utf-16-be"),
        lambda: text.encode("utf-32"),
        lambda: data.rstrip(b"\r\n"),
        lambda: data + b"\n\n\x1a",
        lambda: data + b"\0" * 600,
        lambda: "\n".join(line + ",," for line in lines).encode("latin-1"),
        lambda: "\n".join(line + ";" for line in lines).encode("latin-1"),
        lambda: "\n".join("  " + line + "  " for line in lines).encode("latin-1"),
        lambda: "\n\n".join(lines).encode("latin-1"),
        lambda: b"# written by hand\n" + data,
        lambda: b"sep=,\n" + data,
        lambda: data + b"Tr\xe4ger\n",
        data.upper,
        lambda: data.replace(b",", b";"),
        lambda: data.replace(b".", b","),
    )
    return rng.choice(ways)()


BINARY: tuple[Damage, ...] = (flip, flip, overwrite, cut_end, cut_start, remove, insert, duplicate, swap)
TEXT: tuple[Damage, ...] = (
    *(flip, overwrite, cut_end, cut_start, remove, insert, duplicate, swap),
    *(number, number, number, lines_removed, line_doubled, lines_swapped, line_joined, field_changed, saved_anew),
)


def _block(data: bytes, rng: random.Random) -> tuple[int, int]:
    """First byte and length of a part of the file, more often a short one."""
    first = rng.randrange(len(data))
    return first, min(len(data) - first, rng.choice((1, 4, 8, 24, 100, 1000)))
