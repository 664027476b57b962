"""Carries out one robot's program, step by step, and writes its log."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from math import inf

from .clock import Clock
from .commands import Unanswered
from .faults import (
    BATTERY_LOW,
    CONDITION_FAILED,
    DEVICE_SILENT,
    LINK_LOST,
    PEER_LOST,
    WAIT_TOO_LONG,
    Fault,
    Stopped,
)
from .log import Log, Records
from .missions import Item
from .objects import Locator, look_at, place_of
from .places import ends_of
from .program import (
    Action,
    Choose,
    GoTo,
    Hold,
    Land,
    Look,
    Measure,
    NoEffect,
    Notify,
    Operate,
    Place,
    Policy,
    Recharge,
    Report,
    Robot,
    Step,
    TakeOff,
    Then,
    Turn,
)
from .responses import CONTINUE, policy_for
from .slots import Slots
from .uploads import Flight, fence_of, mission_of, rally_of
from .vehicle import State, Vehicle

Condition = Callable[[State], bool]
Say = Callable[[str], None]

GLANCE_SECONDS = 0.1
FULL = 0.99
RECHARGE_FACTOR = 3.0
"""How many times as long as expected charging may take."""

PEER_SECONDS = 30.0


@dataclass(frozen=True, slots=True)
class Desk:
    """What a pilot works with.

    Attributes:
        conditions: by identifier; locators: by description of the object.
        stop: set when the robot is to stop.
        say: tells people what goes on.
    """

    clock: Clock
    slots: Slots
    log: Log
    records: Records
    conditions: Mapping[str, Condition]
    locators: Mapping[str, Locator]
    stop: threading.Event
    say: Say


class Pilot:
    """Steps through a program.

    Attributes:
        move: the move that the robot is at.
        policies: of the wait that the robot is in; they go before the robot's own.
        track: the places it has passed in the air or on its way, with the moves that ended there.
    """

    def __init__(self, robot: Robot, vehicle: Vehicle, desk: Desk) -> None:
        """Take a program, a vehicle and what is needed to work."""
        self.move = robot.start
        self.policies: tuple[Policy, ...] = ()
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
            self.move = step.move
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
            self._write("begin")
            self._carry_out(step)
            self._write("end")
        else:
            step = self._run(flight)
        for index, action in enumerate(step.after):
            self._act(action, f"post:{index}")
        return self._leave(step) if step.then is not None else None

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
        self._write("begin")

        def reached(seq: int) -> None:
            move = flight.ends.get(seq)
            if move is None:
                return
            movement = self._steps[move].movement
            assert isinstance(movement, GoTo)
            self._passed(place_of(movement.at, {}, self._vehicle.state()))
            self._write("end")
            if move != moves[-1]:
                following = moves[moves.index(move) + 1]
                self._write("take", following)
                self.move = following
                self._tell(self._steps[following])
                self._write("begin")

        self._vehicle.fly(flight.first, flight.last, reached)
        return self._steps[moves[-1]]

    def _passed(self, place: Place) -> None:
        self.track.append((self.move, place))

    def _recharge(self, seconds: float) -> None:
        self.track = []
        self._vehicle.finish()
        begun = self._desk.clock.now()
        self._vehicle.rest(seconds)
        while (left := self._vehicle.state().energy) is not None and left < FULL:
            taken = self._desk.clock.now() - begun
            if taken >= RECHARGE_FACTOR * seconds:
                fault = Fault(BATTERY_LOW, f"after {taken:.0f} s of charging the battery is at {left:.0%}")
                self._raise_unless_carried_on(fault)
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
            self._raise_unless_carried_on(Fault(DEVICE_SILENT, str(error)))
        self._write("act", detail)

    def _do(self, action: Action) -> None:
        if isinstance(action, Operate):
            self._vehicle.operate(action.command, action.params)
            self._vehicle.rest(action.seconds)
        elif isinstance(action, Measure):
            found = self._vehicle.measure(action.value)
            self._vehicle.rest(action.seconds)
            self.record("measured", action.value, {"device": action.device, "result": found})
        elif isinstance(action, Report):
            self._desk.say(f"{self._robot.id!a} reports {action.name!a} {dict(action.pairs)!a}")
            self.record("reported", action.name, dict(action.pairs))
        elif isinstance(action, NoEffect):
            self._desk.say(f"{self._robot.id!a} has no way to do {action.name!a}: {action.why}")

    def record(self, what: str, name: str, content: Mapping[str, object]) -> None:
        """Keep something in the records, with time, place and move."""
        state = self._vehicle.state()
        self._desk.records.add(
            robot=self._robot.id,
            time=round(state.time, 3),
            place=asdict(state.place),
            move=self.move,
            what=what,
            name=name,
            content=dict(content),
        )

    def _notify(self, action: Notify, detail: str) -> None:
        sign = "+" if action.active else "-"
        slots = sign + " ".join(f"{robot}.{slot}" for robot, slot in action.slots)
        self._desk.slots.notify(
            self._robot.id,
            action.slots,
            action.active,
            lambda lamport: self._write("ntf", detail, slots, lamport),
            self._delivery(self._desk.clock.now()),
        )

    def _leave(self, step: Step) -> Step:
        then = step.then
        assert then is not None
        self._follow(then.policies)
        if isinstance(then, Choose):
            following = self._choose(then)
        else:
            self._await(then.waits, lambda lamport: self._write("take", then.move, "", lamport))
            following = then.move
        self._follow(())
        return self._steps[following]

    def _follow(self, policies: tuple[Policy, ...]) -> None:
        """Take up the policies of a wait, and tell the vehicle what it must do without us then."""
        before = policy_for(LINK_LOST, self._robot, self.policies).response
        after = policy_for(LINK_LOST, self._robot, policies).response
        self.policies = policies
        if after != before:
            self._vehicle.answer_lost_link(after)

    def _choose(self, then: Choose) -> str:
        self._await(then.waits, None)
        try:
            holds = bool(self._desk.conditions[then.condition](self._vehicle.state()))
        except Exception as error:
            raise Fault(CONDITION_FAILED, f"condition {then.condition!a} fails: {error!r}") from error
        self._await(
            then.waits, lambda lamport: self._write("choose", "true" if holds else "false", "", lamport)
        )
        return then.move if holds else then.otherwise

    def _await(self, names: tuple[str, ...], record: Callable[[int], None] | None) -> None:
        slots, clock = self._desk.slots, self._desk.clock
        kept = record if record is not None else (lambda lamport: None)
        begun = alone = clock.now()
        told = False
        while not slots.take(self._robot.id, names, kept):
            if not told:
                self._desk.say(f"{self._robot.id!a} waits for {', '.join(map(ascii, names))}")
                told = True
            if not self._orphaned(names):
                alone = clock.now()
            self._check_wait(names, begun, alone)
            slots.await_change(GLANCE_SECONDS)
            self._vehicle.rest(0.0)

    def _delivery(self, begun: float) -> Callable[[tuple[str, ...]], None]:
        def check(silent: tuple[str, ...]) -> None:
            self._vehicle.rest(0.0)
            if self._desk.clock.now() - begun > self._patience(PEER_LOST, PEER_SECONDS):
                shown = ", ".join(map(ascii, silent))
                self._raise_unless_carried_on(Fault(PEER_LOST, f"no answer from {shown}"))

        return check

    def _check_wait(self, names: tuple[str, ...], begun: float, alone: float) -> None:
        if self._desk.stop.is_set():
            raise Stopped()
        now, shown = self._desk.clock.now(), ", ".join(map(ascii, names))
        limit = self._patience(WAIT_TOO_LONG, inf)
        if now - begun > limit:
            self._raise_unless_carried_on(Fault(WAIT_TOO_LONG, f"waited more than {limit:.0f} s for {shown}"))
        if now - alone > self._patience(PEER_LOST, PEER_SECONDS):
            self._raise_unless_carried_on(Fault(PEER_LOST, f"no robot is left that sets {shown}"))

    def _orphaned(self, names: tuple[str, ...]) -> bool:
        slots, senders = self._desk.slots, dict(self._robot.senders)
        for name in names:
            alone = all(slots.lost((sender,)) for sender in senders.get(name, ()))
            if alone and not slots.take(self._robot.id, (name,), lambda lamport: None):
                return True
        return False

    def _patience(self, event: str, usual: float) -> float:
        policy = policy_for(event, self._robot, self.policies)
        return usual if policy.after is None else policy.after

    def _raise_unless_carried_on(self, fault: Fault) -> None:
        if policy_for(fault.event, self._robot, self.policies).response != CONTINUE:
            raise fault
        self._desk.say(f"{self._robot.id!a} carries on although {fault}")

    def _write(self, label: str, detail: str = "", slot: str = "", lamport: int | None = None) -> None:
        logical = self._desk.slots.tick() if lamport is None else lamport
        now = self._desk.clock.now()
        self._desk.log.write(label, self.move, lamport=logical, time=now, detail=detail, slot=slot)

    def fail(self, event: str) -> None:
        """Log that the program has ended before its end."""
        self._write("fault", event)

    def _tell(self, step: Step) -> None:
        serves = f" for task {step.task!a}" if step.task else ""
        self._desk.say(f"{self._robot.id!a}: {step.move!a} ({type(step.movement).__name__}){serves}")
