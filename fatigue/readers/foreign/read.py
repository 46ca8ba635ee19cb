"""Foreign files read: the format is recognised by the first bytes and not by the name, and names the reader."""

from collections.abc import Callable, Collection
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.files.extras import install_command
from fatigue.files.misplaced import HEAD, archive_names, known_format, own_format, unknown_binary
from fatigue.files.naming import missing_foreign_file
from fatigue.readers.foreign.channels.coordinates import coordinates_of
from fatigue.readers.foreign.channels.group import ChannelGroup
from fatigue.readers.foreign.fe.model import FeModel
from fatigue.readers.foreign.fe.results import FeResults
from fatigue.readers.foreign.fe.shell_stress import ShellStresses
from fatigue.readers.foreign.formats import (
    CHANNELS,
    COORDINATES,
    FORCES,
    FORMATS,
    MESH,
    STRESSES,
    Content,
    Extra,
    ForeignFormat,
    all_formats,
    formats_called,
)
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory
from fatigue.readers.text.encoding import marked_encoding


def recognise(path: Path) -> ForeignFormat:
    """Format of a file, told by its content.

    Raises
    ------
    DataError : missing, unreadable or empty file, a format that is not read
    """
    try:
        with path.open("rb") as file:
            head = file.read(HEAD)
            members = archive_names(file) if head.startswith(b"PK") else None
    except (FileNotFoundError, NotADirectoryError, IsADirectoryError):
        raise DataError(missing_foreign_file(path)) from None
    except OSError as error:
        raise DataError(
            Problem("unreadable", str(path), f"the file cannot be read ({error.strerror})", "Check the path")
        ) from error
    if not head:
        raise DataError(Problem("empty", str(path), "the file is empty", "Give the file that the solver wrote"))
    for form in reversed(FORMATS):
        if form.fits_bytes(head) or form.fits_archive(members or ()):
            return form
    if (known := known_format(path)) is not None:
        raise DataError(Problem("foreign_format", str(path), f"this is {known.name}", known.remedy))
    refuse(DataError, filter(None, [unknown_binary(path, str(path), f"Give {all_formats()}")]))
    text = head.decode(marked_encoding(head), errors="replace")
    return next(form for form in reversed(FORMATS) if form.fits_text(text))


def read_forces(
    path: Path, subcase: int | None, interface: Collection[int] = (), loads: Collection[int] | None = ()
) -> FeResults:
    """Grid point forces from any format that holds them, with static subcases that are interface modes or loads."""
    results: FeResults = _reader(path, FORCES)[1](path, subcase, interface, loads)
    return results


def read_model(path: Path) -> FeModel:
    """Geometry from any format that holds it."""
    model: FeModel = _reader(path, MESH)[1](path)
    return model


def read_stresses(path: Path, wanted: NDArray[np.int64]) -> ShellStresses:
    """Stresses of the ``wanted`` shells from any format that holds them."""
    stresses: ShellStresses = _reader(path, STRESSES)[1](path, wanted)
    return stresses


def read_coordinates(path: Path, columns: dict[str, int] | None, time_column: str | None) -> ForeignHistory:
    """Modal coordinates from any format that holds them, be it among other channels."""
    form, reader = _reader(path, COORDINATES)
    if COORDINATES not in form.reads:
        return coordinates_of(path, reader(path), columns, time_column)
    history: ForeignHistory = reader(path, columns, time_column)
    return history


def read_channels(path: Path) -> tuple[ChannelGroup, ...]:
    """All channels of a file, in groups, from any format that holds them; those without a name by their position.

    Raises
    ------
    DataError : no channel of numbers, whatever the reader refuses
    """
    groups: tuple[ChannelGroup, ...] = _reader(path, CHANNELS)[1](path)
    if not any(group.channels for group in groups):
        what = "the file has no channels of numbers"
        raise DataError(Problem("no_channels", str(path), what, "Export the channels again"))
    return tuple(map(_with_names, groups))


def _with_names(group: ChannelGroup) -> ChannelGroup:
    """The group, its nameless channels called by their position, which is no number of a mode."""
    if all(one.name for one in group.channels):
        return group
    named = [replace(one, name=one.name or f"channel {k}") for k, one in enumerate(group.channels, 1)]
    return replace(group, channels=tuple(named))


def _reader(path: Path, content: Content) -> tuple[ForeignFormat, Callable[..., Any]]:
    """Format of a file and its reader of a content; a file that is sound and in the wrong place is refused."""
    form = recognise(path)
    own = own_format(path) if form.is_plain_text else None  # the case itself and its register are texts, too
    reader = form.holds.get(content)
    if own is not None and (reader is None or content.option not in own.remedy):
        raise DataError(_misplaced(path, content, f"this is {own.name}", own.remedy))
    if reader is None:
        raise DataError(
            _misplaced(path, content, f"this is {form.name} (format {form.key})", f"Give it to {form.home}")
        )
    if form.extra is not None:
        _require(form.extra)
    return form, reader.load()


def _misplaced(path: Path, content: Content, what: str, remedy: str) -> Problem:
    """Refusal that says what a file is, where it belongs, and what to give in its place."""
    wanted = f"{content.option} {formats_called(content)}"
    return Problem(content.code, str(path), f"{what}, which holds no {content.name}", f"{remedy}, and to {wanted}")


def _require(extra: Extra) -> None:
    """Refuse a format whose package is not installed."""
    try:
        import_module(extra.package)
    except ImportError as error:
        what, remedy = f"the package {extra.package} is not installed", f"Run: {install_command(extra.package)}"
        raise DataError(Problem(f"no_{extra.package}", extra.needed_for, what, remedy)) from error
