"""The recount as a story: inputs as they were, every line solved anew, points counted anew, table against table."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from fatigue.results import read_provenance, read_table
from fatigue.verify.recount.body import solved_lines
from fatigue.verify.recount.compare import HISTOGRAM_BIN, ColumnCheck, Recount, Row, compare, compare_keys
from fatigue.verify.recount.curve import curve_named
from fatigue.verify.recount.inputs import Inputs, Modes, flags, open_inputs, read_modes, texts
from fatigue.verify.recount.point import Event, MeanStress, OnePass, one_pass, point_of, point_values
from fatigue.verify.recount.record import read_record, spectrum_rules
from fatigue.verify.recount.rows import Key, Station, Weld, cycle_row, damage_row, node_row, stress_rows, weld_row

KEY = ["weld", "part", "order", "surface"]
FACES = {"top": ("top",), "bottom": ("bottom",), "both": ("top", "bottom")}


@dataclass(frozen=True, slots=True, eq=False)
class Stored:
    """The tables of a result by their keys; ``cycles`` by point and event, empty where there are none."""

    nodes: pd.DataFrame
    damage: pd.DataFrame
    stress: pd.DataFrame
    welds: pd.DataFrame
    cycles: Mapping[tuple[Any, ...], pd.DataFrame]
    no_cycles: pd.DataFrame


@dataclass(frozen=True, slots=True, eq=False)
class Passes:
    """One pass of every event at a point, and the damage of each without end treatment."""

    treated: list[OnePass]
    raw_damage: list[float]


def recount(folder: Path, *, sample: int | None = 50, seed: int = 0, case_file: Path | None = None) -> Recount:
    """Recount points of a finished result from its input files, by other code than the one that made it.

    Nothing here imports the line solver, the counting or the spectra of the program: dense matrices, the ``rainflow``
    package, a spectrum of each point's own stress, curves from constants copied a second time.

    Parameters
    ----------
    folder : the result folder
    sample : how many points beside each weld's worst one; None: all
    seed : of the choice of these points
    case_file : the case it was made from; by default where the provenance of the result says

    Raises
    ------
    DataError : no finished result there, or inputs that are missing or changed since
    """
    record = read_provenance(folder)
    inputs = open_inputs(record, folder, case_file)
    modes = read_modes(inputs)
    welds = _welds(inputs, modes, record)
    stations = {
        (solved.line.weld, solved.line.part, int(order)): Station(weld, solved, at)
        for weld in welds.values()
        for solved in weld.parts
        for at, order in enumerate(solved.line.order)
    }
    points: list[Key] = [(*station, surface) for station in stations for surface in ("top", "bottom")]
    events = [event["name"] for event in inputs.case["mission"]["event"]]

    stored = _read_tables(folder)
    checks = [
        compare_keys("nodes", stored.nodes.index, points),
        compare_keys("damage", stored.damage.index, [(*point, event) for point in points for event in events]),
        compare_keys("structural_stress", stored.stress.index, [(*s, int(m)) for s in stations for m in modes.mode]),
        compare_keys("welds", stored.welds.index, list(welds)),
    ]
    if not all(check.passed for check in checks):
        return Recount(folder, 0, len(points), tuple(checks))

    governing = _governing_points(stored, welds)
    chosen = _chosen(stored.nodes, points, governing, sample, seed)
    least = record["rules"]["cycles_kept_from_utilisation"]
    with_cycles = {key for key in governing if stored.welds.loc[key[0], "utilisation"] >= least}
    counted, passes = _count(inputs, modes, {key: stations[key[:3]] for key in chosen}, stored.damage, with_cycles)
    checks += _compared(inputs, modes, welds, stations, stored, counted, passes, with_cycles)
    return Recount(folder, len(counted), len(points), tuple(checks))


def _read_tables(folder: Path) -> Stored:
    tables = {
        name: read_table(folder, name).to_pandas()
        for name in ("nodes", "damage", "structural_stress", "welds", "cycles")
    }
    return Stored(
        nodes=tables["nodes"].set_index(KEY),
        damage=tables["damage"].set_index([*KEY, "event"]),
        stress=tables["structural_stress"].set_index([*KEY[:3], "mode"]),
        welds=tables["welds"].set_index("weld"),
        cycles=dict(tuple(tables["cycles"].groupby([*KEY, "event"]))),
        no_cycles=tables["cycles"][:0],
    )


def _welds(inputs: Inputs, modes: Modes, record: Mapping[str, Any]) -> dict[str, Weld]:
    """Read and solve all welds, in the order of their table."""
    frame = inputs.frame("welds")
    lines = solved_lines(inputs, modes)
    columns = (frame["weld"], flags(frame, "closed"), texts(frame, "surface"), texts(frame, "curve"))
    welds = {}
    for name, closed, given_surface, given_curve in zip(*columns, strict=True):
        surface, curve = given_surface or "both", given_curve or inputs.case["curve"]["name"]
        welds[name] = Weld(
            given={"closed": closed, "surface": surface},
            parts=tuple(solved for solved in lines if solved.line.weld == name),
            curve_name=curve,
            curve=curve_named(curve, inputs.case, record),
            toes=FACES[surface],
        )
    return welds


def _governing_points(stored: Stored, welds: Mapping[str, Weld]) -> set[Key]:
    """Find the points whose cycles are in the table; of a weld without any, the worst point."""
    found = {key[:4] for key in stored.cycles}
    bare = [name for name in welds if name not in {weld for weld, *_ in found}]
    worst = stored.welds.loc[bare, ["worst_part", "worst_order", "worst_surface"]]
    return found | {(name, *row) for name, row in zip(bare, worst.itertuples(index=False), strict=True)}


def _chosen(nodes: pd.DataFrame, points: Sequence[Key], named: set[Key], sample: int | None, seed: int) -> list[Key]:
    """Choose each weld's worst toe point and the named ones, and a random sample of the others."""
    if sample is None:
        return list(points)
    toes = nodes[nodes["toe"]]
    must = named | {key for _, weld in toes.groupby("weld") for key in [weld["utilisation"].idxmax()]}
    others = [point for point in points if point not in must]
    drawn = np.random.default_rng(seed).permutation(len(others))[:sample]
    must |= {others[i] for i in drawn}
    return [point for point in points if point in must]


