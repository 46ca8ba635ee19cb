"""One weld with stress across and along it that follows by hand: three modes, two short load cases, example curves.

Its stresses, curves and lines are invented. The third mode is constant in both events.
"""

from pathlib import Path

import numpy as np
import pandas as pd

from tests.small_case import SmallCase

THICKNESS = 6.0  # mm
MODES = {  # membrane, bending, in-plane shear, twist, transverse shear of the top face [MPa per unit]
    1: (12.0, 4.5, 3.0, 0.9, 0.3),
    2: (-2.4, 3.6, 7.5, -1.5, 0.6),
    3: (6.0, 1.2, 0.6, 0.0, 0.0),
}
TRACK = [(0, 0, 1), (1, 1, 1), (-1, 1, 1), (2, -1, 1), (0.5, 2, 1), (-2, 0, 1)]
LOAD_UNLOAD = [(0, 0, 1), (3, -2, 1)]
CURVES = """
[curves.fillet-36]
slopes = [3.0]
range_at_2e6_MPa = 36.0
applies = "structural"
source = "invented for a test"

[curves.shear-28]
slopes = [5.0]
knees_cycles = [1e8]
range_at_2e6_MPa = 28.0
applies = "structural"
quantity = "shear"
source = "invented for a test"

[curves.knee-36]
slopes = [3.0, 5.0]
knees_cycles = [5e6, 1e8]
range_at_2e6_MPa = 36.0
applies = "structural"
source = "invented for a test"
"""
LINES = """line,component,R,stress_max_MPa,edition,clause
across,perp,-1,60,invented,none
across,perp,0,92.307692307692307,invented,none
across,perp,0.5,126.31578947368421,invented,none
along,par,-1,60,invented,none
along,par,0,92.307692307692307,invented,none
sheared,shear,-1,35,invented,none
sheared,shear,0.5,70,invented,none
"""
CASES = """case,kind,group,factor,q_1,q_2,q_3
dead,static,ride,1,,,1
pitch,alternating,ride,2,1,,
roll,alternating,ride,2,,1,
empty,state,stops,,,,1
full,state,stops,,1,0.5,1
braking,state,stops,,-2,1,1
"""


def compared_case(checks: str = "", normal: str = "fillet-36") -> SmallCase:
    """A weld with toes on both faces, and what ``[checks]`` and the tables behind it ask for."""
    nodes = pd.DataFrame(
        {
            "weld": "W",
            "order": [1, 2, 3],
            "node": [11, 12, 13],
            "x_mm": [0.0, 10.0, 20.0],
            "y_mm": 0.0,
            "z_mm": 0.0,
            "thickness_mm": THICKNESS,
            **{f"normal_{axis}": float(axis == "z") for axis in "xyz"},
            **{f"outward_{axis}": float(axis == "y") for axis in "xyz"},
        }
    )
    return SmallCase(
        modes=pd.DataFrame({"mode": [1, 2, 3], "frequency_hz": [5.0, 12.0, 60.0], "kind": "interface"}),
        welds=pd.DataFrame({"weld": ["W"], "curve_shear": "shear-28"}),
        weld_nodes=nodes,
        nodal_forces=pd.concat([_forces(mode) for mode in MODES], ignore_index=True),
        histories={"track": _history(TRACK), "load_unload": _history(LOAD_UNLOAD)},
        curve={"name": normal},
        mission={"target_km": 1500.0, "km_per_year": 1500.0},
        events=[
            {"name": "track", "history": "track", "length_km": 0.01, "share": 1.0},
            {"name": "load_unload", "history": "load_unload", "per_1000_km": 4.0},
        ],
        extra=CURVES + checks,
    )


def write_case(folder: Path, checks: str = "", *, cases: str = CASES, lines: str = LINES, normal: str = "fillet-36"):
    """Write the case with its static load cases and endurance lines; return the path of the case file."""
    path = compared_case(checks, normal).write(folder)
    (folder / "cases.csv").write_text(cases, encoding="utf-8")
    (folder / "lines.csv").write_text(lines, encoding="utf-8")
    return path


def _forces(mode: int) -> pd.DataFrame:
    """Consistent nodal forces of a uniform line force and moment that make the stresses of a mode."""
    t, (membrane, bending, in_plane, twist, transverse) = THICKNESS, MODES[mode]
    force = [in_plane * t, membrane * t, transverse * t, -bending * t**2 / 6.0, twist * t**2 / 6.0, 0.0]
    load = np.outer([5.0, 10.0, 5.0], force)
    table = pd.DataFrame(load, columns=["fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"])
    return table.assign(weld="W", node=[11, 12, 13], mode=mode)


def _history(samples: list[tuple[float, ...]]) -> pd.DataFrame:
    table = pd.DataFrame(samples, columns=["q_1", "q_2", "q_3"], dtype=float)
    table.insert(0, "time_s", 0.01 * np.arange(len(samples)))
    return table
