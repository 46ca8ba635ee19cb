"""Sentences of the page: what was varied and run, what came out of the claims, what the study is not."""

import math
from collections import Counter
from collections.abc import Iterator, Sequence

from fatigue.report.wording import LONGEST, listed, number, short, whole
from fatigue.study.claims.verdict import CONTRADICTED, REPRODUCED, UNDECIDED, Scatter, Verdict
from fatigue.study.page.studied import Studied, Varied
from fatigue.study.variants.varied.names import shown

MOST_VALUES = 8  # of one thing in a sentence
OWN_VEHICLE = (
    "The vehicle is invented, no number is a property of a real train, and nothing here validates a paper. "
    "A verdict says what this model does."
)
OTHER_SOURCE = "A verdict says what these simulations do, and nothing of what they were not made for."


def caution(of: Studied) -> str:
    """What the study is not."""
    return OWN_VEHICLE if of.vehicle is not None else OTHER_SOURCE


def story(of: Studied) -> Iterator[str]:
    """What was varied, under how many seeds, where histories come from, what was done with them."""
    if of.varied:
        things = listed([_varied(one) for one in of.varied])
        yield f"This study varies {things}{_combined(of)}."
    else:
        yield "This study varies nothing: it has its base alone."
    variants, seeds = len(of.variants), len(of.seeds)
    done = sum(run.state == "done" for run in of.runs)
    count = f"{whole(variants)} variant{'s' * (variants != 1)} under {whole(seeds)} seed{'s' * (seeds != 1)}"
    state = "all are done" if done == len(of.runs) else f"{whole(done)} are done, the others stand below"
    yield f"There are {count}, {whole(len(of.runs))} run{'s' * (len(of.runs) != 1)} in all: {state}."
    base = listed([name for name in (of.vehicle, of.case) if name])
    lives = "every run is assessed to lives in km" if of.case else "there is no case, so runs have numbers and no lives"
    yield f"The base is {base}. The histories are {of.source}; {lives}."
    if seeds == 1:
        yield "One seed has no scatter: what differs by little here may differ the other way under another seed."


def _combined(of: Studied) -> str:
    """How variants are made of what is varied."""
    sizes = [len(one.values) for one in of.varied]
    made = math.prod(sizes) if of.combine == "full" else 1 + sum(size - 1 for size in sizes)
    how = "" if len(sizes) == 1 else ", in combination" if of.combine == "full" else ", one at a time"
    return how if made == len(of.variants) else f"{how}, beside variants stated by themselves"


def _varied(one: Varied) -> str:
    values = [shown(value) for value in one.values]
    few = listed(values) if len(values) <= MOST_VALUES else f"{len(values)} values from {values[0]} to {values[-1]}"
    return f"{short(one.name)} ({few})"


def outcome(verdicts: Sequence[Verdict]) -> str:
    """How many claims came out how."""
    count = Counter(one.verdict for one in verdicts)
    parts = [
        f"{count[word]} {'is' if count[word] == 1 else 'are'} {word}"
        for word in (REPRODUCED, CONTRADICTED, UNDECIDED)
        if count[word]
    ]
    return (
        f"The one claim is {verdicts[0].verdict}."
        if len(verdicts) == 1
        else f"Of {len(verdicts)} claims {listed(parts)}."
    )


def spelled(value: float) -> str:
    """Number with four digits, above 1e12, too, where a life would be written as longer than that."""
    return f"{value:.3e}".replace("e+", "e") if LONGEST < abs(value) < math.inf else number(value)


def told(side: Scatter, unit: str) -> str:
    """One side of a claim: its mean, and least and greatest of several seeds."""
    unit = f" {unit}" if unit not in ("", "-") else ""
    if side.known == 0:
        return "no number"
    if side.known == 1 or side.low == side.high:
        return f"{spelled(side.mean)}{unit}"
    return f"{spelled(side.mean)}{unit} ({spelled(side.low)} to {spelled(side.high)})"


def right_of(one: Verdict) -> str:
    """The right side of a claim: of 'between' both ends, where they are numbers, else the nearer one."""
    ends = [one.claim.factor * side for side in one.claim.right_sides if isinstance(side, float)]
    unit = f" {one.unit}" if one.unit not in ("", "-") else ""
    if one.claim.operator == "between" and len(ends) == 2:
        return f"{ends[0]:g} to {ends[1]:g}{unit}"
    times = "" if one.claim.factor == 1.0 else f", which is {one.claim.factor:g} times what was found"
    return told(one.right, one.unit) + times


def agreement(one: Verdict) -> str:
    """How many seeds say what."""
    n = len(one.of_seeds)
    if n == 1:
        return {"holds": "the one seed holds the sentence", "reverse": "the one seed holds its reverse"}.get(
            one.of_seeds[0].says, "the one seed decides nothing"
        )
    both = f"{one.count('holds')} of {n} seeds hold the sentence, {one.count('reverse')} its reverse"
    return f"{both}; {one.needed} have to agree"
