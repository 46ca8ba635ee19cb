"""Curves that a case may use: those of the catalogue, those of the case, and those of the catalogue that it changes."""

from collections.abc import Iterator
from dataclasses import fields, replace

from fatigue.case import Case, CustomCurve
from fatigue.errors import CaseError, Problem, refuse
from fatigue.life.allowances import ALLOWANCE_KEYS
from fatigue.life.curves import TABULATED, SNCurve, catalogue, user_curve

TEXTS = ("source", "edition", "clause", "status", "checked_by", "checked_on")  # of a curve; all else are its numbers
LINE = {"slopes", "knees_cycles", "range_at_2e6_MPa", "log10_scatter"}  # keys that say where its line lies
OTHERS = {  # of a curve, by the key of the case
    "applies": "applies",
    "quantity": "quantity",
    "thickness_reference_mm": "thickness_reference",
    "thickness_exponent": "thickness_exponent",
    "damage_limit": "damage_limit",
    **{text: text for text in TEXTS},
}


def curves_of_case(case: Case) -> dict[str, SNCurve]:
    """Curves of the catalogue and of the case.

    A curve of the case that has the name of one of the catalogue is that curve with the keys of the case in the place
    of its own. Where any number of it is another one then, its status is ``user``; where none is, the case may say who
    compared it. An unverified curve stays that as long as its line does, whatever factors the case puts on it.

    Raises
    ------
    CaseError : a curve of the catalogue is changed to something that is none
    """
    shipped = catalogue()
    refuse(CaseError, (found for name, given in case.curves.items() for found in _problems(case, name, given)))
    own = {
        name: _changed(shipped[name], given) if name in shipped else _own(name, given)
        for name, given in case.curves.items()
    }
    return dict(shipped) | own


def _own(name: str, given: CustomCurve) -> SNCurve:
    """Curve of the case alone; that no key is missing was seen when the case was read."""
    assert given.slopes is not None
    assert given.range_at_2e6_MPa is not None
    assert given.applies is not None
    assert given.source is not None
    curve = user_curve(
        name=name,
        slopes=given.slopes,
        knees_cycles=given.knees_cycles,
        range_at_2e6=given.range_at_2e6_MPa,
        applies=given.applies,
        source=given.source,
        log10_scatter=given.log10_scatter,
    )
    return _with_keys(curve, given, set(CustomCurve.model_fields))


def _with_keys(curve: SNCurve, given: CustomCurve, keys: set[str]) -> SNCurve:
    """The curve with some keys of the case that are not about its line."""
    values = {ours: getattr(given, key) for key, ours in OTHERS.items() if key in keys}
    if values.get("thickness_exponent", 0.0) is None:
        values["thickness_exponent"] = 0.0
    allowances = {ours: getattr(given, key) for key, ours in ALLOWANCE_KEYS.items() if key in keys}
    if allowances.get("bending_exponent", 0.0) is None:
        allowances["bending_exponent"] = 0.0
    return replace(curve, **values, allowances=replace(curve.allowances, **allowances))


def _changed(shipped: SNCurve, given: CustomCurve) -> SNCurve:
    """A curve of the catalogue with the keys of the case."""
    keys = set(given.model_fields_set)
    line = shipped
    if keys & LINE:
        of_class = shipped.reference_range.get(TABULATED)
        reference = given.range_at_2e6_MPa if "range_at_2e6_MPa" in keys else of_class
        assert reference is not None
        made = user_curve(
            name=shipped.name,
            slopes=given.slopes or shipped.slopes,
            knees_cycles=given.knees_cycles if "knees_cycles" in keys else shipped.knees_cycles,
            range_at_2e6=reference,
            applies=shipped.applies,
            source=shipped.source,
            log10_scatter=given.log10_scatter,
        )
        of_line = ("slopes", "knees_cycles", "reference_cycles", "reference_range")
        line = replace(shipped, **{name: getattr(made, name) for name in of_line})
    curve = _with_keys(line, given, keys)
    if "status" in keys or _same_numbers(curve, shipped):
        return curve
    stays = shipped.status == "unverified" and not keys & LINE  # its line is as unverified as it was
    return curve if stays else replace(curve, status=given.status)


def _same_numbers(one: SNCurve, other: SNCurve) -> bool:
    names = [field.name for field in fields(SNCurve) if field.name not in TEXTS]
    return all(getattr(one, name) == getattr(other, name) for name in names)


def _problems(case: Case, name: str, given: CustomCurve) -> Iterator[Problem]:
    """Refusals of keys that make no curve of one of the catalogue."""
    shipped, keys, where = catalogue().get(name), given.model_fields_set, f"{case.path.name}: curves.{name}"
    if shipped is None:
        return
    if shipped.has_scatter and keys & LINE and not {"slopes", "range_at_2e6_MPa"} <= keys:
        what = f"{', '.join(sorted(keys & LINE))} of a curve of the catalogue that has no range at 2e6 cycles"
        remedy = "Give both slopes and range_at_2e6_MPa, or a curve of another name"
        yield Problem("half_a_curve", where, what, remedy)
        return
    slopes = given.slopes or shipped.slopes
    knees = given.knees_cycles if "knees_cycles" in keys else shipped.knees_cycles
    if len(knees) not in (len(slopes) - 1, len(slopes)):
        what = f"{len(knees)} knees do not go with {len(slopes)} slopes; the catalogue gives what the case does not"
        yield Problem("half_a_curve", where, what, "Give both slopes and knees_cycles")
        return
    applies = given.applies or shipped.applies
    if applies == "dS" and given.bending_factor != "none":
        what = f"'{given.bending_factor}' is given for a curve in dS, which has I(r) of the bending ratio already"
        yield Problem("contradiction", f"{where}.bending_factor", what, "Remove it, or give the curve of a stress")
    if applies == "dS" and given.quantity == "shear":
        what = "'shear' is given for a curve in dS, the equivalent range of the normal stress"
        yield Problem("contradiction", f"{where}.quantity", what, "Give a shear curve of its own")
    if given.status == "verified" and not _same_numbers(_changed(shipped, given), shipped):
        what = "'verified' is given for a curve of the catalogue of which a number is changed"
        remedy = "Give the curve another name with its own source, or leave status out: it is 'user'"
        yield Problem("contradiction", f"{where}.status", what, remedy)
