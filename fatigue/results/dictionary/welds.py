"""Columns of ``welds.parquet``: every weld with its worst point, and the lines that are not assessed."""

from fatigue.results.dictionary.column import Column

WELDS = (
    Column("weld", "text", "-", "weld line"),
    Column("status", "text", "-", "assessed, or excluded (not assessed; also candidates)"),
    Column("reason", "text", "-", "why a weld is not assessed"),
    Column("description", "text", "-", "as given"),
    Column("closed", "flag", "-", "the line closes on itself"),
    Column("parts", "int", "-", "straight parts after splitting at kinks"),
    Column("nodes", "int", "-", "nodes on the line"),
    Column("length_mm", "float", "mm", "length of the line"),
    Column("thickness_min_mm", "float", "mm", "smallest plate thickness"),
    Column("thickness_max_mm", "float", "mm", "largest plate thickness"),
    Column("surface", "text", "-", "faces that carry a weld toe"),
    Column("curve", "text", "-", "S-N curve"),
    Column(
        "curve_status",
        "text",
        "-",
        "what the curve rests on: verified, cross-checked (the catalogue), user (entered by the user), unverified",
    ),
    Column("edition", "text", "-", "edition of the source of the curve"),
    Column("survival", "text", "-", "survival level of the curve"),
    Column("end_length_mm", "float", "mm", "length of the end treatment; empty: plate thickness"),
    Column("attachment_mm", "float", "mm", "length of what the weld attaches, along the stress; empty: not given"),
    Column("damage_limit", "float", "-", "largest Miner sum allowed on the curve"),
    Column("life_km", "float", "km", "shortest life of the weld's toe points"),
    Column("life_years", "float", "a", "the same in years"),
    Column("utilisation", "float", "-", "largest utilisation of the weld's toe points"),
    Column("fulfilled", "flag", "-", "every toe point meets the target, and every check that counts ([checks] counts)"),
    Column(
        "load_factor",
        "float",
        "-",
        "smallest load factor of the weld's counted toe points: of the worst one, or of one that comes first to a knee "
        "or to high mean tension",
    ),
    Column(
        "worst_is_proven",
        "flag",
        "-",
        "no other toe point can be worse; else that with the largest estimate was counted, all being proven below the "
        "share of the limit that needs no counting",
    ),
    Column("worst_part", "int", "-", "worst point: part"),
    Column("worst_order", "int", "-", "worst point: position"),
    Column("worst_node", "int", "-", "worst point: FE node"),
    Column("worst_surface", "text", "-", "worst point: face"),
    Column("worst_arc_length_mm", "float", "mm", "worst point: distance along the part"),
    Column("worst_summed_corner", "flag", "-", "worst point: at a kink where the forces of both legs are one sum"),
    Column("governing_event", "text", "-", "event with the largest share of the worst point's damage"),
    Column(
        "worst_check",
        "text",
        "-",
        "check beside the normal stress at the toe with the largest utilisation_stress in checks.parquet; empty where "
        "none is assessed",
    ),
    Column("worst_check_utilisation", "float", "-", "its utilisation_stress: never a damage sum"),
    Column("checks_not_assessed", "int", "-", "rows of checks.parquet that have no verdict"),
    Column("joint_type", "text", "-", "kind of joint, as given"),
    Column("performance_class", "text", "-", "weld performance class, as given"),
    Column("inspection_class", "text", "-", "weld inspection class, as given"),
    Column(
        "stress_utilisation",
        "float",
        "-",
        "largest stress utilisation of the weld: 1 / load_factor of its toe points, or worst_check_utilisation",
    ),
    Column(
        "stress_category",
        "text",
        "-",
        "low, medium or high by stress_utilisation; the limits and their source are in provenance.json",
    ),
)
