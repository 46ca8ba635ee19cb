"""The table of contents of the package: names, types, and paths as text."""

import re
from dataclasses import replace
from importlib import resources
from pathlib import Path

import pytest

import fatigue
from fatigue.assess import assess
from fatigue.diagnose import diagnose
from fatigue.errors import CaseError, DataError
from fatigue.example import write_example
from fatigue.readers.convert.options import ConvertOptions, WeldSources
from fatigue.report.files.export import write_csv
from fatigue.report.files.vtp import write_vtp
from fatigue.report.page import report_page, write_report
from fatigue.results import read_rows, row_count, row_groups, worst_toes
from fatigue.spectra import spectra
from tests.small_case import small_case


@pytest.mark.parametrize("name", fatigue.__all__)
def test_every_public_name_is_there(name):
    """Each name leads to something with a docstring, or is the version."""
    found = getattr(fatigue, name)
    assert name == "__version__" or found.__doc__
    assert name in dir(fatigue)


def test_other_names_are_refused():
    """As any module does."""
    with pytest.raises(AttributeError, match="module 'fatigue' has no attribute 'nothing'"):
        _ = fatigue.nothing


def test_type_checkers_see_the_same_names():
    """The stub imports every public name from where it is at run time, and the package says that it has types."""
    root = resources.files("fatigue")
    text = root.joinpath("__init__.pyi").read_text(encoding="utf-8")
    said = {name: home for home, name in re.findall(r"^from (\S+) import (\w+) as \2$", text, re.MULTILINE)}
    assert said == fatigue._HOME
    assert root.joinpath("py.typed").is_file()


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    """Paths, as text, of a small case and of its result, which was made with them."""
    folder = tmp_path_factory.mktemp("text")
    case = str(small_case().write(folder / "case"))
    done = assess(case, f"{folder}/result", report=False)
    assert done.folder == folder / "result"
    return case, f"{folder}/result"


def test_a_case_may_be_its_path(result):
    """Where a case is wanted, its file will do, as text or as a path."""
    case, _ = result
    assert fatigue.check_case(case).title == fatigue.check_case(fatigue.load_case(Path(case))).title
    assert fatigue.read_model(case).case.path == Path(case)


@pytest.mark.parametrize(
    "read",
    [
        lambda folder: fatigue.read_table(folder, "nodes").num_rows,
        lambda folder: fatigue.read_table(folder, "nodes", "life_km").column_names,
        lambda folder: fatigue.read_provenance(folder)["title"],
        lambda folder: fatigue.result_summary(folder).as_text(),
        lambda folder: fatigue.recount(folder, sample=2).passed,
        lambda folder: diagnose(folder).as_text(),
        lambda folder: spectra(folder).as_text(),
        lambda folder: [group.num_rows for group in row_groups(folder, "nodes")],
        lambda folder: read_rows(folder, "nodes", worst_toes(folder, 2)).to_pydict(),
        lambda folder: row_count(folder, "damage"),
        lambda folder: write_report(folder).name,
        lambda folder: len(report_page(folder)),
        lambda folder: write_vtp(folder).read_bytes(),
        lambda folder: [path.name for path in write_csv(folder)],
    ],
)
def test_a_folder_may_be_text(result, read):
    """What reads a result or writes beside it does the same with text as with a path."""
    _, folder = result
    assert read(folder) == read(Path(folder))


def test_files_may_be_text(result, tmp_path):
    """The case of a result, and the folder of the example."""
    case, folder = result
    assert fatigue.recount(folder, sample=2, case_file=case).passed
    assert diagnose(folder, case_file=case).as_text()
    cases = write_example(str(tmp_path / "demo"))
    assert [path.name for path in cases] == [
        "case.toml",
        "case_9hz.toml",
        "case_checks.toml",
        "case_endurance.toml",
        "case_gauges.toml",
        "case_loads.toml",
        "case_ride.toml",
    ]


