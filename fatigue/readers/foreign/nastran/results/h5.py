"""Grid point forces and geometry from an MSC Nastran HDF5 file (``MDLPRM,HDF5,1``)."""

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, FatigueError, Problem
from fatigue.readers.foreign.fe.assembly import FileBlocks, assemble
from fatigue.readers.foreign.fe.force_rows import sharing_rows
from fatigue.readers.foreign.fe.model import FeModel, Section, Shell, shell_mesh
from fatigue.readers.foreign.fe.results import REQUEST, Eigenvalue, FeResults, ForceBlock, ShapeBlock, UnusableBlock
from fatigue.readers.foreign.fe.static_case import Heading, heading
from fatigue.readers.foreign.nastran.frames import FrameCard, Frames
from fatigue.readers.foreign.nastran.results.analysis import MODES, STATIC, wrong_analysis

_COMPONENTS = ("F1", "F2", "F3", "M1", "M2", "M3")
_SHAPE = ("X", "Y", "Z", "RX", "RY", "RZ")
_ELEMENTS = "NASTRAN/INPUT/ELEMENT"
_SHELLS = {"CQUAD4": 4, "CQUADR": 4, "CQUAD8": 4, "CTRIA3": 3, "CTRIAR": 3, "CTRIA6": 3}
_BLANK = 1.7368e-18  # what the file holds for a real field left blank
_MOST_COMPRESSED = 1100  # deflate cannot do better; a larger claim is damage

Rows = NDArray[Any]


def read_h5(
    path: Path, subcase: int | None = None, interface: Collection[int] = (), loads: Collection[int] | None = ()
) -> FeResults:
    """Read the grid point forces of a real modal run or of static subcases, in double precision.

    Parameters
    ----------
    subcase : the one to read, where the file has several that cannot be read together
    interface : static subcases that are modes of the basis, beside the modes of a modal subcase
    loads : static subcases that are loads beside them; None: all that can be

    Raises
    ------
    DataError : damaged file, no GRID_FORCE table, other than modal and static results, superelements
    """
    with opened(path) as read:
        if not len(read("NASTRAN/RESULT/NODAL/GRID_FORCE", False)) and len(
            read("NASTRAN/RESULT/NODAL/GRID_FORCE_CPLX", False)
        ):
            raise DataError(
                Problem("complex_forces", str(path), "the forces are complex (table GRID_FORCE_CPLX)", REQUEST)
            )
        forces_table = read("NASTRAN/RESULT/NODAL/GRID_FORCE")
        domains = {int(d["ID"]): d for d in read("NASTRAN/RESULT/DOMAINS", required=False)}
        forces: list[ForceBlock] = []
        unusable: list[UnusableBlock] = []
        stated: dict[tuple[int, int], list[float]] = {}
        for key, rows in _by_domain(forces_table):
            if (domain := domains.get(key)) is None:
                raise DataError(
                    Problem(
                        "no_domain", f"{path}, domain {key}", "the table of domains lacks it", "Copy the file again"
                    )
                )
            where = f"{path}, subcase {domain['SUBCASE']} mode {domain['MODE']} (domain {key})"
            if (other := unusable_domain(domain, where)) is not None:
                unusable.append(UnusableBlock(int(domain["SUBCASE"]), other))
                continue
            forces.append(sharing_rows(_force_block(domain, rows, where), forces))
            stated[domain_key(domain)] = [float(domain["TIME_FREQ_EIGR"])]
        shapes = [
            ShapeBlock(*domain_key(domains[key]), rows["ID"].astype(np.int64), _columns(rows, _SHAPE))
            for name in ("EIGENVECTOR", "DISPLACEMENT")
            for key, rows in _by_domain(read(f"NASTRAN/RESULT/NODAL/{name}", required=False))
            if key in domains and unusable_domain(domains[key], "") is None
        ]
        summary = [
            Eigenvalue(
                int(domains[int(row["DOMAIN_ID"])]["SUBCASE"]) if int(row["DOMAIN_ID"]) in domains else 0,
                int(row["MODE"]),
                float(row["FREQ"]),
                float(row["MASS"]),
                float(row["EIGEN"]),
            )
            for row in read("NASTRAN/RESULT/SUMMARY/EIGENVALUE", required=False)
        ]
        headings = _headings(read("NASTRAN/INPUT/PARAMETER/CASECC/SUBCASE", required=False))
    file = FileBlocks(str(path), "MSC Nastran", forces, shapes, summary, stated, unusable, headings)
    return assemble(file, subcase, interface, loads)


