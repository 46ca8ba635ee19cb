"""The foreign files of a conversion, read and put together: forces, mesh and the coordinates of all events."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.convert.audit.audit import Audit, audit
from fatigue.readers.convert.audit.row import AuditRow
from fatigue.readers.convert.displacement.check import ModalSum, displacement_row
from fatigue.readers.convert.displacement.record import read_displacement
from fatigue.readers.convert.loads.columns import load_columns, with_columns
from fatigue.readers.convert.loads.names import UnitLoad
from fatigue.readers.convert.loads.roles import with_roles
from fatigue.readers.convert.modal_basis import (
    SimulationModes,
    assumed_masses,
    column_map,
    mode_scale,
    numbered,
    only_modes,
    simulated_frequencies,
    simulation_modes,
    with_declared_units,
    with_known_frequencies,
    without_modes,
)
from fatigue.readers.convert.options import ConvertOptions
from fatigue.readers.convert.unit_loads import with_unit_loads
from fatigue.readers.foreign.fe.model import FeModel
from fatigue.readers.foreign.fe.results import FeResults
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory
from fatigue.readers.foreign.histories.matching import matched, with_own_frequencies
from fatigue.readers.foreign.histories.time_grid import uniform
from fatigue.readers.foreign.read import read_coordinates, read_forces, read_model
from fatigue.readers.units.systems import unit_system
from fatigue.stages import stage

FREQUENCIES = "frequency match"  # the check of the audit


@dataclass(frozen=True, slots=True, eq=False)
class ForeignInputs:
    """FE run and simulation as their files tell them, in the files' own units.

    Attributes
    ----------
    results : forces and shapes of the modes and unit loads that are used
    interface_modes : modes named as such, and static subcases that are modes
    unit_loads : the other static subcases, in the order of ``results``
    histories : modal coordinates of every event, with the modes of ``results``, and unit loads that their files give
    simulated : frequency [Hz] and modal mass of the simulation's modes, by mode of the FE run
    warnings : about the simulation's modes and coordinates
    """

    results: FeResults
    model: FeModel
    interface_modes: tuple[int, ...]
    unit_loads: tuple[UnitLoad, ...]
    histories: tuple[ForeignHistory, ...]
    simulated: SimulationModes
    warnings: tuple[Problem, ...]

    def files(self, options: ConvertOptions) -> tuple[Path, ...]:
        """Files that were read."""
        displacements = (asked.file for asked in options.displacements)
        fe = (options.forces, options.mesh, *self.model.included, *options.unit_loads)
        return (*fe, *options.coordinates, *displacements)


def read_inputs(options: ConvertOptions) -> ForeignInputs:
    """Forces, mesh and coordinates, read from their files.

    Raises
    ------
    CaseError, DataError : any refusal of the readers; coordinates whose frequencies fit other modes
    """
    stage("reading forces and mesh")
    results, model = _forces(options), read_model(options.mesh)
    stage("reading modes and coordinates (%d files)", len(options.coordinates))
    columns, of_columns = (None, []) if options.columns is None else column_map(options.columns)
    stated = [read_coordinates(path, columns, options.time_column) for path in options.coordinates]
    numbers = set(results.mode.tolist())
    results, interface_modes, loads = with_roles(without_modes(results, options.ignore_modes), options, stated)
    table, warnings = simulation_modes(options.simulation_modes)
    read = [_history(history, options, results, loads, table) for history in stated]
    simulated = {fe: table[mode] for _, own in read for fe, mode in own.items() if mode in table} if read else table
    numbers |= {fe for _, own in read for fe in own}
    warnings += of_columns + assumed_masses(results, simulated) + _ignored_nowhere(options, numbers)
    histories = tuple(history for history, _ in read)
    of_histories = [warning for history in histories for warning in history.warnings]
    return ForeignInputs(results, model, interface_modes, loads, histories, simulated, (*warnings, *of_histories))


def _forces(options: ConvertOptions) -> FeResults:
    """Forces of the modes and of all static subcases that may be loads or modes beside them."""
    of_files = [read_forces(path, None) for path in options.unit_loads]
    beside = {mode for loads in of_files for mode in loads.mode.tolist()}
    interface = [mode for mode in options.interface_modes if mode not in beside]
    named = [one.subcase for one in options.unit_load_names]
    loads = named if options.subcase is not None or options.static_subcases == "leave_out" else None
    results = read_forces(options.forces, options.subcase, interface, loads)
    for static in of_files:
        results = with_unit_loads(results, static)
    return results


def audited(read: ForeignInputs, options: ConvertOptions) -> Audit:
    """Audit of what was read.

    Raises
    ------
    DataError : a red light that is not accepted, coordinates whose frequencies fit other modes
    """
    stage("auditing")
    frequencies = simulated_frequencies(read.histories, read.simulated)
    judged = audit(read.results, read.model, options.convention, read.interface_modes, frequencies)
    judged = replace(judged, rows=(*judged.rows, *_displacement_rows(read, options)))
    refuse(
        DataError,
        [
            Problem("audit", f"{options.forces}, {row.check}", row.finding, row.remedy or "Correct the input")
            for row in judged.red
            if row.check not in options.accept
        ],
    )
    if FREQUENCIES not in options.accept:
        for history in read.histories:
            with_own_frequencies(history, read.results.mode, read.results.frequency)
    return judged


def unknown_checks(judged: Audit, options: ConvertOptions) -> list[Problem]:
    """Warnings about checks to accept that the audit does not have: misspelt, or there is nothing to accept."""
    known = sorted({row.check for row in judged.rows})
    return [
        Problem("unknown_check", f"--accept {name!r}", "the audit has no such check", f"Choose of {', '.join(known)}")
        for name in options.accept
        if name not in (*known, FREQUENCIES)
    ]


def _displacement_rows(read: ForeignInputs, options: ConvertOptions) -> Iterator[AuditRow]:
    """Rows on the displacements that are given, each beside mode shapes times coordinates."""
    basis = only_modes(read.results, read.results.of_basis)
    modal = ModalSum(
        basis,
        read.model,
        read.histories,
        mode_scale(basis, read.simulated),
        unit_system(options.force_units, "force units"),
        unit_system(options.coordinate_units, "coordinate units"),
        options.normalisation,
    )
    records = [read_displacement(asked.file, modal.history_units.length) for asked in options.displacements]
    for asked, record in zip(options.displacements, records, strict=True):
        yield displacement_row(asked, record, modal)


def _ignored_nowhere(options: ConvertOptions, numbers: set[int]) -> list[Problem]:
    """Warning about modes to ignore that neither side has, as a slip of the pen is."""
    nowhere = sorted(set(options.ignore_modes) - numbers)
    if not nowhere:
        return []
    what = f"neither the forces nor the coordinates have the modes {', '.join(map(str, nowhere[:10]))}"
    return [Problem("ignored_nowhere", "--ignore-modes", what, "Correct the list, unless it is meant for other files")]


def _history(
    stated: ForeignHistory,
    options: ConvertOptions,
    results: FeResults,
    loads: Sequence[UnitLoad],
    table: SimulationModes,
) -> tuple[ForeignHistory, dict[int, int]]:
    """One event, its columns matched with the modes of the forces; and the simulation's number of every FE mode."""
    of_load = load_columns(stated, loads)
    modes = _columns(stated, of_load == 0)
    joined, own = _matched(modes, options, only_modes(results, results.of_basis), table)
    kept = _columns(joined, ~np.isin(joined.mode, np.array(options.ignore_modes, np.int64)))
    if of_load.any():
        kept = with_columns(kept, replace(_columns(stated, of_load > 0), mode=of_load[of_load > 0]))
    return uniform(kept, options.resample_s), own


