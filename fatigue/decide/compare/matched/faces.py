"""Which face of a station is which face of the other: by the normals of both cases, where their files still tell.

Top is the side of the plate normal, and a model may have its normals turned. Where both results read the same weld
tables nothing has turned. Where they did not, the tables are read again, if they are as they were. Otherwise faces of
one name are taken for one face, and every row says so.
"""

from pathlib import PurePosixPath

import numpy as np
from numpy.typing import NDArray

from fatigue.case import load_case
from fatigue.decide.compare.finished import Finished
from fatigue.decide.compare.matched.stations import MatchedStations
from fatigue.errors import FatigueError
from fatigue.files.hashes import sha256
from fatigue.pipeline.solve.body import read_body
from fatigue.readers.neutral.register.weld_register import REGISTER
from fatigue.results import case_of, is_assessed_case

Floats = NDArray[np.float64]
Texts = NDArray[np.object_]

SAME, SWAPPED, ASSUMED = "same", "swapped", "face_assumed"
_LARGE = ("forces", "modal_stresses")  # tables that say nothing of normals and take long to hash


def match_faces(a: Finished, b: Finished, of: MatchedStations) -> tuple[Texts, str]:
    """For every matched station (s,) ``same``, ``swapped`` or ``face_assumed``, and why the last one, in words."""
    if not len(of.first):
        return np.zeros(0, object), ""
    names_a, names_b = (np.array(one.points.names, object)[one.points.weld[one.points.stations]] for one in (a, b))
    keys_a, keys_b = (one.points.order[one.points.stations] for one in (a, b))
    is_same = (names_a[of.first] == names_b[of.second]) & (keys_a[of.first] == keys_b[of.second])
    tables = _weld_tables(a)
    if is_same.all() and tables is not None and tables == _weld_tables(b):
        return np.full(len(of.first), SAME, object), ""
    normals = []
    for one in (a, b):
        found = _normals(one)
        if isinstance(found, str):
            return np.full(len(of.first), ASSUMED, object), f"{one.letter}: {found}"
        normals.append(found)
    cosine = np.einsum("ij,ij->i", normals[0][of.first], normals[1][of.second])
    return np.where(np.isnan(cosine), ASSUMED, np.where(cosine < 0.0, SWAPPED, SAME)).astype(object), ""


def _weld_tables(of: Finished) -> tuple[str | None, ...] | None:
    """SHA-256 of the tables of weld lines, and of the register where there is one, as they were assessed."""
    body = of.case_keys["body"]
    known = {entry["file"]: entry["sha256"] for entry in of.record["inputs"]}
    beside = (PurePosixPath(body["welds"]).parent / REGISTER).as_posix()
    lines = known.get(PurePosixPath(body["weld_nodes"]).as_posix())
    return None if lines is None else (lines, known.get(PurePosixPath(body.get("register", beside)).as_posix()))


def _normals(of: Finished) -> Floats | str:
    """Plate normal at every station (s, 3), NaN where the case has none; or why they are not known."""
    path = case_of(of.record, of.folder)
    if not path.is_file():
        return f"the case {path} is not there any more"
    if not is_assessed_case(of.record, path):
        return f"the case {path} was changed since the assessment"
    try:
        case = load_case(path)
        known = {entry["sha256"] for entry in of.record["inputs"]}
        files = case.input_files().items()
        small = [file for key, file in files if key.startswith("body.") and not key.endswith(_LARGE)]
        if changed := [file.name for file in small if not file.is_file() or sha256(file) not in known]:
            return f"{changed[0]} is not there any more, or was changed since the assessment"
        lines = read_body(case, strict=False).lines
    except FatigueError as error:
        return str(error.problems[0])
    stack = lines.lines(slice(0, len(lines)))
    points, here = of.points, of.points.stations
    number = {name: i for i, name in enumerate(points.names)}
    weld = np.repeat([number.get(name, -1) for name in stack.weld], np.diff(stack.begin))
    return _looked_up(np.stack([weld, stack.order]), np.stack([points.weld[here], points.order[here]]), stack.normal)


def _looked_up(keys: NDArray[np.int64], wanted: NDArray[np.int64], values: Floats) -> Floats:
    """Values (k, 3) of keys (2, k) for wanted keys (2, n); NaN for those that there are not."""
    width = int(max(keys[1].max(initial=0), wanted[1].max(initial=0))) + 1
    low = int(min(keys[1].min(initial=0), wanted[1].min(initial=0)))
    known, asked = (one[0] * (width - low) + one[1] - low for one in (keys, wanted))
    order = np.argsort(known)
    place = np.minimum(np.searchsorted(known[order], asked), max(len(known) - 1, 0))
    found = np.full((wanted.shape[1], 3), np.nan)
    hit = known[order][place] == asked if len(known) else np.zeros(len(asked), np.bool_)
    found[hit] = values[order][place[hit]]
    return found
