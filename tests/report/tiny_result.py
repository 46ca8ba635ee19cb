"""A small, self-consistent result folder, written without the pipeline, with the case and the histories behind it."""

import hashlib
import json
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from fatigue.life.curves import catalogue, damage_law
from fatigue.life.rule import cycle_damage, ratio_factor
from fatigue.results import TABLES, table_writer, write_json

CURVE = "master-aluminium"
MODES = (1, 2, 7)
FREQUENCIES = (8.5, 14.0, 90.0)
STEP = 0.004
SAMPLES = 3000
TARGET_KM, KM_PER_YEAR = 1.2e7, 5.0e5
THICKNESS = 10.0
FACES = ("top", "bottom")


@dataclass(frozen=True)
class Recipe:
    """What the result is made of; ``level`` scales all stress ranges [MPa], 0: nothing damages."""

    welds: tuple[str, ...] = ("W1 bracket", "W2 hanger")
    stations: int = 6
    events: tuple[str, ...] = ("tangent", "curve")
    level: float = 20.0
    title: str = "Trailer car"
    description: str = "toes of the fillet welds"
    closed: bool = False
    toes: str = "both"
    warnings: tuple[dict[str, str], ...] = ()
    spectrum: bool = True
    mesh: bool = False
    curve_status: str = "cross-checked"


def write_result(root: Path, recipe: Recipe = Recipe()) -> Path:
    """Write case and histories to ``root`` and the tables and provenance of their result to ``root/result``."""
    folder = root / "result"
    folder.mkdir(parents=True)
    files = _write_inputs(root, recipe)
    cycles = {
        (w, s, f, e): _cycles(recipe, w, s, f, e)
        for w in range(len(recipe.welds))
        for s in range(recipe.stations)
        for f in range(2)
        for e in range(len(recipe.events))
    }
    passes = _passes_per_km(recipe)
    per_km = {
        (w, s, f): sum(passes[e] * cycles[w, s, f, e]["damage"].sum() for e in range(len(recipe.events)))
        for w, s, f, _ in cycles
    }
    toes = {"top": (True, False), "bottom": (False, True), "both": (True, True)}[recipe.toes]
    worst = [
        max(
            ((s, f) for s in range(recipe.stations) for f in range(2) if toes[f]),
            key=lambda sf, w=w: (per_km[w, sf[0], sf[1]], -sf[0], -sf[1]),
        )
        for w in range(len(recipe.welds))
    ]
    _write(folder, "nodes", _node_rows(recipe, cycles, per_km, passes, toes))
    _write(folder, "damage", _damage_rows(recipe, cycles))
    _write(folder, "cycles", [_cycle_rows(recipe, cycles, w, *at) for w, at in enumerate(worst)])
    _write(folder, "histogram", [_bin_rows(recipe, cycles, w, *at) for w, at in enumerate(worst)])
    _write(folder, "structural_stress", _stress_rows(recipe))
    _write(folder, "welds", _weld_rows(recipe, per_km, passes, cycles, worst))
    write_json(folder / "provenance.json", _provenance(recipe, passes, files))
    return folder


def law():
    """Damage law of the result."""
    return damage_law(catalogue()[CURVE], "mean-2sigma", "none", 1e7)


def _key(recipe, w, s, f):
    return {
        "weld": recipe.welds[w],
        "part": 1,
        "node": 1000 * (w + 1) + s,
        "order": s + 1,
        "surface": FACES[f],
    }


def _cycles(recipe, w, s, f, e):
    """Some cycles of one event at one point; the first station and face of a weld see the largest ranges."""
    decay = 0.8**s * (1.0 if f == 0 else 0.9) * 0.7**w * (1.0 if e == 0 else 0.6)
    ranges = recipe.level * decay * np.array([1.0, 0.8, 0.8, 0.5, 0.2, 0.05])
    r = np.array([0.9, 0.8, 0.7, 0.9, 0.5, 0.2])
    dS = ranges * THICKNESS ** (1.6 / 7.2) / ratio_factor(r)
    return {
        "start_event": [None] * 6,
        "end_event": [None] * 6,
        "start_s": 1.0 + 0.5 * np.arange(6),
        "end_s": 1.2 + 0.5 * np.arange(6),
        "range_MPa": ranges,
        "mean_MPa": np.linspace(-3.0, 3.0, 6),
        "count": np.array([1.0, 1.0, 0.5, 1.0, 1.0, 1.0]),
        "membrane_range_MPa": (1.0 - r) * ranges,
        "bending_range_MPa": r * ranges,
        "bending_ratio": r,
        "equivalent_range_dS": dS,
        "damage": np.array([1.0, 1.0, 0.5, 1.0, 1.0, 1.0]) * cycle_damage(dS, law()),
    }


