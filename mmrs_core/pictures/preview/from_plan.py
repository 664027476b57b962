"""Makes the picture of a plan."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from math import inf

from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.pictures.figures import clock, energy, length
from mmrs_core.pictures.preview.crossings import corners
from mmrs_core.pictures.preview.picture import Handover, Leg, Picture, RobotPicture
from mmrs_core.pictures.preview.places import origin_of, symbol_of_robot, task_pictures, zones_of
from mmrs_core.pictures.preview.steps import arms_of, bars_of, flat, legs_of
from mmrs_core.pictures.preview.things import things_of
from mmrs_core.scene import Await, Name, Plan, Position, Robot, RobotPlan, Scene, Serve, Signal


def picture_of_plan(scene: Scene, plan: Plan, symbols: Mapping[Name, MapSymbol]) -> Picture:
    """Return what to show of a plan for that (expanded) scene; symbols by metaclass."""
    return Picture(
        title=scene.name,
        origin=origin_of(scene.frame),
        robots=tuple(_robot_picture(scene, robot, symbols) for robot in plan.robots),
        zones=zones_of(scene.areas, (robot.clearance for robot in scene.robots)),
        tasks=task_pictures(scene, plan.begins, plan.ends, symbols),
        things=things_of(scene.elements, symbols),
        handovers=tuple(_handovers(plan)),
        makespan=plan.makespan,
        notes=(*map(str, plan.left_out), *plan.notes),
        surface=scene.frame.surface if any(_under_water(scene, robot) for robot in scene.robots) else None,
    )


def _under_water(scene: Scene, robot: Robot) -> bool:
    return robot.kinematics is not None and robot.kinematics.ceiling <= scene.frame.surface


def _robot_picture(scene: Scene, plan: RobotPlan, symbols: Mapping[Name, MapSymbol]) -> RobotPicture:
    robot = scene.robot(plan.robot)
    legs = tuple(legs_of(scene, plan.robot, plan.steps))
    kinematics = robot.kinematics
    return RobotPicture(
        name=robot.name,
        type_name=robot.type.name,
        home=robot.home,
        legs=legs,
        bars=tuple(bars_of(plan.steps)),
        arms=tuple(arms_of(plan.steps)),
        symbol=symbol_of_robot(robot.type, symbols),
        heights=tuple(_heights(robot.home, legs)),
        floor=kinematics.floor if kinematics else -inf,
        ceiling=kinematics.ceiling if kinematics else inf,
        summary=_summary(plan),
    )


def _summary(plan: RobotPlan) -> tuple[tuple[str, str], ...]:
    served = tuple(dict.fromkeys(step.task for step in flat(plan.steps) if isinstance(step, Serve)))
    return (
        ("tasks", ", ".join(served) or f"none ({plan.idle})"),
        ("way", length(plan.length)),
        ("busy", clock(plan.busy)),
        ("energy", energy(plan.energy)),
        ("sorties", str(plan.sorties)),
    )


def _heights(home: Position, legs: Iterable[Leg]) -> Iterator[tuple[float, float]]:
    yield 0.0, home[2]
    for leg in legs:
        if leg.aside:
            continue
        yield from ((time, point[2]) for time, point in corners(leg))


def _handovers(plan: Plan) -> Iterator[Handover]:
    released = {
        (robot.robot, signal): step
        for robot in plan.robots
        for step in flat(robot.steps)
        if isinstance(step, Await)
        for signal in step.signals
    }
    for robot in plan.robots:
        for step in flat(robot.steps):
            if isinstance(step, Signal):
                for receiver in step.receivers:
                    waiting = released.get((receiver, step.signal))
                    if waiting is not None:
                        yield Handover(robot.robot, step.end, receiver, waiting.begin, waiting.end, step.task)
