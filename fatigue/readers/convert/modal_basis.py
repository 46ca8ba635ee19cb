"""The modes of the forces and the modes of the simulation: one basis, or a refusal that names the difference."""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.foreign.fe.results import FeResults
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory
from fatigue.readers.foreign.histories.mode_frequencies import StatedFrequencies
from fatigue.readers.neutral.body.modes import LOWEST_HZ
from fatigue.readers.neutral.tables import open_table
from fatigue.readers.units.coordinate_units import SYSTEM_UNITS, compared
from fatigue.readers.units.systems import Normalisation, UnitSystem

Floats = NDArray[np.float64]
SimulationModes: TypeAlias = dict[int, tuple[float, float]]  # frequency [Hz] and modal mass by mode

_NORMALISED: dict[Normalisation, str] = {"mass": "unit generalised mass", "length": "unity"}


def without_modes(results: FeResults, ignored: Iterable[int]) -> FeResults:
    """FE results without some modes.

    Raises
    ------
    DataError : no mode is left
    """
    keep = ~np.isin(results.mode, np.array(sorted(ignored), np.int64))
    if keep.all():
        return results
    if not keep.any():
        what = f"all {results.mode.size} modes with forces are left out: {_short(results.mode.tolist())}"
        raise DataError(Problem("no_modes", results.source, what, "Name fewer modes in --ignore-modes"))
    return only_modes(results, keep)


def only_modes(results: FeResults, keep: NDArray[np.bool_]) -> FeResults:
    """FE results of the modes and unit loads to ``keep``, (m,)."""
    return replace(
        results,
        mode=results.mode[keep],
        frequency=results.frequency[keep],
        modal_mass=results.modal_mass[keep],
        force=results.force[keep],
        shape=results.shape[keep],
    )


def column_map(path: Path) -> tuple[dict[str, int], list[Problem]]:
    """Mode of each column by its name, from a table of the columns ``column, mode``; and warnings."""
    table = open_table(path, texts=("column",))
    table.expect(("column", "mode"), (), strict=False)
    names, code = table.groups("column")
    mode = table.integers("mode")
    table.unique({"column": code}, {"column": names})
    table.refuse()
    return {names[c]: int(m) for c, m in zip(code, mode, strict=True)}, table.warnings


def with_known_frequencies(history: ForeignHistory, table: SimulationModes, source: Path) -> ForeignHistory:
    """History with the frequencies that the table of the simulation's modes has, by the simulation's own numbers.

    Raises
    ------
    DataError : a frequency that the file states otherwise, by more than the digits of both explain
    """
    known = np.array([table.get(int(m), (np.nan, np.nan))[0] for m in history.mode])
    problems = []
    own = StatedFrequencies(history.name, history.mode, history.frequency, history.resolution)
    listed = StatedFrequencies(history.name, history.mode, known, None)
    for k in np.flatnonzero(np.isfinite(known) & np.isfinite(own.frequency)).tolist():
        if abs(known[k] - own.frequency[k]) > own.half_digit(k) + listed.half_digit(k):
            what = f"mode {own.mode[k]} has {known[k]:.6g} Hz, and {own.frequency[k]:.6g} Hz in {history.source}"
            problems.append(Problem("frequency", str(source), what, "Give the modes of this simulation"))
    refuse(DataError, problems)
    return replace(history, frequency=np.where(np.isnan(history.frequency), known, history.frequency))


