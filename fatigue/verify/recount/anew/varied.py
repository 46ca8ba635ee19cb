"""The case under other assumptions, one at a time, for a recount of the welds that change their verdict.

A variant is another value of a key of the case, and the curve and the records are made anew from that.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from fatigue.verify.recount.anew.curve import RecountCurve

RAW_END = "raw_end"
SHEAR = {"shear_path_range": "range", "shear_asme": "asme"}  # methods that would decide with the normal stress
SAMPLING: dict[str, Any] = {"upsample_1": 1, "upsample_auto": "auto"}
LIMIT = {"damage_limit_0.5": 0.5}
OF_CURVE: dict[str, dict[str, Any]] = {
    "asme_thickness": {"thickness_rule": "asme"},
    "survival_3sigma": {"survival": "mean-3sigma"},
    "haibach_1e7": {"extension": "haibach", "knee_cycles": 1e7},
    "no_knee": {"extension": "none"},
}


def varied_case(case: Mapping[str, Any], variant: str) -> dict[str, Any]:
    """The case with the key of a variant changed, where it has one."""
    changed = dict(case)
    if variant in OF_CURVE:
        changed["curve"] = {**case["curve"], **OF_CURVE[variant]}
    if variant in SAMPLING:
        changed["counting"] = {**case.get("counting", {}), "upsample": SAMPLING[variant]}
    return changed


def limited(curve: RecountCurve, variant: str) -> RecountCurve:
    """The curve with the damage limit of a variant, which is also that of curves with a limit of their own."""
    if variant not in LIMIT:
        return curve
    return replace(curve, allowed=replace(curve.allowed, own_limit=LIMIT[variant], on_limit=1.0))


def expected_variants(case: Mapping[str, Any], method: str, listed: set[str]) -> list[str]:
    """Variants that a result has rows of; of the two of sampling, where the case leaves it open, the ``listed`` one."""
    upsample = case.get("counting", {}).get("upsample", "auto")
    sampling = {"auto": "upsample_1", 1: "upsample_auto"}.get(upsample)
    if sampling is None:  # a factor for all records, which have nothing to be sampled where all are static load cases
        sampling = "upsample_auto" if "upsample_auto" in listed else "upsample_1"
    has_knee = case["curve"].get("extension", "none") != "none"
    of_curve = [name for name in OF_CURVE if name != "no_knee" or has_knee]
    return [*(SHEAR if method != "off" else ()), RAW_END, *of_curve, sampling, *LIMIT]
