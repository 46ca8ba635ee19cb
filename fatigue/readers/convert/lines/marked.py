"""Edges of a model that its user marked as welds, by lists of nodes, node sets, plot elements and bars."""

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np

from fatigue.errors import DataError, Problem
from fatigue.readers.convert.lines.surfaces import Surface
from fatigue.readers.convert.options import WeldSources
from fatigue.readers.foreign.fe.model import FeModel
from fatigue.weld.detection import Key


def marked_edges(
    model: FeModel, surfaces: Sequence[Surface], sources: WeldSources, lists: Mapping[str, list[int]]
) -> list[dict[int, Key]]:
    """Marked edges of each surface; an edge of the skin of solids that is one of shells, too, is that of the shells.

    Raises
    ------
    DataError : an unknown set or marker, marks that lie on no edge, neighbouring nodes of a list that no edge joins
    """
    if not (sources.sets or sources.markers or lists):
        return [{} for _ in surfaces]
    index = {int(n): k for k, n in enumerate(model.mesh.node)}
    edge_of: list[dict[tuple[int, int], int]] = []
    for surface in surfaces:
        known = set().union(*edge_of)
        pairs = ((int(a), int(b)) for a, b in surface.topo.ends)
        edge_of.append({pair: k for k, pair in enumerate(pairs) if pair not in known})
    found: list[dict[int, Key]] = [{} for _ in surfaces]
    edges = "shell edge" if model.solids is None else "edge of shells or of the skin of solids"

    def place(a: int, b: int) -> tuple[int, int] | None:
        first, last = sorted((index.get(a, -1), index.get(b, -1)))
        return next(((k, own[first, last]) for k, own in enumerate(edge_of) if (first, last) in own), None)

    def mark(places: Sequence[tuple[int, int]], name: str) -> None:
        for at, edge in places:
            found[at][edge] = (name, ())

    for number in sources.sets:
        if number not in model.node_sets:
            known_sets = ", ".join(str(s) for s in sorted(model.node_sets)) or "none"
            raise DataError(Problem("no_set", model.source, f"there is no SET {number}", f"Sets found: {known_sets}"))
        inside = np.isin(model.mesh.node, model.node_sets[number])
        places = [(k, edge) for k, own in enumerate(edge_of) for (a, b), edge in own.items() if inside[a] and inside[b]]
        if not places:
            raise DataError(Problem("empty_set", model.source, f"no {edges} lies in SET {number}", "Correct the set"))
        mark(places, f"set{number}")
    for name in sources.markers:
        pairs_of = model.marker_edges.get(name.upper(), np.empty((0, 2), np.int64)).tolist()
        places = [at for a, b in pairs_of if (at := place(a, b)) is not None]
        if not places:
            cards = ", ".join(sorted(model.marker_edges)) or "none"
            what = f"no {name.upper()} lies on a{'n' * (edges[0] == 'e')} {edges}"
            raise DataError(Problem("no_marker", model.source, what, f"Line cards found: {cards}"))
        mark(places, name.lower())
    mids = _mid_nodes(surfaces)
    for weld, nodes in lists.items():
        corners = [n for n in nodes if n not in mids]
        for a, b in pairwise(corners):
            at = place(a, b)
            if at is None:
                where = f"{sources.node_lists}, weld {weld}"
                what = f"no {edges} joins the nodes {a} and {b}"
                raise DataError(Problem("no_edge", where, what, "List neighbouring nodes"))
            mark([at], weld)
    return found


def _mid_nodes(surfaces: Sequence[Surface]) -> set[int]:
    """Ids of mid-side nodes."""
    meshes = [surface.topo.mesh for surface in surfaces]
    return {int(n) for mesh in meshes for n in mesh.node[np.unique(mesh.mid[mesh.mid >= 0])]}
