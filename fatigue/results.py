"""The result folder: its data dictionary, its Parquet tables and where every number comes from."""

import hashlib
import json
import platform
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from fatigue import __version__
from fatigue.errors import DataError, Problem

ColumnType = Literal["text", "int", "flag", "float"]

_ARROW_TYPE: dict[ColumnType, pa.DataType] = {
    "text": pa.string(),
    "int": pa.int64(),
    "flag": pa.bool_(),
    "float": pa.float64(),
}
_ROWS_PER_GROUP = 65_536


@dataclass(frozen=True, slots=True)
class Column:
    """One column of a result table: name, type, unit and meaning, written into the file beside the numbers."""

    name: str
    type: ColumnType
    unit: str
    meaning: str


_POINT = (
    Column("weld", "text", "-", "weld line"),
    Column("part", "int", "-", "straight part of a weld split at its kinks, from 1"),
    Column("node", "int", "-", "FE node id"),
    Column("order", "int", "-", "position along the weld line, as given"),
    Column("surface", "text", "-", "top (side of the plate normal) or bottom face of the assessed plate"),
)

NODES = (
    *_POINT,
    Column("toe", "flag", "-", "the face carries a weld toe; a face without one never governs"),
    Column("arc_length_mm", "float", "mm", "distance along the part from its first node"),
    Column("x_mm", "float", "mm", "position"),
    Column("y_mm", "float", "mm", "position"),
    Column("z_mm", "float", "mm", "position"),
    Column("thickness_mm", "float", "mm", "thickness of the assessed plate"),
    Column("damage_per_km", "float", "1/km", "Miner sum per km of the mission, rainflow, bending ratio of each cycle"),
    Column("life_km", "float", "km", "damage limit / damage_per_km; infinite where nothing damages"),
    Column("life_years", "float", "a", "life_km / km_per_year of the mission"),
    Column("utilisation", "float", "-", "Miner sum at target_km / damage limit"),
    Column("fulfilled", "flag", "-", "utilisation <= 1"),
    Column("load_factor", "float", "-", "scale on all stresses that just meets the target"),
    Column(
        "life_km_dirlik",
        "float",
        "km",
        "life by Dirlik's formula with one bending ratio per event, events with a spectrum",
    ),
    Column("life_km_tb", "float", "km", "life by Tovo-Benasciutti 2005 with one bending ratio per event, same events"),
    Column("life_km_same_ratio", "float", "km", "rainflow life with the same one bending ratio per event, same events"),
    Column("dirlik_ratio", "float", "-", "D_dirlik / D_rainflow at the same bending ratio"),
    Column(
        "dirlik_verdict",
        "text",
        "-",
        "may the frequency domain be trusted here: not_assessed, valid, or the first reason why not (sampling, "
        "quasi_static, single_event, non_stationary, harmonic, non_gaussian, bandwidth), of the event with the largest "
        "share of the damage",
    ),
    Column("max_range_MPa", "float", "MPa", "largest structural stress range of all events"),
    Column(
        "equivalent_range_2e6_MPa",
        "float",
        "MPa",
        "structural stress range that does the same in 2e6 cycles over target_km",
    ),
    Column("mean_stress_MPa", "float", "MPa", "time mean of the structural stress in the governing event"),
    Column("R_largest_cycle", "float", "-", "minimum / maximum structural stress of the largest cycle of all events"),
    Column(
        "damage_factor_if_mean_stress",
        "float",
        "-",
        "damage with the ASME mean-stress factor / without; 1 where it is on",
    ),
    Column("shear_ratio", "float", "-", "rms shear stress / rms structural stress in the governing event"),
    Column("damage_factor_if_shear", "float", "-", "damage with shear combined as in ASME VIII-2 5.5.5.3 / without"),
    Column("governing_event", "text", "-", "event with the largest share of the damage"),
    Column("bending_ratio", "float", "-", "std(sigma_b) / (std(sigma_m) + std(sigma_b)) in the governing event"),
    Column("life_km_raw_end", "float", "km", "life without the end treatment"),
    Column("at_end", "flag", "-", "inside the treated zone of a weld end, or the end node itself"),
    Column("at_corner", "flag", "-", "at a kink of the weld line above 30 degrees"),
    Column(
        "screened", "text", "-", "empty: counted exactly; else the tier of the proven bound that stands for counting"
    ),
)

