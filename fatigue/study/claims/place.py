"""Which variant a term of a claim means, and what is wrong with one that means none."""

import difflib
import json
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace

from fatigue.errors import CaseError, Problem, refuse
from fatigue.study.claims.claim import Claim
from fatigue.study.claims.expression import Setting, Term
from fatigue.study.quantities import Variant

BY_NAME = "variant"  # [variant="E doubled"] names a variant itself; other settings are on top of it


def variant_of(term: Term, variants: Sequence[Variant]) -> Variant | None:
    """Variant with the settings of a term, all others those of the base, the first variant; None if there is none."""
    wanted = _wanted(term, variants)
    if wanted is None:
        return None
    fitting = (one for one in variants if all(is_same(one.settings.get(name), value) for name, value in wanted.items()))
    named = dict(term.settings).get(BY_NAME)
    return next(fitting, None) if named is None or len(term.settings) > 1 else _named(str(named), variants)


def refuse_unplaced(
    claims: Sequence[Claim],
    variants: Sequence[Variant],
    quantities: Collection[str] = (),
    keys: Mapping[str, str] | None = None,
    file: str = "study.toml",
) -> None:
    """Refuse claims that name what a study does not have; nothing need have run for it.

    ``quantities`` are those known before anything runs, none: they are not looked at. ``keys`` are the keys of the
    short names, for what is to be written into the study.

    Raises
    ------
    CaseError : every name, value, combination and quantity that is not there, with the nearest one
    """
    refuse(
        CaseError,
        (
            replace(problem, where=f"{file}: claim[{number}]: {term}")
            for number, claim in enumerate(claims, 1)
            for term in dict.fromkeys(term for side in claim.expressions for term in side.terms)
            for problem in (*_misplaced(term, variants, keys or {}), *_unknown_quantity(term, quantities))
        ),
    )


def is_same(held: object, asked: object) -> bool:
    """Whether a setting has a value: numbers by value, true and false as such, else texts by letters."""
    if isinstance(held, bool) or isinstance(asked, bool):
        return held is asked or str(held).lower() == str(asked).lower()
    if isinstance(held, int | float) and isinstance(asked, int | float):
        return held == asked
    if isinstance(held, str) and not isinstance(asked, str):
        return _as_number(held) == asked
    return str(held) == str(asked)


def _as_number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def _named(name: str, variants: Sequence[Variant]) -> Variant | None:
    return next((one for one in variants if one.name == name), None)


def _wanted(term: Term, variants: Sequence[Variant]) -> dict[str, object] | None:
    """All settings that a term means; None where the variant that it names is not there."""
    asked: dict[str, object] = dict(term.settings)
    named = asked.pop(BY_NAME, None)
    start = variants[0] if named is None else _named(str(named), variants)
    return None if start is None else {**start.settings, **asked}


def _misplaced(term: Term, variants: Sequence[Variant], keys: Mapping[str, str]) -> Iterator[Problem]:
    """Refusals of names, values and a combination of them that no variant has."""
    values = _values(variants)
    sound = True
    for name, value in term.settings:
        if name == BY_NAME:
            if _named(str(value), variants) is None:
                sound = False
                what = f"there is no variant {str(value)!r}"
                yield Problem("unknown_variant", "", what, _nearest(str(value), [one.name for one in variants]))
        elif name not in values:
            sound = False
            what = f"the study does not vary {name!r}"
            yield Problem("unknown_setting", "", what, _nearest(name, list(values), "It varies nothing; remove it"))
        elif not any(is_same(held, value) for held in values[name]):
            sound = False
            what = f"no variant has {name} = {_toml(value)}"
            near = _nearest(str(value), [str(held) for held in values[name]])
            yield Problem("unknown_value", "", what, f"{near}, or add it to the study")
    if sound and variant_of(term, variants) is None:
        asked = [(name, value) for name, value in term.settings if name != BY_NAME]
        together = ", ".join(f"{name} = {_toml(value)}" for name, value in asked)
        setting = ", ".join(f"{json.dumps(keys.get(name, name))} = {_toml(value)}" for name, value in asked)
        what = f"no variant of the study has {together} together"
        remedy = f'Add a [[variant]] with a name and set = {{ {setting} }}, or write combine = "full"'
        yield Problem("unknown_combination", "", what, remedy)


def _unknown_quantity(term: Term, quantities: Collection[str]) -> Iterator[Problem]:
    if quantities and term.quantity not in quantities:
        what = f"the study has no quantity {term.quantity!r}"
        yield Problem("unknown_quantity", "", what, _nearest(term.quantity, list(quantities)))


def _values(variants: Sequence[Variant]) -> dict[str, list[Setting]]:
    """Values that each setting has in any variant, in the order in which they come."""
    found: dict[str, list[Setting]] = {}
    for one in variants:
        for name, value in one.settings.items():
            held = found.setdefault(name, [])
            if not any(is_same(value, other) for other in held):
                held.append(value)
    return found


def _nearest(name: str, known: Sequence[str], without: str = "There is none to choose from") -> str:
    if near := difflib.get_close_matches(name, known, n=1):
        return f"Write {near[0]!r}"
    few = ", ".join(known[:12]) + (f" and {len(known) - 12} more" if len(known) > 12 else "")
    return f"Give one of {few}" if known else without


def _toml(value: object) -> str:
    return json.dumps(value, ensure_ascii=False) if isinstance(value, bool | str) else str(value)
