"""Small bodies with normal stress and shear drawn at random, ready to be counted without files."""

import numpy as np

from fatigue.life.mission import Pass, Plan
from fatigue.life.records.history import ModalHistory
from fatigue.pipeline.count.block import Block
from fatigue.pipeline.mission.event_load import HowCounted, prepare_event
from fatigue.pipeline.multiaxial.toes import Toes
from fatigue.pipeline.solve.modal_stress import ModalStress
from tests.one_event import NO_RAW_ENDS


def drawn_loads(rng, modes=3, residues=("repeat", "half")):
    """Short records, one for each residue, and a plan with them."""
    loads, passes = [], []
    for number, residue in enumerate(residues):
        samples = int(rng.integers(2, 60))
        q = np.cumsum(rng.normal(size=(modes, samples)), axis=1) * rng.uniform(0.2, 2.0, (modes, 1))
        history = ModalHistory(f"event {number}", np.arange(1, modes + 1), q, 0.01, 0.0)
        loads.append(prepare_event(history, HowCounted(residue, stress_factor=1.0 + 0.5 * number), None, None))
        passes.append(Pass(f"event {number}", samples, 0.1, 1.0 / len(residues), None, half=residue == "half"))
    return loads, passes


def drawn_stress(rng, rule, points=6, modes=3):
    """Modal stress of some stations, shear between a tenth and twice the normal stress."""
    shear = 10.0 ** rng.uniform(-1.0, 0.3, (points, 1))
    parts = rng.normal(size=(4, points, modes)) * np.stack([np.ones_like(shear)] * 2 + [shear] * 2)
    return ModalStress(*parts, size=rng.uniform(1.0, 2.0, points), rule=rule, **NO_RAW_ENDS)


def counted_toes(stress, loads, passes, limit=None, of_largest=None, target_km=1e3):
    """The stations with their normal stress counted; the limit as given, or ``of_largest`` times the largest damage.

    By default it is the damage of the median point.
    """
    plan = Plan(tuple(passes), target_km, 1e5, 1.0)
    n, every = len(stress), np.ones((len(stress), 2), np.bool_)
    (settled,) = Block(stress, np.zeros(n, np.int64), every, loads, plan, "welds").all_counted()
    damage = settled.mission.damage_per_km * target_km
    limit = limit or (of_largest * float(damage.max()) if of_largest else float(np.median(damage)))
    plan = Plan(tuple(passes), target_km, 1e5, limit)
    events = settled.events
    return plan, Toes(
        stress=stress,
        toe=every,
        counted=np.ones(n, np.bool_),
        normal=damage / plan.damage_limit,
        transitions=np.zeros((n, 2)),
        with_shear=settled.mission.damage_with_shear * target_km / plan.damage_limit,
        normal_range=np.stack([event.count.max_range for event in events]),
        normal_mean=np.stack([event.estimate.mean for event in events]),
        of_events=np.stack([event.count.damage for event in events]),
        largest=np.stack([event.count.max_equivalent_range for event in events]),
    )
