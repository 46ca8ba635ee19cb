"""Weld lines for ParaView: one poly-line per line part, every column of both faces as point data (VTK XML PolyData)."""

import base64
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, Literal
from xml.sax.saxutils import quoteattr

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, given_path
from fatigue.files.mishaps import refused_writing
from fatigue.files.whole import replacing
from fatigue.report.wording import LONGEST
from fatigue.results import NODES, PICTURE, Column, enlist, marked, read_codes, read_provenance, read_table
from fatigue.weld.line import WeldLine

STATION = (
    "weld",
    "part",
    "node",
    "order",
    "arc_length_mm",
    "x_mm",
    "y_mm",
    "z_mm",
    "thickness_mm",
    "at_end",
    "at_corner",
    "summed_corner",
)
_XYZ = ("x_mm", "y_mm", "z_mm")
_VTK_TYPE = {"f8": "Float64", "i8": "Int64", "i1": "Int8", "u1": "UInt8"}
_DTYPE = {"float": "f8", "int": "i8", "flag": "u1"}


def write_vtp(folder: Path | str, into: Path | None = None) -> Path:
    """Write ``weld_lines.vtp`` beside the tables of a result.

    A point of the file is a node of a weld line. Columns that differ between the faces come twice, with ``_top`` and
    ``_bottom`` at the end of their name; texts are VTK strings, and ``weld_number`` counts the welds in the order of
    the register, for colouring. ``worst_utilisation``, which is shown at first, and ``worst_life_km``, at most 1e12,
    are those of the worse toe face. A comment carries the hash of the result. ``into`` is another folder to write to,
    where it is not listed as a document of the result. Source of the format: VTK file formats, XML PolyData.

    Raises
    ------
    DataError : the folder holds no result
    """
    folder = given_path(folder, "folder")
    surface, faces = read_codes(folder, "nodes", "surface")
    register = read_table(folder, "welds", ["weld", "closed", "parts"]).to_pydict()
    rows = {face: np.flatnonzero(surface == i) for i, face in enumerate(faces)}
    xyz = np.stack([_numbers(folder, name)[rows["top"]] for name in _XYZ], axis=1)
    path = (into or folder) / PICTURE
    mark = marked(read_provenance(folder).get("result", ""))
    data = _point_data(folder, rows, register)
    lines = _line_points(folder, rows["top"], register)
    with refused_writing(path), path.open("w", encoding="ascii", newline="\n") as file:
        file.writelines(poly_data(xyz, lines, data, comment=mark, scalars="worst_utilisation"))
    if into is None:
        enlist(folder, path)
    return path


def _line_points(
    folder: Path, rows: NDArray[np.int64], register: Mapping[str, Sequence[Any]]
) -> list[NDArray[np.integer]]:
    """Points of every line part, the first repeated at the end of a ring."""
    weld, names = read_codes(folder, "nodes", "weld")
    part = read_table(folder, "nodes", ["part"])["part"].to_numpy()
    rings = {
        name
        for name, closed, parts in zip(register["weld"], register["closed"], register["parts"], strict=True)
        if closed and parts == 1
    }
    key = weld[rows] * (part.max() + 1) + part[rows]
    by_line = np.argsort(key, kind="stable")
    lines = np.split(by_line, np.flatnonzero(np.diff(key[by_line])) + 1)
    lines.sort(key=lambda line: line[0])
    return [np.append(line, line[0]) if names[weld[rows[line[0]]]] in rings else line for line in lines]


def _point_data(
    folder: Path, rows: Mapping[str, NDArray[np.int64]], register: Mapping[str, Sequence[Any]]
) -> Iterator[str]:
    """Columns of the table of nodes, encoded, one in memory at a time."""
    of_station = {column.name: column for column in NODES if column.name in STATION}
    for name in STATION:
        if name not in _XYZ:
            (array,) = _arrays(folder, of_station[name], {name: rows["top"]})
            yield array
    weld, names = read_codes(folder, "nodes", "weld")
    place = {name: i for i, name in enumerate(register["weld"], 1)}
    yield _data("weld_number", "i8", np.array([place[name] for name in names])[weld[rows["top"]]])
    yield from _of_worse_face(folder, rows)
    for column in NODES:
        if column.name not in (*STATION, "surface"):
            yield from _arrays(folder, column, {f"{column.name}_{face}": rows[face] for face in ("top", "bottom")})


def _of_worse_face(folder: Path, rows: Mapping[str, NDArray[np.int64]]) -> Iterator[str]:
    """Utilisation and life of the toe face with the larger utilisation, of the larger where neither has a toe."""
    toe, utilisation, life = (_numbers(folder, name) for name in ("toe", "utilisation", "life_km"))
    rank = np.nan_to_num(utilisation, nan=-1.0) + np.where(toe, 1e30, 0.0)
    worse = np.where(rank[rows["top"]] >= rank[rows["bottom"]], rows["top"], rows["bottom"])
    yield _data("worst_utilisation", "f8", utilisation[worse])
    yield _data("worst_life_km", "f8", np.minimum(life[worse], LONGEST))


