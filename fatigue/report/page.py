"""The report: one HTML page that needs nothing but itself, made from a finished result folder."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jinja2
import numpy as np
import pandas as pd
import plotly.graph_objects as go
from markupsafe import Markup
from numpy.typing import NDArray
from plotly.offline import get_plotlyjs

from fatigue.errors import DataError, Problem
from fatigue.life.curves import Survival, damage_law
from fatigue.report import figures, method, tables, wording
from fatigue.report.details import Detail, weld_details
from fatigue.report.embed import Figures, Shown, embedded, packed
from fatigue.report.figures.scene import Body
from fatigue.report.inputs import Inputs, find_inputs
from fatigue.report.result import Result, read_result
from fatigue.report.tables import Cell, Heading, Table
from fatigue.report.variants import Assumptions, assumptions_of, damage_per_km, variants
from fatigue.report.why import Why, band_shares, exponents, mode_shares, read_why

PROBED = ("arc_length_mm", "life_km", "load_factor", "dirlik_ratio", "max_range_MPa")
MOST_DETAILED = 40  # welds with their own page of figures; the others have their rows and their lines
WORST_POINTS = 50


@dataclass(frozen=True, slots=True)
class WeldPage:
    """One weld in detail."""

    id: str
    name: str
    row: Mapping[str, Any]
    facts: list[tuple[str, str]]
    along: Shown
    point: list[Shown]
    variants: Table
    events: Table
    levers: Table | None
    reasons: list[tuple[str, str, str]]
    exponents: Mapping[str, float]


def write_report(folder: Path, case_path: Path | None = None) -> Path:
    """Write ``report.html`` beside the tables of a finished result.

    Histories, for stress excerpts and spectra, and the mesh are read from the inputs of the result, which are found by
    the case file and checked by their hashes; what is gone or has changed is left out of the page, with the reason.
    The same result and inputs give the same bytes.

    Raises
    ------
    DataError : no finished result in the folder
    """
    path = folder / "report.html"
    path.write_text(report_page(folder, case_path), encoding="utf-8", newline="\n")
    return path


def report_page(folder: Path, case_path: Path | None = None) -> str:
    """Return the page as text; see `write_report`."""
    result = read_result(folder, MOST_DETAILED)
    inputs = find_inputs(result.record, folder, case_path)
    missing: list[Problem] = []
    details, steps = _details(result, inputs, missing)
    body = _body(inputs, missing)
    why = read_why(folder, result)

    links = {weld: f"weld-{i}" for i, weld in enumerate(result.detailed, start=1)}
    figs = Figures()
    stations = figures.worst_faces(result.nodes)
    closed = frozenset(result.welds.loc[result.welds["closed"] & (result.welds["parts"] == 1), "weld"])
    rows = figures.line_rows(stations, closed)
    assessed = result.welds[result.welds["status"] == "assessed"]
    context = {
        "title": result.record["title"],
        "record": result.record,
        "missing": missing,
        "head": _head(result),
        "weld_lives": figs.add(
            "lives",
            figures.weld_lives(assessed, result.target_km),
            "Life of the worst point of each weld against the target" + _of_all(len(assessed), 30, "welds"),
        ),
        "worst_welds": tables.weld_table(result.welds, links),
        "worst_ten": tables.point_table(result.nodes, links, 10, "worst-ten"),
        "assumptions": method.assumptions(result.record),
        "warnings": _warnings(result),
        "scene": figs.add(
            "scene",
            figures.scene(stations, rows, result.target_km, body),
            "All weld lines, coloured by the shorter life of the toe faces",
        ),
        "projections": figs.add(
            "views",
            figures.projections(stations, rows, result.target_km, body),
            "Side view and plan of the weld lines, coloured by life",
        ),
        "points": _probe(stations, rows, result, links),
        "strips": figs.add(
            "strips",
            figures.weld_strips(result.nodes, result.target_km),
            "Every weld line unrolled, coloured by life" + _of_all(len(assessed), 60, "welds"),
        ),
        "events_figure": figs.add(
            "events-of-welds", _events_figure(result), "Share of each event in the damage of the worst points"
        ),
        "bands": _bands_figure(result, why, figs),
        "pages": [_weld_page(result, weld, details.get(weld), why, figs, links[weld]) for weld in result.detailed],
        "undetailed": len(assessed) - len(result.detailed),
        **_domains(result, figs),
        "worst_points": tables.point_table(result.nodes, links, WORST_POINTS, "worst-points", "Find a point"),
        "register": tables.register_table(result.welds, links),
        "events": tables.event_table(result.events, result.record["rules"]["residue"], steps),
        "modes": tables.mode_table(result.record["modes"]),
        "rules": method.rules(result.record),
        "checks": _checks(result),
        "inputs": _inputs_table(result.record),
        "config": embedded(figures.CONFIG),
        "template": embedded(
            json.loads(go.Figure(layout={"template": figures.TEMPLATE}).to_json())["layout"]["template"]
        ),
        "plotly": Markup(get_plotlyjs()),
    }
    return _environment().get_template("report.html").render(context)


def _environment() -> jinja2.Environment:
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("fatigue.report"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {
        "number": wording.number,
        "km": wording.km,
        "years": wording.years,
        "whole": wording.whole,
        "bytes": wording.size,
    }
    environment.globals["source"] = lambda name: Markup(environment.loader.get_source(environment, name)[0])  # type: ignore[union-attr]
    return environment


def _details(result: Result, inputs: Inputs, missing: list[Problem]) -> tuple[dict[str, Detail], dict[str, float]]:
    try:
        return weld_details(result, inputs)
    except DataError as error:
        missing += error.problems
        return {}, {}


def _body(inputs: Inputs, missing: list[Problem]) -> Body | None:
    try:
        mesh = inputs.mesh()
    except DataError as error:
        missing += [p for p in error.problems if p.code != "missing_case"]
        return None
    return None if mesh is None else figures.body_outline(mesh.node, mesh.xyz, mesh.corners[:, :4])


def _head(result: Result) -> dict[str, Any]:
    """Collect what the first lines of the page say."""
    welds = result.welds[result.welds["status"] == "assessed"]
    mission = result.record["mission"]
    worst = welds.iloc[0]
    missed = int((~welds["fulfilled"].astype(bool)).sum())
    return {
        "fulfilled": missed == 0,
        "missed": missed,
        "welds": len(welds),
        "excluded": len(result.welds) - len(welds),
        "points": int(result.nodes["toe"].sum()),
        "worst": worst,
        "target_km": mission["target_km"],
        "target_years": mission["target_km"] / mission["km_per_year"],
        "km_per_year": mission["km_per_year"],
        "undamaged": not np.isfinite(worst["life_km"]),
    }


def _warnings(result: Result) -> list[tuple[str, list[Mapping[str, str]]]]:
    """Group the warnings by their kind, the order of the kinds as they came."""
    groups: dict[str, list[Mapping[str, str]]] = {}
    for warning in result.record["warnings"]:
        groups.setdefault(warning["code"], []).append(warning)
    return list(groups.items())


def _probe(stations: pd.DataFrame, rows: NDArray[np.int64], result: Result, links: Mapping[str, str]) -> Markup:
    """Data of every station for the scene: what a click shows, and what the lines can be coloured by."""
    drawn = stations.iloc[np.maximum(rows, 0)]  # in drawing order; what stands at the gaps between lines is never asked for
    welds, events = list(result.welds["weld"]), [event["event"] for event in result.events]

    def index(column: str, names: Sequence[str]) -> dict[str, str]:
        place = {name: i for i, name in enumerate(names)}
        return packed(drawn[column].map(place).fillna(len(names)).to_numpy(dtype=np.int64))

    return embedded(
        {
            "node": packed(drawn["node"].to_numpy()),
            "weld": index("weld", welds),
            "event": index("governing_event", events),
            "bottom": packed((drawn["surface"] == "bottom").to_numpy(dtype=np.int64)),
            **{name: packed(drawn[name].to_numpy()) for name in PROBED},
            "welds": welds,
            "events": events,
            "pages": dict(links),
            "target_km": result.target_km,
            "km_per_year": result.record["mission"]["km_per_year"],
            "colours": list(figures.event_colours(events).values()),
        }
    )


def _events_figure(result: Result, most: int = 20) -> go.Figure:
    shares = _event_shares(result).head(most)
    weights = {
        e["event"]: f"{wording.share(e['share'])} of km"
        if e["share"] is not None
        else f"{wording.number(e['per_1000_km'])} in 1000 km"
        for e in result.events
    }
    return figures.damage_by_event(list(shares.index), shares.reset_index(drop=True), weights)


def _event_shares(result: Result) -> pd.DataFrame:
    """Share of each event in the damage of each detailed weld's worst point, welds worst first."""
    weighted = result.damage["damage_per_pass"] * result.damage["event"].map(result.passes_per_km)
    table = result.damage.assign(weighted=weighted).pivot(index="weld", columns="event", values="weighted")
    table = table.loc[list(result.detailed), [event["event"] for event in result.events]]
    total = table.sum(axis=1)
    return table[total > 0.0].div(total[total > 0.0], axis=0)


