"""A robot's way through its moves, as missions: one a sortie."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import atan2, ceil, degrees, dist

from mmrs_core.behaviour.program import BEHAVIOUR, DEVICE_ACTION, Action, Move
from mmrs_core.behaviour.travel import TRAVEL_MARGINS
from mmrs_core.generation.python.moves import mount_of, number_of
from mmrs_core.scene import Name, Position
from mmrs_mavlink.plugin.context import VehicleContext
from mmrs_mavlink.plugin.headings import gimbal_of, on_gimbal, turns_to
from mmrs_mavlink.plugin.plans import items as cmd
from mmrs_mavlink.plugin.plans.items import PlanItem, unknown_in
from mmrs_mavlink.plugin.runs import CORNER_SECONDS
from mmrs_mavlink.wiring import Wired

ORIGIN = (0.0, 0.0, 0.0)


def sorties_of(context: VehicleContext) -> tuple[tuple[PlanItem, ...], ...]:
    """Return the items of each sortie: what a vehicle does between two stays on the ground.

    What missions cannot express is left out, but never so that a vehicle continues where it should
    wait: a wait becomes an unlimited loiter that the operator ends, and so does the end of a mission at
    a choice or at a move in a loop. A wait on the ground needs no item: the operator begins
    each sortie.
    """
    return tuple(flown(context).sorties)


def flown(context: VehicleContext) -> FlightWriter:
    """Return the moves of a robot as missions, up to where they end."""
    flight = FlightWriter(context)
    robot, index, seen = context.robot, context.robot.start, set[int]()
    while True:
        seen.add(index)
        move, transition = robot.moves[index], robot.transitions.get(index)
        flight.perform(move, fluid=transition is not None and transition.fluid)
        if transition is None:
            break
        ends = transition.condition is not None or transition.to in seen
        if transition.waits or ends:
            flight.wait(move)
        if ends:
            break
        index = transition.to
    flight.end_sortie()
    flight.beyond = frozenset(range(len(robot.moves))) - seen - {robot.stop}
    return flight


class FlightWriter:
    """Writes moves as items, one after the other, and tracks the robot's position.

    Attributes:
        sorties: the finished ones.
        left: what could not be written since a flying vehicle obeys a mission from its take-off
            on only, with the robot and the move.
        beyond: indices of the moves that come after the end of the last mission, if ever; Stop is nothing.
    """

    def __init__(self, context: VehicleContext) -> None:
        """Stand at home."""
        self.sorties: list[tuple[PlanItem, ...]] = []
        self.left: list[str] = []
        self.beyond = frozenset[int]()
        self._context = context
        self._position: Position = context.robot.home or ORIGIN
        self._speed: float | None = None
        self._looking, self._gimbal = False, 0
        self._items: list[PlanItem] = []
        self._down = context.profile.flies
        self._dialect = context.profile.autopilot.missions

    def perform(self, move: Move, *, fluid: bool) -> None:
        """Add a move with its actions; `fluid`: the robot does not stop at its end."""
        for action in move.before:
            self._act(action, move)
        handler = _MOVES.get(move.metaclasses[0]) or _MANOEUVRES.get(self._context.manoeuvre(move))
        if handler is not None:
            handler(self, move, fluid)
        for action in move.after:
            self._act(action, move)

    def wait(self, move: Move) -> None:
        """Add a wait that only the operator ends, if the robot is in motion."""
        if self._items and not self._down:
            self._add(cmd.LOITER_UNLIMITED, move, here=True)

    def end_sortie(self) -> None:
        """Finish the sortie, if it leads anywhere."""
        if any(item.position is not None for item in self._items):
            self.sorties.append(tuple(self._items))
        else:
            labels = dict.fromkeys(self._context.label(item.move) for item in self._items)
            self.left += (f"{label}: what it does there is in no sortie" for label in labels)
        self._items, self._speed, self._looking = [], None, False

    def _act(self, action: Action, move: Move) -> None:
        wiring = self._context.wiring(action) if action.is_a(DEVICE_ACTION) else None
        if isinstance(wiring, Wired) and not unknown_in(wiring, self._dialect):
            for command, params in ((wiring.command, wiring.params), *wiring.more):
                self._add(command, move, *params)
            took = f"no mission waits {wiring.seconds:g} s on the ground for its action '{action.name}'"
            if wiring.seconds and not self._leaves_out(move, took):
                self._stay(move, wiring.seconds)

    def _leaves_out(self, move: Move, what: str) -> bool:
        """Return whether the vehicle stands where no mission moves it, and note what is left out then."""
        if self._down:
            self.left.append(f"{self._context.label(move)}: {what}")
        return self._down

    def take_off(self, move: Move, fluid: bool) -> None:
        """Climb straight up."""
        self._down = False
        east, north, _ = self._position
        self._position = (east, north, self._context.zero + self._context.climb(move))
        self._add(cmd.TAKE_OFF, move, here=True)

    def land(self, move: Move, fluid: bool) -> None:
        """Descend straight down, which ends the sortie."""
        if self._leaves_out(move, "lands without having taken off"):
            return
        east, north, _ = self._position
        self._position = (east, north, self._context.zero)
        self._add(cmd.LAND, move, here=True)
        self.end_sortie()
        self._down = self._context.profile.flies

    def go_to(self, move: Move, fluid: bool) -> None:
        """Go to the target, if its place is known."""
        if move.target is None or move.target.position is None:
            return
        if self._leaves_out(move, "goes somewhere without having taken off"):
            return
        self._pace(move)
        self._look(move)
        # Without a hold at its end a vehicle cuts the corner; a fluid transition is content with that.
        for position in _ends(self._position, move.target.position, self._context.legs(move), move.distance):
            self._position = position
            last = position == move.target.position
            self._add(cmd.WAYPOINT, move, 0.0 if fluid and last else CORNER_SECONDS, here=True)

    def hold(self, move: Move, fluid: bool) -> None:
        """Stay, which a vehicle that flies does only in the air."""
        seconds = number_of(move, "duration")
        if self._down and seconds == 0.0:
            return
        if not self._leaves_out(move, f"no mission stays {seconds:g} s on the ground"):
            self._stay(move, seconds)

    def head_to(self, move: Move, fluid: bool) -> None:
        """Turn to a target, if its position is known; a gimbal turns on its own."""
        heading = move.heading
        if heading is None or not self._context.profile.turns or on_gimbal(heading, self._context):
            self._look(move)
        elif heading.target.position is not None and not self._leaves_out(move, "turns on the ground"):
            aside = heading.angle_degrees + mount_of(heading, self._context)
            angle = _bearing(self._position, heading.target.position) - aside
            self._turn(move, round(angle % 360.0, 1))

    def _stay(self, move: Move, seconds: float) -> None:
        """Stay for a while; where whole seconds are kept and the rest is cut off, not too short."""
        seconds = float(ceil(seconds)) if self._dialect.whole_seconds else seconds
        self._add(cmd.LOITER_TIME, move, seconds, here=True)

    def _turn(self, move: Move, angle: float) -> None:
        """Turn on the spot; some autopilots do so only at a place that they go to."""
        if self._dialect.turns:
            angle = cmd.angle_like_a_place(angle) if self._context.profile.turns_as_places else angle
            self._add(cmd.CONDITION_YAW, move, angle)
        else:
            radius = TRAVEL_MARGINS[self._context.robot.travel_mode].radius
            self._add(cmd.WAYPOINT, move, CORNER_SECONDS, radius, 0.0, angle, here=True)

    def _pace(self, move: Move) -> None:
        speed = self._context.speed(move)
        if speed is not None and speed != self._speed:
            self._speed = speed
            self._add(cmd.CHANGE_SPEED, move, 1.0, speed, -1.0)

    def _look(self, move: Move) -> None:
        heading = move.heading if move.heading and turns_to(move.heading, self._context) else None
        position = heading.target.position if heading else None
        if position is not None:
            self._gimbal = gimbal_of(heading, self._context) if heading else 0
            self._items.append(PlanItem(cmd.ROI_LOCATION, move, (float(self._gimbal),), position))
        elif self._looking:
            self._add(cmd.ROI_NONE, move, float(self._gimbal))
        self._looking = position is not None

    def _add(self, command: int, move: Move, *params: float, here: bool = False) -> None:
        self._items.append(PlanItem(command, move, params, self._position if here else None))


def _ends(start: Position, target: Position, legs: str, distance: float) -> tuple[Position, ...]:
    corner = {
        "level first": ((target[0], target[1], start[2]),),
        "climb first": ((start[0], start[1], target[2]),),
    }.get(legs, ())
    last = corner[-1] if corner else start
    way = dist(last, target)
    if distance <= 0.0 or way == 0.0:
        return (*corner, target)
    part = max(0.0, 1.0 - distance / way)
    east, north, up = (p + part * (q - p) for p, q in zip(last, target, strict=True))
    return (*corner, (east, north, up))


def _bearing(a: Position, b: Position) -> float:
    return degrees(atan2(b[0] - a[0], b[1] - a[1]))


_MOVES: Mapping[Name, Callable[[FlightWriter, Move, bool], None]] = {
    (BEHAVIOUR, "GoTo"): FlightWriter.go_to,
    (BEHAVIOUR, "HoldPosition"): FlightWriter.hold,
    (BEHAVIOUR, "HeadTo"): FlightWriter.head_to,
}
_MANOEUVRES: Mapping[str, Callable[[FlightWriter, Move, bool], None]] = {
    "go_to": FlightWriter.go_to,
    "take_off": FlightWriter.take_off,
    "land": FlightWriter.land,
}
