"""What the command line says of results beside each other, and what it refuses; the two shipped variants."""

import json
import shutil

import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.diagnose import diagnose
from tests.command_line import ROOT, fatigue
from tests.decide.compare.variants import POINT, renamed, result_of, sloping

EXAMPLE = ROOT / "data" / "carbody"


@pytest.fixture(scope="module")
def two(tmp_path_factory):
    """Two results: as it is, and half as loud; read them, never write to them."""
    quiet = sloping()
    for name, table in quiet.histories.items():
        quiet.histories[name] = table.assign(**{q: 0.5 * table[q] for q in ("q_1", "q_2", "q_7")})
    folder = tmp_path_factory.mktemp("two")
    return result_of(sloping(), folder / "a"), result_of(quiet, folder / "b")


def test_text_and_json_and_files(two, tmp_path):
    """Half the stress, 2^k of the life on a straight curve: in words, for machines, in tables."""
    done = fatigue("compare", *two, "-o", tmp_path / "out", "--csv")
    assert done.returncode == 0, done.stderr
    assert "Of 2 welds 2 last longer in B than in A, none less long and none as long to 5 %." in done.stdout
    assert "record, sine: sine.csv -> sine.csv, another content (in per_pass)" in done.stdout
    assert "compare.html" in done.stdout
    factor = 2.0**3.6085450346420327
    asked = json.loads(fatigue("compare", *two, "--json").stdout)
    (compared,) = asked["compared"]
    assert [weld["life_ratio"] for weld in compared["welds"]] == pytest.approx([factor] * 2, rel=1e-9)
    assert asked["results"][0]["result"] == "A"
    assert pd.read_parquet(tmp_path / "out" / "compare.parquet")["life_ratio"].to_numpy() == pytest.approx(
        factor, rel=1e-9
    )
    again = fatigue("compare", *two, "-o", tmp_path / "out")
    assert again.returncode == 0, again.stderr
    assert not (tmp_path / "out" / "compare.csv").exists()


def test_several_results(two, tmp_path):
    """B and C each against A, one page."""
    third = shutil.copytree(two[1], tmp_path / "c")
    done = fatigue("compare", *two, third, "-o", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    assert "C against A" in done.stdout
    table = pd.read_parquet(tmp_path / "out" / "compare.parquet")
    assert set(table["result"]) == {"B", "C"}
    assert (
        table[table["result"] == "B"]
        .drop(columns="result")
        .reset_index(drop=True)
        .equals(table[table["result"] == "C"].drop(columns="result").reset_index(drop=True))
    )
    page = (tmp_path / "out" / "compare.html").read_text(encoding="utf-8")
    assert "Ratios of lives" in page
    assert 'href="#result-c"' in page


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (("{a}",), 2, "at least two result folders"),
        ((), 2, "Missing argument"),
        (("{a}", "{a}"), 3, "is given twice, as A and as B"),
        (("{a}", "{empty}"), 3, "no finished result in this folder"),
        (("{empty}", "{a}"), 3, "no finished result in this folder"),
        (("{a}", "{b}", "--csv"), 2, "name their folder with -o"),
        (("{a}", "{b}", "--map", "{empty}/no.csv"), 3, "no.csv"),
        (("{a}", "{b}", "-o", "{b}"), 3, "is one of the results"),
        (("{a}", "{other}"), 3, "no weld has its name in A"),
    ],
)
def test_mistakes_are_one_line(two, tmp_path, tmp_path_factory, arguments, code, words):
    """Wrong usage is 2, results that cannot be compared are 3."""
    (tmp_path / "empty").mkdir()
    places = {"a": two[0], "b": two[1], "empty": tmp_path / "empty", "other": ""}
    if "{other}" in arguments:
        places["other"] = result_of(renamed(sloping(2.0), {"A": "left", "B": "right"}), tmp_path)
    done = fatigue("compare", *(argument.format(**places) for argument in arguments))
    assert done.returncode == code, done.stderr
    assert words in " ".join(done.stderr.split())
    assert "Traceback" not in done.stderr


def test_files_of_somebody_else_stay(two, tmp_path):
    """A page of another hand is refused without --force."""
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "compare.html").write_text("mine", encoding="utf-8")
    done = fatigue("compare", *two, "-o", tmp_path / "out")
    assert done.returncode == 3
    assert "was not written by fatigue compare" in done.stderr
    assert fatigue("compare", *two, "-o", tmp_path / "out", "--force").returncode == 0


def test_a_damaged_table_is_refused(two, tmp_path):
    """An edited table is told, and nothing is compared."""
    damaged = shutil.copytree(two[1], tmp_path / "damaged")
    with (damaged / "nodes.parquet").open("ab") as file:
        file.write(b"x")
    done = fatigue("compare", two[0], damaged)
    assert done.returncode == 3
    assert "nodes.parquet" in done.stderr


@pytest.fixture(scope="module")
def shipped(example_result, tmp_path_factory):
    """The two shipped variants with their diagnoses: converter at 14 Hz and at 9.2 Hz."""
    folder = tmp_path_factory.mktemp("shipped")
    shutil.copytree(example_result, folder / "14hz")  # as deep as it was, so that it finds its case
    assess(EXAMPLE / "case_9hz.toml", folder / "9hz", threads=2, report=False)
    for name in ("14hz", "9hz"):
        diagnose(folder / name)
    return folder


def test_the_shipped_variants(shipped):
    """14 Hz against 9.2 Hz: hangers last longer, through worn wheels; the rest stays; four verdicts flip."""
    done = fatigue("compare", shipped / "14hz", shipped / "9hz", "-o", shipped / "compared")
    assert done.returncode == 0, done.stderr
    assert "Of 14 welds 10 last longer in B than in A, none less long and 4 as long" in done.stdout
    page = (ROOT / "docs" / "compare.md").read_text(encoding="utf-8")
    shown = page.split("among other things,\n\n```\n")[1].split("```")[0].splitlines()
    printed = done.stdout.replace("\u202f", " ").splitlines()
    assert shown
    assert not [line for line in shown if line not in printed]
    welds = pd.read_parquet(shipped / "compared" / "compare_welds.parquet").set_index("weld")
    gained = welds.index[welds["flip"] == "gained"]
    assert sorted(gained) == [f"W2_hanger{i}_att" for i in (1, 2, 3, 4)]
    assert (welds.loc[gained, "life_ratio"] > 9.0).all()
    assert set(welds.loc[welds["life_ratio"] > 1.05, "cause_event"]) == {"worn 350"}
    ours, theirs = (pd.read_parquet(shipped / name / "welds.parquet").set_index("weld") for name in ("14hz", "9hz"))
    known = theirs["life_km"] / ours["life_km"]
    assert welds["life_ratio"].to_numpy() == pytest.approx(known.reindex(welds.index).to_numpy(), rel=1e-12)
    points = pd.read_parquet(shipped / "compared" / "compare.parquet").set_index(POINT)
    causes = pd.read_parquet(shipped / "compared" / "compare_causes.parquet")
    causes = causes[causes["scope"] == "point"]
    assert len(points) == 390
    assert set(points["face"]) == {"same"}
    ratio = points["log_life_ratio"]
    for kinds in (("event",), ("mission", "per_pass"), ("mode",)):
        made = causes[causes["kind"].isin(kinds)].groupby(POINT)["log_life_ratio"].sum()
        assert len(made) == 390
        assert made.to_numpy() == pytest.approx(ratio.reindex(made.index).to_numpy(), abs=1e-12)
