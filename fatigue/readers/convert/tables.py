"""Tables of the neutral format, built from a foreign model, its forces and its weld lines."""

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from fatigue.readers.convert.weld_lines import FoundWelds
from fatigue.readers.foreign.fe.model import FeModel
from fatigue.readers.foreign.fe.results import FeResults
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory
from fatigue.readers.neutral.forces.convention import COMPONENTS
from fatigue.readers.neutral.register.weld_register import RegisterRow, description_of


def nodes_table(model: FeModel) -> pa.Table:
    """Nodes of a model in mm."""
    mesh = model.mesh
    return pa.table({"node": mesh.node, **{f"{a}_mm": mesh.xyz[:, k] for k, a in enumerate("xyz")}})


def elements_table(model: FeModel) -> pa.Table:
    """Shells with their corners n1 ... n4 and, where there are any, mid-side nodes n5 ... n8; 0 for none."""
    mesh = model.mesh
    around = np.concatenate([mesh.corner, mesh.mid], axis=1)
    ids = np.where(around >= 0, mesh.node[around], 0)
    columns = {f"n{k + 1}": ids[:, k] for k in range(8) if k < 4 or ids[:, 4:].any()}
    thickness = pa.array(np.where(mesh.thickness > 0, mesh.thickness, np.nan), from_pandas=True)
    return pa.table({"element": mesh.element, **columns, "pid": mesh.pid, "thickness_mm": thickness})


def forces_table(results: FeResults, force: NDArray[np.floating], rows: NDArray[np.int64]) -> pa.Table:
    """Put the forces (m, r, 6) of the chosen ``rows``, one line for each mode, element and node, in a table."""
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


def weld_tables(found: FoundWelds) -> dict[str, pa.Table]:
    """Build the tables welds, weld_nodes and weld_elements of the welds to assess."""
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
    }


def history_table(history: ForeignHistory, mode: NDArray[np.int64], factor: NDArray[np.float64]) -> pa.Table:
    """Coordinates of the modes, (m,), each times its ``factor``, (m,)."""
    row = {int(m): k for k, m in enumerate(history.mode)}
    return pa.table(
        {
            "time_s": history.time,
            **{
                f"q_{m}": (history.q[row[int(m)]] * f).astype(np.float32)
                for m, f in zip(mode, factor.tolist(), strict=True)
            },
        }
    )
