"""The tables of a result, written group of welds by group as they come."""

from collections.abc import Generator, Mapping, Sequence
from contextlib import closing
from pathlib import Path

from fatigue.pipeline.checks.group import has_checks
from fatigue.pipeline.checks.rows import CheckRows, joined
from fatigue.pipeline.checks.verdict import verdicts
from fatigue.pipeline.count.worst import WorstPoint, histogram_points, worst_points
from fatigue.pipeline.life_band.points import band_points
from fatigue.pipeline.life_band.rows import BandRows
from fatigue.pipeline.run.work import Work
from fatigue.pipeline.run.workers import Group
from fatigue.pipeline.tables.checks import check_table_rows
from fatigue.pipeline.tables.cycle_rows import KeptPoint, kept_point
from fatigue.pipeline.tables.cycles import cycle_writer
from fatigue.pipeline.tables.histogram import BinnedPoint, histogram_writer
from fatigue.pipeline.tables.path_cycles import kept_paths, path_writer
from fatigue.pipeline.tables.register import excluded_rows, weld_rows
from fatigue.pipeline.tables.rows import damage_rows, node_rows, stress_rows
from fatigue.pipeline.tables.sensitivity import sensitivity_rows
from fatigue.pipeline.tables.tally import Tally
from fatigue.readers.neutral.spare_memory import give_back
from fatigue.results import (
    ASSESSED,
    TableWriter,
    result_tables,
)

ROWS_AT_ONCE = 512  # stations whose rows are made at a time, as many for each as there are events or modes


def write_tables(
    folder: Path,
    key: str,
    assessed: Generator[Group],
    work: Work,
    apart: CheckRows,
    done: Tally,
    threads: int | None,
) -> None:
    """Write the tables of a result, group of welds by group as they come, and count in ``done`` what was written.

    ``apart`` are the checks at stress points, which belong to no group.
    """
    body = work.groups.body
    wants_histograms, wants_checks = work.histogram != "none", has_checks(body.case)
    optional = {
        "histogram": wants_histograms,
        "band": wants_histograms,
        "checks": wants_checks,
        "path_cycles": work.shear is not None,
    }
    wanted = [*ASSESSED, "sensitivity", *(table for table, is_wanted in optional.items() if is_wanted)]
    with result_tables(folder, key, wanted) as tables, closing(assessed):
        cycles = cycle_writer(tables["cycles"], work.loads, work.plan)
        bands = BandRows(tables["band"], work.loads, work.plan, body.case.life_band) if wants_histograms else None
        histograms = bands and histogram_writer(tables["histogram"], bands, work.loads, work.plan, threads)
        paths = path_writer(tables["path_cycles"], work.loads, work.shear.beta) if work.shear else None
        done.checks.add(apart, body.case.checks.counts)
        for group in assessed:
            worst = write_group(tables, group, work, apart)
            cycles.add(points_kept_of(worst, group, work))
            if histograms:
                histograms.add(points_binned_of(worst, group, work))
            if paths:
                paths.add(kept_paths(group, everything=work.counts_all_paths))
            done.add(group, work, worst)
            del group  # not to be held until the next one is there
            give_back()
        cycles.flush()
        if histograms:
            histograms.flush()
        if bands:
            bands.flush()
        if paths:
            paths.flush()
        if wants_checks:
            tables["checks"].write(check_table_rows(apart, body.curves, body.compared.lines))
        tables["welds"].write(excluded_rows(body.excluded))


def write_group(
    tables: Mapping[str, TableWriter], group: Group, work: Work, apart: CheckRows
) -> tuple[WorstPoint, ...]:
    """Write the rows of a group of welds to the tables, cycles left out, and return the worst point of each weld.

    ``apart`` are checks at points that are written elsewhere; those that name a weld belong to its verdict.
    """
    model, result, plan = group.model, group.result, work.plan
    stations, worst = model.stations, worst_points(model.stations, result)
    statuses = [rated.curve.status for rated in model.curve_of_weld]
    tables["nodes"].write(node_rows(stations, result, plan, statuses))
    for first in range(0, len(stations), ROWS_AT_ONCE):
        some = slice(first, first + ROWS_AT_ONCE)
        tables["damage"].write(damage_rows(stations, result, plan, some))
        tables["structural_stress"].write(stress_rows(stations, model.body.coordinates, some))
    of_checks = None
    if "checks" in tables:
        tables["checks"].write(check_table_rows(result.checks, model.body.curves, model.body.compared.lines))
        of_checks = verdicts(joined([result.checks, apart]), stations.names, model.case.checks.counts)
    tables["welds"].write(weld_rows(model, plan, result, worst, of_checks))
    tables["sensitivity"].write(sensitivity_rows(model, result, worst, work.sampling))
    return worst


def points_binned_of(worst: Sequence[WorstPoint], group: Group, work: Work) -> list[BinnedPoint]:
    """The points of a group whose histograms and bands are kept."""
    model, result = group.model, group.result
    binned = histogram_points(model.stations, result, worst, everything=work.histogram == "all")
    with_lines = model.case.life_band.reference_length_mm is not None
    bands = band_points(model, result, binned, work.plan, with_lines=with_lines)
    return [BinnedPoint(kept_point(model, point), band) for point, band in zip(binned, bands, strict=True)]


def points_kept_of(worst: Sequence[WorstPoint], group: Group, work: Work) -> list[KeptPoint]:
    """The worst points of a group whose cycles go into ``cycles.parquet``."""
    used_up = group.result.mission.utilisation
    return [kept_point(group.model, p) for p in worst if used_up[p.station, p.face] >= work.kept_from]
