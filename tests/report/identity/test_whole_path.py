"""From a signed case with a company template to the printed report, as a user does it, on the shipped template."""

import shutil
import subprocess
from pathlib import Path

import pytest

from fatigue.errors import DataError
from fatigue.report.files.browser import find_browser
from fatigue.results import read_provenance
from tests.command_line import fatigue
from tests.report.reading import Page
from tests.small_case import sine_only

COMPANY = Path(__file__).parents[3] / "examples" / "company"
TABLE = """
[report]
document = "RD-4711"
revision = "B"
date = 2026-05-31
author = "Jörg Müller"
checker = "A. Schmidt"
approver = "Ö. Åström"
company = "Rail Bodies GmbH"
template = "company"
"""


@pytest.fixture(scope="module")
def signed(tmp_path_factory):
    """Case with the shipped template beside it, and its result."""
    folder = tmp_path_factory.mktemp("whole")
    case = sine_only()
    case.extra = TABLE
    path = case.write(folder / "case")
    shutil.copytree(COMPANY, folder / "case" / "company")
    done = fatigue("assess", path, "-o", folder / "result", "--exit-zero")
    assert done.returncode == 0, done.stderr
    return folder


def test_the_page_has_the_look_of_the_company(signed):
    """Logo, texts, colours and language of the template; hashes of its files in the provenance."""
    html = (signed / "result" / "report.html").read_text(encoding="utf-8")
    page = Page(html)
    assert '<html lang="de">' in html
    assert "--accent: #004b5a;" in html
    (logo,) = [given for tag, given in page.tags if tag == "img"]
    assert logo["src"].startswith("data:image/svg+xml;base64,")
    assert logo["alt"] == "Rail Bodies GmbH"
    assert "Rail Bodies GmbH · Betriebsfestigkeit" in page.words
    assert "Dieser Bericht gilt nur zusammen" in page.words
    assert "ENTWURF" not in page.words
    assert sorted(read_provenance(signed / "result")["identity"][0]["files"]) == ["logo", "template"]


def test_a_template_that_cannot_be_read_is_refused(signed, tmp_path):
    """One line, exit code 3, the page stays."""
    shutil.copytree(signed, tmp_path / "copy")
    template = tmp_path / "copy" / "case" / "company" / "template.toml"
    template.write_text(template.read_text("utf-8").replace("#004b5a", "#ffee00"), encoding="utf-8")
    done = fatigue("report", tmp_path / "copy" / "result")
    assert done.returncode == 3
    assert (
        "template.toml: colours.accent: '#ffee00' can hardly be read: its contrast with the page is 1.1" in done.stderr
    )


@pytest.mark.browser
@pytest.mark.skipif(shutil.which("pdftotext") is None, reason="pdftotext reads the pages")
def test_every_printed_page_says_whose_it_is(signed, tmp_path):
    """Document and revision at the head, version, hash and page x of y at the foot of each."""
    try:
        find_browser()
    except DataError as error:
        pytest.skip(str(error))
    shutil.copytree(signed, tmp_path / "copy")
    done = fatigue("report", tmp_path / "copy" / "result", "--pdf")
    assert done.returncode == 0, done.stderr
    pdf = tmp_path / "copy" / "result" / "report.pdf"
    pages = (
        subprocess.run(["pdftotext", "-layout", pdf, "-"], capture_output=True, check=True).stdout.decode().split("\f")
    )
    pages = [" ".join(page.split()) for page in pages if page.strip()]
    result = read_provenance(tmp_path / "copy" / "result")["result"]
    assert len(pages) > 3
    for number, page in enumerate(pages, 1):
        assert "RD-4711 Rev. B · 2026-05-31" in page
        assert f"Rail Bodies GmbH · vertraulich · fatigue 0.1.0, Ergebnis {result[:12]}" in page
        assert f"Seite {number} von {len(pages)}" in page
