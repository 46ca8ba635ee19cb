"""Columns of an analysis graph: roots along lines of conicity or speed, critical values, and the stability map."""

from fatigue.results.dictionary.column import Column

_VEHICLE = Column("vehicle", "text", "-", "name of the vehicle")
_POINT = (
    Column("speed_km_h", "float", "km/h", "speed"),
    Column("conicity", "float", "-", "equivalent conicity of the linear contact"),
)
_ROOT = (
    Column("frequency_hz", "float", "Hz", "|s|/2 pi of the root"),
    Column("damping", "float", "-", "damping ratio -Re s/|s|; below 0 the root grows"),
    Column("mode", "text", "-", "name of the root, by the body with most of its kinetic energy and how this moves"),
    Column("group", "text", "-", "that body: car (rigid), flex, conv, trafo, bogies or wheelsets"),
    Column("share", "float", "-", "share of the kinetic energy that this group has"),
)
_ALONG = Column("along", "text", "-", "what grows along the line: conicity or speed; the other stays")

ROOTS = (
    _VEHICLE,
    _ALONG,
    *_POINT,
    Column("locus", "int", "-", "number of the root along its line, followed from point to point, from 1"),
    *_ROOT,
    Column("share_car", "float", "-", "share of the kinetic energy: rigid car body"),
    Column("share_flex", "float", "-", "the same: elastic modes of the car body"),
    Column("share_conv", "float", "-", "the same: traction converter"),
    Column("share_trafo", "float", "-", "the same: transformer"),
    Column("share_bogies", "float", "-", "the same: bogie frames"),
    Column("share_wheelsets", "float", "-", "the same: wheelsets"),
    Column("stable", "flag", "-", "whether the root decays"),
)
CRITICAL = (
    _VEHICLE,
    _ALONG,
    *_POINT,
    Column("change", "text", "-", "gains or loses stability as what grows along the line passes this value"),
    *_ROOT,
)
STABILITY = (
    _VEHICLE,
    *_POINT,
    Column("stable", "flag", "-", "whether all roots of the vehicle decay"),
    Column("frequency_hz", "float", "Hz", "frequency of the least damped root of what runs"),
    Column(
        "damping",
        "float",
        "-",
        "its damping ratio, the least of the roots with half of their energy or more on"
        " car body (rigid), bogies and wheelsets, and of all that grow",
    ),
    *_ROOT[2:],
)
GRAPH: dict[str, tuple[Column, ...]] = {"critical": CRITICAL, "roots": ROOTS, "stability": STABILITY}
