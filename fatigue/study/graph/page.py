"""The page of an analysis graph: one HTML file that needs nothing but itself, in the look of the report."""

import math
from collections.abc import Sequence
from typing import Any

from fatigue.report.page_text import page_text
from fatigue.report.sections.cells import Cell, Heading, PageTable, num, text
from fatigue.report.sections.embed import Figures, Shown
from fatigue.study.graph.asks import asks_table
from fatigue.study.graph.figures.along import along_figure
from fatigue.study.graph.figures.colours import WORDS, palette
from fatigue.study.graph.figures.energy import energy_figure, that_cross
from fatigue.study.graph.figures.maps import boundaries_figure, stability_figure
from fatigue.study.graph.figures.plane import plane_figure
from fatigue.study.graph.line import Line
from fatigue.study.graph.summary import Graph, ranges_of, value_of
from fatigue.study.graph.vehicle_graph import VehicleGraph
from fatigue.study.vehicle_keys import KEYS, OF_SETTING
from fatigue.vehicle.settled import settled

PAGE = "graph.html"


def graph_page(found: Graph) -> str:
    """Return the page as text."""
    figs = Figures()
    several = len(found.vehicles) > 1
    compared = _compared(found, figs) if several else None
    context = {
        "title": ", ".join(of.name for of in found.vehicles),
        "key": _key(found),
        "compared": compared,
        "vehicles": [_vehicle(of, figs, number) for number, of in enumerate(found.vehicles, 1)],
        "asks": asks_table(found),
        "parameters": _parameters(found),
    }
    return page_text("fatigue.study", "graph.html", context, figs)


def _key(found: Graph) -> list[dict[str, str]]:
    """The first numbers of the page: range of conicity and what ends it, of one vehicle or of each."""
    rows = []
    for of in found.vehicles:
        numbers = found.numbers[of.name]
        low, high = (numbers[f"conicity_{end}"][0] for end in ("min", "max"))
        hz = numbers["hunting_hz_at_crossing"][0]
        is_none = math.isnan(low)
        rows.append(
            {
                "name": of.name,
                "at": f"{of.vehicle.run.speed_km_h:g} km/h",
                "range": "unstable" if is_none else f"{low:.3g} – {high:.3g}",
                "then": "" if math.isnan(hz) else f"then hunting at {hz:.1f} Hz",
            }
        )
    return rows


def _compared(found: Graph, figs: Figures) -> Shown:
    caption = (
        "Where each vehicle stops being stable, over speed and equivalent conicity. Circles: at the speed of the run, "
        "with the frequency of the root that loses stability there; star: contact of the run."
    )
    return figs.add("boundaries", boundaries_figure(found.vehicles), caption, wide=True, of_curve=False)


def _vehicle(of: VehicleGraph, figs: Figures, number: int) -> dict[str, Any]:
    under = figs.under(f"v{number}-")
    first, speed = of.over_conicity[0], of.over_speed[0]
    crossing = that_cross(first)
    colours = palette((first, speed, *of.lines))
    return {
        "id": f"vehicle-{number}",
        "name": of.name,
        "said": _said(of),
        "map": under.add(
            "map",
            stability_figure(of),
            "Least damping of the roots of car body, bogies and wheelsets. Black: the boundary of stability, with the "
            "frequency of the root that changes there. Star: speed and conicity of the run.",
            wide=True,
            of_curve=False,
        ),
        "own": _crossings((first, speed), f"own-{number}"),
        "ranges": _ranges(of.lines, f"ranges-{number}"),
        "critical": _crossings(of.lines, f"critical-{number}"),
        "along": [
            under.add(
                f"over-{line.along}",
                along_figure(line, own, colours),
                f"Damping and frequency of the roots that {line.along} moves, at {_stays(line)}. "
                "Red: the vehicle is unstable; dotted: its run.",
                of_curve=False,
            )
            for line, own in ((first, of.vehicle.contact.conicity), (speed, of.vehicle.run.speed_km_h))
        ],
        "planes": [
            under.add(
                f"plane-{lines[0].along}",
                plane_figure(lines, colours),
                f"Root loci over {lines[0].along}: points grow with it, some say at which. Left of zero a root grows. "
                "The list above the figure chooses the other lines.",
                of_curve=False,
            )
            for lines in (of.over_conicity, of.over_speed)
        ],
        "energy": under.add(
            "energy",
            energy_figure(first, crossing),
            "Who has the kinetic energy of the roots that lose stability, over conicity. "
            "Dotted: where the vehicle gains or loses stability.",
            wide=True,
            of_curve=False,
        )
        if crossing
        else None,
    }


