"""Numbers and names as people read them."""

import pandas as pd
import pytest

from fatigue.report.wording import (
    in_figure,
    km,
    life,
    life_in_band,
    life_km,
    life_years,
    listed,
    number,
    share,
    short,
    size,
    whole,
    years,
)


@pytest.mark.parametrize(
    ("value", "written"),
    [
        (0.62558, "0.6256"),
        (5.43268, "5.433"),
        (12.0, "12.00"),
        (1256.4, "1256"),
        (9999.6, "10 000"),
        (27332429.06, "27 330 000"),
        (1.3597e10, "1.360e10"),
        (8.823e-4, "8.823e−4"),
        (0.0, "0"),
        (-7.9196, "−7.920"),
        (1e12, "1.000e12"),
        (1.1e12, "> 1e12"),
        (float("inf"), "> 1e12"),
        (float("-inf"), "< −1e12"),
        (float("nan"), "–"),
        (None, "–"),
        (pd.NA, "–"),
    ],
)
def test_numbers_have_four_digits_and_never_say_inf_or_nan(value, written):
    """Four significant digits, grouped thousands, words for what is beyond and a dash for what is missing."""
    assert number(value) == written.replace(" ", "\u202f") if "000" in written else written


def test_lives_carry_their_unit():
    """Kilometres and years; a life beyond 1e12 km is written as that."""
    assert km(float("inf")) == "> 1e12 km"
    assert years(4.41771) == "4.418 years"
    assert years(float("inf")) == "> 1e6 years"


@pytest.mark.parametrize(
    ("value", "written"),
    [
        (4.41771, "4.42"),
        (607.7, "608"),
        (999.6, "1000"),
        (27332429.06, "27 300 000"),
        (1.3597e10, "13 600 000 000"),
    ],
)
def test_lives_have_three_digits(value, written):
    """The fourth is far below their scatter."""
    assert life(value) == written.replace(" ", "\u202f")
    assert life_km(value) == f"{life(value)} km"


def test_lives_in_years_and_beyond_all():
    """As other times, with three digits; what is missing is a dash."""
    assert life_years(4.41771) == "4.42 years"
    assert life_years(float("inf")) == "> 1e6 years"
    assert (life(float("nan")), life_km(float("inf"))) == ("–", "> 1e12 km")


def test_a_life_and_its_band():
    """Millions of km from one million on; a band as wide as double leaves two digits."""
    assert life_in_band(2.168e6, 1.921e6, 2.447e6) == "2.17 (1.92 – 2.45) million km"
    assert life_in_band(2.2e6, 1.4e6, 3.5e6) == "2.2 (1.4 – 3.5) million km"
    assert life_in_band(231_300.0, 200_400.0, 260_100.0) == "231 000 (200 000 – 260 000) km".replace(
        " 000", "\u202f000"
    )
    assert life_in_band(1.33e10, 1.03e10, 1.73e10) == "1.33e10 (1.03e10 – 1.73e10) km"


def test_shares_counts_and_sizes():
    """Percent with three digits at most, grouped counts, sizes in decimal units."""
    assert [share(x) for x in (0.7073, 0.05, -0.0302, float("nan"))] == ["70.7 %", "5.00 %", "−3.02 %", "–"]
    assert whole(1234567) == "1\u202f234\u202f567"
    assert [size(x) for x in (12, 598_000, 2_251_026)] == ["12 bytes", "598.0 kB", "2.251 MB"]


def test_long_names_lose_their_middle():
    """Both ends of a long name stay, and its length is held."""
    name = "W12_" + "x" * 300 + "_end"
    assert len(short(name)) == 36
    assert short(name).startswith("W12_")
    assert short(name).endswith("_end")
    assert short("two\nlines") == "two lines"


def test_names_in_figures_are_no_markup():
    """Plotly's own markup and template variables come out as plain text."""
    assert in_figure('<a href="x">') == '&lt;a href="x"&gt;'
    assert in_figure("a & b") == "a &amp; b"
    assert "%{" not in in_figure("%{x}")


def test_right_to_left_names_keep_to_themselves():
    """A name in another script is isolated, so that it does not turn the text around it."""
    assert in_figure("שלום") == "\u2068שלום\u2069"


def test_lists_read_as_sentences():
    """Commas and an "and" before the last."""
    assert [listed(x) for x in ([], ["a"], ["a", "b"], ["a", "b", "c"])] == ["", "a", "a and b", "a, b and c"]