def read_h5_model(path: Path) -> FeModel:
    """Read grids, coordinate systems, shells and shell properties of the same file.

    Raises
    ------
    DataError : as ``read_h5``, and geometry that contradicts itself
    """
    source = str(path)
    with opened(path) as read:
        grid = read("NASTRAN/INPUT/NODE/GRID")
        cards = _frame_cards(read)
        sections, unconfirmed = _sections(read)
        shells = [shell for name in _SHELLS for shell in _shells(name, read(f"{_ELEMENTS}/{name}", required=False))]
        plotel = read(f"{_ELEMENTS}/PLOTEL", required=False)
        row_of = {int(n): k for k, n in enumerate(grid["ID"])}
        if len(row_of) < len(grid) or ("SEID" in grid.dtype.names and grid["SEID"].any()):
            raise DataError(
                Problem("superelement", source, "grids of superelements", "Give the residual structure alone")
            )
        position: dict[int, NDArray[np.float64]] = {}

        def find(node: int) -> NDArray[np.float64]:
            if node not in position:
                if node not in row_of:
                    raise DataError(Problem("no_grid", source, f"grid {node} does not exist", "Write the file again"))
                row = grid[row_of[node]]
                position[node] = frames.position(int(row["CP"]), tuple(float(x) for x in row["X"]))  # type: ignore[arg-type]
            return position[node]

        frames = Frames(source, cards, find)
        xyz = {node: find(node) for node in row_of}
        turned = sorted(node for node, k in row_of.items() if grid[k]["CD"])
        axes = [frames.axes_at(int(grid[row_of[n]]["CD"]), xyz[n]) for n in turned]
    for pid in {shell.pid for shell in shells} - sections.keys():
        unconfirmed[pid] = f"property {pid} is not a PSHELL or PCOMP of this model"
    return FeModel(
        source=source,
        mesh=shell_mesh(source, xyz, shells, sections),
        frame_node=np.array(turned, np.int64),
        frame=np.array(axes).reshape(-1, 3, 3),
        unconfirmed_sections=unconfirmed,
        unconfirmed_elements={shell.element: shell.unconfirmed for shell in shells if shell.unconfirmed},
        warnings=_other_elements(path),
        marker_edges={"PLOTEL": plotel["G"].astype(np.int64)} if len(plotel) else {},
    )


def _other_elements(path: Path) -> tuple[Problem, ...]:
    """Warning about elements that are not read, by name and number; a damaged name would be among them."""
    try:
        with h5py.File(path, "r") as file:
            tables = {name: table for name, table in file[_ELEMENTS].items() if isinstance(table, h5py.Dataset)}
            counts = {name: len(table) for name, table in tables.items() if name not in (*_SHELLS, "PLOTEL")}
    except MemoryError:
        raise
    except Exception as error:
        raise _damaged(path, str(error) or type(error).__name__) from error
    if not counts:
        return ()
    listed = ", ".join(f"{count} {name!r}" for name, count in sorted(counts.items()))
    what = f"elements that weld lines do not need are left out: {listed}"
    remedy = "Nothing, unless shells are among them"
    return (Problem("elements_left_out", str(path), what, remedy, sum(counts.values())),)


@contextmanager
def opened(path: Path) -> Iterator[Any]:
    """Function that reads one table of the open file; every failure of the library becomes a DataError."""

    def read(name: str, required: bool = True) -> Rows:
        table = file.get(name)
        if not isinstance(table, h5py.Dataset):
            if not required and (table is not None or file.get(name, getlink=True) is not None):
                raise _damaged(path, f"{name} is no table")
            if not required:
                return np.empty(0, [])
            raise DataError(
                Problem(
                    "no_table",
                    str(path),
                    f"there is no table {name}",
                    "Request GPFORCE with MDLPRM,HDF5,1, which also stores the model",
                )
            )
        if table.size * table.dtype.itemsize > _MOST_COMPRESSED * path.stat().st_size:
            raise _damaged(path, f"table {name} claims {table.size} rows")
        rows: Rows = table[:]
        return rows

    try:
        with h5py.File(path, "r") as file:
            yield read
    except (FatigueError, MemoryError):
        raise
    except Exception as error:  # h5py raises nearly every kind of exception on a damaged file
        raise _damaged(path, str(error) or type(error).__name__) from error


def _damaged(path: Path, found: str) -> DataError:
    return DataError(
        Problem(
            "h5_damaged", str(path), f"the file is no sound MSC HDF5 file: {found}", "Copy it again, or repeat the run"
        )
    )


def _by_domain(rows: Rows) -> Iterator[tuple[int, Rows]]:
    """Rows of every domain, in ascending order of domain."""
    if len(rows):
        for key in np.unique(rows["DOMAIN_ID"]):
            yield int(key), rows[rows["DOMAIN_ID"] == key]


