"""What is said of a column of a result table, and the columns that name a point."""

from dataclasses import dataclass
from typing import Literal

ColumnType = Literal["text", "int", "flag", "float"]


@dataclass(frozen=True, slots=True)
class Column:
    """One column of a result table: name, type, unit and meaning, written into the file beside the numbers."""

    name: str
    type: ColumnType
    unit: str
    meaning: str


POINT = (
    Column("weld", "text", "-", "weld line"),
    Column("part", "int", "-", "straight part of a weld split at its kinks, from 1"),
    Column("node", "int", "-", "FE node id"),
    Column("order", "int", "-", "position along the weld line, as given"),
    Column("surface", "text", "-", "top (side of the plate normal) or bottom face of the assessed plate"),
)
