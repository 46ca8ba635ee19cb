"""Columns of what a study found, written into a folder of its own: variants, runs, numbers, scatter, ratios."""

from fatigue.results.dictionary.column import Column

_VARIANT = Column("variant", "text", "-", "name of the variant; the first one is the base")
_SEED = Column("seed", "int", "-", "seed of the run")
_QUANTITY = (
    Column("quantity", "text", "-", "what the number is; /channel and @event stand behind it"),
    Column("weld", "text", "-", "weld line; empty: the whole run, of lives the worst of all welds"),
)
_UNIT = Column("unit", "text", "-", "unit of the numbers of this row; empty: none")
_REASON = Column("reason", "text", "-", "why a number is empty or infinite")

VARIANTS = (
    _VARIANT,
    Column("setting", "text", "-", "short name of what is varied"),
    Column("keys", "text", "-", "keys of vehicle, case or source that it sets"),
    Column("value", "float", "-", "its value, in the unit that ends the name of its key; empty of a text"),
    Column("text", "text", "-", "its value or its label as it stands in the name of a variant"),
    Column("differs", "flag", "-", "it is not that of the base"),
)

RUNS = (
    _VARIANT,
    _SEED,
    Column("folder", "text", "-", "folder of the run, as seen from that of the study"),
    Column("state", "text", "-", "done, failed or not run"),
    Column("reason", "text", "-", "why it has no numbers"),
)

NUMBERS = (_VARIANT, _SEED, *_QUANTITY, Column("value", "float", "-", "the number"), _UNIT, _REASON)

SCATTER = (
    _VARIANT,
    *_QUANTITY,
    Column("mean", "float", "-", "mean over the seeds; geometric of lives and damage"),
    Column("sd", "float", "-", "standard deviation over the seeds (n - 1); empty of one seed"),
    Column("min", "float", "-", "smallest"),
    Column("max", "float", "-", "largest"),
    Column("n", "int", "-", "seeds with a number above 0 and finite, of other quantities than lives with a finite one"),
    Column("sd_log10", "float", "-", "standard deviation of log10 over the seeds; of lives and damage"),
    _UNIT,
    _REASON,
)

RATIOS = (
    _VARIANT,
    Column("against", "text", "-", "variant it is divided by: all else is equal"),
    Column("changed", "text", "-", "what differs between the two"),
    *_QUANTITY,
    Column("ratio", "float", "-", "mean of the ratios seed by seed; geometric of lives and damage"),
    Column("sd", "float", "-", "standard deviation of these ratios (n - 1); empty of one seed"),
    Column("min", "float", "-", "smallest of these ratios"),
    Column("max", "float", "-", "largest of these ratios"),
    Column("n", "int", "-", "seeds with a ratio"),
    Column("sd_log10", "float", "-", "standard deviation of log10 of the ratios; of lives and damage"),
    Column("agree", "int", "-", "seeds whose ratio is on the same side of 1 as the mean"),
    Column("seeds_above", "text", "-", "seeds with a ratio above 1"),
    Column("seeds_below", "text", "-", "seeds with a ratio below 1"),
    _REASON,
)

STUDY: dict[str, tuple[Column, ...]] = {
    "variants": VARIANTS,
    "runs": RUNS,
    "numbers": NUMBERS,
    "scatter": SCATTER,
    "ratios": RATIOS,
}
