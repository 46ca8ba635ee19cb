"""Grid point forces from a NASTRAN punch file (``GPFORCE(PUNCH)``): text lines of four fields of 18 characters."""

import re
from collections.abc import Collection
from dataclasses import replace
from pathlib import Path

import numpy as np

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.fe.assembly import FileBlocks, assemble
from fatigue.readers.foreign.fe.results import REQUEST, FeResults, ForceBlock
from fatigue.readers.foreign.fe.static_case import Heading, heading
from fatigue.readers.foreign.nastran.results.punch_fields import damaged, real
from fatigue.readers.neutral.body.modes import LOWEST_HZ
from fatigue.readers.text.encoding import unreadable

_HEADING = "$GRID POINT FORCE BALANCE"
_EIGENVALUE = re.compile(r"\$EIGENVALUE\s*=\s*([-+.\dED]+)\s+MODE\s*=\s*(\d{1,9})", re.ASCII)
_SUBCASE = re.compile(r"\$SUBCASE ID\s*=\s*(\d{1,9})", re.ASCII)
_FORCE_ROW = re.compile(r"[ \d]{9}\d {8}(?: {10}|[ \d]{9}\d) {8}[A-Z*][\w*-]* *(?:\d{8})?\s*\Z", re.ASCII)
_OTHER_SOLUTIONS = ("$TIME", "$FREQUENCY", "$LOAD FACTOR", "$LOAD STEP", "$COMPLEX EIGENVALUE")
_PERHAPS_BUCKLING_HZ = 1.0
_SORT2 = ("$POINT ID", "$ELEMENT ID")
_STARTS = ("$TITLE", "$SUBTITLE", "$LABEL", "$SUBCASE ID", "$GRID POINT")


def is_punch(head: str) -> bool:
    """Whether a text file begins like a punch file."""
    return any(line.startswith(_STARTS) for line in head.splitlines()[:50])


def read_punch(
    path: Path, subcase: int | None = None, interface: Collection[int] = (), loads: Collection[int] | None = ()
) -> FeResults:
    """Read the grid point force balances of a punch file; it holds no mode shapes and no generalised masses.

    Parameters
    ----------
    subcase : the one to read, where the file has several that cannot be read together
    interface : static subcases that are modes of the basis, beside the modes of a modal subcase
    loads : static subcases that are loads beside them; None: all that can be

    Raises
    ------
    DataError : unreadable, no grid point forces, complex or SORT2 output, a damaged or incomplete line
    """
    try:
        lines = path.read_text("ascii", errors="replace").splitlines()
    except OSError as error:
        raise unreadable(path, error) from error
    heads = [k for k, line in enumerate(lines) if line.startswith(_HEADING)]
    if not heads:
        raise DataError(Problem("no_forces", str(path), f"no block begins with {_HEADING}", REQUEST))
    if (stray := _stray_row(lines)) is not None:
        raise damaged(path, stray, f"a row of forces stands in a block that does not begin with {_HEADING}")
    stated: dict[tuple[int, int], list[float]] = {}
    blocks = [_block(path, lines, head, stated) for head in heads]
    headings = {block.subcase: _heading(lines, head) for block, head in zip(blocks, heads, strict=True)}
    results = assemble(FileBlocks(str(path), "", blocks, [], [], stated, (), headings), subcase, interface, loads)
    highest = float(np.max(results.frequency, initial=0.0, where=results.frequency > LOWEST_HZ))
    if 0 < highest < _PERHAPS_BUCKLING_HZ:
        return replace(results, warnings=(*results.warnings, _perhaps_buckling(path, highest)))
    return results


def _perhaps_buckling(path: Path, highest: float) -> Problem:
    """Warning about modes all of which are very slow: a punch file does not tell its solution."""
    return Problem(
        "perhaps_buckling",
        str(path),
        f"no mode is above {highest:.3g} Hz: in a run of SOL 105 load factors stand where eigenvalues are read",
        "Make sure that the run was SOL 103; buckling shapes are no modes of vibration",
    )


