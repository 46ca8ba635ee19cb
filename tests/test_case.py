"""A case file: what it may say, and what is said about its mistakes."""

import json
import math
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.case import Case, case_schema, check_distance, check_files, event_length_km, load_case
from fatigue.errors import CaseError, DataError
from fatigue.pipeline.solve.rated_curves import curves_of_case

jsonschema = pytest.importorskip("jsonschema")

MINIMAL = """
[body]
modes = "modes.csv"
welds = "welds.csv"
weld_nodes = "weld_nodes.csv"
nodal_forces = "nodal_forces.parquet"
force_convention = "on_element"

[curve]
name = "master-aluminium"

[mission]
target_km = 1.2e7
km_per_year = 5e5

[[mission.event]]
name = "tangent"
history = "q_tangent.parquet"
speed_km_h = 350.0
share = 0.75

[[mission.event]]
name = "curve"
history = "q_curve.parquet"
length_km = 3
share = 0.25

[[mission.event]]
name = "load"
history = "q_load.parquet"
per_1000_km = 1.5
"""

OWN_CURVE = """
[curves.mine]
slopes = [3.0, 5.0]
knees_cycles = [1e7]
range_at_2e6_MPa = 40.0
applies = "structural"
source = "a book, edition, clause"
"""


@pytest.fixture
def load(tmp_path: Path):
    """Write a case and load it."""

    def write_and_load(text: str | bytes) -> Case:
        path = tmp_path / "case.toml"
        path.write_bytes(text.encode() if isinstance(text, str) else text)
        return load_case(path)

    return write_and_load


def test_defaults_are_those_of_the_contract(load):
    """What a case leaves out takes the documented value."""
    case = load(MINIMAL)
    assert case.title == "Untitled"
    assert case.body.ignore_modes == ()
    curve = case.curve
    assert (curve.survival, curve.thickness_rule, curve.extension) == (None, "actual", "none")
    assert (curve.knee_cycles, curve.mean_stress, curve.yield_MPa) == (1e7, "none", None)
    assert (case.counting.residue, case.counting.upsample) == ("repeat", 1)
    assert (case.spectrum.segment_s, case.spectrum.upper_hz) == (4.0, None)
    assert case.mission.damage_limit == 1.0
    assert [event.start_s for event in case.mission.event] == [0.0, 0.0, 0.0]
    assert [event.stress_factor for event in case.mission.event] == [1.0, 1.0, 1.0]


def test_residue_of_an_event(load):
    """An event's own rule comes first, then half for one counted by number, then the case's."""
    case = load(MINIMAL + 'residue = "repeat"\n')
    assert [case.residue(event) for event in case.mission.event] == ["repeat", "repeat", "repeat"]
    case = load(MINIMAL)
    assert [case.residue(event) for event in case.mission.event] == ["repeat", "repeat", "half"]
    case = load(MINIMAL + '[counting]\nresidue = "half"\n')
    assert [case.residue(event) for event in case.mission.event] == ["half", "half", "half"]


@pytest.mark.parametrize("factor", [1, 2, 64, "auto"])
def test_upsampling_factors(load, factor):
    """Powers of 2 and auto."""
    assert load(MINIMAL + f"[counting]\nupsample = {json.dumps(factor)}\n").counting.upsample == factor


def test_text_and_paths_are_kept(load, tmp_path):
    """The case remembers its text, its file and where its inputs are."""
    text = "# a comment\n" + MINIMAL
    case = load(text)
    assert case.text == text
    assert case.path == tmp_path / "case.toml"
    files = case.input_files()
    assert list(files) == [
        "body.modes",
        "body.welds",
        "body.weld_nodes",
        "body.nodal_forces",
        "mission.event[1].history",
        "mission.event[2].history",
        "mission.event[3].history",
    ]
    assert files["mission.event[2].history"] == tmp_path / "q_curve.parquet"


def test_byte_order_mark_and_windows_line_ends(load):
    """A file saved by a Windows editor reads the same."""
    assert load(b"\xef\xbb\xbf" + MINIMAL.replace("\n", "\r\n").encode()).curve.name == "master-aluminium"


def test_a_case_is_frozen(load):
    """No part of a loaded case can be changed."""
    with pytest.raises(ValueError, match="frozen"):
        load(MINIMAL).mission.target_km = 1.0


