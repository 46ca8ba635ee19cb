"""Elements of other solvers as shells and solids: how their nodes are ordered, and what their force rows are called."""

import re
from collections.abc import Sequence
from typing import NamedTuple

from fatigue.readers.foreign.fe.model import Shell, Solid


class Form(NamedTuple):
    """A kind of element: its name in force rows, its number of corners, and where its mid-side nodes stand."""

    kind: str
    corners: int
    mids: tuple[int, ...] = ()

    @property
    def is_shell(self) -> bool:
        """Whether it is a shell."""
        return self.kind[:4] in ("QUAD", "TRIA")


_HEXA_MIDS = (8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15)
"""Abaqus and Ansys list the mid-side nodes of the top before those between bottom and top."""
_PENTA_MIDS = (6, 7, 8, 12, 13, 14, 9, 10, 11)

_ABAQUS = (
    (r"S3(R|RS|T|RT)?|STRI3", Form("TRIA3", 3)),
    (r"STRI65", Form("TRIA6", 3, (3, 4, 5))),
    (r"S4(R|RS|RSW|R5|T|RT)?", Form("QUAD4", 4)),
    (r"S8R(5|T)?", Form("QUAD8", 4, (4, 5, 6, 7))),
    (r"(C3D8|SC8R)\w*", Form("HEXA", 8)),
    (r"C3D20\w*", Form("HEXA", 8, _HEXA_MIDS)),
    (r"(C3D6|SC6R)\w*", Form("PENTA", 6)),
    (r"C3D15\w*", Form("PENTA", 6, _PENTA_MIDS)),
    (r"C3D4\w*", Form("TETRA", 4)),
    (r"C3D10\w*", Form("TETRA", 4, (4, 5, 6, 7, 8, 9))),
)


def abaqus_form(name: str) -> Form | None:
    """Form of an Abaqus element type; None for one that is neither shell nor solid."""
    return next((form for pattern, form in _ABAQUS if re.fullmatch(pattern, name.upper())), None)


def element_of(form: Form, element: int, pid: int, nodes: Sequence[int]) -> Shell | Solid:
    """Shell or solid of a form, from its nodes as the solver lists them."""
    corners, mids = tuple(nodes[: form.corners]), tuple(nodes[k] for k in form.mids)
    return Shell(element, pid, corners, mids) if form.is_shell else Solid(element, pid, corners, mids)
