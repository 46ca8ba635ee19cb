"""A page as a picture that goes into a mail, drawn by a Chromium, Chrome or Edge that is installed."""

import shutil
import tempfile
from pathlib import Path

from fatigue.errors import DataError, Problem
from fatigue.files.mishaps import refused_writing
from fatigue.report.files.browser import find_browser, run_browser

WIDTH = 1600  # px
INSTEAD = "write the page as HTML: give -o a name that ends with .html"


def draw_png(page: str, png: Path, height: int) -> None:
    """Draw a page of this height [px] that is ``WIDTH`` wide; it draws its figures before it has finished loading.

    Raises
    ------
    DataError : no browser is installed, or it fails
    """
    browser = find_browser("PNG", INSTEAD)
    with tempfile.TemporaryDirectory(prefix="fatigue-", ignore_cleanup_errors=True) as scratch:
        html, drawn = Path(scratch) / "page.html", Path(scratch) / "page.png"
        html.write_text(page, encoding="utf-8", errors="backslashreplace", newline="\n")
        options = (
            f"--screenshot={drawn}",
            f"--window-size={WIDTH},{height}",
            "--force-device-scale-factor=1",
            "--hide-scrollbars",
        )
        said = run_browser(browser, options, html.as_uri(), scratch)
        if not drawn.is_file():
            what, remedy = f"could not draw the page ({said})", f"{INSTEAD[0].upper()}{INSTEAD[1:]}"
            raise DataError(Problem("no_png", str(browser), what, remedy))
        with refused_writing(png):
            shutil.copyfile(drawn, png)
