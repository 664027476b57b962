"""Makes the picture of a plan."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from math import inf

from mmrs_core.cli.preview.crossings import corners
from mmrs_core.cli.preview.figures import clock, length
from mmrs_core.cli.preview.footprints import along, footprints
from mmrs_core.cli.preview.picture import Bar, Handover, Leg, Picture, RobotPicture
from mmrs_core.cli.preview.places import origin_of, task_pictures, zones_of
from mmrs_core.scene import (
    Await,
    Branch,
    Launch,
    Plan,
    Position,
    Recharge,
    Recover,
    Robot,
    RobotPlan,
    Scene,
    Serve,
    Signal,
    Step,
    Transit,
)

_JOULES_IN_WATT_HOUR = 3600.0


def picture_of_plan(scene: Scene, plan: Plan) -> Picture:
    """Return what to show of a plan for that (expanded) scene."""
    return Picture(
        title=scene.name,
        origin=origin_of(scene.frame),
        robots=tuple(_robot_picture(scene, robot) for robot in plan.robots),
        zones=zones_of(scene.areas, (robot.clearance for robot in scene.robots)),
        tasks=task_pictures(scene, plan.begins, plan.ends),
        handovers=tuple(_handovers(plan)),
        makespan=plan.makespan,
        notes=plan.notes,
        surface=scene.frame.surface if any(_under_water(scene, robot) for robot in scene.robots) else None,
    )


def _under_water(scene: Scene, robot: Robot) -> bool:
    return robot.kinematics is not None and robot.kinematics.ceiling <= scene.frame.surface


def _robot_picture(scene: Scene, plan: RobotPlan) -> RobotPicture:
    robot = scene.robot(plan.robot)
    legs = tuple(_legs(scene, plan.robot, plan.steps))
    kinematics = robot.kinematics
    return RobotPicture(
        name=robot.name,
        type_name=robot.type.name,
        home=robot.home,
        legs=legs,
        bars=tuple(_bars(plan.steps)),
        heights=tuple(_heights(robot.home, legs)),
        floor=kinematics.floor if kinematics else -inf,
        ceiling=kinematics.ceiling if kinematics else inf,
        summary=_summary(plan),
    )


def _summary(plan: RobotPlan) -> tuple[tuple[str, str], ...]:
    served = tuple(dict.fromkeys(step.task for step in plan.steps if isinstance(step, Serve)))
    return (
        ("tasks", ", ".join(served) or "none"),
        ("way", length(plan.length)),
        ("busy", clock(plan.busy)),
        ("energy", f"{plan.energy / _JOULES_IN_WATT_HOUR:.1f} Wh" if plan.energy else "not known"),
        ("sorties", str(plan.sorties)),
    )


def _legs(scene: Scene, robot: str, steps: Iterable[Step]) -> Iterator[Leg]:
    for step in steps:
        match step:
            case Launch(at=at, up=up):
                yield Leg("launch", (at, (at[0], at[1], up)), step.begin, step.end, step.task)
            case Transit(route=route):
                yield Leg("transit", route, step.begin, step.end, step.task)
            case Serve():
                yield _work_leg(scene, robot, step)
            case Recover(at=at, up=up):
                yield Leg("recover", (at, (at[0], at[1], up)), step.begin, step.end, step.task)
            case Branch(arms=arms):
                for condition, arm in arms:
                    yield from (_under(leg, condition) for leg in _legs(scene, robot, arm))


def _work_leg(scene: Scene, robot: str, step: Serve) -> Leg:
    stroke = step.stroke
    work = scene.works.get((step.task, robot))
    coverage = work.coverage if work else None
    notes = (f"{len(stroke.actions)} actions" if stroke.actions else "", stroke.object or "")
    return Leg(
        "work",
        stroke.points,
        step.begin,
        step.end,
        step.task,
        covered=tuple(footprints(stroke, coverage)) if coverage else (),
        actions=tuple(along(stroke.points, action.at)[0] for action in stroke.actions),
        note=", ".join(filter(None, notes)),
    )


def _under(leg: Leg, condition: str | None) -> Leg:
    note = f"if {condition}" if condition else "otherwise"
    return replace(leg, note=", ".join(filter(None, (note, leg.note))))


def _bars(steps: Iterable[Step]) -> Iterator[Bar]:
    for step in steps:
        match step:
            case Launch() | Recover() | Transit() | Serve() | Recharge():
                yield Bar(_KINDS[type(step)], step.begin, step.end, step.task)
            case Await(until=until):
                note = f"not before {clock(until)}" if until is not None else ""
                yield Bar("wait", step.begin, step.end, step.task, note)
            case Branch(arms=arms):
                longest = max((arm for _, arm in arms), key=_end_of, default=())
                yield from (replace(bar, note="the longer of the ways") for bar in _bars(longest))


_KINDS: dict[type[Step], str] = {
    Launch: "launch",
    Recover: "recover",
    Transit: "transit",
    Serve: "work",
    Recharge: "recharge",
}


def _end_of(steps: tuple[Step, ...]) -> float:
    return steps[-1].end if steps else 0.0


def _heights(home: Position, legs: Iterable[Leg]) -> Iterator[tuple[float, float]]:
    yield 0.0, home[2]
    for leg in legs:
        yield from ((time, point[2]) for time, point in corners(leg))


def _handovers(plan: Plan) -> Iterator[Handover]:
    released = {
        (robot.robot, signal): step
        for robot in plan.robots
        for step in _flat(robot.steps)
        if isinstance(step, Await)
        for signal in step.signals
    }
    for robot in plan.robots:
        for step in _flat(robot.steps):
            if isinstance(step, Signal):
                for receiver in step.receivers:
                    waiting = released.get((receiver, step.signal))
                    if waiting is not None:
                        yield Handover(robot.robot, step.end, receiver, waiting.begin, waiting.end, step.task)


def _flat(steps: Iterable[Step]) -> Iterator[Step]:
    for step in steps:
        yield step
        if isinstance(step, Branch):
            for _, arm in step.arms:
                yield from _flat(arm)
