"""The small case with all checks beside the toe: throats, a stress point, interaction, endurance between load cases."""

from pathlib import Path

import pandas as pd

from tests.small_case import small_case
from tests.stress_point_case import curve_text, point, stresses, write_points

THROATS = """weld,joint,sides,throat_mm,line_offset_mm,curve,curve_shear,curve_root,ended_plate
A,tee,both,4,0,throat,throat-shear,,true
B,tee,top,4,0,throat,throat-shear,throat,true
"""
CASES = """case,kind,group,factor,q_1,q_2,q_7
dead load,static,proof,1,4.0,0.0,1.0
vertical,alternating,proof,1,12.0,0.0,0.0
lateral,alternating,proof,1,0.0,6.0,3.0
"""
LINES = """line,component,R,stress_max_MPa,edition,clause
perp,perp,-1,53,invented,-
perp,perp,0,70,invented,-
perp,perp,0.5,90,invented,-
"""
CHECKS = """
[checks]
static_cases = "static_cases.csv"
endurance_lines = "endurance_lines.csv"
counts = ["throat_perp"]
[[checks.interaction]]
rule = "en1993"
welds = ["A"]
[[checks.endurance]]
welds = ["A", "B"]
perp = "perp"
cases = "proof"
"""


def write_checks_case(folder: Path, extra: str = "") -> Path:
    """Write the case; return the path of its file."""
    case = small_case(seconds=4.0)
    case.welds = pd.DataFrame(
        {"weld": ["A", "B"], "surface": ["both", "top"], "curve_shear": ["toe-shear", ""], "joint_type": ["T", "T"]}
    )
    case.body |= {"weld_throats": "weld_throats.csv"}
    curves = [
        curve_text("points", 36.0),
        curve_text("throat", 36.0, "throat"),
        curve_text("throat-shear", 80.0, "throat", (5.0,), (1e8,), "shear"),
        curve_text("toe-shear", 80.0, "structural", (5.0,), (1e8,), "shear"),
    ]
    case.extra = extra + CHECKS + "".join(curves)
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in (("weld_throats", THROATS), ("static_cases", CASES), ("endurance_lines", LINES)):
        (folder / f"{name}.csv").write_text(text)
    stress = stresses("P1", {1: (1.0, 0.2, 0.1), 2: (0.5, 0.1, 0.4), 7: (0.2, 0.0, 0.3)}, (3.2, 8.0))
    return write_points(case, folder, [point("P1", weld="A")], [stress])
