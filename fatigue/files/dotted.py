"""Keys of a case with dots between them, as in ``mission.event.worn.stress_factor``, where a table has its name.

A list of tables is entered by the ``name`` of one of them, which may itself hold dots; a list of tables without names,
as ``mission.sequence.1.per_1000_km``, by the number of one.
"""

import difflib
from collections.abc import Mapping
from typing import Any


class NoSuchKey(LookupError):
    """A key that leads nowhere; ``what`` and ``remedy`` say where it ends."""

    def __init__(self, what: str, remedy: str) -> None:
        super().__init__(what)
        self.what, self.remedy = what, remedy


def value_at(tables: Mapping[str, Any], key: str) -> Any:
    """Value under a key, None where there is none.

    Raises
    ------
    NoSuchKey : a table of a list that is not there, or a key inside something that is no table
    """
    table, last = _last_table(tables, key, makes=False)
    return None if table is None else table.get(last)


def put(tables: dict[str, Any], key: str, value: Any) -> None:
    """Set the value under a key, in place; tables on the way are made.

    Raises
    ------
    NoSuchKey : as ``value_at``
    """
    table, last = _last_table(tables, key, makes=True)
    table[last] = value


def _last_table(tables: Any, key: str, *, makes: bool) -> tuple[Any, str]:
    """The table that has the last part of a key, None where there is none, and this part."""
    if key.startswith(".") or key.endswith("."):
        raise NoSuchKey(f"{key!r} is no key: something is missing beside a dot", "Write the tables and the key")
    at, done, rest = tables, "", key
    while rest:
        if isinstance(at, list):
            at, part, rest = _named(at, done, rest)
        elif isinstance(at, Mapping):
            part, _, rest = rest.partition(".")
            if not rest:
                return at, part
            if part not in at and not makes:
                return None, rest
            at = at.setdefault(part, {}) if isinstance(at, dict) else at[part]
        else:
            what = f"{key!r} goes on inside {done!r}, which is no table"
            raise NoSuchKey(what, "Write the tables and the key")
        done = f"{done}.{part}".lstrip(".")
    raise NoSuchKey(f"{key!r} is a table, not a key in one", "Write the tables and the key")


def _named(tables: list[Any], done: str, rest: str) -> tuple[Any, str, str]:
    """The table of a list whose name a key begins with, the name, and the rest of the key; of several the longest."""
    names = [name for table in tables if isinstance(table, Mapping) and isinstance(name := table.get("name"), str)]
    if tables and not names:
        return _numbered(tables, done, rest)
    fitting = [name for name in names if rest == name or rest.startswith(f"{name}.")]
    if not fitting:
        wanted = rest.rpartition(".")[0] or rest
        near = difflib.get_close_matches(wanted, names, n=1)
        there = f"they are {', '.join(map(repr, names))}" if names else "it has none with a name"
        remedy = f"Write {near[0]!r}" if near else f"Name one of {done}; {there}"
        raise NoSuchKey(f"{done} has no table of the name {wanted!r}", remedy)
    name = max(fitting, key=len)
    found = next(table for table in tables if isinstance(table, Mapping) and table.get("name") == name)
    return found, name, rest[len(name) + 1 :]


def _numbered(tables: list[Any], done: str, rest: str) -> tuple[Any, str, str]:
    """The table of a list without names that a key enters by its number from 1, the number, and the rest of the key."""
    number, _, after = rest.partition(".")
    if not number.isdecimal() or not 1 <= int(number) <= len(tables):
        remedy = "Write 1" if len(tables) == 1 else f"Write a number from 1 to {len(tables)}"
        raise NoSuchKey(f"{done} has no table {number!r}", remedy)
    return tables[int(number) - 1], number, after
