"""Cards kept by id: what comes out is what went in, in the same order."""

from fatigue.readers.foreign.nastran.deck.card import Card, KeptCards

CARDS = {
    7: Card("CQUAD4", ("7", "1", "", "2.5-3", "12 + 3"), "a.bdf", 12),
    3: Card("CTRIA3", ("3",), "b.inc", 1),
    9: Card("CTRIA3", ("9", "", ""), "b.inc", 2),
}


def kept():
    """Cards of three ids."""
    cards = KeptCards()
    for number, card in CARDS.items():
        cards[number] = card
    return cards


def test_cards_come_back_as_they_were():
    """By id and one after the other, empty fields at the end included; the last one of an id counts."""
    cards = kept()
    assert list(cards.items()) == list(CARDS.items())
    assert len(cards) == 3
    assert 3 in cards
    assert 4 not in cards
    cards[7] = CARDS[9]
    assert cards[7] == CARDS[9]
    assert next(iter(cards.items()))[0] == 7


def test_taken_cards_are_gone():
    """They come in order, and none is left, not even those taken so far."""
    cards = kept()
    taken = cards.taken()
    assert next(taken) == (7, CARDS[7])
    assert len(cards) == 2
    assert [number for number, _ in taken] == [3, 9]
    assert len(cards) == 0
