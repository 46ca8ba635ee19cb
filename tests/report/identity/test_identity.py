"""Under whose name a report is issued: read from the case as it is, kept with the hash of the result."""

import json
import shutil

import pytest

from fatigue.assess import assess
from fatigue.case import Report
from fatigue.check import check_case
from fatigue.documents import write_documents
from fatigue.errors import CaseError, DataError
from fatigue.report.identity.identity import NAMES, Identity, found_identity
from fatigue.report.page import report_page, write_report
from fatigue.results import read_provenance, strangers
from tests.report.reading import Page
from tests.small_case import sine_only

SIGNED = """
[report]
document = "RD-4711"
revision = "A"
date = 2026-05-31
author = "Jörg Müller"
checker = "<script>alert('C')</script>"
approver = "Ö. Åström"
vehicle = "Trailer car"
"""


def case_file(folder, extra=""):
    """A small case with more text behind it."""
    case = sine_only()
    case.extra = extra
    return case.write(folder)


@pytest.fixture(scope="module")
def assessed(tmp_path_factory):
    """A case that says nothing of its report, and its result with a page."""
    folder = tmp_path_factory.mktemp("identity")
    assess(case_file(folder / "case"), folder / "result")
    return folder


@pytest.fixture
def there(assessed, tmp_path):
    """Case and result copied, to be written to."""
    shutil.copytree(assessed, tmp_path / "copy")
    return tmp_path / "copy"


def sign(there, table):
    """Add a table to the case, or put another in its place."""
    path = there / "case" / "case.toml"
    path.write_text(path.read_text(encoding="utf-8").partition("\n[report]")[0] + table, encoding="utf-8")


def words_of(there):
    """Visible words of the page of the result."""
    return Page((there / "result" / "report.html").read_text(encoding="utf-8")).words


def test_without_a_table_the_page_is_a_draft(assessed):
    """It says so under its title and at the head of every page, and the provenance says nothing."""
    html = (assessed / "result" / "report.html").read_text(encoding="utf-8")
    assert "DRAFT, not identified" in Page(html).words
    assert '@top-right { content: "DRAFT\\2c  not identified"' in html
    assert "identity" not in read_provenance(assessed / "result")


def test_an_identity_is_given_to_a_finished_result(there):
    """No number is made anew: same hash, same tables; the page names who answers, and nothing of it is markup."""
    result = there / "result"
    before = {path.name: path.read_bytes() for path in result.glob("*.parquet")}
    hash_before = read_provenance(result)["result"]
    sign(there, SIGNED)
    write_documents(result)
    record = read_provenance(result)
    assert record["result"] == hash_before
    assert {path.name: path.read_bytes() for path in result.glob("*.parquet")} == before
    assert not strangers(result, record)
    words = words_of(there)
    assert "DRAFT" not in words
    for text in ("Document RD-4711", "Revision A", "Prepared by Jörg Müller", "Approved by Ö. Åström", "Trailer car"):
        assert text in words
    assert "Checked by <script>alert('C')</script>" in words
    assert "<script>alert" not in (result / "report.html").read_text(encoding="utf-8")


def test_every_identity_that_was_issued_is_on_record(there):
    """In their order, each once, beside the hash of the numbers; a correction is one more."""
    result = there / "result"
    for table in (SIGNED, SIGNED, SIGNED.replace('"A"', '"B"')):
        sign(there, table)
        write_report(result)
    record = read_provenance(result)
    assert [(one["report"]["revision"], one["result"]) for one in record["identity"]] == [
        ("A", record["result"]),
        ("B", record["result"]),
    ]
    sign(there, "")
    write_report(result)
    assert [one["report"].get("revision") for one in read_provenance(result)["identity"]] == ["A", "B", None]
    assert "DRAFT" in words_of(there)


def test_an_identity_changes_no_hash(assessed, tmp_path):
    """A case that was signed before it was assessed has the same numbers under the same hash."""
    path = case_file(tmp_path / "case")
    sign(tmp_path, SIGNED)
    assess(path, tmp_path / "result", report=False)
    one, other = (read_provenance(folder / "result") for folder in (assessed, tmp_path))
    assert one["result"] == other["result"]
    assert other["identity"][0]["report"]["author"] == "Jörg Müller"
    for table in (assessed / "result").glob("*.parquet"):
        assert table.read_bytes() == (tmp_path / "result" / table.name).read_bytes()


def test_what_a_draft_lacks_is_named(there):
    """The six entries that identify a report; others may be missing."""
    sign(there, '\n[report]\nauthor = "A"\ndate = "2026-05-31"\n')
    write_report(there / "result")
    assert "DRAFT, not identified: Document, Revision, Checked by and Approved by not given" in words_of(there)


def test_a_case_that_is_gone_leaves_the_identity_it_was_issued_under(there):
    """With a word on the logo that is gone with it."""
    result = there / "result"
    sign(there, SIGNED)
    write_report(result)
    shutil.rmtree(there / "case")
    assert "Jörg Müller" in Page(report_page(result)).words
    record = read_provenance(result)
    record["identity"][-1]["report"]["logo"] = "brand/logo.svg"
    found = found_identity(record, result, None)
    assert found.problems[0].what == "without the case there is no logo, brand/logo.svg"


def test_as_it_was_assessed_where_no_page_was_written(there):
    """The case as it stands in the provenance is the last resort."""
    record = read_provenance(there / "result")
    record["case_text"] += '\n[report]\nauthor = "B"\n'
    assert found_identity(record, there / "result", there / "gone.toml").entries == {"author": "B"}


def test_a_table_that_is_wrong_is_refused_and_nothing_written(there):
    """By every command that would show it."""
    before = (there / "result" / "report.html").read_bytes()
    sign(there, '\n[report]\ndate = "soon"\n')
    with pytest.raises(CaseError, match=r'report.date: "soon" is no date'):
        write_documents(there / "result")
    assert (there / "result" / "report.html").read_bytes() == before


@pytest.mark.parametrize("run", [check_case, lambda path: assess(path, path.parent / "out")])
def test_a_logo_that_is_missing_is_refused_before_anything_is_counted(tmp_path, run):
    """By check and assess."""
    path = case_file(tmp_path, '\n[report]\nlogo = "none.png"\n')
    with pytest.raises(DataError, match=r"case.toml: report.logo: .*none.png is not there"):
        run(path)
    assert not list(tmp_path.glob("out/*.parquet"))


def test_every_entry_has_a_name():
    """All keys of the table are shown, but those of the look."""
    assert set(NAMES) == set(Report.model_fields) - {"logo", "template", "language"}
    assert Identity({}).shown == []


def test_the_record_is_plain_json():
    """Entries, hashes of the files, the hash of the result."""
    record = Identity({"author": "Ä"}).as_record("ab")
    assert json.loads(json.dumps(record)) == {"result": "ab", "report": {"author": "Ä"}, "files": {}}