def with_declared_units(
    history: ForeignHistory, system: str, normalisation: Normalisation, analysis: str
) -> ForeignHistory:
    """History whose stated unit and normalisation do not contradict the options; a warning where they may.

    Coordinates of load cases are multiples of the loads; whatever a file states of their unit is a warning.

    Raises
    ------
    DataError : a contradiction, with the options that would remove it
    """
    problems: list[Problem] = []
    warnings: list[Problem] = []
    if analysis == "modal":
        if history.unit:
            problems, warnings = compared(history.source, history.name, history.unit, system, normalisation)
        own = SYSTEM_UNITS[system][0]
        if history.length and history.length != own:
            fitting = [
                f"--coordinate-units {name}" for name, units in SYSTEM_UNITS.items() if units[0] == history.length
            ]
            what = f"its header declares lengths in {history.length}; --coordinate-units {system} takes them in {own}"
            remedy = f"State {fitting[0]}" if fitting else "Export in a system that --coordinate-units knows"
            problems.append(Problem("coordinate_unit", history.source, what, remedy))
        if history.normalisation not in (None, normalisation):
            what = f"its header declares modes normalised to {_NORMALISED[history.normalisation]}; "
            what += f"--normalisation {normalisation} takes them as normalised to {_NORMALISED[normalisation]}"
            remedy = f"State --normalisation {history.normalisation}, or write coordinates for the modes of the FE run"
            problems.append(Problem("normalisation", history.source, what, remedy))
    elif units := [unit for unit in dict.fromkeys(history.unit) if unit]:
        what = f"the coordinates of load cases are multiples of their loads; the file states {', '.join(units)}"
        warnings.append(Problem("coordinate_unit", history.source, what, "Check that one is one load of the subcase"))
    refuse(DataError, problems)
    return replace(history, warnings=(*history.warnings, *warnings))


def simulation_modes(path: Path | None) -> tuple[SimulationModes, list[Problem]]:
    """Frequency [Hz] and generalised mass (NaN: not given) of the simulation's modes; and warnings."""
    if path is None:
        return {}, []
    table = open_table(path)
    table.expect(("mode", "frequency_hz"), ("modal_mass", "kind", "damping_ratio"), strict=False)
    mode, frequency = table.integers("mode"), table.numbers("frequency_hz")
    mass = table.numbers("modal_mass", default=np.nan)
    table.unique({"mode": mode})
    table.refuse()
    found = {int(m): (float(f), float(g)) for m, f, g in zip(mode, frequency, mass, strict=True)}
    return found, table.warnings


def numbered(history: ForeignHistory, table: SimulationModes, source: Path) -> ForeignHistory:
    """History whose columns without a mode number have the numbers of the simulation's modes, in order.

    Raises
    ------
    DataError : the table has another number of modes
    """
    if not table or (history.mode > 0).all():
        return history
    if len(table) != history.mode.size:
        what = f"{len(table)} modes for {history.mode.size} columns of {history.source}, which name none"
        raise DataError(
            Problem("column_count", str(source), what, "Give one row for every column, or name the columns")
        )
    return replace(history, mode=np.array(list(table), np.int64))


def simulated_frequencies(histories: Sequence[ForeignHistory], table: SimulationModes) -> dict[int, float]:
    """Frequencies of the simulation by FE mode."""
    if not histories:
        return {mode: frequency for mode, (frequency, _) in table.items()}
    return {int(m): float(f) for h in histories for m, f in zip(h.mode, h.frequency, strict=True) if np.isfinite(f)}


def common_modes(
    results: FeResults, histories: Sequence[ForeignHistory], source: Path, interface_modes: Collection[int]
) -> tuple[FeResults, list[Problem]]:
    """FE results without the rigid modes that the simulation lacks, and warnings; any other difference is refused.

    Unit loads may have a history each or none.
    """
    problems, warnings = [], []
    have = set(results.mode[results.of_basis].tolist())
    for history in histories:
        if extra := sorted(set(history.mode.tolist()) - have - set(results.unit_loads)):
            problems.append(
                Problem(
                    "mode_without_forces",
                    history.source,
                    f"modes {_short(extra)} have coordinates and no forces",
                    _in_order(history, results) or f"Request their forces, or ignore the modes{_left_out(results)}",
                )
            )
    if histories:
        common = set.intersection(*(set(h.mode.tolist()) for h in histories))
        lacking = sorted(have - common)
        frequency = dict(zip(results.mode.tolist(), results.frequency.tolist(), strict=True))
        rigid = [m for m in lacking if frequency[m] <= LOWEST_HZ and m not in interface_modes]
        if elastic := [m for m in lacking if m not in rigid]:
            problems.append(
                Problem(
                    "mode_without_coordinates",
                    str(source),
                    f"modes {_short(elastic)} have forces and no coordinates",
                    next(filter(None, (_in_order(h, results) for h in histories)), "")
                    or "Export their coordinates, or ignore the modes",
                )
            )
        if rigid:
            warnings.append(
                Problem("rigid_left_out", str(source), f"rigid modes {_short(rigid)} are left out", "Nothing to do")
            )
            results = without_modes(results, rigid)
    refuse(DataError, problems)
    return results, warnings


