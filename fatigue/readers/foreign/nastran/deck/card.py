"""One bulk data card of NASTRAN: its fields as text, ids and numbers, and its place in the deck."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.nastran.deck.fields import FREE
from fatigue.readers.foreign.nastran.deck.lines import place
from fatigue.readers.foreign.nastran.deck.numbers import integer, real


@dataclass(frozen=True, slots=True)
class Card:
    """One bulk data card: its upper-case name, its data fields (field 2 first), and the file and line it begins in."""

    name: str
    fields: tuple[str, ...]
    source: str
    line: int

    @property
    def where(self) -> str:
        """Its place, for messages."""
        return place(self.source, self.line)

    def text(self, at: int) -> str:
        """Field ``at``, empty if the card ends before."""
        return self.fields[at] if at < len(self.fields) else ""

    def integer(self, at: int, default: int | None = None) -> int:
        """Whole number in field ``at``; an empty field takes the default."""
        text = self.fields[at] if at < len(self.fields) else ""
        if text.isdigit() and len(text) < 9 and text.isascii():  # nearly all of them
            return int(text)
        if (value := integer(text)) is not None:
            return value
        if not text and default is not None:
            return default
        raise self._bad(at, text, "a whole number")

    def identity(self) -> int:
        """Id of the card, a whole number above 0 in its first field."""
        if (value := self.integer(0)) < 1:
            raise self._bad(0, self.text(0), "a whole number above 0")
        return value

    def real(self, at: int, default: float | None = None) -> float:
        """Real number in field ``at``, in any NASTRAN spelling such as ``2.9+7``; an empty field takes the default."""
        text = self.fields[at] if at < len(self.fields) else ""
        if not text and default is not None:
            return default
        try:
            return real(text)
        except ValueError as error:
            raise self._bad(at, text.upper(), str(error)) from None

    def no_more_than(self, count: int) -> None:
        """Refuse data in fields that the card does not have.

        Raises
        ------
        DataError : a field after the first ``count`` is not empty
        """
        for at in range(count, len(self.fields)):
            if self.fields[at]:
                raise DataError(
                    Problem(
                        "too_many_fields",
                        self.where,
                        f"{self.name} has {count} data fields, and a further one holds {self.fields[at]!r}",
                        "Correct the card; a comma too many shifts its fields",
                    )
                )

    def _bad(self, at: int, text: str, wanted: str) -> DataError:
        found = f"is {text!r}, not {wanted}" if text else "is empty"
        remedy = "Correct the card"
        if "," in text:
            remedy += f"; only a comma in the first {FREE} columns separates fields"
        return DataError(Problem("bad_field", self.where, f"{self.name} field {at + 2} {found}", remedy))


@dataclass(slots=True)
class KeptCards:
    """Cards by id in the order in which they came, their fields as one text each: a third of the memory."""

    packed: dict[int, tuple[str, str, str, int]] = field(default_factory=dict)

    def __len__(self) -> int:
        """Count the cards."""
        return len(self.packed)

    def __contains__(self, number: int) -> bool:
        """Whether there is a card of this id."""
        return number in self.packed

    def __getitem__(self, number: int) -> Card:
        """Card of an id."""
        name, fields, source, line = self.packed[number]
        return Card(name, tuple(fields.split("\n")), source, line)

    def __setitem__(self, number: int, card: Card) -> None:
        """Keep a card, in place of the one that had the id."""
        self.packed[number] = card.name, "\n".join(card.fields), card.source, card.line

    def items(self) -> Iterator[tuple[int, Card]]:
        """Give ids and cards."""
        return ((number, self[number]) for number in self.packed)

    def taken(self) -> Iterator[tuple[int, Card]]:
        """Give ids and cards, and keep none of them: what is made of them has their memory."""
        for number in list(self.packed):
            card = self[number]
            del self.packed[number]
            yield number, card
