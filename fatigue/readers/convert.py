"""Foreign files in, a folder of neutral files with a first ``case.toml`` out."""

import math
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

import numpy as np
import pyarrow as pa

from fatigue.errors import CaseError, DataError, Problem, refuse
from fatigue.readers.audit import Audit, audit
from fatigue.readers.case_text import case_text
from fatigue.readers.convert_record import COMMAND, LINES, arguments_of, lines_of_welds
from fatigue.readers.fe_model import in_mm
from fatigue.readers.fe_results import FeResults
from fatigue.readers.force_sign import LOWEST_HZ
from fatigue.readers.forces import Convention
from fatigue.readers.foreign_history import ForeignHistory, Match, matched, uniform, with_own_frequencies
from fatigue.readers.formats import read_coordinates, read_forces, read_model
from fatigue.readers.modal_basis import (
    column_map,
    common_modes,
    numbered,
    simulated_frequencies,
    simulation_modes,
    with_declared_units,
    with_known_frequencies,
    without_modes,
)
from fatigue.readers.neutral_folder import RECORD, check_folder, recorded_files, sha256, write_folder
from fatigue.readers.neutral_tables import elements_table, forces_table, history_table, nodes_table, weld_tables
from fatigue.readers.units import Normalisation, unit_system
from fatigue.readers.weld_forces import coordinate_units, neutral_forces, to_mid_surface, with_forces_only
from fatigue.readers.weld_lines import FoundWelds, WeldSources, find_welds, no_welds
from fatigue.readers.weld_register import REGISTER, RegisterRow, reasons, register_text

CASE = "case.toml"
_FREQUENCIES = "frequency match"  # the check of the audit


@dataclass(frozen=True, slots=True)
class ConvertOptions:
    """What to convert, and how the foreign files are to be understood.

    Attributes
    ----------
    forces, mesh : grid point forces and geometry; an MSC .h5 holds both
    out : folder to write
    coordinates : modal coordinates, one file for each event
    convention : sign of the forces; None: as the audit proves it
    subcase : which one, where the force file has several
    force_units, coordinate_units : unit systems of the FE files and of the coordinates
    normalisation : whether modes have unit generalised mass or unit displacement (for the conversion of units)
    interface_modes : modes that are residual, constraint or attachment modes; static subcases among them are read, too
    ignore_modes : modes to leave out on either side
    match : how columns find their modes
    columns : table of the columns ``column, mode``
    time_column, resample_s : name of the time column; step to interpolate onto
    simulation_modes : table ``mode, frequency_hz, modal_mass`` of the simulation's modes, to compare and scale
    welds : where weld lines come from
    accept : audit checks whose red light is accepted
    curve, title, speed_km_h, target_km : for the first case.toml
    force : overwrite foreign and changed files
    keep_case : leave a case.toml in the folder as it is
    """

    forces: Path
    mesh: Path
    out: Path
    coordinates: tuple[Path, ...] = ()
    convention: Convention | None = None
    subcase: int | None = None
    force_units: str = "mm-t-s"
    coordinate_units: str = "mm-t-s"
    normalisation: Normalisation = "mass"
    interface_modes: tuple[int, ...] = ()
    ignore_modes: tuple[int, ...] = ()
    match: Match = "id"
    columns: Path | None = None
    time_column: str | None = None
    resample_s: float | None = None
    simulation_modes: Path | None = None
    welds: WeldSources = field(default_factory=WeldSources)
    accept: tuple[str, ...] = ()
    curve: str = "master-aluminium"
    title: str = ""
    speed_km_h: float = 100.0
    target_km: float = 1.0e6
    force: bool = False
    keep_case: bool = False


@dataclass(frozen=True, slots=True)
class Conversion:
    """What a conversion found and wrote."""

    folder: Path
    audit: Audit
    welds: tuple[RegisterRow, ...]
    remarks: tuple[Problem, ...]
    modes: int
    force_rows: int
    nodes: int
    files: tuple[str, ...]


