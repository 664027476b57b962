"""A robot's moves as the manoeuvres of a plan, and what follows them as its transitions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import ceil, dist, radians

from mmrs_core.behaviour.earth import metres
from mmrs_core.behaviour.program import DEVICE_ACTION, Action, Move
from mmrs_core.generation.context import RobotContext
from mmrs_core.generation.escaping import file_stems
from mmrs_core.generation.plan_moves import (
    DEEPEST,
    MOVES,
    above_surface,
    seconds_of,
    seconds_of_hold,
    writable_speed,
)
from mmrs_core.scene import Position
from mmrs_core.transformation.kinds import before_target
from mmrs_imc.messages import (
    DEPTH,
    FROM_HERE,
    KEEP_STATION,
    METRES_PER_SECOND,
    UNCONSIDERED,
    WAIT_AT_SURFACE,
    Message,
    Value,
)
from mmrs_imc.wiring import set_by

LONGEST_TEXT = 200
"""Letters of a description at most."""

DONE, IS_DONE = "_done_", "ManeuverIsDone"
LONGEST = 0xFFFF
"""Seconds of a manoeuvre at most."""

PATIENCE, GRACE = 3.0, 60
"""Factor and seconds by which a manoeuvre may exceed its planned duration."""

RADIUS = 2.0
"""Metres about its place within which a vehicle holds; manoeuvres at the surface take 1 at least."""


@dataclass(slots=True)
class Maneuver:
    """A manoeuvre of a plan, the move that it serves, and what is set before and after it."""

    id: str
    move: Move
    data: Message
    before: list[Message] = field(default_factory=list)
    after: list[Message] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class Plan:
    """A robot's plan: the message, its manoeuvres in order, and which moves take longer than these may."""

    message: Message
    maneuvers: tuple[Maneuver, ...]
    faults: tuple[tuple[Move, str], ...]


def plan_of(context: RobotContext, name: str, stem: str) -> Plan:
    """Return the plan of a robot.

    What plans cannot express is left out, but never so that a vehicle continues where it should wait: a
    wait becomes a hold without end, and the plan ends at a choice.

    Args:
        context: of the robot.
        name: of the behaviour, as displayed.
        stem: of the robot's file, which identifies the plan.
    """
    walk = _Walk(context)
    following = walk.made()
    ids = file_stems([each.id for each in walk.maneuvers])
    maneuvers = tuple(walk.maneuvers)
    values: dict[str, Value] = {
        "plan_id": stem,
        "description": f"{name}, {context.robot.id}".encode("ascii", "replace").decode()[:LONGEST_TEXT],
        "vnamespace": "",
        "variables": (),
        "start_man_id": ids[maneuvers[0].id] if maneuvers else "",
        "maneuvers": tuple(_plan_maneuver(each, ids[each.id]) for each in maneuvers),
        "transitions": tuple(
            _transition(ids[one], ids[other] if other is not None else DONE) for one, other in following
        ),
        "start_actions": (),
        "end_actions": (),
    }
    for each in maneuvers:
        each.id = ids[each.id]
    return Plan(Message("PlanSpecification", values), maneuvers, tuple(walk.faults))


