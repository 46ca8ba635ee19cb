"""Foreign files in, a folder of neutral files with a first ``case.toml`` out."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pyarrow as pa

from fatigue.errors import CaseError, DataError, Problem
from fatigue.readers.convert.audit.audit import Audit
from fatigue.readers.convert.audit.shell_rows import without_drilling
from fatigue.readers.convert.case_text import CASE, case_text
from fatigue.readers.convert.folder import RECORD, check_folder, recorded_files, write_folder
from fatigue.readers.convert.inputs import ForeignInputs, audited, read_inputs, unknown_checks
from fatigue.readers.convert.loads.at_welds import loads_at_welds
from fatigue.readers.convert.loads.names import UnitLoad
from fatigue.readers.convert.loads.text import UNIT_LOADS, load_warnings, loads_not_given, loads_text
from fatigue.readers.convert.modal_basis import common_modes, coordinate_units, only_modes
from fatigue.readers.convert.neutral_tables import (
    WELD_COLUMNS,
    elements_table,
    event_tables,
    forces_table,
    loads_table,
    modes_table,
    nodes_table,
    weld_tables,
)
from fatigue.readers.convert.options import ConvertOptions, WeldSources
from fatigue.readers.convert.record import conversion_record
from fatigue.readers.convert.stresses.kept_case import points_not_in_case
from fatigue.readers.convert.stresses.modal_stresses import MODAL_STRESSES, PointStresses, point_stresses
from fatigue.readers.convert.weld_forces import neutral_forces, rows_at_welds, to_mid_surface, with_forces_only
from fatigue.readers.convert.weld_lines import FoundWelds, find_welds, no_welds
from fatigue.readers.foreign.fe.model import in_mm
from fatigue.readers.foreign.fe.results import FeResults
from fatigue.readers.neutral.forces.convention import Convention
from fatigue.readers.neutral.register.conversion import command_line
from fatigue.readers.neutral.register.register_file import register_text
from fatigue.readers.neutral.register.weld_register import REGISTER, RegisterRow, reasons
from fatigue.readers.units.systems import unit_system
from fatigue.stages import stage


@dataclass(frozen=True, slots=True)
class Conversion:
    """What a conversion found and wrote."""

    folder: Path
    audit: Audit
    welds: tuple[RegisterRow, ...]
    warnings: tuple[Problem, ...]
    modes: int
    unit_loads: tuple[UnitLoad, ...]
    force_rows: int
    read_outs: int
    nodes: int
    files: tuple[str, ...]

    @property
    def assessed(self) -> int:
        """Number of weld lines that are assessed."""
        return sum(row.status == "assess" for row in self.welds)


def convert(options: ConvertOptions) -> Conversion:
    """Conversion of foreign files into a folder: read, audited and written; a red check stops it before it writes.

    Raises
    ------
    DataError : any refusal of the readers, a red check not accepted, no weld to assess, foreign files in the way
    CaseError : an unknown unit system, an undecided sign convention
    """
    units = unit_system(options.force_units, "force units")
    history_units = unit_system(options.coordinate_units, "coordinate units")
    inputs = read_inputs(options)
    judged = audited(inputs, options)
    convention = options.convention or judged.convention
    if convention is None:
        raise CaseError(
            Problem("no_convention", str(options.forces), "the files do not prove the sign of the forces", "State it")
        )
    results, left_out = common_modes(inputs.results, inputs.histories, options.forces, inputs.interface_modes)
    stage("finding weld lines")
    metric = in_mm(inputs.model, units.length)
    found = with_forces_only(find_welds(metric, _weld_sources(options)), results)
    if not found.assessed():
        raise DataError(_nothing_to_assess(found, options.mesh))
    stage("turning forces into neutral ones, and writing")
    force = neutral_forces(results, inputs.model, units, options.normalisation)
    if judged.grounded_drilling:
        force = without_drilling(force, results, inputs.model)
    beside, judged = _at_stress_points(options, inputs, results, judged, convention)
    rows = rows_at_welds(found, results)
    force = to_mid_surface(force, results, metric, rows)
    loads = inputs.unit_loads
    basis = only_modes(results, results.of_basis)
    files: dict[str, pa.Table | str] = {
        "modes.csv": modes_table(basis, inputs.interface_modes, inputs.simulated),
        "nodes.parquet": nodes_table(metric),
        "elements.parquet": elements_table(metric),
        "element_forces.parquet": forces_table(basis, force[results.of_basis] if loads else force, rows),
        **weld_tables(found),
        REGISTER: register_text(found.rows),
        **(beside.files if beside else {}),
    }
    if loads:
        files[UNIT_LOADS] = loads_table(only_modes(results, ~results.of_basis), force[~results.of_basis], rows, loads)
    factor = coordinate_units(basis, history_units, options.normalisation)
    events = event_tables(inputs.histories, basis.mode, factor, loads)
    ignored = {int(mode) for history in inputs.histories for mode in history.mode} - set(results.mode.tolist())
    files |= {name: table for (_, name), table in events.items()}
    lacking = loads_not_given(loads, events)
    columns = WELD_COLUMNS if WELD_COLUMNS in files else None
    points = (beside.points, MODAL_STRESSES) if beside else None
    files[CASE] = case_text(
        options, convention, sorted(ignored), list(events), loads_text(loads, lacking), points, columns
    )
    kept, kept_case = {}, None
    if options.keep_case and (options.out / CASE).is_file():
        kept_case = options.out / CASE
        kept = {name: known for name, known in recorded_files(options.out).items() if name == CASE}
        del files[CASE]
    if not options.force:
        check_folder(options.out, [*files, RECORD], REGISTER)
    warnings = (
        *(*unknown_checks(judged, options), *results.warnings, *inputs.model.warnings),
        *(*found.warnings, *left_out, *inputs.warnings),
        *(*loads_at_welds(results, metric, found), *load_warnings(loads, lacking, kept_case)),
        *((*beside.warnings, *points_not_in_case(beside.points, kept_case)) if beside else ()),
    )
    sources = dict.fromkeys([*inputs.files(options), *(beside.sources if beside else ())])
    record = conversion_record(options, sources, convention, judged, warnings, found.rows, loads)
    write_folder(options.out, files, record, CASE, kept)
    return Conversion(
        folder=options.out,
        audit=judged,
        welds=found.rows,
        warnings=warnings,
        modes=basis.mode.size,
        unit_loads=loads,
        force_rows=rows.size * results.mode.size,
        read_outs=beside.read_outs if beside else 0,
        nodes=sum(cut.line.node.size for _, cut in found.assessed()),
        files=(*files, RECORD),
    )


def _at_stress_points(
    options: ConvertOptions, inputs: ForeignInputs, results: FeResults, judged: Audit, convention: Convention
) -> tuple[PointStresses | None, Audit]:
    """Stresses at the stress points, None without any; and the audit with the proof of their axes.

    Raises
    ------
    DataError : the proof is red and not accepted
    """
    units = unit_system(options.force_units, "force units")
    loads = {load.case.number: load.amount for load in inputs.unit_loads}
    amount = np.array([loads.get(mode, 1.0) for mode in results.mode.tolist()])
    factor = units.force / units.length**2 / coordinate_units(results, units, options.normalisation) / amount
    sign = 1.0 if convention == "on_element" else -1.0
    found = point_stresses(options, results, inputs.model, sign, factor, units.length, inputs.unit_loads)
    if found is None:
        return None, judged
    judged = replace(judged, rows=(*judged.rows, found.row))
    if found.row.light == "red" and found.row.check not in options.accept:
        where = f"{', '.join(map(str, found.sources[1:]))}, {found.row.check}"
        raise DataError(Problem("audit", where, found.row.finding, found.row.remedy))
    return found, judged


def _weld_sources(options: ConvertOptions) -> WeldSources:
    """Where weld lines come from; the register of an earlier conversion into the folder where none is given."""
    own = options.out / REGISTER
    return replace(options.welds, register=options.welds.register or (own if own.exists() else None))


def _nothing_to_assess(found: FoundWelds, mesh: Path) -> Problem:
    """Refusal where no weld line can be assessed: all kinds of reasons, with their numbers."""
    if not found.rows:
        return no_welds(mesh)
    kinds = "; ".join(f"{number} because {reason}" for number, reason in reasons(found.rows))
    what = f"none of the {len(found.rows)} weld lines can be assessed: {kinds}"
    how = f"`{command_line(['fatigue', 'welds', str(mesh), '-o', REGISTER])}` writes it, --register reads it"
    remedy = f"Remove the reasons, or set the status of some in the register ({how})"
    return Problem("no_welds", str(mesh), what, remedy)
