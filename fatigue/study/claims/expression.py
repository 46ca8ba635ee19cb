"""The grammar of a claim's sides: ``quantity[:weld or pattern][name=value,...]``, or one of these over another.

``conv_y_rms[fe=9.2,contact=worn]`` is a number of a whole run, ``life_km:W2_hanger*[fe=14]`` the worst of some welds,
``conv_y_rms[fe=9.2] / conv_y_rms[fe=14]`` a ratio. Blanks stand around the stroke of a ratio: a stroke without them
belongs to a name (``alarms/bogie``). A name with a colon, bracket, comma or such a stroke in it stands in quotation
marks, ``life_km:"seam: front [1]"``.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass

OVER = " / "
_QUOTED = re.compile(r'"([^"]*)"|' + r"'([^']*)'")
_NEEDS_QUOTES = re.compile(r"""[:\[\],='"]|\s/\s|^\s|\s$""")

Setting = float | int | str | bool


class ExpressionError(ValueError):
    """Text that is no expression: what is wrong, and what to write instead."""

    def __init__(self, what: str, remedy: str) -> None:
        super().__init__(what)
        self.what, self.remedy = what, remedy


@dataclass(frozen=True, slots=True)
class Term:
    """A number of one variant: quantity, weld or pattern ("" for that of the whole run), settings off the base."""

    quantity: str
    weld: str = ""
    settings: tuple[tuple[str, Setting], ...] = ()

    def __str__(self) -> str:
        """The term as it is written."""
        weld = f":{_spelled(self.weld)}" if self.weld else ""
        inside = ",".join(f"{_spelled(name)}={_value(value)}" for name, value in self.settings)
        return f"{_spelled(self.quantity)}{weld}" + (f"[{inside}]" if inside else "")


@dataclass(frozen=True, slots=True)
class Expression:
    """One term, or one over another."""

    above: Term
    below: Term | None = None

    @property
    def terms(self) -> tuple[Term, ...]:
        """Its one or two terms."""
        return (self.above,) if self.below is None else (self.above, self.below)

    def __str__(self) -> str:
        """The expression as it is written."""
        return OVER.join(map(str, self.terms))


def parsed(text: str) -> Expression:
    """Expression of a text.

    >>> parsed("life_km:W2*[fe=14, contact=worn]").above.settings
    (('fe', 14), ('contact', 'worn'))

    Raises
    ------
    ExpressionError : the text is none; what it says names the place in it
    """
    scan = _Scan(text)
    terms = [_term(scan)]
    if scan.takes_over():
        terms.append(_term(scan))
    scan.blanks()
    if not scan.at_end:
        more = "a third term" if scan.rest.startswith("/") else repr(scan.rest)
        raise scan.error(f"{more} follows where the expression is complete", "Write one term, or one / another")
    return Expression(*terms)


def _term(scan: "_Scan") -> Term:
    quantity = scan.name(":[", "a quantity")
    weld = scan.name("[", "a weld or pattern") if scan.takes(":") else ""
    settings = tuple(_settings(scan)) if scan.takes("[") else ()
    names = [name for name, _ in settings]
    if twice := next((name for name in names if names.count(name) > 1), ""):
        raise ExpressionError(f"{twice!r} stands twice between the brackets of {quantity!r}", "Keep one of them")
    return Term(quantity, weld, settings)


def _settings(scan: "_Scan") -> Iterator[tuple[str, Setting]]:
    if scan.takes("]"):
        return
    while True:
        name = scan.name("=,]", "a name")
        if not scan.takes("="):
            raise scan.error(f"no = follows the name {name!r}", f"Write [{name}=VALUE]")
        quoted = scan.is_quoted()
        text = scan.name(",]", f"a value of {name!r}")
        yield name, text if quoted else _read(text)
        if scan.takes("]"):
            return
        if not scan.takes(","):
            raise scan.error("the bracket is not closed", "Write ] at its end")


def _read(text: str) -> Setting:
    """Value of a text without quotation marks: whole number, number, true or false, else the text itself."""
    if text in ("true", "false"):
        return text == "true"
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


@dataclass(slots=True)
class _Scan:
    """A text that is read from left to right."""

    text: str
    at: int = 0

    @property
    def rest(self) -> str:
        return self.text[self.at :]

    @property
    def at_end(self) -> bool:
        return self.at >= len(self.text)

    def blanks(self) -> None:
        self.at = len(self.text) - len(self.rest.lstrip())

    def takes(self, sign: str) -> bool:
        """Whether a sign comes next, blanks before it left out; it is passed."""
        rest = self.rest.lstrip()
        if not rest.startswith(sign):
            return False
        self.at = len(self.text) - len(rest) + len(sign)
        return True

    def takes_over(self) -> bool:
        """Whether the stroke of a ratio comes next, blanks around it."""
        found = re.match(r"\s*/\s", self.rest)
        if found:
            self.at += found.end()
        return found is not None

    def is_quoted(self) -> bool:
        return _QUOTED.match(self.rest.lstrip()) is not None

    def name(self, ends: str, wanted: str) -> str:
        """Name up to one of some signs or the stroke of a ratio, or what stands in quotation marks."""
        self.blanks()
        if quoted := _QUOTED.match(self.rest):
            self.at += quoted.end()
            name = quoted[1] if quoted[1] is not None else quoted[2]
        else:
            stop = re.search(rf"[{re.escape(ends)}]|\s/\s", self.rest)
            length = stop.start() if stop else len(self.rest)
            name = self.rest[:length].strip()
            self.at += length
        if not name:
            raise self.error(f"{wanted} is missing", "Write quantity[:weld][name=value,...]")
        if stray := re.search(r"[\[\]\"]", name) if not quoted else None:
            raise self.error(f"{stray[0]!r} stands in {name!r}", "Put a name with such a sign into quotation marks")
        return name

    def error(self, what: str, remedy: str) -> ExpressionError:
        place = f"after {self.text[: self.at].strip()!r}" if self.text[: self.at].strip() else "at its beginning"
        return ExpressionError(f"{what} ({place})", remedy)


def _spelled(name: str) -> str:
    """Name as an expression has it, in quotation marks where it needs them."""
    if not _NEEDS_QUOTES.search(name):
        return name
    return f"'{name}'" if '"' in name else f'"{name}"'


def _value(value: Setting) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'"{value}"' if not isinstance(_read(value), str) else _spelled(value)
    return repr(value)
