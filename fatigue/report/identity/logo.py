"""A logo as the page can hold it: a picture of a known kind, small, and of SVG nothing that runs or loads.

The page must need nothing but itself and must harm nobody, so a vector graphic is refused where it could do more than
draw. It stands in the page as an image, in which no browser runs scripts in any case.
"""

import base64
import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from fatigue.errors import DataError, Problem, refuse
from fatigue.files.mishaps import reason

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

MOST_BYTES = 1_000_000
KINDS = ".png, .svg or .jpg"
_PNG, _PNG_END = b"\x89PNG\r\n\x1a\n", b"IEND\xaeB`\x82"
_JPEG, _JPEG_END = b"\xff\xd8\xff", b"\xff\xd9"
_ACTIVE = {"script", "foreignobject", "iframe", "object", "embed", "audio", "video", "handler", "animate", "set"}
_PLAIN = "Save it as plain SVG, without scripts, links and fonts from elsewhere"
_SVG = "{http://www.w3.org/2000/svg}svg"


def logo_uri(path: Path, where: str) -> str:
    """Logo of a file as a data address for the page; ``where`` is the key that names it.

    Raises
    ------
    DataError : the file is missing or too large, is no picture of a known kind, is cut off, or is an SVG that could do
        more than draw
    """
    content = _content(path, where)
    kind, problems = _kind(content), []
    if kind is None:
        problems = [
            Problem("bad_logo", where, f"{path.name} is no picture that the report can hold", f"Give a {KINDS}")
        ]
    elif kind == "svg+xml":
        problems = [Problem("bad_logo", where, f"{path.name} {what}", remedy) for what, remedy in _harm(content)]
    elif not _is_whole(kind, content):
        problems = [Problem("bad_logo", where, f"{path.name} is cut off: its end is missing", "Copy the file again")]
    refuse(DataError, problems)
    return f"data:image/{kind};base64,{base64.b64encode(content).decode()}"


def _content(path: Path, where: str) -> bytes:
    try:
        size = path.stat().st_size
        if not path.is_file():
            what, remedy = f"{path} is no file", f"Give a {KINDS}"
        elif size > MOST_BYTES:
            what, remedy = f"{path.name} has {size / 1e6:.1f} MB, the report takes 1 MB", "Save it smaller, or as SVG"
        else:
            return path.read_bytes()
    except FileNotFoundError:
        what, remedy = f"{path} is not there", "Correct the path, relative to the file that names it"
    except OSError as error:
        what, remedy = f"{path} cannot be read ({reason(error)})", "Check its permissions"
    raise DataError(Problem("missing_file" if "not there" in what else "bad_logo", where, what, remedy))


def _kind(content: bytes) -> str | None:
    """Kind of a picture by its first bytes, as its media type ends; None of anything else."""
    if content.startswith(_PNG):
        return "png"
    if content.startswith(_JPEG):
        return "jpeg"
    head = content[:4096].removeprefix(b"\xef\xbb\xbf").lstrip()
    return "svg+xml" if head.startswith(b"<") and b"<svg" in content else None


def _is_whole(kind: str, content: bytes) -> bool:
    return (_PNG_END if kind == "png" else _JPEG_END) in content[-1024:]


def _harm(content: bytes) -> Iterator[tuple[str, str]]:
    """Everything that an SVG could do beside drawing, and the remedy."""
    import xml.etree.ElementTree as ET  # noqa: PLC0415  (of no use to who has no such logo)

    if re.search(rb"<!(?:DOCTYPE|ENTITY)", content, re.IGNORECASE):  # before any parser expands what it defines
        yield "has a document type, which may define what it does not show", _PLAIN
        return
    try:
        root = ET.fromstring(content)
    except (ET.ParseError, ValueError, RecursionError) as error:
        yield f"is no sound SVG ({error})", "Save it again"
        return
    if root.tag != _SVG:
        yield "is no SVG: its root is not svg in the name space of SVG", _PLAIN
        return
    for what in dict.fromkeys(what for element in root.iter() for what in _of_element(element)):
        yield what, _PLAIN


def _of_element(element: "Element") -> Iterator[str]:
    """What one element could do beside drawing."""
    name = str(element.tag).rpartition("}")[2]
    if name.lower() in _ACTIVE:
        yield f"has a <{name}>"
    for key, value in element.attrib.items():
        attribute = key.rpartition("}")[2].lower()
        if attribute.startswith("on"):
            yield f"has a handler, {attribute}"
        elif attribute == "href" and not re.match(r"#|data:image/(?:png|jpeg);base64,", value.strip()):
            yield f"has a link to elsewhere, {value.strip()[:40]}"
        elif _loads(value):
            yield f"loads from elsewhere, {value.strip()[:40]}"
    if name == "style" and _loads(element.text or ""):
        yield "loads from elsewhere in its style"


def _loads(text: str) -> bool:
    """Whether a style loads anything: an import, or an address that is not inside the picture."""
    outside = re.search(r"url\(\s*['\"]?\s*(?!#|data:image/(?:png|jpeg);)", text, re.IGNORECASE)
    return outside is not None or "@import" in text.lower()
