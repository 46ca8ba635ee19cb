"""Whether the classes that are given for welds are known; which of them may stand together is not judged."""

from collections.abc import Iterator, Sequence

from fatigue.errors import Problem
from fatigue.life.quality import is_known_class, known_classes
from fatigue.readers.neutral.body.welds import Weld
from fatigue.shown import few


def class_warnings(welds: Sequence[Weld], file: str) -> Iterator[Problem]:
    """Warning about performance and inspection classes that nobody knows, one for each of the two."""
    for column in ("performance_class", "inspection_class"):
        odd = [weld for weld in welds if (given := getattr(weld, column)) and not is_known_class(column, given)]
        if odd:
            named = few([f"{getattr(weld, column)!r} of {weld.name}" for weld in odd])
            what = f"{named}: none of {', '.join(known_classes(column))} (EN 15085-3, as recalled)"
            remedy = "Correct the class; it goes into the register as it is given"
            yield Problem("unknown_class", f"{file}: column {column}", what, remedy, len(odd))
