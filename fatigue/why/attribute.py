"""Whose damage it is: the damage of every point and event shared out to modes, frequency bands and places on the track.

The records are gone through once. Cycles are counted as in the assessment, so the parts add up to the damage of the
result; ``fatigue.life.attribution`` has the method. Everything is weighted with the mission: damages are per km, and
the sum over the events is the ``damage_per_km`` of a point.
"""

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from fatigue.life.attribution import Credit, credit
from fatigue.life.counting.rainflow import rainflow
from fatigue.life.counting.vertex import vertex_history
from fatigue.life.mission import Pass, Plan
from fatigue.life.records.history import Residue
from fatigue.life.rule import CycleRule
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.readers.neutral.body.modes import Modes
from fatigue.spectrum.bands import band_products, band_slices, coefficient_frequencies, coefficients
from fatigue.why.long_record import is_long, long_blocks
from fatigue.why.points import Points

Floats = NDArray[np.float64]

BIN_KM = 0.1  # of the track, where nobody says otherwise: about one second at 350 km/h
TIME_BINS = 40  # of an event that has no distance
_OTHER_NUMBERS = 50  # of a point and event: damage, slopes, what the verdict says
_SAMPLES_AT_ONCE = 1_000_000  # of each time vector of a block of points: 8 MB


@dataclass(frozen=True, slots=True, eq=False)
class Bins:
    """What the damage of an event is sorted into.

    ``edges_hz`` (b - 1,) are the ascending edges between the frequency bands [Hz], ``length_km`` is the length of a bin
    of the track [km].
    """

    edges_hz: Floats
    length_km: float


@dataclass(frozen=True, slots=True, eq=False)
class EventAttribution:
    """The damage of one event at p points, per km of the mission [1/km]; a slope is a derivative of that damage.

    Attributes
    ----------
    event : name
    damage : (p,) Miner sum
    top_cycle_share : (p,) share of ``damage`` that the one most damaging cycle has; NaN where nothing damages
    load_slope : (p,) by ln(load), all stresses of the event scaled
    thickness_slope : (p,) by ln(t) through the stress: membrane ~ 1/t, bending ~ 1/t^2 at constant line load
    rule_slope : (p,) by ln(t) through the thickness rule of the curve
    mode, mode_slope : (p, c) damage owed to each mode and, behind them, to each unit load, below 0 where it relieves;
        slope by ln(amplitude) of it
    resonant : (p, c) part of ``mode`` in resonance, within f (1 +- 2 zeta) of the mode; NaN without damping, and of
        unit loads
    band, band_slope : (p, b) the same for the frequency bands
    edges_hz : (b + 1,) edges of the bands; one band from 0 to infinity for a record too short to have a spectrum
    place : (p, x) damage credited half and half to the two instants of each cycle, per bin of the track
    place_s : (x + 1,) file time of the edges of the bins [s]
    place_km : (x + 1,) distance from the first kept sample of the same edges [km]; NaN for an event counted by number
    """

    event: str
    damage: Floats
    top_cycle_share: Floats
    load_slope: Floats
    thickness_slope: Floats
    rule_slope: Floats
    mode: Floats
    mode_slope: Floats
    resonant: Floats
    band: Floats
    band_slope: Floats
    edges_hz: Floats
    place: Floats
    place_s: Floats
    place_km: Floats

    def of(self, index: NDArray[np.int64] | slice) -> Self:
        """The same of some of the points."""
        of_event = {"event", "edges_hz", "place_s", "place_km"}
        return replace(self, **{f.name: getattr(self, f.name)[index] for f in fields(self) if f.name not in of_event})

    @property
    def is_sequence(self) -> bool:
        """Whether this is what a loop of events adds, which has no place on a track."""
        return bool(self.place.shape[1] == 0)

    @property
    def has_bands(self) -> bool:
        """Whether the record is long enough for frequency bands."""
        return len(self.edges_hz) > 2

    @property
    def place_length(self) -> Floats:
        """Part of the event that each bin is long, (x,)."""
        length = np.diff(self.place_s)
        return np.asarray(length / length.sum())


