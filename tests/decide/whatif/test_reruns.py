"""Every knob, at both extremes, beside an assessment of the changed case: exact to rounding, else within bounds."""

import sys

import numpy as np
import pytest

from fatigue.decide.whatif.story import whatif
from tests.decide.whatif.reruns import (
    base_case,
    both,
    changed,
    curve,
    dropped,
    event,
    extra,
    inside,
    load,
    mission,
    nodes_of,
    run,
    shares,
)

EVENTS = 'mission.event."load and unload"'
SHARE = "mission.event.{}.share={}"
HALVES = [SHARE.format("sine", 0.5), SHARE.format("noise", 0.5)]
MISSION = {  # settings, events that are dropped, and the case that is assessed beside it
    "by number 0": ([f"{EVENTS}.per_1000_km=0"], (), event("load and unload", per_1000_km=0)),
    "by number 500": ([f"{EVENTS}.per_1000_km=500"], (), event("load and unload", per_1000_km=500)),
    "slow": (["mission.event.sine.speed_km_h=20"], (), event("sine", speed_km_h=20.0)),
    "fast": (["mission.event.noise.speed_km_h=500"], (), event("noise", speed_km_h=500.0)),
    "number dropped": ([], ("load and unload",), dropped("load and unload")),
    "target": (["mission.target_km=1e6"], (), mission(target_km=1e6)),
    "limit and year": (
        ["mission.damage_limit=0.5", "mission.km_per_year=3e5"],
        (),
        mission(damage_limit=0.5, km_per_year=3e5),
    ),
}
WITHOUT = {  # what a case with this sequence cannot have
    "share 0": ([SHARE.format("sine", 0.0), SHARE.format("noise", 1.0)], (), shares(0.0)),
    "share 1": ([SHARE.format("sine", 1.0), SHARE.format("noise", 0.0)], (), shares(1.0)),
    "noise dropped": ([SHARE.format("sine", 1.0)], ("noise",), dropped("noise", share=1.0)),
    "length": (["mission.event.noise.length_km=0.3"], (), event("noise", length_km=0.3)),
}
CURVE = {
    "load 0.5": (["load=0.5"], (), load(0.5)),
    "load 2": (["load=2"], (), load(2.0)),
    "survival mean": (["curve.survival=mean"], (), curve(survival="mean")),
    "survival 3 sigma": (["curve.survival=mean-3sigma"], (), curve(survival="mean-3sigma")),
    "one event 0.5": ([f"{EVENTS}.stress_factor=0.5"], (), load(0.5, ["load and unload"])),
    "one event 2": ([f"{EVENTS}.stress_factor=2.0"], (), load(2.0, ["load and unload"])),
}
MASTER = {
    "asme": (["curve.thickness_rule=asme"], (), curve(thickness_rule="asme")),
    "none": (["curve.extension=none"], (), curve(extension="none")),
    "haibach": (["curve.extension=haibach"], (), curve(extension="haibach")),
    "cutoff": (["curve.extension=cutoff"], (), curve(extension="cutoff")),
    "knee": (
        ["curve.extension=haibach", "curve.knee_cycles=2e6"],
        (),
        curve(extension="haibach", knee_cycles=2e6),
    ),
    "steel": (["curve.name=master-steel"], (), curve(name="master-steel")),
    "all at once": (
        [
            "curve.survival=mean",
            "load=1.3",
            "curve.thickness_rule=asme",
            *[SHARE.format("sine", 0.5)],
            SHARE.format("noise", 0.5),
        ],
        (),
        both(curve(survival="mean", thickness_rule="asme"), load(1.3), shares(0.5)),
    ),
}
OTHERS = {
    "structural": {
        "class 30": (
            ["curves.own.range_at_2e6_MPa=30"],
            (),
            extra("range_at_2e6_MPa = 60.0", "range_at_2e6_MPa = 30.0"),
        ),
        "class 90": (
            ["curves.own.range_at_2e6_MPa=90"],
            (),
            extra("range_at_2e6_MPa = 60.0", "range_at_2e6_MPa = 90.0"),
        ),
        "slopes": (
            ["curves.own.slopes=[4.0]", "curves.own.knees_cycles=[]"],
            (),
            both(extra("slopes = [3.0, 5.0]", "slopes = [4.0]"), extra("knees_cycles = [1e7]", "knees_cycles = []")),
        ),
        "thickness": (
            ["curves.own.thickness_reference_mm=4", "curves.own.thickness_exponent=0.25"],
            (),
            extra("log10_scatter", "thickness_reference_mm = 4.0\nthickness_exponent = 0.25\nlog10_scatter"),
        ),
        "gamma": (["curves.own.gamma_Mf=1.25"], (), extra("log10_scatter", "gamma_Mf = 1.25\nlog10_scatter")),
        "to dS": (["curve.name=master-aluminium"], (), curve(name="master-aluminium")),
    },
    "straight": MASTER | {"to structural": (["curve.name=own"], (), curve(name="own"))},
    "haibach": MASTER,
    "cutoff": MASTER,
}
SEQUENCE = {
    "K 0": (["mission.sequence.1.per_1000_km=0"], (), extra("per_1000_km = 20.0", "per_1000_km = 0.0")),
    "K 100": (["mission.sequence.1.per_1000_km=100"], (), extra("per_1000_km = 20.0", "per_1000_km = 100.0")),
}
EXACT = {"exact"}


