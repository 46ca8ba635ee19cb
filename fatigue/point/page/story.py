"""A point on demand as a story: found in the result, solved and counted again, its damage shared out, and shown.

The report shows the worst point of each weld, and the detailed ones only. Here is any other: one that no bound let
count, a face without toe, the node that a reviewer asks for. Nothing is written into the result.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from threadpoolctl import threadpool_limits

from fatigue.errors import CaseError, DataError, Problem, given_path, no_threads, refuse
from fatigue.files.whole import replacing, staged
from fatigue.pipeline.mission.events import event_loads
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.point.found import find_station
from fatigue.point.in_the_way import in_the_way
from fatigue.point.page.gathered import Gathered, gather
from fatigue.point.page.page import point_page
from fatigue.point.page.picture import draw_picture
from fatigue.point.page.summary import PointSummary, summary_of
from fatigue.point.reopened import event_numbers, reopened
from fatigue.report.files.browser import find_browser
from fatigue.report.files.png import INSTEAD
from fatigue.report.inputs import find_inputs
from fatigue.results import finished_result
from fatigue.stages import stage

READ = ("nodes", "damage", "welds", "band")  # tables; the last one is not in every result
ENDINGS = (".html", ".png")


def point(
    folder: Path | str,
    weld: str,
    *,
    order: int | None = None,
    node: int | None = None,
    part: int | None = None,
    surface: str | None = None,
    event: str | None = None,
    output: Path | str | None = None,
    case_file: Path | str | None = None,
    threads: int | None = None,
    force: bool = False,
    no_lock: bool = False,
) -> PointSummary:
    """What the report shows of worst points, of any point of a finished result; as a page or a picture if asked.

    Parameters
    ----------
    folder : result of an assessment
    weld : its name
    order, node, part : where along the weld; with neither order nor node at its worst point
    surface : ``top`` or ``bottom``; by default the face that decides: of two toes the more utilised
    event : whose record is shown; by default the one that damages most
    output : file to write, ``.html`` or ``.png``; the latter wants a Chromium, Chrome or Edge
    case_file : the case it was made from; by default where the provenance of the result says
    threads : that prepare events, by default one per processor core; the numbers do not depend on it
    force : overwrite a file that is there already
    no_lock : for a file system without locks, see ``fatigue.assess``

    Raises
    ------
    DataError : no finished result, no such point, inputs that are gone or have changed, a file in the way, no browser
    CaseError : arguments that make no sense
    NumericalError : stress or damage exceeds double precision
    """
    folder = given_path(folder, "folder")
    file = None if output is None else given_path(output, "output")
    named = None if case_file is None else given_path(case_file, "case_file")
    refuse(CaseError, [*no_threads(threads), *_no_format(file)])
    stage("reading the result and its case")
    record = finished_result(folder, READ, READ, no_lock=no_lock)
    station = find_station(folder, weld, order=order, node=node, part=part)
    face = station.face(surface)
    if file is not None:
        refuse(DataError, in_the_way(file, folder, record, named, force=force))
        if file.suffix.lower() == ".png":
            find_browser("PNG", INSTEAD)  # before the work, not after it
    with _scratch(file) as scratch, threadpool_limits(limits=1, user_api="blas"):
        inputs = reopened(folder, record, scratch, named)
        event_numbers(inputs, event)  # refuses one that there is not
        plan, _ = mission_plan(inputs.body, threads)
        stage("preparing the records of the events (%d)", len(plan.passes))
        loads = event_loads(inputs.groups, plan, scratch / "histories", threads, inputs.factors)
        stage("counting the point and sharing out its damage")
        found = gather(inputs, find_inputs(record, folder, named), station, face, loads, plan, event)
        if file is not None:
            _show(found, file)
    return replace(summary_of(found), file=file)


@contextmanager
def _scratch(file: Path | None) -> Iterator[Path]:
    """A folder for what is too large for memory: where the page goes, else that of the system."""
    if file is not None:
        with staged(file.absolute().parent, ".fatigue-point-") as beside:
            yield beside
        return
    with TemporaryDirectory(prefix="fatigue-", ignore_cleanup_errors=True) as away:
        yield Path(away)


def _show(found: Gathered, file: Path) -> None:
    """Write the page or the picture."""
    stage("writing %s", file.name)
    with replacing(file) as unfinished:
        if file.suffix.lower() == ".png":
            draw_picture(found, unfinished)
        else:
            page = point_page(found)
            unfinished.write_text(page, encoding="utf-8", errors="backslashreplace", newline="\n")


def _no_format(file: Path | None) -> Iterator[Problem]:
    """Refusal of a file that is neither a page nor a picture."""
    if file is not None and file.suffix.lower() not in ENDINGS:
        ending = f"is not written as '{file.suffix}'" if file.suffix else "has a name without ending"
        remedy = "End it in .html for the page or in .png for a picture"
        if file.suffix.lower() == ".pdf":
            remedy = "Write .html, and print it from any browser"
        yield Problem("unknown_format", str(file), f"the page of a point {ending}", remedy)
