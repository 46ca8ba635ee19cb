"""The options of a conversion are written once; help, objects and recorded commands are made of them."""

from dataclasses import fields, replace
from pathlib import Path
from typing import get_args, get_type_hints

import click

from fatigue.cli import cli
from fatigue.cli.options import asking_for
from fatigue.readers.convert.loads.names import LoadName
from fatigue.readers.convert.option_fields import option_fields, words_of
from fatigue.readers.convert.options import ConvertOptions, Displacement, WeldSources
from fatigue.readers.foreign.histories.matching import Match
from fatigue.readers.neutral.forces.convention import Convention

FILES = ConvertOptions("a.op2", "a.bdf", "out")
MANY = ConvertOptions(
    "a.op2",
    "a.bdf",
    "out",
    unit_loads=("s.op2", "t.op2"),
    coordinates="q.csv",
    stress_points="points.csv",
    stresses=("s.op2", "u.op2"),
    read_outs="coarse",
    convention="on_node",
    subcase=0,
    force_units="m-kg-s",
    coordinate_units="in-lbf-s",
    normalisation="length",
    match="order",
    columns="map.csv",
    time_column="2",
    resample_s=0.01,
    simulation_modes="modes.csv",
    interface_modes=(31, 32),
    static_subcases="leave_out",
    unit_load_names=(LoadName(1001, "tunnel_pressure", -5.0, "kPa"), LoadName(1002, "gravity", 1.0, "g")),
    ignore_modes=(1, 2, 9),
    displacements=(Displacement("u.csv", 7, "z"), Displacement("v.csv", 8, "x")),
    accept=("sign", "grid totals"),
    curve="master-steel",
    title="a car",
    speed_km_h=120.0,
    target_km=2e6,
    force=True,
    keep_case=True,
    welds=WeldSources("r.csv", "lines.csv", (3, 4), ("PLOTEL",), False, True),
)


def parsed(*words):
    """Options that the command line makes of some words."""
    found = []

    @click.command()
    @asking_for(ConvertOptions, "options")
    def command(options):
        found.append(options)

    command.main(list(words), standalone_mode=False)
    return found[0]


def test_every_field_is_an_option():
    """No field without an option, no two options of one name, all of them in the order of the help."""
    own = [field for asked in (ConvertOptions, WeldSources) for field in option_fields(asked)]
    assert [f.name for f in own] == [
        f.name for f in (*fields(ConvertOptions), *fields(WeldSources)) if f.name != "welds"
    ]
    names = [name for field in own for name in (*field.option.name.split("/"), field.option.short) if name]
    assert len(set(names)) == len(names)
    shown = [opt for param in cli.commands["convert"].params for opt in (*param.opts, *param.secondary_opts)]
    assert sorted(shown) == sorted([*names, "--json"])
    assert [param.name for param in cli.commands["convert"].params] == [*(f.name for f in own), "as_json"]


def test_the_default_of_an_option_is_that_of_its_field():
    """What is not given is what Python has where it is not given."""
    assert parsed("--forces", "a.op2", "--mesh", "a.bdf", "-o", "out") == FILES


def test_a_recorded_command_asks_for_the_same():
    """All options but target, register and what overwrites, given back to the command line."""
    words = words_of(MANY)
    found = parsed(*words, "-o", "out", "--register", "r.csv", "--force", "--keep-case")
    here = Path.cwd()
    assert words_of(found) == words
    assert found.displacements[1] == Displacement(here / "v.csv", 8, "x")
    assert (found.ignore_modes, found.welds.detect, found.welds.sets) == ((1, 2, 9), False, (3, 4))
    for name in ("resample_s", "speed_km_h", "subcase", "title", "accept", "force", "keep_case", "match", "out"):
        assert getattr(found, name) == getattr(MANY, name)
    changed = [f.name for f in fields(MANY) if getattr(MANY, f.name) == getattr(FILES, f.name)]
    assert changed == ["forces", "mesh", "out"]


def test_a_default_is_not_recorded():
    """Files only, and what was changed."""
    words = words_of(replace(FILES, welds=WeldSources(detect=True)))
    assert words == ["--forces", str(Path("a.op2").resolve()), "--mesh", str(Path("a.bdf").resolve()), "--detect"]


def test_choices_are_those_of_the_readers():
    """The words that an option may have are those that the functions behind it know."""
    hints = get_type_hints(ConvertOptions)
    assert get_args(hints["match"]) == get_args(Match)
    assert get_args(get_args(hints["convention"])[0]) == get_args(Convention)
