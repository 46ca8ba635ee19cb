"""Weld maps of two variants beside each other: where each of them lives for how many km."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
import plotly.graph_objects as go

from fatigue.case import load_case
from fatigue.errors import FatigueError
from fatigue.report.figures import BodyOutline, body_outline, line_rows, projections, worst_faces
from fatigue.readers.neutral import read_mesh
from fatigue.results import read_table
from fatigue.study.page.chosen import facing
from fatigue.study.page.studied import Studied
from fatigue.study.quantities import StudyRun, Variant

CASE, RESULT = "case.toml", "result"
MOST_EDGES = 6000  # of the outline of the body: of a finer mesh the weld lines alone are drawn


@dataclass(frozen=True, slots=True, eq=False)
class WeldMap:
    """Weld lines of one variant, coloured by life, and the seed they are of."""

    variant: str
    seed: int
    drawn: go.Figure


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
            maps = [_map(one, run) for one, run in zip(pair, both, strict=True) if run is not None]
            return [one for one in maps if one is not None] if all(maps) else []
    return []
