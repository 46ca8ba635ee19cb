"""Columns of what virtual strain gauges read, written into a folder of its own."""

from fatigue.results.dictionary.column import Column

_GAUGE = Column("gauge", "text", "-", "name of the gauge, as it is listed")
_EVENT = Column("event", "text", "-", "event of the mission; (mission): all of them, where all were asked for")
MICROSTRAIN = "ue"

GAUGES = (
    _GAUGE,
    Column("kind", "text", "-", "element: from element forces; table: at a stress point; toe: at a weld toe"),
    Column("group", "text", "-", "as it is given"),
    Column("stand_in", "flag", "-", "stress at a weld toe: for planning, nothing can be mounted there"),
    Column("element", "int", "-", "element under the middle of the grid"),
    Column("point", "text", "-", "stress point"),
    Column("weld", "text", "-", "weld line of a stand-in"),
    Column("part", "int", "-", "straight part of that weld"),
    Column("order", "int", "-", "position along that weld"),
    Column("surface", "text", "-", "top (+z of the element or the plate), bottom or edge"),
    Column("x_mm", "float", "mm", "middle of the grid on the mid-surface of the plate; of a table as it is there"),
    Column("y_mm", "float", "mm", "likewise"),
    Column("z_mm", "float", "mm", "likewise"),
    Column("dir_x", "float", "-", "unit vector along the grid"),
    Column("dir_y", "float", "-", "likewise"),
    Column("dir_z", "float", "-", "likewise"),
    Column("normal_x", "float", "-", "unit vector out of the face"),
    Column("normal_y", "float", "-", "likewise"),
    Column("normal_z", "float", "-", "likewise"),
    Column("angle_deg", "float", "deg", "from axis x of the element under its middle, or of the point, to the grid"),
    Column("grid_length_mm", "float", "mm", "length of the grid; 0: the element as a whole"),
    Column("elements", "int", "-", "elements that the grid crosses"),
    Column("thickness_mm", "float", "mm", "plate thickness"),
    Column("place_distance_mm", "float", "mm", "of the given place from the mid-surface of the element found"),
    Column("transverse_sensitivity", "float", "-", "of the grid, across over along"),
    Column("E_MPa", "float", "MPa", "modulus of the plate"),
    Column("nu", "float", "-", "Poisson's ratio of the plate"),
    Column("nearest_weld", "text", "-", "weld line nearest to the middle of the grid"),
    Column("distance_to_weld_mm", "float", "mm", "distance from it"),
    Column("rms_ue", "float", MICROSTRAIN, "rms about the mean over the mission, events by their share"),
    Column("rms_MPa", "float", "MPa", "the same of the normal stress along the grid"),
    Column("angle_sensitivity", "float", "-", "largest relative change of the rms of a grid turned by 5 degrees"),
    Column("neighbours", "int", "-", "elements beside that of the gauge, with forces"),
    Column("neighbour_sensitivity", "float", "-", "largest relative change of the rms on one of these"),
    Column("cost", "float", "-", "as it is given"),
)

GAUGE_EVENTS = (
    _GAUGE,
    Column("event", "text", "-", "event of the mission"),
    Column("start_s", "float", "s", "file time of the first kept sample"),
    Column("step_s", "float", "s", "between samples of the histories"),
    Column("samples", "int", "-", "kept samples of the file, or instants that are counted"),
    Column("km_per_pass", "float", "km", "distance of the kept part; empty of an event counted by number"),
    Column("rms_ue", "float", MICROSTRAIN, "rms of the reading about its mean"),
    Column("rms_MPa", "float", "MPa", "the same of the normal stress along the grid"),
    Column("mean_ue", "float", MICROSTRAIN, "mean of the reading; a measurement has no zero to compare it with"),
    Column("min_ue", "float", MICROSTRAIN, "smallest reading at these samples"),
    Column("max_ue", "float", MICROSTRAIN, "largest reading at these samples"),
    Column("cycles_per_pass", "float", "-", "rainflow cycles of a pass at the counted instants"),
    Column("largest_range_ue", "float", MICROSTRAIN, "largest range of these"),
    Column("exponent", "float", "-", "k of the pseudo-damage"),
    Column("pseudo_damage_per_pass", "float", "ue^k", "sum n r^k of a pass"),
    Column("pseudo_damage_per_km", "float", "ue^k/km", "per km of the event itself; empty of one counted by number"),
    Column("pseudo_damage_per_mission_km", "float", "ue^k/km", "per km of the mission: passes_per_km times a pass"),
    Column("equivalent_range_1_hz_ue", "float", MICROSTRAIN, "range that does the same at one cycle a second"),
)

GAUGE_SPECTRUM = (
    _GAUGE,
    _EVENT,
    Column("lower_ue", "float", MICROSTRAIN, "smallest strain range of the class"),
    Column("upper_ue", "float", MICROSTRAIN, "end of the class, which belongs to the next one, or to the last"),
    Column("count_per_km", "float", "1/km", "cycles per km of the mission: passes_per_km times those of one pass"),
    Column("power_sum_per_km", "float", "ue^k/km", "sum n r^k of the ranges themselves, k: exponent"),
    Column("exceedance_per_km", "float", "1/km", "cycles of lower_ue and more per km of the mission"),
)

GAUGE_ROWS = (
    _GAUGE,
    Column("mode", "int", "-", "mode id; empty for a unit load"),
    Column("unit_load", "text", "-", "unit load; empty for a mode"),
    Column("strain_ue", "float", MICROSTRAIN, "reading per unit of the coordinate"),
    Column("stress_MPa", "float", "MPa", "normal stress along the grid per unit of the coordinate"),
)

HISTORIES = (
    Column("event", "text", "-", "event of the mission"),
    Column("time_s", "float", "s", "file time, or of the instants that are counted"),
)


def histories_columns(gauges: tuple[str, ...]) -> tuple[Column, ...]:
    """Columns of the table of histories of some gauges: two of each behind those that all have."""
    own: list[Column] = []
    for name in gauges:
        own.append(Column(f"{name}_ue", "float", MICROSTRAIN, f"reading of gauge {name}"))
        own.append(Column(f"{name}_MPa", "float", "MPa", f"normal stress along the grid of gauge {name}"))
    return (*HISTORIES, *own)


GAUGE_TABLES: dict[str, tuple[Column, ...]] = {
    "gauges": GAUGES,
    "gauge_events": GAUGE_EVENTS,
    "gauge_spectrum": GAUGE_SPECTRUM,
    "gauge_rows": GAUGE_ROWS,
    "histories": HISTORIES,
}
