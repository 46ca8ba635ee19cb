"""A small body in the neutral format: two welds, three modes; each test spoils one thing in it."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from fatigue.errors import DataError, Problem
from fatigue.readers.neutral.body.lines import checked_lines, read_lines
from fatigue.readers.neutral.body.modes import Modes, read_modes
from fatigue.readers.neutral.body.welds import Weld, read_welds
from fatigue.weld.line import LineStack

Columns = dict[str, list]

MODES: Columns = {"mode": [7, 3, 12], "frequency_hz": [12.5, 8.0, 90.0], "kind": ["normal", "normal", "interface"]}
WELDS: Columns = {
    "weld": ["seam", "ring"],
    "closed": [False, True],
    "surface": ["top", "both"],
    "curve": [None, "master-steel"],
    "end_length_mm": [5.0, None],
    "description": ["a straight seam", None],
}
WELD_NODES: Columns = {
    "weld": ["seam"] * 3 + ["ring"] * 4,
    "order": [1, 2, 3, 1, 2, 3, 4],
    "node": [11, 12, 13, 21, 22, 23, 24],
    "x_mm": [0.0, 10.0, 20.0, 10.0, 0.0, -10.0, 0.0],
    "y_mm": [0.0, 0.0, 0.0, 0.0, 10.0, 0.0, -10.0],
    "z_mm": [0.0] * 3 + [5.0] * 4,
    "thickness_mm": [8.0] * 3 + [6.0] * 4,
    "normal_x": [0.0] * 7,
    "normal_y": [0.0] * 7,
    "normal_z": [1.0] * 7,
    "outward_x": [0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0],
    "outward_y": [1.0, 1.0, 1.0, 0.0, -1.0, 0.0, 1.0],
    "outward_z": [0.0] * 7,
}
COMPONENTS = ("fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm")


def nodal_forces() -> Columns:
    """Forces whose value tells its node, mode and component: 1000 node + 10 mode + component."""
    rows = [(w, n, m) for w, n in zip(WELD_NODES["weld"], WELD_NODES["node"], strict=True) for m in MODES["mode"]]
    columns: Columns = {"weld": [w for w, _, _ in rows], "node": [n for _, n, _ in rows], "mode": [m for *_, m in rows]}
    for i, name in enumerate(COMPONENTS):
        columns[name] = [1000.0 * node + 10.0 * mode + i for _, node, mode in rows]
    return columns


def history(samples: int = 5) -> Columns:
    """Modal coordinates whose value tells mode and sample: 100 mode + sample."""
    times = [2.0 + 0.01 * i for i in range(samples)]
    return {"time_s": times} | {f"q_{mode}": [100.0 * mode + i for i in range(samples)] for mode in MODES["mode"]}


def changed(columns: Columns, name: str, row: int, value: object) -> Columns:
    """Replace one value; rows count from 1."""
    values = list(columns[name])
    values[row - 1] = value
    return columns | {name: values}


def without(columns: Columns, name: str) -> Columns:
    """Leave one column out."""
    return {key: values for key, values in columns.items() if key != name}


def picked(columns: Columns, rows: list[int]) -> Columns:
    """Keep the given rows, counted from 1, in the given order."""
    return {key: [values[row - 1] for row in rows] for key, values in columns.items()}


def write(path: Path, columns: Mapping[str, list], types: Mapping[str, pa.DataType] | None = None) -> Path:
    """Write a table as its suffix says; a text in a column of numbers makes the whole column text in Parquet."""
    types = types or {}
    if path.suffix == ".csv":
        rows = [
            ",".join(columns),
            *(",".join(_cell(value) for value in row) for row in zip(*columns.values(), strict=True)),
        ]
        path.write_text("\n".join(rows) + "\n", encoding="utf-8")
        return path
    arrays = {}
    for name, values in columns.items():
        if any(isinstance(value, str) for value in values):
            values = [None if value is None else str(value) for value in values]  # noqa: PLW2901
        arrays[name] = pa.array(values, types.get(name))
    pq.write_table(pa.table(arrays), path)
    return path


def read_weld_nodes(path: Path, welds: Sequence[Weld], *, strict: bool) -> tuple[LineStack, list[Problem]]:
    """Read the lines of all welds, and check their geometry."""
    lines, warnings = read_lines(path, welds, {weld.name for weld in welds}, strict=strict)
    return lines, warnings + checked_lines(lines, path.name)


def small_body(folder: Path, ignore_modes=(), scale=None) -> tuple[Modes, LineStack]:
    """Write and read the small body."""
    columns = MODES if scale is None else MODES | {"scale": scale}
    modes, _ = read_modes(write(folder / "m.csv", columns), ignore_modes, strict=True)
    welds, _ = read_welds(write(folder / "w.csv", WELDS), {"master-steel"}, strict=True)
    lines, _ = read_weld_nodes(write(folder / "n.csv", WELD_NODES), welds, strict=True)
    return modes, lines


def _cell(value: object) -> str:
    return "" if value is None else str(value).lower() if isinstance(value, bool) else str(value)


def refusal_of(read: Callable[..., object], *arguments: object) -> str:
    """Message of the refusal."""
    with pytest.raises(DataError) as refusal:
        read(*arguments, strict=False)
    return str(refusal.value)
