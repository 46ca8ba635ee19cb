"""Published values of S-N curves, and what their extensions and corrections are in closed form."""

from collections.abc import Iterator

import numpy as np

from fatigue.life.allowances import (
    RATIO_LEVELS,
    Allowances,
    StressRatio,
    bending_allowance,
    bending_thickness,
    stress_ratio_factors,
)
from fatigue.life.curves import DamageLaw, SNCurve, Survival, ThicknessRule, catalogue, damage_law, user_curve
from fatigue.life.rule import (
    bending_ratio,
    cycle_damage,
    equivalent_range,
    mean_stress_factor,
    ratio_factor,
    size_factor,
)
from fatigue.life.shear import shear_factor
from fatigue.verify.check import Check

ASME = "ASME VIII-2 5.5.5.2 and Annex 3-F, Table 3-F.11M"
LEVELS: tuple[Survival, ...] = ("mean", "mean-2sigma", "mean-3sigma")
SIX_DIGITS, EIGHT_DIGITS, ROUNDING = 5e-6, 5e-8, 1e-9


def curve_checks() -> Iterator[Check]:
    """Checks of master curves, other curves and corrections."""
    yield from _master_curves()
    yield from _other_curves()
    yield from _corrections()


def _cycles(x: float, law: DamageLaw) -> float:
    return float(1.0 / cycle_damage(np.array([x]), law)[0])


def _master_curves() -> Iterator[Check]:
    for r, expected in ((0.0, 1.2214499), (0.5, 1.2421248), (1.0, 1.3307839)):
        found = float(ratio_factor(np.array([r]))[0])
        yield Check("master curve", f"bending ratio {r:g}", "I(r)^(1/m)", "-", expected, found, EIGHT_DIGITS, ASME)
    yield from _master_case("steel", 20.0, 60.0, 40.0, "asme", 157.57788, (3.79386e6, 1.22148e6, 6.93101e5))
    yield from _master_case("steel", 10.0, 80.0, 0.0, "asme", 121.28206, (8.60886e6, 2.77172e6, 1.57276e6))
    yield from _master_case("steel", 10.0, 80.0, 0.0, "actual", 109.25380, (1.19376e7, 3.84345e6, 2.18089e6))
    yield from _master_case("aluminium", 3.0, 20.0, 10.0, "asme", 45.12506, (6.55701e6, 1.48626e6, 7.07604e5))
    yield from _master_case("aluminium", 3.0, 20.0, 10.0, "actual", 31.10732, (2.51007e7, 5.68949e6, 2.70876e6))


def _master_case(
    metal: str,
    t: float,
    membrane: float,
    bending: float,
    rule: ThicknessRule,
    dS: float,
    cycles: tuple[float, float, float],
) -> Iterator[Check]:
    """Equivalent range and life of one cycle of membrane and bending range [MPa] in a plate of thickness t [mm]."""
    curve = catalogue()[f"master-{metal}"]
    case = f"{metal}, t = {t:g} ({rule}), {membrane:g} + {bending:g} MPa"
    r = bending_ratio(np.array([membrane]), np.array([bending]))
    size = size_factor(np.array([t]), curve, rule)
    found = float(equivalent_range(membrane + bending, size, ratio_factor(r), 1.0)[0])
    yield Check("master curve", case, "dS", "MPa mm^-0.222", dS, found, EIGHT_DIGITS * 2, ASME)
    for level, expected in zip(LEVELS, cycles, strict=True):
        lives = _cycles(found, damage_law(curve, level, "none", 1e7))
        yield Check("master curve", case, f"cycles, {level}", "-", expected, lives, SIX_DIGITS, ASME)


def _other_curves() -> Iterator[Check]:
    curves = catalogue()
    iiw = "IIW Recommendations 2016, Table 3.3"
    fat = damage_law(curves["iiw-steel-100"], None, "none", 1e7)
    yield _curve("IIW FAT 100", "range at the knee, 1e7", "MPa", 58.4803548, float(fat.knees[0]), EIGHT_DIGITS, iiw)
    spectrum = cycle_damage(np.array([100.0, 60.0, 40.0]), fat) @ [1e5, 1e6, 1e6]
    yield _curve(
        "IIW FAT 100", "D of 1e5 x 100, 1e6 x 60 and 40 MPa", "-", 0.172970971, float(spectrum), EIGHT_DIGITS, iiw
    )
    en = "EN 1993-1-9:2005, 7.1"
    detail = damage_law(curves["en1993-hotspot-90"], None, "none", 1e7)
    yield _curve("EN 1993-1-9 class 90", "cycles at 120 MPa", "-", 843750.0, _cycles(120.0, detail), ROUNDING, en)
    detail = damage_law(curves["en1993-hotspot-100"], None, "none", 1e7)
    constant, cutoff = 100 * (2 / 5) ** (1 / 3), 100 * (2 / 5) ** (1 / 3) * (5 / 100) ** (1 / 5)
    yield _curve(
        "EN 1993-1-9 class 100", "range at the knee, 5e6", "MPa", constant, float(detail.knees[0]), ROUNDING, en
    )
    yield _curve("EN 1993-1-9 class 100", "cut-off range, 1e8", "MPa", cutoff, detail.cutoff, ROUNDING, en)
    below = float(cycle_damage(np.array([0.999 * cutoff]), detail)[0])
    yield _curve("EN 1993-1-9 class 100", "damage below the cut-off", "-", 0.0, below, 0.0, en)

    b1 = user_curve("B1", (4.0, 5.0), (1e7,), (10**15.117 / 2e6) ** 0.25, "structural", "DNV-RP-C203, B1 in air")
    law = damage_law(b1, None, "none", 1e7)
    found = float(law.log_constants[1] / np.log(10.0))
    yield _curve("DNV-RP-C203 B1, own curve", "log10 a of slope 5", "-", 17.146, found, 5e-5, "DNV-RP-C203, Table 2-1")
    for metal, factor in (("steel", 8.7537), ("aluminium", 12.1978)):
        law = damage_law(curves[f"master-{metal}"], None, "none", 1e7)
        found = _cycles(50.0, law) / _cycles(100.0, law)
        yield _curve(f"master curve, {metal}", "damage when stress doubles", "-", factor, found, 5e-5, ASME)


