"""Weld lines for ParaView: one poly-line per line part, every column of both faces as point data (VTK XML PolyData)."""

import base64
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.results import NODES, read_table
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
)
_XYZ = ["x_mm", "y_mm", "z_mm"]
_VTK_TYPE = {"f8": "Float64", "i8": "Int64", "u1": "UInt8"}


def write_vtp(folder: Path) -> Path:
    """Write ``weld_lines.vtp`` beside the tables of a result.

    A point of the file is a node of a weld line. Columns that differ between the faces come twice, with ``_top`` and
    ``_bottom`` at the end of their name; texts are VTK strings, and ``weld_number`` counts the welds in the order of
    the register, for colouring. Source of the format: VTK file formats, XML PolyData.

    Raises
    ------
    DataError : the folder holds no result
    """
    nodes = read_table(folder, "nodes").to_pandas()
    closed = read_table(folder, "welds", ["weld", "closed", "parts"]).to_pandas().set_index("weld")
    top = nodes[nodes["surface"] == "top"].reset_index(drop=True)
    bottom = nodes[nodes["surface"] == "bottom"].reset_index(drop=True)

    ring = (closed["closed"] & (closed["parts"] == 1)).to_dict()
    pieces = []
    for (weld, _), rows in top.groupby(["weld", "part"], sort=False).indices.items():
        pieces.append(np.append(rows, rows[0]) if ring[weld] else rows)

    point_data = [_array(name, top[name]) for name in STATION if name not in _XYZ]
    point_data.append(_array("weld_number", top["weld"].map({weld: i for i, weld in enumerate(closed.index, 1)})))
    for column in NODES:
        if column.name not in (*STATION, "surface"):
            point_data += [
                _array(f"{column.name}_{face}", rows[column.name]) for face, rows in (("top", top), ("bottom", bottom))
            ]
    path = folder / "weld_lines.vtp"
    path.write_text(_poly_lines(top[_XYZ].to_numpy(), pieces, point_data), encoding="ascii", newline="\n")
    return path


def write_line_picture(path: Path, lines: Sequence[WeldLine], *, overwrite: bool) -> None:
    """Write weld lines that are not assessed yet: number of the line, node, thickness, normal and outward vectors.

    Raises
    ------
    DataError : the file exists and may not be overwritten
    """
    if path.exists() and not overwrite:
        raise DataError(Problem("foreign_file", str(path), "is there already", "Use --force to overwrite it"))
    number = np.repeat(np.arange(1, len(lines) + 1), [len(line.node) for line in lines])
    first = np.cumsum([0, *(len(line.node) for line in lines)])
    pieces = [
        np.append(rows, rows[0]) if line.closed else rows
        for line, rows in zip(lines, (np.arange(i, j) for i, j in pairwise(first)), strict=True)
    ]
    data = [
        _array("weld", pd.Series([line.weld for line in lines]).iloc[number - 1]),
        _data("weld_number", "i8", number),
        _data("node", "i8", np.concatenate([line.node for line in lines])),
        _data("thickness_mm", "f8", np.concatenate([line.thickness for line in lines])),
        _data("normal", "f8", np.concatenate([line.normal for line in lines]), components=3),
        _data("outward", "f8", np.concatenate([line.outward for line in lines]), components=3),
    ]
    xyz = np.concatenate([line.xyz for line in lines])
    path.write_text(_poly_lines(xyz, pieces, data), encoding="ascii", newline="\n")


def _poly_lines(xyz: NDArray[np.float64], pieces: Sequence[NDArray[np.integer]], point_data: Sequence[str]) -> str:
    """Lay out points, poly-lines and the arrays of the points."""
    return "\n".join(
        [
            '<?xml version="1.0"?>',
            '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">',
            "<PolyData>",
            f'<Piece NumberOfPoints="{len(xyz)}" NumberOfLines="{len(pieces)}">',
            "<Points>",
            _data("Points", "f8", xyz, components=3),
            "</Points>",
            "<Lines>",
            _data("connectivity", "i8", np.concatenate(pieces)),
            _data("offsets", "i8", np.cumsum([len(piece) for piece in pieces])),
            "</Lines>",
            "<PointData>",
            *point_data,
            "</PointData>",
            "</Piece>",
            "</PolyData>",
            "</VTKFile>\n",
        ]
    )


def _array(name: str, column: pd.Series) -> str:
    """Write one column: flags as 0 and 1, whole numbers and floats as they are, all else as text."""
    if pd.api.types.is_bool_dtype(column):
        return _data(name, "u1", column.to_numpy(dtype=np.uint8))
    if pd.api.types.is_integer_dtype(column):
        return _data(name, "i8", column.to_numpy())
    if pd.api.types.is_float_dtype(column):
        return _data(name, "f8", column.to_numpy())
    texts = "\0".join(["" if pd.isna(text) else text.replace("\0", " ") for text in column]) + "\0"
    return _element(name, "String", texts.encode(), components=1)


def _data(name: str, dtype: str, values: NDArray[np.generic], components: int = 1) -> str:
    return _element(name, _VTK_TYPE[dtype], values.astype(f"<{dtype}", order="C").tobytes(), components)


def _element(name: str, kind: str, content: bytes, components: int) -> str:
    """Write a data array as base64, headed by its length in bytes."""
    encoded = base64.b64encode(len(content).to_bytes(8, "little") + content).decode()
    return (
        f'<DataArray type="{kind}" Name={quoteattr(name)} NumberOfComponents="{components}" format="binary">'
        f"{encoded}</DataArray>"
    )