def test_element_forces_with_the_mesh(load):
    """The raw form: element forces, the elements of each weld, nodes and elements."""
    raw = 'element_forces = "ef.parquet"\nweld_elements = "we.csv"\nnodes = "n.csv"\nelements = "e.csv"'
    case = load(MINIMAL.replace('nodal_forces = "nodal_forces.parquet"', raw))
    assert case.body.nodal_forces is None
    assert case.input_files()["body.weld_elements"].name == "we.csv"


def test_own_curve(load):
    """A curve of the case can be chosen; the catalogue's names stay available."""
    case = load(MINIMAL.replace("master-aluminium", "mine") + OWN_CURVE)
    assert case.curves["mine"].slopes == (3.0, 5.0)
    assert {"mine", "master-steel"} <= curves_of_case(case).keys()


@pytest.mark.parametrize("knees", ["[1e7, 1e8]", "[1e7]"])
def test_own_curve_with_and_without_cut_off(load, knees):
    """As many knees as slopes mean a cut-off at the last one."""
    load(MINIMAL + OWN_CURVE.replace("[1e7]", knees))


WRONG_VALUES = [
    # table, replaced line (empty: added), new line, message after "case.toml: "
    ("body", 'modes = "modes.csv"', "modes = 3", "body.modes: 3 should be a valid string. Give the file of the modes"),
    ("body", 'modes = "modes.csv"', 'modes = ""', 'body.modes: "" is empty. Give the file of the modes'),
    (
        "body",
        'modes = "modes.csv"',
        "",
        "body.modes: the key is missing. Give the file of the modes (.parquet or .csv).",
    ),
    ("body", 'welds = "welds.csv"', "", "body.welds: the key is missing. Give the file of the welds"),
    ("body", 'weld_nodes = "weld_nodes.csv"', "", "body.weld_nodes: the key is missing. Give the file of the nodes"),
    (
        "body",
        'nodal_forces = "nodal_forces.parquet"',
        "",
        "body.nodal_forces: neither nodal_forces nor element_forces is given. Give nodal_forces, or element_forces",
    ),
    (
        "body",
        "",
        'element_forces = "e.csv"\nweld_elements = "w.csv"',
        "body.nodal_forces: nodal_forces and element_forces are both given. Keep one of them.",
    ),
    (
        "body",
        'nodal_forces = "nodal_forces.parquet"',
        'element_forces = "e.csv"',
        "body.weld_elements: the key is missing although element_forces = 'e.csv' is given. Give the file of the",
    ),
    (
        "body",
        "",
        'weld_elements = "w.csv"',
        "body.weld_elements: weld_elements = 'w.csv' is given without element_forces. Give element_forces or remove",
    ),
    (
        "body",
        "",
        'elements = "e.csv"',
        "body.nodes: the key is missing although elements = 'e.csv' is given. Give the file of the nodes",
    ),
    (
        "body",
        'force_convention = "on_element"',
        "",
        "body.force_convention: the key is missing. Give the sense of the nodal forces: 'on_element' (K_e u_e) or",
    ),
    (
        "body",
        'force_convention = "on_element"',
        'force_convention = "on_elem"',
        "body.force_convention: \"on_elem\" should be 'on_element' or 'on_node'. Give the sense of",
    ),
    ("body", "", "ignore_modes = 7", "body.ignore_modes: 7 should be a valid list. Give a list of mode ids left out"),
    ("body", "", 'ignore_modes = [7, "8"]', 'body.ignore_modes[2]: "8" should be a valid integer. Give a list of mode'),
    (
        "body",
        "",
        "ignore_modes = [7.0]",
        "body.ignore_modes[1]: 7.0 should be a valid integer. Give a list of mode ids",
    ),
    ("body", "", "mode = 3", "body.mode: unknown key with the value 3. Write 'modes'."),
    (
        "body",
        "",
        "zz = 3",
        "body.zz: unknown key with the value 3. Remove it; the keys are modes, welds, weld_nodes, nodal_",
    ),
    (
        "curve",
        'name = "master-aluminium"',
        "",
        "curve.name: the key is missing. Give the key of a curve of the catalogue",
    ),
    (
        "curve",
        'name = "master-aluminium"',
        'name = "master-aluminum"',
        "curve.name: there is no curve 'master-aluminum'. Write 'master-aluminium'.",
    ),
    (
        "curve",
        'name = "master-aluminium"',
        'name = "qqq"',
        "curve.name: there is no curve 'qqq'. Add it under [curves], or use one of ",
    ),
    (
        "curve",
        "",
        'survival = "95"',
        "curve.survival: \"95\" should be 'mean', 'mean-1sigma', 'mean-2sigma' or 'mean-3sigma'",
    ),
    (
        "curve",
        "",
        'thickness_rule = "real"',
        "curve.thickness_rule: \"real\" should be 'actual' or 'asme'. Give the thickness",
    ),
    (
        "curve",
        "",
        'extension = "fkm"',
        "curve.extension: \"fkm\" should be 'none', 'haibach' or 'cutoff'. Give the curve",
    ),
    ("curve", "", "knee_cycles = 0", "curve.knee_cycles: 0 should be greater than 0. Give the number of cycles [-] at"),
    ("curve", "", 'mean_stress = "fkm"', "curve.mean_stress: \"fkm\" should be 'none' or 'asme'. Give the mean stress"),
    (
        "curve",
        "",
        'mean_stress = "asme"',
        "curve.yield_MPa: the key is missing although mean_stress = 'asme' is given. Give the yield strength [MPa] or",
    ),
    (
        "curve",
        "",
        "yield_MPa = -240.0",
        "curve.yield_MPa: -240.0 should be greater than 0. Give the yield strength [MPa]",
    ),
    (
        "counting",
        "",
        'residue = "closed"',
        "counting.residue: \"closed\" should be 'repeat' or 'half'. Give the treatment",
    ),
    (
        "counting",
        "",
        "upsample = 3",
        "counting.upsample: 3 is neither a power of 2 nor 'auto'. Give the upsampling factor",
    ),
    ("counting", "", "upsample = 0", "counting.upsample: 0 is neither a power of 2 nor 'auto'. Give the upsampling"),
    ("counting", "", "upsample = -2", "counting.upsample: -2 is neither a power of 2 nor 'auto'. Give the upsampling"),
    (
        "counting",
        "",
        "upsample = true",
        "counting.upsample: True is neither a power of 2 nor 'auto'. Give the upsampling",
    ),
    (
        "counting",
        "",
        "upsample = 2.0",
        "counting.upsample: 2.0 is neither a power of 2 nor 'auto'. Give the upsampling",
    ),
    (
        "spectrum",
        "",
        "segment_s = 0",
        "spectrum.segment_s: 0 should be greater than 0. Give the length of one segment [s]",
    ),
    ("spectrum", "", "segment_s = nan", "spectrum.segment_s: nan should be a finite number. Give the length of one"),
    (
        "spectrum",
        "",
        "upper_hz = inf",
        "spectrum.upper_hz: inf should be a finite number. Give the upper frequency [Hz]",
    ),
    ("spectrum", "", "upper_hz = -1", "spectrum.upper_hz: -1 should be greater than 0. Give the upper frequency [Hz]"),
    (
        "mission",
        "target_km = 1.2e7",
        "",
        "mission.target_km: the key is missing. Give the target mileage [km], above 0.",
    ),
    ("mission", "target_km = 1.2e7", "target_km = 0", "mission.target_km: 0 should be greater than 0. Give the target"),
    (
        "mission",
        "target_km = 1.2e7",
        'target_km = "1.2e7"',
        'mission.target_km: "1.2e7" should be a valid number. Give the target mileage [km], above 0.',
    ),
    ("mission", "km_per_year = 5e5", "", "mission.km_per_year: the key is missing. Give the mileage per year [km]"),
    (
        "mission",
        "km_per_year = 5e5",
        "km_per_year = -1",
        "mission.km_per_year: -1 should be greater than 0. Give the mi",
    ),
    (
        "mission",
        "",
        "damage_limit = 0.0",
        "mission.damage_limit: 0.0 should be greater than 0. Give the allowed damage",
    ),
    ("mission", "", "damage_limit = true", "mission.damage_limit: true should be a valid number. Give the allowed"),
    ("", "", "title = 5", "title: 5 should be a valid string. Give the title of the report."),
    ("", "", 'titel = "x"', "titel: unknown key with the value \"x\". Write 'title'."),
    ("", "", "counting = 5", "counting: 5 should be a table. Give a [counting] table."),
    ("", "", "curves.a = 5", "curves.a: 5 should be a table. Give one [curves.<name>] table per curve of your own."),
]


