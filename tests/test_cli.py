"""The command line as a user meets it: help, exit codes, JSON, and one clear line for every failure."""

import json
import os
import pty
import signal
import subprocess
import sys
import time
import tomllib

import click
import jsonschema
import pandas as pd
import pyarrow.parquet as pq
import pytest

from fatigue.cli import cli
from fatigue.cli.main import SECTIONS
from tests.command_line import ROOT, assess, fatigue, fatigue_alone
from tests.small_case import sine_only, small_case


def _commands(group, before=""):
    """Every command by the words that call it, groups and what they hold."""
    for name, command in sorted(group.commands.items()):
        yield before + name, command
        if isinstance(command, click.Group):
            yield from _commands(command, f"{before}{name} ")


COMMANDS = dict(_commands(cli))


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_has_help_with_an_example(name):
    """A command without a word of help and an example that begins with the program's name is not finished."""
    command = COMMANDS[name]
    text = command.get_help(click.Context(command, info_name=f"fatigue {name}"))
    assert f"fatigue {name}" in (command.help or "")
    assert "Example" in text
    for parameter in command.params:
        if isinstance(parameter, click.Option):
            assert parameter.help, parameter.name


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_is_in_the_docs(name):
    """What the program can do, the docs name at a glance."""
    assert f"fatigue {name}" in (ROOT / "docs" / "how-to" / "commands.md").read_text()


def test_every_command_is_in_one_section_and_its_short_help_is_whole():
    """The list of commands has each once, in 80 columns, and no help is cut."""
    assert sorted(name for names in SECTIONS.values() for name in names) == sorted(cli.commands)
    told = cli.get_help(click.Context(cli, info_name="fatigue", terminal_width=80))
    for name, command in cli.commands.items():
        assert f"  {name:{max(map(len, cli.commands))}}  {command.short_help}\n" in told


def test_version_and_help():
    """Both on stdout, exit 0; the exit codes are told."""
    assert fatigue_alone("--version").stdout.startswith("fatigue, version ")
    assert "130 interrupted" in fatigue_alone("--help").stdout


@pytest.mark.parametrize(
    "arguments", [("assess",), ("nonsense",), ("show", "x", "--top", "0"), ("assess", "a", "b", "c")]
)
def test_wrong_usage_is_2(arguments):
    """Click's own exit code."""
    done = fatigue(*arguments)
    assert done.returncode == 2
    assert "Traceback" not in done.stderr


def test_missing_case_file_is_3(tmp_path):
    """A case that is not there is bad data, not wrong usage."""
    done = fatigue_alone("check", tmp_path / "none.toml")
    assert done.returncode == 3
    assert f"error: {tmp_path / 'none.toml'}: there is no such file." in done.stderr
    assert "Traceback" not in done.stderr


def test_missed_target_is_1_unless_told_otherwise(tmp_path):
    """The small case fails its target: 1, the verdict on stdout; --exit-zero: 0."""
    path = small_case().write(tmp_path / "case")
    done = fatigue_alone("assess", path, "-o", tmp_path / "result", "--no-report")
    assert done.returncode == 1
    assert "2 of 2 welds miss their target of 1e+06 km" in done.stdout
    assert "master-aluminium (mean-2sigma); thickness actual; no knee; mean stress none" in done.stdout
    assert assess(path, "-o", tmp_path / "result", "--exit-zero").returncode == 0


def test_fulfilled_is_0(tmp_path):
    """A target that is met."""
    case = sine_only()
    case.mission["target_km"] = 1.0
    done = fatigue("-q", "assess", case.write(tmp_path / "case"), "-o", tmp_path / "result", "--no-report")
    assert done.returncode == 0
    assert "every weld meets its target of 1 km" in done.stdout
    assert done.stderr == ""


def test_bad_data_is_3_with_one_line_each(tmp_path):
    """Several mistakes of a case file: one line each on stderr, nothing on stdout, nothing written."""
    case = small_case()
    case.events[0]["share"] = 0.5
    case.curve["name"] = "master-alu"
    path = case.write(tmp_path / "case")
    done = assess(path, "-o", tmp_path / "result")
    assert done.returncode == 3
    assert done.stdout == ""
    assert all(line.startswith("error: case.toml") for line in done.stderr.splitlines())
    assert "0.75" in done.stderr
    assert not (tmp_path / "result").exists()


