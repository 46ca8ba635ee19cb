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
QUALITY = ("joint_type", "performance_class", "inspection_class")
OPTIONAL = ("closed", "surface", "curve", "end_length_mm", "description", "curve_shear", "attachment_mm", *QUALITY)


@dataclass(frozen=True, slots=True)
class Weld:
    """One weld: which faces carry a toe, its own curve and end length where it has them.

    ``surface`` is top, bottom or both; ``end_length`` in mm, None: the plate thickness, 0: no end treatment.
    ``curve_shear`` is the S-N curve of its shear stress; ``joint_type``, ``performance_class`` and ``inspection_class``
    are quality data as given, empty where there are none. ``attachment`` is the length [mm] along the stress of what
    the weld attaches, None: not given.
    """

    name: str
    closed: bool
    surface: Surface
    curve: str | None
    end_length: float | None
    description: str
    curve_shear: str | None = None
    joint_type: str = ""
    performance_class: str = ""
    inspection_class: str = ""
    attachment: float | None = None


def read_welds(path: Path, curves: Collection[str] | None, *, strict: bool) -> tuple[tuple[Weld, ...], list[Problem]]:
    """Read the column ``weld`` and, where present, those of ``OPTIONAL``, in the file's order.

    ``curves`` are the names a weld's curve may have; None: any, for they are looked at later.
    """
    texts = ("weld", "surface", "curve", "description", "curve_shear", *QUALITY)
    table = open_table(path, texts=texts)
    table.expect(("weld",), OPTIONAL, strict=strict)
    names, code = table.groups("weld")
    table.unique({"weld": code}, {"weld": names})
    closed = table.flags("closed", default=False)
    surface = table.texts("surface", default="both")
    table.choices("surface", surface, SURFACES)
    curve, curve_code = table.groups("curve", default="")
    shear, shear_code = table.groups("curve_shear", default="")
    if curves is not None:
        table.known("curve", curve, curve_code, {"", *curves}, "the curves")
        table.known("curve_shear", shear, shear_code, {"", *curves}, "the curves")
    end_length = table.numbers("end_length_mm", default=np.nan, least=0.0)
    attachment = table.numbers("attachment_mm", default=np.nan, above=0.0)
    description = table.texts("description", default="")
    joint_type, performance, inspection = (table.texts(name, default="") for name in QUALITY)
    table.refuse()
    welds = tuple(
        Weld(
            name=names[code[i]],
            closed=bool(closed[i]),
            surface=cast(Surface, surface[i]),
            curve=curve[curve_code[i]] or None,
            end_length=None if np.isnan(end_length[i]) else float(end_length[i]),
            description=description[i],
            curve_shear=shear[shear_code[i]] or None,
            joint_type=joint_type[i],
            performance_class=performance[i],
            inspection_class=inspection[i],
            attachment=None if np.isnan(attachment[i]) else float(attachment[i]),
        )
        for i in range(table.rows)
    )
    return welds, table.warnings
