"""What the command line prints of a result folder: the verdict, the welds and the worst points."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from numbers import Integral
from pathlib import Path
from typing import Any

import pandas as pd

from fatigue.errors import CaseError, DataError, Problem, given_names, given_path
from fatigue.results.belonging import refuse_mixed
from fatigue.results.beside.checks import BesideToe, read_beside_toe
from fatigue.results.beside.life_band import (
    POINT,
    REASONS,
    SHORT_REASONS,
    WHAT_IT_IS_NOT,
    BandOfPoint,
    Bands,
    read_bands,
    worst_of,
)
from fatigue.results.beside.sensitivity import Sensitivity, in_words, read_sensitivity
from fatigue.results.dictionary.sensitivity import VARIANTS
from fatigue.results.provenance import curves_of_status, read_provenance
from fatigue.results.rows import read_rows, worst_toes
from fatigue.results.weld_table import assessed, not_assessed, read_welds
from fatigue.shown import few, shortened, visible
from fatigue.shown.digits import MILLION, as_given, in_millions, lives, results

LONGEST_LIFE_KM = 1e12  # printed as "> 1e12 km"
MOST_WELDS = 200  # printed: a train has thousands
MOST_LEFT_OUT = 20  # printed one by one
MOST_BANDS = 20  # printed: of the welds with the shortest lives
UNCUT = ("reason",)  # columns; one long name in another would push all that follow off the screen

_POINT_COLUMNS = (
    "weld", "part", "node", "order", "surface", "arc_length_mm", "life_km", "life_years", "utilisation",
    "fulfilled", "load_factor", "life_km_dirlik", "dirlik_ratio", "dirlik_verdict", "governing_event", "max_range_MPa",
    "bending_ratio", "at_end", "at_corner", "summed_corner",
)  # fmt: skip


_WELD_COLUMNS = ("weld", "life_km", "life_years", "utilisation", "load_factor", "node", "face", "governing_event")
_LIFE_COLUMNS = ("life_km", "life_years", "life_km_dirlik", "50_percent_km", "90_percent_km")

_ACROSS = {
    "damage_per_km_transitions": "Cycles across the events of the sequences are",
    "damage_per_km_transitions_bound": "Cycles across events, in an order that is not known, would be at most",
}


@dataclass(frozen=True, slots=True, eq=False)
class Summary:
    """The welds, worst first, those not assessed with their reasons, and the worst toe points of a result."""

    title: str
    assumptions: str
    target_km: float
    welds: pd.DataFrame
    not_assessed: pd.DataFrame
    points: pd.DataFrame
    unverified_curves: tuple[str, ...] = ()
    sensitivity: Sensitivity | None = None
    beside_toe: BesideToe | None = None
    bands: Bands | None = None

    @property
    def fulfilled(self) -> bool:
        """Whether every weld shown meets its target."""
        return bool(self.welds["fulfilled"].all())

    def as_record(self) -> dict[str, Any]:
        """Record for machines, where an infinite life is written as null."""
        return {
            "title": self.title,
            "assumptions": self.assumptions,
            "target_km": self.target_km,
            "fulfilled": self.fulfilled,
            "unverified_curves": list(self.unverified_curves),
            "welds": self._with_bands(self.welds, "worst_"),
            "not_assessed": self.not_assessed.to_dict("records"),
            "points": self._with_bands(self.points),
            **({} if self.beside_toe is None else self.beside_toe.as_record()),
            "sensitivity": None if self.sensitivity is None else self.sensitivity.as_record(),
        }

    def as_text(self) -> str:
        """Text for people: units in every heading, one notation down a column, three digits, no infinities."""
        missed = int((~self.welds["fulfilled"]).sum())
        verdict = (
            "every weld meets its target" if not missed else f"{missed} of {len(self.welds)} welds miss their target"
        )
        welds = self.welds.head(MOST_WELDS).rename(columns={"worst_node": "node", "worst_surface": "face"})
        others = len(self.welds) - len(welds)
        return "\n".join(
            [
                f"{visible(self.title)}: {verdict} of {_km(self.target_km)}",
                self.assumptions,
                *self._unverified(),
                "",
                _text_table(
                    welds,
                    [*_WELD_COLUMNS, *(["curve_status"] if self.unverified_curves else [])],
                ),
                *([f"and {others} welds with a longer life, see welds.parquet"] if others else []),
                *self._in_bands(),
                *self._at_summed_corners(),
                *self._left_out(),
                *([] if self.beside_toe is None else self.beside_toe.as_lines(_cell)),
                *self._otherwise(),
                "",
                "The worst point" if len(self.points) == 1 else f"The {len(self.points)} worst points",
                _text_table(
                    self.points.rename(columns={"surface": "face"}),
                    [
                        "weld",
                        "node",
                        "face",
                        "arc_length_mm",
                        "life_km",
                        "utilisation",
                        "life_km_dirlik",
                        "dirlik_ratio",
                        "governing_event",
                    ],
                ),
                *self._across_events(),
                *self._outside_band(),
            ]
        )

    def _unverified(self) -> list[str]:
        """Say which curves nobody has compared with their source, and which of the welds rest on them."""
        if not self.unverified_curves:
            return []
        welds = self.welds.loc[self.welds["curve"].isin(self.unverified_curves), "weld"].tolist()
        named = f": {few(welds)}" if welds else ""
        curves = ", ".join(self.unverified_curves)
        return [f"Unverified: {curves}; {len(welds)} of {len(self.welds)} welds have their lives from them{named}"]

    def _at_summed_corners(self) -> list[str]:
        """Say which welds are judged by a corner where the stress has no bound."""
        names = self.welds.loc[self.welds["worst_summed_corner"].astype(bool), "weld"].tolist()
        if not names:
            return []
        what = "whose nodal forces are one sum of both legs, so the life there is not bounded"
        return ["", f"Worst at a corner {what}: {few(names, MOST_LEFT_OUT)}"]

    def _otherwise(self) -> list[str]:
        """Say which welds change their verdict under which other assumptions."""
        found = self.sensitivity
        if found is None:
            return []
        lines = [""]
        if found.flipping:
            lines += ["Verdict under other assumptions, utilisation (* the verdict changes)", *_flipping(found)]
        for words, names in (
            ("No verdict changes under", found.steady),
            ("As assessed", [f"{name} ({why})" for name, why in found.own.items()]),
            ("Not decided for some welds under", [f"{n} ({len(rows)})" for n, rows in found.undecided.items()]),
        ):
            lines += [f"{words}: {', '.join(names)}"] if names else []
        return lines

    def _with_bands(self, rows: pd.DataFrame, prefix: str = "") -> list[dict[Any, Any]]:
        """Records of welds or points, with the band of the life of each; null where it has none."""
        records: list[dict[Any, Any]] = rows.to_dict("records")
        if self.bands is None:
            return records
        found = self.bands.of_points(rows, prefix)
        return [
            row | {"band": None if band is None else band.as_record()} for row, band in zip(records, found, strict=True)
        ]

    def _in_bands(self) -> list[str]:
        """How sure the lives of the welds are, and what that does not say."""
        if self.bands is None or self.welds.empty:
            return []
        shown = self.welds.head(MOST_BANDS)
        found = self.bands.of_points(shown, "worst_")
        table = {"weld": shown["weld"].tolist(), "life_km": shown["life_km"].tolist()}
        name, scale = "90_percent_band_of_load_km", 1.0
        if in_millions(end for band in found if band is not None for end in (band.low_km, band.high_km)):
            name, scale = _in_millions(name), MILLION
        table[name] = [_band(band, scale) for band in found]
        for share, column in (("50_percent_km", "life_km_p50"), ("90_percent_km", "life_km_p90")):
            table[share] = [math.nan if band is None else band.lives_km[column] for band in found]
        has_lives = any(band is not None and band.has_lives for band in found)
        columns = list(table) if has_lives else list(table)[:3]
        of_line = [math.nan if band is None else band.line_survival for band in found]
        if not all(map(math.isnan, of_line)):
            table["line_survival_at_target"] = of_line
            columns.append("line_survival_at_target")
        reasons = dict.fromkeys(band.reason for band in found if band is not None and band.reason)
        others = len(self.welds) - len(shown)
        return [
            "",
            "How sure the lives are: the band of another record"
            + ("; lives that a share reaches, by record, S-N curve and damage sum" if has_lives else ""),
            _text_table(pd.DataFrame(table), columns),
            *([f"and {others} others, see band.parquet"] if others else []),
            *(f"{SHORT_REASONS[reason]}: {REASONS[reason]}" for reason in reasons),
            WHAT_IT_IS_NOT,
        ]

    def _across_events(self) -> list[str]:
        """Say what cycles across events are of the damage of the points, or may be."""
        for name, what in _ACROSS.items():
            if name in self.points:
                share = 100.0 * (self.points[name] / self.points["damage_per_km"]).astype(float)
                if share.notna().any():
                    return [f"{what} {_range(share.min(), share.max())} of the damage of these points"]
        return []

    def _outside_band(self) -> list[str]:
        """Say why Dirlik has no life for some points, or one that is too long."""
        outside = self.points["dirlik_verdict"] == "outside_band"
        if not outside.any():
            return []
        where = "" if outside.all() else f" at {outside.sum()} of them"
        none = bool(self.points.loc[outside, "life_km_dirlik"].isna().all())
        what = "no life by Dirlik" if none else "no trust in Dirlik"
        return [f"{what}{where}: the spectra miss too much of the stress (outside_band), see the warnings"]

    def _left_out(self) -> list[str]:
        """Say which welds are not assessed, and why; of many, every kind of reason with its number."""
        if self.not_assessed.empty:
            return []
        head = ["", f"Not assessed: {len(self.not_assessed)} weld{'s' * (len(self.not_assessed) != 1)}"]
        if len(self.not_assessed) <= MOST_LEFT_OUT:
            return [*head, _text_table(self.not_assessed, ["weld", "reason"])]
        kind = self.not_assessed["reason"].str.replace(r"\d+", "0", regex=True)
        kinds = self.not_assessed.groupby(kind, sort=False).agg(
            welds=("weld", "size"), first=("weld", "first"), reason=("reason", "first")
        )
        kinds = kinds.sort_values("welds", ascending=False, kind="stable")
        return [*head, _text_table(kinds, ["welds", "first", "reason"]), "all of them are in welds.parquet"]


def result_summary(folder: Path | str, *, top: int = 10, only: Sequence[str] = ()) -> Summary:
    """Summary of a result folder with its ``top`` worst points, of all welds or ``only`` some.

    Raises
    ------
    DataError : no finished result there, tables of different results, or no such weld in it
    CaseError : ``top`` is no number of points, or ``only`` are no names
    """
    if not (isinstance(top, Integral) and top >= 1):
        raise CaseError(Problem("argument", "top", f"{top!r} is no number of points", "Give a whole number from 1 on"))
    folder, only = given_path(folder, "folder"), given_names(only, "only")
    record = read_provenance(folder)
    refuse_mixed(folder, record, ("nodes", "welds", "sensitivity", "checks", "band"))
    every = read_welds(folder)
    welds, left_out = assessed(every), not_assessed(every)
    unknown = sorted(set(only) - set(welds["weld"]))
    if unknown:
        for row in left_out[left_out["weld"] == unknown[0]].itertuples():
            what = f"weld '{row.weld}' is not assessed: {row.reason}"
            raise DataError(Problem("not_assessed", str(folder), what, "Change its status in the weld register"))
        names = ", ".join(sorted(welds["weld"])[:MOST_WELDS])
        raise DataError(Problem("unknown_weld", str(folder), f"there is no weld '{unknown[0]}'", f"Choose of {names}"))
    across = ("damage_per_km", *_ACROSS) if _joins_events(record) else ()
    sensitivity = read_sensitivity(folder, welds)
    points = read_rows(folder, "nodes", worst_toes(folder, top, only), [*_POINT_COLUMNS, *across]).to_pandas()
    if only:
        sensitivity = None if sensitivity is None else sensitivity.of_welds(only)
        welds, left_out = welds[welds["weld"].isin(only)], left_out[:0]
    beside_toe = read_beside_toe(folder, set(welds["weld"]), every=not only)
    return Summary(
        title=record["title"],
        assumptions=assumptions(record),
        target_km=record["mission"]["target_km"],
        welds=welds,
        not_assessed=left_out,
        points=points,
        unverified_curves=tuple(curves_of_status(record, "unverified")),
        sensitivity=sensitivity,
        beside_toe=beside_toe,
        bands=read_bands(folder, pd.concat([worst_of(welds), points[list(POINT)]])),
    )


def assumptions(record: dict[str, Any]) -> str:
    """One line that no result is shown without: curve, survival, thickness rule, extension, mean stress."""
    rules = record["rules"]
    curves = ", ".join(f"{name} ({survival})" for name, survival in rules["survival"].items())
    extension = (
        "no knee" if rules["extension"] == "none" else f"{rules['extension']} at {rules['knee_cycles']:g} cycles"
    )
    screening = rules["screening"]
    screened = "" if screening["share_of_limit"] == 0.0 else f"; points proven below {screening['share_of_limit']:g} "
    loops = len(record["mission"].get("sequences", []))
    sequences = f"; cycles across the events of {loops} sequence{'s' * (loops != 1)}" * (loops > 0)
    common = record["mission"]["damage_limit"]
    limits = {name: curve["used"].get("damage_limit", common) for name, curve in record.get("curves", {}).items()}
    others = "".join(f", {limit:g} on {name}" for name, limit in limits.items() if limit != common)
    return (
        f"Curve {curves}; thickness {rules['thickness_rule']}; {extension}; mean stress {rules['mean_stress']}; "
        f"damage limit {common:g}{others}{screened and screened + 'of it have bounds only'}"
        f"{sequences}"
    )


def _flipping(found: Sensitivity) -> list[str]:
    """Table of the welds whose verdict changes, one column a variant under which any does, and what these mean."""
    welds, variants = found.flipping[:MOST_LEFT_OUT], found.changing
    table: dict[str, list[str]] = {"weld": welds, "as assessed": [_result(float(found.assessed[w])) for w in welds]}
    for name in variants:
        rows = found.under(name).loc[welds]
        table[name] = [
            in_words(row.utilisation, row.basis, row.fulfilled, _result) + "*" * bool(row.flips)
            for row in rows.itertuples()
        ]
    others = len(found.flipping) - len(welds)
    return [
        _text_table(pd.DataFrame(table), list(table)),
        *([f"and {others} others, see sensitivity.parquet"] if others else []),
        *(f"{name}: {VARIANTS[name]}" for name in variants),
    ]


def _result(value: float) -> str:
    """A number that was computed, alone."""
    return results([value], "")[0].replace("−", "-").replace("–", "-")


def _joins_events(record: dict[str, Any]) -> bool:
    """Whether cycles across events are counted, or bounded because their order is not known."""
    mission = record["mission"]
    return bool(mission.get("sequences")) or any(e.get("stints_per_1000_km") is not None for e in mission["events"])


def _band(found: BandOfPoint | None, scale: float) -> str:
    """Band of a life by the load in a cell, in ``scale`` km, or why there is none."""
    if found is None:
        return "-"
    said = SHORT_REASONS.get(found.reason, "")
    if not found.has_band:
        return said
    return f"{said} {' to '.join(results([found.low_km / scale, found.high_km / scale], ''))}".strip()


def _range(low: float, high: float) -> str:
    """Two percentages, or one where they look the same."""
    return f"{low:.3g} %" if f"{low:.3g}" == f"{high:.3g}" else f"{low:.3g} to {high:.3g} %"


def _text_table(frame: pd.DataFrame, columns: Sequence[str]) -> str:
    columned = [_column(name, frame[name]) for name in columns]
    cells = [[heading for heading, _ in columned], *zip(*(texts for _, texts in columned), strict=True)]
    widths = [max(len(row[i]) for row in cells) for i in range(len(columns))]
    numeric = [pd.api.types.is_numeric_dtype(frame[name]) for name in columns]
    return "\n".join(
        "  ".join(c.rjust(w) if n else c.ljust(w) for c, w, n in zip(row, widths, numeric, strict=True)).rstrip()
        for row in cells
    )


def _column(name: str, values: "pd.Series[Any]") -> tuple[str, list[str]]:
    """Heading and cells of a column, numbers in one unit and one notation; see ``fatigue.shown.digits``."""
    if not pd.api.types.is_float_dtype(values):
        return name, [_cell(value) if name in UNCUT else shortened(_cell(value)) for value in values]
    numbers = values.to_numpy(dtype=float, na_value=math.nan).tolist()
    if name not in _LIFE_COLUMNS or name.endswith("_years"):
        texts = as_given(numbers, "") if name.endswith("_mm") else results(numbers, "")
    else:
        texts, unit = lives(numbers, "")
        name = name if unit == "km" else _in_millions(name)
    return name, [text.replace("−", "-").replace("–", "-") for text in texts]


def _in_millions(name: str) -> str:
    """Name of a column of lives in millions of km."""
    head, _, tail = name.rpartition("_km")
    return f"{head}_million_km{tail}"


def _cell(value: Any) -> str:
    if value is None or pd.isna(value):
        return "-"
    if isinstance(value, float):
        if value > LONGEST_LIFE_KM:
            return "> 1e12"
        return f"{value:.4g}"
    return visible(" ".join(str(value).splitlines()))  # a cell of a spreadsheet may hold several


def _km(value: float) -> str:
    return f"{value:.4g} km"
