"""Foreign files in, a folder of neutral files with a first ``case.toml`` out."""

import math
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from fatigue.errors import CaseError, DataError, Problem, refuse
from fatigue.readers.audit import SHELL_KINDS, Audit, audit
from fatigue.readers.case_text import case_text
from fatigue.readers.fe_model import FeModel, in_mm, to_basic
from fatigue.readers.fe_results import FeResults
from fatigue.readers.force_sign import LOWEST_HZ
from fatigue.readers.forces import Convention
from fatigue.readers.foreign_history import ForeignHistory, Match, matched, uniform
from fatigue.readers.formats import read_coordinates, read_forces, read_model
from fatigue.readers.neutral_folder import check_folder, sha256, write_folder
from fatigue.readers.neutral_tables import elements_table, forces_table, history_table, nodes_table, weld_tables
from fatigue.readers.tables import open_table
from fatigue.readers.units import Normalisation, UnitSystem, unit_system
from fatigue.readers.weld_lines import FoundWelds, WeldSources, find_welds
from fatigue.readers.weld_register import RegisterRow, register_text
from fatigue.weld.cuts import WeldCut
from fatigue.weld.mesh import normals

REGISTER = "welds_register.csv"
CASE = "case.toml"

_CONNECTORS = frozenset(
    {
        *(
            "BAR",
            "BEAM",
            "BEAM3",
            "BEND",
            "ROD",
            "CONROD",
            "TUBE",
            "BUSH",
            "BUSH1D",
            "FAST",
            "WELD",
            "SEAM",
            "GAP",
            "VISC",
        ),
        *(f"{kind}{k}" for kind in ("ELAS", "DAMP", "MASS") for k in range(1, 5)),
        *("CONM1", "CONM2", "RBE2", "RBE3", "RBAR", "RROD"),
    }
)
"""Elements that may touch a weld line without being part of a plate."""


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
    interface_modes : modes that are residual, constraint or attachment modes
    ignore_modes : modes to leave out on either side
    match : how columns find their modes
    columns : table of the columns ``column, mode``
    time_column, resample_s : name of the time column; step to interpolate onto
    simulation_modes : table ``mode, frequency_hz, modal_mass`` of the simulation's modes, to compare and scale
    welds : where weld lines come from
    accept : audit checks whose red light is accepted
    curve, title, speed_km_h, target_km : for the first case.toml
    force : overwrite foreign and changed files
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
    coordinate_units = unit_system(options.coordinate_units, "coordinate units")
    results, model = read_forces(options.forces, options.subcase), read_model(options.mesh)
    results = _without_modes(results, options.ignore_modes)
    table = _simulation_modes(options.simulation_modes)
    histories = [_history(path, options, results, table) for path in options.coordinates]
    judged = audit(results, model, options.convention, options.interface_modes, _simulated(histories, table))
    _refuse_red(judged, options)
    convention = options.convention or judged.convention
    if convention is None:
        raise CaseError(
            Problem("no_convention", str(options.forces), "the files do not prove the sign of the forces", "State it")
        )
    results, remarks = _used_modes(results, histories, options)
    metric = in_mm(model, units.length)
    register = options.welds.register or (options.out / REGISTER if (options.out / REGISTER).exists() else None)
    found = find_welds(metric, replace(options.welds, register=register))
    found = _with_forces_only(found, results)
    if not found.assessed():
        reasons = sorted({row.reason for row in found.rows if row.reason})[:3] or ["the mesh has no weld edges"]
        raise DataError(
            Problem("no_welds", str(options.mesh), f"no weld can be assessed: {'; '.join(reasons)}", "See the reasons")
        )
    force = _neutral_forces(results, model, units, options.normalisation)
    elements = np.unique(np.concatenate([cut.elements for _, cut in found.assessed()]))
    rows = np.flatnonzero(np.isin(results.element, elements) & results.of_element)
    force = _to_mid_surface(force, results, metric, rows)
    files: dict[str, pa.Table | str] = {
        "modes.csv": _modes_table(results, options, table),
        "nodes.parquet": nodes_table(metric),
        "elements.parquet": elements_table(metric),
        "element_forces.parquet": forces_table(results, force, rows),
        **weld_tables(found),
        REGISTER: register_text(found.rows),
    }
    factor = coordinate_units.modal_coordinate(options.normalisation) if results.analysis == "modal" else 1.0
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
    if not options.force:
        check_folder(options.out, [*files, "convert.json"], REGISTER)
    record = {
        "inputs": {str(p): sha256(p) for p in (options.forces, options.mesh, *options.coordinates)},
        "convention": convention,
        "audit": [_plain(asdict(row)) for row in judged.rows],
        "remarks": [str(p) for p in (*results.remarks, *found.remarks, *remarks)],
    }
    write_folder(options.out, files, record, CASE)
    return Conversion(
        folder=options.out,
        audit=judged,
        welds=found.rows,
        remarks=(
            *results.remarks,
            *model.remarks,
            *found.remarks,
            *remarks,
            *(r for h in histories for r in h.remarks),
        ),
        modes=results.mode.size,
        force_rows=rows.size * results.mode.size,
        nodes=sum(cut.line.node.size for _, cut in found.assessed()),
        files=(*files, "convert.json"),
    )


