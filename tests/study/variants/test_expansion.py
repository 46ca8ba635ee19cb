"""Variants of a study: the base, each value alone or with every other, and those stated by themselves."""

import pytest

from fatigue.errors import CaseError
from fatigue.study.study_file import Study
from fatigue.study.variants.varied.expansion import expanded
from fatigue.study.variants.varied.names import folder_names

FILES = {
    "vehicle.converter.fe_hz": 9.2,
    "vehicle.contact.state": "sound",
    "vehicle.contact.worn_sections_m": [[1.0, 2.0]],
}
FE = {"key": "vehicle.converter.fe_hz", "values": [9.2, 12.0, 14.0]}
STATE = {"key": "vehicle.contact.state", "name": "contact", "values": ["sound", "worn"]}


def plan(**tables):
    """Variants of a study over files with the values above."""
    return expanded(Study.model_validate({"base": {"vehicle": "v", "case": "c"}, **tables}), FILES.get)


def names(**tables):
    """Names of the variants."""
    return [planned.variant.name for planned in plan(**tables).variants]


def test_one_at_a_time():
    """The base, and each value that differs from it; the value of the base is no variant of its own."""
    found = plan(vary=[FE, STATE])
    assert [p.variant.name for p in found.variants] == ["base", "fe=12", "fe=14", "contact=worn"]
    assert [dict(p.changes) for p in found.variants] == [
        {},
        {"vehicle.converter.fe_hz": 12.0},
        {"vehicle.converter.fe_hz": 14.0},
        {"vehicle.contact.state": "worn"},
    ]
    assert found.variants[3].variant.settings == {"fe": 9.2, "contact": "worn"}


def test_full():
    """Every value with every other, the base first."""
    assert names(vary=[FE, STATE], combine="full") == [
        "base",
        "contact=worn",
        "fe=12",
        "fe=12, contact=worn",
        "fe=14",
        "fe=14, contact=worn",
    ]


def test_full_without_the_value_of_the_file():
    """The first value takes its place: there is no variant that nobody listed."""
    found = plan(vary=[{**FE, "values": [12.0, 14.0]}, STATE], combine="full")
    assert len(found.variants) == 4
    assert dict(found.variants[0].changes) == {"vehicle.converter.fe_hz": 12.0}
    assert found.variants[0].variant.settings == {"fe": 12.0, "contact": "sound"}


def test_nothing_is_varied():
    """The base alone."""
    assert names() == ["base"]


def test_stated_variants_take_names_of_values():
    """What a [[vary]] has a value for is that value; what it leaves out is that of the base."""
    found = plan(
        vary=[FE], variant=[{"name": "both", "set": {"vehicle.converter.fe_hz": 14, "vehicle.contact.state": "worn"}}]
    )
    assert [p.variant.name for p in found.variants] == ["base", "fe=12", "fe=14", "both"]
    assert [p.variant.settings["contact"] for p in found.variants] == ["sound"] * 3 + ["worn"]
    assert found.variants[3].variant.settings["fe"] == 14.0
    assert found.variants[3].changes == {"vehicle.converter.fe_hz": 14, "vehicle.contact.state": "worn"}


def test_labels_and_keys_that_are_set_together():
    """A label is what claims and folders know; what is the base is found through all of its keys."""
    together = {
        "name": "track",
        "set": [dict(FILES), {**FILES, "vehicle.contact.worn_sections_m": [[3.0, 4.0]]}],
        "labels": ["short", "long"],
    }
    found = plan(vary=[together])
    assert [p.variant.name for p in found.variants] == ["base", "track=long"]
    assert found.variants[0].variant.settings == {"track": "short"}
    assert found.variants[1].changes == {"vehicle.contact.worn_sections_m": [[3.0, 4.0]]}


def test_a_key_of_the_source_has_its_base_stated_or_first():
    """No file has it."""
    assert names(vary=[{"key": "own.k", "values": [1, 2]}]) == ["base", "k=2"]
    found = plan(vary=[{"key": "own.k", "values": [1, 2], "base": 3}])
    assert [p.variant.name for p in found.variants] == ["base", "k=1", "k=2"]
    assert [p.changes["own.k"] for p in found.variants] == [3, 1, 2]


@pytest.mark.parametrize(
    ("tables", "words"),
    [
        ({"vary": [FE], "variant": [{"name": "x", "set": {"vehicle.converter.fe_hz": 14}}]}, "has already"),
        (
            {"vary": [FE], "variant": [{"name": "x", "set": {"vehicle.converter.fe_hz": 9.2}}]},
            "variant 'base' has already",
        ),
        ({"vary": [FE], "variant": [{"name": "fe=12", "set": {"own.a": 1}}]}, "'fe=12' is a variant already"),
        (
            {"variant": [{"name": "x", "set": {"vehicle.converter.fe_hz": 1, "vehicle.transformer.fe_hz": 2}}]},
            "would be called 'fe'",
        ),
        ({"vary": [FE, {**FE, "name": "other"}]}, "is varied by vary[1] already"),
    ],
)
def test_what_is_there_twice(tables, words):
    """Names, keys and variants are there once."""
    with pytest.raises(CaseError) as found:
        plan(**tables)
    assert words in str(found.value)


def test_folders_differ_on_every_system():
    """Names that differ in case or in signs alone, those a system keeps for itself, and long ones."""
    given = ["a b", "a_b", "A B", "con", "..", "ä/ö:*", "x" * 300, "x" * 299]
    folders = folder_names(given)
    assert len({folder.casefold() for folder in folders}) == len(given)
    assert all(len(folder) < 100 and folder.isascii() and "/" not in folder for folder in folders)
    assert "con" not in folders
    assert not any(folder.startswith(".") for folder in folders)
    assert folder_names(given) == folders
