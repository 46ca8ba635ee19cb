"""Print the report: the same page on paper, by a Chromium, Chrome or Edge that is installed."""

import shutil
import tempfile
from pathlib import Path

from fatigue.errors import DataError, Problem
from fatigue.files.mishaps import refused_writing
from fatigue.report.files.browser import find_browser, run_browser


def print_pdf(html: Path | str, pdf: Path | str, comment: str = "") -> None:
    """Print a report to PDF: all figures and details, paginated for A4; ``comment`` goes into its last line.

    The page draws all its figures before it has finished loading when its address ends in ``#print``.

    Raises
    ------
    DataError : no browser is installed, it fails, or there is no such page
    """
    html, pdf = Path(html), Path(pdf)
    if not html.is_file():
        raise DataError(Problem("missing_file", str(html), "there is no such page", "Write the report first"))
    browser = find_browser()
    with tempfile.TemporaryDirectory(prefix="fatigue-", ignore_cleanup_errors=True) as profile:
        printed = Path(profile) / "report.pdf"
        options = ("--no-pdf-header-footer", f"--print-to-pdf={printed}")
        said = run_browser(browser, options, f"{html.resolve().as_uri()}#print", profile)
        if not printed.is_file():
            what, remedy = f"could not print the page ({said})", f"Open {html.name} in any browser and print it there"
            raise DataError(Problem("no_pdf", str(browser), what, remedy))
        with refused_writing(pdf):
            shutil.copyfile(printed, pdf)
            if comment:  # a comment behind the end marker is allowed (ISO 32000-1, 7.2.4 and 7.5.5)
                with pdf.open("ab") as file:
                    file.write(f"% {comment}\n".encode("ascii"))
