"""Stress beside the roof bracket of the shipped car body: ``python -m tests.carbody_stresses`` writes its tables again.

The forces of all modes on the elements along the bracket are in ``tests/data``, from the run that gave the forces of
the body. The stiffness of an element has a pseudoinverse, so that these forces tell the nodal displacements but for a
rigid motion, and so all strains. The stress is that of the element's own field, on its middle line across the weld.
"""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from fatigue.flexbody.elements.bilinear import GAUSS, gradient, quad_axes
from fatigue.flexbody.elements.quad import curvature, plane_strain_matrix
from tests.carbody_loads import FOLDER, car_body

DATA = FOLDER.parents[1] / "tests" / "data"
STRESS = ["sx_MPa", "sy_MPa", "txy_MPa"]
FORCES = ["fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"]
SIDES = {"W1_roof_bracket_neg": -1.0, "W1_roof_bracket_pos": 1.0}  # and where the plate is along x
HOT_SPOTS_MM = (300.0, 325.0, 500.0, 675.0)  # where the element of a point begins along the weld, y
HAZ_MM = (300.0, 500.0)
THICKNESS = 12.0  # of the pad
BESIDE = 12.5  # [mm] of a point in the heat-affected zone from the toe: the middle of an element
COARSE = (0.5 * THICKNESS, 1.5 * THICKNESS)  # read-outs of type a; the mesh of 25 mm is twice as coarse as it should be


@dataclass
class Plate:
    """One element of the pad: corners (4, 3) and nodal displacements (24, m) of each mode, but for a rigid motion."""

    corners: np.ndarray
    u: np.ndarray
    E: float
    nu: float

    def stress(self, place, surface):
        """Stress sx, sy, txy (3, m) [MPa] at a place [mm] in its plane, in global x and y, at z = +-t/2."""
        axes = quad_axes(self.corners[None])[0]
        assert np.allclose(np.abs(axes[2]), [0.0, 0.0, 1.0])
        xy = (self.corners - self.corners.mean(axis=0)) @ axes[:2].T
        local = np.einsum("ij,bnjm->bnim", axes, self.u.reshape(4, 2, 3, -1)).reshape(24, -1)
        dofs = local.reshape(4, 6, -1)
        half = np.ptp(xy, axis=0) / 2.0
        xi, eta = ((place - self.corners.mean(axis=0)) @ axes[:2].T) / half
        D = self.E / (1 - self.nu**2) * np.array([[1, self.nu, 0], [self.nu, 1, 0], [0, 0, (1 - self.nu) / 2]])
        membrane = D @ plane_strain(xy[None], dofs[:, :2].reshape(8, -1), D, xi, eta)
        z = THICKNESS / 2.0 * (1.0 if surface == "top" else -1.0) * np.sign(axes[2, 2])
        bending = z * D @ (curvature(xy[None], xi, eta)[0][0] @ dofs[:, 2:5].reshape(12, -1))
        return turned(membrane + bending, axes[:2, :2])


def plane_strain(xy, u, D, xi, eta):
    """Strain (3, m) of the bilinear quad with its incompatible modes, which follow from the displacements (8, m)."""
    J0 = gradient(xy, 0.0, 0.0)[1]
    L = Q = 0.0
    for at in GAUSS:
        dN, J = gradient(xy, *at)
        B, C = plane_strain_matrix(dN), plane_strain_matrix(bubbles(J0, J, *at))
        weight = np.linalg.det(J)[:, None, None]
        L, Q = L + C.swapaxes(1, 2) @ D @ B * weight, Q + C.swapaxes(1, 2) @ D @ C * weight
    alpha = -np.linalg.solve(Q, L)[0] @ u
    dN, J = gradient(xy, xi, eta)
    C = plane_strain_matrix(bubbles(J0, J, xi, eta))
    return plane_strain_matrix(dN)[0] @ u + C[0] @ alpha


