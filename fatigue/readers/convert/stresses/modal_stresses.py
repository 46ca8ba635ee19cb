"""Modal stresses at stress points: from the stress tables of an FE run to the table of a case."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import get_args

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from fatigue.errors import CaseError, DataError, Problem, refuse
from fatigue.readers.convert.audit.row import AuditRow
from fatigue.readers.convert.loads.names import UnitLoad
from fatigue.readers.convert.options import ConvertOptions, Density
from fatigue.readers.convert.stresses.blocks import blocks_of_modes
from fatigue.readers.convert.stresses.evaluate import at_read_outs, available
from fatigue.readers.convert.stresses.points import read_stress_points
from fatigue.readers.convert.stresses.proof import stress_row
from fatigue.readers.convert.stresses.read_outs import ReadOut, doubts, place_read_outs
from fatigue.readers.convert.stresses.surface import plates_of
from fatigue.readers.convert.stresses.weights import Available, elements_needed, skewed, terms_of
from fatigue.readers.foreign.fe.model import FeModel, in_mm
from fatigue.readers.foreign.fe.results import FeResults
from fatigue.readers.foreign.fe.shell_stress import REQUEST, ShellStresses
from fatigue.readers.foreign.read import read_stresses
from fatigue.stages import stage

STRESS_POINTS, MODAL_STRESSES = "stress_points", "modal_stresses.parquet"
_MOST_PROVEN, _MOST_PROBLEMS = 500, 10


@dataclass(frozen=True, slots=True)
class PointStresses:
    """What a conversion makes of stress points.

    Attributes
    ----------
    row : of the audit
    points : name of the file of stress points in the folder
    files : tables to write, by name
    warnings : met on the way
    sources : files that were read
    read_outs : how many there are
    """

    row: AuditRow
    points: str
    files: Mapping[str, pa.Table | str]
    warnings: tuple[Problem, ...]
    sources: tuple[Path, ...]
    read_outs: int


def point_stresses(
    options: ConvertOptions,
    results: FeResults,
    model: FeModel,
    sign: float,
    factor: NDArray[np.float64],
    unit_length: float,
    loads: Sequence[UnitLoad],
) -> PointStresses | None:
    """Stresses at the stress points per unit of every mode and load of ``results``; None without stress points.

    Parameters
    ----------
    results, model : in the file's own units
    sign : turns the forces into those on the elements
    factor : (m,) MPa per unit modal coordinate or load of a stress of 1
    unit_length : of the model [mm]

    Raises
    ------
    CaseError : an unknown density of read-outs
    DataError : any refusal of the readers; read-outs outside plates; elements or modes without stresses
    """
    if options.stress_points is None:
        return None
    if options.read_outs not in get_args(Density):
        what = f"{options.read_outs!r} is none"
        raise CaseError(Problem("read_outs", "read_outs", what, f"Give one of {', '.join(get_args(Density))}"))
    stage("reading stresses at stress points")
    points, warnings = read_stress_points(options.stress_points)
    file = options.stress_points.name
    metric = in_mm(model, unit_length)
    plates = plates_of(metric.mesh)
    read_outs, problems = place_read_outs(plates, points, options.read_outs, file)
    refuse(DataError, problems[:_MOST_PROBLEMS])
    wanted = np.union1d(elements_needed(plates, read_outs), _some_with_forces(results))
    sources = options.stresses or (options.forces, *options.unit_loads)
    stresses = [read_stresses(path, wanted) for path in sources]
    by_mode = blocks_of_modes(results, stresses, options.subcase)
    given = available(by_mode[0])
    refuse(DataError, _silent(read_outs, metric, given, stresses))
    terms = terms_of(plates, read_outs, given)
    refuse(DataError, skewed(plates, terms, file))
    row = stress_row(results, model, by_mode, sign)
    stress = (
        np.stack([at_read_outs(terms, own, model, len(read_outs)) for own in by_mode]) * factor[:, None, None, None]
    )
    copied = f"{STRESS_POINTS}{'.parquet' if options.stress_points.suffix == '.parquet' else '.csv'}"
    files: dict[str, pa.Table | str] = {MODAL_STRESSES: _table(results, read_outs, stress, loads)}
    if options.stress_points.resolve() != (options.out / copied).resolve():
        files[copied] = _copy(options.stress_points)
    warnings += [*doubts(plates, read_outs, options.read_outs, file), *_from_centres(read_outs, metric, given, file)]
    return PointStresses(row, copied, files, tuple(warnings), (options.stress_points, *sources), len(read_outs))


def _some_with_forces(results: FeResults) -> NDArray[np.int64]:
    """Ids of some elements with forces, spread over all of them, whose stresses can be compared with these."""
    element = np.unique(results.element[results.of_element])
    return element[:: max(1, -(-element.size // _MOST_PROVEN))]


def _silent(
    read_outs: Sequence[ReadOut], model: FeModel, given: Available, stresses: Sequence[ShellStresses]
) -> list[Problem]:
    """Mistakes of elements that hold read-outs and have no stresses, or none of a plate."""
    found: dict[int, Problem] = {}
    unread = {element: why for one in stresses for element, why in one.unread.items()}
    for one in read_outs:
        element = int(model.mesh.element[one.held.element])
        if element in given.anywhere:
            continue
        where = ", ".join(dict.fromkeys(stress.source for stress in stresses))
        if element in unread:
            what, remedy = f"element {element} holds {one.called}: {unread[element]}", "Give homogeneous shells there"
            found.setdefault(element, Problem("layered_point", where, what, remedy))
        else:
            what = f"element {element} holds {one.called}, and has no stresses"
            found.setdefault(element, Problem("no_stress_of_element", where, what, REQUEST))
    return list(found.values())[:_MOST_PROBLEMS]


def _from_centres(read_outs: Sequence[ReadOut], model: FeModel, given: Available, file: str) -> list[Problem]:
    """Warning about read-outs that rest on stresses at the centres of elements."""
    bare = [one for one in read_outs if int(model.mesh.element[one.held.element]) not in given.corners]
    if not bare:
        return []
    what = f"{len(bare)} of {len(read_outs)} read-outs rest on stresses at centres of elements, with the slope between "
    what += f"them; the first is {bare[0].called}"
    remedy = "Request STRESS(CORNER), or mesh with quadrangles: CTRIA3 have none at corners"
    return [Problem("centre_stresses", file, what, remedy, len(bare))]


def _table(
    results: FeResults, read_outs: Sequence[ReadOut], stress: NDArray[np.float64], loads: Sequence[UnitLoad]
) -> pa.Table:
    """Table of stresses (m, r, 2, 3) [MPa], by mode or load, read-out and face; at edges the mean of both faces."""
    name = {load.case.number: load.name for load in loads}
    rows = [(k, surface) for k, one in enumerate(read_outs) for surface in one.surfaces]
    at = np.array([k for k, _ in rows])
    faces = {"top": stress[:, :, 0], "bottom": stress[:, :, 1], "edge": stress.mean(axis=2)}
    edge_only = np.array([[1.0, 0.0, 0.0] if surface == "edge" else [1.0] * 3 for _, surface in rows])
    values = np.stack([faces[surface][:, k] for k, surface in rows], axis=1) * edge_only + 0.0  # no negative zero
    modes = results.mode.tolist()
    some = [read_outs[k] for k in at.tolist()] * len(modes)
    columns = {
        "point": [one.point.name for one in some],
        "read_out": pa.array([one.number for one in some], pa.int64()),
        "distance_mm": [one.distance for one in some],
        "mode": pa.array([None if mode in name else mode for mode in modes for _ in rows], pa.int64()),
    }
    if loads:
        columns["unit_load"] = pa.array([name.get(mode) for mode in modes for _ in rows], pa.string())
    columns["surface"] = [surface for _, surface in rows] * len(modes)
    flat = values.reshape(-1, 3)
    return pa.table(columns | {f"{c}_MPa": np.ascontiguousarray(flat[:, k]) for k, c in enumerate(("sx", "sy", "txy"))})


def _copy(path: Path) -> pa.Table | str:
    """Content of the table of stress points."""
    return pq.read_table(path) if path.suffix == ".parquet" else path.read_text("utf-8-sig")
