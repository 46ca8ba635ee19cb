"""The welds of a body in the neutral format."""

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, TypeAlias, cast

import numpy as np

from fatigue.errors import Problem
from fatigue.readers.neutral.tables import open_table

Surface: TypeAlias = Literal["top", "bottom", "both"]
SURFACES = ("top", "bottom", "both")


@dataclass(frozen=True, slots=True)
class Weld:
    """One weld: which faces carry a toe, its own curve and end length where it has them.

    ``surface`` is top, bottom or both; ``end_length`` in mm, None: the plate thickness, 0: no end treatment.
    """

    name: str
    closed: bool
    surface: Surface
    curve: str | None
    end_length: float | None
    description: str


def read_welds(path: Path, curves: Collection[str] | None, *, strict: bool) -> tuple[tuple[Weld, ...], list[Problem]]:
    """Read ``weld`` and, where present, ``closed, surface, curve, end_length_mm, description``, in the file's order.

    ``curves`` are the names a weld's curve may have; None: any, for they are looked at later.
    """
    table = open_table(path, texts=("weld", "surface", "curve", "description"))
    table.expect(("weld",), ("closed", "surface", "curve", "end_length_mm", "description"), strict=strict)
    names, code = table.groups("weld")
    table.unique({"weld": code}, {"weld": names})
    closed = table.flags("closed", default=False)
    surface = table.texts("surface", default="both")
    table.choices("surface", surface, SURFACES)
    curve, curve_code = table.groups("curve", default="")
    if curves is not None:
        table.known("curve", curve, curve_code, {"", *curves}, "the curves")
    end_length = table.numbers("end_length_mm", default=np.nan, least=0.0)
    description = table.texts("description", default="")
    table.refuse()
    welds = tuple(
        Weld(
            name=names[code[i]],
            closed=bool(closed[i]),
            surface=cast(Surface, surface[i]),
            curve=curve[curve_code[i]] or None,
            end_length=None if np.isnan(end_length[i]) else float(end_length[i]),
            description=description[i],
        )
        for i in range(table.rows)
    )
    return welds, table.warnings
