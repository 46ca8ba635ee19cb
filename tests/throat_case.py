"""The small case with fillet welds at its plates: weld A has throats on both sides, B on its top alone."""

from pathlib import Path

from tests.small_case import SmallCase

A_MM = 4.0  # throat
CLASS = 36.0  # MPa at 2e6 cycles, straight, invented
SHEAR_CLASS = 80.0
HEAD = "weld,joint,sides,throat_mm,line_offset_mm,curve,curve_shear,curve_root,ended_plate"
CURVES = f"""
[curves.throat]
slopes = [3.0]
range_at_2e6_MPa = {CLASS}
applies = "throat"
source = "invented"
edition = "first"
[curves.throat-shear]
slopes = [5.0]
knees_cycles = [1e8]
range_at_2e6_MPa = {SHEAR_CLASS}
applies = "throat"
quantity = "shear"
source = "invented"
"""


def with_throats(case: SmallCase, folder: Path, rows: list[str], extra: str = "", head: str = HEAD) -> Path:
    """Write a case with throats; ``rows`` are those of the table."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "weld_throats.csv").write_text("\n".join([head, *rows]) + "\n")
    case.body = case.body | {"weld_throats": "weld_throats.csv"}
    case.extra = case.extra + extra + CURVES
    return case.write(folder)


def row(weld: str, sides: str, root: str = "", joint: str = "tee", offset: float = 0.0) -> str:
    """A row of the table, of a throat of 4 mm."""
    return f"{weld},{joint},{sides},{A_MM:g},{offset:g},throat,throat-shear,{root},true"