@dataclass(frozen=True, slots=True, eq=False)
class Attribution:
    """The damage of some points shared out, event by event."""

    points: Points
    events: tuple[EventAttribution, ...]

    def of(self, index: NDArray[np.int64] | slice) -> Self:
        """The same of some of the points."""
        return replace(self, points=self.points.of(index), events=tuple(event.of(index) for event in self.events))

    @property
    def damage(self) -> Floats:
        """Miner sum of every point per km of the mission, (p,) [1/km]."""
        return np.asarray(sum(event.damage for event in self.events))

    def share(self, part: Floats) -> Floats:
        """Damages or slopes (p, ...) over the damage of their point; 0 where nothing damages."""
        damage = self.damage.reshape(-1, *[1] * (part.ndim - 1))
        return np.divide(part, damage, out=np.zeros_like(part), where=damage > 0.0)

    @property
    def event_share(self) -> Floats:
        """Share of every event, (p, e)."""
        return self.share(np.stack([event.damage for event in self.events], axis=1))

    @property
    def mode_share(self) -> Floats:
        """Share of every mode and unit load over all events, (p, c); below 0 where it relieves."""
        return self.share(np.asarray(sum(event.mode for event in self.events)))

    @property
    def resonant_share(self) -> Floats:
        """Part of ``mode_share`` that each mode makes in its own resonance, (p, c); NaN without damping."""
        return self.share(np.asarray(sum(event.resonant for event in self.events)))

    @property
    def mode_exponent(self) -> Floats:
        """Exponents d ln(life) / d ln(amplitude) of every mode and unit load in all events, (p, c)."""
        return -self.share(np.asarray(sum(event.mode_slope for event in self.events)))

    @property
    def band_share(self) -> Floats:
        """Share of every frequency band, (p, b + 1); the last column is what events too short for bands make."""
        resolved = [event.band for event in self.events if event.has_bands]
        short = sum((event.damage for event in self.events if not event.has_bands), np.zeros(len(self.points)))
        return self.share(np.column_stack([np.asarray(sum(resolved)), short] if resolved else [short]))


def numbers_of_point(plan: Plan, coordinates: int, bins: Bins) -> int:
    """How many numbers are held of one point for all events."""
    places = sum(TIME_BINS if one.length is None else int(one.length / bins.length_km) + 1 for one in plan.passes)
    return places + len(plan.passes) * (3 * coordinates + 2 * len(bins.edges_hz) + _OTHER_NUMBERS)


def attribute_event(points: Points, load: EventLoad, one_pass: Pass, modes: Modes, bins: Bins) -> EventAttribution:
    """Damage of one event at some points, shared out; the first coordinates of its record are ``modes``."""
    q = load.counted.q
    inner = bins.edges_hz if load.moments is not None else np.zeros(0)
    place_s, place_km = _place_edges(load, one_pass, bins.length_km)
    blocks = list(
        long_blocks(points, load, q, modes, inner, place_s)
        if is_long(q)
        else _blocks(points, load, np.asarray(q), modes, inner, place_s)
    )
    per_pass = {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}
    damage, top_cycle = per_pass["damage"], per_pass.pop("top_cycle")
    return EventAttribution(
        event=one_pass.event,
        top_cycle_share=np.divide(top_cycle, damage, out=np.full_like(damage, np.nan), where=damage > 0.0),
        edges_hz=np.array([0.0, *inner, np.inf]),
        place_s=place_s,
        place_km=place_km,
        **{name: one_pass.passes_per_km * value for name, value in per_pass.items()},
    )


