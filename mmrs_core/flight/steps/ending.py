"""What one robot does when its program ends before its end, until nothing is left to do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ..desk import Desk
from ..faults import (
    BATTERY_LOW,
    GROUND_LOST,
    LINK_LOST,
    ORDERED,
    POSITION_LOST,
    STOPPED,
    TAKEN_OVER,
    VEHICLE_RESTARTED,
    Alone,
    Fault,
    Strange,
)
from ..links.link import Link
from ..orders.obedience import Obedience, Ordered
from ..program import Robot
from ..vehicles.vehicle import Vehicle
from .energy import COMES_DOWN
from .obeying import obeying
from .pilot import Pilot
from .responses import HOLD, NOTHING, RETURN, respond, response_to
from .watch import Watch

OK, FAILED, LINK, INTERRUPTED = 0, 1, 5, 130
WATCH_SECONDS = 0.5
KEPT_UP = (
    "is not ours: heartbeats go on until its motors are off; interrupted again, they end, and the vehicle"
    " does what it does about a lost link, whoever has it"
)
CODES = {STOPPED: INTERRUPTED, ORDERED: INTERRUPTED, LINK_LOST: LINK}
OVERTAKES = frozenset({POSITION_LOST, VEHICLE_RESTARTED, BATTERY_LOW, GROUND_LOST, STOPPED})
"""Events that are answered although the robot already responds to another."""


@dataclass(frozen=True, slots=True)
class Crew:
    """All that works for one robot.

    Attributes:
        link: None in a dry run.
        on_stop: the response when somebody asks the robot to stop.
    """

    robot: Robot
    vehicle: Vehicle
    link: Link | None
    watch: Watch
    obedience: Obedience
    desk: Desk
    pilot: Pilot
    on_stop: str

    def say(self, words: str) -> None:
        """Tell people something about the robot."""
        self.desk.say(f"{self.robot.id!a}: {words}")


class Ending:
    """Carries out what policies and people have a robot do.

    Attributes:
        suspended: whether the program may go on when the battery has been changed.
        where: for people, ``home`` or ``down``, when it is there.
        down: whether what was to be done is done, so that the battery can be changed.
    """

    def __init__(self, crew: Crew, leave: Callable[[], None]) -> None:
        """End nothing yet; `leave` tells the others that the robot sets no more slots."""
        self.suspended = False
        self.down = False
        self.where = ""
        self._crew = crew
        self._leave = leave
        self._handled: set[str] = set()

    def end(self, fault: Fault) -> int:
        """Respond to what has ended the program; return the exit code."""
        crew, response = self._crew, self._response_to(fault)
        self.suspended = fault.event == BATTERY_LOW and response in COMES_DOWN
        self._tell(fault, response)
        if not self.suspended:
            self._log(fault)
        first = fault
        while True:
            try:
                self._carry_out(fault, response)
                break
            except Fault as other:
                if isinstance(other, Ordered):
                    first = other if self.suspended else first
                elif other.event not in OVERTAKES or other.event in self._handled:
                    return self._give_up(other, response)
                fault, response = other, self._response_to(other)
                self._tell(fault, response)
                if self.suspended and fault.event != BATTERY_LOW:
                    self.suspended = False
                    self._log(fault)
        self.down, self.where = True, "home" if response == RETURN else "down"
        crew.say("stopped" if first.event == STOPPED else "ended early")
        return CODES.get(first.event, FAILED)

    def refuse(self, fault: Strange | Alone) -> int:
        """Leave a vehicle alone that is not the robot's, or robots that have not come; return the exit code.

        A log that others will go on with, or which can still begin, is left as it is.
        """
        self._tell(fault, NOTHING)
        waits = isinstance(fault, Alone)
        self.suspended = waits or bool(self._crew.desk.log.steps)
        if not self.suspended:
            self._log(fault)
        self._crew.say("has not begun; --resume tries again" if waits else "ended early")
        return LINK if waits else FAILED

    def _carry_out(self, fault: Fault, response: str) -> None:
        crew = self._crew
        self._handled.add(fault.event)
        crew.watch.relax(self._handled, response)
        crew.obedience.ended = not self.suspended
        if fault.event == LINK_LOST:
            return
        if response == NOTHING:
            self._stand_back()
            return
        crew.watch.check_hands()
        if isinstance(fault, Ordered):
            seen = obeying(response, crew.robot, crew.vehicle, crew.pilot.track)
            crew.obedience.expect(fault.receipt, seen)
        holds = respond(response, crew.robot, crew.vehicle, crew.pilot.track, crew.obedience.repeat)
        crew.obedience.settle()
        crew.watch.moving = holds
        if holds and fault.event == STOPPED:
            self._leave_it_holding()
        elif holds:
            self._watch_over()

    def _response_to(self, fault: Fault) -> str:
        crew = self._crew
        if isinstance(fault, Ordered) and fault.response:
            return fault.response
        if fault.event == STOPPED:
            return crew.on_stop.upper()
        return response_to(fault.event, crew.robot, crew.pilot.waits.policies)

    def _tell(self, fault: Fault, response: str) -> None:
        self._crew.say(f"{fault.event}: {fault}; response: {response}")
        self._crew.pilot.journal.decide(fault.event, str(fault), response)

    def _log(self, fault: Fault) -> None:
        try:
            self._crew.pilot.journal.fail(fault.event)
        except Fault as error:
            self._crew.say(f"the fault is not in the log: {error}")
        self._leave()

    def _give_up(self, fault: Fault, response: str) -> int:
        crew = self._crew
        crew.pilot.journal.decide(fault.event, f"{response} cannot be carried out: {fault}", NOTHING)
        crew.obedience.settle(str(fault))
        if fault.event == TAKEN_OVER or self._acts_by_itself():
            crew.say(f"{fault}")
            self._stand_back()
            return FAILED
        crew.say(f"cannot carry out {response}: {fault}; take over by hand")
        return CODES.get(fault.event, FAILED)

    def _acts_by_itself(self) -> bool:
        """Return whether the vehicle is in a mode that nobody here told it."""
        try:
            self._crew.vehicle.check()
        except Fault:
            return True
        return False

    def _watch_over(self) -> None:
        """Stay with a vehicle that holds until somebody stops the program.

        Raises:
            Fault: the link is lost, somebody has taken over, or has ordered something else.
        """
        self._crew.say("holds; interrupt to end")
        while not self._crew.desk.stop.is_set():
            self._crew.vehicle.rest(WATCH_SECONDS)

    def _leave_it_holding(self) -> None:
        """Have a vehicle that was stopped stay where it is when nobody talks to it any more."""
        try:
            self._crew.vehicle.answer_lost_link(HOLD)
        except Fault as fault:
            self._crew.say(f"{fault}: it may not stay where it is when this program has ended")

    def _stand_back(self) -> None:
        """Send nothing but heartbeats until the motors are off: without them, the vehicle might fly away."""
        crew = self._crew
        if crew.link is None:
            return
        crew.watch.let_go()
        crew.obedience.hands_off = True
        crew.say("hands off until its motors are off; interrupt twice to end before")
        if self.suspended:
            crew.say("its program can go on later: start again with --resume")
        told = False
        try:
            while crew.vehicle.state().armed and not crew.desk.abandon.is_set():
                crew.link.wait(lambda: None, crew.desk.clock.patience(0.0, WATCH_SECONDS))
                crew.obedience.refuse_all("somebody else has the vehicle")
                if crew.desk.stop.is_set() and not told:
                    told = True
                    crew.say(KEPT_UP)
        except Fault as lost:
            crew.say(f"{lost}")