@pytest.mark.parametrize("command", ["check", "assess"])
def test_a_thickness_in_metres_is_3_with_one_line(tmp_path, command):
    """One weld of two given in m: one line that tells where, what and the remedy, and no result folder."""
    case = small_case()
    case.weld_nodes.loc[case.weld_nodes.weld == "B", "thickness_mm"] /= 1000.0
    path = case.write(tmp_path / "case")
    done = fatigue(command, path, *(("-o", tmp_path / "result") if command == "assess" else ()))
    assert done.returncode == 3
    assert done.stdout == ""
    assert done.stderr == (
        "error: weld_nodes.csv: weld B, node 200 (order 1) and 6 more: thickness_mm is 0.008 on edges of 10 mm, no "
        "plate is welded so thin. Give thickness_mm in mm; this looks like m.\n"
    )
    assert [entry.name for entry in tmp_path.iterdir()] == ["case"]


def test_json_is_json_with_null_for_infinite_life(tmp_path):
    """Machines get JSON on stdout; infinite life is null; keys carry units."""
    case = sine_only()
    case.histories["sine"]["q_1"] = 0.0
    path = case.write(tmp_path / "case")
    done = assess(path, "-o", tmp_path / "result", "--json")
    assert done.returncode == 0
    record = json.loads(done.stdout)
    assert record["fulfilled"] is True
    assert record["welds"][0]["life_km"] is None
    assert record["points"][0]["life_km"] is None
    assert json.loads(fatigue("show", tmp_path / "result", "--json", "--top", 3).stdout)["points"][2]["node"] == 101
    text = fatigue("show", tmp_path / "result").stdout
    assert "> 1e12" in text
    assert " inf" not in text
    assert " nan" not in text


def test_check_prints_sizes_and_writes_nothing(tmp_path):
    """The dry run: sizes, estimated time, warnings; no file appears."""
    path = small_case().write(tmp_path / "case")
    before = sorted(p.name for p in tmp_path.rglob("*"))
    done = fatigue("check", path)
    assert done.returncode == 0
    assert "2 in 2 straight parts, 14 stations" in done.stdout
    assert "estimated time" in done.stdout
    assert sorted(p.name for p in tmp_path.rglob("*")) == before
    record = json.loads(fatigue("check", path, "--json").stdout)
    assert record["samples"] == 14 * (2400 + 2200 + 2)


def test_warnings_of_many_welds_are_one_line_with_their_number(tmp_path):
    """Those that are summed up count one by one."""
    done = fatigue("check", small_case(pairs=16).write(tmp_path / "case"))
    assert "(and 31 more of this kind" in done.stderr
    assert "  warnings         34\n" in done.stdout


def test_strict_takes_unknown_columns_for_errors(tmp_path):
    """Unknown columns warn; with --strict they are refused with their name."""
    case = small_case()
    case.welds["colour"] = "red"
    path = case.write(tmp_path / "case")
    assert fatigue("check", path).returncode == 0
    done = fatigue("check", path, "--strict")
    assert done.returncode == 3
    assert "column colour" in done.stderr


def test_show_without_result_is_3(tmp_path):
    """No result, no traceback, but what to do."""
    done = fatigue("show", tmp_path)
    assert done.returncode == 3
    assert "Run `fatigue assess CASE -o DIR` first" in done.stderr


def test_show_of_a_damaged_table_is_3(tmp_path):
    """A truncated Parquet file in the result folder is named, and how it differs from what was written."""
    path = small_case().write(tmp_path / "case")
    assess(path, "-o", tmp_path / "result")
    table = tmp_path / "result" / "nodes.parquet"
    table.write_bytes(table.read_bytes()[:1000])
    done = fatigue("show", tmp_path / "result")
    assert done.returncode == 3
    assert "nodes.parquet: was changed since it was written: it has 1000 bytes" in done.stderr


