"""The tables of a case: defaults, and values that are refused."""

import json

import pytest

from fatigue.errors import CaseError
from fatigue.pipeline.solve.rated.rated_curves import curves_of_case
from tests.case.case_text import MINIMAL, OWN_CURVE


def test_defaults_are_those_of_the_contract(load):
    """What a case leaves out takes the documented value."""
    case = load(MINIMAL)
    assert case.title == "Untitled"
    assert case.body.ignore_modes == ()
    curve = case.curve
    assert (curve.survival, curve.thickness_rule, curve.extension) == (None, "actual", "none")
    assert (curve.knee_cycles, curve.mean_stress, curve.yield_MPa) == (1e7, "none", None)
    assert (case.counting.residue, case.counting.upsample) == ("repeat", "auto")
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
    (
        "counting",
        "",
        "upsample = 128",
        "counting.upsample: 128 is above 64, with which no record has less than 128 samples per peak ('auto' takes",
    ),
    ("counting", "", "upsample = 1048576", "counting.upsample: 1048576 is above 64"),
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
        "curves.mine.applies: \"hot spot\" should be 'structural', 'dS'",
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
]


@pytest.mark.parametrize(("old", "new", "message"), WRONG_CURVES, ids=lambda value: str(value)[:40])
def test_wrong_curve(load, old, new, message):
    """A curve of the user's own is checked like the rest."""
    with pytest.raises(CaseError) as refusal:
        load(MINIMAL + OWN_CURVE.replace(old, new, 1))
    assert str(refusal.value).startswith("case.toml: " + message)
