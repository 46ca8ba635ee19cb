"""Shells, solids, sections and node components from an ANSYS archive (``CDWRITE,DB``)."""

import re
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.ansys.blocks import Lines, fields_of, number, numbers, whole_numbers
from fatigue.readers.foreign.ansys.elements import SECTIONED, SHELLS, SOLIDS, element_of
from fatigue.readers.foreign.fe.model import FeModel, Section, Shell, Solid, others_left_out, shell_mesh, solid_mesh
from fatigue.readers.text.encoding import unreadable

_HEAD = re.compile(r"(?im)^(?:NBLOCK,|EBLOCK,|/PREP7|/COM,)")
_REAL = 1_000_000_000  # added to the numbers of real constants, so that they are told from sections
_UNBLOCKED = ("N", "E", "EN", "EMORE")
_MOST = 10


@dataclass
class Archive:
    """What an archive says, as far as it has been read."""

    nodes: dict[int, NDArray[np.float64]] = field(default_factory=dict)
    turned: set[int] = field(default_factory=set)
    routine: dict[int, int] = field(default_factory=dict)
    rows: list[tuple[int, int, int, int, list[int]]] = field(default_factory=list)  # type, real, section, id, nodes
    sections: dict[int, list[float]] = field(default_factory=dict)  # thicknesses of layers
    offset: dict[int, str] = field(default_factory=dict)
    reals: dict[int, list[float]] = field(default_factory=dict)
    components: dict[str, list[int]] = field(default_factory=dict)
    current_type: int = 0
    current_section: int = 0
    current_real: int = 0


def is_archive(head: str) -> bool:
    """Whether a text begins like an archive."""
    return _HEAD.search(head) is not None


def read_archive(path: Path) -> FeModel:
    """Read the blocked archive that ``CDWRITE,DB`` writes; commands that say nothing of the mesh are passed over.

    Node components become node sets, numbered in the order of their names. Axes of rotated nodes are not needed: forces
    and shapes of the macro are in global axes.

    Raises
    ------
    DataError : unreadable, cut or damaged file, nodes or elements outside blocks, an element of a node that is not
        there, neither shells nor solids
    """
    try:
        text = path.read_text("utf-8", errors="replace")
    except OSError as error:
        raise unreadable(path, error) from error
    archive, lines = Archive(), Lines(str(path), text.splitlines())
    for line in lines:
        words = [word.strip() for word in line.split("!")[0].split(",")]
        command = words[0].upper()
        if command in _COMMANDS:
            _COMMANDS[command](archive, lines, words)
        elif command in _UNBLOCKED and not "".join(words[1:2]).upper().startswith("R5"):
            raise DataError(
                Problem(
                    "unblocked",
                    lines.where,
                    f"{command} stands outside a block",
                    "Write it with CDWRITE,DB,,,,,BLOCKED",
                )
            )
    if not archive.nodes or not archive.rows:
        what = "it has no nodes" if not archive.nodes else "it has no elements"
        raise DataError(Problem("no_mesh", str(path), what, "Write the model with CDWRITE,DB"))
    return _model(str(path), archive)


def _nblock(archive: Archive, lines: Lines, words: list[str]) -> None:
    """Nodes: id, two numbers of the solid model, then coordinates and rotations; or id and these alone."""
    fields = fields_of(lines)
    first = sum(column.is_whole for column in fields)
    if first < 1 or not all(column.is_whole for column in fields[:first]) or len(fields) < first + 3:
        raise lines.damaged("the format of NBLOCK is not whole numbers and then three or six others")
    before = len(archive.nodes)
    while True:
        line = lines.next("NBLOCK")
        if line.strip() == "-1" or line.lstrip().upper().startswith("N,"):
            _check_count(lines, words, len(archive.nodes) - before)
            return
        head = whole_numbers(lines, line[: fields[first - 1].end], fields[:first])
        if len(head) < first:
            raise lines.damaged(f"a node of {first} whole numbers and its place was expected")
        node = head[0]
        values = numbers(lines, line, fields)[first:] + [0.0] * 6
        if node < 1 or node in archive.nodes:
            raise lines.damaged(f"{node} is no id of a node" if node < 1 else f"node {node} is given twice")
        archive.nodes[node] = np.array(values[:3])
        if any(values[3:6]):
            archive.turned.add(node)


