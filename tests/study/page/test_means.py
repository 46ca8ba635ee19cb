"""Numbers of the variants on the page of a study."""

import math

from fatigue.study.page.means import MOST_COLUMNS, means_table
from fatigue.study.quantities import Number
from tests.study.page.studied_example import studied


def test_each_variant_has_its_means_with_least_and_greatest():
    """Rows are the variants in their order; numbers of single welds stay in the files."""
    table = means_table(studied())
    assert [heading.text for heading in table.headings] == ["variant", "f_hunt", "conv_y_rms"]
    assert [heading.unit for heading in table.headings] == ["", "Hz", "m/s2"]
    worn = table.rows[2]
    assert [cell.text for cell in worn] == ["contact=worn", "8.200 (8.100 to 8.300)", "2.369 (2.346 to 2.392)"]


def test_a_number_that_is_not_there_is_a_dash_and_a_life_without_end_no_error():
    """What one variant has alone is a dash in the others; lives have geometric means."""
    lives = [Number("base", seed, "life_km", "", life, "km") for seed, life in ((1, 1e6), (2, 1e8))]
    lives += [Number("fe=14", seed, "life_km", "", math.inf, "km") for seed in (1, 2)]
    rows = means_table(studied(numbers=lives)).rows
    assert [row[1].value for row in rows[:1]] == [1e7]
    assert rows[1][1].text == "> 1e12"
    assert rows[2][1].text == "–"


def test_no_numbers_no_table_and_never_too_many_columns():
    """The page keeps to what a page can hold."""
    assert means_table(studied(numbers=[])) is None
    many = [Number("base", 1, f"q{i}", "", 1.0, "m") for i in range(30)]
    assert len(means_table(studied(numbers=many)).headings) == MOST_COLUMNS + 1