def convert(options: ConvertOptions) -> Conversion:
    """Read, audit and write; nothing is written if a check is red.

    Raises
    ------
    DataError : any refusal of the readers, a red check not accepted, no weld to assess, foreign files in the way
    CaseError : an unknown unit system, an undecided sign convention
    """
    units = unit_system(options.force_units, "force units")
    history_units = unit_system(options.coordinate_units, "coordinate units")
    results, model = read_forces(options.forces, options.subcase, options.interface_modes), read_model(options.mesh)
    results = without_modes(results, options.ignore_modes)
    table, of_table = simulation_modes(options.simulation_modes)
    histories = []
    simulated: dict[int, tuple[float, float]] = {}  # by FE mode
    for path in options.coordinates:
        history, own = _history(path, options, results, table)
        histories.append(history)
        simulated |= {fe: table[mode] for fe, mode in own.items() if mode in table}
    simulated = simulated if histories else table
    judged = audit(
        results, model, options.convention, options.interface_modes, simulated_frequencies(histories, simulated)
    )
    _refuse_red(judged, options)
    if _FREQUENCIES not in options.accept:
        for history in histories:
            with_own_frequencies(history, results.mode, results.frequency)
    convention = options.convention or judged.convention
    if convention is None:
        raise CaseError(
            Problem("no_convention", str(options.forces), "the files do not prove the sign of the forces", "State it")
        )
    results, remarks = common_modes(results, histories, options.forces, options.interface_modes)
    metric = in_mm(model, units.length)
    register = options.welds.register or (options.out / REGISTER if (options.out / REGISTER).exists() else None)
    found = find_welds(metric, replace(options.welds, register=register))
    found = with_forces_only(found, results)
    if not found.assessed():
        raise DataError(_nothing_to_assess(found, options.mesh))
    force = neutral_forces(results, model, units, options.normalisation)
    elements = np.unique(np.concatenate([cut.elements for _, cut in found.assessed()]))
    rows = np.flatnonzero(np.isin(results.element, elements) & results.of_element)
    force = to_mid_surface(force, results, metric, rows)
    files: dict[str, pa.Table | str] = {
        "modes.csv": _modes_table(results, options, simulated),
        "nodes.parquet": nodes_table(metric),
        "elements.parquet": elements_table(metric),
        "element_forces.parquet": forces_table(results, force, rows),
        **weld_tables(found),
        REGISTER: register_text(found.rows),
    }
    factor = coordinate_units(results, history_units, options.normalisation)
    events = []
    for history in histories:
        name = _unused(f"q_{_slug(Path(history.source).stem)}.parquet", files)
        files[name] = history_table(history, results.mode, factor)
        events.append((Path(history.source).stem, name))
    unused = sorted({int(m) for h in histories for m in h.mode} - set(results.mode.tolist()))
    files[CASE] = case_text(
        options.title or f"{options.mesh.stem}",
        convention,
        unused,
        options.curve,
        events,
        options.speed_km_h,
        options.target_km,
    )
    kept = {}
    if options.keep_case and (options.out / CASE).is_file():
        kept = {name: known for name, known in recorded_files(options.out).items() if name == CASE}
        del files[CASE]
    if not options.force:
        check_folder(options.out, [*files, RECORD], REGISTER)
    told = (*of_table, *remarks, *(r for h in histories for r in h.remarks))
    doubts = (*results.remarks, *model.remarks, *found.remarks, *told)
    record = {
        "inputs": {str(p): sha256(p) for p in (options.forces, options.mesh, *model.included, *options.coordinates)},
        "convention": convention,
        "audit": [_plain(asdict(row)) for row in judged.rows],
        "remarks": [str(p) for p in doubts],
        LINES: lines_of_welds(found.rows),
        COMMAND: arguments_of(options),
    }
    write_folder(options.out, files, record, CASE, kept)
    return Conversion(
        folder=options.out,
        audit=judged,
        welds=found.rows,
        remarks=doubts,
        modes=results.mode.size,
        force_rows=rows.size * results.mode.size,
        nodes=sum(cut.line.node.size for _, cut in found.assessed()),
        files=(*files, RECORD),
    )