def _bands_figure(result: Result, why: Why | None, figs: Figures, most: int = 30) -> Shown | None:
    """Map of welds over frequency bands; None without a diagnosis."""
    if why is None:
        return None
    found = {weld: band_shares(why.of_weld(weld)) for weld in result.detailed[:most]}
    found = {weld: bands for weld, bands in found.items() if len(bands) > 1}
    if not found:
        return None
    shares = np.stack([bands["share"].to_numpy() for bands in found.values()])
    fig = figures.bands_of_welds(list(found), np.nan_to_num(shares), next(iter(found.values())))
    return figs.add("bands", fig, "Share of each frequency band in the damage of the worst points")


def _weld_page(result: Result, weld: str, detail: Detail | None, why: Why | None, figs: Figures, id_: str) -> WeldPage:
    row = result.welds.set_index("weld", drop=False).loc[weld]
    point = result.worst(weld)
    points = result.nodes[result.nodes["weld"] == weld]
    cycles = result.cycles[result.cycles["weld"] == weld]
    used = assumptions_of(result.record, row["curve"])
    event = row["governing_event"]
    along = figures.along_weld(
        points,
        result.target_km,
        detail.deviation if detail and detail.deviation else None,
        wording.in_figure(str(event)),
    )
    shown = [figs.add(f"{id_}-along", along, f"{wording.short(weld)}: life, load factor and stress along the weld")]
    if len(cycles) and cycles["range_MPa"].max() > 0.0:
        shown += _cycle_figures(result, weld, cycles, used, figs, id_)
    of_weld = None if why is None else why.of_weld(weld)
    if detail is not None:
        shown += _signal_figures(result, detail, str(event), figs, id_, modes_too=of_weld is None)
    if of_weld is not None:
        shown += _why_figures(result, of_weld, str(event), figs, id_)
    return WeldPage(
        id=id_,
        name=weld,
        row=row.to_dict(),
        facts=_facts(point, row),
        along=shown[0],
        point=shown[1:],
        variants=_variants_table(point, cycles, result, used, id_),
        events=_events_table(result, weld, id_),
        levers=None if of_weld is None or of_weld.levers.empty else _levers_table(of_weld, id_),
        reasons=[]
        if of_weld is None
        else [tuple(row) for row in of_weld.diagnosis[["event", "verdict", "reason"]].to_numpy()],
        exponents={} if of_weld is None else exponents(of_weld),
    )