ASKED = {  # of every curve, without and with a sequence; what a mission does to stored damage depends on no curve
    ("straight", False): CURVE | OTHERS["straight"],
    ("straight", True): MISSION | CURVE | SEQUENCE,
    ("haibach", False): MISSION | WITHOUT | CURVE | OTHERS["haibach"],
    ("haibach", True): CURVE | OTHERS["haibach"] | SEQUENCE,
    ("cutoff", False): CURVE | OTHERS["cutoff"],
    ("cutoff", True): SEQUENCE | {"load 2": CURVE["load 2"]},
    ("structural", False): CURVE | OTHERS["structural"],
    ("structural", True): SEQUENCE | {"load 2": CURVE["load 2"]},
}
AS_IT_IS = {"straight": "none"}  # other knobs of extension have the name of the curve


def cases():
    """Curve, sequence or not, name of the knob, settings, dropped events, and the case beside it."""
    for (name, sequence), knobs in ASKED.items():
        for knob, (settings, drop, mutate) in knobs.items():
            if knob != AS_IT_IS.get(name, name):
                yield pytest.param(name, sequence, knob, settings, drop, mutate, id=f"{name}-{sequence}-{knob}")


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Results of the case on every curve, without and with a sequence, assessed when they are asked for."""
    made = {}

    def of(name, sequence):
        if (name, sequence) not in made:
            folder = tmp_path_factory.mktemp(f"{name}{sequence}")
            made[name, sequence] = run(base_case(name, sequence=sequence), folder)
        return made[name, sequence]

    return of


LARGEST: dict[str, list[float]] = {}


@pytest.mark.parametrize(("name", "sequence", "knob", "settings", "drop", "mutate"), list(cases()))
def test_knob_beside_an_assessment_of_the_changed_case(results, tmp_path, name, sequence, knob, settings, drop, mutate):
    """Exact damage agrees to 1e-12; other damage lies between low and high, and its value is as close as they are."""
    found = whatif(results(name, sequence), settings, drop=drop)
    again = nodes_of(run(changed(base_case(name, sequence=sequence), mutate), tmp_path, histogram="none"))
    points = found.points
    truth, damage = again["damage_per_km"].to_numpy(), points["damage_per_km"].to_numpy()
    assert not points["basis"].eq("recount").any()
    exact = points["basis"].eq("exact").to_numpy()
    if knob in MISSION | WITHOUT or (name == "straight" and knob in CURVE):
        assert exact.all()
    np.testing.assert_allclose(damage[exact], truth[exact], rtol=1e-12)
    low, high = points["damage_per_km_low"].to_numpy(), points["damage_per_km_high"].to_numpy()
    assert inside(low, truth, high)
    for basis in points["basis"].unique():
        here = points["basis"].eq(basis).to_numpy() & (truth > 0.0)
        if here.any():
            LARGEST.setdefault(f"{basis} of {name}", []).append(float(np.abs(damage[here] / truth[here] - 1.0).max()))
    np.testing.assert_allclose(points["life_km"][exact], again["life_km"][exact], rtol=1e-12)
    np.testing.assert_allclose(points["utilisation"][exact], again["utilisation"][exact], rtol=1e-12)
    np.testing.assert_allclose(points["life_years"][exact], again["life_years"][exact], rtol=1e-12)
    factor = again["load_factor"].to_numpy()
    assert inside(points["load_factor_low"].to_numpy(), factor, points["load_factor_high"].to_numpy(), 3e-4)
    worst = found.welds.set_index("weld")
    after = again[again["toe"]].groupby("weld")["utilisation"].max()
    assert (worst["verdict"].eq("misses") <= (after[worst.index] > 1.0)).all()
    assert (worst["verdict"].eq("meets") <= (after[worst.index] <= 1.0)).all()


def test_largest_errors():
    """The largest error of every basis, over all knobs of this module that ran, for the docs: exact is rounding."""
    for basis, errors in sorted(LARGEST.items()):
        sys.stdout.write(f"{basis}: {max(errors):.2e}\n")
    assert all(max(errors) < 1e-12 for basis, errors in LARGEST.items() if basis.startswith("exact"))
