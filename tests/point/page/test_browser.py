"""The page of a point in a real browser: it opens, asks for nothing, draws every figure, and fits a phone."""

import pytest

from fatigue.errors import DataError
from fatigue.point.page.story import point
from fatigue.report.files.browser import find_browser

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def browser():
    """A browser without a window."""
    try:
        chromium = find_browser()
    except DataError as error:
        pytest.skip(str(error))
    sync_api = pytest.importorskip("playwright.sync_api", reason="needs the package playwright")
    with sync_api.sync_playwright() as playwright:
        found = playwright.chromium.launch(executable_path=str(chromium), args=["--no-sandbox"])
        yield found
        found.close()


@pytest.fixture(scope="module")
def page(results, tmp_path_factory):
    """The page of a point."""
    return point(results("plain"), "A", order=3, output=tmp_path_factory.mktemp("page") / "point.html").file


@pytest.mark.parametrize("width", [1280, 420])
def test_it_opens_and_draws(browser, page, width):
    """The console is silent, the only request is for the page, no figure is empty, and nothing is wider than it."""
    heard, asked = [], []
    with browser.new_page(viewport={"width": width, "height": 900}) as opened:
        opened.on("console", lambda message: heard.append(message.text) if message.type == "error" else None)
        opened.on("pageerror", lambda error: heard.append(str(error)))
        opened.on("request", lambda request: asked.append(request.url))
        opened.goto(page.as_uri())
        opened.wait_for_function("window.Plotly !== undefined")
        opened.evaluate(
            "(async () => { for (const p of document.querySelectorAll('.plot')) {"
            " p.scrollIntoView({ behavior: 'instant' }); await new Promise(requestAnimationFrame); } })()"
        )
        opened.wait_for_function(
            "[...document.querySelectorAll('.plot')]"
            ".every((p) => p.querySelector('.main-svg .trace, .heatmaplayer, .bars'))"
        )
        wide = opened.evaluate("document.documentElement.scrollWidth")
    assert heard == []
    assert asked == [page.as_uri()]
    assert wide <= width