def _cycle_figures(
    result: Result, weld: str, cycles: pd.DataFrame, used: Assumptions, figs: Figures, id_: str
) -> list[Shown]:
    per_km = (cycles["event"].map(result.passes_per_km) * cycles["count"]).to_numpy(dtype=np.float64)
    laws = {
        level: damage_law(used.curve, _survival(used, level), used.extension, used.knee_cycles)
        for level in used.curve.reference_range
    }
    unit = "MPa mm<sup>−0.222</sup>" if used.curve.applies == "dS" else "MPa"
    name = wording.short(weld)
    return [
        figs.add(
            f"{id_}-matrix",
            figures.rainflow_matrices(cycles, per_km),
            f"{name}: rainflow matrix and damage matrix",
            wide=True,
        ),
        figs.add(
            f"{id_}-exceedance", figures.exceedance(cycles, result.passes_per_km), f"{name}: stress ranges in 1e6 km"
        ),
        figs.add(
            f"{id_}-sn",
            figures.sn_with_spectrum(cycles, per_km * result.target_km, laws, used.survival, unit),
            f"{name}: S-N curve and the cycles of {wording.km(result.target_km)}",
        ),
    ]


def _survival(used: Assumptions, level: str) -> Survival | None:
    return level if used.curve.has_scatter else None  # type: ignore[return-value]


