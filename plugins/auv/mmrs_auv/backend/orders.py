"""From moves and actions of a behaviour to what a decision centre has its vehicle do."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace

from auv_vessel.decision.duties import (
    NO_PROGRESS,
    Charge,
    Duty,
    Face,
    FailureError,
    Finish,
    Look,
    Ready,
    Seek,
    Sight,
    Stay,
    Travel,
    Use,
)
from auv_vessel.sheet import Sheet, Vector
from mmrs_auv.controllers.orders import NoWayError, Waters
from mmrs_auv.sayable import Bus, mount_of, parameter_of, unturnable
from mmrs_auv.sheets import action_number
from mmrs_core.behaviour.program import BEHAVIOUR, DEVICE_ACTION, Action, Heading, Move
from mmrs_core.contributions.vehicles import VehicleInput
from mmrs_core.errors import UnreachableError, UnsupportedError
from mmrs_core.scene import Position
from mmrs_core.simulation.escape import Escapes
from mmrs_core.simulation.known import kinematics_of, move_kinds_of
from mmrs_runtime.faults import DEVICE_SILENT
from mmrs_runtime.policies import AFTER, Policy, patience
from mmrs_runtime.vehicle import Fault

START, STOP, GO_TO, RECHARGE = ((BEHAVIOUR, name) for name in ("Start", "Stop", "GoTo", "Recharge"))


class BehaviourOrders:
    """Knows what a robot's moves and actions are to its vehicle.

    Attributes:
        charged: called when batteries were charged.
    """

    def __init__(self, given: VehicleInput, sheet: Sheet, waters: Waters, sight: Sight | None) -> None:
        """Take what orders are made of; without a `sight`, objects are where they are expected.

        Raises:
            UnsupportedError: moves or actions are of unknown kinds, or more than the vehicle's bus
                can say; lists all of them.
        """
        self.policies: Sequence[Policy] = (*given.robot.policies, *given.policies)
        self.reserve, self.waters = given.program.reserve, waters
        self._home = given.robot.home or (0.0, 0.0, given.program.frame.surface)
        self.home = waters.below(self._home)
        self._given, self._sheet, self._sight = given, sheet, sight
        self._kinds = move_kinds_of(given)
        self._kinematics = kinematics_of(given)
        self._escapes = Escapes(given, self._kinematics, given.robot.home or (0.0, 0.0, 0.0))
        self.charged: Callable[[], None] = lambda: None
        self._reported: dict[str, Vector] = {}
        self._found: dict[str, Vector] = {}
        strange = tuple(self._strange())
        if strange:
            raise UnsupportedError(
                f"robot '{given.robot.id}': unknown to underwater vehicles, or not stated", strange
            )

    def duty(self, order: object, here: Vector, *, through: bool) -> Duty | Fault:
        """Return what a move or an action is; a fault where the device does not have that action."""
        if isinstance(order, Move):
            return self.movement(order, self.waters.above(here), through=through)
        assert isinstance(order, Action)
        found = self.action(order)
        return found or Fault(DEVICE_SILENT, f"'{order.device}' does not do '{order.name}'")

    def reports(self, order: object) -> Mapping[str, object] | None:
        """Return what an action reports, with its `name`; None: it does not report."""
        if not isinstance(order, Action) or order.is_a(DEVICE_ACTION):
            return None
        return {"name": order.name, **dict(order.parameters)}

    def learn(self, name: str, place: Vector) -> None:
        """Take note of where another robot has detected an object."""
        self._reported[name] = place

    def escape(self, response: str, here: Vector) -> Duty:
        """Return the path home, or to an emergency area, around what is in the way."""
        return self.way(self._escapes.clear(response, self.waters.above(here)))

    def back(self, passed: Sequence[str], begun: str, here: Vector) -> Duty:
        """Return the path to where the last of the moves ended, around what is in the way.

        Raises:
            NoWayError: there is none.
        """
        above = self.waters.above(here)
        try:
            return self.way(self._escapes.path(above, self._ended_at(passed, above)))
        except UnreachableError as error:
            raise NoWayError(str(error)) from error

    def _ended_at(self, passed: Sequence[str], here: Position) -> Position:
        moves = {move.id: move for move in self._given.robot.moves}
        place = self._given.robot.home or here
        for id in passed:
            path = self.path(moves[id], place)
            place = path[-1] if path else place
        return place

    def movement(self, move: Move, here: Position, *, through: bool) -> Duty:
        """Return what a move is; `through`: it need not stop at the end."""
        if move.is_a(START):
            return Ready()
        if move.is_a(STOP):
            return Finish(floats=self._sheet.weight_in_water < 0.0)
        kind = self._kinds[move.id]
        path = self.path(move, here)
        shortest = kind.seconds(move, path, self._kinematics, self._given.robot.travel_mode).shortest
        if move.is_a(RECHARGE):
            return Charge(shortest, self.charged)
        if len(path) > 1 and move.is_a(GO_TO) and self._is_sought(move):
            return self._seek(move, here)
        if len(path) > 1:
            return self._travel(move, path, through)
        if move.heading is not None and (look := self._look(move.heading)) is not None:
            return Face(look)
        return Stay(shortest)

    def action(self, action: Action) -> Duty | None:
        """Return what a device does; None where it does not have that action."""
        number = action_number(self._given.type, action.device, action.name)
        if not action.is_a(DEVICE_ACTION):
            return Stay(0.0)
        if number is None:
            return None
        seconds = self._given.type.devices[action.device].actions[action.name].duration
        after = patience(DEVICE_SILENT, (*self._given.robot.policies, *self._given.policies))
        return Use(
            action.device,
            number,
            parameter_of(action),
            seconds + (AFTER[DEVICE_SILENT] if after is None else after),
        )

    def path(self, move: Move, here: Position) -> tuple[Position, ...]:
        """Return the positions that a move passes, the current one first."""
        return self._kinds[move.id].path(move, here, self._given.robot.home) or (here,)

    def way(self, path: tuple[Position, ...]) -> Travel:
        """Return the way along a path whose first position is where the vehicle is."""
        return Travel([self.waters.below(each) for each in path[1:]], self._kinematics.cruise)

    def _travel(self, move: Move, path: tuple[Position, ...], through: bool) -> Travel:
        points = [self.waters.below(each) for each in path[1:]]
        look = self._look(move.heading) if move.heading is not None else None
        return Travel(points, self._speed(move), look, through=through)

    def _seek(self, move: Move, here: Position) -> Duty:
        target = move.target
        assert target is not None
        assert target.position is not None
        assert self._sight is not None
        kind, home, name = self._kinds[move.id], self._given.robot.home, target.description or ""

        def way(place: Vector, found: bool) -> Duty:
            if found:
                self._found[name] = place
            aimed = replace(move, target=replace(target, position=self.waters.above(place)))
            path = kind.path(aimed, here, home)
            if path is None:
                raise FailureError(NO_PROGRESS, f"no path to {place}")
            return self._travel(aimed, path, through=False)

        expected = self.waters.below(target.position)
        reported = self._place(name, expected) if name in self._reported else None
        return Seek(name, expected, target.tolerance, self._sight, way, reported)

    def _place(self, name: str, expected: Vector) -> Vector:
        """Return where an object was found, or was detected by others: at the depth expected."""
        if name in self._found:
            return self._found[name]
        north, east, _ = self._reported.get(name, expected)
        return (north, east, expected[2])

    def _is_sought(self, move: Move) -> bool:
        return self._sight is not None and move.target is not None and move.target.description is not None

    def _speed(self, move: Move) -> float:
        return min(move.speed or self._kinematics.cruise, self._sheet.speed)

    def _look(self, heading: Heading) -> Look | None:
        if heading.target.position is None:
            return None
        expected = self.waters.below(heading.target.position)
        north, east, _ = self._place(heading.target.description or "", expected)
        return Look(north, east, heading.angle_degrees + mount_of(heading.device, self._given.type))

    def _strange(self) -> Iterator[str]:
        bus = Bus(self._sheet, self._given.program.frame.surface)
        for move in self._given.robot.moves:
            kind = self._kinds[move.id]
            if kind.leaves in ("airborne", "grounded") or kind.needs == {"airborne"}:
                yield f"move '{move.id}': {move.kind}"
            elif move.is_a(GO_TO) and (move.target is None or move.target.position is None):
                yield f"move '{move.id}': the expected position of its object is unknown"
            facing = () if move.heading is None else unturnable(move.heading.device, self._given.type)
            yield from (f"move '{move.id}': {each}" for each in (*bus.refused(move), *facing))
