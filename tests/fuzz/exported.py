"""Text of the export scripts for Abaqus and ANSYS, and the decks beside it."""

import numpy as np

from fatigue.readers.foreign.fe.results import FeResults
from tests.readers.foreign.ansys.macro_writer import archive, macro_text

ABAQUS_DECK = """*Heading
*Node
1, 0., 0., 0.
2, 10., 0., 0.
3, 10., 10., 0.
4, 0., 10., 0.
5, 20., 5., 2.
*Element, type=S4R, elset=plate
7, 1, 2, 3, 4
*Element, type=S3, elset=wall
8, 2, 5, 3
*Shell Section, elset=plate, material=steel, offset=SPOS
8., 5
*Shell Section, elset=wall, material=steel
6., 5
"""


def abaqus_text(run: FeResults) -> bytes:
    """Text of the script for Abaqus, of the shells of a run."""
    rows = np.flatnonzero(run.of_element)
    nodes = np.unique(run.node[rows])
    lines = ["fatigue export 1 Abaqus 2023", f"*nodes 4 {nodes.size}"]
    lines += [f"{n} {n}.0 {n * n}.0 0.0" for n in nodes.tolist()]
    lines += ["*sections 3 1", "1 8.000000000e+00 0.000000000e+00"]
    for element in np.unique(run.element[rows]).tolist():
        own = run.node[rows][run.element[rows] == element].tolist()
        kind = {3: "S3", 4: "S4R"}[len(own)]
        lines += [f"*elements {2 + len(own)} 1 {kind}", " ".join(map(str, (element, 1, *own)))]
    for k, mode in enumerate(run.mode.tolist()):
        lines += ["*mode 3 1", f"{mode} {run.frequency[k]:.9e} {1.0:.9e}", f"*shape 7 {run.shape_node.size}"]
        lines += [f"{n} " + " ".join(f"{x:.9e}" for x in u) for n, u in zip(run.shape_node, run.shape[k], strict=True)]
        lines.append(f"*forces 8 {rows.size}")
        lines += [
            f"{run.element[r]} {run.node[r]} " + " ".join(f"{x:.9e}" for x in run.force[k, r]) for r in rows.tolist()
        ]
    return ("\n".join([*lines, "*end"]) + "\n").encode()


def ansys_text(run: FeResults) -> bytes:
    """Text of the macro for ANSYS, of the shells of a run; a triangle repeats its last node."""
    rows = np.flatnonzero(run.of_element)
    shells = []
    for element in np.unique(run.element[rows]).tolist():
        own = run.node[rows][run.element[rows] == element].tolist()
        shells.append((element, [*own, *own[-1:] * (4 - len(own))]))
    pairs = list(zip(run.element[rows].tolist(), run.node[rows].tolist(), strict=True))
    modes = [
        (int(mode), float(run.frequency[k]), run.shape_node.tolist(), run.shape[k], pairs, run.force[k, rows])
        for k, mode in enumerate(run.mode)
    ]
    return macro_text({181: shells}, modes).encode()


ANSYS_ARCHIVE = archive(
    [[0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0], [20, 5, 2]],
    [(1, 1, 1, 7, [1, 2, 3, 4]), (1, 1, 2, 8, [2, 5, 3, 3])],
    {1: 181},
    ("SECTYPE,1,SHELL,,plate", "SECOFFSET,TOP", "SECDATA,8.0,1,0.0,3", "SECTYPE,2,SHELL,,wall", "SECDATA,6.0,1,0.0,3"),
    [("WELD", [1, -5])],
)
