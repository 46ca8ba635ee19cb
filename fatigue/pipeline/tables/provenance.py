"""Where every number of a result comes from: inputs, versions, curves, rules and warnings, as one record."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from fatigue.case import Case, stress_categories
from fatigue.errors import Problem
from fatigue.life.band.load import BLOCK, CONFIDENCE, PIECES
from fatigue.life.band.quantiles import SURVIVALS
from fatigue.life.mission import Plan
from fatigue.pipeline.count.worst import ABOVE
from fatigue.pipeline.life_band.scatter import MINOR
from fatigue.pipeline.mission.gravity import HeldGravity
from fatigue.pipeline.multiaxial.method import DECIDING
from fatigue.pipeline.run.work import Work
from fatigue.pipeline.solve.body import Body
from fatigue.pipeline.solve.rated.rated_curves import RatedCurve
from fatigue.pipeline.tables.unit_loads import load_records
from fatigue.results import software_versions, way_to_case

RESIDUE_RULES = {
    "repeat": "the record recurs: every cycle closes (ASTM E1049-85 5.4.5, ISO 12110-2)",
    "half": "a single pass: what does not close counts as half cycles (ASTM E1049-85 5.4.4)",
}
_HISTOGRAM_RULES = {
    "worst": f"the worst point of each weld, and counted toe points from a utilisation of {ABOVE:g} on; counted once "
    "more in double precision",
    "all": "every counted point; counted once more in double precision",
    "none": "none",
}


def provenance_record(
    body: Body,
    work: Work,
    stations: Mapping[str, int],
    folder: Path,
    inputs: Sequence[dict[str, Any]],
    warnings: Sequence[Problem],
    gravity: Sequence[HeldGravity] = (),
    shear: Mapping[str, int] | None = None,
) -> dict[str, Any]:
    """Everything an assessor needs to trace or repeat a result; the same inputs give the same record.

    ``stations`` are numbers of stations by the tier of screening that settled them, ``gravity`` is what the mean of q
    of each event holds of the dead load, ``shear`` numbers of toe points by what settled their shear. ``case_path``
    leads from the result folder to the case file, so that both can be moved together.
    """
    case, plan = body.case, work.plan
    return {
        "program": "fatigue",
        "software": software_versions(),
        "title": case.title,
        "case_file": case.path.name,
        "case_path": way_to_case(case.path, folder),
        "case_text": case.text,
        "inputs": list(inputs),
        "modes": {
            "used": body.modes.mode.tolist(),
            "ignored": list(case.body.ignore_modes),
            "frequency_hz": body.modes.frequency.tolist(),
            "kind": list(body.modes.kind),
        },
        "unit_loads": load_records(body),
        "force_convention": case.body.force_convention,
        "curves": {name: _curve_record(rated, plan) for name, rated in body.curves.items()},
        "rules": {
            "structural_stress": "Dong: consistent line forces from nodal forces, membrane + bending",
            "thickness_rule": case.curve.thickness_rule,
            "survival": {name: rated.survival for name, rated in body.curves.items()},
            "extension": case.curve.extension,
            "knee_cycles": case.curve.knee_cycles,
            "mean_stress": case.curve.mean_stress,
            "yield_MPa": case.curve.yield_MPa,
            "bending_ratio": "of each cycle, from its own two instants; one rms ratio per event for the comparison",
            "weld_ends": "mean of the line force and moment over end_length_mm, by default the plate thickness",
            "residue": {event.name: RESIDUE_RULES[case.residue(event)] for event in case.mission.event},
            "events": _joining_rule(plan),
            "mean_of_q": {event.name: case.mean_of_q(event) for event in case.mission.event},
            "upsample": case.counting.upsample,
            "upsampled": {load.counted.event: load.upsample for load in work.loads},
            "reversals": case.counting.reversals,
            "precision": _precision(work),
            "screening": _screening_record(work, stations),
            "cycles_kept_from_utilisation": work.kept_from,
            "histogram": _HISTOGRAM_RULES[work.histogram],
            "life_band": _band_record(case, work),
            "multiaxial": _shear_record(case, work, shear or {}),
            "stress_category": asdict(stress_categories(case.checks.stress_category)),
            "spectrum": {
                "segment_s": case.spectrum.segment_s,
                "upper_hz": case.spectrum.upper_hz,
                "window": "periodic Hann, 50 % overlap, constant detrend",
            },
        },
        "mission": {
            "target_km": plan.target_km,
            "km_per_year": plan.km_per_year,
            "damage_limit": plan.damage_limit,
            "events": [
                asdict(p)
                | {"passes_per_km": p.passes_per_km, "stress_factor": event.stress_factor, "start_s": event.start_s}
                for p, event in zip(plan.passes, case.mission.event, strict=True)
            ],
            "sequences": [
                {
                    "name": loop.name,
                    "order": [plan.passes[event].event for event in loop.order],
                    "runs_per_km": loop.runs_per_km,
                }
                for loop in plan.loops
            ],
        },
        "gravity": [one.as_record() for one in gravity],
        "conversion": body.conversion,
        "warnings": [asdict(problem) for problem in warnings],
    }


def _band_record(case: Case, work: Work) -> dict[str, Any] | None:
    """What the bands of lives rest on; None where there are none."""
    if work.histogram == "none":
        return None
    return {
        "load": f"half of each cycle's damage at either instant, {PIECES} pieces of the record, circular blocks of "
        f"{BLOCK} in closed form; events independent, degrees of freedom by Welch and Satterthwaite",
        "confidence_of_load": CONFIDENCE,
        "survivals": dict(SURVIVALS),
        "events_without_scatter_below_share": MINOR,
        **case.life_band.model_dump(),
        "miner_median": case.life_band.miner_median or "the allowed damage sum",
    }


def _shear_record(case: Case, work: Work, points: Mapping[str, int]) -> dict[str, Any]:
    """How shear was counted with the normal stress, and what settled the toe points."""
    asked = case.multiaxial
    if work.shear is None:
        return {"method": asked.method}
    named = asked.method in DECIDING
    decides = f"the larger one of normal stress and {asked.method}" if named else "the normal stress alone"
    return {
        "method": asked.method,
        "beta": asked.beta,
        "alpha": asked.alpha,
        "decides": decides,
        "paths": "half cycles from sample to sample, upsampled as the normal stress; cycles across the events of "
        "sequences by normal stress",
        "worst_points_counted_from_utilisation": work.shear.counted_from,
        "path_cycles": f"of each weld the point with the largest sum by range, from {ABOVE:g} of the limit on, of "
        + ("all" if work.counts_all_paths else "those that only the counter settles"),
        "toe_points": dict(points),
    }


def _joining_rule(plan: Plan) -> str:
    """How events are joined, in words."""
    if plan.loops:
        return (
            "cycles across the events of each sequence are counted, from the residues of the passes; cycles between "
            "sequences are not"
        )
    if plan.joins_events:
        return "every event follows on itself; what another order of the stints adds at most is stated beside it"
    return "every event follows on itself: cycles across events are not counted"


def _precision(work: Work) -> str:
    """Precision of the counter."""
    single = work.loads[0].single is not None and not any(load.vertex for load in work.loads)
    return "single, doubtful points in double" if single else "double"


def _screening_record(work: Work, stations: Mapping[str, int]) -> dict[str, Any]:
    """Which points a bound has settled, and why that is safe."""
    if work.screening is None:
        return {"rule": "none: every point is counted", "share_of_limit": 0.0, "stations": dict(stations)}
    worst = "" if work.screening.proves_worst else "; not so in welds that are below the share everywhere"
    return {
        "rule": "a point is not counted if a proven upper bound of its damage stays below this share of the limit and "
        f"below the counted damage of the worst point of its weld{worst}; damage without end treatment is not counted "
        "if such a bound stays below this share",
        "share_of_limit": work.screening.share,
        "stations": dict(stations),
    }


def _curve_record(rated: RatedCurve, plan: Plan) -> dict[str, Any]:
    curve = rated.curve
    return {
        "applies": curve.applies,
        "quantity": curve.quantity,
        "slopes": list(curve.slopes),
        "knees_cycles": list(curve.knees_cycles),
        "reference_cycles": curve.reference_cycles,
        "reference_range": dict(curve.reference_range),
        "thickness_reference_mm": curve.thickness_reference,
        "thickness_exponent": curve.thickness_exponent,
        "source": curve.source,
        "edition": curve.edition,
        "clause": curve.clause,
        "status": curve.status,
        "checked_by": curve.checked_by,
        "checked_on": curve.checked_on,
        "allowances": asdict(curve.allowances),
        "factors": [asdict(factor) for factor in rated.factors],
        "used": {
            "survival": rated.survival,
            "slopes": rated.rule.law.slopes,
            "log_constants": rated.rule.law.log_constants,
            "knees": rated.rule.law.knees,
            "cutoff": rated.rule.law.cutoff,
            "factor_on_range": rated.on_range,
            "damage_limit": rated.damage_limit(plan.damage_limit),
        },
    }
