"""Numbers in the fields of cards."""

import pytest

from fatigue.readers.foreign.nastran.deck.numbers import integer, is_number, real


@pytest.mark.parametrize(("text", "value"), [("2.9+7", 2.9e7), ("1.D3", 1e3), (".7-12", 0.7e-12), ("-5", -5.0)])
def test_real(text, value):
    """An exponent with a letter or without."""
    assert real(text) == value
    assert is_number(text)


@pytest.mark.parametrize("text", ["1_0", "1e300", "nan", "seam", "", "٣.0"])
def test_no_real(text):
    """What Python reads as a number and NASTRAN does not is none."""
    with pytest.raises(ValueError, match="a number"):
        real(text)


@pytest.mark.parametrize(("text", "value"), [("+7", 7), ("-7", -7), ("7.", None), ("", None), ("²", None)])
def test_integer(text, value):
    """Digits of ASCII with a sign."""
    assert integer(text) == value