def _passes_per_km(recipe):
    """Passes of every event per km: equal shares of the mileage at 300 km/h."""
    length = 300.0 / 3600.0 * SAMPLES * STEP
    return np.full(len(recipe.events), 1.0 / len(recipe.events) / length)


def _life(damage, share=1.0):
    return np.inf if damage * share <= 0.0 else 1.0 / (damage * share)


def _factor(utilisation):
    return np.inf if utilisation <= 0.0 else utilisation ** (-1.0 / law().slopes[0])


def _node_rows(recipe, cycles, per_km, passes, toes):
    rows = []
    for (w, s, f), damage in per_km.items():
        of_point = [cycles[w, s, f, e] for e in range(len(recipe.events))]
        utilisation = damage * TARGET_KM
        estimate = recipe.spectrum and damage > 0.0
        rows.append(
            {
                **_key(recipe, w, s, f),
                "toe": toes[f],
                "arc_length_mm": 25.0 * s,
                "x_mm": 1000.0 * w,
                "y_mm": 25.0 * s,
                "z_mm": 2600.0,
                "thickness_mm": THICKNESS,
                "damage_per_km": damage,
                "damage_per_km_transitions": np.nan,
                "damage_per_km_transitions_bound": np.nan,
                "life_km": _life(damage),
                "life_years": _life(damage) / KM_PER_YEAR,
                "utilisation": utilisation,
                "fulfilled": utilisation <= 1.0,
                "load_factor": _factor(utilisation),
                "life_km_dirlik": _life(damage, 1.1) if recipe.spectrum else np.nan,
                "life_km_tb": _life(damage, 1.2) if recipe.spectrum else np.nan,
                "life_km_same_ratio": _life(damage, 0.98) if recipe.spectrum else np.nan,
                "dirlik_ratio": 1.1 / 0.98 if estimate else np.nan,
                "dirlik_verdict": "not_assessed",
                "max_range_MPa": max(c["range_MPa"].max() for c in of_point),
                "equivalent_range_2e6_MPa": 0.4 * recipe.level,
                "mean_stress_MPa": 1.5 if damage > 0.0 else np.nan,
                "R_largest_cycle": -0.8 if damage > 0.0 else np.nan,
                "damage_factor_if_mean_stress": np.nan,
                "shear_ratio": 0.1 if damage > 0.0 else np.nan,
                "damage_factor_if_shear": 1.02 if damage > 0.0 else np.nan,
                "governing_event": recipe.events[0] if damage > 0.0 else None,
                "bending_ratio": 0.85 if damage > 0.0 else np.nan,
                "life_km_raw_end": _life(damage, 2.0 if s == 0 else 1.0),
                "at_end": not recipe.closed and s in (0, recipe.stations - 1),
                "at_corner": False,
                "summed_corner": False,
                "curve_status": recipe.curve_status,
                "screened": "",
            }
        )
    return rows


def _damage_rows(recipe, cycles):
    length = 300.0 / 3600.0 * SAMPLES * STEP
    rows = []
    for (w, s, f, e), counted in cycles.items():
        damage = float(counted["damage"].sum())
        spectral = damage if recipe.spectrum else np.nan
        rows.append(
            {
                **_key(recipe, w, s, f),
                "event": recipe.events[e],
                **{
                    f"damage{name}_per_{unit}": value * factor / (length if unit == "km" else 1.0)
                    for name, factor, value in (
                        ("", 1.0, damage),
                        ("_dirlik", 1.1, spectral),
                        ("_tb", 1.2, spectral),
                        ("_tb_whole", 1.2, spectral),
                        ("_same_ratio", 0.98, spectral),
                    )
                    for unit in ("km", "pass")
                },
                "cycles_per_km": counted["count"].sum() / length,
                "cycles_per_pass": counted["count"].sum(),
                "max_range_MPa": counted["range_MPa"].max(),
                "max_equivalent_range_dS": counted["equivalent_range_dS"].max(),
                "bending_ratio": 0.85,
                "mean_stress_MPa": 1.5,
                "kurtosis": 3.0 + 0.5 * e + 0.1 * w,
                "outside_share": 1e-6,
                "irregularity": 0.7,
                "peaks_per_s": 20.0,
                "samples_per_peak": 12.5,
                "verdict": "not_assessed",
            }
        )
    return rows