def _signal_figures(
    result: Result, detail: Detail, event: str, figs: Figures, id_: str, *, modes_too: bool
) -> list[Shown]:
    """Figures of the records, none where nothing varies; with the modes' shares of the variance if asked."""
    colours = figures.event_colours([e["event"] for e in result.events])
    names, natural = _mode_names(result.record["modes"])
    shown = []
    if detail.envelope is not None and detail.excerpts:
        history = figures.stress_history(detail.envelope, detail.excerpts, names, colours[event])
        caption = f"Stress in event {wording.short(event)}, and close by at its most damaging cycle"
        shown.append(figs.add(f"{id_}-history", history, caption, wide=True))
    parts: dict[int, float] = {}
    if detail.variance_share is not None and np.isfinite(detail.variance_share).all():
        leading = np.argsort(-np.abs(detail.variance_share), kind="stable")[:8]
        parts = {result.record["modes"]["used"][k]: float(detail.variance_share[k]) for k in leading}
    if parts and modes_too:
        title = f"share of the stress variance in event {wording.in_figure(event)} [%]"
        bars = figures.shares([names[mode] for mode in parts], np.array(list(parts.values())), title)
        shown.append(figs.add(f"{id_}-modes", bars, "Modes in the stress of the worst point"))
    if detail.spectra:
        drawn = sorted(detail.spectra, key=lambda s: s.event != event)[:6]
        marked = {f"mode {m}, {natural[m]:.4g} Hz": (natural[m], part) for m, part in parts.items() if m in natural}
        spectrum = figures.stress_spectrum(drawn, colours, dict(list(marked.items())[:4]), event)
        shown.append(
            figs.add(f"{id_}-psd", spectrum, "Stress spectrum, the leading normal modes, and where the variance lies")
        )
    return shown


def _why_figures(result: Result, why: Why, event: str, figs: Figures, id_: str) -> list[Shown]:
    """Modes, frequency bands and places that make the damage of a weld's worst point."""
    names, natural = _mode_names(result.record["modes"])
    shown = []
    modes = mode_shares(why).head(8)
    if modes["share"].notna().any():
        bars = figures.shares(
            [names[mode] for mode in modes["mode"]], modes["share"].to_numpy(), "share of the damage, all events [%]"
        )
        shown.append(figs.add(f"{id_}-damage-modes", bars, "Damage by mode; a negative share relieves"))
    bands = band_shares(why)
    if len(bands) > 1 and bands["share"].notna().all():
        marked = [natural[mode] for mode in modes["mode"][:4] if mode in natural]
        shown.append(
            figs.add(
                f"{id_}-damage-bands",
                figures.damage_by_band(bands, marked),
                "Damage by frequency band; dotted: leading normal modes",
            )
        )
    track = why.track[why.track["event"] == event]
    if len(track) > 1:
        caption = f"Where in event {wording.short(event)} the damage is made"
        shown.append(figs.add(f"{id_}-track", figures.damage_on_track(track), caption))
    return shown


def _levers_table(why: Why, id_: str) -> Table:
    """Which mode, if 10 % smaller, buys most kilometres."""
    rows = [
        [
            tables.integer(row.mode),
            tables.num(row.frequency_hz),
            Cell(row.kind),
            tables.percent(row.share),
            tables.num(row.life_exponent),
            tables.num(row.life_km_estimated),
            tables.num(row.life_km_counted),
            tables.num(row.gain_km),
        ]
        for row in why.levers.sort_values("rank").itertuples()
    ]
    headings = (
        Heading("mode"),
        Heading("frequency", "Hz"),
        Heading("kind", numeric=False),
        Heading("share of damage", "%"),
        Heading("d ln life / d ln amplitude", "-"),
        Heading("life, estimated", "km"),
        Heading("life, counted again", "km"),
        Heading("gain", "km"),
    )
    return tables.plain_table(f"{id_}-levers", headings, rows)


