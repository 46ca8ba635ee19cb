"""Sound files of every format, and what is read from them, as plain columns."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from fatigue.case import load_case
from fatigue.errors import DataError, Problem
from fatigue.readers.convert.folder import read_record
from fatigue.readers.convert.modal_basis import common_modes
from fatigue.readers.foreign.fe.model import FeModel
from fatigue.readers.foreign.fe.results import FeResults
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory
from fatigue.readers.foreign.histories.matching import matched
from fatigue.readers.foreign.histories.time_grid import uniform
from fatigue.readers.foreign.read import read_coordinates, read_forces, read_model
from fatigue.readers.neutral.body.mesh import read_mesh
from fatigue.readers.neutral.body.modes import Modes, read_modes
from fatigue.readers.neutral.body.welds import read_welds
from fatigue.readers.neutral.forces.element_forces import read_element_forces, read_weld_elements
from fatigue.readers.neutral.forces.nodal_forces import open_nodal_forces, read_nodal_forces
from fatigue.readers.neutral.history import read_history
from fatigue.readers.neutral.register.register_file import open_register
from fatigue.readers.neutral.tables import open_table
from fatigue.results import read_provenance, read_table
from fatigue.results.json_records import write_json
from fatigue.results.tables import schema
from tests.fuzz import damage
from tests.fuzz.exported import ABAQUS_DECK, ANSYS_ARCHIVE, abaqus_text, ansys_text
from tests.fuzz.recordings import recordings
from tests.readers import neutral_tables as neutral
from tests.readers.foreign.histories.test_mcf import MCF
from tests.readers.op2_writer import modal_op2
from tests.solid_meshes import deck, tee

Columns = dict[str, Any]
Reader = Callable[[Path], tuple[Columns, tuple[Problem, ...]]]
NASTRAN = Path("data/nastran")


@dataclass(frozen=True)
class Source:
    """One sound file, with others that it needs beside it, and how it is read.

    ``structure`` says that the format itself tells how much it holds, so that nothing can be lost unnoticed.
    """

    name: str
    file: str
    files: Mapping[str, bytes]
    read: Reader
    kinds: tuple[damage.Damage, ...]
    structure: bool = False


def _results(path: Path) -> tuple[Columns, tuple[Problem, ...]]:
    found = read_forces(path, None)
    names = ("mode", "node", "element", "kind", "force", "shape_node", "shape")
    optional = {"?frequency": found.frequency, "?modal_mass": found.modal_mass}
    told = {  # by the audit: an unproven sign, a red light
        "no_shapes": not found.shape_node.size,
        "no_frequency": not np.isfinite(found.frequency).all(),
    }
    without = tuple(Problem(code, "", "the audit says so", "") for code, bad in told.items() if bad)
    columns = {name: getattr(found, name) for name in names}
    rows = found.of_element  # loads and totals may differ between modes, and count nowhere
    columns |= {name: columns[name][rows] for name in ("node", "element", "kind")} | {"force": found.force[:, rows]}
    return columns | optional, (*found.warnings, *without)


def _model(path: Path) -> tuple[Columns, tuple[Problem, ...]]:
    found: FeModel = read_model(path)
    mesh = found.mesh
    if "deck" in path.stem and not (5 in found.node_sets and "PLOTEL" in found.marker_edges):
        raise DataError(Problem("no_set", str(path), "the set or marker that is asked for is not there", "Correct it"))
    columns: Columns = {
        name: getattr(mesh, name) for name in ("node", "xyz", "element", "corner", "mid", "pid", "offset")
    }
    columns |= {"?thickness": mesh.thickness, "frame_node": found.frame_node, "frame": found.frame}
    columns |= {f"set {k}": np.array([str(v)]) for k, v in found.node_sets.items()} | {
        f"of {k}": v for k, v in found.marker_edges.items()
    }
    doubts = [f"{k} {v}" for k, v in (found.unconfirmed_sections | found.unconfirmed_elements).items()]
    return columns, (*found.warnings, *(Problem("doubt", "", doubt, "") for doubt in doubts))


def _coordinates(path: Path) -> tuple[Columns, tuple[Problem, ...]]:
    run = small_run()
    found: ForeignHistory = read_coordinates(path, None, None)
    found = uniform(matched(found, run.mode, run.frequency, "id"), None)
    common_modes(run, [found], path, ())
    columns = {"mode": found.mode, "?frequency": found.frequency, "time": found.time, "q": found.q}
    return columns | {"name": np.array(found.name)}, found.warnings


def _history(path: Path) -> tuple[Columns, tuple[Problem, ...]]:
    found, warnings = read_history(path, "event", np.array(sorted(neutral.MODES["mode"])), (), strict=False)
    return {"q": found.q, "step": np.array([found.step]), "start": np.array([found.start])}, tuple(warnings)


def _modes(path: Path) -> tuple[Columns, tuple[Problem, ...]]:
    found, warnings = read_modes(path, (), strict=False)
    names = ("mode", "frequency", "modal_mass", "scale")
    columns = {name: getattr(found, name) for name in names} | {"kind": np.array(found.kind)}
    return columns | {"?damping": found.damping_ratio}, tuple(warnings)


def _welds(path: Path) -> tuple[Columns, tuple[Problem, ...]]:
    found, warnings = read_welds(path, {"master-steel"}, strict=False)
    columns = {
        name: np.array([str(getattr(w, name)) for w in found]) for name in ("name", "closed", "surface", "curve")
    }
    return columns | {"end": np.array([str(w.end_length) for w in found])}, tuple(warnings)


@cache
def _neutral_welds(folder: Path) -> Any:
    return read_welds(neutral.write(folder / "welds.csv", neutral.WELDS), {"master-steel"}, strict=False)[0]


def _weld_nodes(path: Path) -> tuple[Columns, tuple[Problem, ...]]:
    found, warnings = neutral.read_weld_nodes(path, _neutral_welds(path.parent), strict=False)
    names = ("order", "node", "xyz", "thickness", "normal", "outward", "edge_mid")
    return {name: getattr(found, name) for name in names}, tuple(warnings)


def _nodal_forces(path: Path) -> tuple[Columns, tuple[Problem, ...]]:
    nodes = neutral.write(path.parent / "weld_nodes.csv", neutral.WELD_NODES)
    lines, _ = neutral.read_weld_nodes(nodes, _neutral_welds(path.parent), strict=False)
    mode = np.array(sorted(neutral.MODES["mode"]))
    ones = np.ones(mode.size)
    modes = Modes(mode, ones, ones, ones, ("normal",) * mode.size, ones)
    force, warnings = read_nodal_forces(open_nodal_forces(path), lines, modes, "on_element", (), strict=False)
    return {"force": force}, tuple(warnings)


def _element_forces(path: Path) -> tuple[Columns, tuple[Problem, ...]]:
    mode = np.array([1, 2])
    ones = np.ones(2)
    modes = Modes(mode, ones, ones, ones, ("normal",) * 2, ones)
    found, warnings = read_element_forces(path, modes, "on_element", (), strict=False)
    order = np.lexsort((found.node, found.element, found.mode))
    return {name: getattr(found, name)[order] for name in ("mode", "node", "element", "force")}, tuple(warnings)


def _weld_elements(path: Path) -> tuple[Columns, tuple[Problem, ...]]:
    found, warnings = read_weld_elements(path, _neutral_welds(path.parent), strict=False)
    return {f"of {name}": elements for name, elements in found.items()}, tuple(warnings)


def _mesh(path: Path) -> tuple[Columns, tuple[Problem, ...]]:
    nodes = neutral.write(path.parent / "mesh_nodes.csv", _MESH_NODES)
    found, warnings = read_mesh(nodes, path, strict=False)
    return {"element": found.element, "corners": found.corners, "?thickness": found.thickness}, tuple(warnings)


def _nodes(path: Path) -> tuple[Columns, tuple[Problem, ...]]:
    found, warnings = read_mesh(path, None, strict=False)
    return {"node": found.node, "xyz": found.xyz}, tuple(warnings)


def _register(path: Path) -> tuple[Columns, tuple[Problem, ...]]:
    register = open_register(path, strict=False)
    rows = register.rows
    names = ("weld", "line", "status", "reason", "thickness", "confirmed", "surface", "curve", "end_length", "nodes")
    return {name: np.array([str(getattr(row, name)) for row in rows]) for name in names}, register.warnings


def _mapping(path: Path) -> tuple[Columns, tuple[Problem, ...]]:
    table = open_table(path, texts=("column",))
    table.expect(("column", "mode"), (), strict=False)
    names, mode = table.texts("column"), table.integers("mode")
    table.refuse()
    return {"column": np.array(names), "mode": mode}, tuple(table.warnings)


def _case(path: Path) -> tuple[Columns, tuple[Problem, ...]]:
    case = load_case(path)
    return {"case": np.array([case.model_dump_json()]), "files": np.array(list(case.input_files()))}, ()


def _provenance(path: Path) -> tuple[Columns, tuple[Problem, ...]]:
    return {"keys": np.array(sorted(read_provenance(path.parent)))}, ()


def _record(path: Path) -> tuple[Columns, tuple[Problem, ...]]:
    return {"keys": np.array(sorted(read_record(path)))}, ()


def _result_table(path: Path) -> tuple[Columns, tuple[Problem, ...]]:
    table = read_table(path.parent, path.stem)
    numbers = {n: table.column(n).to_numpy() for n in ("node", "x_mm", "damage_per_km")}
    return numbers | {"weld": np.array(table.column("weld").to_pylist())}, ()


_MESH_NODES = {"node": [1, 2, 3, 4, 5, 6], **{f"{a}_mm": [0.0, 1.0, 1.0, 0.0, 2.0, 2.0] for a in "xyz"}}
_ELEMENTS = {"element": [7, 8], "n1": [1, 2], "n2": [2, 5], "n3": [3, 6], "n4": [4, None], "pid": [1, 1]}
_REGISTER = (
    "weld,line,status,reason,kind,pids,pid,nodes,length_mm,thickness_mm,confirmed,surface,curve,end_length_mm,description\n"
    'roof,T-1,assess,,T,1 2,1,5,40,8,false,both,,,"a seam, long"\n'
    "wall,T-2,excluded,not welded,T,1 3,1,4,30,,false,top,master-steel,5,\n"
    "door,L-3,candidate,a fold,fold,2,2,9,80,6,true,both,,0,\n"
)
_CASE = """title = "Trailer, Träger"
[body]
modes = "modes.csv"
welds = "welds.csv"
weld_nodes = "weld_nodes.csv"
nodal_forces = 'sub/nodal_forces.parquet'
force_convention = "on_element"
ignore_modes = [1, 2]
[curve]
name = "mine"
[curves.mine]
slopes = [3.0, 5.0]
knees_cycles = [1e7]
range_at_2e6_MPa = 40.0
applies = "structural"
source = "a book"
[counting]
residue = "repeat"
upsample = "auto"
[mission]
target_km = 1.2e7
km_per_year = 5e5
[[mission.event]]
name = "tangent"
history = "q.parquet"
speed_km_h = 350.0
share = 0.75
[[mission.event]]
name = "curve"
history = "q2.parquet"
length_km = 3
share = 0.25
"""
_DECK = """SOL 103
CEND
SET 5 = 1 THRU 4
GPFORCE(PLOT) = 5
BEGIN BULK
INCLUDE 'grids.inc'
CORD2R,3,0,0.,0.,0.,0.,0.,1.
,1.,0.,0.
CQUAD4  7       1       1       2       3       4
CTRIA3  8       1       2       5       3
PSHELL  1       1       8.0     1               1
MAT1    1       70000.          .33     2.7-9
PLOTEL  9       2       3
ENDDATA
"""
_GRIDS = """GRID    1               0.      0.      0.
GRID    2               10.     0.      0.              3
GRID,3,,10.,10.,0.
GRID*                  4                              0.             10.
*                     0.
GRID    5               20.     5.      1.5+0
"""


@cache
def small_run() -> FeResults:
    """Three modes of two elements with a total for each grid."""
    rng = np.random.default_rng(1)
    node = np.array([1, 2, 3, 4, 2, 5, 3, 1, 2, 3, 4, 5])
    element = np.array([7, 7, 7, 7, 8, 8, 8, 0, 0, 0, 0, 0])
    kind = np.array(["QUAD4"] * 4 + ["TRIA3"] * 3 + ["*TOTALS*"] * 5)
    grids = np.arange(1, 6)
    return FeResults(
        source="small",
        solver="",
        analysis="modal",
        mode=np.array([1, 2, 3]),
        frequency=np.array([10.0, 20.0, 30.0]),
        modal_mass=np.ones(3),
        node=node,
        element=element,
        kind=kind,
        force=rng.normal(size=(3, node.size, 6)).astype(np.float32),
        shape_node=grids,
        shape=rng.normal(size=(3, grids.size, 6)).astype(np.float32),
    )


def punch(run: FeResults) -> bytes:
    """Punch file of a run."""
    lines = []
    for k, mode in enumerate(run.mode):
        omega = 2 * np.pi * run.frequency[k]
        lines += ["$TITLE   = SMALL", "$SUBTITLE=", "$LABEL   =", "$GRID POINT FORCE BALANCE", "$REAL OUTPUT"]
        lines += ["$SUBCASE ID =           1", f"$EIGENVALUE = {omega**2:14.7E}  MODE = {mode:5d}"]
        for row in range(run.node.size):
            element = str(run.element[row]) if run.element[row] else ""
            lines.append(f"{run.node[row]:10d}        {element:>10}        {run.kind[row]:<8}")
            for part in (run.force[k, row, :3], run.force[k, row, 3:]):
                lines.append("-CONT-            " + "".join(f"{value:18.6E}" for value in part))
    return ("\n".join(line.ljust(72) for line in lines) + "\n").encode()


def _text(columns: Mapping[str, list[Any]], separator: str = ",", decimal: str = ".", head: str = "") -> bytes:
    rows = [separator.join(columns)]
    rows += [separator.join(str(v).replace(".", decimal) for v in row) for row in zip(*columns.values(), strict=True)]
    return (head + "\n".join(rows) + "\n").encode()


def _table(folder: Path, name: str, columns: Mapping[str, list[Any]], suffix: str) -> bytes:
    return neutral.write(folder / f"sound_{name}{suffix}", columns).read_bytes()


def sources(folder: Path) -> list[Source]:
    """All sound files; ``folder`` is for those that a library writes."""
    found: list[Source] = []

    def add(name: str, file: str, data: bytes, read: Reader, **more: Any) -> None:
        binary = more.pop("binary", False)
        kinds = damage.BINARY if binary else damage.TEXT
        found.append(Source(name, file, {file: data, **more.pop("beside", {})}, read, kinds, **more))

    for word, order in ((4, "<"), (8, "<"), (4, ">")):
        data = modal_op2(small_run(), word, order)
        add(f"op2 {8 * word} bit {order}", "run.op2", data, _results, binary=True, structure=True)
    for name in ("modes_elements.op2", "modes_elements.h5"):
        add(name, name, (NASTRAN / name).read_bytes(), _results, binary=True, structure=True)
    h5 = (NASTRAN / "modes_elements.h5").read_bytes()
    add("mesh of modes_elements.h5", "m.h5", h5, _model, binary=True, structure=True)
    add("punch", "run.pch", punch(small_run()), _results)
    add("deck", "deck.bdf", _DECK.encode(), _model, beside={"grids.inc": _GRIDS.encode()})
    include = {name: (NASTRAN / name).read_bytes() for name in ("geom.inc",)}
    add("deck of solids", "solids.bdf", deck(tee(wedge=4.0), parabolic=True).encode(), _model)
    add("modes_elements.bdf", "m.bdf", (NASTRAN / "modes_elements.bdf").read_bytes(), _model, beside=include)
    add("geom.inc", "geom.inc", include["geom.inc"], _model)
    add("mcf", "q.mcf", MCF.replace("2              7", "2              3").encode(), _coordinates)
    q = {"time": [0.01 * k for k in range(12)], **{f"q_{m}": [m + 0.5 * k for k in range(12)] for m in (1, 2, 3)}}
    add("history, commas", "q.csv", _text(q), _coordinates)
    add("history, semicolons", "q.txt", _text(q, ";", ",", "SIMPACK export\n"), _coordinates)
    add(
        "history, tabs",
        "q.tab",
        _text({"Time [s]": q["time"], **{f"$B.q({m})": q[f"q_{m}"] for m in (3, 1, 2)}}, "\t"),
        _coordinates,
    )
    add("history, blanks", "q.dat", _text(q, "   ", ".", "! run 1\n"), _coordinates)
    pq.write_table(pa.table(q), folder / "sound_q.parquet")
    add("history, Parquet", "q.parquet", (folder / "sound_q.parquet").read_bytes(), _coordinates, binary=True)
    ef = {
        "mode": [1] * 7 + [2] * 7,
        "node": [1, 2, 3, 4, 2, 5, 3] * 2,
        "element": [7] * 4 + [8] * 3 + [7] * 4 + [8] * 3,
    }
    ef |= {name: [float(k) for k in range(14)] for name in neutral.COMPONENTS}
    tables: tuple[tuple[str, Mapping[str, list[Any]], Reader], ...] = (
        ("modes", neutral.MODES, _modes),
        ("welds", neutral.WELDS, _welds),
        ("weld_nodes", neutral.WELD_NODES, _weld_nodes),
        ("nodal_forces", neutral.nodal_forces(), _nodal_forces),
        ("element_forces", ef, _element_forces),
        ("weld_elements", {"weld": ["seam", "seam", "ring"], "element": [1, 2, 3]}, _weld_elements),
        ("nodes", _MESH_NODES, _nodes),
        ("elements", _ELEMENTS, _mesh),
        ("history", neutral.history(), _history),
        ("mapping", {"column": ["q_1", "q_2"], "mode": [1, 2]}, _mapping),
    )
    for name, columns, read in tables:
        for suffix in (".csv", ".parquet"):
            data = _table(folder, name, columns, suffix)
            add(f"{name}{suffix}", f"table{suffix}", data, read, binary=suffix != ".csv", structure=suffix != ".csv")
    add("register", "welds_register.csv", _REGISTER.encode(), _register)
    add("case.toml", "case.toml", _CASE.encode(), _case)
    record = {"inputs": {"a": "b"}, "convention": "on_node", "audit": [], "remarks": [], "files": {}}
    write_json(folder / "sound.json", record)
    add("convert.json", "convert.json", (folder / "sound.json").read_bytes(), _record)
    write_json(folder / "sound.json", {"program": "fatigue", "version": "1", "inputs": [], "warnings": []})
    add("provenance.json", "provenance.json", (folder / "sound.json").read_bytes(), _provenance)
    plain = schema("nodes")
    filled = {f.name: pa.array(_FILLED.get(f.name, [None] * 5), f.type) for f in plain}
    pq.write_table(pa.table(filled, schema=plain), folder / "sound_nodes.parquet")
    nodes = (folder / "sound_nodes.parquet").read_bytes()
    add("result table", "nodes.parquet", nodes, _result_table, binary=True, structure=True)
    add("Abaqus deck", "plate.inp", ABAQUS_DECK.encode(), _model)
    add("Abaqus text", "run.txt", abaqus_text(small_run()), _results, structure=True)
    add("mesh of Abaqus text", "mesh.txt", abaqus_text(small_run()), _model, structure=True)
    add("ANSYS text", "macro.txt", ansys_text(small_run()), _results, structure=True)
    add("ANSYS archive", "plate.cdb", ANSYS_ARCHIVE.encode(), _model)
    for name, path, is_text in recordings(folder):
        add(name, path.name, path.read_bytes(), _coordinates, binary=not is_text)
    return found


_FILLED = {"weld": list("aabbb"), "node": [1, 2, 3, 4, 5], "x_mm": [0.5] * 5, "damage_per_km": [1e-9] * 5}
