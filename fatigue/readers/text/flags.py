"""Words that say yes or no in a table."""

from collections.abc import Mapping

WORDS_OF_PROGRAMS: Mapping[str, bool] = {"true": True, "false": False}
"""In tables that programs write, where a column of numbers may hold 1 and 0 as well."""

WORDS_BY_HAND: Mapping[str, bool] = {
    **dict.fromkeys(("true", "1", "yes", "wahr", "ja", "vrai", "oui"), True),
    **dict.fromkeys(("", "false", "0", "no", "falsch", "nein", "faux", "non"), False),
}
"""In registers, as spreadsheets in several languages write them."""


def flag_of(text: str, words: Mapping[str, bool]) -> bool | None:
    """Flag that a trimmed text says in any letter case; None if it is none of the words."""
    return words.get(text.lower())