DAMAGE = (
    *_POINT,
    Column("event", "text", "-", "event of the mission"),
    Column("damage_per_km", "float", "1/km", "Miner sum per km of this event; empty for an event counted by number"),
    Column("damage_per_pass", "float", "-", "Miner sum of one pass of the simulated record"),
    Column("damage_dirlik_per_km", "float", "1/km", "Dirlik's estimate with the one bending ratio"),
    Column("damage_tb_per_km", "float", "1/km", "Tovo-Benasciutti 2005 with the one bending ratio"),
    Column("damage_same_ratio_per_km", "float", "1/km", "rainflow with the one bending ratio"),
    Column("damage_dirlik_per_pass", "float", "-", "Dirlik's estimate of one pass; empty without a spectrum"),
    Column("damage_tb_per_pass", "float", "-", "Tovo-Benasciutti 2005 of one pass; empty without a spectrum"),
    Column("damage_same_ratio_per_pass", "float", "-", "rainflow with the one bending ratio of one pass"),
    Column("cycles_per_km", "float", "1/km", "counted cycles per km"),
    Column("cycles_per_pass", "float", "-", "counted cycles of one pass"),
    Column("max_range_MPa", "float", "MPa", "largest structural stress range"),
    Column(
        "max_equivalent_range_dS",
        "float",
        "MPa mm^-0.222",
        "largest equivalent range (MPa on curves in structural stress)",
    ),
    Column("bending_ratio", "float", "-", "std(sigma_b) / (std(sigma_m) + std(sigma_b)) over the kept samples"),
    Column("mean_stress_MPa", "float", "MPa", "time mean of the structural stress"),
    Column("kurtosis", "float", "-", "Pearson kurtosis of the structural stress, 3 for a Gaussian record"),
    Column("irregularity", "float", "-", "alpha_2 = zero up-crossings / peaks, from the spectral moments"),
    Column("peaks_per_s", "float", "1/s", "nu_p = sqrt(m4 / m2)"),
    Column("samples_per_peak", "float", "-", "sampling rate of the counted record / nu_p"),
    Column(
        "verdict",
        "text",
        "-",
        "may the frequency domain be trusted in this event: see dirlik_verdict of the nodes table",
    ),
)

CYCLES = (
    *_POINT,
    Column("event", "text", "-", "event of the mission"),
    Column("start_s", "float", "s", "file time of the first reversal"),
    Column("end_s", "float", "s", "file time of the second reversal; before start_s: the cycle wraps past the end"),
    Column("range_MPa", "float", "MPa", "structural stress range"),
    Column("mean_MPa", "float", "MPa", "mean of the two reversals"),
    Column("count", "float", "-", "1: cycle, 0.5: half cycle"),
    Column("membrane_range_MPa", "float", "MPa", "membrane stress range between the same two instants"),
    Column("bending_range_MPa", "float", "MPa", "bending stress range between the same two instants"),
    Column("bending_ratio", "float", "-", "bending / (membrane + bending) range"),
    Column("equivalent_range_dS", "float", "MPa mm^-0.222", "equivalent range (MPa on curves in structural stress)"),
    Column("damage", "float", "-", "count / cycles to failure at this range"),
)

_COMPONENTS = (
    ("membrane_MPa", "membrane stress"),
    ("bending_MPa", "bending stress of the top face"),
    ("in_plane_shear_MPa", "in-plane shear stress, mean"),
    ("twist_shear_MPa", "in-plane shear stress of the top face from the twisting moment"),
    ("transverse_shear_MPa", "transverse shear stress, mean"),
)