def mode_list(text: str) -> tuple[int, ...]:
    """Read a list of modes such as ``1-6,31-52``.

    Raises
    ------
    CaseError : anything else
    """
    modes: list[int] = []
    for part in text.split(","):
        first, dash, last = part.strip().partition("-")
        if not first.isdigit() or (dash and not last.isdigit()) or (dash and int(last) - int(first) > 100_000):
            raise CaseError(Problem("bad_modes", "list of modes", f"{part!r} is no mode or range", "Write 1-6,31-52"))
        modes += range(int(first), int(last or first) + 1)
    return tuple(modes)


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


def _without_modes(results: FeResults, ignored: Iterable[int]) -> FeResults:
    keep = ~np.isin(results.mode, np.array(sorted(ignored), np.int64))
    if keep.all():
        return results
    return replace(
        results,
        mode=results.mode[keep],
        frequency=results.frequency[keep],
        modal_mass=results.modal_mass[keep],
        force=results.force[keep],
        shape=results.shape[keep],
    )


def _simulation_modes(path: Path | None) -> dict[int, tuple[float, float]]:
    """Frequency [Hz] and generalised mass (NaN: not given) of the simulation's modes."""
    if path is None:
        return {}
    table = open_table(path)
    table.expect(("mode", "frequency_hz"), ("modal_mass", "kind", "damping_ratio"), strict=False)
    mode, frequency = table.integers("mode"), table.numbers("frequency_hz")
    mass = table.numbers("modal_mass", default=np.nan)
    table.refuse()
    return {int(m): (float(f), float(g)) for m, f, g in zip(mode, frequency, mass, strict=True)}


def _history(
    path: Path, options: ConvertOptions, results: FeResults, table: dict[int, tuple[float, float]]
) -> ForeignHistory:
    """Read one event and match its columns with the modes of the forces."""
    columns = None
    if options.columns is not None:
        mapping = open_table(options.columns, texts=("column",))
        mapping.expect(("column", "mode"), (), strict=False)
        names, modes = mapping.texts("column"), mapping.integers("mode")
        mapping.refuse()
        columns = {name: int(mode) for name, mode in zip(names, modes, strict=True)}
    history = read_coordinates(path, columns, options.time_column)
    known = np.array([table.get(int(m), (np.nan, np.nan))[0] for m in history.mode])
    history = replace(history, frequency=np.where(np.isnan(history.frequency), known, history.frequency))
    history = matched(history, results.mode, results.frequency, options.match)
    keep = ~np.isin(history.mode, np.array(options.ignore_modes, np.int64))
    history = replace(
        history,
        mode=history.mode[keep],
        frequency=history.frequency[keep],
        name=tuple(n for n, k in zip(history.name, keep, strict=True) if k),
        q=history.q[keep],
    )
    return uniform(history, options.resample_s)


def _simulated(histories: list[ForeignHistory], table: dict[int, tuple[float, float]]) -> dict[int, float]:
    """Frequencies of the simulation by FE mode."""
    if not histories:
        return {mode: frequency for mode, (frequency, _) in table.items()}
    return {int(m): float(f) for h in histories for m, f in zip(h.mode, h.frequency, strict=True) if np.isfinite(f)}


