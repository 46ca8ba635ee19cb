"""Whose damage it is: that of every point, event by event, shared out to modes, frequency bands and places on the track.

One pass over the records. Cycles are counted as in the assessment, so the parts add up to the damage of the result; see
`fatigue.life.attribution` for the method. Everything is weighted with the mission: damages are per km, and the sum over
the events is the ``damage_per_km`` of a point.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fatigue.event_block import EventLoad
from fatigue.life.attribution import Credit, DamageRule, credit, size_exponent
from fatigue.life.damage import size_factor
from fatigue.life.mission import Pass
from fatigue.life.rainflow import rainflow
from fatigue.model import Model
from fatigue.spectrum.bands import band_products, band_slices, coefficient_frequencies, coefficients

Floats = NDArray[np.float64]
Progress = Callable[[int, int], None]

TIME_BINS = 40  # of an event that has no distance
_SAMPLES_AT_ONCE = 1_000_000  # of each time vector of a piece of points: 8 MB


@dataclass(frozen=True, slots=True, eq=False)
class Points:
    """Points whose damage is shared out, (p,): station, face (0 top, 1 bottom) and why they were chosen."""

    station: NDArray[np.int64]
    face: NDArray[np.int64]
    chosen: NDArray[np.object_]

    def __len__(self) -> int:
        """Count the points."""
        return len(self.station)


@dataclass(frozen=True, slots=True, eq=False)
class EventAttribution:
    """The damage of one event at p points, per km of the mission [1/km]; a slope is a derivative of that damage.

    Attributes
    ----------
    event : name
    damage : (p,) Miner sum
    load_slope : (p,) by ln(load), all stresses of the event scaled
    thickness_slope : (p,) by ln(t) through the stress, at constant line force and moment: membrane ~ 1/t, bending ~ 1/t^2
    rule_slope : (p,) by ln(t) through the thickness rule of the curve
    mode, mode_slope : (p, m) damage owed to each mode, below 0 where it relieves; slope by ln(amplitude) of the mode
    resonant : (p, m) part of ``mode`` within the half-power band f (1 +- 2 zeta) of the mode; NaN without damping
    band, band_slope : (p, b) the same for the frequency bands
    edges_hz : (b + 1,) edges of the bands; one band from 0 to infinity for a record too short to have a spectrum
    place : (p, x) damage credited half and half to the two instants of each cycle, per bin of the track
    place_s : (x + 1,) file time of the edges of the bins [s]
    place_km : (x + 1,) distance from the first kept sample of the same edges [km]; NaN for an event counted by number
    """

    event: str
    damage: Floats
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

    @property
    def has_bands(self) -> bool:
        """Whether the record is long enough for frequency bands."""
        return self.band.shape[1] > 1


def attribute_event(
    model: Model, load: EventLoad, one_pass: Pass, points: Points, edges_hz: Sequence[float] | Floats, bin_km: float
) -> EventAttribution:
    """Share out the damage of one event at some points.

    ``edges_hz`` are ascending edges between frequency bands, ``bin_km`` the length of a bin of the track [km].
    """
    q, residue = load.counted.q, load.residue
    frequency = coefficient_frequencies(q.shape[1], load.counted.step, residue)
    inner = np.asarray(edges_hz if load.moments is not None else (), dtype=np.float64)
    bands = band_slices(frequency, inner)
    Q = coefficients(q, residue)
    place_s, place_km = _place_edges(load, one_pass, bin_km)
    time = load.counted.start + load.counted.step * np.arange(q.shape[1])
    bin_of_sample = np.clip(np.searchsorted(place_s, time, side="right") - 1, 0, len(place_s) - 2)

    rows = max(1, _SAMPLES_AT_ONCE // q.shape[1])  # depends on the record only: the numbers do not depend on the machine
    pieces = []
    for first in range(0, len(points), rows):
        piece = slice(first, first + rows)
        station, face = points.station[piece], points.face[piece]
        shapes_m = load.stress_factor * model.stations.treated.membrane[station]
        shapes_b = load.stress_factor * model.stations.treated.bending[station]
        side = np.where(face == 0, 1.0, -1.0)
        sigma_m, sigma_b = shapes_m @ q, shapes_b @ q
        credits = [
            point_credit(m, b, s, damage_rule(model, at), load)
            for m, b, s, at in zip(sigma_m, sigma_b, side, station, strict=True)
        ]
        share = coefficients(np.stack([c.share for c in credits]), residue)
        by_m, by_b = np.stack([c.by_membrane for c in credits]), np.stack([c.by_bending for c in credits])
        stress_shapes = shapes_m + side[:, None] * shapes_b
        owed = stress_shapes[:, :, None] * band_products(share, Q, bands)
        slope = shapes_m[:, :, None] * band_products(coefficients(by_m, residue), Q, bands)
        slope += shapes_b[:, :, None] * band_products(coefficients(by_b, residue), Q, bands)
        load_slope = np.array([c.slope for c in credits])
        exponent = np.array([_size_exponent(model, at) for at in station])
        pieces.append(
            (
                np.array([c.damage for c in credits]),
                load_slope,
                -np.einsum("pt,pt->p", by_m, sigma_m) - 2.0 * np.einsum("pt,pt->p", by_b, sigma_b),
                load_slope * exponent,
                owed.sum(axis=2),
                slope.sum(axis=2),
                stress_shapes * _resonant_products(share, Q, frequency, model),
                owed.sum(axis=1),
                slope.sum(axis=1),
                np.stack([np.bincount(bin_of_sample, c.place, len(place_s) - 1) for c in credits]),
            )
        )
    weighted = [one_pass.passes_per_km * np.concatenate(parts) for parts in zip(*pieces, strict=True)]
    return EventAttribution(
        one_pass.event, *weighted[:9], np.array([0.0, *inner, np.inf]), weighted[9], place_s, place_km
    )


def damage_with_mode_scaled(
    model: Model, load: EventLoad, points: Points, mode: NDArray[np.int64], factor: float
) -> Floats:
    """Count one pass of an event with one mode's amplitude scaled: (p,), ``mode`` (p,) an index into the modes."""
    damage = np.empty(len(points))
    treated, q = model.stations.treated, load.counted.q
    for i, (at, face, k) in enumerate(zip(points.station, points.face, mode, strict=True)):
        scale = np.full(len(q), load.stress_factor)
        scale[k] *= factor
        side = 1.0 if face == 0 else -1.0
        m, b = (scale * treated.membrane[at]) @ q, (scale * treated.bending[at]) @ q
        damage[i] = point_credit(m, b, side, damage_rule(model, at), load).damage
    return damage


