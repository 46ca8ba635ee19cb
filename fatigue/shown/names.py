r"""Texts that somebody else wrote, as they are shown: what cannot be seen is spelled out, what is long is cut.

A name may hold a character that moves the cursor of a terminal, turns the direction of the letters behind it, or is no
letter at all. Tables keep such a name as it is; whoever reads it on a screen or a page sees ``\u202e`` in its place.
"""

import logging
import re
import unicodedata
from collections.abc import Sequence

LONGEST_NAME = 60  # letters of a name in a message or a text table
FEW = 3  # names of many in one message

_UNSEEN = ("Cc", "Cf", "Cs", "Zl", "Zp")  # control, direction and joining, half a character, ends of lines
_PERHAPS_UNSEEN = re.compile("[^\u0020-\u007e\u00a0-\u00ac\u00ae-\u05ff\u2030-\u205f\u20a0-\ud7ff]")


def visible(text: str, keep: str = "") -> str:
    r"""Text in which every character of control or direction is written as an escape, as ``\n`` or ``\u202e``.

    ``keep`` are characters that stay as they are.

    >>> print(visible("A\u202eB"))
    A\u202eB
    """
    return _PERHAPS_UNSEEN.sub(lambda found: found[0] if found[0] in keep else _escaped(found[0]), text)


def spelled_out(text: str) -> str:
    r"""Text in plain ASCII, everything else written as an escape: look-alikes differ in it.

    >>> print(spelled_out("W\u0435ld"))
    W\u0435ld
    """
    return visible(text).encode("ascii", "backslashreplace").decode("ascii")


def shortened(text: str, longest: int = LONGEST_NAME, mark: str = "...") -> str:
    """Text of so many characters at most, its middle, where names differ least, replaced by a mark if it has more.

    >>> shortened("abcdefghij", 9)
    'abcd...ij'
    """
    if len(text) <= longest:
        return text
    head = (longest - len(mark)) * 2 // 3
    return f"{text[:head]}{mark}{text[head + len(mark) - longest :]}"


def few(names: Sequence[object], most: int = FEW) -> str:
    """The first of some names, each of them short, and how many others there are.

    >>> few(["A", "B", "C", "D", "E"])
    'A, B, C and 2 more'
    """
    shown = ", ".join(shortened(str(name)) for name in names[:most])
    return shown if len(names) <= most else f"{shown} and {len(names) - most} more"


class VisibleFormatter(logging.Formatter):
    """Log lines without a character that could not be seen; a name with the end of a line in it begins no new one."""

    def formatMessage(self, record: logging.LogRecord) -> str:  # noqa: N802  (its name in the standard library)
        """Compose the line without a traceback."""
        return visible(super().formatMessage(record))


def _escaped(character: str) -> str:
    if unicodedata.category(character) not in _UNSEEN:
        return character
    return (
        character.encode("ascii", "backslashreplace").decode("ascii") if ord(character) > 127 else repr(character)[1:-1]
    )
