"""The mission in numbers: how long each record is and how often it is passed, once every record has been checked."""

from pathlib import Path

from fatigue.case import Case, Event, check_distance, event_length_km
from fatigue.errors import CaseError, DataError, FatigueError, Problem, refuse
from fatigue.life.mission import Pass, Plan
from fatigue.life.records.history import first_kept
from fatigue.pipeline.mission.events import top_mode_hz
from fatigue.pipeline.mission.loops import plan_loops
from fatigue.pipeline.mission.record_units import step_problems, step_warnings
from fatigue.pipeline.mission.record_warnings import CheckedEvent, record_warnings
from fatigue.pipeline.mission.unit_loads import event_files, unused_load_warnings
from fatigue.pipeline.solve.body import Body
from fatigue.readers.neutral.event.event_record import check_event
from fatigue.readers.neutral.history import TimeGrid
from fatigue.readers.neutral.record_outline import RecordOutline
from fatigue.side_by_side import in_order
from fatigue.spectrum.moments import FREQUENCY_TOLERANCE, default_upper_hz, samples_per_segment, segment_count

FEW_SEGMENTS = 8  # below, the spectrum is an estimate from too little
FEW_LINES = 8  # above 0 Hz; a line under the Hann window is four wide


def mission_plan(body: Body, threads: int | None = None) -> tuple[Plan, tuple[Problem, ...]]:
    """The mission in numbers, and the warnings about its records, each of which is read and checked.

    The records are read on some threads, by default one per processor core, and a column of each is in memory.
    """
    mission = body.case.mission
    warnings: list[Problem] = []
    problems: list[Problem] = []
    passes: list[Pass] = []
    records: list[CheckedEvent] = []
    for checked in in_order(lambda event: _checked(body, event), mission.event, threads):
        if isinstance(checked, FatigueError):
            problems += checked.problems
        else:
            passes.append(checked[0])
            warnings += checked[1]
            records.append(checked[2])
    refuse(DataError, problems)
    warnings += record_warnings(records, body.coordinates, body.case.path.name)
    warnings += unused_load_warnings(body.case.path.name, [record.loads for record in records])
    loops = plan_loops(body.case, passes)
    plan = Plan(tuple(passes), mission.target_km, mission.km_per_year, mission.damage_limit, loops)
    return plan, tuple(warnings)


def _checked(body: Body, event: Event) -> tuple[Pass, list[Problem], CheckedEvent] | FatigueError:
    """The passes of an event, the warnings about its record and the record, or what is wrong with the record."""
    case = body.case
    outline = RecordOutline(event.start_s)
    try:
        files = event_files(body, event)
        checked = check_event(files, outline)
        grid, warnings = checked.grid, checked.warnings
        name = case.path.name if files.path is None else files.path.name
        if files.path is not None:
            refuse(DataError, step_problems(grid, body.modes, name, event.name))
        samples = _kept_samples(case, event, grid)
    except FatigueError as error:
        return error
    one = Pass(
        event=event.name,
        samples=samples,
        length=event_length_km(event, samples * grid.step),
        share=event.share,
        per_1000_km=event.per_1000_km,
        refined=checked.refined,
        half=case.residue(event) == "half",
        stints_per_1000_km=event.stints_per_1000_km,
    )
    if files.path is not None:
        warnings += step_warnings(grid, body.modes, name, event.name)
        warnings += _spectrum_warnings(body, event, samples, grid.step)
    return one, warnings, CheckedEvent(event, name, grid, outline, files.loads)


def _kept_samples(case: Case, event: Event, grid: TimeGrid) -> int:
    """Number of samples behind the start-up of a record, whose length is checked."""
    where = f"{case.path.name}: mission.event '{event.name}'"
    samples = max(0, grid.samples - first_kept(grid.step, event.start_s))
    if samples < 2:
        file = Path(event.history or "").name
        raise CaseError(
            Problem(
                "short_record",
                f"{where}: start_s",
                f"start_s = {event.start_s:g} leaves {samples} samples of {file}, which "
                f"lasts {grid.samples * grid.step:g} s",
                "Cut less, or record longer",
            )
        )
    check_distance(event, samples * grid.step, where)
    return samples


def _spectrum_warnings(body: Body, event: Event, samples: int, step: float) -> list[Problem]:
    where = f"event '{event.name}'"
    segment_s = body.case.spectrum.segment_s
    segments = segment_count(samples, step, segment_s)
    if segments == 0:
        return [
            Problem(
                "no_spectrum",
                where,
                f"the record of {samples * step:g} s has no spectral segment of {segment_s:g} s (at least four "
                "samples), so there is no frequency-domain estimate",
                "Record longer or shorten segment_s if you need one",
            )
        ]
    warnings = []
    if segments < FEW_SEGMENTS:
        warnings.append(
            Problem(
                "few_segments",
                where,
                f"the spectrum is an average of {segments} segments of {segment_s:g} s",
                f"Record longer, or shorten segment_s to get {FEW_SEGMENTS} segments or more",
            )
        )
    resolution_hz = 1.0 / (step * samples_per_segment(step, segment_s))
    upper = body.case.spectrum.upper_hz or default_upper_hz(step, top_mode_hz(body))
    lines = int(min(upper, 0.5 / step) * (1 + FREQUENCY_TOLERANCE) / resolution_hz)
    if lines < FEW_LINES:
        warnings.append(
            Problem(
                "few_lines",
                where,
                f"upper_hz ({upper:g} Hz) leaves {lines} lines of its spectrum, {resolution_hz:g} Hz apart",
                f"Raise upper_hz or lengthen segment_s to get {FEW_LINES} lines or more",
            )
        )
    return warnings
