"""Columns of how resonances form: excitation of the modes, what it makes at each weld, and which one to watch."""

from fatigue.results.dictionary.column import POINT, Column

_EVENT = Column("event", "text", "-", "event of the mission")

RESONANCE = (
    _EVENT,
    Column("mode", "int", "-", "mode id"),
    Column("frequency_hz", "float", "Hz", "natural frequency of the mode"),
    Column("damping_ratio", "float", "-", "damping ratio of the mode; empty: none given"),
    Column("class", "text", "-", "quasi_static: follows its load; resonant: swings; not_assessed"),
    Column("rms_q", "float", "-", "rms of the coordinate about its mean"),
    Column("dynamic_share", "float", "-", "rms of the dynamic part over rms_q"),
    Column("half_power_share", "float", "-", "share of the excitation within f (1 +- 2 zeta)"),
    Column("excitation_hz", "float", "Hz", "dominant frequency of the excitation"),
    Column("response_hz", "float", "Hz", "dominant frequency of the coordinate"),
    Column("reason", "text", "-", "why a number is empty"),
)

WELD_RESONANCE = (
    *POINT,
    _EVENT,
    Column("dominant_hz", "float", "Hz", "dominant frequency of the structural stress at the weld's worst point"),
    Column("damage_per_km", "float", "1/km", "damage of the event per km of the mission"),
    Column("damage_per_km_quasi_static", "float", "1/km", "damage of the quasi-static part of the stress alone"),
    Column("damage_per_km_dynamic", "float", "1/km", "damage of the dynamic part of the stress alone"),
    Column("dynamic_share", "float", "-", "rms of the dynamic part of the stress over that of the stress"),
    Column("reason", "text", "-", "why a number is empty"),
)

WATCH = (
    *POINT,
    Column("rank", "int", "-", "1: the resonance that costs most"),
    _EVENT,
    Column("mode", "int", "-", "mode id"),
    Column("frequency_hz", "float", "Hz", "natural frequency of the mode"),
    Column("start_km", "float", "km", "where in the event it is strongest; empty if counted by number"),
    Column("end_km", "float", "km", "end of that place"),
    Column("start_s", "float", "s", "file time at the start of that place"),
    Column("end_s", "float", "s", "file time at the end of that place"),
    Column("damage_share", "float", "-", "share of the damage of the point that goes with the resonance"),
    Column("life_km", "float", "km", "life as it is"),
    Column("life_km_without", "float", "km", "life with the mode following its load in this event, counted again"),
    Column("cost_km", "float", "km", "life_km_without - life_km"),
)

FORMED: dict[str, tuple[Column, ...]] = {"resonance": RESONANCE, "weld_resonance": WELD_RESONANCE, "watch": WATCH}
