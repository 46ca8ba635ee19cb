"""The page in a real browser: it opens, draws, answers pointer and keyboard, sorts, filters and prints."""

import re
import shutil
import subprocess

import pytest

from fatigue.errors import DataError
from fatigue.report.files.browser import find_browser
from fatigue.report.files.pdf import print_pdf
from fatigue.report.page import write_report
from tests.report.tiny_result import Recipe, write_result

pytestmark = pytest.mark.browser
FLAGS = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking", "--no-sandbox"]


@pytest.fixture(scope="module")
def chromium():
    """Path of an installed browser; the reason is shown where there is none."""
    try:
        return find_browser()
    except DataError as error:
        pytest.skip(str(error))


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    """Report of a small result with a name that would like to run a script."""
    recipe = Recipe(welds=("W1 bracket", "<script>alert(1)</script>"), stations=5)
    return write_report(write_result(tmp_path_factory.mktemp("browser"), recipe))


@pytest.fixture(scope="module")
def browser(chromium):
    """A running browser."""
    sync_api = pytest.importorskip("playwright.sync_api", reason="needs the package playwright")
    with sync_api.sync_playwright() as playwright:
        running = playwright.chromium.launch(executable_path=str(chromium), args=FLAGS)
        yield running
        running.close()


@pytest.fixture(scope="module")
def opened(browser, report):
    """The page, opened and scrolled to its end, with what it asked for and complained of."""
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    page.heard = []
    page.asked = []
    page.on("console", lambda message: page.heard.append(message.text) if message.type == "error" else None)
    page.on("pageerror", lambda error: page.heard.append(str(error)))
    page.on("request", lambda request: page.asked.append(request.url))
    page.goto(report.as_uri())
    page.wait_for_function("window.Plotly !== undefined")
    page.evaluate("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
    page.evaluate(
        "(async () => { for (const p of document.querySelectorAll('.plot')) {"
        " p.scrollIntoView({ behavior: 'instant' }); await new Promise(requestAnimationFrame); } })()"
    )
    page.wait_for_function(
        "[...document.querySelectorAll('.plot')].filter((p) => p.offsetParent)"
        ".every((p) => p.querySelector('.main-svg, .gl-container canvas'))"
    )
    yield page
    page.close()


def test_it_opens_without_errors_and_asks_for_nothing(opened, report):
    """The console is silent and the only request is for the page itself."""
    assert opened.heard == []
    assert opened.asked == [report.as_uri()]


def test_every_figure_on_screen_is_drawn(opened):
    """Every visible figure has axes or a canvas, and none is an empty box."""
    drawn = opened.evaluate(
        "[...document.querySelectorAll('.plot')].filter((p) => p.offsetParent).map((p) => "
        "[p.dataset.figure, p.querySelectorAll('.xy .trace, .xy .heatmaplayer, .barlayer .bars, canvas').length])"
    )
    assert len(drawn) == 20
    assert [name for name, count in drawn if not count] == []


def test_there_is_no_upload_button(opened):
    """No mode bar offers to share, to upload or to edit in a cloud."""
    titles = opened.evaluate(
        "[...document.querySelectorAll('.modebar-btn')].map((b) => b.dataset.title || b.ariaLabel || '')"
    )
    assert titles
    assert not [t for t in titles if re.search("share|cloud|upload|chart studio|plotly", t, re.IGNORECASE)]


# Where the first point of the weld lines is on screen, by the matrices of the camera.
FIRST_POINT = """(() => {
  const plot = document.querySelector('#fig-scene .plot');
  plot.scrollIntoView({ block: 'center', behavior: 'instant' });
  const scene = plot._fullLayout.scene._scene, camera = scene.glplot.cameraParams;
  const trace = plot._fullData.find((d) => d.name === 'weld lines');
  let v = [trace.x[0] * scene.dataScale[0], trace.y[0] * scene.dataScale[1], trace.z[0] * scene.dataScale[2], 1];
  for (const m of [camera.model, camera.view, camera.projection])
    v = [0, 1, 2, 3].map((i) => m[i] * v[0] + m[4 + i] * v[1] + m[8 + i] * v[2] + m[12 + i] * v[3]);
  const box = plot.querySelector('.gl-container canvas, canvas').getBoundingClientRect();
  return [box.x + box.width * (0.5 + 0.5 * v[0] / v[3]), box.y + box.height * (0.5 - 0.5 * v[1] / v[3])];
})()"""


def test_a_point_of_the_scene_shows_its_numbers(opened):
    """Moving onto a weld line in 3-D shows the numbers of the point beside the scene; a click keeps them."""
    opened.evaluate(FIRST_POINT)  # brings the scene into view, which draws it anew
    opened.wait_for_timeout(1000)
    x, y = opened.evaluate(FIRST_POINT)
    for step in range(40):  # the picture under the pointer is read back once it moves
        opened.mouse.move(x + step % 4 - 2, y)
        opened.wait_for_timeout(100)
        if opened.inner_text("#probe"):
            break
    opened.mouse.click(x, y)
    shown = opened.inner_text("#probe")
    assert re.search(r"node\s+[12]00\d\b", shown)
    assert "km" in shown
    assert opened.inner_text("#probe-link") == "Show this weld in detail"


@pytest.mark.parametrize("by", ["utilisation", "ratio", "event", "life"])
def test_the_scene_takes_another_colour(opened, by):
    """Each choice recolours the lines and renames the colour bar; reached by keyboard labels."""
    opened.check(f"input[name=colour][value={by}]")
    title = opened.evaluate(
        "(() => { const p = document.querySelector('#fig-scene .plot');"
        " return p.data.find((d) => d.name === 'weld lines').marker.colorbar.title.text; })()"
    )
    assert (
        title.split(" ")[0]
        in {"utilisation": "utilisation", "ratio": "damage", "event": "governing", "life": "life"}[by]
    )


def test_tables_sort_by_number_and_by_name(opened):
    """A click on the head sorts up, another one down, and the head says so."""
    column = "[...document.querySelectorAll('#worst-ten tbody tr')].map((r) => Number(r.cells[5].dataset.v))"
    head = opened.locator("#worst-ten th button").nth(5)
    head.click()
    rising = opened.evaluate(column)
    head.click()
    assert rising == sorted(rising)
    assert opened.evaluate(column) == sorted(rising, reverse=True)
    assert opened.get_attribute("#worst-ten th:nth-child(6)", "aria-sort") == "descending"


def test_tables_filter(opened):
    """Only rows with all the words stay, and their number is told."""
    opened.fill("#filter-weld-register", "bracket w1")
    assert (
        opened.evaluate("[...document.querySelectorAll('#weld-register tbody tr')].filter((r) => !r.hidden).length")
        == 1
    )
    assert opened.inner_text("[data-filter='Find a weld'] [role=status]") == "1 of 2"
    opened.fill("#filter-weld-register", "")


def test_a_link_opens_the_page_of_its_weld(browser, report):
    """Following a weld from the first table opens its details."""
    page = browser.new_page()
    page.goto(report.as_uri())
    page.click("#worst-welds tbody tr:nth-child(2) a")
    page.wait_for_function("document.getElementById('weld-2').open")
    page.close()


def test_everything_is_reached_by_keyboard_and_has_a_label(opened):
    """Controls are native and named; figures have a name for readers who do not see them."""
    unnamed = opened.evaluate(
        "[...document.querySelectorAll('input')].filter((i) => !i.labels.length).length"
        " + [...document.querySelectorAll('.plot')].filter((p) => !p.ariaLabel).length"
        " + [...document.querySelectorAll('th button')].filter((b) => !b.innerText.trim()).length"
    )
    assert unnamed == 0
    opened.focus("#welds details summary")
    before = opened.evaluate("document.activeElement.parentElement.open")
    opened.keyboard.press("Enter")
    assert opened.evaluate("document.activeElement.parentElement.open") != before
    opened.keyboard.press("Enter")


def test_text_has_contrast(opened):
    """Ink, quiet text, accent, alarm and doubt keep a contrast of 4.5 against light and dark pages (WCAG 2.1 AA)."""
    seen = "--page --wash --ink --quiet --accent --missed --doubt"

    def luminance(colour):
        parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
        linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
        return sum(w * c for w, c in zip((0.2126, 0.7152, 0.0722), linear, strict=True))

    for scheme in ("dark", "light"):
        opened.emulate_media(color_scheme=scheme)
        page, wash, *colours = opened.evaluate(
            f"'{seen}'.split(' ').map((name) => "
            "getComputedStyle(document.documentElement).getPropertyValue(name).trim())"
        )
        assert (luminance(page) < 0.5) == (scheme == "dark")
        for ground in (page, wash):
            for colour in colours:
                low, high = sorted((luminance(ground), luminance(colour)))
                assert (high + 0.05) / (low + 0.05) >= 4.5, (scheme, ground, colour)
    assert opened.evaluate("getComputedStyle(document.querySelector('.plot')).backgroundColor") != "rgb(18, 24, 29)"


def test_nothing_is_wider_than_a_small_screen(browser, report):
    """Down to a phone nothing but tables in their own frame runs off to the right, and facts have room for words."""
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    page.goto(report.as_uri())
    page.evaluate("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
    for width in (1280, 700, 420):
        page.set_viewport_size({"width": width, "height": 900})
        page.wait_for_function(f"document.documentElement.scrollWidth <= {width}")
        widths = page.evaluate("[...document.querySelectorAll('dl.facts.grid dd')].map((d) => d.clientWidth)")
        assert min(widths) >= 80
    page.close()


def test_the_page_prints_on_numbered_pages(chromium, report, tmp_path):
    """The PDF has the verdict, every weld and the method, on more than a few pages, each with its number."""
    pdf = tmp_path / "report.pdf"
    print_pdf(report, pdf)
    assert pdf.read_bytes().startswith(b"%PDF")
    if not shutil.which("pdftotext"):
        pytest.skip("needs pdftotext to read the pages")
    text = subprocess.run(["pdftotext", "-layout", str(pdf), "-"], capture_output=True, check=True).stdout.decode()
    pages = text.split("\f")[:-1]
    assert 5 <= len(pages) <= 12
    numbers = [int(n) for n in re.findall(r"Figure (\d+)", text)]
    assert numbers == list(range(1, len(numbers) + 1))
    assert all(f"page {i} of {len(pages)}" in " ".join(page.split()) for i, page in enumerate(pages, start=1))
    assert "Target not fulfilled" in pages[0]
    assert "Prepared" in pages[0]
    assert "<script>alert(1)</script>" in text
    assert "arc length [mm]" in text


def test_every_point_is_found(opened):
    """Words, a node, a least utilisation and only the worst of hot spots; the rows link to their weld."""
    opened.locator("#all-points").scroll_into_view_if_needed()
    opened.wait_for_selector("#found-points tbody tr")
    shown = "document.getElementById('points-shown').textContent"
    assert opened.evaluate(shown) == "1 to 20 of 20 points"

    def told(words, least="", only=False):
        opened.fill("#find-points", words)
        opened.fill("#from-utilisation", least)
        opened.set_checked("#only-worst", only)
        opened.evaluate(
            "document.getElementById('points-shown').textContent = '';"
            "document.querySelector('#all-points form').dispatchEvent(new Event('input'))"
        )
        opened.wait_for_function(f"{shown} !== ''")
        return opened.evaluate(shown)

    assert told("bracket bottom") == "1 to 5 of 5 points"
    assert told("1003") == "1 to 2 of 2 points"
    assert told("", only=True) == "1 to 4 of 4 points"
    assert told("no such weld") == "no point like this"
    assert told("", least="1e9") == "no point like this"
    assert told("bracket") == "1 to 10 of 10 points"
    first = opened.inner_text("#found-points tbody tr:first-child")
    spot = opened.inner_text("#hot-spots tbody tr:first-child")
    assert first.split("\t")[:3] == spot.split("\t")[:3]
    assert [float(row.split("\t")[7]) for row in (first, spot)] == pytest.approx(
        [float(first.split("\t")[7])] * 2, rel=5e-3
    )
    assert opened.get_attribute("#found-points tbody a", "href") == "#weld-1"
    told("")
