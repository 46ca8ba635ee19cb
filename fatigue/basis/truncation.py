"""What the highest modes carry: the damage of every weld once more without them.

Modes of high frequency are where a basis ends. Where a weld hardly notices that the last ones are gone, more of them
would hardly be noticed either; where its life moves, the force that reaches it is made by the end of the basis. The
coordinates stay those of the simulation, so this is no other simulation: it says what the modes carry.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.basis.counted import FACES, MOST_SAMPLES, CountedGroup, OpenCase, counted
from fatigue.basis.finding import Finding
from fatigue.basis.loaded.shapes import elastic
from fatigue.pipeline.multiaxial.method import DECIDING
from fatigue.readers.neutral.body.modes import Modes
from fatigue.shown import few
from fatigue.stages import stage

Floats = NDArray[np.float64]

HEADING = "Damage without the highest modes"
SHARES = (0.1, 0.2, 0.3)
MOVES = 1.2  # of a life, up or down: records of 5 km that differ by chance alone scatter the damage by 17 %
ALL, NORMAL, INTERFACE = "all", "normal", "interface"
NOTHING_DAMAGES = "nothing damages the weld"
NOTHING_LEFT = "without them nothing damages the weld: there is no end to its life"


@dataclass(frozen=True, slots=True, eq=False)
class LeftOut:
    """The highest of some modes: ``of`` names them, ``share`` is the part asked for, ``mask`` (m,) marks them."""

    of: str
    share: float
    mask: NDArray[np.bool_]

    def in_words(self, modes: Modes) -> str:
        """How many they are, of which kind and from which frequency."""
        which = "the interface modes" if self.of == INTERFACE else f"the highest {100 * self.share:g} % of the modes"
        which = f"the highest {100 * self.share:g} % of the normal modes" if self.of == NORMAL else which
        kinds = np.array(modes.kind)[self.mask]
        made_of = " and ".join(f"{int((kinds == kind).sum())} {kind}" for kind in (NORMAL, INTERFACE) if kind in kinds)
        return f"{which} ({made_of}, from {modes.frequency[self.mask].min():.4g} Hz)"


@dataclass(frozen=True, slots=True)
class TruncationRow:
    """One weld without some modes; see the columns of ``truncation``."""

    left_out_of: str
    share: float
    modes: int
    interface_modes: int
    from_hz: float
    weld: str
    part: int
    node: int
    order: int
    surface: str
    utilisation: float
    utilisation_without: float
    life_ratio: float
    shortest_life_ratio: float
    moves: bool | None
    reason: str


def truncation(case: OpenCase, shares: Sequence[float] = SHARES) -> Finding:
    """Damage of the worst point of every weld without the highest modes, as without them among ``ignore_modes``.

    Left out are the highest of all elastic modes, the highest of the normal modes alone, which says whether these reach
    high enough, and all interface modes.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    modes = case.body.modes
    choices = left_out(modes, shares)
    stage("counting without the highest modes (%d times)", len(choices))
    groups = counted(case, [choice.mask for choice in choices])
    rows = tuple(row for v, choice in enumerate(choices) for group in groups for row in _rows(group, v, choice, modes))
    said = [line for choice in choices for line in _said(choice, [r for r in rows if _is_of(r, choice)], modes)]
    return Finding("truncation", HEADING, tuple(said), rows, tuple(_notes(case, choices, len(shares))))


def left_out(modes: Modes, shares: Sequence[float] = SHARES) -> list[LeftOut]:
    """Choices of modes to leave out, each another one, and never all elastic modes."""
    kind, elastic_modes = np.array(modes.kind), elastic(modes)
    of_interface = elastic_modes & (kind == INTERFACE)
    choices = [LeftOut(ALL, share, highest(modes, elastic_modes, share)) for share in shares]
    if of_interface.any():
        normal = elastic_modes & (kind == NORMAL)
        choices += [LeftOut(NORMAL, share, highest(modes, normal, share)) for share in shares]
        choices.append(LeftOut(INTERFACE, 1.0, of_interface))
    found: list[LeftOut] = []
    for one in choices:
        is_new = not any(np.array_equal(one.mask, other.mask) for other in found)
        if is_new and one.mask.any() and (elastic_modes & ~one.mask).any():
            found.append(one)
    return found


def highest(modes: Modes, among: NDArray[np.bool_], share: float) -> NDArray[np.bool_]:
    """The highest by frequency of some modes (m,), the rounded share of them and at least one."""
    those = np.flatnonzero(among)
    count = min(len(those), max(1, round(share * len(those))))
    order = those[np.argsort(modes.frequency[those], kind="stable")]
    mask = np.zeros(len(among), dtype=np.bool_)
    mask[order[len(those) - count :]] = True
    return mask


