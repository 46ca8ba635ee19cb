"""The S-N curves that stress points ask for."""

from collections.abc import Iterator
from typing import cast

from fatigue.life.curves import Quantity
from fatigue.pipeline.solve.rated_curves import AskedCurve, Use
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
