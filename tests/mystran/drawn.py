"""Decks drawn from a seed: a joint, distorted, cut into triangles, turned, renumbered, in any frames and units."""

from dataclasses import dataclass

import numpy as np

from fatigue.readers.units import SYSTEMS
from tests.mystran import plates as joints
from tests.mystran.decks import Deck

JOINTS = (joints.tee, joints.cruciform, joints.lap, joints.bracket, joints.box)


@dataclass(frozen=True)
class Drawn:
    """The static and the modal run of one model, and what was drawn for it."""

    static: Deck
    modal: Deck
    story: str


def drawn(seed: int) -> Drawn:
    """Draw a model; every joint comes in turn."""
    rng = np.random.default_rng(seed)
    joint = JOINTS[seed % len(JOINTS)]
    plates, story = joint(rng), [joint.__name__]

    def chance(share, name):
        if hit := rng.random() < share:
            story.append(name)
        return hit

    if chance(0.7, "distorted"):
        plates = joints.distorted(plates, rng)
    if chance(0.4, "triangles"):
        plates = joints.with_triangles(plates, rng)
    if chance(0.4, "bars and spiders"):
        plates = joints.with_bars_and_spiders(plates, rng)
    if chance(0.4, "turned"):
        plates = joints.turned(plates, rng)
    n, e = len(plates.xyz), len(plates.shells)
    node_ids, shell_ids = np.arange(1, n + 1), np.arange(1, e + 1)
    if chance(0.6, "renumbered"):
        node_ids, shell_ids = (rng.choice(np.arange(1, 10_000_000), k, replace=False) for k in (n, e))
    frames = np.zeros(n, int)
    if chance(0.6, "frames"):
        frames = rng.choice([0, 7, 8], n)
    units = str(rng.choice(list(SYSTEMS)))
    story.append(units)
    runs = [Deck(plates, sol, node_ids, shell_ids, frames, modes=4, units=units) for sol in (101, 103)]
    return Drawn(*runs, " ".join(story))
