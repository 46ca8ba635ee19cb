"""How the result was found, rule by rule: the parameter, the choice made, and the clause or paper it comes from."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from fatigue.report.sections.curves import allowances_in_words, curve_words, damage_limits
from fatigue.report.wording import number
from fatigue.shown import few


@dataclass(frozen=True, slots=True)
class Rule:
    """One rule of the method as it was applied."""

    subject: str
    choice: str
    source: str


def rules(record: Mapping[str, Any]) -> list[Rule]:
    """Every rule of an assessment with its source, in the order of the calculation."""
    chosen, mission = record["rules"], record["mission"]
    return [
        Rule(
            "Nodal forces",
            f"force convention {record['force_convention']}, global axes, {len(record['modes']['used'])} modes",
            "case file: body.force_convention",
        ),
        *(_load_rule(load) for load in record.get("unit_loads", ())),
        Rule(
            "Line forces",
            "consistent with the edge shape functions along each weld line, solved once for all modes",
            "Dong 2001, Int. J. Fatigue 23; ASME VIII-2 5.5.5.1",
        ),
        Rule("Weld ends", chosen["weld_ends"], "case file: end_length_mm"),
        Rule(
            "Structural stress",
            "membrane plus bending normal to the weld line, per face: σm = fy′/t, σb = −6 mx′/t²",
            "Dong 2001; ASME VIII-2 5.5.5.2 (a)",
        ),
        *(_curve_rule(name, curve) for name, curve in record["curves"].items()),
        Rule("Thickness in ΔS", _thickness(chosen["thickness_rule"]), "ASME VIII-2 5.5.5.2 (e)"),
        Rule("Bending ratio", chosen["bending_ratio"], "ASME VIII-2 5.5.5.2 (d): I(r)^(1/m)"),
        Rule("Below the knee", _extension(chosen), "case file: curve.extension; Haibach 1970"),
        Rule(
            "Mean stress",
            "no correction"
            if chosen["mean_stress"] == "none"
            else f"f_M for high mean tension, yield {number(chosen['yield_MPa'])} MPa",
            "ASME VIII-2 5.5.5.2 (c)",
        ),
        Rule(
            "Shear",
            "not in the headline life; the factor it would bring is given for every point",
            "ASME VIII-2 5.5.5.3",
        ),
        *(
            Rule(f"Counting: {words.split(':')[0]}", words, "ASTM E1049-85")
            for words in _unique(chosen["residue"].values())
        ),
        Rule("Cycles across events", _across_events(record), "case file: mission.sequence"),
        Rule(
            "Points not counted", _screening(chosen["screening"]), "option --screen; proofs: fatigue/life/screening.py"
        ),
        *_level_rule(chosen),
        Rule("Upsampling before counting", _upsampling(chosen), "case file: counting.upsample"),
        Rule("Reversals", _reversals(chosen), "case file: counting.reversals"),
        *(
            Rule("Design range", words, "case file: curves, checks.strength_factors")
            for words in allowances_in_words(record)
        ),
        Rule("Damage", f"linear sum, limit {damage_limits(record)}", "Palmgren 1924, Miner 1945"),
        Rule(
            "Mission",
            f"target {number(mission['target_km'])} km, {number(mission['km_per_year'])} km per year",
            "case file: mission",
        ),
        Rule(
            "Spectra",
            f"{chosen['spectrum']['window']}, segments of {number(chosen['spectrum']['segment_s'])} s, upper frequency "
            + (
                f"{number(chosen['spectrum']['upper_hz'])} Hz"
                if chosen["spectrum"]["upper_hz"]
                else "the lower of 0.4 sampling rates and 1.5 times the highest normal mode"
            ),
            "Welch 1967",
        ),
        Rule("Frequency-domain life", "Dirlik, with one bending ratio per point and event", "Dirlik 1985"),
        Rule("Frequency-domain life, second", "Tovo-Benasciutti", "Benasciutti and Tovo 2005, Int. J. Fatigue 27"),
    ]


def _load_rule(load: Mapping[str, Any]) -> Rule:
    """What one unit load is, and what events that do not give it have of it; its values stand under Loads."""
    what = f"forces per {load['unit']}, one more coordinate beside the modes, role {load['role']}; an event that does "
    what += "not give it " + ("is refused" if load["when_missing"] == "error" else "has none of it")
    ways = ", ".join(dict.fromkeys(_WAYS[given["way"]] for given in load["given"].values()))
    return Rule(f"Unit load {load['name']}", f"{what}; here: {ways}", "case file: body.unit_load")


_WAYS = {
    "constant": "constant",
    "values": "static values",
    "column": "column of the event's record",
    "file": "a history of its own",
    "missing": "not given, zero",
}


def assumptions(record: Mapping[str, Any]) -> list[tuple[str, str]]:
    """What the life on the first page assumes, in a few lines."""
    chosen, mission = record["rules"], record["mission"]
    curves = [
        f"{curve_words(name, record)}, {_survival(chosen['survival'][name])} ({curve['source']})"
        for name, curve in record["curves"].items()
    ]
    allowances = allowances_in_words(record)
    return [
        ("S-N curve" if len(curves) == 1 else "S-N curves", "; ".join(curves)),
        ("Thickness in ΔS", _thickness(chosen["thickness_rule"])),
        ("Below the knee", _extension(chosen)),
        ("Mean stress", "no correction" if chosen["mean_stress"] == "none" else "ASME factor for high mean tension"),
        *((rule.subject, rule.choice) for rule in _level_rule(chosen)),
        ("Residue", "; ".join(_unique(chosen["residue"].values()))),
        ("Upsampling", _upsampling(chosen)),
        *([("Cycles across events", _across_events(record))] if mission.get("sequences") else []),
        ("Weld ends", chosen["weld_ends"]),
        ("Points not counted", _screening(chosen["screening"])),
        *([("Design range", "; ".join(allowances))] if allowances else []),
        ("Damage limit", f"Miner sum {damage_limits(record)} at the target"),
    ]


def _across_events(record: Mapping[str, Any]) -> str:
    """Whether cycles across events are counted, and in which order."""
    loops = record["mission"].get("sequences", [])
    said = str(record["rules"].get("events", "every event follows on itself"))
    if not loops:
        return said
    orders = "; ".join(
        f"{' – '.join(loop['order'])} {number(1000.0 * loop['runs_per_km'])} in 1000 km" for loop in loops
    )
    return f"{said}: {orders}"


def _level_rule(chosen: Mapping[str, Any]) -> list[Rule]:
    """Which events have the mean of their modal coordinates removed; nothing where none has."""
    of_event: Mapping[str, str] = chosen.get("mean_of_q", {})
    removed = [event for event, rule in of_event.items() if rule == "remove"]
    if not removed:
        return []
    where = "in all events" if len(removed) == len(of_event) else f"in {', '.join(removed)}"
    choice = f"removed {where}: means and stress ratios are those about the static loads that are given"
    return [Rule("Mean of q", choice, "case file: mean_of_q")]


def _curve_rule(name: str, curve: Mapping[str, Any]) -> Rule:
    used = curve["used"]
    slopes = ", ".join(number(k) for k in used["slopes"])
    ranges = ", ".join(f"{level} {number(value)}" for level, value in curve["reference_range"].items())
    unit = "MPa mm^(−0.222)" if curve["applies"] == "dS" else "MPa"
    return Rule(
        f"Curve {name}",
        f"slopes {slopes}; range at {number(curve['reference_cycles'])} cycles [{unit}]: {ranges}; "
        f"used: {used['survival']}",
        curve["source"],
    )


def _survival(level: str) -> str:
    meaning = {
        "mean": "50 % survival",
        "mean-1sigma": "84 % survival",
        "mean-2sigma": "97.7 % survival",
        "mean-3sigma": "99.9 % survival",
    }
    return f"{level}: {meaning[level]}" if level in meaning else level


def _thickness(rule: str) -> str:
    return {"actual": "actual plate thickness", "asme": "ASME: at least 16 mm, at most 150 mm"}[rule]


def _extension(chosen: Mapping[str, Any]) -> str:
    words = {
        "none": "the curve as it is, no further knee",
        "haibach": f"slope 2k − 1 beyond {number(chosen['knee_cycles'])} cycles (Haibach)",
        "cutoff": f"cut-off at {number(chosen['knee_cycles'])} cycles",
    }
    return words[chosen["extension"]]


def _upsampling(chosen: Mapping[str, Any]) -> str:
    """By how much the record of each event was upsampled, in words."""
    events: dict[int, list[str]] = {}
    for event, factor in chosen.get("upsampled", {}).items():
        events.setdefault(factor, []).append(f'"{event}"')
    done = [f"{'none' if factor == 1 else f'{factor} times'}: {few(events[factor])}" for factor in sorted(events)]
    enough = 8 if chosen.get("reversals") == "vertex" else 20
    asked = f"as much as gives {enough} samples per peak" if chosen["upsample"] == "auto" else str(chosen["upsample"])
    return "; ".join([asked, *done])


def _reversals(chosen: Mapping[str, Any]) -> str:
    """Where reversals are read, in words."""
    if chosen.get("reversals") == "vertex":
        return "at the vertex of the parabola through three samples, membrane and bending at the same instant"
    return "at the samples"


def _screening(screening: Mapping[str, Any]) -> str:
    """Which points have bounds in place of counted damage, in words."""
    share, stations = screening["share_of_limit"], screening["stations"]
    if share == 0.0:
        return "none: cycles are counted at every point"
    counted, settled = stations["counted"], sum(stations.values())
    return (
        f"{settled - counted} of {settled} stations have proven upper bounds of damage, below {number(share)} of the "
        "limit and below the worst point of their weld, which is counted exactly"
    )


def _unique(words: Any) -> Sequence[str]:
    return list(dict.fromkeys(words))
