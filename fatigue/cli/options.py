"""Options of a command made of the annotated fields of a dataclass, and one object of it made of what is given."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from functools import wraps
from pathlib import Path
from typing import Any, Literal, TypeVar, get_args, get_origin

import click

from fatigue.cli.arguments import FOLDER
from fatigue.cli.numbers import ABOVE_ZERO
from fatigue.readers.convert.option_fields import OptionField, option_fields, parts_with_options

Command = Callable[..., None]
Asked = TypeVar("Asked")

FILE = click.Path(path_type=Path)


def asking_for(asked: type[Asked], argument: str) -> Callable[[Command], Command]:
    """Decorator that gives a command all options of a dataclass, and calls it with one object of the dataclass."""
    every = list(_all_fields(asked))

    def decorated(command: Command) -> Command:
        @wraps(command)
        def called(**given: Any) -> None:
            own = {field.name: given.pop(field.name) for field in every}
            command(**given, **{argument: _made(asked, own)})

        made: Command = called
        for field in reversed(every):
            made = _option(field)(made)
        return made

    return decorated


def _all_fields(asked: type) -> Iterator[OptionField]:
    """Fields of a dataclass and of its parts."""
    yield from option_fields(asked)
    for part in parts_with_options(asked).values():
        yield from _all_fields(part)


def _option(field: OptionField) -> Callable[[Command], Command]:
    """Decorator that gives a command the click option of a field."""
    asked = field.option
    names = [name for name in (asked.short, asked.name) if name]
    if field.kind is bool:
        return click.option(*names, field.name, is_flag=True, default=field.default, help=asked.help)
    kind = str if asked.is_list else FOLDER if asked.is_folder else _type(field.kind)
    told: dict[str, Any] = {"type": kind, "metavar": asked.metavar, "help": asked.help}
    if field.is_required:
        return click.option(*names, field.name, required=True, **told)
    if asked.is_list:
        return click.option(*names, field.name, **told)
    if field.is_repeated:
        return click.option(*names, field.name, multiple=True, **told)
    return click.option(*names, field.name, default=field.default, show_default=bool(field.default), **told)


def _type(kind: Any) -> Any:
    """Type of a value, as click knows it."""
    if is_dataclass(kind):
        return tuple(float if field.type is float else _type(field.type) for field in fields(kind))
    if get_origin(kind) is Literal:
        return click.Choice(get_args(kind))
    return {Path: FILE, float: ABOVE_ZERO}.get(kind, kind)


def _made(asked: type[Asked], given: Mapping[str, Any]) -> Asked:
    """Object of what is given on the command line; what is not given has its default."""
    own = {
        field.name: field.value(given[field.name]) for field in option_fields(asked) if given[field.name] is not None
    }
    return asked(**own, **{name: _made(part, given) for name, part in parts_with_options(asked).items()})
