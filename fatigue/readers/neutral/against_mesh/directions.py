"""Whether a plate lies where normal and outward vector put the assessed one.

With y' out of the assessed plate, square to the line and in the plate, that plate lies in the direction -y' from the
line. The angle about the line between -y' and a shell there is the angle by which the normal is turned against that
shell's, whichever face is called its top. Where a shell lies at y' and none at -y', the outward vector points the wrong
way, and tension is read as compression.
"""

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.neutral.against_mesh.findings import Finding, warnings_of
from fatigue.weld.detection import SMOOTH_DEG
from fatigue.weld.line import LineStack
from fatigue.weld.line_geometry import local_axes, unit

Vectors = NDArray[np.float64]

TURNED = SMOOTH_DEG + 1e-6  # [deg] shells that meet at a smaller angle are one plate, and a normal between them is fine
BESIDE = 0.1  # of its length: an arm along the line tells no direction about it


def astray(lines: LineStack, at: NDArray[np.int64], arm: Vectors, side: str, file: str) -> list[Finding]:
    """Warning of each weld at which no shell lies on the side of the assessed plate.

    Parameters
    ----------
    at : (p,) positions of nodes, ascending
    arm : (p, 3) from these nodes to the middle of shells that touch them
    side : what these shells are called
    """
    axes = local_axes(lines)
    along, y = axes[at, 0], axes[at, 1]
    beside = arm - np.sum(arm * along, axis=1, keepdims=True) * along
    tells = np.linalg.norm(beside, axis=1) > BESIDE * np.linalg.norm(arm, axis=1)
    at, cosine = at[tells], np.sum(unit(beside) * y, axis=1)[tells]
    off, off_if_turned = np.full((2, lines.node.size), np.inf)
    np.minimum.at(off, at, np.degrees(np.arccos(np.clip(-cosine, -1.0, 1.0))))
    np.minimum.at(off_if_turned, at, np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))
    wrong = np.isfinite(off) & (off > TURNED)
    inward = wrong & (off_if_turned <= TURNED)

    def of_outward(worst: int, nodes: NDArray[np.int64]) -> tuple[str, str]:
        what = f"the outward vector points into {side}: it lies where the vector points to, and not behind it"
        return what, "Give a vector from the assessed plate across the line: tension is read as compression now"

    def of_normal(worst: int, nodes: NDArray[np.int64]) -> tuple[str, str]:
        what = (
            f"{side} is turned about the line by {off[worst]:.0f} degrees against the plane that the normal gives "
            f"(more than {SMOOTH_DEG:g})"
        )
        return what, "Check normal_x, normal_y and normal_z: with them stress across the weld is read in another plane"

    return [
        *warnings_of(lines, inward, off, "outward_into_plate", of_outward, file),
        *warnings_of(lines, wrong & ~inward, off, "normal_off_plate", of_normal, file),
    ]