def _block(path: Path, lines: list[str], head: int, stated: dict[tuple[int, int], list[float]]) -> ForceBlock:
    """One balance: its $ lines, then three lines for each row."""
    where = f"{path}, line {head + 1}"
    number, mode, eigenvalue, at = 0, 0, np.nan, head + 1
    while at < len(lines) and lines[at].startswith("$"):
        line = lines[at][:72]
        if found := _SUBCASE.match(line):
            number = int(found[1])
        if found := _EIGENVALUE.match(line):
            mode, eigenvalue = int(found[2]), real(path, at, found[1])
        elif line.startswith("$EIGENVALUE"):
            raise damaged(path, at, f"in {line.strip()!r} the eigenvalue or the mode is no number")
        if line.startswith(("$REAL-IMAGINARY", "$MAGNITUDE-PHASE")):
            raise DataError(
                Problem("complex_forces", where, "the forces are complex", "Request REAL output of SOL 103")
            )
        if line.startswith(_OTHER_SOLUTIONS):
            other = line[1:].split("=")[0].strip().lower()
            raise DataError(
                Problem("wrong_analysis", where, f"the forces belong to a {other}, to no mode or load", REQUEST)
            )
        if line.startswith(_SORT2):
            raise DataError(Problem("sort2", where, "the forces are sorted by grid (SORT2)", "Request SORT1"))
        at += 1
    if number < 1:
        raise DataError(Problem("no_subcase", where, "no line $SUBCASE ID follows", "Copy the punch file again"))
    stated[number, mode] = [eigenvalue]
    node, element, kind, force = [], [], [], []
    while at < len(lines) and not lines[at].startswith("$"):
        if not lines[at].strip():
            at += 1
            continue
        first = lines[at]
        following = [lines[k] if k < len(lines) else "" for k in (at + 1, at + 2)]
        if first.startswith("-CONT-") or not all(line.startswith("-CONT-") for line in following):
            raise damaged(path, at, "a row of one line and two -CONT- lines was expected")
        node.append(_id(path, at, first[:18]))
        element.append(_id(path, at, first[18:36] or "0"))
        kind.append(first[36:54].strip())
        force.append([real(path, at, line[k : k + 18]) for line in following for k in (18, 36, 54)])
        at += 3
    return ForceBlock(
        f"{where}, subcase {number} mode {mode}",
        number,
        mode,
        np.array(node, np.int64),
        np.array(element, np.int64),
        np.array(kind, np.str_),
        np.array(force, np.float64).reshape(-1, 6),
    )


def _heading(lines: list[str], head: int) -> Heading:
    """Title, subtitle and label, which stand above the heading of a balance."""
    found = {"TITLE": "", "SUBTITLE": "", "LABEL": ""}
    for line in lines[max(head - 5, 0) : head]:
        word, _, text = line[:72].lstrip("$").partition("=")
        if line.startswith("$") and word.strip() in found:
            found[word.strip()] = text
    return heading(*found.values())


def _stray_row(lines: list[str]) -> int | None:
    """Find a row that names grid, element and kind, as forces do, outside a force balance: its heading is damaged."""
    inside = False
    for at, line in enumerate(lines):
        if line.startswith("$"):
            begins = at == 0 or not lines[at - 1].startswith("$")
            inside = line.startswith(_HEADING) or (inside and not begins)
        elif not inside and _FORCE_ROW.match(line) and any(k.startswith("-CONT-") for k in lines[at + 1 : at + 2]):
            return at
    return None


def _id(path: Path, at: int, text: str) -> int:
    digits = text.strip() or "0"
    if not (digits.isascii() and digits.isdigit() and len(digits) < 12):
        raise damaged(path, at, f"{digits!r} is no id")
    return int(digits)
