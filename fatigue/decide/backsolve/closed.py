"""Answers in closed form, and which part of a range of shares meets a target."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class Span(NamedTuple):
    """Values from one end to the other; none where ``low`` is above ``high``."""

    low: Floats
    high: Floats


def km_per_year(life_km: Floats, years: float) -> Floats:
    """Mileage in a year at which lives [km] last so many years.

    >>> km_per_year(np.array([4.8e6]), 30.0)
    array([160000.])
    """
    return np.asarray(life_km / years)


def strength_factor(utilisation: Floats, slope: Floats | float) -> Floats:
    """Factor on the ranges of a straight curve that just meets the target, ``u^(1/k)``; 1 over the load factor.

    >>> strength_factor(np.array([2.5]), 3.6085450346420327).round(6)
    array([1.289072])
    """
    return np.asarray(utilisation ** (1.0 / slope))


def share_that_meets(held: Floats, own: Floats, rest: Floats, allowed: Floats | float) -> Floats:
    """Share s of an event with which the damage per km is ``allowed``: s own + (1 - s) rest + held.

    Parameters
    ----------
    held : damage per km that the share does not change: events by number, cycles across events
    own, rest : damage per km of the event, and of the mix of all others
    allowed : damage limit over target

    >>> share_that_meets(np.zeros(1), np.array([4e-8]), np.array([(3e-8 + 1.2e-8) / 0.3]), 1.0 / 1.2e7).round(6)
    array([0.566667])
    """
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return np.asarray((allowed - held - rest) / (own - rest))


def shares_that_meet(held: Floats, own: Floats, rest: Floats, allowed: Floats | float) -> Span:
    """Shares 0 to 1 with which the damage per km is at most ``allowed``; ``low`` above ``high``: none is.

    >>> span = shares_that_meet(np.zeros(2), np.array([3.0, 1.0]), np.array([1.0, 3.0]), 2.0)
    >>> span.low, span.high
    (array([0. , 0.5]), array([0.5, 1. ]))
    """
    at = share_that_meets(held, own, rest, allowed)
    rises, falls = own > rest, own < rest
    meets = held + rest <= allowed
    low = np.where(falls, np.maximum(at, 0.0), np.where(rises | meets, 0.0, np.inf))
    high = np.where(rises, np.minimum(at, 1.0), np.where(falls | meets, 1.0, -np.inf))
    return Span(low, high)