def _used_modes(
    results: FeResults, histories: list[ForeignHistory], options: ConvertOptions
) -> tuple[FeResults, list[Problem]]:
    """Leave out rigid modes the simulation does not have; any other difference of the bases is refused."""
    problems, remarks = [], []
    have = set(results.mode.tolist())
    for history in histories:
        if extra := sorted(set(history.mode.tolist()) - have):
            problems.append(
                Problem(
                    "mode_without_forces",
                    history.source,
                    f"modes {_short(extra)} have coordinates and no forces",
                    "Request their forces, or ignore the modes",
                )
            )
    if histories:
        common = set.intersection(*(set(h.mode.tolist()) for h in histories))
        lacking = sorted(have - common)
        frequency = dict(zip(results.mode.tolist(), results.frequency.tolist(), strict=True))
        rigid = [m for m in lacking if frequency[m] <= LOWEST_HZ and m not in options.interface_modes]
        if elastic := [m for m in lacking if m not in rigid]:
            problems.append(
                Problem(
                    "mode_without_coordinates",
                    str(options.forces),
                    f"modes {_short(elastic)} have forces and no coordinates",
                    "Export their coordinates, or ignore the modes",
                )
            )
        if rigid:
            remarks.append(
                Problem(
                    "rigid_left_out", str(options.forces), f"rigid modes {_short(rigid)} are left out", "Nothing to do"
                )
            )
            results = _without_modes(results, rigid)
    refuse(DataError, problems)
    return results, remarks


def _short(modes: list[int]) -> str:
    return ", ".join(str(m) for m in modes[:10]) + (f" and {len(modes) - 10} more" if len(modes) > 10 else "")


def _with_forces_only(found: FoundWelds, results: FeResults) -> FoundWelds:
    """Exclude welds whose side lacks forces, or which an element of unknown kind touches."""
    present: dict[int, set[int]] = {}
    for element, node in zip(results.element[results.of_element], results.node[results.of_element], strict=True):
        present.setdefault(int(element), set()).add(int(node))
    strange = results.of_element & ~np.isin(results.kind, sorted(SHELL_KINDS | _CONNECTORS))
    strange_at = dict(zip(results.node[strange].tolist(), results.kind[strange].tolist(), strict=True))
    rows = []
    for row in found.rows:
        cut = found.cuts.get(row.line)
        reason = _force_gap(cut, present, strange_at) if cut is not None and row.status == "assess" else ""
        rows.append(replace(row, status="excluded", reason=reason) if reason else row)
    return replace(found, rows=tuple(rows))


def _force_gap(cut: WeldCut, present: dict[int, set[int]], strange_at: dict[int, str]) -> str:
    """Why a cut cannot be assessed with the forces at hand; empty if it can."""
    silent = [int(e) for e in cut.elements if int(e) not in present]
    if silent:
        return f"{len(silent)} of {cut.elements.size} elements have no grid point forces, element {silent[0]} the first"
    covered = set().union(*(present[int(e)] for e in cut.elements))
    bare = [int(n) for n in cut.line.node if int(n) not in covered]
    if bare:
        return f"node {bare[0]} has no grid point forces"
    touching = [int(n) for n in cut.line.node if int(n) in strange_at]
    if touching:
        return f"an element of kind {strange_at[touching[0]]} touches the line at node {touching[0]}"
    return ""


def _neutral_forces(
    results: FeResults, model: FeModel, units: UnitSystem, normalisation: Normalisation
) -> NDArray[np.floating]:
    """Turn the forces of all rows into basic axes and N, N mm per unit modal coordinate of the mm, t, s system."""
    coordinate = units.modal_coordinate(normalisation) if results.analysis == "modal" else 1.0
    factor = units.force / coordinate * np.array([1.0] * 3 + [units.length] * 3)
    force = to_basic(results.force, results.node, model)
    return force if np.all(factor == 1) else (force * factor).astype(force.dtype)


def _to_mid_surface(
    force: NDArray[np.floating], results: FeResults, model: FeModel, rows: NDArray[np.int64]
) -> NDArray[np.floating]:
    """Move moments from the grids to the mid-surface: the grid lies at -offset along the element normal."""
    mesh = model.mesh
    at = np.searchsorted(mesh.element, results.element[rows])
    offset = mesh.offset[at]
    shifted = rows[offset != 0]
    if not shifted.size:
        return force
    arm = -(offset[:, None] * normals(mesh)[at])[offset != 0]
    moved = force.copy()
    moved[:, shifted, 3:] += np.cross(arm, force[:, shifted, :3])
    return moved


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
