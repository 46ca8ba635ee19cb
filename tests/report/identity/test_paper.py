"""Head and foot of printed pages: strings of CSS that no text can break out of."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.report.identity.identity import Identity
from fatigue.report.identity.paper import page_boxes, quoted


def read_back(css):
    """Text of a string of CSS, by the rule of escapes (CSS Syntax 3, 4.3.7)."""
    assert re.fullmatch(r'"[^"\\\n]*(?:\\[0-9a-f]{1,6} [^"\\\n]*)*"', css)
    return re.sub(r"\\([0-9a-f]{1,6}) ", lambda found: chr(int(found[1], 16)), css[1:-1])


@given(st.text())
def test_no_text_ends_the_string(text):
    """Nothing but letters, digits and blanks stands as itself, so that no name ends string, style or page."""
    css = quoted(text)
    assert "<" not in css
    read_back(css)


@pytest.mark.parametrize("text", ["RD-4711 rev. B · 2026-05-31", 'Rail "Bodies" GmbH', "Ä\\B", "日本 1"])
def test_texts_come_back_as_they_were(text):
    """What a browser shows is what was given."""
    assert read_back(quoted(text)) == text


def test_what_stands_around_a_page():
    """Title, document with revision and date, version and hash, page x of y."""
    identity = Identity({"document": "D1", "revision": "B", "date": "2026-05-31"})
    style = page_boxes(identity, "DRAFT", "My title", "0.1.0", "0123456789abcdef" * 2)
    said = {box: read_back(text) for box, text in re.findall(r'@([a-z-]+) \{ content: ("[^;]*");', style)}
    assert said["top-left"] == "My title"
    assert said["top-right"] == "DRAFT · D1 rev. B · 2026-05-31"
    assert said["bottom-left"] == "fatigue 0.1.0, result 0123456789ab"
    assert 'content: "page" " " counter(page) " " "of" " " counter(pages);' in style