def _corrections() -> Iterator[Check]:
    steel = catalogue()["master-steel"]
    k = 1 / 0.3195
    knee = 13875.7 / 1e7**0.3195
    bent = damage_law(steel, "mean-2sigma", "haibach", 1e7)
    expected = 1e7 * 2 ** (2 * k - 1)
    yield _curve(
        "haibach, knee at 1e7",
        "cycles at half the knee",
        "-",
        expected,
        _cycles(knee / 2, bent),
        ROUNDING,
        "Haibach 1970",
    )
    cut = damage_law(steel, "mean-2sigma", "cutoff", 1e7)
    yield _curve("cut-off at 1e7", "cut-off range", "MPa mm^-0.222", knee, cut.cutoff, ROUNDING, "closed form")

    low, high = np.array([100.0, -10.0]), np.array([200.0, 200.0])
    f_M = mean_stress_factor(low, high, 250.0)
    yield _curve("100 to 200 MPa, yield 250 MPa", "f_M", "-", 0.5 ** (1 / 3.6), float(f_M[0]), ROUNDING, ASME)
    yield _curve("-10 to 200 MPa, yield 250 MPa", "f_M", "-", 1.0, float(f_M[1]), 0.0, ASME)
    one, third, none = np.array([1.0]), np.array([1.0 / 3.0]), np.array([0.0])
    clause = "ASME VIII-2 5.5.5.3"
    in_phase = float(shear_factor(one, third / 3, third)[0])
    yield _curve("shear a third of normal, in phase", "factor on dS", "-", np.sqrt(4 / 3), in_phase, ROUNDING, clause)
    circle = float(shear_factor(one, third, none)[0])
    yield _curve("shear 1/sqrt(3) of normal, 90 degrees", "factor on dS", "-", 2.0, circle, ROUNDING, clause)
    thick = SNCurve("t", "structural", (3.0,), (), 2e6, {"as tabulated": 90.0}, "", 25.0, 0.3)
    found = float(size_factor(np.array([50.0]), thick, "actual")[0])
    yield _curve(
        "t = 50 mm, reference 25 mm, n = 0.3", "factor on the range", "-", 2**0.3, found, ROUNDING, "IIW 2016, 3.5.2"
    )
    yield from _allowances()


def _allowances() -> Iterator[Check]:
    """What curves allow for in every cycle; both rules are recalled from their editions."""
    low, high = np.array([-50.0, 0.0, 60.0, -120.0]), np.array([100.0, 100.0, 100.0, 60.0])
    printed: dict[StressRatio, tuple[float, ...]] = {
        "iiw_low": (1.4, 1.2, 1.0, 1.6),
        "iiw_medium": (1.1, 1.0, 1.0, 1.3),
    }
    for level, factors in printed.items():
        found = stress_ratio_factors(low, high, RATIO_LEVELS[level]).tolist()
        for R, expected, f in zip((-0.5, 0.0, 0.6, -2.0), factors, found, strict=True):
            yield _curve(f"f(R), {level}, R = {R:g}", "f(R)", "-", expected, f, ROUNDING, "IIW 2016, recalled")
    of = Allowances(bending_factor="bs7608", bending_reference=25.0, bending_exponent=0.25)
    k_tb = float(bending_allowance(0.5) / bending_thickness(np.array([50.0]), of)[0])
    by_hand = 0.5**0.25 * (1.0 + 0.18 * 0.5**1.4)
    yield _curve("bending ratio 0.5, t = 50 mm", "k_tb", "-", by_hand, k_tb, ROUNDING, "BS 7608:2014, recalled")


def _curve(case: str, quantity: str, unit: str, expected: float, found: float, tolerance: float, source: str) -> Check:
    return Check("curves", case, quantity, unit, expected, found, tolerance, source)