def _columns(rows: Rows, names: tuple[str, ...]) -> NDArray[np.float64]:
    return np.stack([rows[name] for name in names], axis=1)


def _headings(rows: Rows) -> dict[int, Heading]:
    """Heading of every subcase that the case control has."""
    fields = ("TITLE", "SUBTITLE", "LABEL")
    if not {"SID", *fields} <= set(rows.dtype.names or ()):
        return {}
    return {int(row["SID"]): heading(*(_text(row[name]) for name in fields)) for row in rows}


def _text(raw: bytes) -> str:
    return "".join(c if c.isprintable() else " " for c in raw.decode("latin-1"))


def domain_key(domain: Any) -> tuple[int, int]:
    """Subcase and mode, 0 in a static subcase."""
    return int(domain["SUBCASE"]), int(domain["MODE"]) if int(domain["ANALYSIS"]) == MODES else 0


def unusable_domain(domain: Any, where: str) -> Problem | None:
    """Why a domain is no real static or modal result of the residual structure; None if it is."""
    if int(domain["ANALYSIS"]) not in (STATIC, MODES):
        return wrong_analysis(where, int(domain["ANALYSIS"]))
    if int(domain["SE"]):
        return Problem("superelement", where, f"results of superelement {domain['SE']}", "Run without superelements")
    return None


def _force_block(domain: Any, rows: Rows, where: str) -> ForceBlock:
    distinct, which = np.unique(rows["ELNAME"], return_inverse=True)
    kind = np.array([name.decode("ascii").strip() for name in distinct.tolist()], dtype=np.str_)
    return ForceBlock(
        where,
        *domain_key(domain),
        rows["ID"].astype(np.int64),
        rows["EID"].astype(np.int64),
        kind[which],
        _columns(rows, _COMPONENTS),
    )


def _frame_cards(read: Any) -> dict[int, FrameCard]:
    found = {}
    for kind in "RCS":
        for row in read(f"NASTRAN/INPUT/COORDINATE_SYSTEM/CORD2{kind}", required=False):
            points = tuple(tuple(float(row[f"{p}{k}"]) for k in (1, 2, 3)) for p in "ABC")
            found[int(row["CID"])] = FrameCard(kind, int(row["RID"]), points)  # type: ignore[arg-type]
        for row in read(f"NASTRAN/INPUT/COORDINATE_SYSTEM/CORD1{kind}", required=False):
            found[int(row["CID"])] = FrameCard(kind, grids=tuple(int(row[name]) for name in ("G1", "G2", "G3")))
    return found


def _is_blank(value: float) -> bool:
    return bool(np.isclose(value, _BLANK, rtol=1e-3, atol=0))


def _sections(read: Any) -> tuple[dict[int, Section], dict[int, str]]:
    """Shell properties, and those whose thickness needs a confirmation by hand."""
    sections, unconfirmed = {}, {}
    for row in read("NASTRAN/INPUT/PROPERTY/PSHELL", required=False):
        pid = int(row["PID"])
        thickness = float(row["T"])
        sections[pid] = Section(np.nan if thickness == 0 or _is_blank(thickness) else thickness)
        if row["MID2"] not in (row["MID1"], -1) or abs(float(row["BK"]) - 1.0) > 1e-6 or row["MID4"] > 0:
            unconfirmed[pid] = f"PSHELL {pid} has a bending stiffness of its own"
    ply = read("NASTRAN/INPUT/PROPERTY/PCOMP/PLY", required=False)
    for row in read("NASTRAN/INPUT/PROPERTY/PCOMP/IDENTITY", required=False):
        pid, first = int(row["PID"]), int(row["PLY_POS"])
        total = float(ply["T"][first : first + int(row["PLY_LEN"])].sum())
        bottom = float(row["Z0"])
        sections[pid] = Section(total, 0.0 if _is_blank(bottom) else bottom + total / 2)
        unconfirmed[pid] = f"PCOMP {pid} is a layered section"
    return sections, unconfirmed


def _shells(name: str, rows: Rows) -> Iterator[Shell]:
    corners = _SHELLS[name]
    for row in rows:
        given = np.asarray(row["T"][:corners], np.float64)
        own = given[given > 0]  # -1 where the property's thickness holds
        grids = [int(g) for g in row["G"]]
        uneven = own.size and (own.size < corners or np.ptp(own) > 0.01 * own.max() or int(row["TFLAG"]))
        yield Shell(
            int(row["EID"]),
            int(row["PID"]),
            tuple(grids[:corners]),
            tuple(grids[corners:]),
            float(own.mean()) if own.size else None,
            float(row["ZOFFS"]),
            f"{name} {row['EID']} has corner thicknesses of its own" if uneven else "",
        )
