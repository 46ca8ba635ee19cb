"""Blocks of a result file, one for each mode or subcase, joined into one FE run."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.foreign.fe.force_rows import common_rows, unlike_rows
from fatigue.readers.foreign.fe.results import (
    REQUEST,
    Eigenvalue,
    FeResults,
    ForceBlock,
    ShapeBlock,
    UnusableBlock,
    frequency_of,
)
from fatigue.readers.foreign.fe.static_case import APART, Heading, StaticCase
from fatigue.readers.neutral.body.modes import LOWEST_HZ

_NOT_GIVEN = 1e-37
"""A smaller eigenvalue is no number a solver computes: the word holds an integer or nothing."""

_AGREE = 1.001
"""Frequencies of one mode by two tables differ by less."""

_UNSTABLE_HZ = 0.1
"""A negative eigenvalue of a lower frequency is the round-off of a rigid mode."""

Key = tuple[int, int]
"""Subcase and mode; mode 0: a static subcase."""


@dataclass(frozen=True, slots=True, eq=False)
class FileBlocks:
    """What a result file holds, block by block.

    Attributes
    ----------
    source, solver : path of the file, and the program that wrote it, empty where it does not tell
    forces, shapes : of each mode or subcase
    summary : the eigenvalue summaries of the file
    stated : eigenvalues beside shapes, reactions and forces, used for modes of a file without summary
    unusable : blocks that are refused if the choice falls on them
    headings : how the static subcases are called
    """

    source: str
    solver: str
    forces: list[ForceBlock]
    shapes: list[ShapeBlock]
    summary: list[Eigenvalue]
    stated: Mapping[Key, Sequence[float]]
    unusable: Collection[UnusableBlock] = ()
    headings: Mapping[int, Heading] = field(default_factory=dict)


def assemble(
    file: FileBlocks, subcase: int | None, interface: Collection[int] = (), loads: Collection[int] | None = ()
) -> FeResults:
    """FE run that the blocks of a file make.

    Parameters
    ----------
    subcase : the subcase to take from a file with several modal ones; None if there is only one
    interface : static subcases that are modes of the basis, beside the modes of a modal subcase
    loads : static subcases that are loads beside the modes of a modal subcase, which may have the number of a mode;
        None: all that are sound and have the rows of the modes

    Raises
    ------
    DataError : no blocks, a choice of subcase is needed, a mode or a row given twice, rows that differ between modes, a
        value that is no number, eigenvalues that contradict each other
    """
    source, stated = file.source, file.stated
    if not file.forces and not file.unusable:
        raise DataError(Problem("no_forces", source, "its table of grid point forces is empty", REQUEST))
    chosen, warnings = _choose(source, file.forces, file.unusable, subcase, interface, loads)
    modal = {block.subcase for block in chosen if block.mode > 0}
    key = _numbers(chosen)
    is_static = np.array([block.mode == 0 for block in chosen])
    known = _summary_of(file.summary, stated, modal)
    rows = common_rows(chosen)
    if absent := sorted(set(interface) - set(key.tolist())):
        warnings.append(
            Problem(
                "no_such_interface",
                source,
                f"of the interface modes named, {len(absent)} have no forces, {absent[0]} the first",
                "Name modes, or static subcases that are not left out",
            )
        )
    modes = set(key[~is_static].tolist())
    if known and (stray := sorted(modes - set(known))):
        raise DataError(
            Problem(
                "unknown_mode",
                source,
                f"mode {stray[0]} has forces and is not in the eigenvalue summary of {len(known)} modes",
                "Give the results of one run; copy the file again if it was one",
            )
        )
    listed = set(known) or {mode for subcase_of, mode in stated if subcase_of in modal and mode}
    if modal and (silent := sorted(listed - modes)):
        warnings.append(
            Problem(
                "modes_without_forces",
                source,
                f"the file lists {len(listed)} modes, {len(silent)} of them without forces, mode {silent[0]} the first",
                "Request GPFORCE for all modes that the simulation uses",
            )
        )
    if not modal and subcase is None:
        warnings += _subcases_without_forces(source, file.shapes, set(key.tolist()))
    beside = {} if known else _given(source, stated, [(block.subcase, block.mode) for block in chosen if block.mode])
    frequency, mass, eigenvalue = (np.full(key.size, np.nan) for _ in range(3))
    for k, block in enumerate(chosen):
        if block.mode and known:
            line = known[block.mode]
            frequency[k], mass[k], eigenvalue[k] = line.frequency, line.modal_mass, line.eigenvalue
        elif block.mode:
            eigenvalue[k] = beside.get((block.subcase, block.mode), np.nan)
            frequency[k] = frequency_of(eigenvalue[k])
    warnings += _unstable(source, key, frequency, eigenvalue)
    shape_node, shape = _shapes([(block.subcase, block.mode) for block in chosen], file.shapes)
    return FeResults(
        source=source,
        solver=file.solver,
        analysis="modal" if modal else "static",
        mode=key,
        frequency=frequency,
        modal_mass=mass,
        node=rows.node,
        element=rows.element,
        kind=rows.kind,
        force=rows.force,
        shape_node=shape_node,
        shape=shape,
        warnings=tuple(warnings),
        static_modes=tuple(key[is_static].tolist()) if modal else (),
        static_cases=tuple(
            StaticCase(number, block.subcase, file.headings.get(block.subcase, Heading()), source)
            for number, block in zip(key.tolist(), chosen, strict=True)
            if block.mode == 0
        ),
    )


def _numbers(blocks: Sequence[ForceBlock]) -> NDArray[np.int64]:
    """Number of every block: of its mode, of its subcase, or one that no mode has."""
    modes = {block.mode for block in blocks if block.mode}
    return np.array(
        [block.mode or block.subcase + (APART if block.subcase in modes else 0) for block in blocks], np.int64
    )


def _subcases_without_forces(source: str, shapes: list[ShapeBlock], having: set[int]) -> list[Problem]:
    """Warning about static subcases that have displacements only: they may be unit loads."""
    silent = sorted({block.subcase for block in shapes if block.mode == 0} - having)
    if not silent:
        return []
    what = f"{len(silent)} static subcases have displacements and no grid point forces, subcase {silent[0]} the first"
    remedy = "Request GPFORCE above all subcases, or in each of them, if they are unit loads"
    return [Problem("subcases_without_forces", source, what, remedy, len(silent))]


def _unstable(
    source: str, mode: NDArray[np.int64], frequency: NDArray[np.float64], eigenvalue: NDArray[np.float64]
) -> list[Problem]:
    """Warning about modes with a negative eigenvalue beyond the round-off of rigid ones."""
    bad = np.flatnonzero((eigenvalue < 0) & (frequency > _UNSTABLE_HZ))
    if not bad.size:
        return []
    first = bad[0]
    what = f"{bad.size} modes have a negative eigenvalue, mode {mode[first]} the first ({eigenvalue[first]:.6g}): they "
    what += f"are unstable and vibrate with no frequency; {frequency[first]:.6g} Hz is what its size would give"
    return [Problem("unstable_mode", source, what, "Check the run (preload, springs, mass), or --ignore-modes")]


def _choose(
    source: str,
    blocks: list[ForceBlock],
    unusable: Collection[UnusableBlock],
    subcase: int | None,
    interface: Collection[int],
    loads: Collection[int] | None,
) -> tuple[list[ForceBlock], list[Problem]]:
    """Blocks of the run asked for: all static subcases, or the modes of one subcase and the static ones named."""
    named = (*interface, *(loads or ()))
    usable = sorted({block.subcase for block in blocks})
    warnings = _superelements(source, unusable) if blocks else []
    if blocks:
        unusable = [other for other in unusable if other.problem.code != "superelement"]
    if subcase is not None:
        blocks = [block for block in blocks if block.subcase == subcase or _is_named(block, named)]
        unusable = [other for other in unusable if other.subcase == subcase]
    refuse(DataError, _unusable_problems(unusable, usable))
    if subcase is not None and not any(block.subcase == subcase for block in blocks):
        raise DataError(
            Problem("no_subcase", source, f"subcase {subcase} has no grid point forces", f"Name one of {usable}")
        )
    modal = [block for block in blocks if block.mode > 0]
    subcases = sorted({block.subcase for block in modal})
    if len(subcases) > 1:
        what = f"modes of several subcases: {subcases}"
        raise DataError(Problem("many_subcases", source, what, "Name the subcase to use (--subcase)"))
    modes = {block.mode for block in modal}
    static = [block for block in blocks if block.mode == 0]
    beside = [block for block in static if _is_named(block, interface) and block.subcase not in modes]
    beside += [block for block in static if block not in beside and _is_named(block, loads or ())]
    if modal:
        if loads is None:
            fit, unfit = _fit_beside(modal[0], [block for block in static if block not in beside])
            warnings += unfit
            static = beside = [*beside, *fit]
        warnings += _left_out(source, [block.subcase for block in static if block not in beside], modes)
    chosen = [*modal, *beside] if modal else static
    seen: set[Key] = set()
    for block in chosen:
        if (block.subcase, block.mode) in seen:
            raise DataError(
                Problem(
                    "block_twice",
                    block.where,
                    f"subcase {block.subcase} mode {block.mode} is given more than once, as superelements, restarts, "
                    "appended runs and design cycles do",
                    "Give the results of one residual structure and one run",
                )
            )
        seen.add((block.subcase, block.mode))
    return chosen, warnings


def _fit_beside(mode: ForceBlock, static: list[ForceBlock]) -> tuple[list[ForceBlock], list[Problem]]:
    """Static blocks that can be loads beside a mode, and a warning about the others, which nobody asked for."""
    fit, unfit = [], []
    for block in static:
        twice = sum(other.subcase == block.subcase for other in static) > 1
        problem = unlike_rows(block, mode)
        if twice:
            unfit.append((block.subcase, "it is given more than once"))
        elif problem is not None:
            unfit.append((block.subcase, problem.what))
        else:
            fit.append(block)
    if not unfit:
        return fit, []
    number, why = unfit[0]
    what = f"{len(unfit)} static subcases cannot stand beside the modes and are left out; subcase {number}: {why}"
    remedy = "Nothing, unless they are loads: then request the same GPFORCE set for them, or give them in a file of own"
    return fit, [Problem("static_left_out", mode.where, what, remedy, len(unfit))]


def _is_named(block: ForceBlock, interface: Collection[int]) -> bool:
    return block.mode == 0 and block.subcase in interface


def _unusable_problems(unusable: Collection[UnusableBlock], usable: list[int]) -> list[Problem]:
    """One refusal of each kind, with the subcases that could be read instead."""
    found: dict[str, Problem] = {}
    for other in unusable:
        problem = other.problem
        elsewhere = [number for number in usable if number != other.subcase]
        remedy = problem.remedy
        if elsewhere:
            remedy += f", or name the subcase to use: {elsewhere[:10]} (--subcase)"
        found.setdefault(problem.code, Problem(problem.code, problem.where, problem.what, remedy))
    return list(found.values())


def _superelements(source: str, unusable: Collection[UnusableBlock]) -> list[Problem]:
    """Warning that the results of superelements beside the residual structure are not used."""
    found = [other.problem for other in unusable if other.problem.code == "superelement"]
    if not found:
        return []
    what = (
        f"{len(found)} blocks of superelements are left out beside the residual structure; the first: {found[0].what}"
    )
    remedy = "Welds at their elements are left out; run the model without superelements if they matter"
    return [Problem("superelements_left_out", source, what, remedy)]


def _left_out(source: str, subcases: list[int], modes: set[int]) -> list[Problem]:
    """Warning about static subcases that are not used: a preload is no mode, a unit load of an interface is one."""
    if not subcases:
        return []
    some = ", ".join(str(number) for number in subcases[:10]) + (" ..." if len(subcases) > 10 else "")
    clash = next((number for number in subcases if number in modes), None)
    remedy = "Name them as interface modes if they are unit loads of the modal basis"
    if clash is not None:
        remedy += f"; subcase {clash} has the number of a mode and needs another"
    return [
        Problem(
            "static_left_out", source, f"{len(subcases)} static subcases ({some}) are left out beside the modes", remedy
        )
    ]


def _summary_of(
    summary: list[Eigenvalue], stated: Mapping[Key, Sequence[float]], modal: set[int]
) -> dict[int, Eigenvalue]:
    """Lines of the chosen subcase by mode; where several summaries do not tell theirs, those that agree with shapes."""
    own = [line for line in summary if line.subcase in modal] or (summary if modal else [])
    found: dict[int, Eigenvalue] = {}
    for mode in {line.mode for line in own}:
        lines = [line for line in own if line.mode == mode]
        if len({line.frequency for line in lines}) > 1:
            beside = [frequency_of(v) for subcase in modal for v in stated.get((subcase, mode), ()) if v]
            lines = [line for line in lines if any(np.isclose(line.frequency, f, rtol=1e-3) for f in beside)]
        if not lines:
            return {}
        found[mode] = lines[0]
    return found


def _given(source: str, stated: Mapping[Key, Sequence[float]], wanted: list[Key]) -> dict[Key, float]:
    """Eigenvalues that are numbers; a zero counts only beside others, as a rigid mode has it."""
    found = {}
    for key in wanted:
        values = [v if abs(v) > _NOT_GIVEN else 0.0 for v in stated.get(key, ()) if np.isfinite(v)]
        found[key] = max(values, key=abs, default=np.nan)
        given = [frequency_of(v) for v in values if v]
        if given and max(given) > _AGREE * min(given) and max(given) > LOWEST_HZ:
            raise DataError(
                Problem(
                    "eigenvalues_contradict",
                    source,
                    f"mode {key[1]} of subcase {key[0]} is given with {min(given):.6g} and {max(given):.6g} Hz",
                    "Copy the file again in binary mode, or give the results of one run",
                )
            )
    return found if any(value for value in found.values() if np.isfinite(value)) else {}


def _shapes(keys: list[Key], blocks: list[ShapeBlock]) -> tuple[NDArray[np.int64], NDArray[np.floating]]:
    """Shapes of all modes by ascending grid, or none if one is missing or their grids differ.

    A static subcase beside modes may lack its displacements: they are zero then, and prove nothing.
    """
    found = {(block.subcase, block.mode): block for block in blocks}
    is_mixed = any(mode for _, mode in keys)
    wanted = [found.get(key) for key in keys]
    given = [_by_grid(block) for block in wanted if block is not None]
    is_missing = any(block is None and (mode or not is_mixed) for block, (_, mode) in zip(wanted, keys, strict=True))
    if is_missing or any(not np.array_equal(block.node, given[0].node) for block in given):
        return np.empty(0, np.int64), np.empty((len(keys), 0, 6))
    shape = np.zeros((len(keys), *given[0].shape.shape), np.result_type(*(block.shape for block in given)))
    shape[[block is not None for block in wanted]] = [block.shape for block in given]
    return given[0].node, shape


def _by_grid(block: ShapeBlock) -> ShapeBlock:
    """Shape by ascending grid."""
    order = np.argsort(block.node, kind="stable")
    return block if (np.diff(order) > 0).all() else replace(block, node=block.node[order], shape=block.shape[order])