def point_credit(sigma_m: Floats, sigma_b: Floats, side: float, rule: DamageRule, load: EventLoad) -> Credit:
    """Count one face of one station, side +1 or -1, and lay its damage on the instants of its cycles."""
    cycles = rainflow(sigma_m + side * sigma_b, load.residue)
    return credit(cycles.start, cycles.end, cycles.count, sigma_m, sigma_b, side, rule)


def damage_rule(model: Model, station: int) -> DamageRule:
    """Find the rule from stress range to damage at a station: its curve, its thickness, the mean-stress option."""
    rated = model.curves[model.curve_of_weld[model.stations.weld[station]]]
    curve = model.case.curve
    thickness = model.stations.thickness[station : station + 1]
    return DamageRule(
        law=rated.law,
        size=float(size_factor(thickness, rated.curve, curve.thickness_rule)[0]),
        uses_bending_ratio=rated.curve.applies == "dS",
        yield_MPa=curve.yield_MPa if curve.mean_stress == "asme" else None,
    )


def _size_exponent(model: Model, station: int) -> float:
    rated = model.curves[model.curve_of_weld[model.stations.weld[station]]]
    return size_exponent(float(model.stations.thickness[station]), rated.curve, model.case.curve.thickness_rule)


def _resonant_products(share: Floats, Q: Floats, frequency: Floats, model: Model) -> Floats:
    """Products of the share vectors (p, t) with each mode's coordinate in its own half-power band: (p, m)."""
    half_width = 2.0 * model.modes.damping_ratio * model.modes.frequency
    products = np.full((len(share), len(Q)), np.nan)
    for k in np.flatnonzero(np.isfinite(half_width)):
        low, high = model.modes.frequency[k] + half_width[k] * np.array([-1.0, 1.0])
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
