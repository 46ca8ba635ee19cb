"""What events give of unit loads, in words."""

import pytest

from fatigue.report.sections.unit_loads import load_table, source_in_words

FILE = {"way": "file", "file": "p.csv", "column": "u_p", "scale": 1.0, "shift_s": 0.0, "interpolation": "fourier"}


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"way": "constant", "constant": 1.25}, "constant 1.25 kPa"),
        ({"way": "values", "values": [0.0, 60.0]}, "values 0, 60 kPa"),
        ({"way": "values", "values": [float(k) for k in range(10)]}, "values 0, 1, 2, 3, 4, 5, 6, 7 and 2 more kPa"),
        ({"way": "missing"}, "not given: zero"),
        ({"way": "column", "file": "q.parquet", "column": "u_p"}, "column u_p of q.parquet"),
        (FILE, "column u_p of p.csv"),
        (
            {**FILE, "scale": 3.0, "shift_s": -0.5, "interpolation": "linear"},
            "column u_p of p.csv, times 3, shifted by -0.5 s, linear between its samples",
        ),
    ],
)
def test_sources_in_words(given, words):
    """Every way in which an event gives a load."""
    assert source_in_words(given, "kPa") == words


def test_events_that_give_the_same_are_one_row():
    """All of them by that word, some by their names."""
    load = {"name": "p", "unit": "kPa", "role": "gravity", "elements_carry_load": True}
    one, two = {"way": "constant", "constant": 1.0}, {"way": "missing"}
    table = load_table([load | {"given": {"a": one, "b": one}}, load | {"given": {"a": one, "b": two, "c": one}}])
    assert [[cell.text for cell in row] for row in table.rows] == [
        ["p", "kPa", "gravity, on the assessed elements", "all events", "constant 1 kPa"],
        ["p", "kPa", "gravity, on the assessed elements", "a, c", "constant 1 kPa"],
        ["p", "kPa", "gravity, on the assessed elements", "b", "not given: zero"],
    ]
    assert load_table([]) is None
