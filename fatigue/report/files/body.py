"""The shells of the body for ParaView, to stand beside the weld lines: geometry and ids, no field."""

from pathlib import Path

import numpy as np

from fatigue.errors import DataError, Problem, given_path
from fatigue.files.mishaps import refused_writing
from fatigue.report.files.vtp import integer_array, poly_data
from fatigue.report.inputs import find_inputs
from fatigue.results import BODY, enlist, marked, read_provenance


def write_body(folder: Path | str, case_path: Path | str | None = None, into: Path | None = None) -> Path:
    """Write ``body.vtp``: the shell elements of the case by their corners, with ids of nodes and elements.

    ``case_path`` is the case of the result, by default where its provenance says; ``into`` another folder to write to,
    where the file is not listed as a document of the result. Coordinates are those of ``weld_lines.vtp`` [mm].

    Raises
    ------
    DataError : no finished result, no mesh in its case, or mesh or case are not those of the result any more
    """
    folder = given_path(folder, "folder")
    record = read_provenance(folder)
    mesh = find_inputs(record, folder, None if case_path is None else given_path(case_path, "case_path")).mesh()
    if mesh is None or not len(mesh.element):
        what = "the case names no nodes and elements, so there is no body to draw"
        raise DataError(Problem("no_mesh", BODY, what, "Give body.nodes and body.elements in the case, and assess it"))
    corners = mesh.corners[:, :4]
    used = np.unique(corners[corners > 0])
    place = np.searchsorted(used, corners)
    cells = [shell[:3] if three else shell for shell, three in zip(place, corners[:, 3] == 0, strict=True)]
    path = (into or folder) / BODY
    points = [integer_array("node", used)]
    elements = [integer_array("element", mesh.element)]
    with refused_writing(path), path.open("w", encoding="ascii", newline="\n") as file:
        comment = marked(record.get("result", ""))
        xyz = mesh.xyz[np.searchsorted(mesh.node, used)]
        file.writelines(poly_data(xyz, cells, points, cell_data=elements, kind="Polys", comment=comment))
    if into is None:
        enlist(folder, path)
    return path
