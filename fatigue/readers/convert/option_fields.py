"""Fields of a dataclass that are options of a command: each is written once, with its type, its default and its help.

The command line makes its options of them, and a conversion records with them how it was called.
"""

from collections.abc import Iterator
from dataclasses import MISSING, dataclass, fields, is_dataclass
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, Union, get_args, get_origin, get_type_hints

from fatigue.errors import given_path
from fatigue.readers.convert.mode_list import mode_list


@dataclass(frozen=True, slots=True)
class Option:
    """What makes a field an option: ``forces: Annotated[Path, Option("--forces", "Grid point forces.")]``.

    Attributes
    ----------
    name : on the command line; a switch has two, ``--detect/--no-detect``
    help : what the help of the command says of it
    short : its one letter, ``-o``
    metavar : what stands for its value in the help
    is_folder : whether its path is a folder
    is_list : whether its numbers are given in one word, as 1-6,31-52
    is_recorded : whether a command that would do the same again has it
    """

    name: str
    help: str
    short: str = ""
    metavar: str | None = None
    is_folder: bool = False
    is_list: bool = False
    is_recorded: bool = True


@dataclass(frozen=True, slots=True)
class OptionField:
    """A field that is an option.

    Attributes
    ----------
    name : of the field
    kind : type of the value, or of each of several; a dataclass takes one word for each of its fields
    is_repeated : whether it may be given several times
    default : its value where it is not given; ``MISSING`` if it has to be
    """

    name: str
    kind: Any
    is_repeated: bool
    default: Any
    option: Option

    @property
    def is_required(self) -> bool:
        """Whether there is no default."""
        return self.default is MISSING

    def value(self, given: Any) -> Any:
        """Value of what a command line gives: numbers of a list, records of words that belong together.

        Raises
        ------
        CaseError : a list that is none
        """
        if self.option.is_list:
            return mode_list(given, self.option.name) if given else ()
        if isinstance(self.kind, type) and is_dataclass(self.kind):
            return tuple(self.kind(*words) for words in given)
        return given

    def words(self, value: Any) -> list[str]:
        """Words of a command line that state a value, none for the default; paths are absolute."""
        if value == self.default:
            return []
        if self.kind is bool:
            return [self.option.name.split("/")[0 if value else 1]]
        if self.option.is_list:
            return [self.option.name, ",".join(map(str, value))]
        return [word for one in (value if self.is_repeated else (value,)) for word in (self.option.name, *_words(one))]


def option_fields(asked: type) -> Iterator[OptionField]:
    """Fields of a dataclass that are options of its own, in their order."""
    hints = get_type_hints(asked, include_extras=True)
    for field in fields(asked):
        if (option := _option(hints[field.name])) is None:
            continue
        kind = get_args(hints[field.name])[0]
        if get_origin(kind) in (Union, UnionType):
            (kind,) = (one for one in get_args(kind) if one is not NoneType)
        is_repeated = get_origin(kind) is tuple
        yield OptionField(field.name, get_args(kind)[0] if is_repeated else kind, is_repeated, field.default, option)


def parts_with_options(asked: type) -> dict[str, type]:
    """Fields of a dataclass that are dataclasses with options of their own, and these."""
    hints = get_type_hints(asked, include_extras=True)
    return {field.name: hints[field.name] for field in fields(asked) if is_dataclass(hints[field.name])}


def words_of(asked: Any) -> list[str]:
    """Words of a command line that ask for the same: every recorded option that has not its default."""
    own = [
        word
        for field in option_fields(type(asked))
        if field.option.is_recorded
        for word in field.words(getattr(asked, field.name))
    ]
    return own + [word for name in parts_with_options(type(asked)) for word in words_of(getattr(asked, name))]


def take_paths(asked: Any) -> None:
    """Let the options of an object that is being made have text for a path, and one path for a tuple of one.

    Raises
    ------
    CaseError : what is given is no path
    """
    for field in option_fields(type(asked)):
        given = getattr(asked, field.name)
        if field.kind is not Path or (given is None and not field.is_required):
            continue
        if field.is_repeated:
            paths = given if isinstance(given, tuple | list) else (given,)
            object.__setattr__(asked, field.name, tuple(given_path(path, field.name) for path in paths))
        else:
            object.__setattr__(asked, field.name, given_path(given, field.name))


def _option(hint: Any) -> Option | None:
    return next((extra for extra in getattr(hint, "__metadata__", ()) if isinstance(extra, Option)), None)


def _words(value: Any) -> list[str]:
    if is_dataclass(value):
        return [word for field in fields(value) for word in _words(getattr(value, field.name))]
    return [str(value.resolve()) if isinstance(value, Path) else str(value)]