def _blocks(
    points: Points, load: EventLoad, q: NDArray[np.floating], modes: Modes, edges_hz: Floats, place_s: Floats
) -> Iterator[dict[str, Floats]]:
    """Some points after the other, in one pass of the event, whose record is in memory."""
    residue = load.residue
    frequency = coefficient_frequencies(q.shape[1], load.counted.step, residue)
    bands = band_slices(frequency, edges_hz)
    Q = coefficients(q, residue)
    bin_of_sample = np.searchsorted(
        place_s, load.counted.start + load.counted.step * np.arange(q.shape[1]), side="right"
    )
    bin_of_sample = np.clip(bin_of_sample - 1, 0, len(place_s) - 2)

    rows = max(1, _SAMPLES_AT_ONCE // q.shape[1])  # of the record only: the numbers are the same on every machine
    for first in range(0, len(points), rows):
        some = points.of(slice(first, first + rows))
        modal_m, modal_b = load.stress_factor * some.membrane, load.stress_factor * some.bending
        sigma_m, sigma_b = modal_m @ q, modal_b @ q
        modal_s = modal_m + some.side[:, None] * modal_b
        of_points = zip(sigma_m, sigma_b, some.side, some.size, some.rule, modal_s @ load.offset, strict=True)
        counted = [
            count_credit(m, b, side, size, rule, residue, offset, vertex=load.vertex)
            for m, b, side, size, rule, offset in of_points
        ]
        share = coefficients(np.stack([c.share for c in counted]), residue)
        by_m, by_b = np.stack([c.by_membrane for c in counted]), np.stack([c.by_bending for c in counted])
        owed = modal_s[:, :, None] * band_products(share, Q, bands)
        slope = modal_m[:, :, None] * band_products(coefficients(by_m, residue), Q, bands)
        slope += modal_b[:, :, None] * band_products(coefficients(by_b, residue), Q, bands)
        by_offset = np.array([c.by_offset for c in counted])[:, None] * load.offset
        slope[:, :, 0] += modal_s * by_offset  # what is constant has the frequency 0
        constant = by_offset * (modal_m + 2.0 * some.side[:, None] * modal_b)
        load_slope = np.array([c.slope for c in counted])
        yield {
            "damage": np.array([c.damage for c in counted]),
            "top_cycle": np.array([c.top_cycle for c in counted]),
            "load_slope": load_slope,
            "thickness_slope": -np.vecdot(by_m, sigma_m) - 2.0 * np.vecdot(by_b, sigma_b) - constant.sum(axis=1),
            "rule_slope": load_slope * some.size_exponent,
            "mode": owed.sum(axis=2),
            "mode_slope": slope.sum(axis=2),
            "resonant": modal_s * _resonant_products(share, Q, frequency, modes),
            "band": owed.sum(axis=1),
            "band_slope": slope.sum(axis=1),
            "place": np.stack([np.bincount(bin_of_sample, c.place, len(place_s) - 1) for c in counted]),
        }


def count_credit(
    sigma_m: Floats,
    sigma_b: Floats,
    side: float,
    size: float,
    rule: CycleRule,
    residue: Residue,
    offset: float = 0.0,
    *,
    vertex: bool,
) -> Credit:
    """Damage of one face of one station, side +1 or -1, counted and laid on the instants of its cycles.

    ``offset`` is the constant stress of the face beside the samples [MPa]. With ``vertex`` each reversal is read at its
    vertex.
    """
    if vertex:
        moved = vertex_history(sigma_m, sigma_b, side, recurs=residue == "repeat")
        cycles = rainflow(moved.membrane + side * moved.bending, residue)
        return credit(cycles, moved.membrane, moved.bending, side, size, rule, offset, moved.shift)
    cycles = rainflow(sigma_m + side * sigma_b, residue)
    return credit(cycles, sigma_m, sigma_b, side, size, rule, offset)


def _resonant_products(share: Floats, Q: Floats, frequency: Floats, modes: Modes) -> Floats:
    """Products of the share vectors (p, t) with each mode's coordinate in its own resonance: (p, c)."""
    half_width = 2.0 * modes.damping_ratio * modes.frequency
    products = np.full((len(share), len(Q)), np.nan)
    for k in np.flatnonzero(np.isfinite(half_width)):
        low, high = modes.frequency[k] + half_width[k] * np.array([-1.0, 1.0])
        own = slice(*np.searchsorted(frequency, [low, high]).tolist())
        products[:, k] = share[:, own] @ Q[k, own]
    return products


def _place_edges(load: EventLoad, one_pass: Pass, bin_km: float) -> tuple[Floats, Floats]:
    """Edges of the bins of the track in file time [s] and in distance [km]."""
    if one_pass.length is None:
        bins = min(TIME_BINS, load.counted.q.shape[1])
        parts, distance = np.linspace(0.0, 1.0, bins + 1), np.full(bins + 1, np.nan)
    else:
        bins = max(1, int(np.ceil(one_pass.length / bin_km - 1e-9)))
        distance = np.append(bin_km * np.arange(bins), one_pass.length)
        parts = distance / one_pass.length
    return load.counted.start + parts * load.duration, distance
