"""The table [report]: every key is checked, with one clear line for each mistake."""

from datetime import date

import pytest

from fatigue.case import PEOPLE, Report
from fatigue.errors import CaseError
from tests.case.case_text import MINIMAL


def problems(load, table):
    """Refusals of a case with this table."""
    with pytest.raises(CaseError) as error:
        load(MINIMAL + f"\n[report]\n{table}\n")
    return [str(problem) for problem in error.value.problems]


def test_all_keys(load):
    """Texts stay as they are, with umlauts and markup; a day of TOML becomes its text."""
    case = load(MINIMAL + '\n[report]\nauthor = "Jörg <b>"\ndate = 2026-05-31\nlanguage = "de"\n')
    assert case.report.as_record() == {"date": "2026-05-31", "author": "Jörg <b>", "language": "de"}


def test_a_case_without_it_says_nothing(load):
    """Nothing is asked for."""
    assert load(MINIMAL).report.is_empty


def test_a_report_is_identified_by_keys_that_there_are():
    """The six of people and document are keys of the table."""
    assert set(PEOPLE) <= set(Report.model_fields)


@pytest.mark.parametrize("key", sorted(set(Report.model_fields) - {"date"}))
@pytest.mark.parametrize("value", ["7", "true", "[]", "{}", "2026-05-31", '""'])
def test_every_key_is_a_text(load, key, value):
    """Of no other type, and not empty."""
    (told,) = problems(load, f"{key} = {value}")
    assert told.startswith(f"case.toml: report.{key}: ")
    assert "string" in told or "is empty" in told


@pytest.mark.parametrize(
    "value",
    ['"31.05.2026"', '"2026-02-30"', '"20260531"', '"soon"', "7", "true", "[]", "2026-05-31T08:00:00", "08:00:00"],
)
def test_a_date_that_is_none(load, value):
    """A day as ISO 8601 writes it, nothing else."""
    (told,) = problems(load, f"date = {value}")
    assert told.startswith("case.toml: report.date: ")
    assert "is no date" in told
    assert told.endswith("Give the date of the revision, as in 2026-05-31.")


@pytest.mark.parametrize("day", ["2026-05-31", "2024-02-29", "0001-01-01"])
def test_a_date_as_text_and_as_toml_are_the_same(load, day):
    """Both ways of writing a day."""
    assert date.fromisoformat(load(MINIMAL + f'\n[report]\ndate = "{day}"\n').report.date)
    assert load(MINIMAL + f"\n[report]\ndate = {day}\n").report.date == day


def test_unknown_key_and_endless_text(load):
    """As everywhere in a case."""
    assert problems(load, 'authors = "X"') == [
        "case.toml: report.authors: unknown key with the value \"X\". Write 'author'."
    ]
    (told,) = problems(load, f'author = "{"x" * 3000}"')
    assert "at most 2000" in told


def test_a_path_that_lost_a_backslash(load):
    """As of all files of a case."""
    (told,) = problems(load, 'logo = "brand\\new.png"')
    assert "report.logo" in told
    assert "escape" in told
