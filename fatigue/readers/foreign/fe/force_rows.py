"""The rows of a grid point force balance: one set of rows for all modes, and what makes rows impossible.

Rows of elements are the same in every mode. The others (loads, reactions, totals) differ from subcase to subcase: a
unit load stands at its own grid, a reaction where something holds. They are kept behind the element rows.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.foreign.fe.results import REQUEST, TOTALS, ForceBlock, is_sound, names_element, names_total


class CommonRows(NamedTuple):
    """Rows of all modes: grid, element and name of each, (r,), and forces, (m, r, 6), NaN where a mode lacks a row."""

    node: NDArray[np.int64]
    element: NDArray[np.int64]
    kind: NDArray[np.str_]
    force: NDArray[np.floating]


def sharing_rows(block: ForceBlock, before: list[ForceBlock]) -> ForceBlock:
    """Block that shares the ids and names of the one before where they are equal, which saves most of the memory."""
    if not before:
        return block
    last = before[-1]
    return replace(
        block,
        node=last.node if np.array_equal(block.node, last.node) else block.node,
        element=last.element if np.array_equal(block.element, last.element) else block.element,
        kind=last.kind if np.array_equal(block.kind, last.kind) else block.kind,
    )


def common_rows(blocks: list[ForceBlock]) -> CommonRows:
    """Rows of all modes in one order, the file's own where all modes have it.

    Raises
    ------
    DataError : a value that is no number, no rows of elements, an element given twice or under two names, elements that
        have forces in some modes only
    """
    blocks = [_with_one_total(block) for block in blocks]
    is_element = [block.of_element for block in blocks]
    refuse(DataError, _problems(blocks, is_element))
    first = blocks[0]
    own = np.where(is_element[0], first.element, 0)
    if all(_is_alike(block, which, first, own) for block, which in zip(blocks, is_element, strict=True)):
        is_same = all(np.array_equal(block.element, first.element) for block in blocks)
        element = first.element if is_same else own  # ids left over from elements may differ
        return CommonRows(first.node, element, first.kind, np.stack([block.force for block in blocks]))
    rows = np.flatnonzero(is_element[0])
    order = _order(first, rows)
    others, place = _other_rows(blocks, is_element)
    force = np.full((len(blocks), rows.size + len(others), 6), np.nan, np.result_type(*(b.force for b in blocks)))
    for out, block, which, at in zip(force, blocks, is_element, place, strict=True):
        out[order] = block.force[_sorted_rows(block, np.flatnonzero(which))]
        out[rows.size + at] = block.force[~which]
    return CommonRows(
        np.concatenate([first.node[rows], np.array([node for node, _, _ in others], np.int64)]),
        np.concatenate([first.element[rows], np.zeros(len(others), np.int64)]),
        np.concatenate([first.kind[rows], np.array([kind for _, kind, _ in others], np.str_)]),
        force,
    )


def unlike_rows(block: ForceBlock, modes: ForceBlock) -> Problem | None:
    """Why the rows of a block cannot stand beside those of a mode; None if they can."""
    pair = [_with_one_total(one) for one in (modes, block)]
    return next(_problems(pair, [one.of_element for one in pair]), None)


def _with_one_total(block: ForceBlock) -> ForceBlock:
    """Block whose totals all have the same name."""
    other = names_total(block.kind) & (block.kind != TOTALS)
    return replace(block, kind=np.where(other, TOTALS, block.kind)) if other.any() else block


def _is_alike(block: ForceBlock, is_element: NDArray[np.bool_], first: ForceBlock, element: NDArray[np.int64]) -> bool:
    """Whether a block has the rows of the first one in the same order."""
    return (
        np.array_equal(block.node, first.node)
        and np.array_equal(np.where(is_element, block.element, 0), element)
        and np.array_equal(block.kind, first.kind)
    )


def _order(block: ForceBlock, rows: NDArray[np.int64]) -> NDArray[np.int64]:
    """Order by element and grid."""
    return np.lexsort((block.node[rows], block.element[rows]))


def _sorted_rows(block: ForceBlock, rows: NDArray[np.int64]) -> NDArray[np.int64]:
    """Rows by element and grid."""
    return rows[_order(block, rows)]


def _other_rows(
    blocks: list[ForceBlock], is_element: list[NDArray[np.bool_]]
) -> tuple[list[tuple[int, str, int]], list[NDArray[np.int64]]]:
    """Rows of any block that are no element's, by grid, name and repetition, and where each block has them."""
    node = np.concatenate([block.node[~which] for block, which in zip(blocks, is_element, strict=True)])
    names, kind = np.unique(
        np.concatenate([block.kind[~which] for block, which in zip(blocks, is_element, strict=True)]),
        return_inverse=True,
    )
    count = [int((~which).sum()) for which in is_element]
    block = np.repeat(np.arange(len(blocks)), count)
    order = np.lexsort((kind, node, block))
    same = np.zeros(order.size, np.bool_)
    for column in (kind, node, block):
        sorted_column = column[order]
        same[1:] = (sorted_column[1:] == sorted_column[:-1]) & (same[1:] | (column is kind))
    at = np.arange(order.size)
    again = np.empty(order.size, np.int64)
    again[order] = at - np.maximum.accumulate(np.where(same, 0, at))
    keys, place = np.unique(np.stack([node, kind, again], axis=1), axis=0, return_inverse=True)
    others = [(int(n), str(names[k]), int(a)) for n, k, a in keys]
    return others, np.split(place.reshape(-1), np.cumsum(count)[:-1])


