"""Tables of the neutral format, built from a foreign model, its forces, its modes and its weld lines."""

from collections.abc import Collection, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from fatigue.readers.convert.audit.shell_rows import elastic_modes
from fatigue.readers.convert.loads.names import UnitLoad
from fatigue.readers.convert.modal_basis import SimulationModes, mode_masses, mode_scale
from fatigue.readers.convert.weld_lines import FoundWelds, unconfirmed_elements
from fatigue.readers.foreign.fe.model import FeModel
from fatigue.readers.foreign.fe.results import FeResults
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory
from fatigue.readers.neutral.body.modes import LOWEST_HZ
from fatigue.readers.neutral.forces.convention import COMPONENTS
from fatigue.readers.neutral.register.weld_register import RegisterRow, description_of
from fatigue.weld.cuts import WeldCut
from fatigue.weld.mesh import ShellMesh
from fatigue.weld.solid.mesh import SolidMesh
from fatigue.weld.solid.skin import skin_of

WELD_COLUMNS = "weld_columns.csv"


def nodes_table(model: FeModel) -> pa.Table:
    """Table of the nodes of a model in mm."""
    mesh = model.mesh
    return pa.table({"node": mesh.node, **{f"{a}_mm": mesh.xyz[:, k] for k, a in enumerate("xyz")}})


def elements_table(model: FeModel) -> pa.Table:
    """Table of the shells, their corners n1 ... n4 and, where there are any, mid-side nodes n5 ... n8; 0 for none.

    Where the thickness of some is not that of a plate, ``unconfirmed`` says why, for strain gauges on them. Of solids
    the table has the skin, faces numbered from above the last element on.
    """
    mesh = model.mesh if model.solids is None else _with_skin(model.mesh, model.solids)
    around = np.concatenate([mesh.corner, mesh.mid], axis=1)
    ids = np.where(around >= 0, mesh.node[around], 0)
    columns = {f"n{k + 1}": ids[:, k] for k in range(8) if k < 4 or ids[:, 4:].any()}
    thickness = pa.array(np.where(mesh.thickness > 0, mesh.thickness, np.nan), from_pandas=True)
    columns |= {"pid": mesh.pid, "thickness_mm": thickness}
    if doubts := unconfirmed_elements(model):
        columns["unconfirmed"] = pa.array([doubts.get(element) for element in mesh.element.tolist()], pa.string())
    return pa.table({"element": mesh.element, **columns})


def _with_skin(shells: ShellMesh, solids: SolidMesh) -> ShellMesh:
    """Shells, and the skin of solids as surface elements without thickness."""
    skin = skin_of(solids).mesh
    above = int(max(shells.element.max(initial=0), solids.element.max()))
    names = ("corner", "mid", "pid", "thickness", "offset")
    both = {name: np.concatenate([getattr(shells, name), getattr(skin, name)]) for name in names}
    return replace(shells, element=np.concatenate([shells.element, above + skin.element]), **both)


def forces_table(results: FeResults, force: NDArray[np.floating], rows: NDArray[np.int64]) -> pa.Table:
    """Table of the forces (m, r, 6) of the chosen ``rows``, one line for each mode, element and node."""
    modes = results.mode.size
    flat = force[:, rows].reshape(-1, 6)
    return pa.table(
        {
            "mode": np.repeat(results.mode, rows.size),
            "node": np.tile(results.node[rows], modes),
            "element": np.tile(results.element[rows], modes),
            **{name: np.ascontiguousarray(flat[:, k]) for k, name in enumerate(COMPONENTS)},
        }
    )


def loads_table(
    results: FeResults, force: NDArray[np.floating], rows: NDArray[np.int64], loads: Sequence[UnitLoad]
) -> pa.Table:
    """Table of the forces per unit of every unit load, of the forces (u, r, 6) of their subcases, ``results``."""
    of_one = force / np.array([load.amount for load in loads])[:, None, None]
    table = forces_table(results, of_one.astype(force.dtype), rows)
    name = pa.array([load.name for load in loads])
    return table.set_column(0, "unit_load", name.take(pa.array(np.repeat(np.arange(len(loads)), rows.size))))