def _matched(
    stated: ForeignHistory, options: ConvertOptions, results: FeResults, table: SimulationModes
) -> tuple[ForeignHistory, dict[int, int]]:
    """Modal coordinates of one event with the modes of the forces; and the simulation's number of every FE mode."""
    source = options.simulation_modes or Path(stated.source)
    if options.match == "order":
        stated = numbered(stated, table, source)
    history = with_known_frequencies(stated, table, source)
    if options.match == "frequency" or FREQUENCIES in options.accept:
        history = matched(history, results.mode, results.frequency, options.match)
    else:  # what the file itself states is compared here, the table of the simulation's modes after the audit
        joined = matched(stated, results.mode, results.frequency, options.match)
        with_own_frequencies(joined, results.mode, results.frequency)
        history = replace(history, mode=joined.mode)
    own = dict(zip(history.mode.tolist(), stated.mode.tolist(), strict=True))
    return with_declared_units(history, options.coordinate_units, options.normalisation, results.analysis), own


def _columns(history: ForeignHistory, kept: NDArray[np.bool_]) -> ForeignHistory:
    """History with some of its columns."""
    if kept.all():
        return history
    return replace(
        history,
        mode=history.mode[kept],
        frequency=history.frequency[kept],
        name=tuple(n for n, k in zip(history.name, kept, strict=True) if k),
        unit=tuple(u for u, k in zip(history.unit, kept, strict=True) if k) if history.unit else (),
        resolution=None if history.resolution is None else history.resolution[kept],
        q=history.q[kept],
    )