def _problems(blocks: list[ForceBlock], is_element: list[NDArray[np.bool_]]) -> Iterator[Problem]:
    """Mistakes in every block by itself, and in the element rows of all blocks together."""
    for block in blocks:
        if (bad := np.flatnonzero(~is_sound(block.force).all(axis=1))).size:
            yield Problem(
                "not_a_number",
                f"{block.where}, node {block.node[bad[0]]}, element {block.element[bad[0]]}",
                f"{bad.size} force rows hold a value that is no number of sensible size",
                "Copy the file again, or repeat the run",
            )
        if (bad := np.flatnonzero((block.node <= 0) | ((block.element < 0) & names_element(block.kind)))).size:
            yield Problem(
                "bad_id",
                block.where,
                f"{bad.size} rows with impossible ids, node {block.node[bad[0]]} element {block.element[bad[0]]} the "
                "first",
                "Copy the file again, or repeat the run",
            )
        totals = np.sort(block.node[block.kind == TOTALS])
        if (twice := totals[1:][totals[1:] == totals[:-1]]).size:
            yield Problem(
                "row_twice", block.where, f"grid {twice[0]} has two totals", "Copy the file again, or repeat the run"
            )
    filled = [k for k, which in enumerate(is_element) if which.any()]
    if not filled:
        yield Problem("no_element_rows", blocks[0].where, "there is no force row of an element", REQUEST)
        return
    first = blocks[filled[0]]
    rows = _sorted_rows(first, np.flatnonzero(is_element[filled[0]]))
    yield from _clashes(first, rows)
    for block, which in zip(blocks, is_element, strict=True):
        if block is not first:
            yield from _difference(block, _sorted_rows(block, np.flatnonzero(which)), first, rows)


def _clashes(block: ForceBlock, rows: NDArray[np.int64]) -> Iterator[Problem]:
    """Rows of elements, sorted, that are given twice or name an element in two ways.

    Springs between two directions of one grid, fasteners and collapsed solids may have several rows at a grid.
    """
    node, element, kind = block.node[rows], block.element[rows], block.kind[rows]
    is_plate = np.strings.startswith(kind, "QUAD") | np.strings.startswith(kind, "TRIA")
    twice = np.flatnonzero((np.diff(node) == 0) & (np.diff(element) == 0) & is_plate[1:])
    if twice.size:
        yield Problem(
            "row_twice",
            block.where,
            f"{twice.size} element rows are given twice, element {element[twice[0]]} node {node[twice[0]]} the first",
            "Give the results of one run without superelements",
        )
    mixed = np.flatnonzero((np.diff(element) == 0) & (kind[1:] != kind[:-1]))
    if mixed.size:
        yield Problem(
            "kind_differs",
            block.where,
            f"element {element[mixed[0]]} is named {kind[mixed[0]]} and {kind[mixed[0] + 1]}",
            "Copy the file again, or give every element its own id",
        )


def _difference(
    block: ForceBlock, rows: NDArray[np.int64], first: ForceBlock, wanted: NDArray[np.int64]
) -> Iterator[Problem]:
    """Element rows, sorted, of one block only, or of another name."""
    if np.array_equal(block.node[rows], first.node[wanted]) and np.array_equal(
        block.element[rows], first.element[wanted]
    ):
        other = np.flatnonzero(block.kind[rows] != first.kind[wanted])
        if other.size:
            k = int(other[0])
            yield Problem(
                "kind_differs",
                block.where,
                f"element {block.element[rows[k]]} is named {block.kind[rows[k]]}, and {first.kind[wanted[k]]} in "
                f"{first.where}",
                "Copy the file again, or repeat the run",
            )
        return
    ours = set(zip(block.element[rows].tolist(), block.node[rows].tolist(), strict=True))
    theirs = set(zip(first.element[wanted].tolist(), first.node[wanted].tolist(), strict=True))
    lacking, beyond = theirs - ours, ours - theirs
    element, node = min(lacking or beyond or ours)
    one = f"element {element} at grid {node} " + ("has no row here" if lacking else "has a row only here")
    yield Problem(
        "rows_differ",
        block.where,
        f"its {rows.size} element rows are not those of {first.where} ({wanted.size} rows): "
        + (one if lacking or beyond else "some are given twice"),
        "Request the same GPFORCE set for all modes and subcases that are used, or name the subcase (--subcase)",
    )
