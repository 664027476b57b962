"""Makes the picture of a plan."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from math import dist, hypot, inf

from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.pictures.figures import clock, energy, length
from mmrs_core.pictures.preview.crossings import corners
from mmrs_core.pictures.preview.features import (
    elements_of,
    origin_of,
    symbol_of_robot,
    task_pictures,
    zones_of,
)
from mmrs_core.pictures.preview.picture import Arm, Bar, Handover, Leg, Picture, RadioRange, RobotPicture
from mmrs_core.scene import (
    Await,
    Branch,
    Coverage,
    Launch,
    Name,
    Plan,
    Point,
    Position,
    Recharge,
    Recover,
    Ring,
    Robot,
    RobotPlan,
    Scene,
    Serve,
    Signal,
    Step,
    Stroke,
    Transit,
    all_steps,
)
from mmrs_core.scene.relays import radio_range, relays_of, station_of

_DRAWN = (Launch, Transit, Serve, Recover)
_KINDS: dict[type[Step], str] = {
    Launch: "launch",
    Recover: "recover",
    Transit: "transit",
    Serve: "work",
    Recharge: "recharge",
}
_NORTH = (0.0, 1.0)

_CLOSE = 0.05
"""Share of the radio's range within which homes are drawn as one."""


def picture_of_plan(
    scene: Scene,
    plan: Plan,
    symbols: Mapping[Name, MapSymbol],
    moves: Mapping[tuple[str, int], Sequence[str]] | None = None,
) -> Picture:
    """Return what to show of a plan.

    Args:
        scene: expanded.
        plan: of that scene.
        symbols: how things look, by metaclass.
        moves: those that carry out each step, by robot and the step's number (`Trace.moves`); None: unknown.
    """
    return Picture(
        title=scene.name,
        origin=origin_of(scene.frame),
        robots=tuple(_robot_picture(scene, robot, symbols, moves or {}) for robot in plan.robots),
        zones=zones_of(scene.areas, {robot.name: robot.clearance for robot in scene.robots}),
        tasks=task_pictures(scene, plan.begins, plan.ends, symbols),
        elements=elements_of((*scene.elements, *(each.part for each in scene.corridors)), symbols),
        handovers=tuple(_handovers(plan)),
        makespan=plan.makespan,
        notes=(*map(str, plan.left_out), *plan.notes),
        ranges=tuple(_ranges(scene, plan)),
        surface=scene.frame.surface if any(_under_water(scene, robot) for robot in scene.robots) else None,
    )


def _ranges(scene: Scene, plan: Plan) -> Iterator[RadioRange]:
    """Yield the ranges of the context's relays, of the robots that stay somewhere as relays, and from home.

    Where there are no relays, nothing is drawn. Homes close together are drawn as one.
    """
    relays = [*_relay_ranges(scene, plan)]
    homes = list[RadioRange]()
    for robot in scene.robots if relays else ():
        metres, at = radio_range(robot.type), robot.home[:2]
        if metres is not None and all(
            each.metres != metres or dist(each.at, at) > _CLOSE * metres for each in homes
        ):
            homes.append(RadioRange(f"home of '{robot.name}'", at, metres))
    yield from (*homes, *relays)


def _relay_ranges(scene: Scene, plan: Plan) -> Iterator[RadioRange]:
    for relay in relays_of(scene.elements):
        yield RadioRange(f"relay '{relay.name}'", relay.position[:2], relay.range)
    for each in plan.robots:
        tasks = dict.fromkeys(step.task for step in each.steps if isinstance(step, Serve))
        for task in tasks:
            type, work = scene.robot(each.robot).type, scene.works.get((task, each.robot))
            station = None if work is None else station_of(task, work, type, scene.position_error)
            if station is not None:
                yield RadioRange(f"'{each.robot}' as relay '{task}'", station.position[:2], station.range)


def _under_water(scene: Scene, robot: Robot) -> bool:
    return robot.kinematics is not None and robot.kinematics.ceiling <= scene.frame.surface


def _robot_picture(
    scene: Scene,
    plan: RobotPlan,
    symbols: Mapping[Name, MapSymbol],
    moves: Mapping[tuple[str, int], Sequence[str]],
) -> RobotPicture:
    robot = scene.robot(plan.robot)
    drawn = (i for i, step in enumerate(all_steps(plan.steps)) if isinstance(step, _DRAWN))
    legs = tuple(
        replace(leg, moves=_words(moves.get((plan.robot, number), ())))
        for leg, number in zip(legs_of(scene, plan.robot, plan.steps), drawn, strict=True)
    )
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
    served = tuple(dict.fromkeys(step.task for step in all_steps(plan.steps) if isinstance(step, Serve)))
    return (
        ("tasks", ", ".join(served) or f"none ({plan.idle})"),
        ("distance", length(plan.length)),
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
        for step in all_steps(robot.steps)
        if isinstance(step, Await)
        for signal in step.signals
    }
    for robot in plan.robots:
        for step in all_steps(robot.steps):
            if isinstance(step, Signal):
                for receiver in step.receivers:
                    waiting = released.get((receiver, step.signal))
                    if waiting is not None:
                        yield Handover(robot.robot, step.end, receiver, waiting.begin, waiting.end, step.task)


