"""Numbers over the seeds: mean, scatter, extremes; of lives and damage those of their logarithm."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import exp, inf, isfinite, log, nan, sqrt

from fatigue.study.quantities import Number, is_life

Key = tuple[str, str]  # quantity and weld


@dataclass(frozen=True, slots=True)
class Spread:
    """Mean, standard deviation (n - 1) and extremes of numbers; ``mean`` is geometric of lives, with ``sd_log10``."""

    mean: float
    sd: float
    least: float
    most: float
    n: int
    sd_log10: float


@dataclass(frozen=True, slots=True)
class ScatterRow:
    """One quantity of one variant over the seeds; fields are columns of ``scatter.parquet``."""

    variant: str
    quantity: str
    weld: str
    mean: float
    sd: float
    min: float
    max: float
    n: int
    sd_log10: float
    unit: str
    reason: str


def by_variant(numbers: Iterable[Number]) -> dict[str, dict[Key, dict[int, Number]]]:
    """Numbers by variant, quantity with weld, and seed, in their order."""
    found: dict[str, dict[Key, dict[int, Number]]] = {}
    for number in numbers:
        of_variant = found.setdefault(number.variant, {})
        of_variant.setdefault((number.quantity, number.weld), {})[number.seed] = number
    return found


def spread(values: Sequence[float], *, of_logarithm: bool) -> Spread:
    """Mean, scatter and extremes of finite numbers, above 0 where the logarithm is meant.

    >>> round(spread([1.0, 100.0], of_logarithm=True).mean, 9), round(spread([1.0, 3.0], of_logarithm=False).sd, 3)
    (10.0, 1.414)
    """
    if not values:
        return Spread(nan, nan, nan, nan, 0, nan)
    n = len(values)
    mean, sd = _moments(values)
    sd_log10 = nan
    if of_logarithm:
        logarithm, sd_log = _moments([log(value) for value in values])
        mean, sd_log10 = exp(logarithm), sd_log / log(10.0)
    return Spread(mean, sd, min(values), max(values), n, sd_log10)


def _moments(values: Sequence[float]) -> tuple[float, float]:
    n = len(values)
    mean = sum(values) / n
    return mean, sqrt(sum((value - mean) ** 2 for value in values) / (n - 1)) if n > 1 else nan


def usable(value: float, *, of_logarithm: bool) -> bool:
    """Whether a number takes part in a mean."""
    return isfinite(value) and (value > 0.0 or not of_logarithm)


def scatter_rows(numbers: Iterable[Number]) -> list[ScatterRow]:
    """Scatter of every quantity of every variant, in the order of the numbers."""
    return [_row(variant, key, seeds) for variant, of in by_variant(numbers).items() for key, seeds in of.items()]


def _row(variant: str, key: Key, seeds: Mapping[int, Number]) -> ScatterRow:
    life = is_life(key[0])
    values = [number.value for number in seeds.values() if usable(number.value, of_logarithm=life)]
    found = spread(values, of_logarithm=life)
    unit = next(iter(seeds.values())).unit
    reason = _left_out([number for number in seeds.values() if not usable(number.value, of_logarithm=life)], len(seeds))
    return ScatterRow(
        variant, *key, found.mean, found.sd, found.least, found.most, found.n, found.sd_log10, unit, reason
    )


def _left_out(numbers: Sequence[Number], of: int) -> str:
    """Which seeds have no part, and why the first of them has none."""
    if not numbers:
        return ""
    first = numbers[0]
    why = first.reason or ("it is infinite" if first.value == inf else "it is 0 or below")
    return f"{len(numbers)} of {of} seeds have no part: {why}"