def _cycle_rows(recipe, cycles, w, s, f):
    rows = []
    for e, event in enumerate(recipe.events):
        counted = cycles[w, s, f, e]
        rows += [
            _key(recipe, w, s, f)
            | {"event": event, "start_event": None, "end_event": None}
            | {name: values[i] for name, values in counted.items()}
            for i in range(6)
        ]
    return rows


def _bin_rows(recipe, cycles, w, s, f):
    """Classes of structural stress of the worst point of a weld."""
    rows = {}
    for e, event in enumerate(recipe.events):
        found = cycles[w, s, f, e]
        for S, n in zip(found["range_MPa"], found["count"], strict=True):
            at = int(64 * (np.log10(max(S, 1e-3)) + 3))
            empty = {"count_per_pass": 0.0, "power_sum_per_pass": 0.0}
            row = rows.setdefault((e, at), {**_key(recipe, w, s, f), "event": event, "kind": "S", "bin": at, **empty})
            row["count_per_pass"] += n
            row["power_sum_per_pass"] += n * S ** law().slopes[0]
    return [*rows.values()]


def _stress_rows(recipe):
    rows = []
    components = ("membrane", "bending", "in_plane_shear", "twist_shear", "transverse_shear")
    for w in range(len(recipe.welds)):
        for s in range(recipe.stations):
            key = _key(recipe, w, s, 0)
            for m, mode in enumerate(MODES):
                values = {c: recipe.level * 0.05 * (m + 1) * 0.8**s / (i + 1) for i, c in enumerate(components)}
                rows.append(
                    {
                        **{name: key[name] for name in ("weld", "part", "order", "node")},
                        "mode": mode,
                        "unit_load": None,
                        **{f"{c}_MPa": value for c, value in values.items()},
                        **{f"{c}_raw_MPa": value for c, value in values.items()},
                    }
                )
    return rows


def _weld_rows(recipe, per_km, passes, cycles, worst):
    rows = []
    for w, (s, f) in enumerate(worst):
        damage = per_km[w, s, f]
        utilisation = damage * TARGET_KM
        rows.append(
            {
                "weld": recipe.welds[w],
                "status": "assessed",
                "reason": "",
                "description": recipe.description,
                "closed": recipe.closed,
                "parts": 1,
                "nodes": recipe.stations,
                "length_mm": 25.0 * (recipe.stations - 1),
                "thickness_min_mm": THICKNESS,
                "thickness_max_mm": THICKNESS,
                "surface": recipe.toes,
                "curve": CURVE,
                "curve_status": recipe.curve_status,
                "edition": "2007 and later",
                "survival": "mean-2sigma",
                "end_length_mm": np.nan,
                "attachment_mm": np.nan,
                "damage_limit": 1.0,
                "life_km": _life(damage),
                "life_years": _life(damage) / KM_PER_YEAR,
                "utilisation": utilisation,
                "fulfilled": utilisation <= 1.0,
                "load_factor": _factor(utilisation),
                "checks_not_assessed": 0,
                "worst_is_proven": True,
                "worst_part": 1,
                "worst_order": s + 1,
                "worst_node": 1000 * (w + 1) + s,
                "worst_surface": FACES[f],
                "worst_arc_length_mm": 25.0 * s,
                "worst_summed_corner": False,
                "governing_event": recipe.events[0] if damage > 0.0 else None,
            }
        )
    return rows


def _write(folder, table, rows):
    rows = [row for piece in rows for row in (piece if isinstance(piece, list) else [piece])]
    nothing = {column.name: None for column in TABLES[table]}  # of what this result has nothing to say
    with table_writer(folder, table) as writer:
        writer.write({name: [row.get(name) for row in rows] for name in nothing})


def _write_inputs(root, recipe):
    """Histories of all events and the case file; returns the register of inputs."""
    time = STEP * np.arange(SAMPLES)
    random = np.random.default_rng(7)
    files = []
    for e in range(len(recipe.events)):
        q = {
            f"q_{mode}": 1.0
            + np.sin(2 * np.pi * frequency * time + e) * (1.0 + 0.3 * np.sin(time))
            + 0.1 * random.normal(size=SAMPLES)
            for mode, frequency in zip(MODES, FREQUENCIES, strict=True)
        }
        pq.write_table(pa.table({"time_s": time, **q}), root / f"q_{e}.parquet")
        files.append(root / f"q_{e}.parquet")
    if recipe.mesh:  # two quadrilaterals, at right angles
        nodes = ["1,0,0,0", "2,1000,0,0", "3,1000,200,0", "4,0,200,0", "5,1000,0,300", "6,0,0,300"]
        (root / "nodes.csv").write_text("\n".join(["node,x_mm,y_mm,z_mm", *nodes]) + "\n")
        (root / "elements.csv").write_text("element,n1,n2,n3,n4\n1,1,2,3,4\n2,1,2,5,6\n")
        files += [root / "nodes.csv", root / "elements.csv"]
    case = root / "case.toml"
    case.write_text(_case_text(recipe), encoding="utf-8")
    files.append(case)
    return [
        {"file": f.name, "bytes": f.stat().st_size, "sha256": hashlib.sha256(f.read_bytes()).hexdigest()} for f in files
    ]


