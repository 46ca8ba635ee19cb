"""Contrast of colours by WCAG 2.1."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.report.identity.contrast import contrast, luminance
from fatigue.report.identity.template import GROUND
from fatigue.report.page_text import environment

colours = st.integers(0, 0xFFFFFF).map(lambda number: f"#{number:06x}")


@pytest.mark.parametrize(("grey", "ratio"), [("#767676", 4.54), ("#777777", 4.48), ("#949494", 3.03)])
def test_known_contrasts_on_white(grey, ratio):
    """The greys that stand on either side of the limits of WCAG 2.1 (understanding 1.4.3)."""
    assert contrast(grey, "#ffffff") == pytest.approx(ratio, abs=0.005)


def test_primary_colours():
    """The coefficients of luminance (ITU-R BT.709)."""
    assert [luminance(c) for c in ("#ff0000", "#00ff00", "#0000ff")] == pytest.approx([0.2126, 0.7152, 0.0722])


@given(colours, colours)
def test_contrast_does_not_ask_which_is_the_ground(one, other):
    """Symmetric, at least 1 and at most 21."""
    assert contrast(one, other) == contrast(other, one)
    assert 1.0 <= contrast(one, other) <= 21.0


def test_the_page_as_it_is_can_be_read():
    """Letters of every colour of the page keep the limit on its darkest ground, which is the one of the style sheet."""
    style = environment("fatigue.report").from_string("{{ source('style.css') }}").render()
    found = dict(
        part.split(":") for part in style[style.index("{") + 1 : style.index("}")].replace(" ", "").split(";") if part
    )
    assert found["--wash"] == GROUND
    assert all(contrast(found[f"--{name}"], GROUND) >= 4.5 for name in ("ink", "quiet", "accent", "missed", "doubt"))
