"""Every code that the program can tell has a page, and no page has a code that it cannot tell."""

import json
import tomllib
from pathlib import Path

import pytest

from fatigue.explain import all_codes, explanation, near
from tests import problem_codes, reference
from tests.command_line import fatigue

ROOM = Path(__file__).parents[2] / "fatigue" / "explain"


def test_every_code_of_the_program_has_a_page():
    """Codes are collected from the source; what each says where it arises is up to date."""
    assert set(all_codes()) == set(problem_codes.codes())
    assert (ROOM / "told.json").read_text(encoding="utf-8") == reference.told_text()


def test_warnings_are_told_as_warnings():
    """Whatever the program adds to its warnings has a family, a meaning and a remedy."""
    pages = {code: page for code, page in all_codes().items() if page.kind != "refusal"}
    assert not problem_codes.codes_of_warnings() - pages.keys()
    assert all(page.says and page.why and page.do and page.family for page in pages.values())


def test_refusals_say_what_and_what_to_do():
    """No page is empty: the words stand where the refusal is made, or are written by hand."""
    pages = [page for page in all_codes().values() if page.kind == "refusal"]
    assert len(pages) > 400
    assert not [page.code for page in pages if not (page.says or any(place.what for place in page.places))]
    assert not [page.code for page in pages if not (page.do or any(place.remedy for place in page.places))]


def test_hand_written_refusals_are_refusals():
    """What is written by hand belongs to a refusal that exists."""
    written = tomllib.loads((ROOM / "refusals.toml").read_text(encoding="utf-8"))
    assert {all_codes()[code].kind for code in written} == {"refusal"}


def test_places_are_modules():
    """Where a code arises can be opened."""
    modules = {place.module for page in all_codes().values() for place in page.places}
    assert not [module for module in modules if not (ROOM.parent / module).exists()]


@pytest.mark.parametrize("given", ["no_interface_mode", "No-Interface-Mode", "`no_interface_mode`"])
def test_a_code_is_found_as_people_write_it(given):
    """Case, blanks, hyphens and quotes do not matter."""
    assert explanation(given).code == "no_interface_mode"


def test_near_names():
    """A slip of the keys, or one word of the name, leads to the code."""
    assert near("unverifed_curve")[0] == "unverified_curve"
    assert "thickness_step" in near("thickness_jump", most=20)
    assert near("qqqqqq") == []


def test_command_tells_a_code():
    """Meaning, why, remedy and place, in words and for machines."""
    done = fatigue("explain", "no_interface_mode")
    assert done.returncode == 0
    assert "What it means: none of the modes is an interface mode" in done.stdout
    assert "Why it matters" in done.stdout
    assert "What to do: add residual, attachment or constraint modes" in " ".join(done.stdout.split())
    assert "fatigue/readers/neutral/body/modes.py" in done.stdout
    record = json.loads(fatigue("explain", "no_interface_mode", "--json").stdout)
    assert record["code"] == "no_interface_mode"
    assert record["kind"] == "warning of a result"


def test_command_lists_all_codes():
    """Without a code, one line for each, no line cut into two."""
    done = fatigue("explain")
    listed = [line.split()[0] for line in done.stdout.splitlines() if line.startswith("  ")]
    assert listed == list(all_codes())
    assert len(json.loads(fatigue("explain", "--json").stdout)) == len(listed)


def test_command_refuses_an_unknown_code():
    """Wrong usage, with names near it; without any, with how to list all."""
    done = fatigue("explain", "unverifed_curve")
    assert done.returncode == 2
    assert "near it: unverified_curve" in done.stderr
    assert "lists all codes" in fatigue("explain", "qqqqqq").stderr
