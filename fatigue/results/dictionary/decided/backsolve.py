"""Columns of what just meets a target, written into a folder of its own."""

from fatigue.results.dictionary.column import POINT, Column

BACKSOLVE = (
    Column("question", "text", "-", "load, curve, km_per_year, share:EVENT or thickness"),
    Column("weld", "text", "-", "weld line; empty: the whole body, one answer for all welds"),
    *POINT[1:],
    Column(
        "state",
        "text",
        "-",
        "solved; any: the target is met whatever it is (of thickness: as thin as was looked at); none: nothing of it "
        "meets the target",
    ),
    Column("unit", "text", "-", "unit of the answer and of what stands beside it; - for factors and shares"),
    Column("now", "float", "-", "what it is now, in the unit of the row; 1 of a factor, empty of thickness for a body"),
    Column("answer", "float", "-", "what just meets the target, in the unit of the row; empty unless solved"),
    Column("sense", "text", "-", "at_most or at_least: on which side of the answer the target is met"),
    Column("low", "float", "-", "the answer is at least this: equal to it unless the basis is histogram"),
    Column("high", "float", "-", "the answer is at most this"),
    Column("factor", "float", "-", "answer over now"),
    Column("share_at_least", "float", "-", "of share: smallest share that meets the target; empty where none does"),
    Column("share_at_most", "float", "-", "of share: largest share that meets the target"),
    Column("utilisation_now", "float", "-", "utilisation at the target as it is now"),
    Column("utilisation_at_answer", "float", "-", "the same at the answer, by going forward"),
    Column("deviation", "float", "-", "how far that is from 1"),
    Column("utilisation_at_0", "float", "-", "of share: utilisation at a share of 0"),
    Column("utilisation_at_1", "float", "-", "of share: utilisation at a share of 1"),
    Column(
        "basis",
        "text",
        "-",
        "exact: closed form; histogram: ranges in classes, between low and high; recount: cycles counted again at "
        "every trial",
    ),
    Column("not_monotonic", "flag", "-", "the utilisation rises somewhere as the thickness grows"),
    Column("note", "text", "-", "what is to be known about this answer"),
)

BACKSOLVED: dict[str, tuple[Column, ...]] = {"backsolve": BACKSOLVE}
