"""Options of a command made of the annotated fields of a dataclass, and one object of it made of what is given."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from functools import wraps
from pathlib import Path
from typing import Any, Literal, TypeVar, get_args, get_origin

import click

from fatigue.cli.numbers import ABOVE_ZERO
from fatigue.readers.convert.mode_list import mode_list
from fatigue.readers.convert.option_fields import OptionField, option_fields, parts_with_options

Command = Callable[..., None]
Asked = TypeVar("Asked")

FILE = click.Path(path_type=Path)
FOLDER = click.Path(path_type=Path, file_okay=False)


def asking_for(asked: type[Asked], argument: str) -> Callable[[Command], Command]:
    """Give a command all options of a dataclass, and call it with one object of it."""

    def decorated(command: Command) -> Command:
        @wraps(command)
        def called(**given: Any) -> None:
            own = {name: given.pop(name) for name in _names(asked)}
            command(**given, **{argument: _made(asked, own)})

        made: Command = called
        for option in reversed([_option(field) for field in _all_fields(asked)]):
            made = option(made)
        return made

    return decorated


def _all_fields(asked: type) -> Iterator[OptionField]:
    """Fields of a dataclass and of its parts."""
    yield from option_fields(asked)
    for part in parts_with_options(asked).values():
        yield from _all_fields(part)


def _names(asked: type) -> list[str]:
    return [field.name for field in _all_fields(asked)]


def _option(field: OptionField) -> Callable[[Command], Command]:
    """Make the click option of a field."""
    asked = field.option
    names = [name for name in (asked.short, asked.name) if name]
    if field.kind is bool:
        return click.option(*names, field.name, is_flag=True, default=field.default, help=asked.help)
    kind = str if asked.is_list else FOLDER if asked.is_folder else _type(field.kind)
    told: dict[str, Any] = {"type": kind, "metavar": asked.metavar, "help": asked.help}
    if field.is_required:
        return click.option(*names, field.name, required=True, **told)
    if asked.is_list:
        return click.option(*names, field.name, callback=_modes, **told)
    if field.is_repeated:
        return click.option(*names, field.name, multiple=True, **told)
    return click.option(*names, field.name, default=field.default, show_default=bool(field.default), **told)


def _type(kind: Any) -> Any:
    """Give the click type of a value."""
    if is_dataclass(kind):
        return tuple(_type(field.type) for field in fields(kind))
    if get_origin(kind) is Literal:
        return click.Choice(get_args(kind))
    return {Path: FILE, float: ABOVE_ZERO}.get(kind, kind)


def _made(asked: type[Asked], given: Mapping[str, Any]) -> Asked:
    """Make an object of what is given on the command line; what is not given has its default."""
    own = {
        field.name: field.value(given[field.name]) for field in option_fields(asked) if given[field.name] is not None
    }
    return asked(**own, **{name: _made(part, given) for name, part in parts_with_options(asked).items()})


def _modes(_: click.Context, param: click.Parameter, given: str | None) -> tuple[int, ...]:
    """Read a list of modes, in the words of `mode_list` where it is none."""
    return mode_list(given, param.opts[0]) if given else ()
