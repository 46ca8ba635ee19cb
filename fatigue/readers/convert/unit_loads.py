"""Static subcases of the same model in a file of their own, joined to its modes.

Solvers that compute modes and static subcases in separate runs (MYSTRAN among them) write them into separate files.
"""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.convert.loads.roles import static_cases_of
from fatigue.readers.foreign.fe.force_rows import common_rows
from fatigue.readers.foreign.fe.results import FeResults, ForceBlock
from fatigue.readers.foreign.fe.static_case import APART


def with_unit_loads(modes: FeResults, loads: FeResults) -> FeResults:
    """FE results with static subcases joined to the modes, each with the number of its subcase if no other has it.

    Raises
    ------
    DataError : the second file holds modes, or the elements with forces differ
    """
    refuse(DataError, _problems(loads))
    number = _unused(loads.mode.tolist(), set(modes.mode.tolist()))
    rows = common_rows([*_blocks(modes), *_blocks(loads)])
    shape_node, shape = _shapes(modes, loads)
    return replace(
        modes,
        mode=np.concatenate([modes.mode, np.array(number, np.int64)]),
        frequency=np.concatenate([modes.frequency, loads.frequency]),
        modal_mass=np.concatenate([modes.modal_mass, loads.modal_mass]),
        node=rows.node,
        element=rows.element,
        kind=rows.kind,
        force=rows.force,
        shape_node=shape_node,
        shape=shape,
        warnings=(*modes.warnings, *loads.warnings),
        static_modes=(*modes.static_modes, *number),
        static_cases=(
            *static_cases_of(modes),
            *(replace(case, number=own) for case, own in zip(static_cases_of(loads), number, strict=True)),
        ),
    )


def _unused(subcases: Sequence[int], taken: Collection[int]) -> list[int]:
    """Number of every subcase, or one from ``APART`` on where a mode or a subcase of another file has its own."""
    found: list[int] = []
    for subcase in subcases:
        number = subcase
        while number in taken or number in found:
            number = max(number, APART - 1) + 1
        found.append(number)
    return found


def _problems(loads: FeResults) -> Iterator[Problem]:
    """Mistakes that keep a file from being one of static subcases."""
    if loads.analysis != "static":
        remedy = "Give the file with modes as the forces, and the one with static subcases as unit loads"
        yield Problem("no_unit_loads", loads.source, "it holds modes, no static subcases", remedy)


def _blocks(results: FeResults) -> Iterator[ForceBlock]:
    """Every mode or subcase with the rows it has."""
    for mode, force in zip(results.mode.tolist(), results.force, strict=True):
        own = ~np.isnan(force[:, 0])
        where = f"{results.source}, {'subcase' if results.analysis == 'static' else 'mode'} {mode}"
        node, element, kind = results.node[own], results.element[own], results.kind[own]
        yield ForceBlock(where, mode, 0, node, element, kind, force[own])


def _shapes(modes: FeResults, loads: FeResults) -> tuple[NDArray[np.int64], NDArray[np.floating]]:
    """Shapes of all modes at the grids both files have, or none where one file has none."""
    node, ours, theirs = np.intersect1d(modes.shape_node, loads.shape_node, return_indices=True)
    if not node.size:
        return np.empty(0, np.int64), np.empty((modes.mode.size + loads.mode.size, 0, 6))
    return node, np.concatenate([modes.shape[:, ours], loads.shape[:, theirs]])
