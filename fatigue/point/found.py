"""Which point is meant: one station of a weld line of a finished result, and its two faces."""

import difflib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from numbers import Integral
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from fatigue.errors import CaseError, DataError, Problem, refuse
from fatigue.pipeline.count.worst import EQUAL
from fatigue.results import read_codes, read_rows, read_table, read_welds, rows_of_welds
from fatigue.shown import few, shortened, visible

FACES = ("top", "bottom")
MOST_NAMED = 8  # welds, orders or nodes in a message

_COLUMNS = ("weld", "part", "order", "node", "surface", "toe", "utilisation", "screened", "max_range_MPa")


@dataclass(frozen=True, slots=True)
class Station:
    """A node of a part of a weld line; pairs are of its top and its bottom face.

    Attributes
    ----------
    weld, part, order, node : where it is
    rows : its rows in ``nodes.parquet``
    toe : whether the face carries a weld toe
    screened : whether a bound replaced the count of the face
    utilisation : at the target, or a bound of it
    max_range : largest range of the structural stress in any event [MPa], or a bound of it
    """

    weld: str
    part: int
    order: int
    node: int
    rows: tuple[int, int]
    toe: tuple[bool, bool]
    screened: tuple[bool, bool]
    utilisation: tuple[float, float]
    max_range: tuple[float, float]

    def __str__(self) -> str:
        """Name it in words."""
        return f"weld {visible(shortened(self.weld))}, part {self.part}, order {self.order}, node {self.node}"

    @property
    def worst_face(self) -> int:
        """The face that decides, 0 the top and 1 the bottom: that with a weld toe, of two the more utilised."""
        if self.toe[0] != self.toe[1]:
            return int(self.toe[1])
        return int(self.utilisation[0] < EQUAL * self.utilisation[1])  # of equal ones the top, as the assessment

    def face(self, surface: str | None = None) -> int:
        """Number of a face, 0 of ``top`` and 1 of ``bottom``; None: of the one that decides.

        Raises
        ------
        DataError : no face has this name
        """
        if surface is None:
            return self.worst_face
        if surface not in FACES:
            what = f"there is no face {visible(str(surface))!r}"
            raise DataError(Problem("unknown_point", str(self), what, "Say top or bottom, or leave it out"))
        return FACES.index(surface)


def find_station(
    folder: Path, weld: str, *, order: int | None = None, node: int | None = None, part: int | None = None
) -> Station:
    """The station of a weld at a position along its line or at a node; with neither, that of its worst point.

    A ``part`` is needed only where several of them have it. The tables have to be those of one result, see
    ``finished_result``; of ``nodes.parquet`` no more is read than what may hold the weld.

    Raises
    ------
    DataError : no such weld, part, order or node, or several stations that fit
    CaseError : a part, order or node that is no whole number
    """
    wanted_of = {"part": part, "order": order, "node": node}
    refuse(CaseError, [problem for name, wanted in wanted_of.items() for problem in _no_number(name, wanted)])
    rows = rows_of_welds(folder, "nodes", [str(weld)])[str(weld)]
    if not rows.size:
        raise DataError(_unknown_weld(folder, str(weld)))
    points = read_rows(folder, "nodes", rows, _COLUMNS).to_pandas().assign(row=rows)
    points["screened"] = points["screened"].fillna("") != ""
    found, given = points, ""
    for name, wanted in wanted_of.items():
        if wanted is not None:
            before, found = found, found[found[name] == wanted]
            if found.empty:
                raise DataError(_unknown_place(folder, name, wanted, before, given))
            given += f", {name} {wanted}"
    if order is None and node is None:
        found = _worst(folder, found, of_weld=part is None)
    stations = found.drop_duplicates(["part", "order"])
    if len(stations) > 1:
        raise DataError(_several(stations))
    return _station(found)


def refuse_unknown_weld(folder: Path, weld: str) -> None:
    """Refuse a weld that the result does not have, or has not assessed.

    Raises
    ------
    DataError : in the words of ``find_station``
    """
    welds = read_table(folder, "welds", ["weld", "status"]).to_pandas()
    if str(weld) not in set(welds.loc[welds["status"] == "assessed", "weld"]):
        raise DataError(_unknown_weld(folder, str(weld)))


def _no_number(name: str, wanted: object) -> Iterator[Problem]:
    if wanted is not None and (not isinstance(wanted, Integral) or isinstance(wanted, bool)):
        yield Problem("argument", name, f"{wanted!r} is no {name}", "Give a whole number, as in nodes.parquet")