def test_show_only_one_weld(tmp_path):
    """--weld filters; an unknown weld is refused with those there are."""
    path = small_case().write(tmp_path / "case")
    assess(path, "-o", tmp_path / "result")
    points = json.loads(fatigue("show", tmp_path / "result", "--weld", "B", "--json").stdout)["points"]
    assert {p["weld"] for p in points} == {"B"}
    done = fatigue("show", tmp_path / "result", "--weld", "C")
    assert done.returncode == 3
    assert "there is no weld 'C'. Choose of A, B" in done.stderr


@pytest.mark.skipif(os.name == "nt", reason="Windows has other signals")
def test_ctrl_c_is_130_and_the_next_run_goes_on(tmp_path):
    """SIGINT in the middle: one line, 130, finished blocks kept."""
    path = small_case(seconds=100.0, pairs=16).write(tmp_path / "case")
    result = tmp_path / "result"
    command = [sys.executable, "-m", "fatigue", "assess", str(path), "-o", str(result), "--threads", "1", "--no-report"]
    process = subprocess.Popen(
        command,
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # A shell's job in the background ignores SIGINT, and hands that down.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # noqa: PLW1509 (no threads here)
    )
    while process.poll() is None and not list(result.rglob("*.npz")):
        time.sleep(0.005)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert out == ""
    assert err.splitlines()[-1] == "interrupted: the same command goes on from here"
    assert "Traceback" not in err
    assert fatigue("-q", "assess", path, "-o", result, "--no-report").returncode == 1
    assert " 0 of " not in (result / "fatigue.log").read_text().splitlines()[-2]


@pytest.mark.skipif(os.name == "nt", reason="pseudo terminals are a Unix thing")
def test_progress_bar_only_on_a_terminal(tmp_path):
    """On a terminal a bar with percentage on stderr; in a pipe or with -q none."""
    path = small_case().write(tmp_path / "case")
    assert "%" not in assess(path, "-o", tmp_path / "piped").stderr.replace("% low", "")
    ours, theirs = pty.openpty()
    command = [
        sys.executable,
        "-m",
        "fatigue",
        "assess",
        str(path),
        "-o",
        str(tmp_path / "shown"),
        "--exit-zero",
        "--no-report",
    ]
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=theirs) as process:
        os.close(theirs)
        shown = b""
        try:
            while piece := os.read(ours, 4096):
                shown += piece
        except OSError:  # how Linux ends a pseudo terminal
            pass
    os.close(ours)
    assert process.returncode == 0
    assert b"assessing" in shown
    assert b"100%" in shown


def test_example_and_schema(tmp_path):
    """The shipped case is written, refuses to overwrite, and is valid by the schema the program prints."""
    done = fatigue("example", tmp_path / "demo")
    assert done.returncode == 0
    schema = json.loads(fatigue("schema").stdout)
    for name in ("case.toml", "case_9hz.toml"):
        jsonschema.validate(tomllib.loads((tmp_path / "demo" / name).read_text()), schema)
    again = fatigue("example", tmp_path / "demo")
    assert again.returncode == 3
    assert "is there already. Give another folder, or --force" in again.stderr
    assert fatigue("example", tmp_path / "demo", "--force").returncode == 0


def test_schema_describes_every_key_with_its_unit():
    """Editors show a description for every key; keys that are quantities name their unit."""
    schema = json.loads(fatigue("schema").stdout)
    for table in schema["$defs"].values():
        for key, value in table.get("properties", {}).items():
            assert value.get("description"), key
            for suffix, unit in (("_s", "[s]"), ("_hz", "[Hz]"), ("_km", "[km]"), ("_MPa", "[MPa"), ("_mm", "[mm]")):
                if key.endswith(suffix) and not key.endswith("per_1000_km"):
                    assert unit in value["description"], key


def test_tables_carry_units_and_survive_pandas(small_result):
    """Field metadata hold unit and meaning of every column; pandas reads the tables as they are."""
    for name in ("nodes", "damage", "cycles", "histogram", "structural_stress", "welds"):
        schema = pq.read_schema(small_result / f"{name}.parquet")
        assert all(f.metadata[b"unit"] and f.metadata[b"description"] for f in schema)
        assert len(pd.read_parquet(small_result / f"{name}.parquet"))
