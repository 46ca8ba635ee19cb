"""Case files beyond all measure are refused in one line."""

import pytest

from fatigue.case import check_files, load_case
from fatigue.errors import CaseError
from tests.small_case import small_case


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ("x = " + "[" * 1000 + "]" * 1000, "line 33: tables or lists lie in one another without end"),
        ("x = " + "{a = " * 5000 + "1" + "}" * 5000, "line 33: tables or lists lie in one another without end"),
        ("[" + ".".join("a" * 1000) + "]", "tables or lists lie in one another without end"),
        ("x = " + "[" * 40 + "]" * 40, "tables or lists lie in one another without end"),
        ("x = " + "9" * 5000, "line 33: an integer of 5000 digits is none of TOML"),
        ("x = 0x" + "f" * 5000, r"mission\.event\[3\]\.x: an integer of 20000 bits is none of TOML"),
        ("x = [1, {y = -9223372036854775809}]", r"x\[2\]\.y: an integer of 64 bits is none of TOML"),
    ],
    ids=["lists", "inline tables", "headers", "beyond what a case has", "digits", "hexadecimal", "just too large"],
)
def test_values_beyond_measure_are_refused_with_their_place(tmp_path, more, words):
    """Neither a recursion nor the limit of digits is met."""
    case = small_case()
    case.extra = more
    with pytest.raises(CaseError, match=rf"^case\.toml: .*{words}") as refused:
        load_case(case.write(tmp_path))
    assert len(str(refused.value)) < 300


def test_the_largest_integer_of_toml_is_judged_by_its_key(tmp_path):
    """It is a number like others."""
    case = small_case()
    case.extra = "x = 9223372036854775807"
    with pytest.raises(CaseError, match="unknown key with the value 9223372036854775807"):
        load_case(case.write(tmp_path))


def test_a_file_name_that_no_file_can_have_is_told_with_its_key(tmp_path):
    """300 letters are more than any disk allows."""
    case = small_case()
    case.body = {"welds": "w" * 300 + ".csv"}
    with pytest.raises(
        Exception, match=r"^case\.toml: body\.welds: .*w\.csv cannot be read or written \(File name too"
    ):
        check_files(load_case(case.write(tmp_path)))