@pytest.mark.parametrize(("table", "old", "new", "message"), WRONG_VALUES, ids=lambda value: str(value)[:40])
def test_wrong_value(load, table, old, new, message):
    """Each mistake alone gives exactly one message with place, value and remedy."""
    if old:
        text = MINIMAL.replace(old, new, 1)
    elif not table:
        text = new + "\n" + MINIMAL
    elif f"[{table}]\n" in MINIMAL:
        text = MINIMAL.replace(f"[{table}]\n", f"[{table}]\n{new}\n", 1)
    else:
        text = MINIMAL + f"[{table}]\n{new}\n"
    with pytest.raises(CaseError) as refusal:
        load(text)
    assert len(refusal.value.problems) == 1
    assert str(refusal.value).startswith("case.toml: " + message)


WRONG_EVENTS = [
    ('name = "curve"', "", "mission.event[2].name: the key is missing. Give a name of the event"),
    ('name = "curve"', 'name = ""', 'mission.event[2].name: "" is empty. Give a name of the event'),
    (
        'name = "curve"',
        'name = "tangent"',
        "mission.event[2].name: 'tangent' is already the name of mission.event[1]. Give every event its own name.",
    ),
    (
        'history = "q_curve.parquet"',
        "",
        "mission.event[2].history ('curve'): the key is missing. Give the file of the modal coordinates over time",
    ),
    (
        "share = 0.25",
        "share = 0.15",
        "mission.event.share: the shares 0.75 + 0.15 sum to 0.9, not to 1. Correct them, they are not rescaled.",
    ),
    (
        "share = 0.25",
        "share = 0.250002",
        "mission.event.share: the shares 0.75 + 0.250002 sum to 1.000002, not to 1. Correct them",
    ),
    (
        "share = 0.25",
        "",
        "mission.event[2].share ('curve'): neither share nor per_1000_km is given. Give the share of the mileage, or",
    ),
    (
        "share = 0.25",
        "share = 0.25\nper_1000_km = 2",
        "mission.event[2].share ('curve'): share = 0.25 and per_1000_km = 2 are both given. Keep one of them.",
    ),
    (
        "share = 0.25",
        'share = "0.25"',
        "mission.event[2].share ('curve'): \"0.25\" should be a valid number. Give the share of the mileage [-], 0 to",
    ),
    (
        "share = 0.25",
        "share = 1.5",
        "mission.event[2].share ('curve'): 1.5 should be less than or equal to 1. Give the",
    ),
    ("share = 0.25", "share = nan", "mission.event[2].share ('curve'): nan should be a finite number. Give the share"),
    (
        "length_km = 3",
        "",
        "mission.event[2].speed_km_h ('curve'): neither speed_km_h nor length_km is given with share = 0.25. Give the",
    ),
    (
        "length_km = 3",
        "length_km = 0",
        "mission.event[2].length_km ('curve'): 0 should be greater than 0. Give the leng",
    ),
    (
        "speed_km_h = 350.0",
        "speed_km_h = -1",
        "mission.event[1].speed_km_h ('tangent'): -1 should be greater than 0. G",
    ),
    (
        "speed_km_h = 350.0",
        "length_km = 1\nspeed = 3",
        "mission.event[1].speed ('tangent'): unknown key with the value 3.",
    ),
    (
        "per_1000_km = 1.5",
        "per_1000_km = 1.5\nspeed_km_h = 5",
        "mission.event[3].speed_km_h ('load'): 5 is given for an event counted by number, per_1000_km = 1.5. Remove it",
    ),
    (
        "per_1000_km = 1.5",
        "per_1000_km = 1.5\nlength_km = 5.5",
        "mission.event[3].length_km ('load'): 5.5 is given for an event counted by number, per_1000_km = 1.5. Remove",
    ),
    (
        "per_1000_km = 1.5",
        "per_1000_km = -1",
        "mission.event[3].per_1000_km ('load'): -1 should be greater than or equal",
    ),
    (
        "per_1000_km = 1.5",
        "per_1000_km = 1\nstart_s = -1",
        "mission.event[3].start_s ('load'): -1 should be greater than or",
    ),
    (
        "per_1000_km = 1.5",
        "per_1000_km = 1\nstress_factor = 0",
        "mission.event[3].stress_factor ('load'): 0 should be gr",
    ),
    (
        "per_1000_km = 1.5",
        'per_1000_km = 1\nresidue = "none"',
        "mission.event[3].residue ('load'): \"none\" should be 'repeat' or 'half'. Give the treatment of the residue",
    ),
]