def life_ratio(utilisation: float, other: float) -> tuple[float, str]:
    """Life under another utilisation over life under this one, and why it is empty or has no end."""
    if utilisation <= 0.0:
        return np.nan, NOTHING_DAMAGES
    return (np.inf, NOTHING_LEFT) if other <= 0.0 else (utilisation / other, "")


def moves(ratio: float) -> bool | None:
    """Whether a life ratio is beyond what is stated; None where there is none."""
    return None if np.isnan(ratio) else bool(max(ratio, 1.0 / ratio) > MOVES)


def times(ratio: float) -> str:
    """A life ratio in words.

    >>> times(3627.4), times(0.8176), times(float("inf"))
    ('3630 times as long', '0.818 times as long', 'without end')
    """
    return "without end" if np.isinf(ratio) else f"{float(f'{ratio:.3g}'):g} times as long"


def _rows(group: CountedGroup, v: int, choice: LeftOut, modes: Modes) -> Iterator[TruncationRow]:
    """Every weld of a group without the modes of one choice."""
    full, without = group.utilisation, group.without[v]
    kind = np.array(modes.kind)
    for (station, face), other in zip(group.worst(full), group.worst(without), strict=True):
        ratio, reason = life_ratio(full[station, face], without[station, face])
        shortest, _ = life_ratio(full[station, face], without[other])
        weld, part, order = group.place(station)
        yield TruncationRow(
            left_out_of=choice.of,
            share=choice.share,
            modes=int(choice.mask.sum()),
            interface_modes=int((choice.mask & (kind == INTERFACE)).sum()),
            from_hz=float(modes.frequency[choice.mask].min()),
            weld=weld,
            part=part,
            node=int(group.node[station]),
            order=order,
            surface=FACES[face],
            utilisation=float(full[station, face]),
            utilisation_without=float(without[station, face]),
            life_ratio=ratio,
            shortest_life_ratio=shortest,
            moves=moves(shortest),
            reason=reason,
        )


def _is_of(row: TruncationRow, choice: LeftOut) -> bool:
    return (row.left_out_of, row.share) == (choice.of, choice.share)


def _said(choice: LeftOut, rows: Sequence[TruncationRow], modes: Modes) -> Iterator[str]:
    """One sentence for each choice of modes."""
    what = choice.in_words(modes)
    known = [row for row in rows if row.moves is not None]
    moving = sorted((row for row in known if row.moves), key=_size, reverse=True)
    if not known:
        yield f"Without {what}: nothing damages any weld."
    elif not moving:
        most = max(known, key=_size)
        yield (
            f"Without {what} no life moves by more than a factor of {MOVES:g}; most does that of {most.weld}, "
            f"{times(most.shortest_life_ratio)}."
        )
    else:
        each = few([f"{row.weld} {times(row.shortest_life_ratio)}" for row in moving])
        yield f"Without {what} {len(moving)} of {len(known)} lives move by more than a factor of {MOVES:g}: {each}."


def _size(row: TruncationRow) -> float:
    return abs(float(np.log(row.shortest_life_ratio)))


def _notes(case: OpenCase, choices: Sequence[LeftOut], shares: int) -> Iterator[str]:
    """What the numbers assume, of so many shares that were asked for."""
    kind = np.array(case.body.modes.kind)
    if not choices:
        yield "Nothing can be left out: the body has a single elastic mode."
        return
    if len(choices) < (2 * shares + 1 if INTERFACE in kind else shares):
        yield "Of so few modes some shares are the same modes, or all of them: each choice was counted once."
    yield (
        f"A life moves where it is longer or shorter by more than a factor of {MOVES:g}; records of 5 km that differ "
        "by chance alone scatter the damage by 17 % (standard deviation)."
    )
    if any(choice.of == ALL and (kind[choice.mask] == INTERFACE).all() for choice in choices):
        yield (
            "The highest modes are all interface modes: what moves without them shows how much of the force at the "
            "weld is local, not that normal modes are missing. The rows of the normal modes show that."
        )
    if INTERFACE not in kind:
        yield "The basis has no interface modes, so the highest modes are normal ones."
    yield (
        "The coordinates stay those of the simulation with all modes. A simulation without these modes would move the "
        "others as well."
    )
    if not case.is_small:
        yield (
            f"The case is large (more than {MOST_SAMPLES:.0e} stress samples, or very many stations): only the worst "
            "point of every weld was counted without the modes, and another may have the shorter life then."
        )
    method = case.body.case.multiaxial.method
    if method in DECIDING:
        yield f"Lives rest on the normal stress here, and not on multiaxial.method = {method!r} as in the assessment."
    if case.body.points is not None or case.body.throats:
        yield "Stress points and throats are not counted without the modes: only the toes of the weld lines are."
