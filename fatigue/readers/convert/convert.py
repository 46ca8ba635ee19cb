"""Foreign files in, a folder of neutral files with a first ``case.toml`` out."""

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np
import pyarrow as pa

from fatigue.errors import CaseError, DataError, Problem
from fatigue.files.hashes import sha256
from fatigue.readers.convert.audit.audit import Audit
from fatigue.readers.convert.audit.shell_rows import elastic_modes, without_drilling
from fatigue.readers.convert.case_text import case_text
from fatigue.readers.convert.folder import RECORD, check_folder, recorded_files, write_folder
from fatigue.readers.convert.inputs import audited, read_run, unknown_checks
from fatigue.readers.convert.modal_basis import SimulationModes, common_modes, mode_masses, mode_scale
from fatigue.readers.convert.option_fields import words_of
from fatigue.readers.convert.options import ConvertOptions
from fatigue.readers.convert.record import lines_of_welds
from fatigue.readers.convert.tables import elements_table, forces_table, history_table, nodes_table, weld_tables
from fatigue.readers.convert.weld_forces import coordinate_units, neutral_forces, to_mid_surface, with_forces_only
from fatigue.readers.convert.weld_lines import FoundWelds, find_welds, no_welds
from fatigue.readers.foreign.fe.model import in_mm
from fatigue.readers.foreign.fe.results import FeResults
from fatigue.readers.neutral.body import LOWEST_HZ
from fatigue.readers.neutral.register.conversion import COMMAND, LINES, command_line
from fatigue.readers.neutral.register.register_file import register_text
from fatigue.readers.neutral.register.weld_register import REGISTER, RegisterRow, reasons
from fatigue.readers.units.systems import unit_system
from fatigue.stages import stage

CASE = "case.toml"


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

    @property
    def assessed(self) -> int:
        """Number of weld lines that are assessed."""
        return sum(row.status == "assess" for row in self.welds)


def convert(options: ConvertOptions) -> Conversion:
    """Read, audit and write; nothing is written if a check is red.

    Raises
    ------
    DataError : any refusal of the readers, a red check not accepted, no weld to assess, foreign files in the way
    CaseError : an unknown unit system, an undecided sign convention
    """
    units = unit_system(options.force_units, "force units")
    history_units = unit_system(options.coordinate_units, "coordinate units")
    run = read_run(options)
    judged = audited(run, options)
    convention = options.convention or judged.convention
    if convention is None:
        raise CaseError(
            Problem("no_convention", str(options.forces), "the files do not prove the sign of the forces", "State it")
        )
    model, histories = run.model, run.histories
    results, remarks = common_modes(run.results, histories, options.forces, run.interface_modes)
    stage("finding weld lines")
    metric = in_mm(model, units.length)
    register = options.welds.register or (options.out / REGISTER if (options.out / REGISTER).exists() else None)
    found = find_welds(metric, replace(options.welds, register=register))
    found = with_forces_only(found, results)
    if not found.assessed():
        raise DataError(_nothing_to_assess(found, options.mesh))
    stage("turning forces into neutral ones, and writing")
    force = neutral_forces(results, model, units, options.normalisation)
    elements = np.unique(np.concatenate([cut.elements for _, cut in found.assessed()]))
    rows = np.flatnonzero(np.isin(results.element, elements) & results.of_element)
    if judged.grounded_drilling:
        force = without_drilling(force, results, model)
    force = to_mid_surface(force, results, metric, rows)
    files: dict[str, pa.Table | str] = {
        "modes.csv": _modes_table(results, run.interface_modes, run.simulated),
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
    doubts = (*unknown_checks(judged, options), *results.remarks, *model.remarks)
    doubts += (*found.remarks, *remarks, *run.remarks)
    record = {
        "inputs": {str(p): sha256(p) for p in run.inputs(options)},
        "convention": convention,
        "audit": [_plain(asdict(row)) for row in judged.rows],
        "remarks": [str(p) for p in doubts],
        LINES: lines_of_welds(found.rows),
        COMMAND: words_of(options),
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
    how = f"`{command_line(['fatigue', 'welds', str(mesh), '-o', REGISTER])}` writes it, --register reads it"
    remedy = f"Remove the reasons, or set the status of some in the register ({how})"
    return Problem("no_welds", str(mesh), what, remedy)


def _modes_table(results: FeResults, interface_modes: Sequence[int], table: SimulationModes) -> pa.Table:
    is_static = results.analysis == "static"
    interface = np.isin(results.mode, np.array(interface_modes, np.int64))
    rigid = (results.frequency <= LOWEST_HZ) | ~elastic_modes(results)
    kind = np.where(interface | is_static, "interface", np.where(rigid, "rigid", "normal"))
    mass, simulated = mode_masses(results, table)
    return pa.table(
        {
            "mode": results.mode,
            "frequency_hz": np.nan_to_num(results.frequency),
            "modal_mass": np.where(np.isfinite(simulated), simulated, mass),
            "kind": kind.tolist(),
            "scale": mode_scale(results, table),
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
