"""A small case with a plate for strain gauges: a row of elements under fields whose strains are known.

Four rectangles of 20 x 10 mm side by side along x, a triangle at their end, a flange upright on them, a sandwich over
the first, far from the welds of ``small_case``. Mode 1 is tension along x, 1, 2, 3, 4, 5 times as much from one
to the next, mode 2 bending about y, mode 7 shear.
"""

from dataclasses import dataclass, field

import numpy as np
import pandas as pd

from fatigue.flexbody.elements.quad import quad_stiffness
from fatigue.flexbody.elements.section import Section
from fatigue.flexbody.elements.triangle import triangle_stiffness
from fatigue.gauges.element_row import element_frames
from tests.small_case import small_case

E, NU, T = 70000.0, 0.3, 2.0
STRAIN = 1e-4  # of mode 1 in element 1
FACE_STRAIN = 2e-4  # of mode 2 at the top face
SHEAR = 3e-4  # of mode 7, g_xy
COMPONENTS = ["fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"]
NODES = {
    **{i + 1: (20.0 * i, 1000.0, 0.0) for i in range(5)},
    **{i + 11: (20.0 * i, 1010.0, 0.0) for i in range(5)},
    21: (100.0, 1000.0, 0.0),
    31: (0.0, 1000.0, 10.0),
    32: (20.0, 1000.0, 10.0),
}
ELEMENTS = {  # id: corners, property
    101: ((1, 2, 12, 11), 1),
    102: ((2, 3, 13, 12), 1),
    103: ((3, 4, 14, 13), 1),
    104: ((5, 15, 14, 4), 1),  # its own x runs along y
    105: ((5, 21, 15), 1),
    106: ((1, 2, 32, 31), 1),  # upright, normal -y
    107: ((11, 12, 2, 1), 2),  # a sandwich over element 101, its normal down
}
PLATES = (101, 102, 103, 104, 105)


@dataclass
class GaugeCase:
    """Tables of a case with gauges before they are written; a test changes what it wants to see refused."""

    gauges: str
    forces: pd.DataFrame
    elements: pd.DataFrame
    properties: pd.DataFrame | None
    body: dict = field(default_factory=dict)
    case: object = None

    def write(self, folder):
        """Write all files; returns the path of the case and that of the gauges."""
        folder.mkdir(parents=True, exist_ok=True)
        nodes = pd.DataFrame([(n, *at) for n, at in NODES.items()], columns=["node", "x_mm", "y_mm", "z_mm"])
        on_welds = self.case.weld_nodes[["node", "x_mm", "y_mm", "z_mm"]]
        pd.concat([nodes, on_welds]).to_csv(folder / "nodes.csv", index=False)
        self.elements.to_csv(folder / "elements.csv", index=False)
        self.forces.to_csv(folder / "gauge_forces.csv", index=False)
        self.case.body |= {"nodes": "nodes.csv", "elements": "elements.csv", "gauge_forces": "gauge_forces.csv"}
        if self.properties is not None:
            self.properties.to_csv(folder / "properties.csv", index=False)
            self.case.body |= {"properties": "properties.csv"}
        self.case.body |= self.body
        path = self.case.write(folder)
        table = folder / "gauges.csv"
        table.write_text(self.gauges, encoding="utf-8")
        return path, table


def gauge_case(gauges, seconds=4.0):
    """A case with these lines as its table of gauges."""
    rows = [(e, *ids, *[np.nan] * (4 - len(ids)), pid, T) for e, (ids, pid) in ELEMENTS.items()]
    elements = pd.DataFrame(rows, columns=["element", "n1", "n2", "n3", "n4", "pid", "thickness_mm"])
    properties = pd.DataFrame(
        {"pid": [1, 2], "E_MPa": E, "nu": NU, "thickness_mm": T, "bending_thickness_mm": [T, 30.0], "rho_t_mm3": 0.0}
    )
    return GaugeCase(gauges, pd.concat(map(_forces, PLATES)), elements, properties, case=small_case(seconds))


def _forces(element):
    """Element forces of all modes on one element, in global axes."""
    ids, _ = ELEMENTS[element]
    nodes = np.array([NODES[n] for n in ids])
    factor = 1.0 + list(PLATES).index(element)
    fields = {
        1: (factor * STRAIN * np.array([1.0, -NU, 0.0]), np.zeros(3)),
        2: (np.zeros(3), FACE_STRAIN / (T / 2) * np.array([1.0, -NU, 0.0])),
        7: (np.array([0.0, 0.0, SHEAR]), np.zeros(3)),
    }
    one = np.ones(1)
    stiffness = quad_stiffness if len(ids) == 4 else triangle_stiffness
    K = stiffness(nodes[None], Section(T * one, T * one, E * one, NU * one, 0 * one, 0 * one))[0]
    rows = []
    for mode, (strain, curvature) in fields.items():
        force = (K @ displaced(nodes, strain, curvature, np.eye(3))).reshape(len(ids), 6)
        table = pd.DataFrame(force, columns=COMPONENTS)
        rows.append(table.assign(mode=mode, node=ids, element=element))
    return pd.concat(rows)


def displaced(nodes, strain, curvature, axes=None):
    """Displacements (6 n,) of a linear field: strains e_xx, e_yy, g_xy of the mid-surface, and of their curvatures.

    Strains are those in ``axes``, by default of the element; at a height z they are strain + z curvature.
    """
    axes = element_frames(nodes).axes if axes is None else axes
    x, y = ((nodes - nodes.mean(axis=0)) @ axes[:2].T).T
    exx, eyy, gxy = strain
    kxx, kyy, kxy = curvature
    local = np.zeros((len(x), 6))
    local[:, 0], local[:, 1] = exx * x + 0.5 * gxy * y, 0.5 * gxy * x + eyy * y
    local[:, 2] = -0.5 * (kxx * x**2 + kyy * y**2 + kxy * x * y)
    local[:, 3], local[:, 4] = -(kyy * y + 0.5 * kxy * x), kxx * x + 0.5 * kxy * y  # rx = dw/dy, ry = -dw/dx
    turn = np.zeros((6, 6))
    turn[:3, :3] = turn[3:, 3:] = axes
    return (local @ turn).ravel()
