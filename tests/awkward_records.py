"""Modal coordinates that a bound may fail on, and curves of every form, to try the screening on."""

import numpy as np
from numpy.typing import NDArray

from fatigue.life.curves import DamageLaw, catalogue, damage_law, user_curve

LAWS: dict[str, DamageLaw] = {
    "straight": damage_law(catalogue()["master-aluminium"], "mean-2sigma", "none", 1e7),
    "haibach": damage_law(catalogue()["master-steel"], "mean-2sigma", "haibach", 1e7),
    "cutoff": damage_law(catalogue()["master-steel"], "mean-2sigma", "cutoff", 1e7),
    "three slopes and a cutoff": damage_law(
        user_curve("class", (3.0, 5.0, 9.0), (5e6, 1e7, 1e8), 50.0, "structural", "test"), None, "none", 1e7
    ),
    "flatter for small ranges": damage_law(
        user_curve("odd", (3.7, 3.2), (5e6,), 50.0, "structural", "test"), None, "none", 1e7
    ),
    "slope 2.5": damage_law(user_curve("low", (2.5,), (), 50.0, "structural", "test"), None, "none", 1e7),
    "slope 1": damage_law(user_curve("one", (1.0,), (), 50.0, "structural", "test"), None, "none", 1e7),
}
KINDS = ("resonances", "noise", "walk", "steps", "dependent", "spike", "constant", "few samples", "units")


def modal_coordinates(rng: np.random.Generator, kind: str, modes: int | None = None) -> NDArray[np.float64]:
    """Draw (m, t): smooth, rough, drifting, with ties, linearly dependent, in units far apart, or hardly any."""
    m, t = modes or int(rng.integers(1, 7)), int(rng.integers(20, 200))
    noise = rng.normal(size=(m, t))
    time = np.arange(t)
    draw = {
        "resonances": np.sin(rng.uniform(0.05, 1.5, (m, 1)) * time + rng.uniform(0, 6, (m, 1))) + 0.1 * noise,
        "noise": noise * np.exp(2 * rng.normal(size=(m, 1))),
        "walk": np.cumsum(noise, axis=1) + 100.0,
        "steps": np.round(noise),
        "dependent": rng.normal(size=(m, 2)) @ noise[[0, -1]],
        "spike": 1e-3 * noise + 50.0 * (time == t // 3),
        "constant": np.repeat(noise[:, :1], t, axis=1),
        "few samples": noise[:, : int(rng.integers(1, 4))],
        "units": noise * 10.0 ** rng.integers(-8, 9, (m, 1)),
    }
    return np.ascontiguousarray(draw[kind])
