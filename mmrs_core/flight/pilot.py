"""Carries out one robot's program, step by step, and writes its log."""

from __future__ import annotations

from .commands import Unanswered
from .desk import Desk
from .faults import BATTERY_LOW, DEVICE_SILENT, LINK_LOST, Fault
from .journal import Journal
from .missions import Item
from .objects import look_at, place_of
from .places import ends_of
from .program import (
    Action,
    GoTo,
    Hold,
    Land,
    Look,
    Measure,
    NoEffect,
    Notify,
    Operate,
    Place,
    Recharge,
    Report,
    Robot,
    Step,
    TakeOff,
    Then,
    Turn,
)
from .recording import fix
from .responses import policy_for
from .uploads import Flight, fence_of, mission_of, rally_of
from .vehicle import Vehicle
from .waits import Waits

FULL = 0.99
RECHARGE_FACTOR = 3.0
"""How many times as long as expected charging may take."""


class Pilot:
    """Steps through a program.

    Attributes:
        journal: what the robot writes down, with the move that it is at.
        waits: in which it stands still for others.
        track: the places it has passed in the air or on its way, with the moves that ended there.
    """

    def __init__(self, robot: Robot, vehicle: Vehicle, desk: Desk) -> None:
        """Take a program, a vehicle and what is needed to work."""
        self.journal = Journal(robot, vehicle, desk)
        self.waits = Waits(robot, vehicle, desk, self.journal)
        self.track: list[tuple[str, Place]] = []
        self._robot = robot
        self._vehicle = vehicle
        self._desk = desk
        self._steps = {step.move: step for step in robot.steps}
        self._flights: dict[str, Flight] = {}

    def fly(self, fence: bool = True) -> None:
        """Carry out the whole program.

        Raises:
            Fault: it cannot be carried out to its end.
        """
        self._prepare(fence)
        step: Step | None = self._steps[self._robot.start]
        while step is not None:
            self.journal.move = step.move
            step = self._perform(step)
        self._vehicle.finish()

    def _prepare(self, fence: bool) -> None:
        mission, self._flights = mission_of(self._robot)
        polygons: tuple[Item, ...] = fence_of(self._robot) if fence else ()
        self._vehicle.answer_lost_link(policy_for(LINK_LOST, self._robot).response)
        self._vehicle.prepare(polygons, rally_of(self._robot), mission)
        if self._vehicle.state().energy is None:
            self._desk.say(f"{self._robot.id!a} does not tell its battery: nobody will notice when it is low")

    def _perform(self, step: Step) -> Step | None:
        self._tell(step)
        for index, action in enumerate(step.before):
            self._act(action, f"pre:{index}")
        flight = self._flights.get(step.move)
        if flight is None:
            self.journal.write("begin")
            self._carry_out(step)
            self.journal.write("end")
        else:
            step = self._run(flight)
        for index, action in enumerate(step.after):
            self._act(action, f"post:{index}")
        return self._steps[self.waits.leave(step.then)] if step.then is not None else None

    def _carry_out(self, step: Step) -> None:
        movement = step.movement
        if isinstance(movement, TakeOff):
            self.track = []
            self._vehicle.take_off(movement.height)
            self._passed(self._vehicle.state().place)
        elif isinstance(movement, Land):
            self._vehicle.land()
        elif isinstance(movement, GoTo):
            self._go_to(movement, isinstance(step.then, Then) and step.then.fluid)
        elif isinstance(movement, Recharge):
            self._recharge(movement.seconds)
        elif isinstance(movement, Hold):
            self._vehicle.rest(movement.seconds)
        elif isinstance(movement, Turn) and (look := self._look(movement.look)) is not None:
            self._vehicle.turn(look)

    def _look(self, look: Look | None) -> Look | None:
        return look_at(look, self._desk.locators, self._vehicle.state())

    def _go_to(self, movement: GoTo, fluid: bool) -> None:
        here = self._vehicle.state().place
        if not self.track:
            self._passed(here)
        target = place_of(movement.at, self._desk.locators, self._vehicle.state())
        look = self._look(movement.look)
        ends = ends_of(here, target, movement.legs, movement.distance)
        for place in ends:
            last = place == ends[-1]
            self._vehicle.go_to(place, movement.speed, look, fluid and last)
            self._passed(place)

    def _run(self, flight: Flight) -> Step:
        moves = flight.run.moves
        self.journal.write("begin")

        def reached(seq: int) -> None:
            move = flight.ends.get(seq)
            if move is None:
                return
            movement = self._steps[move].movement
            assert isinstance(movement, GoTo)
            self._passed(place_of(movement.at, {}, self._vehicle.state()))
            self.journal.write("end")
            if move != moves[-1]:
                following = moves[moves.index(move) + 1]
                self.journal.write("take", following)
                self.journal.move = following
                self._tell(self._steps[following])
                self.journal.write("begin")

        self._vehicle.fly(flight.first, flight.last, reached)
        return self._steps[moves[-1]]

    def _passed(self, place: Place) -> None:
        if self._desk.dry:
            fix(self._desk.box, self._vehicle.state(), place)
        self.track.append((self.journal.move, place))

    def _recharge(self, seconds: float) -> None:
        self.track = []
        self._vehicle.finish()
        begun = self._desk.clock.now()
        self._vehicle.rest(seconds)
        while (left := self._vehicle.state().energy) is not None and left < FULL:
            taken = self._desk.clock.now() - begun
            if taken >= RECHARGE_FACTOR * seconds:
                fault = Fault(BATTERY_LOW, f"after {taken:.0f} s of charging the battery is at {left:.0%}")
                self.waits.raise_unless_carried_on(fault)
                return
            self._vehicle.rest(min(5.0, seconds or 5.0))
        if left is None:
            self._desk.say(f"{self._robot.id!a} has charged for {seconds:.0f} s; nobody knows how far")

    def _act(self, action: Action, detail: str) -> None:
        if isinstance(action, Notify):
            self._notify(action, detail)
            return
        try:
            self._do(action)
        except Unanswered as error:
            self.waits.raise_unless_carried_on(Fault(DEVICE_SILENT, str(error)))
        self.journal.write("act", detail)

    def _do(self, action: Action) -> None:
        if isinstance(action, Operate):
            self._vehicle.operate(action.command, action.params, confirmed=action.confirmed)
            for command, params in action.more:
                self._vehicle.operate(command, params)
            self._vehicle.rest(action.seconds)
        elif isinstance(action, Measure):
            found = self._vehicle.measure(action.value)
            self._vehicle.rest(action.seconds)
            self.journal.record("measured", action.value, {"device": action.device, "result": found})
        elif isinstance(action, Report):
            self._desk.say(f"{self._robot.id!a} reports {action.name!a} {dict(action.pairs)!a}")
            self.journal.record("reported", action.name, dict(action.pairs))
        elif isinstance(action, NoEffect):
            self._desk.say(f"{self._robot.id!a} has no way to do {action.name!a}: {action.why}")

    def _notify(self, action: Notify, detail: str) -> None:
        sign = "+" if action.active else "-"
        slots = sign + " ".join(f"{robot}.{slot}" for robot, slot in action.slots)
        self._desk.slots.notify(
            self._robot.id,
            action.slots,
            action.active,
            lambda lamport: self.journal.write("ntf", detail, slots, lamport),
            self.waits.delivery(),
        )

    def _tell(self, step: Step) -> None:
        serves = f" for task {step.task!a}" if step.task else ""
        self._desk.say(f"{self._robot.id!a}: {step.move!a} ({type(step.movement).__name__}){serves}")