def _mode_names(modes: Mapping[str, Any]) -> tuple[dict[int, str], dict[int, float]]:
    """Name of every mode, and the natural frequencies [Hz] of the normal ones."""
    names, natural = {}, {}
    for mode, frequency, kind in zip(modes["used"], modes["frequency_hz"], modes["kind"], strict=True):
        names[mode] = f"mode {mode}, {frequency:.4g} Hz" + ("" if kind == "normal" else f", {kind}")
        if kind == "normal" and frequency > 0.0:
            natural[mode] = frequency
    return names, natural


def _facts(point: pd.Series, row: pd.Series) -> list[tuple[str, str]]:
    """Say where the worst point is and what it endures."""
    place = f"{wording.number(point['x_mm'])}, {wording.number(point['y_mm'])}, {wording.number(point['z_mm'])} mm"
    flags = wording.listed([w for w, f in (("weld end", point["at_end"]), ("corner", point["at_corner"])) if f])
    return [
        ("Worst point", f"node {point['node']}, {point['surface']} face, {wording.number(point['arc_length_mm'])} mm along part {point['part']}"),
        ("Position x, y, z", place),
        ("Place", flags or "along the line"),
        ("Plate", f"{wording.number(point['thickness_mm'])} mm"),
        ("Curve", f"{row['curve']}, {row['survival']}"),
        ("Life", f"{wording.km(point['life_km'])} ({wording.years(point['life_years'])})"),
        ("Utilisation (damage)", wording.number(point["utilisation"])),
        ("Utilisation (load)", wording.number(1.0 / point["load_factor"])),
        ("Load factor", wording.number(point["load_factor"])),
        ("Governing event", wording.NOT_AVAILABLE if pd.isna(point["governing_event"]) else str(point["governing_event"])),
        ("Largest range", f"{wording.number(point['max_range_MPa'])} MPa"),
        ("Equivalent range at 2e6", f"{wording.number(point['equivalent_range_2e6_MPa'])} MPa"),
        ("Bending ratio", wording.number(point["bending_ratio"])),
        ("R of the largest cycle", wording.number(point["R_largest_cycle"])),
        ("Mean stress", f"{wording.number(point['mean_stress_MPa'])} MPa"),
        ("Shear / normal stress, rms", wording.number(point["shear_ratio"])),
        ("Life by Dirlik", wording.km(point["life_km_dirlik"])),
        ("Dirlik / rainflow damage", wording.number(point["dirlik_ratio"])),
        ("Verdict on Dirlik", str(point["dirlik_verdict"]).replace("_", " ")),
    ]  # fmt: skip


def _variants_table(point: pd.Series, cycles: pd.DataFrame, result: Result, used: Assumptions, id_: str) -> Table:
    """Life under other assumptions, from the same cycles."""
    per_year = result.record["mission"]["km_per_year"]
    rows = []
    for row in variants(point, cycles, result.passes_per_km, used).itertuples():
        factor = row.damage_factor
        life = np.inf if factor == 0.0 else point["life_km"] / factor
        rows.append(
            [
                Cell(row.assumption),
                Cell(row.choice + (" (used)" if row.used else ""), mark="used" if row.used else ""),
                tables.num(life),
                tables.num(life / per_year),
                tables.num(factor),
            ]
        )
    headings = (
        Heading("assumption", numeric=False),
        Heading("choice", numeric=False),
        Heading("life", "km"),
        Heading("life", "years"),
        Heading("damage factor", "-"),
    )
    return tables.plain_table(f"{id_}-variants", headings, rows)


def _events_table(result: Result, weld: str, id_: str) -> Table:
    """The events at the worst point."""
    of_weld = result.damage[result.damage["weld"] == weld]
    weighted = of_weld["damage_per_pass"] * of_weld["event"].map(result.passes_per_km)
    total = weighted.sum()
    rows = [
        [
            Cell(row.event),
            tables.percent(part / total if total > 0.0 else np.nan),
            tables.num(row.damage_per_pass),
            tables.num(row.max_range_MPa),
            tables.num(row.cycles_per_pass),
            tables.num(row.bending_ratio),
            tables.num(row.damage_dirlik_per_pass / row.damage_same_ratio_per_pass if row.damage_same_ratio_per_pass > 0.0 else np.nan),
            tables.num(row.kurtosis),
            tables.num(row.irregularity),
            tables.num(row.peaks_per_s),
            tables.num(row.samples_per_peak),
        ]
        for row, part in zip(of_weld.itertuples(), weighted, strict=True)
    ]  # fmt: skip
    headings = (
        Heading("event", numeric=False),
        Heading("share of damage", "%"),
        Heading("damage of a pass", "-"),
        Heading("largest range", "MPa"),
        Heading("cycles of a pass", "-"),
        Heading("bending ratio", "-"),
        Heading("Dirlik / rainflow", "-"),
        Heading("kurtosis", "-"),
        Heading("irregularity", "-"),
        Heading("peaks", "1/s"),
        Heading("samples per peak", "-"),
    )
    return tables.plain_table(f"{id_}-events", headings, rows)


