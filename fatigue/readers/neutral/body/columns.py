"""The columns of nodes of solid welds in the neutral format: every node through the thickness at each station."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.neutral.body.mesh import Mesh
from fatigue.readers.neutral.tables import Table, open_table
from fatigue.weld.line import LineStack, Vectors, WeldLine
from fatigue.weld.solid.column_check import ColumnShape, column_shape
from fatigue.weld.solid.columns import Columns, SolidWeld

POSITION = ("x_mm", "y_mm", "z_mm")
SAME_PLACE = 1e-3  # mm: as far as positions in two tables may differ
DOUBTFUL, ABSURD = 0.02, 0.10  # of the thickness: how far thickness and middle may be off before it is told, refused
LEANS, LIES = 5.0, 20.0  # degrees from the normal, likewise
BENT, BROKEN = 0.05, 0.20  # of the thickness, a node off the line through the outer nodes, likewise
UNIT_FACTOR = 100.0  # by which thickness and reach differ where units are mistaken


@dataclass(frozen=True, slots=True, eq=False)
class _Rows:
    """The rows of the table: name of the weld, station (position on all lines), node, and position, (r,) each."""

    station: NDArray[np.int64]
    node: NDArray[np.int64]
    xyz: Vectors


def read_columns(
    path: Path, lines: LineStack, mesh: Mesh | None, *, strict: bool
) -> tuple[dict[str, SolidWeld], list[Problem]]:
    """Read ``weld, order, node`` and, where present, ``x_mm, y_mm, z_mm``: the solid welds by name, and doubts.

    Parameters
    ----------
    lines : of all welds in the tables; a weld without rows is one of shells
    mesh : the nodes of the case, whose positions are needed where the table has none

    Raises
    ------
    DataError
        an unknown weld or station, a station without its column or with one node, a node in two columns or without a
        position; a column that is not straight, not along the normal, not of the thickness or not about the station
    """
    table = open_table(path, texts=("weld",))
    table.expect(("weld", "order", "node"), POSITION, strict=strict)
    names, code = table.groups("weld")
    order, node = table.integers("order"), table.integers("node")
    table.known("weld", names, code, set(lines.weld), "the welds")
    table.unique({"weld": code, "node": node}, {"weld": names})
    table.refuse()
    station = _stations(table, names, code, order, lines)
    table.refuse()
    xyz = _positions(table, node, mesh)
    table.refuse()
    by_station = np.argsort(station, kind="stable")
    rows = _Rows(station[by_station], node[by_station], xyz[by_station])
    solid = {names[i] for i in np.unique(code).tolist()}
    welds: dict[str, SolidWeld] = {}
    problems: list[Problem] = []
    for number, name in enumerate(lines.weld):
        if name not in solid:
            continue
        line, first = lines[number], int(lines.begin[number])
        a, b = np.searchsorted(rows.station, [first, first + line.node.size])
        count = np.bincount(rows.station[a:b] - first, minlength=line.node.size)
        columns = Columns(np.append(0, np.cumsum(count)), rows.node[a:b], rows.xyz[a:b])
        found = list(_mistakes(path.name, line, columns))
        if not found:
            found, doubts = _of_shape(path.name, line, columns)
            table.warnings.extend([*doubts, *_uneven(path.name, line, count)])
            welds[name] = _by_node(line, columns)
        problems += found
    refuse(DataError, problems)
    return welds, table.warnings


def _stations(
    table: Table, names: tuple[str, ...], code: NDArray[np.int32], order: NDArray[np.int64], lines: LineStack
) -> NDArray[np.int64]:
    """Position on all lines of the station of every row, (r,)."""
    place = {weld: i for i, weld in enumerate(lines.weld)}
    line_of = np.array([place[name] for name in names], dtype=np.int64)[code] if names else np.zeros(0, np.int64)
    owner = np.repeat(np.arange(len(lines)), np.diff(lines.begin))
    orders = np.unique(np.concatenate([lines.order, order]))
    known = owner * orders.size + np.searchsorted(orders, lines.order)  # ascending: lines are sorted by order
    wanted = line_of * orders.size + np.searchsorted(orders, order)
    at = np.searchsorted(known, wanted).clip(max=max(known.size - 1, 0))
    unknown = known[at] != wanted
    row = int(unknown.argmax()) if unknown.size else 0
    if unknown.any():
        what = f"weld {names[code[row]]} has no station of order {order[row]}"
        table.report(unknown, "unknown_id", "order", what, "Write the orders of weld_nodes, or add the station there")
    return at.astype(np.int64)


def _positions(table: Table, node: NDArray[np.int64], mesh: Mesh | None) -> Vectors:
    """Position of the node of every row, (r, 3) [mm]: of the table itself, else of the table of nodes."""
    own = [name for name in POSITION if name in table.position]
    if own and len(own) < len(POSITION):
        lacking = next(name for name in POSITION if name not in own)
        what = f"the column is missing although {own[0]} is there"
        table.problems.append(Problem("missing_column", table.where(lacking), what, "Give all three or none"))
        return np.zeros((node.size, 3))
    if not own and mesh is None:
        what = "nothing says where the nodes of the columns are"
        remedy = "Name the table of nodes in the case ([body] nodes), or add the columns x_mm, y_mm, z_mm"
        table.problems.append(Problem("no_positions", table.path.name, what, remedy))
        return np.zeros((node.size, 3))
    given = np.column_stack([table.numbers(name) for name in POSITION]).astype(np.float64) if own else None
    if mesh is None:
        assert given is not None
        return given
    at = np.searchsorted(mesh.node, node).clip(max=max(mesh.node.size - 1, 0))
    is_known = mesh.node[at] == node if mesh.node.size else np.zeros(node.size, np.bool_)
    if given is None:
        if not is_known.all():
            lost = node[int((~is_known).argmax())]
            what = f"node {lost} has no position in the table of nodes"
            table.report(~is_known, "unknown_node", "node", what, "Add it there, or mend the number")
            return np.zeros((node.size, 3))
        return np.asarray(mesh.xyz[at])
    apart = np.where(is_known, np.linalg.norm(mesh.xyz[at] - given, axis=1), 0.0) if mesh.node.size else 0.0 * node
    moved = apart > SAME_PLACE
    if moved.any():
        row = int(moved.argmax())
        what = f"node {node[row]} is {apart[row]:.3g} mm away from where the table of nodes has it"
        table.report(
            moved, "moved_node", "x_mm", what, "Write both tables from one mesh, or leave x_mm, y_mm, z_mm out"
        )
    return given


def _mistakes(file: str, line: WeldLine, columns: Columns) -> Iterator[Problem]:
    """Stations that have no column, or one of a single node."""
    size = np.diff(columns.begin)
    where = f"{file}: weld {line.weld}"
    if (size == 0).any():
        at, count = int((size == 0).argmax()), int(np.count_nonzero(size == 0))
        what = f"the station of order {line.order[at]} has no column{_more(count)}, and others of the weld have"
        yield Problem("no_column", where, what, "List every node through the thickness at each station of the weld")
    elif (size == 1).any():
        at, count = int((size == 1).argmax()), int(np.count_nonzero(size == 1))
        what = f"the column at order {line.order[at]} is one node, {columns.of(at)[0]}{_more(count)}"
        remedy = "List every node through the thickness; leave the weld out where its plate is of shells"
        yield Problem("short_column", where, what, remedy)
    elif not (own := np.bincount(columns.station, columns.node == line.node[columns.station]) == 1).all():
        at, count = int((~own).argmax()), int(np.count_nonzero(~own))
        what = f"node {line.node[at]} of weld_nodes is not in the column at order {line.order[at]}{_more(count)}"
        yield Problem("foreign_column", where, what, "Give weld_nodes the node of the column on the top surface")


def _of_shape(file: str, line: WeldLine, columns: Columns) -> tuple[list[Problem], list[Problem]]:
    """Mistakes and doubts about the shape of the columns of a weld: the first mistake, or one doubt of each kind."""
    shape, t = column_shape(columns, line.xyz, line.normal), line.thickness
    doubts: list[Problem] = []
    for code, measure, doubtful, absurd in (
        ("column_thickness", np.abs(shape.reach / t - 1.0), DOUBTFUL, ABSURD),
        ("column_off_middle", shape.off_mid / t, DOUBTFUL, ABSURD),
        ("leaning_column", shape.lean_deg, LEANS, LIES),
        ("bent_column", shape.bow / t, BENT, BROKEN),
    ):
        at = int(measure.argmax())
        if not measure[at] > doubtful:
            continue
        where = f"{file}: weld {line.weld}, order {line.order[at]}"
        problem = Problem(code, where, *_told(code, line, shape, at))
        if measure[at] > absurd:
            return [problem], []
        doubts.append(problem)
    low = shape.top != line.node
    if low.any():
        at = int(low.argmax())
        what = f"node {line.node[at]} of weld_nodes is not at the top, where the normal points to: node "
        what += f"{shape.top[at]} is{_more(int(np.count_nonzero(low)))}"
        remedy = "Turn the normal if top and bottom are confused, or give weld_nodes the node on the top surface"
        doubts.append(Problem("not_top_node", f"{file}: weld {line.weld}, order {line.order[at]}", what, remedy))
    return [], doubts


def _told(code: str, line: WeldLine, shape: ColumnShape, at: int) -> tuple[str, str]:
    """What is wrong with the column at a station, and what to do."""
    t, reach = float(line.thickness[at]), float(shape.reach[at])
    if code == "column_thickness":
        what = f"the outer nodes are {reach:.4g} mm apart along the normal, and thickness_mm is {t:.4g}"
        if reach > 0 and max(reach / t, t / reach) > UNIT_FACTOR:
            return what, "Give positions and thickness both in mm"
        return what, "List all nodes from surface to surface, and their distance as thickness_mm"
    if code == "column_off_middle":
        off = float(shape.off_mid[at])
        what = f"x_mm, y_mm, z_mm of weld_nodes are {off:.3g} mm away from the middle between the outer nodes"
        if shape.off_outer[at] < ABSURD * t:
            what = f"x_mm, y_mm, z_mm of weld_nodes are at a surface, {off:.3g} mm from the middle of the column"
        return what, "Give the middle between the outer nodes: moments are about mid-thickness"
    if code == "leaning_column":
        what = f"the column leans by {shape.lean_deg[at]:.3g} degrees from the normal"
        return what, "Give normal_x, normal_y, normal_z across the plate, and columns along it"
    what = f"a node of the column is {shape.bow[at]:.3g} mm off the line through its outer nodes"
    return what, "List the nodes of one column of the mesh"


def _uneven(file: str, line: WeldLine, count: NDArray[np.int64]) -> Iterator[Problem]:
    """Doubt about columns with other numbers of nodes than most: one that lacks a node loses its force."""
    where = f"{file}: weld {line.weld}"
    corner = count[~line.edge_mid]
    usual = int(np.bincount(corner).argmax())
    wanted = np.full(count.size, usual)
    if line.edge_mid.any():
        of_mid = int(np.bincount(count[line.edge_mid]).argmax())
        wanted[line.edge_mid] = of_mid
        if usual != 2 * of_mid - 1:
            what = f"columns of corner stations have {usual} nodes and those of mid-side stations {of_mid}"
            remedy = f"List the mid-side nodes between layers at corner stations too: {2 * of_mid - 1} nodes"
            yield Problem("uneven_columns", where, what, remedy)
            return
    odd = count != wanted
    if odd.any():
        at = int(odd.argmax())
        what = f"the column at order {line.order[at]} has {count[at]} nodes, others have {wanted[at]}"
        what += _more(int(np.count_nonzero(odd)))
        yield Problem("uneven_columns", where, what, "Complete the columns, unless the number of layers changes there")


def _by_node(line: WeldLine, columns: Columns) -> SolidWeld:
    """Columns of a weld, its stations by ascending node."""
    along = np.argsort(line.node)
    size = np.diff(columns.begin)[along]
    begin = np.append(0, np.cumsum(size))
    rows = np.arange(begin[-1]) + np.repeat(columns.begin[along] - begin[:-1], size)
    return SolidWeld(line.node[along], Columns(begin, columns.node[rows], columns.xyz[rows]))


def _more(count: int) -> str:
    return f" (and {count - 1} more)" if count > 1 else ""
