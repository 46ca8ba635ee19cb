"""The stress of one point in one event, of any mixture of its coordinates and their quasi-static parts, counted."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from fatigue.life.records.spool import Samples, Spool, SpoolWriter, create_spool, time_slices
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.vibration.dominant import Spectrum, dominant_hz, spectrum
from fatigue.vibration.excitation import SHORTEST
from fatigue.why.attribute import count_credit
from fatigue.why.formation.modes import BLOCK, LAID, MIXED
from fatigue.why.long_record import Row, is_long, lay_damage, long_damage
from fatigue.why.points import Points

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Laid:
    """Damage of a point in one pass, laid on its samples.

    ``share`` (1, t), or more rows of which it is the first: ``stress @ share`` is the damage, see ``life.attribution``.
    """

    damage: float
    share: Samples


@dataclass(frozen=True, slots=True, eq=False)
class PointStress:
    """One point under one event.

    Attributes
    ----------
    point : the only one
    load : the event
    q, quasi_static : (c, t) coordinates and their quasi-static parts
    """

    point: Points
    load: EventLoad
    q: Samples
    quasi_static: Samples

    @property
    def modal(self) -> Floats:
        """Membrane and bending stress per unit coordinate, (2, c) [MPa]."""
        return self.load.stress_factor * np.concatenate([self.point.membrane, self.point.bending])

    @property
    def side(self) -> float:
        """Sign of the bending stress."""
        return float(self.point.side[0])

    @property
    def surface(self) -> Floats:
        """Stress of the face per unit coordinate, (c,) [MPa]."""
        membrane, bending = self.modal
        return np.asarray(membrane + self.side * bending)

    def history(self, swings: Floats, follows: Floats) -> Samples:
        """Membrane and bending stress (2, t) of coordinates times ``swings`` (c,) and parts times ``follows`` (c,).

        Raises
        ------
        DataError : the disk is full
        """
        of_q, of_parts = self.modal * swings, self.modal * follows
        if not isinstance(self.quasi_static, Spool):
            return np.asarray(of_q @ np.asarray(self.q) + of_parts @ self.quasi_static)
        with SpoolWriter(self.quasi_static.path.with_name(MIXED), 2, np.dtype(np.float64)) as writer:
            for part in time_slices(self.q.shape):
                writer.append(of_q @ self.q[:, part] + of_parts @ self.quasi_static[:, part])
        return writer.spool()

    def damage(self, stress: Samples, constant: Floats) -> float:
        """Miner sum of a stress history in one pass; ``constant`` (c,) of the coordinates is beside its samples."""
        offset = float(self.surface @ constant)
        size, rule, residue = float(self.point.size[0]), self.point.rule[0], self.load.residue
        if is_long(stress):
            return long_damage(stress, Row(0, self.side, size, rule, offset), residue, vertex=self.load.vertex)
        membrane, bending = np.asarray(stress)
        found = count_credit(membrane, bending, self.side, size, rule, residue, offset, vertex=self.load.vertex)
        return found.damage

    def laid(self, stress: Samples) -> Laid:
        """Damage of the whole stress, laid on its samples.

        Raises
        ------
        DataError : the disk is full
        """
        offset = float(self.surface @ self.load.offset)
        size, rule = float(self.point.size[0]), self.point.rule[0]
        if is_long(stress):
            row = Row(0, self.side, size, rule, offset)
            laid = create_spool(stress.path.with_name(LAID), (3, stress.shape[1]), np.dtype(np.float64))
            return Laid(lay_damage(stress, row, self.load, laid, 0, np.array([-np.inf, np.inf])).damage, laid)
        membrane, bending = np.asarray(stress)
        found = count_credit(
            membrane, bending, self.side, size, rule, self.load.residue, offset, vertex=self.load.vertex
        )
        return Laid(found.damage, found.share[None])

    def moves(self, stress: Samples) -> tuple[float, float]:
        """Rms about the mean [MPa] and dominant frequency [Hz] of the stress of the face, block by block."""
        samples = stress.shape[1]
        count = max(1, samples // BLOCK) if is_long(stress) else 1
        edges = [samples * i // count for i in range(count + 1)]
        shortest = min(end - first for first, end in pairwise(edges))
        hz, variance, moments, base = np.zeros(0), np.zeros(0), np.zeros(2), None
        for first, end in pairwise(edges):
            membrane, bending = stress[0:2, first:end]
            x = np.asarray(membrane + self.side * bending, np.float64)
            base = x.mean() if base is None else base
            moments += [np.sum(x - base), np.sum((x - base) ** 2)]
            if shortest > 1:
                hz, of_block = spectrum(x[:shortest], self.load.counted.step)
                variance = of_block / count + (variance if variance.size else 0.0)
        mean, square = moments / samples
        frequency = float(dominant_hz(Spectrum(hz, variance))) if shortest >= SHORTEST else np.nan
        return float(np.sqrt(max(0.0, square - mean**2))), frequency