def _eblock(archive: Archive, lines: Lines, words: list[str]) -> None:
    """Elements: of SOLID blocks eleven numbers before the nodes, of others five."""
    fields = fields_of(lines)
    is_solid = len(words) > 2 and words[2].upper() == "SOLID"
    before = len(archive.rows)
    while True:
        line = lines.next("EBLOCK")
        if line.strip() == "-1":
            _check_count(lines, words, len(archive.rows) - before)
            return
        row = whole_numbers(lines, line, fields)
        if is_solid:
            if len(row) < 12 or not 0 < row[8] <= 64:
                raise lines.damaged("an element of eleven numbers and its nodes was expected")
            kind, real, section, element, nodes, count = row[1], row[2], row[3], row[10], row[11:], row[8]
        else:
            if len(row) < 6:
                raise lines.damaged("an element of five numbers and its nodes was expected")
            element, section, real, nodes, count = row[0], row[1], row[2], row[5:], len(row) - 5
            kind = archive.current_type
        while len(nodes) < count:
            nodes = nodes + whole_numbers(lines, lines.next("EBLOCK"), fields)
        if element < 1 or len(nodes) > count:
            raise lines.damaged(f"element {element} has {len(nodes)} nodes, and {count} are stated")
        archive.rows.append((kind, real, section, element, nodes))


def _check_count(lines: Lines, words: list[str], found: int) -> None:
    """Refuse a block that does not hold as many rows as its head states, where it does."""
    if len(words) > 4 and words[4].isdigit() and 0 < int(words[4]) != found:
        raise lines.damaged(f"{words[0]} states {words[4]} rows, and {found} stand there")


def _et(archive: Archive, lines: Lines, words: list[str]) -> None:
    """Element type: ``ET,1,181`` or ``ET,1,SHELL181``."""
    digits = re.search(r"(\d+)\s*\Z", words[2]) if len(words) > 2 else None
    if digits is None or not words[1].isdigit():
        raise lines.damaged("an element type has no number and no name")
    archive.routine[int(words[1])] = int(digits[1])
    archive.current_type = int(words[1])


def _type(archive: Archive, lines: Lines, words: list[str]) -> None:
    """Type of the elements of the next block that is not SOLID."""
    if len(words) > 1 and words[1].isdigit():
        archive.current_type = int(words[1])


def _sectype(archive: Archive, lines: Lines, words: list[str]) -> None:
    """Section of the data that follows; 0 where it is no shell."""
    archive.current_section = _id(lines, words) if len(words) > 2 and words[2].upper().startswith("SHEL") else 0


def _secdata(archive: Archive, lines: Lines, words: list[str]) -> None:
    """Thickness of one layer."""
    if archive.current_section:
        thickness = number(lines, words[1] if len(words) > 1 else "")
        archive.sections.setdefault(archive.current_section, []).append(thickness)


def _secblock(archive: Archive, lines: Lines, words: list[str]) -> None:
    """Thicknesses of all layers, one in a line."""
    for _ in range(_id(lines, words)):
        _secdata(archive, lines, ["", lines.next("SECBLOCK").split(",")[0]])


def _secoffset(archive: Archive, lines: Lines, words: list[str]) -> None:
    """Which surface the nodes lie on."""
    if archive.current_section and len(words) > 1:
        archive.offset[archive.current_section] = words[1].upper()[:4]


