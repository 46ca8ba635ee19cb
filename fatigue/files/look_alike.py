"""Names that look alike on a screen and are not the same: by letter case, blanks, dashes, or other alphabets.

A copied name may bring a blank that does not break, a letter of another alphabet that looks like a Latin one, or a
character that is not seen at all. Every such name is a name of its own, with rows of its own.
"""

import re
import unicodedata
from collections.abc import Iterable, Sequence

from fatigue.errors import Problem
from fatigue.shown import FEW, LONGEST_NAME, few, shortened, spelled_out, visible

_LATIN = str.maketrans(
    "АВЕКМНОРСТУХІЈЅԚԜаеорсухкіјѕԛԝһΑΒΕΖΗΙΚΜΝΟΡΤΥΧαικνορτυχı\u2010\u2011\u2012\u2013\u2014\u2015\u2212’‘",
    "ABEKMHOPCTYXIJSQWaeopcyxkijsqwh" + "ABEZHIKMNOPTYXaikvoptux" + "i" + "-------" + "''",
)
_NOT_SEEN = re.compile(
    "[\u115f\u1160\u2800\u3164\ufe00-\ufe0f\uffa0]"
)  # although Unicode takes them for letters or marks
_AROUND = 20  # letters shown on either side of the place where two long names differ


def name_warnings(where: str, names: Iterable[str], of: str) -> list[Problem]:
    """Warnings about names that look alike, and about characters in names that cannot be seen.

    ``of`` says what the names are, as ``welds``; ``where`` is the place they are from.
    """
    every = list(dict.fromkeys(names))
    return [*_similarity_warnings(where, every, of), *_unseen_warnings(where, every, of)]


def skeleton(name: str) -> str:
    """What a name looks like: equal for names that are easily taken for each other."""
    plain = unicodedata.normalize("NFKC", unicodedata.normalize("NFKC", name).translate(_LATIN).casefold())
    seen = (c for c in _NOT_SEEN.sub("", plain) if c.isspace() or visible(c) == c)
    return " ".join("".join(seen).split())


def _similarity_warnings(where: str, names: Sequence[str], of: str) -> list[Problem]:
    alike: dict[str, list[str]] = {}
    for name in names:
        alike.setdefault(skeleton(name), []).append(name)
    groups = [group for group in alike.values() if len(group) > 1]
    if not groups:
        return []
    shown = "; ".join(" and ".join(repr_of) for repr_of in map(_apart, groups[:FEW]))
    more = f"; and {len(groups) - FEW} more such groups" if len(groups) > FEW else ""
    what = f"names look alike and count as different {of}: {shown}{more}"
    remedy = "Write them alike if they are meant to be one, or give them names that can be told apart"
    return [Problem("similar_names", where, what, remedy, len(groups))]


def _unseen_warnings(where: str, names: Sequence[str], of: str) -> list[Problem]:
    hidden = [name for name in names if visible(name) != name]
    if not hidden:
        return []
    what = f"names of {of} hold characters that are not seen, or turn the direction of the text: "
    what += few([f"'{shortened(visible(name))}'" for name in hidden])
    return [Problem("unseen_character", where, what, "Remove these characters, if they are not meant", len(hidden))]


def _apart(group: Sequence[str]) -> list[str]:
    """Names of a group as plain ASCII, long ones about the first place where they differ."""
    spelled = [spelled_out(name) for name in group[: FEW + 1]]
    if max(map(len, spelled)) > LONGEST_NAME:
        columns = zip(*spelled, strict=False)
        at = next((i for i, letters in enumerate(columns) if len(set(letters)) > 1), min(map(len, spelled)))
        some = slice(max(0, at - _AROUND), at + _AROUND)
        spelled = [f"{'...' * (some.start > 0)}{name[some]}{'...' * (len(name) > some.stop)}" for name in spelled]
    return [f"'{name}'" for name in spelled]
