"""Columns of a shift study: life against the frequency or damping of one mode."""

from fatigue.results.dictionary.column import POINT, Column

SHIFT = (
    *POINT,
    Column("mode", "int", "-", "mode that is moved"),
    Column("frequency_hz", "float", "Hz", "frequency it is moved to"),
    Column("damping_ratio", "float", "-", "damping ratio it is moved to"),
    Column("is_as_assessed", "flag", "-", "frequency and damping as they were assessed"),
    Column("damage_per_km", "float", "1/km", "Miner sum per km of the mission, counted again"),
    Column("life_km", "float", "km", "life, a screening without feedback"),
    Column("life_ratio", "float", "-", "life over that at the setting as assessed"),
    Column("is_worst_of_weld", "flag", "-", "shortest life of its weld at this setting"),
)

SHIFTED: dict[str, tuple[Column, ...]] = {"shift": SHIFT}
