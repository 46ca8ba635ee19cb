"""Weld maps of two variants beside each other: where each of them lives for how many km."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from fatigue.case import Case, load_case
from fatigue.errors import FatigueError
from fatigue.readers.neutral.body.mesh import read_mesh
from fatigue.report.figures import BodyOutline, body_outline, line_rows, projections, worst_faces
from fatigue.report.figures.drawn import Figure
from fatigue.report.figures.style import drawn_life
from fatigue.results import read_table
from fatigue.study.page.chosen import facing
from fatigue.study.page.studied import Studied
from fatigue.study.quantities import StudyRun, Variant

CASE, RESULT = "case.toml", "result"
NODE_COLUMNS = ["weld", "part", "order", "toe", "utilisation", "x_mm", "y_mm", "z_mm", "life_km"]
SHORTEST_KM = 1e-3  # with which the colour scale may begin
MOST_EDGES = 6000  # of the outline of the body: of a finer mesh the weld lines alone are drawn


@dataclass(frozen=True, slots=True, eq=False)
class WeldMap:
    """Weld lines of one variant, coloured by life, and the seed they are of."""

    variant: str
    seed: int
    drawn: Figure


def weld_maps(of: Studied) -> list[WeldMap]:
    """Maps of the two variants that claims about lives compare, of the first seed under which both are done.

    None where a result is not there or cannot be read: lives stand in the table all the same.
    """
    pair = facing(of)
    if pair is None or of.case is None:
        return []
    runs = {(run.variant, run.seed): run for run in of.runs if run.state == "done"}
    for seed in of.seeds:
        both = [runs.get((one.name, seed)) for one in pair]
        if all(run is not None and (run.folder / RESULT).is_dir() for run in both):
            return _maps([(one, run) for one, run in zip(pair, both, strict=True) if run is not None])
    return []


def _maps(runs: Sequence[tuple[Variant, StudyRun]]) -> list[WeldMap]:
    """Maps of some runs with one colour scale, from the decade of the shortest life of all; none if any is missing."""
    try:
        stations = [worst_faces(read_table(run.folder / RESULT, "nodes", NODE_COLUMNS)) for _, run in runs]
        shortest = min(float(drawn_life(one["life_km"]).min()) for one in stations)
        scaled = 10.0 ** (math.floor(math.log10(max(shortest, SHORTEST_KM))) + 1)
        outline = _outline(load_case(runs[0][1].folder / CASE))
    except (FatigueError, ValueError):  # no station at all has no shortest life
        return []
    drawn = [projections(one, line_rows(one, frozenset()), scaled, outline) for one in stations]
    return [WeldMap(variant.name, run.seed, fig) for (variant, run), fig in zip(runs, drawn, strict=True)]


def _outline(case: Case) -> BodyOutline | None:
    """Outline of the body; None without a mesh, and of one so fine that it would outweigh the page."""
    if case.body.nodes is None or case.body.elements is None:
        return None
    mesh, _ = read_mesh(case.resolve(case.body.nodes), case.resolve(case.body.elements), strict=False)
    outline = body_outline(mesh.node, mesh.xyz, mesh.corners[:, :4])
    return outline if len(outline.edge) <= MOST_EDGES else None