def _worst(folder: Path, points: pd.DataFrame, *, of_weld: bool) -> pd.DataFrame:
    """Both faces at the worst point of a weld, or of some of its points: a toe that was counted, if there is any."""
    if of_weld:
        welds = read_welds(folder).set_index("weld")
        part, order = welds.loc[points["weld"].iloc[0], ["worst_part", "worst_order"]]
    else:
        ranked = points.sort_values(["toe", "screened", "utilisation"], ascending=[False, True, False], kind="stable")
        part, order = ranked.iloc[0][["part", "order"]]
    return points[(points["part"] == part) & (points["order"] == order)]


def _station(faces: pd.DataFrame) -> Station:
    """Station of the rows of its two faces."""
    top, bottom = faces.set_index("surface").loc[list(FACES)].to_dict("records")

    def pair(name: str) -> tuple[Any, Any]:
        return top[name], bottom[name]

    return Station(
        weld=str(top["weld"]),
        part=int(top["part"]),
        order=int(top["order"]),
        node=int(top["node"]),
        rows=pair("row"),
        toe=pair("toe"),
        screened=pair("screened"),
        utilisation=pair("utilisation"),
        max_range=pair("max_range_MPa"),
    )


def _unknown_weld(folder: Path, weld: str) -> Problem:
    """Refusal of a weld that the result does not have, or has not assessed."""
    welds = read_table(folder, "welds", ["weld", "status", "reason"]).to_pandas()
    listed = welds.loc[welds["weld"] == weld, "reason"].fillna("")
    if len(listed):
        what = f"the weld {_quoted(weld)} was not assessed: {listed.iloc[0] or 'no reason is given'}"
        return Problem("unknown_weld", str(folder), what, "Name a weld that was, or change the register and assess")
    names = welds.loc[welds["status"] == "assessed", "weld"].tolist()
    return Problem("unknown_weld", str(folder), f"the result has no weld {_quoted(weld)}", meant(weld, names))


def meant(name: str, known: Sequence[str]) -> str:
    """Remedy for a name that is not known: those that hold it, the most alike, else the first ones that there are.

    >>> meant("W1-roof", ["W1_roof", "W2_roof"])
    "Name 'W1_roof'"
    """
    wanted = name.casefold()
    holding = [one for one in known if wanted in one.casefold()]
    if len(holding) > 1:
        return f"Name one of {few([_quoted(one) for one in holding], MOST_NAMED)}"
    folded = {one.casefold(): one for one in reversed(known)}
    near = holding or [folded[one] for one in difflib.get_close_matches(wanted, folded, n=1)]
    if near:
        return f"Name {_quoted(near[0])}"
    return f"Name one of {few([_quoted(one) for one in known], MOST_NAMED)}"


def _unknown_place(folder: Path, name: str, wanted: int, among: pd.DataFrame, given: str) -> Problem:
    """Refusal of a part, order or node that some points do not have: those of the weld, and of what else is given."""
    weld = str(among["weld"].iloc[0])
    there = sorted(among[name].unique().tolist())
    numbers = few(there, MOST_NAMED) if name == "node" or len(there) <= MOST_NAMED else f"{there[0]} to {there[-1]}"
    where = f"{folder}: weld {_quoted(weld)}{given}"
    if name == "node" and not given and (others := _welds_with(folder, wanted, weld)):
        what = f"has no node {wanted}, which is of {few([_quoted(one) for one in others])}"
        return Problem("unknown_point", where, what, f"Name that weld, or one of its own nodes: {numbers}")
    return Problem("unknown_point", where, f"has no {name} {wanted}", f"Take one of its {name}s: {numbers}")


def _welds_with(folder: Path, node: int, but: str) -> list[str]:
    """Other welds that have a node."""
    code, names = read_codes(folder, "nodes", "weld")
    at = read_table(folder, "nodes", ["node"])["node"].to_numpy() == node
    return [names[i] for i in np.unique(code[at]) if names[i] != but]


def _several(stations: pd.DataFrame) -> Problem:
    """Refusal of a place that several parts of a weld share: a node is on a line once, and a corner ends two parts."""
    parts, order = few(stations["part"].tolist(), MOST_NAMED), stations["order"].iloc[0]
    what = f"the parts {parts} share the order {order}, at a corner where the line is split"
    return Problem("several_points", f"weld {_quoted(str(stations['weld'].iloc[0]))}", what, f"Give the part: {parts}")


def _quoted(name: str) -> str:
    return f"'{visible(shortened(name))}'"
