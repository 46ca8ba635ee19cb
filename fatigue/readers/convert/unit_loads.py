"""Unit loads in a file of their own: static subcases of the same model, joined to its modes as interface modes.

Solvers that compute modes and static subcases in separate runs (MYSTRAN among them) write them into separate files.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.foreign.fe.force_rows import common_rows
from fatigue.readers.foreign.fe.results import FeResults, ForceBlock


def with_unit_loads(modes: FeResults, loads: FeResults) -> FeResults:
    """FE results with static subcases joined to the modes, each as a mode that has the number of its subcase.

    Raises
    ------
    DataError : the second file holds modes, a number is used twice, or the elements with forces differ
    """
    refuse(DataError, _problems(modes, loads))
    rows = common_rows([*_blocks(modes), *_blocks(loads)])
    shape_node, shape = _shapes(modes, loads)
    return replace(
        modes,
        mode=np.concatenate([modes.mode, loads.mode]),
        frequency=np.concatenate([modes.frequency, loads.frequency]),
        modal_mass=np.concatenate([modes.modal_mass, loads.modal_mass]),
        node=rows.node,
        element=rows.element,
        kind=rows.kind,
        force=rows.force,
        shape_node=shape_node,
        shape=shape,
        warnings=(*modes.warnings, *loads.warnings),
        static_modes=(*modes.static_modes, *loads.mode.tolist()),
    )


def _problems(modes: FeResults, loads: FeResults) -> Iterator[Problem]:
    """Mistakes that keep two files from being one basis."""
    if loads.analysis != "static":
        remedy = "Give the file with modes as the forces, and the one with static subcases as unit loads"
        yield Problem("no_unit_loads", loads.source, "it holds modes, no static subcases", remedy)
    elif (both := np.intersect1d(modes.mode, loads.mode)).size:
        yield Problem(
            "mode_twice",
            loads.source,
            f"subcase {both[0]} has the number of a mode in {modes.source}",
            "Number the subcases of unit loads apart from the modes, as from 1001 on",
        )


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
