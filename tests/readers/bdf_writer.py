"""Random NASTRAN decks whose content is known: the same cards in every form a solver reads."""

import random
from dataclasses import dataclass, field

Fields = tuple[str, list[str]]
"""Card name and data fields."""

FORMS = ("small", "large", "free", "free large", "long", "flowing", "mixed")
_NOISE = (
    "$ a comment, with commas",
    "",
    "   ",
    "$$",
    "PARAM,POST,-1",
    "MAT1           1  2.1+5              .3 7.85-9",
)


@dataclass
class Written:
    """Lines of a deck, and those that stand far from their card."""

    rng: random.Random
    lines: list[str] = field(default_factory=list)
    far: list[str] = field(default_factory=list)
    marks: int = 0

    def mark(self) -> str:
        """Give a name for a continuation that no other has."""
        self.marks += 1
        return f"{self.marks:05X}"


def spelling(rng: random.Random, value: float) -> str:
    """Write a number of few digits in at most eight columns, in one of the many ways FORTRAN allows."""
    plain = f"{value:.6g}"
    plain = plain if "." in plain else f"{plain}."
    mantissa = f"{value / 10:.7g}"
    mantissa = mantissa if "." in mantissa else f"{mantissa}."
    ways = [plain, plain.replace("0.", ".", 1), f"{mantissa}+1", f"{mantissa}E1", f"{mantissa}d1", f"{mantissa}E+1"]
    ways += [f"+{plain}"] if value >= 0 else []
    ways = [way for way in ways if len(way) <= 8 and way not in (".", "-.", "-.+1") and not way.startswith("..")]
    return rng.choice([way for way in ways if _reads(way, value)])


def _reads(text: str, value: float) -> bool:
    text = text.upper().replace("D", "E")
    head, sign, tail = text.rpartition("+")
    text = f"{head}E{sign}{tail}" if sign and head and not head.endswith("E") else text
    try:
        return abs(float(text) - value) < 1e-9
    except ValueError:
        return False


def write(rng: random.Random, cards: list[Fields], form: str | None = None) -> str:
    """Write a deck, every card in the given form or in one of its own."""
    out = Written(rng)
    for name, fields in cards:
        last = max((k for k, text in enumerate(fields, 1) if text), default=0)
        data = fields[:last]
        _card(out, rng.choice((name, name.lower())), data, form or rng.choice(FORMS))
        if rng.random() < 0.2:
            out.lines.append(rng.choice(_NOISE))
    return "\n".join(out.lines + out.far) + "\n"


def _card(out: Written, name: str, data: list[str], form: str) -> None:
    if form == "long":
        out.lines.append(_commas(out.rng, name, data))
    elif form == "flowing":
        _flowing(out, name, data)
    else:
        _rows(out, name, data, form)


def _flowing(out: Written, name: str, data: list[str]) -> None:
    """Break a comma line after commas, before fields that are not empty."""
    line, rest = name, list(data)
    while rest:
        line += f",{rest.pop(0)}" if line else rest.pop(0)
        if rest and rest[0][:1].isdigit() and out.rng.random() < 0.3:
            out.lines.append(f"{line},")
            line = ""
    out.lines.append(line)


def _rows(out: Written, name: str, data: list[str], form: str) -> None:
    """Write lines of 8 fields or pairs of lines of 4, joined by blanks, bare marks, names, or names far away."""
    pieces = [data[k : k + 8] for k in range(0, len(data), 8)] or [[]]
    join = out.rng.choice(("blank", "bare", "named", "far"))
    target, head, mark = out.lines, name, ""
    for number, piece in enumerate(pieces):
        last = number == len(pieces) - 1
        style = out.rng.choice(("small", "large", "free", "free large")) if form == "mixed" else form
        halves = [piece[:4], piece[4:]] if "large" in style else [piece]
        for half, values in enumerate(halves):
            ends = last and half == len(halves) - 1
            sign = "*" if "large" in style else "+"
            following = "" if ends or join == "blank" else sign if join == "bare" else f"{sign}{out.mark()}"
            first = number == 0 and half == 0
            if first:
                shown = f"{head}*" if "large" in style else head
            else:
                shown = {"blank": "*" if sign == "*" else "", "bare": sign}.get(join, f"{sign}{mark}")
            target.append(_line(out.rng, style, shown, values, following))
            mark = following[1:]
            if join == "far" and first:
                target = out.far


def _line(rng: random.Random, style: str, head: str, values: list[str], mark: str) -> str:
    width = 4 if "large" in style else 8
    if "free" in style:
        if mark:
            values = values + [""] * (width - len(values)) + [mark]
        return _commas(rng, head, values) if values else f"{head},"
    size = 64 // width
    if rng.random() < 0.2 and size == 8 and not mark and all(len(v) < 8 for v in (head, *values)):
        return "\t".join([head, *values]).rstrip()  # eight columns each
    body = "".join(rng.choice((f"{v:>{size}}", f"{v:<{size}}", f"{v:^{size}}")) for v in values)
    return f"{head:<8}{body:<64}{mark}".rstrip()


def _commas(rng: random.Random, head: str, values: list[str]) -> str:
    blank = rng.choice(("", " "))
    return ",".join([head, *(f"{blank}{v}{blank}" for v in values)])
