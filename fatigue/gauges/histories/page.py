"""The page of virtual gauges: one HTML file that needs nothing but itself, in the look of the report."""

from collections.abc import Sequence

from fatigue.gauges.histories.counts import GaugeSpectra
from fatigue.gauges.histories.figures import EXCERPT_S, MOST_HISTORIES, MOST_SPECTRA, exceedance, excerpts, places
from fatigue.gauges.histories.summary import Histories
from fatigue.gauges.histories.tables import EventRow, GaugeRow
from fatigue.gauges.instrument import MICROSTRAIN
from fatigue.gauges.simulated import Reading
from fatigue.pipeline.solve.body import Body
from fatigue.report.figures.scene import body_outline
from fatigue.report.page_text import page_text
from fatigue.report.rows_table import FILTERED_FROM, MOST_ROWS
from fatigue.report.sections.cells import Cell, Heading, PageTable, num, percent, text
from fatigue.report.sections.embed import Figures

PAGE = "gauges.html"
OF_PLACES = "Gauges on the body, with the direction in which they read."


def histories_page(found: Histories, body: Body, readings: Sequence[Reading], spectra: Sequence[GaugeSpectra]) -> str:
    """Return the page as text: where the gauges are, how sure they are, excerpts, spectra, events."""
    figs = Figures()
    mesh = body.mesh
    outline = None
    if mesh is not None and mesh.element.size:
        outline = body_outline(mesh.node, mesh.xyz, mesh.corners[:, :4])
    lines = [line.xyz for line in body.lines]
    where = figs.add("places", places(found.gauges, lines, outline), OF_PLACES, wide=True, of_curve=False)
    parts = [
        figs.add(f"history-{i}", one, f"{event}: {EXCERPT_S:g} s around the largest swing.", wide=True, of_curve=False)
        for i, (event, one) in enumerate(excerpts(found.gauges, readings))
    ]
    drawn = exceedance(found.gauges, spectra)
    context = {
        "title": found.title,
        "found": found,
        "said": found.said(),
        "where": where,
        "excerpts": parts,
        "most_histories": MOST_HISTORIES,
        "spectrum": drawn and figs.add("exceedance", drawn, _of_spectra(len(found.gauges)), wide=True, of_curve=False),
        "gauges": _gauges(found.gauges),
        "surety": _surety(found.gauges),
        "events": _events(found.events),
        "most_rows": MOST_ROWS,
        "warnings": found.warnings,
    }
    return page_text("fatigue.gauges.histories", "gauges.html", context, figs)


def _of_spectra(gauges: int) -> str:
    which = f"the {MOST_SPECTRA} gauges with the largest ranges" if gauges > MOST_SPECTRA else "every gauge"
    return f"Range spectra of the mission, of {which}."


def _gauges(rows: Sequence[GaugeRow]) -> PageTable:
    headings = (
        _words("gauge"),
        _words("kind"),
        _words("where"),
        _words("face"),
        Heading("x", "mm", numeric=True),
        Heading("y", "mm", numeric=True),
        Heading("z", "mm", numeric=True),
        Heading("angle", "deg", numeric=True),
        Heading("grid", "mm", numeric=True),
        Heading("E", "MPa", numeric=True),
        Heading("nu", "-", numeric=True),
    )
    cells = tuple(
        (
            text(row.gauge),
            text(_kind(row)),
            text(_where(row)),
            text(row.surface),
            *(num(value) for value in (row.x_mm, row.y_mm, row.z_mm, row.angle_deg)),
            num(row.grid_length_mm or None),
            num(row.E_MPa),
            num(row.nu),
        )
        for row in rows[:MOST_ROWS]
    )
    return PageTable("gauges-table", headings, cells, "Find a gauge" if len(rows) >= FILTERED_FROM else "")


def _surety(rows: Sequence[GaugeRow]) -> PageTable:
    headings = (
        _words("gauge"),
        Heading("rms", MICROSTRAIN, numeric=True),
        Heading("rms", "MPa", numeric=True),
        Heading("turned by 5°", "-", numeric=True),
        Heading("neighbours", "-", numeric=True),
        Heading("on a neighbour", "-", numeric=True),
        _words("nearest weld"),
        Heading("distance", "mm", numeric=True),
    )
    cells = tuple(
        (
            text(row.gauge),
            num(row.rms_ue),
            num(row.rms_MPa),
            percent(row.angle_sensitivity),
            Cell(str(row.neighbours), float(row.neighbours)),
            percent(row.neighbour_sensitivity),
            text(row.nearest_weld or None),
            num(row.distance_to_weld_mm),
        )
        for row in rows[:MOST_ROWS]
    )
    return PageTable("surety-table", headings, cells, "Find a gauge" if len(rows) >= FILTERED_FROM else "")


def _events(rows: Sequence[EventRow]) -> PageTable:
    headings = (
        _words("gauge"),
        _words("event"),
        Heading("rms", MICROSTRAIN, numeric=True),
        Heading("largest range", MICROSTRAIN, numeric=True),
        Heading("at 1 Hz", MICROSTRAIN, numeric=True),
        Heading("pseudo-damage", "per km", numeric=True),
        Heading("per km of the mission", "", numeric=True),
    )
    cells = tuple(
        (
            text(row.gauge),
            text(row.event),
            num(row.rms_ue),
            num(row.largest_range_ue),
            num(row.equivalent_range_1_hz_ue),
            num(row.pseudo_damage_per_km),
            num(row.pseudo_damage_per_mission_km),
        )
        for row in rows[:MOST_ROWS]
    )
    return PageTable("events-table", headings, cells, "Find a row" if len(rows) >= FILTERED_FROM else "")


def _words(name: str) -> Heading:
    """Head of a column of texts."""
    return Heading(name, numeric=False)


def _kind(row: GaugeRow) -> str:
    return f"{row.kind}, stand-in" if row.stand_in else row.kind


def _where(row: GaugeRow) -> str:
    if row.kind == "element":
        return f"element {row.element}" + (f" and {row.elements - 1} more" if row.elements > 1 else "")
    return row.point if row.kind == "table" else f"{row.weld}, order {row.order}"