def _domains(result: Result, figs: Figures) -> dict[str, Any]:
    """Time against frequency domain at all points."""
    ratio = result.nodes["dirlik_ratio"].to_numpy(dtype=np.float64)
    ratio = ratio[np.isfinite(ratio) & (ratio > 0.0)]
    if not len(ratio):
        return {"scatter": None, "histogram": None, "ratio": None, "verdicts": []}
    low, middle, high = np.quantile(ratio, [0.05, 0.5, 0.95])
    verdicts = result.nodes["dirlik_verdict"].value_counts()
    return {
        "scatter": figs.add("domains", figures.time_against_frequency(result.nodes), "Life by Dirlik against life by rainflow, both with one bending ratio, all points"),
        "histogram": figs.add("ratios", figures.ratio_histogram(result.nodes), "Spread of the damage ratio"),
        "ratio": {
            "points": len(ratio), "median": float(middle), "low": float(low), "high": float(high),
            "within": float(np.mean((ratio >= 0.5) & (ratio <= 2.0))), "spread": float(np.log10(ratio).std()),
        },
        "verdicts": [(str(name).replace("_", " "), int(count)) for name, count in verdicts.items()],
    }  # fmt: skip


def _drawn(result: Result) -> str:
    """Say which points are drawn where there are too many."""
    estimated = int(np.isfinite(result.nodes["dirlik_ratio"].to_numpy(dtype=np.float64)).sum())
    drawn = int(figures.drawn_points(result.nodes).sum())
    if drawn >= estimated:
        return ", all points"
    return f"; {wording.whole(drawn)} of {wording.whole(estimated)} points, those that disagree first"


def _checks(result: Result) -> list[tuple[str, str, bool]]:
    """Recompute on paper what the tables say of the points shown in detail; largest relative difference of each."""
    from_cycles, from_events = [0.0], [0.0]
    for weld in result.detailed:
        point = result.worst(weld)
        if point["damage_per_km"] <= 0.0:
            continue
        curve = result.welds.set_index("weld").loc[weld, "curve"]
        cycles = result.cycles[result.cycles["weld"] == weld]
        again = damage_per_km(cycles, result.passes_per_km, assumptions_of(result.record, curve))
        from_cycles.append(abs(again / point["damage_per_km"] - 1.0))
        of_weld = result.damage[result.damage["weld"] == weld]
        summed = float((of_weld["damage_per_pass"] * of_weld["event"].map(result.passes_per_km)).sum())
        from_events.append(abs(summed / point["damage_per_km"] - 1.0))
    return [
        (
            "damage per km from the listed cycles and the S-N curve",
            wording.number(max(from_cycles)),
            max(from_cycles) < 1e-6,
        ),
        ("damage per km from the damage of every event", wording.number(max(from_events)), max(from_events) < 1e-6),
    ]


def _inputs_table(record: Mapping[str, Any]) -> Table:
    headings = (Heading("file", numeric=False), Heading("size"), Heading("SHA-256", numeric=False))
    rows = [
        [
            Cell(entry["file"]),
            Cell(wording.size(entry["bytes"]), float(entry["bytes"])),
            Cell(entry["sha256"], mark="hash"),
        ]
        for entry in record["inputs"]
    ]
    return tables.plain_table("inputs", headings, rows)


def _of_all(total: int, shown: int, what: str) -> str:
    return f", the {shown} worst of {total} {what}" if total > shown else ""


__all__: Sequence[str] = ["report_page", "write_report"]
