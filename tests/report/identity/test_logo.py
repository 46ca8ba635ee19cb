"""Logos: pictures of known kinds, small, and nothing that runs or loads."""

import base64

import pytest

from fatigue.errors import DataError
from fatigue.report.identity.logo import MOST_BYTES, logo_uri
from tests.report.identity.pictures import JPEG, PNG, svg


def told(path):
    """The first line that refuses a logo."""
    with pytest.raises(DataError) as error:
        logo_uri(path, "case.toml: report.logo")
    return str(error.value.problems[0])


@pytest.mark.parametrize(
    ("content", "kind"),
    [
        (PNG, "png"),
        (JPEG, "jpeg"),
        (svg(), "svg+xml"),
        (b'\xef\xbb\xbf<?xml version="1.0"?>\n' + svg(), "svg+xml"),
        (svg('<use xlink:href="#a"/><style>.a { fill: url(#b) }</style>'), "svg+xml"),
        (svg('<image xlink:href="data:image/png;base64,AAAA"/>'), "svg+xml"),
    ],
)
def test_pictures_of_each_kind(tmp_path, content, kind):
    """By their content, whatever the name; the bytes are in the address as they are."""
    path = tmp_path / "logo.dat"
    path.write_bytes(content)
    head, _, data = logo_uri(path, "").partition(",")
    assert head == f"data:image/{kind};base64"
    assert base64.b64decode(data) == content


@pytest.mark.parametrize(
    ("inside", "finding"),
    [
        ("<script>alert(1)</script>", "has a <script>"),
        ("<g><SCRIPT xmlns='http://www.w3.org/1999/xhtml'/></g>", "has a <SCRIPT>"),
        ("<foreignObject/>", "has a <foreignObject>"),
        ('<rect onload="alert(1)"/>', "has a handler, onload"),
        ('<rect ONCLICK="alert(1)"/>', "has a handler, onclick"),
        ('<a xlink:href="javascript:alert(1)"/>', "has a link to elsewhere, javascript:alert(1)"),
        ('<image href="https://example.org/a.png"/>', "has a link to elsewhere"),
        ('<image href="data:image/svg+xml;base64,AA"/>', "has a link to elsewhere"),
        ('<rect style="fill: url(https://example.org/x)"/>', "loads from elsewhere"),
        ("<style>@import 'https://example.org/x';</style>", "loads from elsewhere in its style"),
        ('<style>a { src: URL( "//example.org/f") }</style>', "loads from elsewhere in its style"),
        ('<set attributeName="onclick" to="alert(1)"/>', "has a <set>"),
        ("<unclosed>", "is no sound SVG"),
    ],
)
def test_an_svg_that_could_do_more_than_draw(tmp_path, inside, finding):
    """Scripts, handlers, links, anything from elsewhere."""
    path = tmp_path / "logo.svg"
    path.write_bytes(svg(inside))
    assert f"report.logo: logo.svg {finding}" in told(path)


def test_an_svg_with_entities(tmp_path):
    """Refused before anything expands them."""
    path = tmp_path / "logo.svg"
    path.write_bytes(b'<!DOCTYPE svg [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]>' + svg("<text>&b;</text>"))
    assert "has a document type" in told(path)


@pytest.mark.parametrize(
    ("content", "finding"),
    [
        (b"", "is no picture"),
        (b"GIF89a", "is no picture"),
        (b"%PDF-1.4", "is no picture"),
        (b"<html><svg></svg></html>", "is no SVG"),
        (b"<html></html>", "is no picture"),
        (PNG[:-8], "is cut off"),
        (JPEG[:-2], "is cut off"),
    ],
)
def test_what_is_no_picture(tmp_path, content, finding):
    """Other kinds, and files that were not copied to their end."""
    path = tmp_path / "logo.png"
    path.write_bytes(content)
    assert finding in told(path)


def test_missing_folder_and_too_large(tmp_path):
    """Nothing is read of a file that is too large."""
    assert "is not there. Correct the path" in told(tmp_path / "none.png")
    assert "is no file" in told(tmp_path)
    large = tmp_path / "large.png"
    large.write_bytes(PNG + bytes(10 * MOST_BYTES))
    assert told(large) == (
        "case.toml: report.logo: large.png has 10.0 MB, the report takes 1 MB. Save it smaller, or as SVG."
    )
