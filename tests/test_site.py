"""The docs as a site: built with warnings as errors, every page in it, every section with its contents."""

import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
HAS_SPHINX = all(importlib.util.find_spec(name) for name in ("sphinx", "myst_parser", "furo"))

pytestmark = pytest.mark.skipif(not HAS_SPHINX, reason='the site needs pip install -e ".[docs]"')


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """Folder of the built site."""
    folder = tmp_path_factory.mktemp("site")
    command = ["-m", "sphinx", "-W", "--keep-going", "-q", "-b", "html", "-c", "docs/site", ".", str(folder)]
    done = subprocess.run(
        [sys.executable, *command], cwd=ROOT, env=os.environ.copy(), capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return folder


def test_every_page_is_in_the_site(site):
    """No page of the docs is left out."""
    pages = [page.relative_to(ROOT).with_suffix(".html") for page in ROOT.glob("docs/**/*.md")]
    assert len(pages) > 70
    assert not [page for page in pages if not (site / page).exists()]


def test_links_and_pictures_are_there(site):
    """What pages of the site refer to lies in the site, and nothing is loaded from elsewhere."""
    for page in site.glob("docs/**/*.html"):
        text = page.read_text(encoding="utf-8")
        names = re.findall(r'(?:href|src)="([^"#?]+)', text)
        local = [name for name in names if not re.match(r"[a-z]+:|//", name)]
        assert not [name for name in local if not (page.parent / name).exists()], page
        loaded = re.findall(r'(?:<script[^>]*src|<link[^>]*rel="stylesheet"[^>]*href)="(https?:[^"]+)', text)
        assert not loaded, page


def test_sections_lead_to_their_pages(site):
    """The contents of the site have every section."""
    home = (site / "docs" / "index.html").read_text(encoding="utf-8")
    for name in ("start", "how-to", "gallery", "reference", "theory", "verification", "quality"):
        assert f'href="{name}.html"' in home
