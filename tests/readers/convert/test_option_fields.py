"""Fields of a dataclass as options of a command."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

import pytest

from fatigue.errors import CaseError
from fatigue.readers.convert.option_fields import Option, option_fields, parts_with_options, take_paths, words_of


@dataclass(frozen=True)
class Place:
    """Two words of one option."""

    file: Path
    node: int


@dataclass(frozen=True)
class Part:
    """Options of a part."""

    search: Annotated[bool | None, Option("--search/--no-search", "Search.")] = None


@dataclass(frozen=True)
class Asked:
    """An option of every kind."""

    mesh: Annotated[Path, Option("--mesh", "Mesh.")]
    files: Annotated[tuple[Path, ...], Option("--file", "Files.")] = ()
    modes: Annotated[tuple[int, ...], Option("--modes", "Modes.", is_list=True)] = ()
    places: Annotated[tuple[Place, ...], Option("--place", "Places.")] = ()
    out: Annotated[Path | None, Option("--out", "Folder.", is_recorded=False)] = None
    plain: int = 3
    part: Part = field(default_factory=Part)

    def __post_init__(self) -> None:
        """Take text for a path."""
        take_paths(self)


def test_fields_by_type():
    """Type of one value, whether there may be several, and whether it has to be given; a plain field is no option."""
    found = {f.name: (f.kind, f.is_repeated, f.is_required) for f in option_fields(Asked)}
    assert found == {
        "mesh": (Path, False, True),
        "files": (Path, True, False),
        "modes": (int, True, False),
        "places": (Place, True, False),
        "out": (Path, False, False),
    }
    assert parts_with_options(Asked) == {"part": Part}


def test_values_of_words():
    """Numbers of a list, records of words."""
    by_name = {f.name: f for f in option_fields(Asked)}
    assert by_name["modes"].value("1-3,7") == (1, 2, 3, 7)
    assert by_name["places"].value([("a.csv", 5)]) == (Place("a.csv", 5),)


def test_words_that_ask_for_the_same():
    """Only what has not its default and is recorded; paths are absolute, a part comes last."""
    asked = Asked("a.bdf", "b.op2", (1, 2), (Place(Path("u.csv"), 5),), "out", 4, Part(search=False))
    here = str(Path.cwd())
    assert words_of(asked) == [
        *("--mesh", f"{here}/a.bdf", "--file", f"{here}/b.op2", "--modes", "1,2"),
        *("--place", f"{here}/u.csv", "5", "--no-search"),
    ]
    assert words_of(Asked("a.bdf")) == ["--mesh", f"{here}/a.bdf"]


def test_paths_may_be_texts():
    """One for several, too; a number is no path."""
    assert (Asked("a").mesh, Asked("a", "b").files, Asked("a", ["b", "c"]).files) == (
        Path("a"),
        (Path("b"),),
        (Path("b"), Path("c")),
    )
    with pytest.raises(CaseError, match="mesh"):
        Asked(5)