@pytest.mark.parametrize(("old", "new", "message"), WRONG_EVENTS, ids=lambda value: str(value)[:40])
def test_wrong_event(load, old, new, message):
    """The place of a mistake in an event carries its position and its name."""
    with pytest.raises(CaseError) as refusal:
        load(MINIMAL.replace(old, new, 1))
    assert len(refusal.value.problems) == 1
    assert str(refusal.value).startswith("case.toml: " + message)


WRONG_CURVES = [
    ("slopes = [3.0, 5.0]", "", "curves.mine.slopes: the key is missing. Give a list of the slopes [-]"),
    ("slopes = [3.0, 5.0]", "slopes = []", "curves.mine.slopes: [] is empty. Give a list of the slopes [-]"),
    ("slopes = [3.0, 5.0]", "slopes = [3.0, -5]", "curves.mine.slopes[2]: -5 should be greater than 0. Give a list of"),
    ("slopes = [3.0, 5.0]", 'slopes = "3"', 'curves.mine.slopes: "3" should be a valid list. Give a list of the'),
    (
        "slopes = [3.0, 5.0]",
        "slopes = [3.0]\nm = 1",
        "curves.mine.m: unknown key with the value 1. Remove it; the keys",
    ),
    (
        "knees_cycles = [1e7]",
        "knees_cycles = [1e7, 1e6]",
        "curves.mine.knees_cycles: [10000000.0, 1000000.0] does not ascend. Sort the knees by cycles.",
    ),
    ("knees_cycles = [1e7]", "", "curves.mine.knees_cycles: 0 knees do not go with 2 slopes. Give one knee less than"),
    (
        "knees_cycles = [1e7]",
        "knees_cycles = [1e6, 1e7, 1e8]",
        "curves.mine.knees_cycles: 3 knees do not go with 2 slopes. Give one knee less than slopes, or as many for a",
    ),
    ("range_at_2e6_MPa = 40.0", "", "curves.mine.range_at_2e6_MPa: the key is missing. Give the range at 2e6 cycles"),
    (
        "range_at_2e6_MPa = 40.0",
        "range_at_2e6_MPa = 0",
        "curves.mine.range_at_2e6_MPa: 0 should be greater than 0. Give",
    ),
    ('applies = "structural"', "", "curves.mine.applies: the key is missing. Give the range the curve is for: 'struct"),
    (
        'applies = "structural"',
        'applies = "hot spot"',
        "curves.mine.applies: \"hot spot\" should be 'structural' or 'dS'",
    ),
    ('source = "a book, edition, clause"', "", "curves.mine.source: the key is missing. Give the source: document"),
    ('source = "a book, edition, clause"', 'source = ""', 'curves.mine.source: "" is empty. Give the source: document'),
    (
        "knees_cycles = [1e7]",
        "knees_cycles = [1e7]\nlog10_scatter = 0",
        "curves.mine.log10_scatter: 0 should be greater",
    ),
    (
        "knees_cycles = [1e7]",
        "knees_cycles = [1e7]\nthickness_reference_mm = 25",
        "curves.mine.thickness_exponent: thickness_reference_mm and thickness_exponent need each other. Give both or",
    ),
    (
        "knees_cycles = [1e7]",
        "knees_cycles = [1e7]\nthickness_exponent = 0.1",
        "curves.mine.thickness_reference_mm: thickness_reference_mm and thickness_exponent need each other. Give both",
    ),
    (
        "[curves.mine]",
        "[curves.master-steel]",
        "curves.master-steel: 'master-steel' is a curve of the catalogue. Give it",
    ),
]