def _count(
    inputs: Inputs,
    modes: Modes,
    stations: Mapping[Key, Station],
    damage: pd.DataFrame,
    with_cycles: set[Key],
) -> tuple[dict[Key, Passes], list[Event]]:
    """Count every event at every point, one record in memory at a time; keep cycles only where they are compared."""
    asked = inputs.case["curve"]
    mean_stress = MeanStress(asked.get("yield_MPa"), counts=asked.get("mean_stress", "none") == "asme")
    counted = {key: Passes([], []) for key in stations}
    events = []
    for event in inputs.case["mission"]["event"]:
        fastest = damage["peaks_per_s"][damage.index.get_level_values("event") == event["name"]].max()
        record = read_record(inputs, event, modes, 0.0 if np.isnan(fastest) else float(fastest))
        rules = spectrum_rules(inputs.case, modes, record.step)
        for key, station in stations.items():
            solved, at, curve = station.solved, station.at, station.weld.curve
            thickness = float(solved.line.thickness[at])
            one = one_pass(point_of(solved.treated[at], key[3], curve, thickness), record, rules, mean_stress)
            raw = one
            if not np.array_equal(solved.raw[at], solved.treated[at]):
                raw = one_pass(point_of(solved.raw[at], key[3], curve, thickness), record, rules, mean_stress)
            counted[key].treated.append(one if key in with_cycles else replace(one, rows={}))
            counted[key].raw_damage.append(raw.quantities["damage_per_pass"])
        events.append(Event(record.name, record.length_km, record.passes_per_km))
    return counted, events


def _compared(
    inputs: Inputs,
    modes: Modes,
    welds: Mapping[str, Weld],
    stations: Mapping[tuple[str, int, int], Station],
    stored: Stored,
    counted: Mapping[Key, Passes],
    events: Sequence[Event],
    with_cycles: set[Key],
) -> list[ColumnCheck]:
    """Set the recounted rows of all tables beside the stored ones."""
    mission = inputs.case["mission"]
    values = {
        key: point_values(passes.treated, passes.raw_damage, events, mission, stations[key[:3]].weld.curve)
        for key, passes in counted.items()
    }
    nodes: list[Row] = []
    damage: list[Row] = []
    cycles: list[Row] = []
    stress: list[Row] = []
    for key, passes in counted.items():
        found = stored.nodes.loc[key].to_dict()
        nodes.append(node_row(key, stations[key[:3]], values[key], found))
        for event, one in zip(events, passes.treated, strict=True):
            of_event = stored.damage.loc[(*key, event.name)].to_dict()
            damage.append(damage_row(key, event, one, of_event, is_bound=bool(found["screened"])))
            if key in with_cycles:
                cycles.append(cycle_row(key, event, one, stored.cycles.get((*key, event.name), stored.no_cycles)))
    for at in dict.fromkeys(key[:3] for key in counted):
        of_modes = [stored.stress.loc[(*at, mode)].to_dict() for mode in modes.mode.tolist()]
        stress += stress_rows(stations[at], modes.mode, of_modes)
    all_counted = bool((stored.nodes["screened"] == "").all())
    of_welds = [
        weld_row(
            weld,
            {key: values[key] for key in values if key[0] == name},
            stored.welds.loc[name].to_dict(),
            all_counted=all_counted,
        )
        for name, weld in welds.items()
    ]
    bins = {} if all(weld.curve.is_straight for weld in welds.values()) else {"load_factor": HISTOGRAM_BIN}
    return [
        *compare("nodes", nodes, bins),
        *compare("damage", damage, bins),
        *compare("cycles", cycles, bins),
        *compare("structural_stress", stress, bins),
        *compare("welds", of_welds, bins),
    ]
