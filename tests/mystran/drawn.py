"""Decks drawn from a seed: a joint, distorted, cut into triangles, turned, renumbered, in any frames and units."""

from dataclasses import dataclass

import numpy as np

from fatigue.readers.units.systems import SYSTEMS
from tests.mystran import plates as joints
from tests.mystran.decks import FRAMES, Deck, plain

JOINTS = (joints.tee, joints.cruciform, joints.lap, joints.bracket, joints.box)
_MODES = 4


@dataclass(frozen=True)
class Drawn:
    """One model: its static and its modal run, what was drawn for it, and the same runs of its plain twin.

    The twin is not turned; its ids count from 1, its frames are basic, its units mm, t, s.
    """

    static: Deck
    modal: Deck
    story: str
    static_twin: Deck
    modal_twin: Deck


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
    quad = str(rng.choice(["MIN4", "MIN4T", "MITC4"]))
    story.append(quad)
    twins = [plain(plates, sol, modes=_MODES, quad=quad) for sol in (101, 103)]
    if chance(0.4, "turned"):
        plates = joints.turned(plates, rng)
    n, e = len(plates.xyz), len(plates.shells)
    node_ids, shell_ids = np.arange(1, n + 1), np.arange(1, e + 1)
    if chance(0.6, "renumbered"):
        node_ids, shell_ids = (rng.choice(np.arange(1, 10_000_000), k, replace=False) for k in (n, e))
    frames = np.zeros(n, int)
    if chance(0.6, "frames"):
        frames = rng.choice([0, *FRAMES], n)
        for card, head, nodes in plates.spiders:
            if card == "RBE3":  # MYSTRAN's depends on the displacement frames of its nodes
                frames[[head, *nodes]] = 0
    places = np.zeros(n, int)
    if chance(0.4, "places"):
        places = rng.choice([0, *FRAMES], n)
    units = str(rng.choice(list(SYSTEMS)))
    story.append(units)
    runs = [
        Deck(plates, sol, node_ids, shell_ids, frames, places, modes=_MODES, units=units, quad=quad)
        for sol in (101, 103)
    ]
    return Drawn(*runs, " ".join(story), *twins)