@pytest.mark.parametrize(("old", "new", "message"), WRONG_CURVES, ids=lambda value: str(value)[:40])
def test_wrong_curve(load, old, new, message):
    """A curve of the user's own is checked like the rest."""
    with pytest.raises(CaseError) as refusal:
        load(MINIMAL + OWN_CURVE.replace(old, new, 1))
    assert str(refusal.value).startswith("case.toml: " + message)


@pytest.mark.parametrize("table", ["body", "curve", "mission"])
def test_missing_table(load, table):
    """Each table that has no default is asked for by name."""
    kept = [part for part in MINIMAL.split("\n\n") if not part.strip().startswith((f"[{table}", f"[[{table}"))]
    with pytest.raises(CaseError) as refusal:
        load("\n\n".join(kept))
    assert str(refusal.value) == f"case.toml: {table}: the key is missing. Give a [{table}] table."


@pytest.mark.parametrize(
    ("events", "message"),
    [
        ("event = []", "mission.event: [] is empty. Give one [[mission.event]] table per operating condition."),
        ("event = 3", "mission.event: 3 should be a valid list. Give one [[mission.event]] table per"),
        ("event = [3]", "mission.event[1]: 3 should be a table. Give one [[mission.event]] table per"),
        (
            'event = {name = "a"}',
            "mission.event: {'name': 'a'} should be a valid list. Give one [[mission.event]] table",
        ),
        ("", "mission.event: the key is missing. Give one [[mission.event]] table per operating condition."),
    ],
)
def test_no_list_of_events(load, events, message):
    """A mission needs at least one event, as an array of tables."""
    with pytest.raises(CaseError) as refusal:
        load(MINIMAL[: MINIMAL.index("[[")] + events)
    assert str(refusal.value).startswith("case.toml: " + message)


