"""Columns of how resonances form: excitation of the modes, what it makes at each weld, and which one to watch."""

from fatigue.results.dictionary.column import POINT, Column

_EVENT = Column("event", "text", "-", "event of the mission")

RESONANCE = (
    _EVENT,
    Column("mode", "int", "-", "mode id"),
    Column("frequency_hz", "float", "Hz", "natural frequency of the mode"),
    Column("damping_ratio", "float", "-", "damping ratio of the mode; empty: none is known, and the split takes 0"),
    Column("damping_source", "text", "-", "modes: of the table of modes; assumed: given to the diagnosis; empty: none"),
    Column(
        "class",
        "text",
        "-",
        "quasi_static: follows its load, dynamic_share below 0.5, or a boundary mode above 2 times highest_hz; "
        "resonant: swings, dynamic_share from 0.5, and amplification from 1 or response_share from 0.5; inertial: its "
        "loads are above its frequency, where it moves less than they would move it statically; not_assessed",
    ),
    Column("rms_q", "float", "-", "rms of the coordinate about its mean"),
    Column("dynamic_share", "float", "-", "rms of the dynamic part over rms_q; r^2 of a sine at r times the frequency"),
    Column("amplification", "float", "-", "rms_q over the rms of the quasi-static part"),
    Column("half_power_share", "float", "-", "share of the variance of the excitation within f (1 +- 2 zeta)"),
    Column("response_share", "float", "-", "share of the variance of the coordinate within f (1 +- 2 zeta)"),
    Column("excitation_hz", "float", "Hz", "dominant frequency of the excitation"),
    Column("response_hz", "float", "Hz", "dominant frequency of the coordinate"),
    Column("highest_hz", "float", "Hz", "frequency below which 99 % of the variance of the coordinate lies"),
    Column("reason", "text", "-", "why a number is empty, or what is special about the mode"),
)

WELD_RESONANCE = (
    *POINT,
    _EVENT,
    Column("dominant_hz", "float", "Hz", "dominant frequency of the structural stress at the weld's worst point"),
    Column("damage_per_km", "float", "1/km", "damage of the event per km of the mission"),
    Column("damage_per_km_quasi_static", "float", "1/km", "damage of the quasi-static part of the stress alone"),
    Column(
        "damage_per_km_dynamic",
        "float",
        "1/km",
        "damage of the dynamic part of the stress alone, about the mean stress; the two do not add up to damage_per_km",
    ),
    Column("dynamic_share", "float", "-", "rms of the dynamic part of the stress over that of the stress"),
    Column("reason", "text", "-", "why a number is empty"),
)

WATCH = (
    *POINT,
    Column("rank", "int", "-", "1: the swing that adds most to the utilisation of its weld; within a weld as well"),
    _EVENT,
    Column("mode", "int", "-", "mode id"),
    Column("frequency_hz", "float", "Hz", "natural frequency of the mode"),
    Column("class", "text", "-", "class of the mode in this event, see the resonance table"),
    Column("start_km", "float", "km", "start of the shortest stretch that holds half of what the swing does; or empty"),
    Column("end_km", "float", "km", "end of that stretch; empty for an event counted by number"),
    Column("start_s", "float", "s", "file time at the start of that stretch"),
    Column("end_s", "float", "s", "file time at the end of that stretch"),
    Column(
        "damage_share", "float", "-", "share of the damage of the point that goes with the swing, 1 - life / without"
    ),
    Column("life_km", "float", "km", "life as it is"),
    Column("life_km_without", "float", "km", "life with the mode following its load in this event, counted again"),
    Column("cost_km", "float", "km", "life_km_without - life_km"),
    Column("utilisation_cost", "float", "-", "what the swing adds to the utilisation of the point"),
)

FORMED: dict[str, tuple[Column, ...]] = {"resonance": RESONANCE, "weld_resonance": WELD_RESONANCE, "watch": WATCH}
