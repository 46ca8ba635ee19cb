"""What static subcases are: modes of the basis where the simulation has coordinates for them, else unit loads."""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

import numpy as np

from fatigue.errors import CaseError, DataError, Problem, refuse
from fatigue.readers.convert.loads.columns import load_of_column
from fatigue.readers.convert.loads.names import UnitLoad, named_loads
from fatigue.readers.convert.modal_basis import without_modes
from fatigue.readers.convert.options import ConvertOptions
from fatigue.readers.foreign.fe.results import FeResults
from fatigue.readers.foreign.fe.static_case import APART, StaticCase
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory


def static_cases_of(results: FeResults) -> tuple[StaticCase, ...]:
    """Static subcases of a run; a run that tells nothing of them has them by number."""
    told = {case.number: case for case in results.static_cases}
    numbers = results.mode[results.is_static].tolist()
    return tuple(told.get(number, StaticCase(number, number, source=results.source)) for number in numbers)


def with_roles(
    results: FeResults, options: ConvertOptions, histories: Sequence[ForeignHistory]
) -> tuple[FeResults, tuple[int, ...], tuple[UnitLoad, ...]]:
    """FE results whose static subcases are modes, loads, or left out; the interface modes, and the unit loads.

    ``histories`` are the coordinates as their files give them: a column of a subcase makes it an interface mode.

    Raises
    ------
    CaseError, DataError : a name for what is no unit load; an interface mode with the number of a mode; nothing is left
    """
    cases = static_cases_of(results)
    every = named_loads(cases, options.unit_load_names)
    modes = _modes(every, results, options, histories)
    loads = [load for load in every if load.case.number not in modes]
    if options.static_subcases == "leave_out":
        loads = [load for load in loads if load.is_unit_known]
    left_out = {case.number for case in cases} - modes - {load.case.number for load in loads}
    results = without_modes(results, left_out) if left_out else results
    of_basis = [load for load in every if load.case.number in modes]
    refuse(CaseError, _named_modes(of_basis))
    refuse(DataError, _clashes([load.case for load in of_basis]))
    refuse(DataError, _without_basis(results, loads))
    interface = [mode for mode in options.interface_modes if mode not in {case.number for case in cases}]
    results, apart = _numbered_apart(results, loads)
    return results, (*interface, *sorted(modes)), apart


def _modes(
    every: Sequence[UnitLoad], results: FeResults, options: ConvertOptions, histories: Sequence[ForeignHistory]
) -> set[int]:
    """Numbers of the static subcases that are modes of the basis."""
    numbers = {load.case.number for load in every}
    unnamed = {load.case.number for load in every if not load.is_unit_known}
    asked = numbers.intersection(options.interface_modes)
    if options.static_subcases == "interface_modes":
        return asked | unnamed
    if options.static_subcases is not None:
        return asked
    if not (~results.is_static).any() and not (numbers - unnamed) and not histories:
        return numbers  # a run of static subcases only has no other modes
    given = [
        [
            mode
            for name, mode in zip(history.name, history.mode.tolist(), strict=True)
            if not load_of_column(name, every)
        ]
        for history in histories
    ]
    if options.match == "id":
        return asked | (unnamed & {mode for own in given for mode in own})
    wanted = int((~np.isin(results.mode, options.ignore_modes)).sum())
    in_order = options.match == "order" and any(len(own) == wanted for own in given)
    return asked | (unnamed if in_order else set())


def _without_basis(results: FeResults, loads: Collection[UnitLoad]) -> Iterator[Problem]:
    """Mistake where all that is left are loads: a body has one mode at least."""
    if len(loads) == results.mode.size:
        what = f"its {len(loads)} static subcases are all loads, and there are no modes; a body has one at least"
        remedy = "Give the modal run as --forces and this file as --unit-loads, or --static-subcases interface_modes "
        remedy += "and columns q_<subcase> for coordinates"
        yield Problem("no_modes", results.source, what, remedy)


def _named_modes(modes: Collection[UnitLoad]) -> Iterator[Problem]:
    """Mistake where a subcase is named as a load and as an interface mode."""
    for load in modes:
        if load.is_unit_known:
            where = f"--unit-load-name {load.case.subcase}"
            what = "--interface-modes makes the subcase a mode of the basis, whose coordinate the simulation gives"
            yield Problem("unit_load_name", where, what, "Keep one of the two")


def _clashes(modes: Collection[StaticCase]) -> Iterator[Problem]:
    """Mistake where a subcase that is to be a mode has the number of another."""
    for case in modes:
        if case.number != case.subcase:
            what = f"subcase {case.subcase} has the number of a mode and is to be an interface mode"
            remedy = "Number the subcases of interface modes apart from the modes, as from 1001 on"
            yield Problem("mode_twice", case.source, what, remedy)
            return


def _numbered_apart(results: FeResults, loads: Sequence[UnitLoad]) -> tuple[FeResults, tuple[UnitLoad, ...]]:
    """The same with numbers for the unit loads that no mode and no column has."""
    if not loads:
        return results, ()
    apart = {load.case.number: APART + k for k, load in enumerate(loads)}
    renumbered = replace(
        results,
        mode=np.array([apart.get(mode, mode) for mode in results.mode.tolist()], np.int64),
        static_modes=tuple(apart.get(mode, mode) for mode in results.static_modes),
        static_cases=tuple(replace(case, number=apart.get(case.number, case.number)) for case in results.static_cases),
        unit_loads={apart[load.case.number]: load.name for load in loads},
    )
    return renumbered, tuple(replace(load, case=replace(load.case, number=apart[load.case.number])) for load in loads)
