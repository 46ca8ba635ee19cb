"""The S-N curves that throats and stress points ask for, and what a throat counted as a path cannot have."""

from collections.abc import Iterator, Mapping
from typing import cast

from fatigue.case import Case
from fatigue.errors import Problem
from fatigue.life.curves import Quantity
from fatigue.pipeline.solve.rated.rated_curves import AskedCurve, RatedCurve, Use
from fatigue.readers.neutral.body.throats import WeldThroat
from fatigue.readers.neutral.points.stress_points import CHECK_OF, StressPoints


def point_curves(points: StressPoints | None) -> Iterator[AskedCurve]:
    """Curves that stress points ask for, each use of them once, at the first point that asks."""
    if points is None:
        return
    columns: tuple[tuple[str, Quantity, tuple[str, ...]], ...] = (
        ("curve", "normal", points.curve),
        ("curve_shear", "shear", points.curve_shear),
    )
    for column, quantity, curves in columns:
        first: dict[tuple[str, str], str] = {}
        for name, kind, point in zip(curves, points.kind, points.name, strict=True):
            first.setdefault((name, CHECK_OF[kind]), point)
        for (name, use), point in first.items():
            if name:
                yield AskedCurve(name, f"{points.file}: point {point}: {column}", cast(Use, use), quantity)


def throat_curves(case: Case, throats: Mapping[str, WeldThroat]) -> Iterator[AskedCurve]:
    """Curves of the stress across and along the throat of every weld, and at its root where it has one."""
    for throat in throats.values():
        where = f"{case.body.weld_throats}: weld {throat.weld}"
        yield AskedCurve(throat.curve, f"{where}: curve", use="throat")
        yield AskedCurve(throat.curve_shear, f"{where}: curve_shear", use="throat", quantity="shear")
        if throat.curve_root:
            yield AskedCurve(throat.curve_root, f"{where}: curve_root", use="root")


def path_problems(case: Case, throats: Mapping[str, WeldThroat], curves: Mapping[str, RatedCurve]) -> Iterator[Problem]:
    """Refusals of throats counted as a path where cycles are more than ranges between samples of one event."""
    events = case.mission.event
    joins = bool(case.mission.sequence) or any(event.stints_per_1000_km is not None for event in events)
    for throat in (one for one in throats.values() if one.combination == "path"):
        where, remedy = f"{case.body.weld_throats}: weld {throat.weld}: combination", "Give direction"
        stress_ratio = curves[throat.curve].rule.stress_ratio
        if joins:
            what = "a path is counted event by event, and cycles across events are part of the mission"
            yield Problem("path", where, what, remedy)
        if case.counting.reversals == "vertex":
            what = "a path is counted from sample to sample, and reversals = 'vertex' reads stress beyond them"
            yield Problem("path", where, what, f"{remedy}, or reversals = 'samples' and upsample = 'auto'")
        if stress_ratio != "none":
            what = f"a half cycle of a path has no stress ratio, and curve '{throat.curve}' has mean_stress = "
            yield Problem("path", where, f"{what}'{stress_ratio}'", f"{remedy}, or a curve without mean_stress")
