"""Columns of bench programmes: cycles of every block, what they achieve at every point, and one cycle of each."""

from fatigue.results.dictionary.column import POINT, Column

_METHOD = Column(
    "method",
    "text",
    "-",
    "least_squares: closest to all targets; cover: every target reached, none exceeded by more than need be",
)
_BLOCK = Column("block", "text", "-", "block of the bench, by its name or its row")

BENCH_BLOCKS = (
    _METHOD,
    _BLOCK,
    Column("cycles", "float", "-", "cycles of the block in the programme; 0: it is not used"),
    Column("whole_cycles", "float", "-", "the same rounded up"),
)

BENCH_POINTS = (
    _METHOD,
    *POINT,
    Column("factor", "float", "-", "factor on the target damage, as asked for"),
    Column("target_damage", "float", "-", "Miner sum of the point at target_km, times its factor"),
    Column("achieved_over_target", "float", "-", "Miner sum of the programme over the target"),
    Column("achieved_over_target_whole", "float", "-", "the same in whole cycles"),
)

BENCH_DAMAGE = (
    *POINT,
    _BLOCK,
    Column("membrane_range_MPa", "float", "MPa", "membrane stress range of a cycle of the block"),
    Column("bending_range_MPa", "float", "MPa", "bending stress range of the cycle"),
    Column("range_MPa", "float", "MPa", "structural stress range of the cycle at the face"),
    Column("bending_ratio", "float", "-", "bending / (membrane + bending) range"),
    Column("equivalent_range_dS", "float", "MPa mm^-0.222", "equivalent range (MPa on curves in structural stress)"),
    Column("damage_per_cycle", "float", "-", "1 / cycles to failure at this range, without mean-stress factor"),
)

BENCHED: dict[str, tuple[Column, ...]] = {
    "bench_blocks": BENCH_BLOCKS,
    "bench_points": BENCH_POINTS,
    "bench_damage": BENCH_DAMAGE,
}