def bubbles(J0, J, xi, eta):
    """Gradient (e, 2, 2) of the incompatible modes 1 - xi^2 and 1 - eta^2."""
    modes = np.broadcast_to(np.diag([-2 * xi, -2 * eta]), (len(J), 2, 2))
    return np.linalg.solve(J0, modes) * (np.linalg.det(J0) / np.linalg.det(J))[:, None, None]


def turned(stress, axes):
    """Stress (3, m) in element axes, rows of (2, 2), as stress in global x and y."""
    s = np.stack([stress[[0, 2]], stress[[2, 1]]])
    s = np.einsum("ki,klm,lj->ijm", axes, s, axes)
    return np.stack([s[0, 0], s[1, 1], s[0, 1]])


def plates():
    """Elements of the pad along both sides of the bracket, by weld and place along it [mm]; and ids of the modes."""
    body = car_body()
    forces = pd.read_parquet(DATA / "carbody_element_forces.parquet").sort_values(["element", "node", "mode"])
    sides = pd.read_csv(DATA / "carbody_weld_elements.csv")
    found = {}
    for weld in SIDES:
        for element in sides.loc[sides["weld"] == weld, "element"]:
            k = int(np.searchsorted(body.element, element))
            of_element = forces[forces["element"] == element].set_index("node")
            f = np.stack([of_element.loc[node, FORCES].to_numpy(float).T for node in body.node[body.model.quads[k]]])
            u = np.linalg.pinv(body.model.stiffness[k], rcond=1e-9) @ f.reshape(24, -1)
            corners = body.model.xyz[body.model.quads[k]].astype(float)
            found[weld, float(corners[:, 1].min())] = Plate(corners, u, body.model.E, body.model.nu)
    return found, np.unique(forces["mode"])


def tables():
    """The tables ``stress_points`` and ``modal_stresses`` of the example."""
    found, modes = plates()
    points, rows = [], []
    for (weld, y), plate in found.items():
        out, name = np.array([SIDES[weld], 0.0, 0.0]), f"{weld.removeprefix('W1_roof_bracket_')}_{y:.0f}"
        line = plate.corners[:, 0].max() if SIDES[weld] < 0.0 else plate.corners[:, 0].min()
        toe = np.array([line, plate.corners[:, 1].mean(), plate.corners[0, 2]])
        if y in HOT_SPOTS_MM:
            points.append([f"toe_{name}", "hot_spot_a", weld, *toe, THICKNESS, *out, 0.0, 0.0, 1.0, "hot_spot"])
            rows.append(read(plate, f"toe_{name}", toe, out, COARSE, ("top",), modes))
        if y in HAZ_MM:
            at = toe + BESIDE * out
            points.append([f"haz_{name}", "haz", weld, *at, THICKNESS, *out, 0.0, 0.0, 1.0, "plate"])
            rows.append(read(plate, f"haz_{name}", toe, out, (BESIDE,), ("top", "bottom"), modes))
    columns = ["point", "kind", "weld", "x_mm", "y_mm", "z_mm", "thickness_mm", "e1_x", "e1_y", "e1_z"]
    columns += ["normal_x", "normal_y", "normal_z", "curve"]
    return pd.DataFrame(points, columns=columns), pd.concat(rows, ignore_index=True)


def read(plate, point, toe, out, distances, surfaces, modes):
    """Rows of ``modal_stresses`` of a point, read at some distances from the toe.

    With x against the global one y is, too, so that sx, sy and txy keep their signs.
    """
    rows = []
    for number, distance in enumerate(distances, 1):
        for surface in surfaces:
            keys = {"point": point, "read_out": number, "distance_mm": distance, "mode": modes, "surface": surface}
            rows.append(
                pd.DataFrame(keys | dict(zip(STRESS, plate.stress(toe + distance * out, surface), strict=True)))
            )
    return pd.concat(rows)


if __name__ == "__main__":
    stress_points, modal_stresses = tables()
    stress_points.to_csv(FOLDER / "stress_points.csv", index=False, lineterminator="\n")
    modal_stresses[STRESS] = modal_stresses[STRESS].astype(np.float32)
    modal_stresses.to_parquet(FOLDER / "modal_stresses.parquet", index=False, compression="zstd")