def test_all_mistakes_at_once(load):
    """Mistakes in different tables do not hide one another, nor those of the events as a whole."""
    text = (
        MINIMAL.replace('"on_element"', '"on_both"')
        .replace("master-aluminium", "mastr-aluminium")
        .replace("target_km = 1.2e7", "target_km = -1")
        .replace("speed_km_h", "speed")
        .replace('name = "load"', 'name = "curve"')
        .replace("share = 0.25", "share = 0.2")
    )
    with pytest.raises(CaseError) as refusal:
        load(text + "[counting]\nupsample = 3\n")
    found = [(problem.code, problem.where.removeprefix("case.toml: ")) for problem in refusal.value.problems]
    assert sorted(found) == sorted(
        [
            ("bad_value", "body.force_convention"),
            ("unknown_curve", "curve.name"),
            ("bad_value", "counting.upsample"),
            ("bad_value", "mission.target_km"),
            ("unknown_key", "mission.event[1].speed ('tangent')"),
            ("duplicate", "mission.event[3].name"),
            ("shares", "mission.event.share"),
        ]
    )


def test_only_events_counted_by_number(load):
    """Without any share there is no sum to check."""
    start, *events = MINIMAL.split("[[mission.event]]")
    assert load(f"{start}[[mission.event]]{events[2]}").mission.event[0].per_1000_km == 1.5


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[body]\nmodes = = 3\n", "case.toml: line 2, column 9: not valid TOML: Invalid value. Correct the line."),
        (
            "[body]\nmodes = 'a'\nmodes = 'b'\n",
            "case.toml: line 3, column 12: not valid TOML: Cannot overwrite a value.",
        ),
        ("[body]\n\nmodes = 'a", "case.toml: line 3: not valid TOML: "),
        (
            b"# Tr\xe4ger\n" + MINIMAL.encode(),
            "case.toml: line 1: the byte 0xe4 is not UTF-8 text. Save the file as UTF-8.",
        ),
    ],
)
def test_not_toml(load, text, message):
    """A syntax error names its line and column."""
    with pytest.raises(CaseError) as refusal:
        load(text)
    assert str(refusal.value).startswith(message)


def test_empty_file(load):
    """An empty file lacks every table that has no default."""
    with pytest.raises(CaseError) as refusal:
        load("")
    assert [problem.where for problem in refusal.value.problems] == [
        "case.toml: body",
        "case.toml: curve",
        "case.toml: mission",
    ]


def test_missing_case_file(tmp_path):
    """A path without file is refused, not raised as an error of the system."""
    with pytest.raises(CaseError, match=r"nowhere\.toml: there is no such file\. Give the path of a case\.toml\.$"):
        load_case(tmp_path / "nowhere.toml")


def test_folder_instead_of_case_file(tmp_path):
    """A folder is not searched for a case."""
    with pytest.raises(CaseError, match=r"this is a folder\. Give the path of the case\.toml in it\.$"):
        load_case(tmp_path)