def _stays(line: Line) -> str:
    return f"{line.at:g} km/h" if line.along == "conicity" else f"a conicity of {line.at:g}"


def _said(of: VehicleGraph) -> list[str]:
    """Sentences about one vehicle."""
    first, speed = of.over_conicity[0], of.over_speed[0]
    return [
        f"At {first.at:g} km/h, the speed of its run, it is stable for {ranges_of(first)}.",
        f"At {speed.at:g}, the conicity of its contact, it is stable for {ranges_of(speed)}.",
    ]


def _crossings(lines: Sequence[Line], id_: str) -> PageTable:
    """Crossings of some lines: which root, how fast, and what the vehicle is from there on."""
    headings = (
        Heading("at", numeric=False),
        Heading("crossing"),
        Heading("from there on", numeric=False),
        Heading("frequency", "Hz"),
        Heading("root", numeric=False),
        Heading("most of its energy", numeric=False),
    )
    rows = []
    for line in lines:
        unit = "" if line.along == "conicity" else " km/h"
        for crossing in line.crossings:
            of_root, hz = crossing.root.of, crossing.root.frequency_hz
            change = "unstable" if crossing.change == "loses" else "stable"
            share = f"{100.0 * of_root.shares[of_root.group]:.0f} % {WORDS[of_root.group]}"
            at = Cell(f"{value_of(line, crossing.at)}{unit}", crossing.at)
            rows.append((Cell(_stays(line)), at, text(change), Cell(f"{hz:.2f}", hz), text(of_root.name), text(share)))
    return PageTable(id_, headings, tuple(rows))


def _ranges(lines: Sequence[Line], id_: str) -> PageTable:
    """Stable ranges of some lines."""
    rows = tuple((Cell(_stays(line)), Cell(ranges_of(line))) for line in lines)
    return PageTable(id_, (Heading("at", numeric=False), Heading("stable for", numeric=False)), rows)


def _parameters(found: Graph) -> PageTable:
    """Values in which the vehicles differ from the reference, or from one another; those of the setting always."""
    settings = [settled(of.vehicle) for of in found.vehicles]
    rows = []
    for table, keys in KEYS.items():
        for name, key in keys.items():
            dotted = f"{table}.{name}"
            values = [getattr(getattr(of.vehicle, table), name) for of in found.vehicles]
            if dotted in OF_SETTING or name == "worn_conicity":
                values = [getattr(setting, name) for setting in settings]
            if dotted in _ALWAYS or len(set(map(str, values))) > 1:
                rows.append((Cell(dotted), *(_cell(value) for value in values), Cell(key.origin), Cell(key.meaning)))
    names = tuple(Heading(of.name) for of in found.vehicles)
    headings = (
        Heading("key", numeric=False),
        *names,
        Heading("origin", numeric=False),
        Heading("what it is", numeric=False),
    )
    return PageTable("parameters", headings, tuple(rows))


_ALWAYS = (*OF_SETTING, "suspension.setting", "run.speed_km_h", "contact.conicity", "car.body", "converter.fe_hz")


def _cell(value: Any) -> Cell:
    if value is None:
        return Cell("–")
    return num(value) if isinstance(value, int | float) else Cell(str(value))