def test_options_of_a_conversion_may_be_text():
    """Text becomes a path at once; one file of coordinates needs no tuple."""
    welds = WeldSources(register="r.csv")
    options = ConvertOptions("a.op2", "a.bdf", "out", coordinates="q.csv", unit_loads=["s.op2", "t.op2"], welds=welds)
    assert options.unit_loads == (Path("s.op2"), Path("t.op2"))
    assert replace(options, unit_loads="s.op2").unit_loads == (Path("s.op2"),)
    assert (options.forces, options.mesh, options.out) == (Path("a.op2"), Path("a.bdf"), Path("out"))
    assert options.coordinates == (Path("q.csv"),)
    assert options.welds.register == Path("r.csv")
    assert options.columns is None


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda case, folder: fatigue.read_table(folder, "point"), "no table 'point' of a result. Name one of nodes"),
        (lambda case, folder: fatigue.read_table(folder, 3), "no table 3 of a result"),
        (lambda case, folder: fatigue.read_table(folder, "nodes", ["lifekm"]), "no column 'lifekm'. Name 'life_km'"),
        (lambda case, folder: fatigue.read_table(folder + "x", "nodes"), "no such result table"),
        (lambda case, folder: row_count(folder, "points"), "no table 'points'"),
        (lambda case, folder: fatigue.result_summary(folder, only="W9"), "there is no weld 'W9'"),
        (lambda case, folder: fatigue.result_summary(folder, top=0), "top: 0 is no number of points"),
        (lambda case, folder: fatigue.result_summary(folder, top=2.5), "top: 2.5 is no number"),
        (lambda case, folder: fatigue.recount(folder, sample=-1), "sample: -1 is no whole number"),
        (lambda case, folder: fatigue.recount(folder, seed=0.5), "seed: 0.5 is no whole number"),
        (lambda case, folder: assess(case, folder, threads=0), "threads: 0 is no number of threads"),
        (lambda case, folder: assess(case, folder, threads=1.5), "threads: 1.5 is no number"),
        (lambda case, folder: assess(case, folder, share=2), "share: 2 is no share"),
        (lambda case, folder: assess(case, folder, share=float("nan")), "share: nan is no share"),
        (lambda case, folder: assess(case, folder, share="a", threads=-1), "threads: -1 .*\n.*share: 'a' is no share"),
        (lambda case, folder: assess(case, folder, executor=4), "executor: int is no executor"),
        (lambda case, folder: diagnose(folder, share_of_limit=float("nan")), "share_of_limit: nan"),
        (lambda case, folder: diagnose(folder, edges_hz="ab"), "edges_hz: ab does not ascend"),
        (lambda case, folder: diagnose(folder, edges_hz=3), "edges_hz: 3 does not ascend"),
        (lambda case, folder: diagnose(folder, edges_hz=[]), r"edges_hz: \[\] does not ascend"),
        (lambda case, folder: diagnose(folder, edges_hz=[1.0, float("inf")]), "does not ascend"),
        (lambda case, folder: diagnose(folder, bin_km="long"), "bin_km: 'long' km is not a length"),
    ],
)  # fmt: skip
def test_senseless_arguments_are_refused(result, call, words):
    """One line for each, that names the argument and its value."""
    with pytest.raises((CaseError, DataError), match=words):
        call(*result)


@pytest.mark.parametrize("given", [None, 3, b"case.toml", ["case.toml"], object(), "a\0b", "\ud800"])
@pytest.mark.parametrize(
    "call",
    [
        fatigue.load_case,
        fatigue.check_case,
        fatigue.read_model,
        fatigue.read_provenance,
        fatigue.result_summary,
        fatigue.recount,
        diagnose,
        spectra,
        write_example,
        write_report,
        write_vtp,
        write_csv,
        lambda given: fatigue.read_table(given, "nodes"),
        lambda given: spectra("result", points=given or 3),
        lambda given: assess(given, "result"),
        lambda given: ConvertOptions(given, "a.bdf", "out"),
        lambda given: ConvertOptions("a.op2", "a.bdf", "out", unit_loads=(given,)),
    ],
)
def test_what_is_no_path_is_refused(call, given):
    """One line that names the argument and what stands there."""
    with pytest.raises(CaseError, match=r"\A\w+: .* (is no path|no path can have)\. Give a path[^\n]*\Z"):
        call(given)


def test_what_is_no_name_is_refused(result):
    """Names of columns and of welds are texts."""
    _, folder = result
    for given in (3, [3], b"life_km", Path("life_km")):
        with pytest.raises(CaseError, match=r"\Acolumns: .* is no list of names"):
            fatigue.read_table(folder, "nodes", given)
        with pytest.raises(CaseError, match=r"\Aonly: .* is no list of names"):
            fatigue.result_summary(folder, only=given)
    with pytest.raises(DataError, match="no table"):
        fatigue.read_table(folder, ["nodes"])


def test_the_catalogue_cannot_be_changed():
    """It is read once: who changed it would change every assessment after."""
    with pytest.raises(TypeError):
        fatigue.catalogue()["mine"] = None
