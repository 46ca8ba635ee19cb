"""What the throats of fillet welds will take: each is counted in every direction, or as a path."""

import numpy as np

from fatigue.pipeline.solve.body import Body

THROAT = 0.43e-6  # processor time [s] of each sample at each throat: 36 directions, or one path


def counted_throats(body: Body) -> int:
    """Throats of all stations: one or two at each station of a weld that has them."""
    if not body.throats:
        return 0
    sides = [len(body.throats[name].sides) if name in body.throats else 0 for name in body.lines.weld]
    return int(np.dot(sides, np.diff(body.lines.begin)))


def throat_seconds(throats: int, samples: int) -> float:
    """Processor time [s] of so many throats in records of so many samples together."""
    return THROAT * throats * samples