def legs_of(scene: Scene, robot: str, steps: Iterable[Step], *, aside: bool = False) -> Iterator[Leg]:
    """Yield where a robot travels and works, those of all branches of a choice one after the other.

    Args:
        scene: expanded.
        robot: whose steps these are.
        steps: in order.
        aside: whether all of it is on a branch of a choice that is not the longest.
    """
    for step in steps:
        match step:
            case Launch(at=at, up=up):
                points = (at, (at[0], at[1], up))
                yield Leg("launch", points, step.begin, step.end, step.task, aside=aside)
            case Transit(route=route):
                yield Leg("transit", route, step.begin, step.end, step.task, aside=aside)
            case Serve():
                yield replace(_work_leg(scene, robot, step), aside=aside)
            case Recover(at=at, up=up):
                points = (at, (at[0], at[1], up))
                yield Leg("recover", points, step.begin, step.end, step.task, aside=aside)
            case Branch(arms=arms):
                longest = _longest(step)
                for index, (condition, arm) in enumerate(arms):
                    legs = legs_of(scene, robot, arm, aside=aside or index != longest)
                    yield from (_under(leg, condition) for leg in legs)


def _work_leg(scene: Scene, robot: str, step: Serve) -> Leg:
    stroke = step.stroke
    work = scene.works.get((step.task, robot))
    coverage = work.coverage if work else None
    hold = f"holds for {clock(stroke.hold)}" if stroke.hold > 0 else ""
    done, each = len(stroke.spots), stroke.repetition
    actions = f"{done} actions" if done > 1 else ""
    only = stroke.actions[0].action if len(stroke.actions) == 1 else ""
    passing = f"in passing, each {each.every:.1f} m" if each is not None else ""
    return Leg(
        "work",
        stroke.points,
        step.begin,
        step.end,
        step.task,
        covered=tuple(footprints(stroke, coverage)) if coverage else (),
        actions=tuple(along(stroke.points, at)[0] for at in stroke.spots),
        note=", ".join(filter(None, (actions, passing, only, hold, stroke.object or ""))),
    )


def _under(leg: Leg, condition: str | None) -> Leg:
    return replace(leg, note=", ".join(filter(None, (_when(condition), leg.note))))


def bars_of(steps: Iterable[Step]) -> Iterator[Bar]:
    """Yield what a robot spends its time on; a choice is one bar."""
    for step in steps:
        match step:
            case Launch() | Recover() | Transit() | Serve() | Recharge():
                yield Bar(_KINDS[type(step)], step.begin, step.end, step.task)
            case Await(until=until):
                note = f"not before {clock(until)}" if until is not None else ""
                yield Bar("wait", step.begin, step.end, step.task, note)
            case Branch(arms=arms):
                branches = ", ".join(_when(condition) for condition, _ in arms)
                yield Bar("choice", step.begin, step.end, step.task, branches)


def arms_of(steps: Iterable[Step], level: int = 0) -> Iterator[Arm]:
    """Yield the branches of every choice, those of inner choices after the branch that they are on."""
    for step in steps:
        if not isinstance(step, Branch):
            continue
        longest = _longest(step)
        for index, (condition, arm) in enumerate(step.arms):
            end = arm[-1].end if arm else step.begin
            yield Arm(_when(condition), step.begin, end, tuple(bars_of(arm)), level, index == longest)
            yield from arms_of(arm, level + 1)


def _when(condition: str | None) -> str:
    return "otherwise" if condition is None else f"if {condition}"


def _longest(branch: Branch) -> int:
    """Return the number of the arm that the branch ends with."""
    ends = [arm[-1].end if arm else branch.begin for _, arm in branch.arms]
    return min(range(len(ends)), key=lambda arm: abs(ends[arm] - branch.end))


def _words(moves: Sequence[str]) -> str:
    if not moves:
        return ""
    return f"move {moves[0]}" if len(moves) == 1 else f"moves {moves[0]} to {moves[-1]}"


def footprints(stroke: Stroke, coverage: Coverage) -> Iterator[Ring]:
    """Yield rectangles that a stroke covers, all turning the same way.

    Where one action covers a length of ground, these are the footprints of the actions; elsewhere
    they are strips along the legs.
    """
    if coverage.length > 0 and stroke.spots:
        for spot in stroke.spots:
            at, heading = along(stroke.points, spot)
            yield _rectangle(at, heading, coverage.length / 2, coverage.width / 2)
        return
    for start, end in pairwise(stroke.points):
        half = dist(start[:2], end[:2]) / 2
        if half > 0:
            middle = ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2, start[2])
            yield _rectangle(middle, _direction(start, end), half, coverage.width / 2)


def along(points: Sequence[Position], at: float) -> tuple[Position, Point]:
    """Return the position at an arc length and the direction of travel there, as a unit vector.

    Beyond the ends, these are the ends'; a path that only climbs is taken to head north.

    >>> along([(0, 0, 0), (10, 0, 0)], 4.0)
    ((4.0, 0.0, 0.0), (1.0, 0.0))
    """
    left, heading = max(at, 0.0), _NORTH
    for start, end in pairwise(points):
        leg = dist(start, end)
        heading = _direction(start, end) if dist(start[:2], end[:2]) > 0 else heading
        if left <= leg and leg > 0:
            part = left / leg
            east, north, up = (a + part * (b - a) for a, b in zip(start, end, strict=True))
            return (east, north, up), heading
        left -= leg
    return points[-1], heading


def _direction(start: Position, end: Position) -> Point:
    east, north = end[0] - start[0], end[1] - start[1]
    length = hypot(east, north)
    return east / length, north / length


def _rectangle(middle: Position, heading: Point, ahead: float, aside: float) -> Ring:
    (x, y), (east, north) = middle[:2], heading
    corners = ((ahead, aside), (-ahead, aside), (-ahead, -aside), (ahead, -aside))
    return tuple((x + a * east - b * north, y + a * north + b * east) for a, b in corners)
