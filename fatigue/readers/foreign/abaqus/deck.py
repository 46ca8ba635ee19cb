"""The mesh of an Abaqus deck: nodes, shells, solids, sections with thickness and offset, parts and instances."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.foreign.abaqus.keywords import Data, Keyword, keywords
from fatigue.readers.foreign.abaqus.placed import Placed, placed
from fatigue.readers.foreign.export.elements import abaqus_form, element_of
from fatigue.readers.foreign.fe.model import FeModel, Section, Shell, Solid, others_left_out, shell_mesh, solid_mesh

_GENERATED = frozenset({"NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY"})
_MOST_PROBLEMS = 20
_HIGHEST = 1_000_000_000  # labels of Abaqus are lower
_REFERENCE = {"SPOS": 0.5, "SNEG": -0.5}


@dataclass(slots=True, eq=False)
class _Part:
    """What one part, or the deck outside of any part, defines, in its own axes."""

    name: str
    nodes: dict[int, NDArray[np.float64]] = field(default_factory=dict)
    elements: dict[int, tuple[str, tuple[int, ...], str, int]] = field(default_factory=dict)
    sets: dict[str, set[int]] = field(default_factory=dict)
    ranges: dict[str, list[range]] = field(default_factory=dict)  # of GENERATE, never listed: a slip may be huge
    sections: list[Keyword] = field(default_factory=list)


def read_inp(path: Path) -> FeModel:
    """Shells and solids of a deck with their sections, numbered as they stand in it.

    Raises
    ------
    DataError : generated nodes or elements, instances with equal labels, a damaged line, an element of a node that does
        not exist, neither shells nor solids
    """
    words, included = keywords(path)
    problems: list[Problem] = []
    doubts: list[Problem] = []
    if generated := [word for word in words if word.name in _GENERATED]:
        what = f"{len(generated)} keywords generate nodes or elements, *{generated[0].name} the first"
        raise DataError(Problem("generated", generated[0].where, what, "Write the deck with all nodes and elements"))
    parts, instances = _parts(words, problems)
    del words  # with the text of all lines
    refuse(DataError, problems[:_MOST_PROBLEMS])
    grids: dict[int, NDArray[np.float64]] = {}
    shells: list[Shell] = []
    solids: list[Solid] = []
    sections: dict[int, Section] = {}
    unconfirmed: dict[int, str] = {}
    others: dict[str, int] = {}
    for part, place in _placed_parts(parts, instances, problems):
        _refuse_twice(path, part, grids.keys(), [*shells, *solids])
        grids.update(part.nodes if place.is_still else {number: place.of(xyz) for number, xyz in part.nodes.items()})
        of_element = _sections_of(part, sections, unconfirmed)
        doubts += _undefined_sets(part)
        for number, (kind, nodes, file, line) in part.elements.items():
            form = abaqus_form(kind)
            if form is None:
                others[kind.upper()] = others.get(kind.upper(), 0) + 1
            elif len(nodes) != form.corners + len(form.mids):
                due = form.corners + len(form.mids)
                what = f"element {number} of type {kind} has {len(nodes)} nodes, {due} are due"
                problems.append(Problem("inp_damaged", f"{file}, line {line}", what, "Write the deck again"))
            else:
                made = element_of(form, number, of_element.get(number, 0), nodes)
                (shells if isinstance(made, Shell) else solids).append(made)  # type: ignore[arg-type]
    refuse(DataError, problems[:_MOST_PROBLEMS])
    if any(shell.pid == 0 for shell in shells):
        unconfirmed[0] = "no *SHELL SECTION gives it a thickness"
    return FeModel(
        source=str(path),
        mesh=shell_mesh(str(path), grids, shells, sections),
        frame_node=np.zeros(0, np.int64),
        frame=np.zeros((0, 3, 3)),
        unconfirmed_sections=unconfirmed,
        other_cards=others,
        warnings=(*others_left_out(str(path), others), *doubts),
        included=included,
        solids=solid_mesh(str(path), grids, solids, shells),
    )


def _parts(words: Iterable[Keyword], problems: list[Problem]) -> tuple[dict[str, _Part], list[Keyword]]:
    """Parts by name, that of the deck outside of parts by no name, and the instances."""
    parts = {"": _Part("")}
    current, instances = parts[""], []
    for word in words:
        if word.name == "PART":
            current = parts.setdefault(word.get("NAME").upper(), _Part(word.get("NAME")))
        elif word.name in ("END PART", "ASSEMBLY", "END INSTANCE", "END ASSEMBLY"):
            current = parts[""]
        elif word.name == "INSTANCE":
            instances.append(word)
            own = f"INSTANCE {word.get('NAME')}".upper()  # an instance may define nodes and elements of its own
            current = parts.setdefault(own, _Part(word.get("NAME")))
        elif word.name == "NODE":
            _take_nodes(word, current, problems)
        elif word.name == "ELEMENT":
            _take_elements(word, current, problems)
        elif word.name == "ELSET" and not word.get("INSTANCE"):
            _take_set(word, current, problems)
        elif word.name in ("SHELL SECTION", "SHELL GENERAL SECTION"):
            current.sections.append(word)
        elif word.name == "SYSTEM" and word.data:
            what = "*SYSTEM turns the nodes that follow, which is not read"
            problems.append(Problem("inp_system", word.where, what, "Write the deck in global axes"))
    return parts, instances


def _take_nodes(word: Keyword, part: _Part, problems: list[Problem]) -> None:
    if word.get("SYSTEM", "R").upper() != "R":
        what = f"nodes are given in a system {word.get('SYSTEM')!r}, which is not read"
        problems.append(Problem("inp_system", word.where, what, "Write the deck in rectangular axes"))
        return
    for row in word.data:
        values = _numbers(row, problems)
        if values is None:
            continue
        if not 1 <= len(values) <= 7 or not _is_label(values[0]):
            problems.append(_bad(row, f"a node of {len(values)} numbers"))
            continue
        number, xyz = int(values[0]), np.array([*values[1:4], 0.0, 0.0, 0.0][:3]) + 0.0  # no -0.0
        if number in part.nodes and not np.array_equal(part.nodes[number], xyz):
            what = f"node {number} is given twice, at two places"
            problems.append(Problem("node_twice", f"{row[0]}, line {row[1]}", what, "Give every node its own id"))
        part.nodes[number] = xyz


def _take_elements(word: Keyword, part: _Part, problems: list[Problem]) -> None:
    """Elements of one type; a row of nodes goes on in the next line until it is as long as the type wants."""
    kind = word.get("TYPE")
    if not kind:
        problems.append(Problem("inp_damaged", word.where, "*ELEMENT names no TYPE", "Write the deck again"))
        return
    form = abaqus_form(kind)
    own = part.sets.setdefault(word.get("ELSET").upper(), set()) if word.get("ELSET") else set()
    due = 1 + form.corners + len(form.mids) if form else 0
    row: list[int] = []
    first: Data | None = None
    for line in word.data:
        values = _numbers((line[0], line[1], [text for text in line[2] if text]), problems)
        if values is None:
            continue
        if not all(_is_label(value) for value in values):
            problems.append(_bad(line, "an element with a number that is no id"))
            continue
        first = first or line
        row += [int(value) for value in values]
        goes_on = line[2][-1] == "" if form is None else len(row) < due
        if goes_on:
            continue
        _put_element(kind, row, first, part, own, problems)
        row, first = [], None
    if row and first is not None:
        _put_element(kind, row, first, part, own, problems)


def _put_element(kind: str, row: list[int], first: Data, part: _Part, own: set[int], problems: list[Problem]) -> None:
    if row[0] in part.elements:
        where, what = f"{first[0]}, line {first[1]}", f"element {row[0]} is given twice"
        problems.append(Problem("element_twice", where, what, "Give every element its own id"))
    part.elements[row[0]] = (kind, tuple(row[1:]), first[0], first[1])
    own.add(row[0])


def _take_set(word: Keyword, part: _Part, problems: list[Problem]) -> None:
    """Elements of a set: ids, names of sets before it, or ranges."""
    found = part.sets.setdefault(word.get("ELSET").upper(), set())
    ranges = part.ranges.setdefault(word.get("ELSET").upper(), [])
    for row in word.data:
        texts = [text for text in row[2] if text]
        if "GENERATE" in word.parameters:
            values = _numbers((row[0], row[1], texts), problems)
            if values is not None and len(values) >= 2:
                first, last, step = (*map(int, values), 1)[:3]
                ranges.append(range(first, last + 1, max(step, 1)))
            continue
        for text in texts:
            if text.lstrip("+-").isdecimal():
                found.add(int(text))
            else:
                name = text.strip("\"'").upper()
                found |= part.sets.get(name, set())
                ranges += part.ranges.get(name, []) if part.ranges.get(name) is not ranges else []


def _sections_of(part: _Part, sections: dict[int, Section], unconfirmed: dict[int, str]) -> dict[int, int]:
    """Number of the section of each element, counted over the deck; thickness and offset go into ``sections``."""
    of_element: dict[int, int] = {}
    for word in part.sections:
        number = len(sections) + 1
        name = word.get("ELSET")
        reason, thickness = "", np.nan
        fields = word.data[0][2] if word.data else []
        if "COMPOSITE" in word.parameters:
            layers = [_first(row[2]) for row in word.data]
            thickness, reason = float(np.sum(layers)), "is a layered section"
        elif word.name == "SHELL GENERAL SECTION" and not word.get("MATERIAL"):
            reason = "is given by its stiffness"
        else:
            thickness = _first(fields)
        if not thickness > 0.0 or not np.isfinite(thickness):
            thickness, reason = np.nan, reason or "has no number as its thickness"
        if "NODAL THICKNESS" in word.parameters or word.get("SHELL THICKNESS"):
            thickness, reason = np.nan, "has a thickness that varies"
        offset = word.get("OFFSET").upper()
        fraction = _REFERENCE.get(offset)
        if fraction is None:
            fraction = _first([offset]) if offset else 0.0
        if not np.isfinite(fraction):
            fraction, reason = 0.0, f"has the offset {offset}, which is not read"
        sections[number] = Section(thickness, -fraction * thickness if np.isfinite(thickness) else 0.0)
        if reason:
            unconfirmed[number] = f"section {number} (elements {name}) {reason}"
        own, ranges = part.sets.get(name.upper(), set()), part.ranges.get(name.upper(), [])
        members = (e for e in part.elements if e in own or any(e in labels for labels in ranges))
        for element in members:
            if (first := of_element.setdefault(element, number)) != number:
                unconfirmed[first] = f"section {first} shares elements with section {number}"
    return of_element


def _undefined_sets(part: _Part) -> list[Problem]:
    """Sections of sets that the deck does not define: elements of theirs may be missing."""
    unknown = [word for word in part.sections if word.get("ELSET").upper() not in part.sets]
    remedy = "Give the whole deck, with every *ELEMENT and *ELSET of it"
    return [
        Problem("no_elset", word.where, f"a section is of the set {word.get('ELSET')!r}, which is not defined", remedy)
        for word in unknown
    ]


def _placed_parts(
    parts: Mapping[str, _Part], instances: list[Keyword], problems: list[Problem]
) -> Iterator[tuple[_Part, Placed]]:
    """Parts as they stand in the assembly; a deck without instances is one part in global axes."""
    yield parts[""], Placed()
    for word in instances:
        own = parts.get(f"INSTANCE {word.get('NAME')}".upper(), _Part(""))
        part = parts.get(word.get("PART").upper())
        if part is None:
            what = f"the instance {word.get('NAME')!r} is of the part {word.get('PART')!r}, which is not defined"
            raise DataError(Problem("no_part", word.where, what, "Give the whole deck"))
        rows = [_numbers(row, problems) or [] for row in word.data]
        refuse(DataError, problems)
        place = placed(rows, word.where)
        yield part, place
        if own.nodes or own.elements:
            yield own, place


def _refuse_twice(path: Path, part: _Part, nodes: Iterable[int], elements: Iterable[Shell | Solid]) -> None:
    """Refuse labels that two instances have: forces could not be joined to their elements."""
    both = sorted(set(part.nodes) & set(nodes)) or sorted(set(part.elements) & {e.element for e in elements})
    if both:
        what = f"two instances have the label {both[0]}"
        remedy = "Give the text of the script as --mesh: it tells instances apart, and so do its forces"
        raise DataError(Problem("label_twice", str(path), what, remedy))


def _numbers(row: Data, problems: list[Problem]) -> list[float] | None:
    """Numbers of a data line; None, with a problem, if one is none."""
    texts = row[2][:-1] if row[2] and row[2][-1] == "" else row[2]
    try:
        values = [float(text.upper().replace("D", "E")) if text else 0.0 for text in texts]
    except ValueError:
        bad = next(text for text in texts if not _is_number(text))
        problems.append(_bad(row, f"{bad[:30]!r} is no number"))
        return None
    if not all(map(isfinite, values)):
        problems.append(_bad(row, "a number is not finite"))
        return None
    return values


def _is_label(value: float) -> bool:
    """Whether a number can be that of a node or an element."""
    return value.is_integer() and 0 <= value < _HIGHEST


def _first(fields: list[str]) -> float:
    return float(fields[0].upper().replace("D", "E")) if fields and _is_number(fields[0]) and fields[0] else np.nan


def _is_number(text: str) -> bool:
    try:
        float(text.upper().replace("D", "E") or 0.0)
    except ValueError:
        return False
    return True


def _bad(row: Data, what: str) -> Problem:
    return Problem("inp_damaged", f"{row[0]}, line {row[1]}", what, "Write the deck again")
