"""A company template: one folder with ``template.toml`` (colours, texts, language) and a logo.

Every key may be left out. Colours are those of letters and lines, not of figures, whose colours mean something; those
that cannot be read on the ground of the page are refused.
"""

import difflib
import hashlib
import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from fatigue.case import Case
from fatigue.errors import DataError, Problem, refuse
from fatigue.files.mishaps import reason
from fatigue.report.identity.contrast import LEAST, contrast
from fatigue.report.identity.logo import logo_uri
from fatigue.report.language import ENGLISH, Language, language_named, languages

TEMPLATE = "template.toml"
COLOURS = {
    "accent": "links, the verdict of a target that is met, and lines of the head",
    "missed": "the verdict of a target that is missed",
    "ink": "letters",
    "quiet": "captions and what is said beside",
}
TEXTS = {"head": "above the title", "note": "below the verdict", "foot": "at the foot of every printed page"}
LONGEST_TEXT = 2000
GROUND = "#f5f7f9"  # the darkest ground of letters on the page
_TABLES = ("logo", "language", "colours", "texts")


@dataclass(frozen=True, slots=True)
class Look:
    """Look of a report.

    Attributes
    ----------
    logo : data address of the picture; empty without one
    colours : of ``COLOURS``, those that are not as they are by default
    texts : of ``TEXTS``, those that are given
    language : of headings, captions and verdicts
    files : SHA-256 of the files it is made of, by the key that names them
    """

    logo: str = ""
    colours: Mapping[str, str] = field(default_factory=dict)
    texts: Mapping[str, str] = field(default_factory=dict)
    language: Language = ENGLISH
    files: Mapping[str, str] = field(default_factory=dict)

    def in_language(self, name: str | None) -> "Look":
        """The same look in another language, where there is one of this name."""
        return replace(self, language=language_named(name)) if name in languages() else self


PLAIN = Look()


def look_of(case: Case) -> Look:
    """Look that a case gives its report: that of its template, logo and language of the case before those of it.

    Raises
    ------
    DataError : template or logo are missing or unfit, a colour cannot be read, or there is no such language
    """
    report, name = case.report, case.path.name
    where = f"{name}: report.template"
    look = PLAIN if report.template is None else _look_of_folder(case.resolve(report.template), where)
    if report.language is not None:
        refuse(DataError, _no_language(report.language, f"{name}: report.language"))
        look = look.in_language(report.language)
    if report.logo is not None:
        look = _with_logo(look, case.resolve(report.logo), f"{name}: report.logo")
    return look


def _look_of_folder(folder: Path, where: str) -> Look:
    """Look of the folder of a template; ``where`` is the key that names it."""
    path = folder / TEMPLATE
    raw, digest = _read(path, folder, where)
    refuse(DataError, _unfit(raw, path))
    look = Look(
        colours={key: str(value).lower() for key, value in raw.get("colours", {}).items()},
        texts=dict(raw.get("texts", {})),
        files={"template": digest},
    )
    if "language" in raw:
        look = look.in_language(raw["language"])
    return _with_logo(look, folder / raw["logo"], f"{path.name}: logo") if "logo" in raw else look


def _read(path: Path, folder: Path, where: str) -> tuple[dict[str, Any], str]:
    """Tables of a template, and the SHA-256 of its file."""
    if not folder.is_dir():
        what = "is a file, not a folder" if folder.exists() else "is not there"
        remedy = f"Give the folder that holds {TEMPLATE}, relative to the case file"
        raise DataError(Problem("bad_template", where, f"the folder {folder} {what}", remedy))
    try:
        content = path.read_bytes()
        return tomllib.loads(content.decode("utf-8-sig")), hashlib.sha256(content).hexdigest()
    except OSError as error:
        what, remedy = f"{path} cannot be read ({reason(error)})", f"Write {TEMPLATE} into the folder, it may be empty"
    except (ValueError, RecursionError) as error:
        what, remedy = f"{path} is no TOML in UTF-8 ({error})", "Correct the line"
    raise DataError(Problem("bad_template", where, what, remedy))


def _with_logo(look: Look, path: Path, where: str) -> Look:
    uri = logo_uri(path, where)
    return replace(look, logo=uri, files={**look.files, "logo": hashlib.sha256(path.read_bytes()).hexdigest()})


def _unfit(raw: Mapping[str, Any], path: Path) -> Iterator[Problem]:
    """Everything that is wrong with the keys of a template."""
    yield from _unknown(raw, _TABLES, "", path)
    for key in ("logo", "language"):
        if key in raw and not (isinstance(raw[key], str) and raw[key]):
            yield _bad(path, key, raw[key], "is no text", f"Give the {'file' if key == 'logo' else 'name'} as a text")
    if isinstance(raw.get("language"), str):
        yield from _no_language(raw["language"], f"{path.name}: language")
    for table, known in (("colours", COLOURS), ("texts", TEXTS)):
        given = raw.get(table, {})
        if not isinstance(given, dict):
            yield _bad(path, table, given, "is no table", f"Write [{table}] above its keys")
            continue
        yield from _unknown(given, tuple(known), f"{table}.", path)
        for key in known.keys() & given.keys():
            yield from (_colour if table == "colours" else _text)(path, f"{table}.{key}", given[key])


def _unknown(given: Mapping[str, Any], known: tuple[str, ...], prefix: str, path: Path) -> Iterator[Problem]:
    for key in given:
        if key not in known:
            near = difflib.get_close_matches(key, known, n=1)
            remedy = f"Write {near[0]!r}" if near else f"Remove it; the keys are {', '.join(known)}"
            yield Problem("unknown_key", f"{path.name}: {prefix}{key}", "unknown key", remedy)


def _colour(path: Path, key: str, value: Any) -> Iterator[Problem]:
    if not (isinstance(value, str) and re.fullmatch(r"#[0-9a-fA-F]{6}", value)):
        yield _bad(path, key, value, "is no colour", "Write it as #rrggbb, for instance #0b5c8a")
    elif (found := contrast(value, GROUND)) < LEAST:
        what = f"can hardly be read: its contrast with the page is {found:.1f}, at least {LEAST:g} is wanted (WCAG 2.1)"
        yield _bad(path, key, value, what, "Take a darker colour")


def _text(path: Path, key: str, value: Any) -> Iterator[Problem]:
    if not isinstance(value, str):
        yield _bad(path, key, value, "is no text", "Put it into quotation marks")
    elif len(value) > LONGEST_TEXT:
        yield Problem(
            "bad_template", f"{path.name}: {key}", f"has {len(value)} letters", f"Give {LONGEST_TEXT} at most"
        )


def _bad(path: Path, key: str, value: Any, what: str, remedy: str) -> Problem:
    return Problem("bad_template", f"{path.name}: {key}", f"{str(value)[:60]!r} {what}", remedy)


def _no_language(name: str, where: str) -> Iterator[Problem]:
    if name not in languages():
        yield Problem(
            "bad_value", where, f"there is no language {name[:60]!r}", f"Give one of {', '.join(languages())}"
        )
