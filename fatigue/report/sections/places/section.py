"""The parts of the page about single places: hot spots, worst first, and every point to be searched."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from markupsafe import Markup
from numpy.typing import NDArray

from fatigue.report import figures
from fatigue.report.hot_spots.of_result import HotSpots, hot_spots
from fatigue.report.result import ShownResult
from fatigue.report.sections.body import DrawnLines
from fatigue.report.sections.cells import Cell, Heading, PageTable, integer, linked, num, text
from fatigue.report.sections.curves import marked
from fatigue.report.sections.embed import embedded
from fatigue.report.sections.places.deflated import deflated
from fatigue.report.sections.tables import EVENT, FACE, LIFE, LIFE_COLUMNS, WELD, place
from fatigue.report.wording import whole

LISTED = 50
ON_PAGE_ONE = 10
_SEARCHED = ("arc_length_mm", "utilisation", "load_factor", "max_range_MPa", "dirlik_ratio")


@dataclass(frozen=True, slots=True)
class Places:
    """What the page shows of single places.

    ``found`` is how many hot spots the drawn welds have, ``points`` how many points can be searched; ``data`` are these
    in columns.
    """

    worst_ten: PageTable
    worst: PageTable
    found: int
    points: int
    data: Markup


def places(result: ShownResult, lines: DrawnLines, links: Mapping[str, str], unverified: Sequence[str]) -> Places:
    """Hot spots and points of the drawn welds; ``lines`` as the figure in space has them."""
    found = hot_spots(result.nodes, result.assessed)
    return Places(
        worst_ten=marked(hot_spot_table(found.table.head(ON_PAGE_ONE), links, "worst-ten"), unverified),
        worst=marked(hot_spot_table(found.table.head(LISTED), links, "hot-spots", "Find a hot spot"), unverified),
        found=len(found.table),
        points=len(result.nodes),
        data=_searched(result, lines, found, links, unverified),
    )


def hot_spot_table(spots: pd.DataFrame, links: Mapping[str, str], id_: str, label: str = "") -> PageTable:
    """Hot spots, worst first, with the columns of ``HOT_SPOTS``: where each is, how far it reaches, its worst point."""
    rows = tuple(
        (
            integer(row.hot_spot),
            linked(row.weld, links),
            text(row.surface),
            Cell(extent(row.from_mm, row.to_mm), float(row.from_mm)),
            integer(row.node),
            *(cell(getattr(row, name)) for name, cell in LIFE_COLUMNS.items()),
            text(row.governing_event),
            num(row.max_range_MPa),
            num(row.equivalent_range_2e6_MPa),
            num(row.dirlik_ratio),
            text(place(row)),
        )
        for row in spots.itertuples()
    )
    headings = (
        Heading("hot spot"),
        WELD,
        FACE,
        Heading("along the line", "mm"),
        Heading("worst node"),
        *LIFE,
        EVENT,
        Heading("largest range", "MPa"),
        Heading("equiv. range at 2e6", "MPa"),
        Heading("Dirlik / rainflow damage", "-"),
        Heading("place", numeric=False),
    )
    return PageTable(id_, headings, rows, label)


def extent(from_mm: float, to_mm: float) -> str:
    """Where a stretch lies, in whole millimetres: ``25 – 375``, ``0`` of a single station."""
    begin, end = whole(round(from_mm)), whole(round(to_mm))
    return begin if begin == end else f"{begin} – {end}"


def _searched(
    result: ShownResult, lines: DrawnLines, found: HotSpots, links: Mapping[str, str], unverified: Sequence[str]
) -> Markup:
    """All points of the drawn welds in columns, and which of them the figure in space draws, in its order."""
    points, welds, events = result.nodes, list(result.drawn), list(result.passes_per_km)
    is_worst = np.zeros(len(points), dtype=bool)
    is_worst[found.worst_row] = True
    flags = {
        1: points["surface"] == "bottom",
        2: ~points["toe"],
        4: points["screened"].fillna("") != "",
        8: is_worst,
        16: points["at_end"],
        32: points["at_corner"],
    }
    rows = np.maximum.accumulate(np.where(lines.rows < 0, -1, np.arange(len(lines.rows))))  # a gap: the row before it
    drawn = lines.of_nodes[lines.rows[rows]]
    columns = {
        "weld": _index(points["weld"], welds),
        "event": _index(points["governing_event"], events),
        "node": points["node"].to_numpy(),
        "hot_spot": found.of_row,
        "flags": sum(bit * np.asarray(flag, dtype=np.int64) for bit, flag in flags.items()),
        **{name: points[name].to_numpy(dtype=np.float64) for name in _SEARCHED},
        "drawn_steps": np.diff(drawn, prepend=0),  # steps take less than rows
    }
    return embedded(
        {
            **deflated(columns),
            "welds": welds,
            "events": events,
            "colours": list(figures.event_colours(events).values()),
            "pages": dict(links),
            "unverified": list(unverified),
            "target_km": result.target_km,
            "km_per_year": result.record["mission"]["km_per_year"],
        }
    )


def _index(texts: "pd.Series[str]", names: Sequence[str]) -> NDArray[np.int64]:
    """Place of each text among the names; their number where it is none of them."""
    code = pd.Index(names).get_indexer(texts)
    return np.where(code < 0, len(names), code)