def _rlblock(archive: Archive, lines: Lines, words: list[str]) -> None:
    """Sets of real constants: their number and how many, six values, then seven in a line."""
    first, more = fields_of(lines), fields_of(lines)
    for _ in range(_id(lines, words)):
        line = lines.next("RLBLOCK")
        head = whole_numbers(lines, line[: first[1].end], first[:2])
        if len(head) < 2 or not 0 <= head[1] <= 10_000:
            raise lines.damaged("a set of real constants was expected")
        values = numbers(lines, line, first)[2:]
        for _ in range(-(-max(head[1] - len(first) + 2, 0) // len(more))):
            values += numbers(lines, lines.next("RLBLOCK"), more)
        archive.reals[head[0]] = values


def _r(archive: Archive, lines: Lines, words: list[str]) -> None:
    """A set of real constants in one command."""
    if len(words) > 1 and words[1].isdigit():
        archive.reals[int(words[1])] = [number(lines, word) for word in words[2:]]


def _cmblock(archive: Archive, lines: Lines, words: list[str]) -> None:
    """A component: ids, a negative one ends the range that the one before begins."""
    if len(words) < 4 or not words[3].isdigit():
        raise lines.damaged("a component has no name, kind and number of ids")
    fields, wanted = fields_of(lines), int(words[3])
    ids: list[int] = []
    while len(ids) < wanted:
        ids += whole_numbers(lines, lines.next("CMBLOCK"), fields)
    if len(ids) > wanted:
        raise lines.damaged(f"the component {words[1]} has {len(ids)} ids, and {wanted} are stated")
    if words[2].upper() == "NODE":
        archive.components[words[1]] = ids


def _id(lines: Lines, words: list[str]) -> int:
    if len(words) < 2 or not words[1].isdigit():
        raise lines.damaged(f"{words[0]} has no number")
    return int(words[1])


_COMMANDS: Mapping[str, Callable[[Archive, Lines, list[str]], None]] = {
    "NBLOCK": _nblock,
    "EBLOCK": _eblock,
    "ET": _et,
    "TYPE": _type,
    "SECTYPE": _sectype,
    "SECDATA": _secdata,
    "SECBLOCK": _secblock,
    "SECOFFSET": _secoffset,
    "RLBLOCK": _rlblock,
    "R": _r,
    "CMBLOCK": _cmblock,
}


def _model(source: str, archive: Archive) -> FeModel:
    """Model of what was read."""
    shells: list[Shell] = []
    solids: list[Solid] = []
    others: Counter[str] = Counter()
    for kind, real, section, element, nodes in archive.rows:
        if kind not in archive.routine:
            what = f"its element type {kind} is not defined"
            raise DataError(Problem("no_type", f"{source}, element {element}", what, "Write it again with CDWRITE,DB"))
        routine = archive.routine[kind]
        pid = section if routine in SECTIONED or routine in SOLIDS else _REAL + real
        listed = {**SHELLS, **SOLIDS}.get(routine, 0)
        made = element_of(routine, element, pid, nodes + [0] * (listed - len(nodes)))
        if made is None:
            others[f"E{routine}"] += 1
        elif isinstance(made, Shell):
            shells.append(made)
        else:
            solids.append(made)
    sections, unconfirmed = _sections(archive, {shell.pid for shell in shells})
    sets, warnings = _node_sets(source, archive)
    return FeModel(
        source=source,
        mesh=shell_mesh(source, archive.nodes, shells, sections),
        frame_node=np.zeros(0, np.int64),
        frame=np.zeros((0, 3, 3)),
        unconfirmed_sections=unconfirmed,
        node_sets=sets,
        other_cards=dict(others),
        warnings=(*warnings, *others_left_out(str(source), others)),
        solids=solid_mesh(source, archive.nodes, solids, shells),
    )


def _sections(archive: Archive, used: set[int]) -> tuple[dict[int, Section], dict[int, str]]:
    """Sections in use, and why the thickness of some has to be confirmed by hand."""
    found: dict[int, Section] = {}
    unconfirmed: dict[int, str] = {}
    for pid in sorted(used):
        if pid >= _REAL:
            values = (archive.reals.get(pid - _REAL, []) + [0.0] * 4)[:4]
            corners = {values[0], *(value for value in values[1:] if value)}
            found[pid] = Section(values[0] if values[0] > 0 else np.nan)
            if len(corners) > 1:
                unconfirmed[pid] = f"real constants {pid - _REAL} give a thickness that varies"
            elif not values[0] > 0:
                unconfirmed[pid] = f"real constants {pid - _REAL} give no thickness"
            continue
        layers = archive.sections.get(pid, [])
        thickness = sum(layers)
        place = archive.offset.get(pid, "MID")
        share = {"TOP": -0.5, "BOT": 0.5}.get(place, 0.0)  # from the nodes to the mid-surface along the normal
        found[pid] = Section(thickness if thickness > 0 else np.nan, share * thickness)
        if not thickness > 0:
            unconfirmed[pid] = f"section {pid} gives no thickness (SECDATA)"
        elif len(layers) > 1:
            unconfirmed[pid] = f"section {pid} has {len(layers)} layers"
        elif place not in ("MID", "TOP", "BOT"):
            unconfirmed[pid] = f"section {pid} has an offset by SECOFFSET,{place}, which is not read"
    return found, unconfirmed


def _node_sets(source: str, archive: Archive) -> tuple[dict[int, NDArray[np.int64]], tuple[Problem, ...]]:
    """Components of nodes by number, and which name each number is."""
    sets = {}
    for key, name in enumerate(sorted(archive.components), start=1):
        ids: list[int] = []
        for value in archive.components[name]:
            if value < 0 and ids and 0 < -value - ids[-1] <= max(archive.nodes):
                ids += range(ids[-1] + 1, 1 - value)
            else:
                ids.append(value)
        sets[key] = np.unique(np.array([n for n in ids if n in archive.nodes], np.int64))
    if not sets:
        return {}, ()
    called = ", ".join(f"{key} {name}" for key, name in enumerate(sorted(archive.components), start=1))
    what = f"node components are node sets by number: {called}"
    return sets, (Problem("node_sets_numbered", source, what, "Name a set by its number"),)