class _Walk:
    """Goes through a robot's moves from its start to where they end, or come round again."""

    def __init__(self, context: RobotContext) -> None:
        self.maneuvers: list[Maneuver] = []
        self.faults: list[tuple[Move, str]] = []
        self._context = context
        self._here: Position = context.robot.home or (0.0, 0.0, 0.0)
        self._pending: list[Message] = []

    def made(self) -> tuple[tuple[str, str | None], ...]:
        """Make the manoeuvres; return which follows which, None for the end of the plan."""
        robot = self._context.robot
        index, first = robot.start, dict[int, int]()
        again: int | None = None
        while True:
            first[index] = len(self.maneuvers)
            transition = robot.transitions.get(index)
            self._perform(robot.moves[index])
            if transition is None or transition.condition is not None:
                break
            if transition.waits:
                self._hold(f"{robot.moves[index].id}-waits", robot.moves[index], 0)
            index = transition.to
            if index in first:
                again = first[index]
                break
        names = [each.id for each in self.maneuvers]
        last = names[again] if again is not None and again < len(names) else None
        return tuple(zip(names, (*names[1:], last), strict=True)) if names else ()

    def _perform(self, move: Move) -> None:
        for number, action in enumerate(move.before):
            self._act(f"{move.id}-before-{number}", move, action)
        sort = MOVES.get(move.metaclasses[0])
        if sort == "go" and move.target is not None and move.target.position is not None:
            self._go(move, move.target.position)
        elif sort == "hold" and seconds_of_hold(move) > 0.0:
            self._hold(move.id, move, ceil(seconds_of_hold(move)))
        for number, action in enumerate(move.after):
            self._act(f"{move.id}-after-{number}", move, action)
        if self._pending:
            self._hold(f"{move.id}-acts", move, 1)

    def _go(self, move: Move, position: Position) -> None:
        place = before_target(self._here, position, move.distance)
        speed = writable_speed(self._context.speed(move) or 0.0)
        way = dist(self._here, place)
        self._here = place
        if GRACE + way / speed > LONGEST:
            self.faults.append((move, f"takes {way / speed:,.0f} s, of {LONGEST - GRACE:,} at most"))
        timeout = ceil(min(LONGEST, GRACE + PATIENCE * way / speed))
        angles = {"roll": UNCONSIDERED, "pitch": UNCONSIDERED, "yaw": UNCONSIDERED}
        self._add(move.id, move, "Goto", {"timeout": timeout, "speed": speed, **angles})

    def _hold(self, id: str, move: Move, seconds: int) -> None:
        """Stay for whole seconds; 0 is without end. At the surface that is what finds the position."""
        seconds = min(seconds, LONGEST)
        speed = self._slowly()
        if seconds and self._depth() == 0.0 and self._context.dives:
            flags = FROM_HERE | WAIT_AT_SURFACE | KEEP_STATION
            limits = {"timeout": min(LONGEST, seconds + GRACE), "flags": flags}
            self._add(id, move, "PopUp", {**limits, "duration": seconds, "radius": RADIUS, "speed": speed})
        else:
            self._add(id, move, "StationKeeping", {"duration": seconds, "radius": RADIUS, "speed": speed})

    def _act(self, id: str, move: Move, action: Action) -> None:
        """Set what an action sets, and stay for as long as it takes."""
        made = set_by(action, self._context.type) if action.is_a(DEVICE_ACTION) else ""
        if isinstance(made, str):
            return
        seconds = ceil(seconds_of(action, self._context.type))
        if seconds > LONGEST:
            self.faults.append((move, f"action '{action.name}' takes {seconds:,} s, of {LONGEST:,} at most"))
        if seconds:
            self._pending.append(made)
            self._hold(id, move, seconds)
        elif self.maneuvers and self.maneuvers[-1].move is move:
            self.maneuvers[-1].after.append(made)
        else:
            self._pending.append(made)

    def _add(self, id: str, move: Move, name: str, values: Mapping[str, Value]) -> None:
        latitude, longitude = self._degrees()
        place = {"lat": radians(latitude), "lon": radians(longitude), "z": self._depth(), "z_units": DEPTH}
        whole = {**place, "speed_units": METRES_PER_SECOND, "custom": "", **values}
        self.maneuvers.append(Maneuver(id, move, Message(name, whole), self._pending))
        self._pending = []

    def _degrees(self) -> tuple[float, float]:
        """Return where the robot is; 0 where there are no degrees, which is refused."""
        context = self._context
        return (0.0, 0.0) if context.frame.is_local else context.degrees.at(self._here[:2])

    def _depth(self) -> float:
        return metres(min(DEEPEST, max(0.0, -above_surface(self._here, self._context))))

    def _slowly(self) -> float:
        type = self._context.type
        known = [each.speed for each in type.capabilities] if type is not None else []
        return max(known[0][0], known[0][1] / 2.0) if known else 0.5


def _plan_maneuver(each: Maneuver, id: str) -> Message:
    return Message(
        "PlanManeuver",
        {
            "maneuver_id": id,
            "data": each.data,
            "start_actions": tuple(each.before),
            "end_actions": tuple(each.after),
        },
    )


def _transition(source: str, to: str) -> Message:
    return Message(
        "PlanTransition", {"source_man": source, "dest_man": to, "conditions": IS_DONE, "actions": ()}
    )
