"""Columns of the tables that lay results beside each other; A is the reference, B, C ... what is compared with it."""

from fatigue.results.dictionary.column import POINT, Column

_RESULT = Column("result", "text", "-", "letter of the result that is compared with A, see compare_results")
_OTHER = tuple(Column(f"other_{c.name}", c.type, c.unit, f"the same of the point there: {c.meaning}") for c in POINT)
_WELD = Column("weld", "text", "-", "weld line of A")
_OTHER_WELD = Column("other_weld", "text", "-", "weld line there")
_LIVES = (
    Column("life_km", "float", "km", "life in A; infinite where nothing damages"),
    Column("other_life_km", "float", "km", "life there"),
    Column("life_ratio", "float", "-", "other_life_km / life_km; empty where nothing is known"),
    Column("log_life_ratio", "float", "-", "its natural logarithm; 0 where both lives are infinite"),
    Column(
        "basis",
        "text",
        "-",
        "exact; at_least or at_most: the life of one of them is a bound, as is the ratio; unknown: both are, or the "
        "bound says nothing",
    ),
)

COMPARE = (
    _RESULT,
    *POINT,
    *_OTHER,
    Column("toe", "flag", "-", "the face carries a weld toe in A"),
    Column("other_toe", "flag", "-", "the face carries a weld toe there"),
    *_LIVES,
    Column("distance_mm", "float", "mm", "between the two points; lives are never interpolated"),
    Column("comparable", "flag", "-", "they are within half the finer spacing of the two lines there"),
    Column(
        "face",
        "text",
        "-",
        "same or swapped, by the plate normals of both cases; face_assumed: the files no longer tell, faces of one "
        "name are taken for one",
    ),
)

CAUSES = (
    _RESULT,
    Column(
        "scope", "text", "-", "weld: its worst point there over its worst point in A; point: two points at one place"
    ),
    *POINT,
    *_OTHER,
    Column(
        "kind",
        "text",
        "-",
        "limit, event and sequence add up to the log ratio; mission (how often an event occurs) and per_pass (the "
        "damage of a pass) add up to an event that both have; mode and unit_load add up to it, too",
    ),
    Column("event", "text", "-", "event, or sequence of events; empty of a limit"),
    Column("mode", "int", "-", "mode id, of kind mode"),
    Column("unit_load", "text", "-", "name of the unit load, of kind unit_load"),
    Column("value", "float", "see unit", "in A: damage per km, passes per km, damage per pass or damage limit"),
    Column("other_value", "float", "see unit", "the same there"),
    Column("unit", "text", "-", "unit of both"),
    Column("log_life_ratio", "float", "-", "what it adds to ln(other_life_km / life_km): below 0 it costs life"),
)

WELDS = (
    _RESULT,
    _WELD,
    _OTHER_WELD,
    Column("matched_by", "text", "-", "name, map, or geometry (an accepted proposal)"),
    *_LIVES,
    Column("utilisation", "float", "-", "damage at the target over the limit in A"),
    Column("other_utilisation", "float", "-", "the same there, with its own target and limit"),
    Column("fulfilled", "flag", "-", "A meets its target"),
    Column("other_fulfilled", "flag", "-", "the other meets its target"),
    Column("flip", "text", "-", "lost: meets its target in A and misses it there; gained: the reverse; empty: neither"),
    Column("cause_event", "text", "-", "event or sequence that moves the life most the way it went; empty: the limit"),
    Column("cause_log_life_ratio", "float", "-", "what it adds to the log ratio"),
    Column("cause_by", "text", "-", "modes and unit loads that make most of it; empty without a diagnosis of both"),
    Column("why", "text", "-", "the causes in words; empty where nothing changes a life by more than 5 %"),
    Column("curve", "text", "-", "S-N curve in A"),
    Column("other_curve", "text", "-", "S-N curve there"),
    *(Column(c.name, c.type, c.unit, f"worst point of A: {c.meaning}") for c in POINT[1:]),
    *(Column(f"other_{c.name}", c.type, c.unit, f"worst point there: {c.meaning}") for c in POINT[1:]),
    Column("worst_moved", "flag", "-", "the worst point there is not the one that is matched to that of A"),
)

MATCHES = (
    _RESULT,
    _WELD,
    _OTHER_WELD,
    Column(
        "matched_by",
        "text",
        "-",
        "name, map or geometry; proposed: lines that lie on each other and were not accepted; empty: no partner",
    ),
    Column("line_distance_mm", "float", "mm", "largest distance of a point of either line from the other, if proposed"),
    Column("points", "int", "-", "matched points"),
    Column("comparable_points", "int", "-", "of these, within half the finer spacing"),
    Column("swapped_points", "int", "-", "of these, with turned plate normals"),
    Column("largest_distance_mm", "float", "mm", "largest distance between two matched points"),
    Column("other_stations", "int", "-", "stations of the weld there"),
    Column("other_stations_unmatched", "int", "-", "of these, beside no station of A"),
    Column("note", "text", "-", "why there is no partner, or which welds cannot be told apart"),
)

DIFFERENCES = (
    _RESULT,
    Column("what", "text", "-", "curve, rule, key of the mission or file"),
    Column("value", "text", "-", "in A"),
    Column("other_value", "text", "-", "there"),
    Column("sits_in", "text", "-", "kind of cause in which it shows"),
)

RESULTS = (
    Column("result", "text", "-", "letter: A is the reference"),
    Column("folder", "text", "-", "folder, as given"),
    Column("title", "text", "-", "title of its case"),
    Column("hash", "text", "-", "hash of the result"),
    Column("is_diagnosed", "flag", "-", "there is a diagnosis that says what the modes did"),
    Column("welds", "int", "-", "assessed welds"),
    Column("points", "int", "-", "points, both faces"),
    Column("welds_missed", "int", "-", "welds that miss their target"),
    Column("shortest_life_km", "float", "km", "shortest life of its welds"),
    Column("shortest_weld", "text", "-", "the weld with the shortest life"),
    Column("target_km", "float", "km", "target"),
)

COMPARED: dict[str, tuple[Column, ...]] = {
    "compare_results": RESULTS,
    "compare": COMPARE,
    "compare_welds": WELDS,
    "compare_causes": CAUSES,
    "compare_matches": MATCHES,
    "compare_differences": DIFFERENCES,
}