def weld_tables(found: FoundWelds) -> dict[str, pa.Table]:
    """Tables welds, weld_nodes and weld_elements of the welds to assess, and weld_columns of those of solids."""
    chosen = found.assessed()
    of_weld: dict[str, list[RegisterRow]] = {}
    for row in found.rows:
        if row.status == "assess":
            of_weld.setdefault(row.weld, []).append(row)
    lines = [cut.line for _, cut in chosen]
    sizes = [line.node.size for line in lines]
    vectors = {"normal": [line.normal for line in lines], "outward": [line.outward for line in lines]}
    return {
        "welds.csv": pa.table(
            {
                "weld": [row.weld for row, _ in chosen],
                "closed": [cut.line.closed for _, cut in chosen],
                "surface": [row.surface for row, _ in chosen],
                "curve": pa.array([row.curve or None for row, _ in chosen], pa.string()),
                "end_length_mm": pa.array([cut.line.end_length for _, cut in chosen], pa.float64()),
                "description": [description_of(of_weld[row.weld]) for row, _ in chosen],
            }
        ),
        "weld_nodes.csv": pa.table(
            {
                "weld": np.repeat([row.weld for row, _ in chosen], sizes).tolist(),
                "order": np.concatenate([line.order for line in lines]),
                "node": np.concatenate([line.node for line in lines]),
                **{f"{a}_mm": np.concatenate([line.xyz[:, k] for line in lines]) for k, a in enumerate("xyz")},
                "thickness_mm": np.concatenate([line.thickness for line in lines]),
                **{
                    f"{name}_{a}": np.concatenate([v[:, k] for v in values])
                    for name, values in vectors.items()
                    for k, a in enumerate("xyz")
                },
                "edge_mid": np.concatenate([line.edge_mid for line in lines]),
            }
        ),
        "weld_elements.csv": pa.table(
            {
                "weld": np.repeat([row.weld for row, _ in chosen], [cut.elements.size for _, cut in chosen]).tolist(),
                "element": np.concatenate([cut.elements for _, cut in chosen]),
            }
        ),
        **_columns_table([(row.weld, cut) for row, cut in chosen if cut.columns]),
    }


def _columns_table(of_solids: Sequence[tuple[str, WeldCut]]) -> dict[str, pa.Table]:
    """Table of the nodes through the thickness at every station of the welds of solids; no table without any."""
    rows = [
        (weld, int(order), node)
        for weld, cut in of_solids
        for order, column in zip(cut.line.order, cut.columns, strict=True)
        for node in column
    ]
    if not rows:
        return {}
    columns = zip(("weld", "order", "node"), zip(*rows, strict=True), strict=True)
    return {WELD_COLUMNS: pa.table({name: list(values) for name, values in columns})}


def modes_table(results: FeResults, interface_modes: Sequence[int], simulated: SimulationModes) -> pa.Table:
    """Table of the modes: frequencies of the FE run, masses of the simulation where it gives them, and the scale."""
    interface = np.isin(results.mode, np.array(interface_modes, np.int64))
    rigid = (results.frequency <= LOWEST_HZ) | ~elastic_modes(results)
    kind = np.where(interface | results.is_static, "interface", np.where(rigid, "rigid", "normal"))
    mass, of_simulation = mode_masses(results, simulated)
    return pa.table(
        {
            "mode": results.mode,
            "frequency_hz": np.nan_to_num(results.frequency),
            "modal_mass": np.where(np.isfinite(of_simulation), of_simulation, mass),
            "kind": kind.tolist(),
            "scale": mode_scale(results, simulated),
        }
    )


def event_tables(
    histories: Sequence[ForeignHistory],
    mode: NDArray[np.int64],
    factor: NDArray[np.float64],
    loads: Sequence[UnitLoad] = (),
) -> dict[tuple[str, str], pa.Table]:
    """Tables of the coordinates of all events, by the names of the event and of its file; and of loads they give."""
    tables: dict[tuple[str, str], pa.Table] = {}
    for history in histories:
        event = Path(history.source).stem
        file = _unused(f"q_{_slug(event)}.parquet", {name for _, name in tables})
        tables[event, file] = _history_table(history, mode, factor, loads)
    return tables


def _history_table(
    history: ForeignHistory, mode: NDArray[np.int64], factor: NDArray[np.float64], loads: Sequence[UnitLoad]
) -> pa.Table:
    """Table of the coordinates of the modes, (m,), each times its ``factor``, (m,), and of the loads it gives."""
    row = {int(m): k for k, m in enumerate(history.mode)}
    return pa.table(
        {
            "time_s": history.time,
            **{
                f"q_{m}": (history.q[row[int(m)]] * f).astype(np.float32)
                for m, f in zip(mode, factor.tolist(), strict=True)
            },
            **{load.column: history.q[row[load.case.number]] for load in loads if load.case.number in row},
        }
    )


def _slug(name: str) -> str:
    return "".join(c if c.isalnum() or c in "-_." else "_" for c in name).lower() or "event"


def _unused(name: str, files: Collection[str]) -> str:
    """The name, with a number if two events have the same."""
    stem, number = name.removesuffix(".parquet"), 2
    while name in files:
        name, number = f"{stem}_{number}.parquet", number + 1
    return name
