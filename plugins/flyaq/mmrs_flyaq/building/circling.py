"""Circular moves as way points around their centre."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import cos, inf, isfinite, pi, radians, sin

from mmrs_core.grounding.features import number
from mmrs_core.languages import behaviour as bl
from mmrs_core.languages.element import Element, container_of, metaclass_of, root_of
from mmrs_core.languages.registry import Registry
from mmrs_flyaq.building.drafts import Draft, number_in, placed
from mmrs_flyaq.building.robot_types import RobotTypes, Speeds
from mmrs_flyaq.findings import Category, Record
from mmrs_flyaq.rules.mapping import Ring, Rule, Use
from mmrs_flyaq.sources.nodes import SourceNode, Text


def towards(angle_degrees: float, metres: float) -> tuple[float, float]:
    """Return metres east and north, to the millimetre, of what lies that far away, clockwise from north.

    >>> towards(90.0, 5.0), towards(180.0, 5.0)
    ((5.0, 0.0), (0.0, -5.0))
    """
    angle = radians(angle_degrees)
    # adding zero turns a negative zero into one that reads like any other
    return round(metres * sin(angle), 3) + 0.0, round(metres * cos(angle), 3) + 0.0


def set_heading(
    node: SourceNode, feature: str, element: Element, use: Use, draft: Draft, record: Record
) -> None:
    """Give a move a heading for the angle that a feature holds; what hinders it is recorded."""
    assert use.bearing is not None  # asked before
    value, *further = node.values.get(feature) or [Text(draft.said(node, feature), node.line)]
    if further:
        record.value(Category.LOST, "is more than one angle, of which the first counts", node, feature)
    own = use.bearing.base == "self"
    owner = next(draft.around(node), None) if own else element
    robot = next((each for each in draft.around(node) if isinstance(each, bl.Robot)), None)
    base = element if own else robot.home if robot is not None else None
    behaviour = root_of(owner) if owner is not None else None
    target = metaclass_of(owner).by_name.get(use.to[0].last) if owner is not None else None
    if (
        not isinstance(value, Text)
        or owner is None
        or target is None
        or not isinstance(behaviour, bl.Behaviour)
    ):
        record.value(Category.LOST, "stands in no move of a behaviour", node, feature)
        return
    try:
        east, north = towards(number_in(value.text), use.bearing.distance)
    except ValueError as fault:
        record.value(Category.LOST, str(fault), node, feature, value)
        return
    reference = base if isinstance(base, bl.Coordinate) else None
    place = placed(bl.RelativeCoordinate(x=east, y=north, reference=reference), node)
    behaviour.targets.append(place)
    setattr(owner, target.attribute, bl.Heading(target=place))
    reason = use.changed or f"headings lead to a place: one {use.bearing.distance:g} m away in this direction"
    record.value(Category.CHANGED, reason, node, feature, value)


MOST_ROUNDS = 10
"""So many at most, flown the slower the longer they are to last."""


@dataclass(frozen=True, slots=True)
class Circle:
    """A circle as the source describes it.

    Attributes:
        radius: metres.
        up: metres from the centre.
        turn: degrees from one way point to the next, clockwise from above.
        points: of one round.
        duration: seconds; 0 where it is not stated.
    """

    radius: float
    up: float
    turn: float
    points: int
    duration: float

    @property
    def length(self) -> float:
        """Metres of one round, from way point to way point."""
        return 2 * self.points * self.radius * sin(pi / self.points)

    def offsets(self, rounds: int) -> list[tuple[float, float, float]]:
        """Return metres east, north and up of the centre, around and back to the first."""
        angles = [(index % self.points) * self.turn for index in range(rounds * self.points + 1)]
        return [(*towards(angle, self.radius), round(self.up, 3)) for angle in angles]


def draw_ring(
    node: SourceNode, rule: Rule, draft: Draft, types: RobotTypes, registry: Registry, record: Record
) -> None:
    """Let the move that a node became go round its centre, over way points that further moves lead to.

    The move's target is the centre before, and the first way point, north of the centre, afterwards.
    """
    ring, first = rule.ring, draft.made[node]
    assert ring is not None  # asked before
    robot, centre = container_of(first), getattr(first, "target", None)
    if not (isinstance(first, bl.GoTo) and isinstance(robot, bl.Robot) and isinstance(centre, bl.Coordinate)):
        record.element(Category.LOST, "no centre to go round is known", node)
        return
    try:
        circle = _circle(node, ring, draft, number(centre, "altitude") or 0.0)
    except ValueError as fault:
        record.element(Category.DOUBTFUL, f"{fault}, so the robot only goes to the centre", node)
        return
    speeds = types.speeds(robot)
    rounds, speed = _rounds(circle, speeds)
    if node.text(ring.height):
        reason = "the altitude of a circle counts from its centre here"
        record.value(Category.CHANGED, reason, node, ring.height)
    if circle.duration > 0.0:
        category, reason = _pace(rounds, speed, _unknown(robot, types) if speeds is None else "")
        record.value(category, reason, node, ring.duration)
    offsets = circle.offsets(rounds)
    moves = [first, *_further(first, len(offsets) - 1, robot, registry)]
    at = robot.moves.index(first) + 1
    robot.moves[at:at] = moves[1:]
    for move, (x, y, z) in zip(moves, offsets, strict=True):
        move.target = placed(bl.RelativeCoordinate(x=x, y=y, z=z, reference=centre), node)
        _behaviour(robot).targets.append(move.target)
    for move in moves[1:]:
        placed(move, node).speed = speed
    for transition in _join(robot, moves):
        placed(transition, node)
    moves[-1].postActions.extend(list(first.postActions))


def _circle(node: SourceNode, ring: Ring, draft: Draft, altitude: float) -> Circle:
    """Return the circle that a node describes.

    Args:
        altitude: of its centre, in metres.

    Raises:
        ValueError: if a figure is not a number, or the radius not above 0.
    """
    radius = number_in(draft.said(node, ring.radius) or "0")
    if not 0 < radius < inf:
        raise ValueError(f"{ring.radius} is {radius:g} m")
    height, duration = draft.said(node, ring.height), draft.said(node, ring.duration)
    up = number_in(height) - altitude if height else 0.0
    turn = 360 / ring.points * (1 if draft.said(node, ring.clockwise).lower() == "true" else -1)
    return Circle(radius, up, turn, ring.points, max(0.0, number_in(duration or "0")))


def _rounds(circle: Circle, speeds: Speeds | None) -> tuple[int, float | None]:
    """Return how many rounds last as long as the circle does, and at which speed they are flown.

    None for a speed: at the robot's own, since its speeds are not known, or none of them makes the rounds
    last so long.
    """
    if circle.duration <= 0.0 or not isfinite(circle.duration) or speeds is None:
        return 1, None
    usual = speeds.around(circle.radius)
    rounds = max(1, min(MOST_ROUNDS, int(circle.duration * usual / circle.length)))
    speed = round(rounds * circle.length / circle.duration, 3)
    fits = speeds.slowest <= speed <= speeds.fastest_around(circle.radius)
    return rounds, speed or None if fits else None


def _unknown(robot: bl.Robot, types: RobotTypes) -> str:
    """Return how to provide the unknown speeds of a robot."""
    name = robot.typeName or ""
    how = types.how(name)
    return f"the speeds of robot type {name!r} are not known, so the robot goes round once at its own: {how}"


def _pace(rounds: int, speed: float | None, unknown: str) -> tuple[Category, str]:
    """Return what becomes of the time that a circle lasts, and why.

    Args:
        rounds: that are flown.
        speed: at which; None: at the robot's own.
        unknown: the message where the speed of the robot type is unknown.
    """
    times = "once" if rounds == 1 else f"{rounds} times"
    if speed is not None:
        return Category.CHANGED, f"a circle is flown by rounds here: {times} at {speed} m/s takes so long"
    if unknown:
        return Category.LOST, unknown
    return Category.LOST, f"the robot goes round {times}, and no speed that it has makes that last so long"


def _join(robot: bl.Robot, moves: Sequence[bl.GoTo]) -> Sequence[bl.MoveTransition]:
    """Lead from each way point to the next, and from the last where the first led before.

    Returns:
        The transitions between way points.
    """
    onward = [each for each in robot.moveTransitions if each.from_ is moves[0]]
    for transition in onward:
        transition.from_ = moves[-1]
    at = robot.moveTransitions.index(onward[0]) if onward else len(robot.moveTransitions)
    between = [bl.MoveTransition(from_=one, to=other, fluid=True) for one, other in pairwise(moves)]
    robot.moveTransitions[at:at] = between
    return between


def _further(first: bl.GoTo, count: int, robot: bl.Robot, registry: Registry) -> list[bl.GoTo]:
    """Return further moves like the first, each with a name that no other move of the robot has."""
    taken = {move.name for move in robot.moves}
    found: list[bl.GoTo] = []
    number = 1
    for _ in range(count):
        number += 1
        while first.name and f"{first.name}_{number}" in taken:
            number += 1
        name = f"{first.name}_{number}" if first.name else None
        made = registry.create(*metaclass_of(first).key, name=name)
        assert isinstance(made, bl.GoTo)  # as the first is
        found.append(made)
    return found


def _behaviour(robot: bl.Robot) -> bl.Behaviour:
    behaviour = root_of(robot)
    assert isinstance(behaviour, bl.Behaviour)  # robots stand in nothing else
    return behaviour