def _nothing_to_assess(found: FoundWelds, mesh: Path) -> Problem:
    """Say why no weld line can be assessed: all kinds of reasons, with their numbers."""
    if not found.rows:
        return no_welds(mesh)
    kinds = "; ".join(f"{number} because {reason}" for number, reason in reasons(found.rows))
    what = f"none of the {len(found.rows)} weld lines can be assessed: {kinds}"
    return Problem("no_welds", str(mesh), what, "Remove the reasons, or set the status of some in the register")


def _refuse_red(judged: Audit, options: ConvertOptions) -> None:
    """Turn red lights that are not accepted into a refusal."""
    refuse(
        DataError,
        [
            Problem("audit", f"{options.forces}, {row.check}", row.finding, row.remedy or "Correct the input")
            for row in judged.rows
            if row.light == "red" and row.check not in options.accept
        ],
    )


def _history(
    path: Path, options: ConvertOptions, results: FeResults, table: dict[int, tuple[float, float]]
) -> tuple[ForeignHistory, dict[int, int]]:
    """Read one event and match its columns with the modes of the forces; the simulation's number of every FE mode."""
    columns, doubts = (None, []) if options.columns is None else column_map(options.columns)
    stated = read_coordinates(path, columns, options.time_column)
    if options.match == "order":
        stated = numbered(stated, table, options.simulation_modes or path)
    history = with_known_frequencies(stated, table, options.simulation_modes or path)
    if options.match == "frequency" or _FREQUENCIES in options.accept:
        history = matched(history, results.mode, results.frequency, options.match)
    else:  # what the file itself states is compared here, the table of the simulation's modes after the audit
        joined = matched(stated, results.mode, results.frequency, options.match)
        with_own_frequencies(joined, results.mode, results.frequency)
        history = replace(history, mode=joined.mode)
    own = dict(zip(history.mode.tolist(), stated.mode.tolist(), strict=True))
    history = replace(history, remarks=(*doubts, *history.remarks))
    history = with_declared_units(history, options.coordinate_units, options.normalisation, results.analysis)
    keep = ~np.isin(history.mode, np.array(options.ignore_modes, np.int64))
    history = replace(
        history,
        mode=history.mode[keep],
        frequency=history.frequency[keep],
        name=tuple(n for n, k in zip(history.name, keep, strict=True) if k),
        unit=tuple(u for u, k in zip(history.unit, keep, strict=True) if k) if history.unit else (),
        resolution=None if history.resolution is None else history.resolution[keep],
        q=history.q[keep],
    )
    return uniform(history, options.resample_s), own


def _modes_table(results: FeResults, options: ConvertOptions, table: dict[int, tuple[float, float]]) -> pa.Table:
    is_static = results.analysis == "static"
    interface = np.isin(results.mode, np.array(options.interface_modes, np.int64))
    kind = np.where(interface | is_static, "interface", np.where(results.frequency <= LOWEST_HZ, "rigid", "normal"))
    mass = np.where(results.modal_mass > 0, results.modal_mass, 1.0)
    simulated = np.array([table.get(int(m), (np.nan, np.nan))[1] for m in results.mode])
    scale = np.where(np.isfinite(simulated), np.sqrt(simulated / mass), 1.0)
    return pa.table(
        {
            "mode": results.mode,
            "frequency_hz": np.nan_to_num(results.frequency),
            "modal_mass": np.where(np.isfinite(simulated), simulated, mass),
            "kind": kind.tolist(),
            "scale": scale,
        }
    )


def _slug(name: str) -> str:
    return "".join(c if c.isalnum() or c in "-_." else "_" for c in name).lower() or "event"


def _unused(name: str, files: dict[str, pa.Table | str]) -> str:
    """Return the name, with a number if two events have the same."""
    stem, number = name.removesuffix(".parquet"), 2
    while name in files:
        name, number = f"{stem}_{number}.parquet", number + 1
    return name


def _plain(row: dict[str, object]) -> dict[str, object]:
    """Audit row for JSON, which knows no NaN and no infinity."""
    value = row["value"]
    return {**row, "value": value if isinstance(value, float) and math.isfinite(value) else None}
