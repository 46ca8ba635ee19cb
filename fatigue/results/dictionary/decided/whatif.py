"""Columns of a what-if: points and welds under another mission, curve or load, before and after."""

from fatigue.results.dictionary.column import POINT, Column

_BASIS = (
    "what the numbers rest on: exact, sums of stored damages; histogram, stored ranges on the new curve, between "
    "proven bounds; bound, a multiple that no cycle exceeds; recount, nothing stored says enough"
)

WHATIF = (
    *POINT,
    Column("toe", "flag", "-", "face with a weld toe; others never govern"),
    Column("basis", "text", "-", f"{_BASIS}; counted, counted again"),
    Column("damage_per_km_before", "float", "1/km", "Miner sum per km as assessed"),
    Column("damage_per_km", "float", "1/km", "Miner sum per km after the change; of a bound, its upper end"),
    Column("damage_per_km_low", "float", "1/km", "the damage is at least this"),
    Column("damage_per_km_high", "float", "1/km", "the damage is at most this"),
    Column("life_km_before", "float", "km", "life as assessed"),
    Column("life_km", "float", "km", "life after the change"),
    Column("life_km_low", "float", "km", "the life is at least this"),
    Column("life_km_high", "float", "km", "the life is at most this"),
    Column("life_years", "float", "years", "life_km over km_per_year"),
    Column("utilisation", "float", "-", "damage at the target over its limit, after the change"),
    Column("utilisation_low", "float", "-", "the utilisation is at least this"),
    Column("utilisation_high", "float", "-", "the utilisation is at most this"),
    Column("fulfilled", "flag", "-", "the target is met even at the upper end; empty where that is open"),
    Column("load_factor", "float", "-", "scale on all stresses that just meets the target after the change"),
    Column("load_factor_low", "float", "-", "the load factor is at least this"),
    Column("load_factor_high", "float", "-", "the load factor is at most this"),
)

WHATIF_WELDS = (
    Column("weld", "text", "-", "weld line"),
    Column("curve", "text", "-", "its curve after the change"),
    Column("verdict_before", "text", "-", "meets or misses the target, as assessed"),
    Column("verdict", "text", "-", "meets, misses, or not_proven: points have to be counted again, or a band is open"),
    Column("flips", "flag", "-", "the verdict is another one than before"),
    Column("basis", "text", "-", f"of its worst point: {_BASIS}; recount where a point that may govern has no number"),
    Column("points_to_recount", "int", "-", "toe points that have no number"),
    Column("life_km_before", "float", "km", "life of the worst point as assessed"),
    Column("life_km", "float", "km", "life of the worst point after the change, of those with a number"),
    Column("life_km_low", "float", "km", "the life is at least this; empty where points have no number"),
    Column("life_km_high", "float", "km", "the life is at most this"),
    Column("life_years", "float", "years", "life_km over km_per_year"),
    Column("life_ratio", "float", "-", "life after over life before"),
    Column("utilisation_before", "float", "-", "damage at the target over its limit, as assessed"),
    Column("utilisation", "float", "-", "damage at the target over its limit, after the change"),
    Column("utilisation_low", "float", "-", "the utilisation is at least this"),
    Column("utilisation_high", "float", "-", "the utilisation is at most this; empty where points have no number"),
    Column("load_factor_before", "float", "-", "scale on all stresses that just meets the target, as assessed"),
    Column("load_factor", "float", "-", "the same after the change: the smallest of the toe points that have one"),
    Column("load_factor_low", "float", "-", "the load factor is at least this; empty where points have no number"),
    Column("load_factor_high", "float", "-", "the load factor is at most this"),
    Column("worst_part", "int", "-", "part of the worst point after the change"),
    Column("worst_order", "int", "-", "position of the worst point along the line"),
    Column("worst_node", "int", "-", "node of the worst point"),
    Column("worst_surface", "text", "-", "face of the worst point"),
    Column("worst_moved", "flag", "-", "the worst point is another one than before"),
)

WHATIFS: dict[str, tuple[Column, ...]] = {"whatif": WHATIF, "whatif_welds": WHATIF_WELDS}
