"""Gathers what ``mmrs export`` draws: a mission, its behaviour, and the flight of that."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from mmrs_core.behaviour.as_scene import carries_out
from mmrs_core.behaviour.box_files import black_boxes
from mmrs_core.behaviour.log import logs_in
from mmrs_core.cli.behaviours import Loaded, is_behaviour, load_behaviour
from mmrs_core.cli.output import tell
from mmrs_core.cli.parameters import behaviour_file, without_mission
from mmrs_core.cli.plan import folder_of
from mmrs_core.cli.session import CommandStages, Session
from mmrs_core.errors import UnreadableError, UnsupportedError, UsageError
from mmrs_core.languages.modelset import model_in
from mmrs_core.pictures.layers.layer import Layer

if TYPE_CHECKING:
    from mmrs_core.drawings.drawing import Drawing, HeightReference
    from mmrs_core.pictures.flights.flight import Flight
    from mmrs_core.pictures.layers.chart import Chart, Drawn
    from mmrs_core.scene import Frame, Scene

_OF_MISSIONS = frozenset({Layer.AREAS, Layer.ELEMENTS, Layer.TASKS, Layer.HOMES})
_STANDING = frozenset({Layer.RALLY_POINTS})
_OF_FLIGHTS = frozenset({Layer.TRACKS, Layer.MEASUREMENTS, Layer.EVENTS})


@dataclass(frozen=True, slots=True)
class Exported:
    """A mission, behaviour or flight to be drawn.

    Attributes:
        source: path of it, as typed.
        mission: None for a behaviour alone. loaded: None for a mission without a behaviour.
        plan: the behaviour as simulated; None if it cannot be. flight: as flown; None if it was not.
        logs: files of that flight.
    """

    source: Path
    title: str
    frame: Frame
    mission: Scene | None = None
    loaded: Loaded | None = None
    plan: Flight | None = None
    flight: Flight | None = None
    logs: tuple[Path, ...] = ()


def given_by(
    session: Session,
    source: Path,
    logs: Sequence[Path],
    context: Path | None,
    robots: tuple[Path, ...],
    assume: list[str] | None,
    only: Collection[Layer],
) -> Exported:
    """Return what is known of a project, a behaviour, or the logs of its run.

    Raises:
        UnreadableError: if there is nothing of these, or no behaviour for the logs.
        InvalidModelError: if models are not valid.
        UnsupportedError: if it has no place on the Earth.
        UsageError: if a wanted layer can't be in it.
    """
    mission: Scene | None = None
    file = _behaviour_of_logs(source)
    if file is not None:
        logs = (source, *logs)
    elif is_behaviour(session, alone := without_mission(source)):
        file = alone
    if not logs and (flown := sorted(_OF_FLIGHTS.intersection(only))):
        raise UsageError(f"--only {flown[0]}: needs the logs of a run; add --logs DIR")
    if file is not None and Layer.TASKS in only:
        raise UsageError(f"--only tasks: {source} has no mission; export the project instead")
    if file is None:
        mission = CommandStages(session, source, context=context, robots=robots).grounded
        _refuse_local(mission.frame, source)
        file = model_in(folder_of(source), "behaviour")
        beyond = set(only) - _OF_MISSIONS
        if (only and not beyond) or (file is None and not (beyond or logs or assume)):
            return Exported(source, mission.name, mission.frame, mission)
    loaded = load_behaviour(
        session, file or behaviour_file(folder_of(source)), context=context, robots=robots
    )
    _refuse_local(loaded.program.frame, source)
    if mission is not None and not carries_out(loaded.program, mission):
        tell(f"{file}: note: is of another mission; its paths are left out")
        return Exported(source, mission.name, mission.frame, mission)
    title = mission.name if mission is not None else loaded.program.name
    made = Exported(source, title, loaded.program.frame, mission, loaded)
    if logs:
        return _flown(session, made, logs, assume)
    return _planned(session, made, assume) if not only or set(only) - _OF_MISSIONS - _STANDING else made


def _planned(session: Session, given: Exported, assume: list[str] | None) -> Exported:
    from mmrs_core.cli.simulation import answers, fly
    from mmrs_core.pictures.layers.courses import flight_as_planned

    assert given.loaded is not None
    run = fly(session, given.loaded.program, given.loaded.place, answers(assume))
    return replace(given, plan=flight_as_planned(given.loaded.program, run))


def _flown(session: Session, given: Exported, logs: Sequence[Path], assume: list[str] | None) -> Exported:
    from mmrs_core.cli.report import flown, read_files
    from mmrs_core.pictures.layers.courses import flight_as_planned

    assert given.loaded is not None
    found = flown(session, given.loaded, logs, assume)
    for line in (*found.flight.damages, *found.planned.notes):
        tell(line)
    plan = flight_as_planned(given.loaded.program, found.planned.run) if found.planned.run else None
    return replace(given, plan=plan, flight=found.flight, logs=read_files(logs))


def _behaviour_of_logs(source: Path) -> Path | None:
    """Return the behaviour of logs, which lies beside them or their folder; None for anything but logs.

    Raises:
        UnreadableError: if there is none.
    """
    folder = source if source.is_dir() else source.parent
    models = source.is_dir() and any(model_in(folder, name) for name in ("mission", "behaviour"))
    if models or not (logs_in([source]) or black_boxes([source])):
        return None
    for near in (folder, folder.resolve().parent):
        if (file := model_in(near, "behaviour")) is not None:
            return file
    raise UnreadableError(
        f"{source}: no behaviour.xmi beside these logs; name it: 'mmrs export BEHAVIOUR --logs {source}'"
    )


def _refuse_local(frame: Frame, source: Path) -> None:
    if frame.is_local:
        where = "give its origin, or the home of its first robot, a latitude and a longitude"
        raise UnsupportedError(f"{source}: is local, so no map of the Earth can show it; {where}")


def drawing_from(
    session: Session,
    given: Exported,
    heights: Sequence[HeightReference],
    start: float | None,
    only: Iterable[Layer],
) -> Drawing:
    """Return what is given as a drawing; report missing data for its heights.

    Args:
        heights: what they may be measured from, most wanted first.
        start: time of day, seconds since 1970-01-01 UTC; None: that of the flight.
        only: layers wanted; none: all.
    """
    from mmrs_core.pictures.layers.chart import chart_of, drawing_of, lacking_for

    if start is None and given.flight is not None:
        start = given.flight.zero
    chart = chart_of(given.frame, heights, start)
    drawing = drawing_of(_drawn(session, given, chart), only)
    if (lacking := lacking_for(given.frame, heights)) and any(each.heights for each in drawing.features):
        tell(f"{given.source}: note: heights are above the origin; the mission does not give {lacking}")
    return drawing


def _drawn(session: Session, given: Exported, chart: Chart) -> Iterator[Drawn]:
    from mmrs_core.pictures.layers.courses import Courses
    from mmrs_core.pictures.layers.places import areas_on, elements_on, homes_on, rally_points_on, tasks_on

    mission, loaded, known = given.mission, given.loaded, session.contributions
    if mission is not None:
        yield from areas_on(chart, mission.areas)
        corridors = (each.part for each in mission.corridors)
        yield from elements_on(chart, (*mission.elements, *corridors), known.map_symbols)
        yield from tasks_on(chart, mission, known.map_symbols)
        yield from homes_on(chart, [(robot.name, robot.type.name, robot.home) for robot in mission.robots])
    elif loaded is not None:
        yield from areas_on(chart, loaded.place.areas or ())
        corridors = (each.part for each in loaded.place.corridors)
        yield from elements_on(chart, (*loaded.place.elements, *corridors), known.map_symbols)
        robots = loaded.program.robots
        yield from homes_on(chart, [(robot.id, robot.type_name, robot.home) for robot in robots])
    if loaded is None:
        return
    yield from rally_points_on(chart, loaded.program, loaded.place.types, loaded.place.areas or ())
    courses = Courses(chart, loaded.program, loaded.place.types, known)
    if given.plan is not None:
        yield from courses.lines(given.plan, Layer.PATHS)
    if given.flight is not None:
        yield from courses.lines(given.flight, Layer.TRACKS)
    if (shown := given.flight or given.plan) is not None:
        yield from courses.points(shown)