STRUCTURAL_STRESS = (
    Column("weld", "text", "-", "weld line"),
    Column("part", "int", "-", "straight part of a weld split at its kinks, from 1"),
    Column("order", "int", "-", "position along the weld line, as given"),
    Column("node", "int", "-", "FE node id"),
    Column("mode", "int", "-", "mode id"),
    *(
        Column(name, "float", "MPa", f"{meaning}, per unit modal coordinate, ends treated")
        for name, meaning in _COMPONENTS
    ),
    *(
        Column(name.replace("_MPa", "_raw_MPa"), "float", "MPa", f"{meaning}, per unit modal coordinate, as solved")
        for name, meaning in _COMPONENTS
    ),
)

WELDS = (
    Column("weld", "text", "-", "weld line"),
    Column("status", "text", "-", "assessed, or excluded"),
    Column("reason", "text", "-", "why a weld is excluded"),
    Column("description", "text", "-", "as given"),
    Column("closed", "flag", "-", "the line closes on itself"),
    Column("parts", "int", "-", "straight parts after splitting at kinks"),
    Column("nodes", "int", "-", "nodes on the line"),
    Column("length_mm", "float", "mm", "length of the line"),
    Column("thickness_min_mm", "float", "mm", "smallest plate thickness"),
    Column("thickness_max_mm", "float", "mm", "largest plate thickness"),
    Column("surface", "text", "-", "faces that carry a weld toe"),
    Column("curve", "text", "-", "S-N curve"),
    Column("survival", "text", "-", "survival level of the curve"),
    Column("end_length_mm", "float", "mm", "length of the end treatment; empty: plate thickness"),
    Column("life_km", "float", "km", "shortest life of the weld's toe points"),
    Column("life_years", "float", "a", "the same in years"),
    Column("utilisation", "float", "-", "largest utilisation of the weld's toe points"),
    Column("fulfilled", "flag", "-", "every toe point meets the target"),
    Column("load_factor", "float", "-", "load factor of the worst point"),
    Column("worst_part", "int", "-", "worst point: part"),
    Column("worst_order", "int", "-", "worst point: position"),
    Column("worst_node", "int", "-", "worst point: FE node"),
    Column("worst_surface", "text", "-", "worst point: face"),
    Column("worst_arc_length_mm", "float", "mm", "worst point: distance along the part"),
    Column("governing_event", "text", "-", "event with the largest share of the worst point's damage"),
)

TABLES: dict[str, tuple[Column, ...]] = {
    "nodes": NODES,
    "damage": DAMAGE,
    "cycles": CYCLES,
    "structural_stress": STRUCTURAL_STRESS,
    "welds": WELDS,
}


def schema(table: str) -> pa.Schema:
    """Arrow schema of a result table with unit and meaning of every column in its field metadata."""
    return pa.schema(
        [
            pa.field(c.name, _ARROW_TYPE[c.type], metadata={"unit": c.unit, "description": c.meaning})
            for c in TABLES[table]
        ],
        metadata={"program": "fatigue", "table": table},
    )


class TableWriter:
    """Writes one result table in row groups of a fixed size, whatever the size of the pieces it is given."""

    def __init__(self, table: str, writer: pq.ParquetWriter) -> None:
        self._table = table
        self._schema = schema(table)
        self._writer = writer
        self._waiting: list[pa.Table] = []
        self._rows = 0

    def write(self, columns: Mapping[str, Any]) -> None:
        """Append rows; every column of the table must be there, NaN in a float column meaning "not available"."""
        arrays = [pa.array(columns[f.name], type=f.type, from_pandas=True) for f in self._schema]
        self._waiting.append(pa.Table.from_arrays(arrays, schema=self._schema))
        self._rows += len(arrays[0])
        if self._rows >= _ROWS_PER_GROUP:
            self.flush()

    def flush(self) -> None:
        """Write what is waiting."""
        if self._waiting:
            self._writer.write_table(pa.concat_tables(self._waiting), row_group_size=_ROWS_PER_GROUP)
            self._waiting, self._rows = [], 0