def test_unreadable_case_file(tmp_path, monkeypatch):
    """A file that may not be read is refused with the reason of the system."""
    (tmp_path / "case.toml").write_text(MINIMAL)

    def denied(_: Path) -> bytes:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "read_bytes", denied)
    with pytest.raises(CaseError, match=r"cannot be read \(Permission denied\)\. Check its permissions\.$"):
        load_case(tmp_path / "case.toml")


def test_long_values_are_cut(load):
    """A message never repeats a page of text."""
    with pytest.raises(CaseError) as refusal:
        load(MINIMAL.replace('"on_element"', f'"{"x" * 500}"'))
    assert '"' + "x" * 56 + "... should be" in str(refusal.value)


def test_missing_inputs_are_listed_together(load, tmp_path):
    """Every file the case names and nobody has is listed."""
    (tmp_path / "welds.csv").write_text("weld\n")
    with pytest.raises(DataError) as refusal:
        check_files(load(MINIMAL))
    assert [problem.where for problem in refusal.value.problems] == [
        "case.toml: body.modes",
        "case.toml: body.weld_nodes",
        "case.toml: body.nodal_forces",
        "case.toml: mission.event[1].history",
        "case.toml: mission.event[2].history",
        "case.toml: mission.event[3].history",
    ]
    assert "q_tangent.parquet. Correct the path." in str(refusal.value)


def test_length_of_an_event(load):
    """Speed times duration, or the length given; an event counted by number has none."""
    tangent, curve, number = load(MINIMAL).mission.event
    for event in (tangent, curve, number):
        check_distance(event, 36.0, "here")
    assert event_length_km(tangent, 36.0) == pytest.approx(3.5)
    assert event_length_km(curve, 36.0) == 3
    assert event_length_km(number, 36.0) is None


@pytest.mark.parametrize(
    ("length", "fits"), [(3.5, True), (3.5034, True), (3.4966, True), (3.504, False), (3.496, False)]
)
def test_length_against_speed(load, length, fits):
    """Length and speed have to agree to 1e-3; the length then decides."""
    event = load(MINIMAL.replace("speed_km_h = 350.0", f"speed_km_h = 350.0\nlength_km = {length}")).mission.event[0]
    assert event_length_km(event, 36.0) == length
    if fits:
        check_distance(event, 36.0, "here")
        return
    with pytest.raises(CaseError) as refusal:
        check_distance(event, 36.0, "here")
    assert str(refusal.value) == (
        f"here: length_km = {length:g} of event 'tangent' is not speed_km_h = 350 times the duration of 36 s, 3.5 km. "
        "Correct one of them or leave one out."
    )


def test_schema_accepts_what_the_models_accept(load):
    """The JSON Schema says the same as the models, and every key is described."""
    schema = case_schema()
    case = load(MINIMAL + OWN_CURVE)
    content = json.loads(case.model_dump_json(exclude_none=True))
    assert Case.model_validate_json(json.dumps(content)).text == ""
    jsonschema.Draft202012Validator(schema).validate(content)
    content["mission"]["target_km"] = -1
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.Draft202012Validator(schema).validate(content)
    for table in (schema, *schema["$defs"].values()):
        for key, value in table["properties"].items():
            assert value.get("description"), key


@settings(deadline=None, max_examples=50)
@given(st.lists(st.floats(0.01, 1.0), min_size=1, max_size=6), st.floats(-1e-5, 1e-5))
def test_shares_are_accepted_within_the_tolerance(tmp_path_factory, weights, excess):
    """Shares that sum to 1 within 1e-6 pass, others do not."""
    shares = [weight / math.fsum(weights) for weight in weights]
    shares[0] += excess
    total = math.fsum(shares)
    events = [
        f'[[mission.event]]\nname = "e{i}"\nhistory = "q"\nspeed_km_h = 100\nshare = {share!r}\n'
        for i, share in enumerate(shares)
    ]
    path = tmp_path_factory.mktemp("case") / "case.toml"
    path.write_text(MINIMAL[: MINIMAL.index("[[")] + "".join(events))
    if abs(total - 1) <= 1e-6 and max(shares) <= 1:
        assert [event.share for event in load_case(path).mission.event] == shares
    else:
        with pytest.raises(CaseError):
            load_case(path)