def _numbers(folder: Path, name: str) -> NDArray[Any]:
    """Column of numbers or flags of the table of nodes."""
    values: NDArray[Any] = read_table(folder, "nodes", [name])[name].to_numpy()
    return values


def _arrays(folder: Path, column: Column, wanted: Mapping[str, NDArray[np.int64]]) -> Iterator[str]:
    """Some rows of a column, encoded, each under a name of its own: flags as 0, 1 and -1 for none, texts as strings."""
    if column.type == "text":
        codes, texts = read_codes(folder, "nodes", column.name)
        for name, rows in wanted.items():
            yield _texts(name, codes[rows], texts)
    else:
        stored, dtype = read_table(folder, "nodes", [column.name])[column.name], _DTYPE[column.type]
        if column.type == "flag" and stored.null_count:
            stored, dtype = stored.cast(pa.int8()).fill_null(-1), "i1"
        values = stored.to_numpy()
        for name, rows in wanted.items():
            yield _data(name, dtype, values[rows])


def write_line_picture(path: Path | str, lines: Sequence[WeldLine], *, overwrite: bool) -> None:
    """Write weld lines that are not assessed yet: number of the line, node, thickness, normal and outward vectors.

    Raises
    ------
    DataError : the file exists and may not be overwritten, or there are no lines
    """
    path = given_path(path, "path")
    if not lines:
        raise DataError(Problem("no_welds", str(path), "there are no weld lines to draw", "Choose others"))
    if path.exists() and not overwrite:
        raise DataError(Problem("foreign_file", str(path), "is there already", "Use --force to overwrite it"))
    number = np.repeat(np.arange(1, len(lines) + 1), [len(line.node) for line in lines])
    first = np.cumsum([0, *(len(line.node) for line in lines)])
    points = [
        np.append(rows, rows[0]) if line.closed else rows
        for line, rows in zip(lines, (np.arange(i, j) for i, j in pairwise(first)), strict=True)
    ]
    data = [
        _texts("weld", number - 1, [line.weld for line in lines]),
        _data("weld_number", "i8", number),
        _data("node", "i8", np.concatenate([line.node for line in lines])),
        _data("thickness_mm", "f8", np.concatenate([line.thickness for line in lines])),
        _data("normal", "f8", np.concatenate([line.normal for line in lines]), components=3),
        _data("outward", "f8", np.concatenate([line.outward for line in lines]), components=3),
    ]
    xyz = np.concatenate([line.xyz for line in lines])
    with replacing(path) as unfinished, unfinished.open("w", encoding="ascii", newline="\n") as file:
        file.writelines(poly_data(xyz, points, data))


def poly_data(
    xyz: NDArray[np.float64],
    cells: Sequence[NDArray[np.integer]],
    point_data: Iterable[str],
    *,
    cell_data: Iterable[str] = (),
    kind: Literal["Lines", "Polys"] = "Lines",
    comment: str = "",
    scalars: str = "",
) -> Iterator[str]:
    """Text of a file: a comment, points, cells of one kind, the arrays of points and those of cells.

    ``scalars`` names the array of the points that is shown at first.
    """
    yield '<?xml version="1.0"?>\n'
    yield f"<!-- {comment} -->\n" if comment else ""
    yield '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n<PolyData>\n'
    yield f'<Piece NumberOfPoints="{len(xyz)}" NumberOf{kind}="{len(cells)}">\n'
    yield f"<Points>\n{_data('Points', 'f8', xyz, components=3)}</Points>\n<{kind}>\n"
    yield _data("connectivity", "i8", np.concatenate(cells))
    yield _data("offsets", "i8", np.cumsum([len(cell) for cell in cells]))
    yield f"</{kind}>\n<PointData{f' Scalars={quoteattr(scalars)}' if scalars else ''}>\n"
    yield from point_data
    yield "</PointData>\n<CellData>\n"
    yield from cell_data
    yield "</CellData>\n</Piece>\n</PolyData>\n</VTKFile>\n"


def integer_array(name: str, values: NDArray[np.integer]) -> str:
    """Data array of whole numbers."""
    return _data(name, "i8", values)


def _texts(name: str, codes: NDArray[np.integer], texts: Sequence[str]) -> str:
    """Data array of ``texts[codes]``; a missing text, code -1, is empty."""
    plain = np.array([*(text.replace("\0", " ") for text in texts), ""], dtype=object)
    return _element(name, "String", ("\0".join(plain[codes]) + "\0").encode(), components=1)


def _data(name: str, dtype: str, values: NDArray[np.generic], components: int = 1) -> str:
    return _element(name, _VTK_TYPE[dtype], values.astype(f"<{dtype}", order="C").tobytes(), components)


def _element(name: str, kind: str, content: bytes, components: int) -> str:
    """Data array as base64, headed by its length in bytes."""
    encoded = base64.b64encode(len(content).to_bytes(8, "little") + content).decode()
    return (
        f'<DataArray type="{kind}" Name={quoteattr(name)} NumberOfComponents="{components}" format="binary">'
        f"{encoded}</DataArray>\n"
    )