@contextmanager
def table_writer(folder: Path, table: str) -> Iterator[TableWriter]:
    """Open ``<table>.parquet`` in a folder for writing, piece by piece."""
    with pq.ParquetWriter(folder / f"{table}.parquet", schema(table), compression="zstd") as writer:
        pieces = TableWriter(table, writer)
        yield pieces
        pieces.flush()


@contextmanager
def result_tables(folder: Path) -> Iterator[dict[str, TableWriter]]:
    """Open all result tables of a folder for writing, by name."""
    folder.mkdir(parents=True, exist_ok=True)
    with ExitStack() as stack:
        yield {table: stack.enter_context(table_writer(folder, table)) for table in TABLES}


def read_table(folder: Path, table: str, columns: Sequence[str] | None = None) -> pa.Table:
    """Read a result table.

    Raises
    ------
    DataError : the folder holds no such table, or the file is damaged
    """
    path = folder / f"{table}.parquet"
    try:
        return pq.read_table(path, columns=None if columns is None else list(columns))
    except FileNotFoundError:
        problem = Problem(
            "no_result", str(path), "no such result table", "Run `fatigue assess CASE -o DIR` first and give its DIR"
        )
    except (pa.ArrowInvalid, OSError) as error:
        detail = str(error).splitlines()[0] if str(error) else type(error).__name__
        problem = Problem(
            "damaged_result", str(path), f"the table cannot be read ({detail})", "Run the assessment again"
        )
    raise DataError(problem)


def read_provenance(folder: Path) -> dict[str, Any]:
    """Read ``provenance.json`` of a result folder.

    Raises
    ------
    DataError : the folder holds no finished result
    """
    path = folder / "provenance.json"
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        problem = Problem(
            "no_result",
            str(folder),
            "no finished result in this folder",
            "Run `fatigue assess CASE -o DIR` first and give its DIR",
        )
        raise DataError(problem) from None
    except (json.JSONDecodeError, UnicodeDecodeError, OSError) as error:
        problem = Problem("damaged_result", str(path), f"cannot be read ({error})", "Run the assessment again")
        raise DataError(problem) from None
    if not isinstance(record, dict) or record.get("program") != "fatigue":
        raise DataError(
            Problem("no_result", str(path), "was not written by fatigue", "Give a folder that `fatigue assess` wrote")
        )
    return record


def input_register(paths: Sequence[Path], root: Path) -> list[dict[str, Any]]:
    """Name, size and SHA-256 of every input file, so that a result can be traced to its inputs."""
    return [{"file": _relative(path, root), "bytes": path.stat().st_size, "sha256": sha256(path)} for path in paths]


def sha256(path: Path) -> str:
    """SHA-256 of a file's content."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def software_versions() -> dict[str, str]:
    """Versions of the program and of what its numbers rest on."""
    packages = ("numpy", "scipy", "numba", "pyarrow", "pandas", "rainflow")
    found = {"fatigue": __version__, "python": platform.python_version()}
    for package in packages:
        try:
            found[package] = version(package)
        except PackageNotFoundError:  # an optional peer that is not installed has no say in the numbers
            continue
    return found


def write_json(path: Path, record: Mapping[str, Any]) -> None:
    """Write a record as UTF-8 JSON; infinite and missing numbers become null."""
    text = json.dumps(json_ready(record), indent=2, ensure_ascii=False, allow_nan=False)
    path.write_text(text + "\n", encoding="utf-8")


def json_ready(value: Any) -> Any:
    """Turn numpy scalars, arrays and non-finite numbers into what JSON can say (null for infinite life)."""
    if isinstance(value, Mapping):
        return {str(k): json_ready(v) for k, v in value.items()}
    if isinstance(value, np.ndarray | list | tuple):
        return [json_ready(v) for v in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not np.isfinite(value):
        return None
    return value


def _relative(path: Path, root: Path) -> str:
    try:
        return path.resolve().relative_to(root.resolve()).as_posix()
    except ValueError:  # an input elsewhere on the disk keeps its full path
        return path.as_posix()
