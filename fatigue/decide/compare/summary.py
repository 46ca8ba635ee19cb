"""What is said of results beside each other, for people and for machines."""

import textwrap
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import pandas as pd

from fatigue.decide.compare.finished import Finished
from fatigue.decide.compare.pairs import Pair
from fatigue.decide.compare.said import notes, sentences
from fatigue.decide.text_lines import aligned
from fatigue.report.wording import life_km
from fatigue.shown import shortened, visible

WIDTH = 110
MOST_WELDS = 20  # in the text
MOST_DIFFERENCES = 20


@dataclass(frozen=True, slots=True, eq=False)
class Comparison:
    """Results beside the first of them, a pair each; ``written`` are the files."""

    results: tuple[Finished, ...]
    pairs: tuple[Pair, ...]
    written: tuple[str, ...] = ()

    def as_record(self) -> dict[str, Any]:
        """Record for machines: results, and for each of the others sentences, differences, welds and partners."""
        return {
            "results": _records(result_rows(self.results)),
            "compared": [
                {
                    "result": pair.other.letter,
                    "said": list(sentences(pair)),
                    "notes": list(notes(pair)),
                    "differences": [asdict(one) for one in pair.differences],
                    "welds": _records(pair.welds),
                    "matches": _records(match_rows(pair)),
                }
                for pair in self.pairs
            ],
            "written": list(self.written),
        }

    def as_text(self) -> str:
        """Text for people: results, what differs, the welds from the largest loss to the largest gain."""
        lines = [f"{one.letter}  {one.folder}: {shortened(str(one.record['title']))}" for one in self.results]
        parts = ["\n".join(lines), *(part for pair in self.pairs for part in _of_pair(pair))]
        if self.written:
            parts.append(f"written: {', '.join(self.written)}")
        return visible("\n\n".join(parts), keep="\n")


def _of_pair(pair: Pair) -> list[str]:
    head = f"{pair.other.letter} against A"
    shown = pair.differences[:MOST_DIFFERENCES]
    more = f"  and {len(pair.differences) - len(shown)} more" if len(pair.differences) > len(shown) else ""
    differ = [f"  {one.what}: {one.value} -> {one.other_value} (in {one.sits_in})" for one in shown]
    parts = [
        "\n".join([f"{head}: what else differs", *(differ or ["  nothing on record"]), *[more] * bool(more)]),
        "\n".join([head, *(_indented(one) for one in sentences(pair))]),
    ]
    if len(pair.welds):
        parts.append(_ranking(pair))
    if said := [_indented(f"- {one}", "    ") for one in notes(pair)]:
        parts.append("\n".join(said))
    return parts


def _ranking(pair: Pair) -> str:
    """Welds from the largest loss to the largest gain; of many those at both ends."""
    welds = pair.welds
    if len(welds) > MOST_WELDS:
        welds = pd.concat([welds.head(MOST_WELDS // 2), welds.tail(MOST_WELDS // 2)])
    rows = [
        (
            shortened(str(row.weld), 34),
            life_km(row.life_km),
            life_km(row.other_life_km),
            f"x {row.life_ratio:.3g}" + {"at_least": " or more", "at_most": " or less"}.get(row.basis, ""),
            {"lost": "MISSES NOW", "gained": "meets now", "": "" if row.fulfilled else "misses"}[row.flip],
            (row.cause_event or "") if row.why else "",
        )
        for row in welds.itertuples(index=False)
    ]
    head = ("weld", "life in A", f"life in {pair.other.letter}", "ratio", "target", "largest cause")
    left = len(pair.welds) - len(welds)
    return "\n".join([*aligned([head, *rows], right=()), *[f"  and {left} welds between"] * bool(left)])


def _indented(sentence: str, then: str = "  ") -> str:
    return textwrap.fill(sentence, WIDTH, initial_indent="  ", subsequent_indent=then)


def result_rows(results: Sequence[Finished]) -> pd.DataFrame:
    """Rows of ``compare_results``."""
    rows = []
    for one in results:
        shortest = one.welds.sort_values("life_km").head(1)
        rows.append(
            {
                "result": one.letter,
                "folder": str(one.folder),
                "title": str(one.record["title"]),
                "hash": str(one.record.get("result", "")),
                "is_diagnosed": one.is_diagnosed,
                "welds": len(one.welds),
                "points": len(one.points),
                "welds_missed": int((~one.welds["fulfilled"]).sum()),
                "shortest_life_km": shortest["life_km"].iloc[0] if len(shortest) else None,
                "shortest_weld": shortest.index[0] if len(shortest) else None,
                "target_km": float(one.record["mission"]["target_km"]),
            }
        )
    return pd.DataFrame(rows)


def match_rows(pair: Pair) -> pd.DataFrame:
    """Rows of ``compare_matches``: every weld of either result, and its partner if it has one."""
    of_points = pair.points.assign(
        swapped=pair.points["face"] == "swapped"
    ).groupby("weld", sort=False).agg(
        points=("weld", "size"),
        comparable_points=("comparable", "sum"),
        swapped_points=("swapped", "sum"),
        largest_distance_mm=("distance_mm", "max"),
    )  # fmt: skip
    matched, result = pair.matched, pair.other.letter
    rows = []
    for weld, other in matched.other.items():
        here = of_points.loc[weld]
        stations, alone = pair.unmatched_stations[other]
        rows.append(
            {
                "weld": weld,
                "other_weld": other,
                "matched_by": matched.by[weld],
                "line_distance_mm": matched.distance_mm.get(weld),
                **{name: here[name] for name in of_points.columns},
                "other_stations": stations,
                "other_stations_unmatched": alone,
                "note": "",
            }
        )
    for one in matched.proposed:
        note = f"as well: {', '.join(one.others)}" if one.others else "take it with --accept-proposed"
        names = {"weld": one.weld, "other_weld": one.other_weld, "matched_by": "proposed"}
        rows.append({**names, "line_distance_mm": one.distance_mm, "note": note})
    proposed = {one.weld for one in matched.proposed}, {one.other_weld for one in matched.proposed}
    for name, some, skip, out in (
        ("weld", matched.only_first, proposed[0], pair.other.left_out),
        ("other_weld", matched.only_other, proposed[1], pair.first.left_out),
    ):
        for weld in (weld for weld in some if weld not in skip):
            note = f"listed and not assessed: {out[weld] or 'no reason given'}" if weld in out else "no partner"
            rows.append({name: weld, "matched_by": "", "note": note})
    columns = [
        "weld", "other_weld", "matched_by", "line_distance_mm", "points", "comparable_points", "swapped_points",
        "largest_distance_mm", "other_stations", "other_stations_unmatched", "note",
    ]  # fmt: skip
    table = pd.DataFrame(rows, columns=columns).assign(result=result)
    whole = ["points", "comparable_points", "swapped_points", "other_stations", "other_stations_unmatched"]
    return table.astype(dict.fromkeys(whole, "Int64"))


def _records(table: pd.DataFrame) -> list[dict[str, Any]]:
    """Rows for machines; what is missing is None."""
    found: list[dict[str, Any]] = table.astype(object).where(table.notna(), None).to_dict("records")
    return found
