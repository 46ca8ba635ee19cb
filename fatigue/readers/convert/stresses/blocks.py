"""The stress blocks of every mode and static subcase whose forces are converted."""

from collections.abc import Iterator, Sequence

import numpy as np

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.convert.loads.roles import static_cases_of
from fatigue.readers.foreign.fe.results import FeResults, frequency_of
from fatigue.readers.foreign.fe.shell_stress import REQUEST, ShellStresses, StressBlock
from fatigue.readers.foreign.fe.static_case import StaticCase
from fatigue.readers.neutral.body.modes import LOWEST_HZ

_AGREE = 1e-3


def blocks_of_modes(
    results: FeResults, stresses: Sequence[ShellStresses], subcase: int | None
) -> list[list[StressBlock]]:
    """Blocks of every mode of ``results``, in their order.

    Raises
    ------
    DataError : a mode or load without stresses, modes of several subcases, a subcase in several files, an eigenvalue
        that is not that of the forces
    """
    all_modal = [block for one in stresses for block in one.blocks if block.mode]
    subcases = sorted({block.subcase for block in all_modal})
    if subcase is None and len(subcases) > 1:
        what = f"stresses of modes of several subcases: {subcases}"
        raise DataError(Problem("many_subcases", stresses[0].source, what, "Name the subcase to use (--subcase)"))
    modal: dict[int, list[StressBlock]] = {}
    for block in all_modal:
        if subcase in (None, block.subcase):
            modal.setdefault(block.mode, []).append(block)
    cases = {case.number: case for case in static_cases_of(results)}
    numbers, is_static = results.mode.tolist(), results.is_static.tolist()
    found = [
        _of_case(cases[number], stresses) if static else modal.get(number, [])
        for number, static in zip(numbers, is_static, strict=True)
    ]
    refuse(DataError, [*_lacking(results, found, stresses), *_of_another_run(results, found), *_twice(found)])
    return found


def _of_case(case: StaticCase, stresses: Sequence[ShellStresses]) -> list[StressBlock]:
    """Blocks of a static subcase: of its own file if that has stresses, else of the one that has the subcase."""
    having = [one for one in stresses if any(not b.mode and b.subcase == case.subcase for b in one.blocks)]
    own = [one for one in having if one.source == case.source] or having
    if len(own) > 1:
        files = ", ".join(one.source for one in own)
        what = f"subcase {case.subcase} has stresses in several files: {files}"
        raise DataError(
            Problem("many_stresses", case.source, what, "Number the subcases apart, or give one of the files")
        )
    return [block for one in own for block in one.blocks if not block.mode and block.subcase == case.subcase]


def _lacking(
    results: FeResults, found: Sequence[Sequence[StressBlock]], stresses: Sequence[ShellStresses]
) -> Iterator[Problem]:
    """Mistake of modes and loads that have forces and no stresses, with why blocks of the files are not used."""
    silent = [results.called(mode) for mode, own in zip(results.mode.tolist(), found, strict=True) if not own]
    if not silent:
        return
    more = f" and {len(silent) - 5} more" if len(silent) > 5 else ""
    what = f"{', '.join(silent[:5])}{more} have forces and no stresses of the shells at the stress points"
    why = [problem for one in stresses for problem in one.problems]
    yield Problem("no_stresses", ", ".join(one.source for one in stresses), what, REQUEST, len(silent))
    yield from dict.fromkeys(why[:3])


def _of_another_run(results: FeResults, found: Sequence[Sequence[StressBlock]]) -> Iterator[Problem]:
    """Mistake where the stresses of a mode state another frequency than its forces."""
    for mode, frequency, own in zip(results.mode.tolist(), results.frequency.tolist(), found, strict=True):
        for block in own:
            stated = frequency_of(block.eigenvalue) if np.isfinite(block.eigenvalue) else 0.0
            if min(stated, frequency) > LOWEST_HZ and abs(stated - frequency) > _AGREE * frequency:
                what = f"the stresses of mode {mode} are of {stated:.6g} Hz, its forces of {frequency:.6g} Hz"
                yield Problem("other_run", block.where, what, "Give forces and stresses of one run")
                return


def _twice(found: Sequence[Sequence[StressBlock]]) -> Iterator[Problem]:
    """Mistake where an element has stresses of one kind of points twice in a mode, as in appended runs."""
    for own in found:
        for corners in (False, True):
            elements = [block.element for block in own if block.has_corners is corners]
            every = np.concatenate(elements) if elements else np.empty(0, np.int64)
            if np.unique(every).size < every.size:
                what = "an element has stresses twice in one mode, as appended runs and restarts do"
                yield Problem("stress_twice", own[0].where, what, "Give the results of one run")
                return