def _case_text(recipe):
    text = json.dumps  # a JSON string in ASCII is a TOML basic string
    share = 1.0 / len(recipe.events)
    events = "".join(
        f'[[mission.event]]\nname = {text(name)}\nhistory = "q_{e}.parquet"\nspeed_km_h = 300.0\nshare = {share!r}\n'
        for e, name in enumerate(recipe.events)
    )
    return (
        f"title = {text(recipe.title)}\n"
        '[body]\nmodes = "modes.csv"\nwelds = "welds.csv"\nweld_nodes = "weld_nodes.csv"\n'
        'nodal_forces = "nodal_forces.parquet"\nforce_convention = "on_element"\n'
        + ('nodes = "nodes.csv"\nelements = "elements.csv"\n' if recipe.mesh else "")
        + f'[curve]\nname = "{CURVE}"\nsurvival = "mean-2sigma"\n[spectrum]\nsegment_s = 2.0\n'
        f"[mission]\ntarget_km = {TARGET_KM!r}\nkm_per_year = {KM_PER_YEAR!r}\n{events}"
    )


def _provenance(recipe, passes, files):
    curve = catalogue()[CURVE]
    used = law()
    return {
        "program": "fatigue",
        "software": {"fatigue": "0.1.0", "python": "3.11.7", "numpy": "2.4.6"},
        "title": recipe.title,
        "case_file": "case.toml",
        "case_path": "../case.toml",
        "case_text": _case_text(recipe),
        "inputs": files,
        "modes": {
            "used": list(MODES),
            "ignored": [],
            "frequency_hz": list(FREQUENCIES),
            "kind": ["normal", "normal", "interface"],
        },
        "force_convention": "on_element",
        "curves": {
            CURVE: {
                "applies": curve.applies,
                "slopes": list(curve.slopes),
                "knees_cycles": list(curve.knees_cycles),
                "reference_cycles": curve.reference_cycles,
                "reference_range": dict(curve.reference_range),
                "thickness_reference_mm": curve.thickness_reference,
                "thickness_exponent": curve.thickness_exponent,
                "source": curve.source,
                "edition": curve.edition,
                "clause": curve.clause,
                "status": recipe.curve_status,
                "checked_by": "",
                "checked_on": "",
                "allowances": asdict(curve.allowances),
                "factors": [],
                "quantity": curve.quantity,
                "used": {
                    "survival": "mean-2sigma",
                    "slopes": used.slopes,
                    "log_constants": used.log_constants,
                    "knees": used.knees,
                    "cutoff": used.cutoff,
                    "factor_on_range": 1.0,
                    "damage_limit": 1.0,
                },
            }
        },
        "rules": {
            "structural_stress": "Dong",
            "thickness_rule": "actual",
            "survival": {CURVE: "mean-2sigma"},
            "extension": "none",
            "knee_cycles": 1e7,
            "mean_stress": "none",
            "yield_MPa": None,
            "bending_ratio": "of each cycle",
            "weld_ends": "mean over the plate thickness",
            "residue": dict.fromkeys(recipe.events, "the record recurs: every cycle closes"),
            "upsample": 1,
            "upsampled": {},
            "screening": {"rule": "none", "share_of_limit": 0.0, "stations": {}},
            "spectrum": {"segment_s": 2.0, "upper_hz": None, "window": "periodic Hann, 50 % overlap, constant detrend"},
        },
        "mission": {
            "target_km": TARGET_KM,
            "km_per_year": KM_PER_YEAR,
            "damage_limit": 1.0,
            "events": [
                {
                    "event": event,
                    "samples": SAMPLES,
                    "length": 300.0 / 3600.0 * SAMPLES * STEP,
                    "share": 1.0 / len(recipe.events),
                    "per_1000_km": None,
                    "passes_per_km": passes[e],
                    "stress_factor": 1.0,
                    "start_s": 0.0,
                }
                for e, event in enumerate(recipe.events)
            ],
        },
        "warnings": list(recipe.warnings),
        "outputs": [],
    }
