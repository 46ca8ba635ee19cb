"""Columns of ``sensitivity.parquet``: every weld under other assumptions than those of the case, one at a time."""

from fatigue.results.dictionary.column import POINT, Column

VARIANTS: dict[str, str] = {
    "shear_path_range": "shear at the toe counted with the normal stress, by the range of their common path",
    "shear_asme": "shear combined with the normal stress by the ASME factor (VIII-2 5.5.5.3)",
    "raw_end": "weld ends as they were solved, without the end treatment",
    "asme_thickness": "thickness in dS at least 16 mm and at most 150 mm (ASME VIII-2)",
    "survival_3sigma": "curve at mean - 3 sigma",
    "haibach_1e7": "flatter slope 2 k - 1 beyond 1e7 cycles (Haibach)",
    "no_knee": "first slope of the curve for all cycles, without the knee or cut-off of the case",
    "upsample_1": "records counted as they are sampled (upsample = 1)",
    "upsample_auto": 'records upsampled to 20 samples per peak (upsample = "auto")',
    "damage_limit_0.5": "damage sum of 0.5 allowed",
}
"""What each variant changes, in words, in the order in which they are shown."""

EXACT, RECOUNT, BOUND, AS_ASSESSED, UNDECIDED = "exact", "recount", "bound", "as assessed", "undecided"
COUNTED = "counted"
BASES = (EXACT, RECOUNT, BOUND, AS_ASSESSED, UNDECIDED, COUNTED)

SENSITIVITY = (
    Column("variant", "text", "-", f"what is changed: {', '.join(VARIANTS)}"),
    *POINT[:1],
    Column("part", "int", "-", "point that decides under the variant: part; empty where only a bound is known"),
    Column("node", "int", "-", "point that decides: FE node"),
    Column("order", "int", "-", "point that decides: position along the weld line"),
    Column("surface", "text", "-", "point that decides: top or bottom face"),
    Column(
        "utilisation",
        "float",
        "-",
        "largest utilisation of the weld's toe points under the variant; with basis bound at most this where the "
        "target is met and at least this where it is not; with basis undecided or counted at least this",
    ),
    Column("fulfilled", "flag", "-", "the target is met under the variant; empty where that is undecided"),
    Column("flips", "flag", "-", "the verdict is another one than that of the assessment"),
    Column(
        "basis",
        "text",
        "-",
        "exact: closed form at every toe point; recount: counted again at every point that may be the worst; bound: "
        "enough for the verdict; counted: the largest of the points that were counted, all others being proven to meet "
        "the target; as assessed: nothing changes; undecided",
    ),
    Column("recounted", "int", "-", "stations of the weld whose cycles were counted again"),
    Column("note", "text", "-", "why nothing changes, or what limits the number"),
)