def _in_order(history: ForeignHistory, results: FeResults) -> str:
    """Proposal to join in order, where the simulation seems to count its modes from another number; else empty."""
    own = np.sort(history.mode[~np.isin(history.mode, list(results.unit_loads))])
    fe = results.mode[results.of_basis]
    count = own.size
    rigid = results.mode[results.frequency <= LOWEST_HZ]
    if np.array_equal(own, fe) or not np.array_equal(own, own[:1] + np.arange(count)):
        return ""
    if count == fe.size:
        pairs = f"modes {own[0]}-{own[-1]} of the simulation are modes {fe[0]}-{fe[-1]} of the FE run"
        return f"If {pairs}, state --match order"
    if count == fe.size - rigid.size and own[0] == 1:
        some = f"{rigid[0]}-{rigid[-1]}" if rigid[-1] - rigid[0] + 1 == rigid.size else ",".join(map(str, rigid))
        return (
            f"If modes 1-{count} of the simulation are the elastic modes of the FE run, state --match order "
            f"--ignore-modes {some}"
        )
    return ""


def _left_out(results: FeResults) -> str:
    """Reminder of static subcases that the force file has and that were not asked for; empty without any."""
    found = [warning.what for warning in results.warnings if warning.code == "static_left_out"]
    return f"; {found[0]}, name them with --interface-modes if it is these" if found else ""


def _short(modes: list[int]) -> str:
    return ", ".join(str(m) for m in modes[:10]) + (f" and {len(modes) - 10} more" if len(modes) > 10 else "")


def mode_masses(results: FeResults, table: SimulationModes) -> tuple[Floats, Floats]:
    """Generalised masses (m,) of the FE run, and of the simulation (NaN: not given)."""
    mass = np.where(results.modal_mass > 0, results.modal_mass, 1.0)
    return mass, np.array([table.get(int(m), (np.nan, np.nan))[1] for m in results.mode])


def mode_scale(results: FeResults, table: SimulationModes) -> Floats:
    """Factor (m,) on the coordinates of each mode, where simulation and FE run normalise differently."""
    mass, simulated = mode_masses(results, table)
    return np.where(np.isfinite(simulated), np.sqrt(simulated / mass), 1.0)


def coordinate_units(results: FeResults, units: UnitSystem, normalisation: Normalisation) -> NDArray[np.float64]:
    """Unit of each mode's coordinate, (m,); the coordinate of a static subcase is a plain number of its loads."""
    return np.where(results.is_static, 1.0, units.modal_coordinate(normalisation))


def assumed_masses(results: FeResults, table: SimulationModes) -> list[Problem]:
    """Warning about modes scaled to the simulation's masses although the FE run states none of its own."""
    _, simulated = mode_masses(results, table)
    assumed = results.mode[np.isfinite(simulated) & ~(results.modal_mass > 0)].tolist()
    if not assumed:
        return []
    what = f"the file states no generalised masses of the modes {_short(assumed)}; 1 is assumed beside the simulation's"
    return [Problem("assumed_mass", results.source, what, "Normalise the FE run to unit mass, or request the summary")]
