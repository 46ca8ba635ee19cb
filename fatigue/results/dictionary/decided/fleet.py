"""Columns of what a fleet does to its welds, written into a folder of its own: units, welds, points, percentiles."""

from fatigue.results.dictionary.column import POINT, Column

_UNIT = Column("unit", "text", "-", "unit of the fleet")
_DAMAGE = Column(
    "damage_per_year",
    "float",
    "1/a",
    "Miner sum in a year: over the conditions, damage per km (or pass) times km (or passes); an upper bound where "
    "is_bound",
)
_LIFE = Column("life_years", "float", "a", "damage limit over damage_per_year: at least this where is_bound")
_BOUND = Column("is_bound", "flag", "-", "the damage rests on an upper bound of a point that was not counted")
_AT_MOST = Column(
    "life_years_at_most", "float", "a", "life of the worst counted point; equal to life_years unless is_bound"
)
_GOVERNING = (
    Column("governing_condition", "text", "-", "condition with the largest part of the damage"),
    Column("governing_share", "float", "-", "that part of the damage"),
)

FLEET_UNITS = (
    Column("rank", "int", "-", "1: the unit with the shortest life"),
    _UNIT,
    Column("km_per_year", "float", "km/a", "sum of its distances; passes are none"),
    *POINT,
    _DAMAGE,
    _LIFE,
    Column("life_km", "float", "km", "the same as a distance: life_years times km_per_year"),
    _BOUND,
    _AT_MOST,
    Column("fulfilled", "flag", "-", "every weld lives at least target_years; empty where no target is given"),
    *_GOVERNING,
    Column(
        "damage_cv",
        "float",
        "-",
        "standard deviation of damage_per_year over it, from what is said of distances and damage; empty: nothing is",
    ),
)

FLEET_WELDS = (
    _UNIT,
    *POINT,
    _DAMAGE,
    _LIFE,
    _BOUND,
    _AT_MOST,
    Column("fulfilled", "flag", "-", "life_years is at least target_years; empty where no target is given"),
    *_GOVERNING,
)

FLEET_POINTS = (
    _UNIT,
    *POINT,
    Column("toe", "flag", "-", "there is a weld toe: a face without one never governs"),
    _DAMAGE,
    _LIFE,
    _BOUND,
)

FLEET_PERCENTILES = (
    Column("weld", "text", "-", "weld line; empty: all of them, of each unit the one with the shortest life"),
    Column("percentile", "float", "%", "over the units, linear between the sorted values"),
    Column("life_years", "float", "a", "so many percent of the units live no longer"),
    Column("damage_per_year", "float", "1/a", "percentile of the damage itself, not of 1 / life_years"),
    Column("utilisation_per_year", "float", "1/a", "percentile of damage_per_year over the damage limit of the weld"),
    Column("units_with_bound", "int", "-", "units whose damage here rests on an upper bound"),
)

FLEET_VARIANCE = (
    Column(
        "of",
        "text",
        "-",
        "units: how units differ, over all of them; unit: how sure the damage of one unit is, from km_per_year_sd, "
        "correlations and damage_cv",
    ),
    Column("unit", "text", "-", "unit; empty where all are looked at"),
    *POINT,
    Column("condition", "text", "-", "condition"),
    Column(
        "source",
        "text",
        "-",
        "distance: the distances; damage: the damage of the condition; both: their product, an interaction",
    ),
    Column("variance_per_year2", "float", "1/a^2", "part of the variance of damage_per_year"),
    Column("share", "float", "-", "that part over the variance; below 0 where distances go against each other"),
)

FLEET: dict[str, tuple[Column, ...]] = {
    "fleet_units": FLEET_UNITS,
    "fleet_welds": FLEET_WELDS,
    "fleet_points": FLEET_POINTS,
    "fleet_percentiles": FLEET_PERCENTILES,
    "fleet_variance": FLEET_VARIANCE,
}
