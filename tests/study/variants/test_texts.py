"""Keys with dots, TOML that is written, and placeholders."""

import math
import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.errors import DataError
from fatigue.files.dotted import NoSuchKey, put, value_at
from fatigue.study.variants.source.placeholders import filled, names_in
from fatigue.study.variants.varied.toml_text import toml_text

TEXTS = st.text(st.characters(blacklist_categories=("Cs",)), max_size=8)
VALUES = st.one_of(st.booleans(), st.integers(-(2**63), 2**63 - 1), st.floats(allow_nan=False), TEXTS)
TABLES = st.recursive(
    st.dictionaries(TEXTS, VALUES, max_size=3),
    lambda inner: st.dictionaries(
        TEXTS, st.one_of(VALUES, inner, st.lists(inner, max_size=3), st.lists(VALUES, max_size=3))
    ),
    max_leaves=12,
)


@given(TABLES)
def test_what_is_written_reads_as_it_was(tables):
    """Of any tables, lists of tables and values in one another."""
    assert tomllib.loads(toml_text(tables)) == tables


def test_numbers_that_are_none():
    """TOML has words for them."""
    found = tomllib.loads(toml_text({"a": [math.inf, -math.inf, math.nan], "b": [{"c": 1}, 2]}))
    assert found["a"][:2] == [math.inf, -math.inf]
    assert math.isnan(found["a"][2])
    assert found["b"] == [{"c": 1}, 2]


CASE = {"curve": {"survival": "mean"}, "mission": {"event": [{"name": "worn"}, {"name": "worn 350.5", "share": 0.5}]}}


def test_a_table_of_a_list_has_its_name():
    """Of names that begin alike the longest counts; dots are part of a name."""
    assert value_at(CASE, "mission.event.worn 350.5.share") == 0.5
    assert value_at(CASE, "mission.event.worn.share") is None
    assert value_at(CASE, "counting.upsample") is None
    tables = {"mission": {"event": [{"name": "worn"}]}}
    put(tables, "mission.event.worn.stress_factor", 2.0)
    put(tables, "ride.alarm.cycles", 5)
    assert tables == {"mission": {"event": [{"name": "worn", "stress_factor": 2.0}]}, "ride": {"alarm": {"cycles": 5}}}


def test_a_table_of_a_list_without_names_has_its_number():
    """From 1; a number beyond the list says how many there are."""
    tables = {"mission": {"sequence": [{"per_1000_km": 1.0}, {"per_1000_km": 2.0}]}}
    put(tables, "mission.sequence.2.per_1000_km", 3.0)
    assert value_at(tables, "mission.sequence.2.per_1000_km") == 3.0
    assert value_at(tables, "mission.sequence.1.per_1000_km") == 1.0
    for wrong in ("0", "3", "two"):
        with pytest.raises(NoSuchKey) as found:
            put(tables, f"mission.sequence.{wrong}.per_1000_km", 1.0)
        assert found.value.remedy == "Write a number from 1 to 2"


@pytest.mark.parametrize(
    ("key", "words", "remedy"),
    [
        ("mission.event.worm.share", "no table of the name 'worm'", "Write 'worn'"),
        ("mission.event.worn", "is a table, not a key in one", "Write the tables"),
        ("curve.survival.x", "goes on inside 'curve.survival', which is no table", "Write the tables"),
        (".curve", "something is missing beside a dot", "Write the tables"),
        ("mission.event.", "something is missing", "Write the tables"),
    ],
)
def test_keys_that_lead_nowhere(key, words, remedy):
    """They say where they end."""
    with pytest.raises(NoSuchKey) as found:
        put({"curve": {"survival": "mean"}, "mission": {"event": [{"name": "worn"}]}}, key, 1)
    assert words in found.value.what
    assert remedy in found.value.remedy


def test_placeholders():
    """Numbers as names have them, unless a format is given; braces are doubled."""
    assert filled("{a}-{b}-{c:.1f}-{{x}}", {"a": 350.0, "b": True, "c": 9.25}) == "350-true-9.2-{x}"
    assert names_in("{a} {a:03d} {{b}}") == {"a"}
    with pytest.raises(DataError, match="cannot be filled in"):
        filled("{a:03d}", {"a": "worn"})
