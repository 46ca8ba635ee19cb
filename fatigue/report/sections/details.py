"""The worst points of the welds shown in detail, as their details are gathered: modal stress, event, largest cycle."""

import pandas as pd

from fatigue.report.inputs import FoundInputs
from fatigue.report.result import ShownResult
from fatigue.report.sections.point.detail import COMPONENTS, Detail, DetailedPoint, point_details
from fatigue.report.sections.point.worst_cycles import leading_event, most_damaging


def weld_details(result: ShownResult, inputs: FoundInputs) -> tuple[dict[str, Detail], dict[str, float]]:
    """Details of each weld shown in detail, and the time step of each record [s]; one event is in memory at a time.

    Raises
    ------
    DataError : a history is not there any more or is not the one that was assessed
    """
    return point_details(_welds(result), inputs, result.record)


def _welds(result: ShownResult) -> dict[str, DetailedPoint]:
    governing = _leading_events(result)
    twist = result.modal_stress(["twist_shear_MPa"]) if _shows_a_path(result) else {}
    welds = {}
    for name, (stations, modal_stress) in result.modal_stress(list(COMPONENTS.values())).items():
        components = dict(zip(COMPONENTS, modal_stress, strict=True))
        point = result.worst(name)
        at = int(((stations["part"] == point["part"]) & (stations["order"] == point["order"])).argmax())
        sign = 1.0 if point["surface"] == "top" else -1.0
        by_model = name in twist and point["multiaxial_verdict"] == "model_dependent"
        welds[name] = DetailedPoint(
            modal_stress=components["membrane"][at] + sign * components["bending"][at],
            stations=components,
            shear=components["in-plane shear"][at] + sign * twist[name][1][0][at] if by_model else None,
            governing_event=governing[name],
            cycles=most_damaging(result.cycles(name), governing[name], 1),
        )
    return {name: welds[name] for name in result.detailed}


def _shows_a_path(result: ShownResult) -> bool:
    """Whether the worst point of any detailed weld passes by one model of shear and fails by another."""
    return any(result.worst(weld).get("multiaxial_verdict") == "model_dependent" for weld in result.detailed)


def _leading_events(result: ShownResult) -> dict[str, str | None]:
    """Governing event of each weld; the event with the most damage where a sequence governs, which has no record."""
    known = {event["event"] for event in result.events}
    found: dict[str, str | None] = {}
    for weld, name in result.assessed.set_index("weld")["governing_event"].items():
        found[str(weld)] = None if pd.isna(name) else str(name)
        if not pd.isna(name) and name not in known:
            found[str(weld)] = leading_event(result.damage[result.damage["weld"] == weld], result.record)
    return found
