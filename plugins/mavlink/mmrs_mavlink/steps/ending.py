"""What one robot does when its program ends before its end, until nothing is left to do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mmrs_runtime.faults import (
    BATTERY_LOW,
    LINK_LOST,
    ORDERED,
    STOPPED,
    TAKEN_OVER,
    Alone,
    Fault,
    Refused,
    Stopped,
    Strange,
)
from mmrs_runtime.policies import COMES_DOWN, HOLD, NOTHING, OVERTAKES

from ..desk import Desk
from ..orders.obedience import Obedience, Ordered
from ..program import Robot
from ..vehicles import modes
from ..vehicles.vehicle import Vehicle
from .hearing import is_heard, lately, listening
from .obeying import obeying, undone
from .pilot import Pilot
from .responding import HINDRANCES, comes_down_alone, respond_or_less
from .responses import response_to
from .watch import Watch

if TYPE_CHECKING:
    from ..links.link import Link

OK, FAILED, LINK, INTERRUPTED = 0, 1, 5, 130
WATCH_SECONDS = 0.5
GLANCE_SECONDS = 0.1
KEPT_UP = (
    "is not ours: heartbeats go on until its motors are off; interrupted again, they end, and the vehicle"
    " does what it does about a lost link, whoever has it"
)
CODES = {STOPPED: INTERRUPTED, ORDERED: INTERRUPTED, LINK_LOST: LINK}
OVERTAKING = OVERTAKES | {STOPPED}


@dataclass(frozen=True, slots=True)
class Crew:
    """All that works for one robot.

    Attributes:
        link: None in a dry run.
        on_stop: the response when somebody asks the robot to stop.
        near_home: metres from home within which it has come home.
    """

    robot: Robot
    vehicle: Vehicle
    link: Link | None
    watch: Watch
    obedience: Obedience
    desk: Desk
    pilot: Pilot
    on_stop: str
    near_home: float = 20.0

    def say(self, words: str) -> None:
        """Tell people something about the robot."""
        self.desk.say(f"{self.robot.id!r}: {words}")


class Ending:
    """Carries out what policies and people have a robot do.

    Attributes:
        suspended: whether the program may go on when the battery has been changed.
        down: whether what was to be done is done, so that the battery can be changed.
    """

    def __init__(
        self,
        crew: Crew,
        leave: Callable[[], None],
        lose: Callable[[], bool] = lambda: False,
        *,
        down: bool = False,
    ) -> None:
        """End nothing yet.

        Args:
            crew: whose program it is.
            leave: tells the others that the robot sets no more slots.
            lose: tells that its link is lost; returns whether other robots of the process still work.
            down: whether it came down for its battery before, and may wait for what it lacks.
        """
        self.suspended = False
        self.down = down
        self._crew = crew
        self._leave = leave
        self._lose = lose
        self._handled: set[str] = set()
        self._logged = False

    def end(self, fault: Fault) -> int:
        """Respond to what has ended the program; return the exit code."""
        crew, response = self._crew, self._response_to(fault)
        self.suspended = fault.event == BATTERY_LOW and response in COMES_DOWN
        self._tell(fault, response)
        if not self.suspended:
            self._log(fault)
        crew.obedience.overtake(fault)
        self.down = False
        first = fault
        while True:
            try:
                self._carry_out(fault, response)
                break
            except Fault as other:
                crew.obedience.overtake(other)
                if isinstance(other, Ordered):
                    first = other if self.suspended else first
                elif other.event == LINK_LOST:
                    self._tell_undone(other, response)
                elif not other.instead and (other.event not in OVERTAKING or other.event in self._handled):
                    return self._give_up(other, response)
                fault, response = other, self._response_to(other)
                self._tell(fault, response)
                if self.suspended and fault.event != BATTERY_LOW:
                    self.suspended = False
                    self._log(fault)
        self.down = crew.obedience.has_vehicle
        crew.say("stopped" if first.event == STOPPED else "ended early")
        return self._code(first)

    def _code(self, fault: Fault) -> int:
        return LINK if LINK_LOST in self._handled else CODES.get(fault.event, FAILED)

    def refuse(self, fault: Strange | Alone) -> int:
        """Leave a vehicle alone that is not the robot's, or cannot go on, or robots that have not come.

        A log that others will go on with, or which can still begin, is left as it is.

        Returns:
            The exit code.
        """
        self._tell(fault, NOTHING)
        self._crew.obedience.overtake(fault)
        if self.down:
            self.suspended = True
            return FAILED
        waits = isinstance(fault, Alone)
        self.suspended = waits or bool(self._crew.desk.log.steps)
        if not self.suspended:
            self._log(fault)
        begun = "begun" if waits else "gone on"
        self._crew.say(f"has not {begun}; --resume tries again" if self.suspended else "ended early")
        return LINK if waits else FAILED

    def _carry_out(self, fault: Fault, response: str) -> None:
        crew = self._crew
        if crew.obedience.has_vehicle and fault.event != LINK_LOST and response != NOTHING:
            crew.watch.check_hands(fault.event)
        self._handled.add(fault.event)
        crew.watch.relax(self._handled, response)
        crew.obedience.ended = not self.suspended
        if not crew.obedience.has_vehicle:
            self._leave_untouched(fault)
            return
        if fault.event == LINK_LOST and self._await_link():
            return
        if response == NOTHING:
            self._stand_back()
            return
        if isinstance(fault, Ordered):
            seen = obeying(response, crew.robot, crew.vehicle, crew.pilot.track)
            crew.obedience.expect(fault.receipt, seen)
        holds = self._respond(fault, response)
        crew.obedience.conclude(undone(response, crew.robot, crew.vehicle, crew.near_home))
        crew.watch.moving = holds
        if holds and (fault.event == STOPPED or crew.desk.stop.is_set()):
            self._leave_it_holding()
        elif holds:
            self._watch_over()

    def _respond(self, fault: Fault, response: str) -> bool:
        """Carry out a response, or what is plainer; return whether the vehicle must be watched.

        One that does nothing of what it is told, and would not come down without us either, is stayed with.
        """
        crew = self._crew
        repeat, low = crew.obedience.repeat, fault.event == BATTERY_LOW
        try:
            return respond_or_less(
                response, crew.robot, crew.vehicle, crew.pilot.track, repeat, self._do_less, low=low
            )
        except Fault as hindrance:
            down = comes_down_alone(crew.robot, crew.vehicle, crew.pilot.waits.policies)
            if hindrance.event not in HINDRANCES or fault.event == STOPPED or down:
                raise
            crew.obedience.overtake(hindrance)
            self._tell_undone(hindrance, response)
            crew.watch.relax(self._handled, HOLD)
            return True

    def _do_less(self, response: str, why: Fault, less: str) -> None:
        """Tell that something plainer is done than a response."""
        crew = self._crew
        crew.obedience.overtake(why)
        crew.pilot.journal.decide(why.event, f"{response} cannot be carried out: {why}", less)
        crew.say(f"cannot carry out {response}: {why}; response: {less}")
        crew.watch.relax(self._handled, less)

    def _response_to(self, fault: Fault) -> str:
        crew = self._crew
        if fault.instead:
            return fault.instead
        if isinstance(fault, Ordered) and fault.response:
            return fault.response
        if fault.event == STOPPED:
            return crew.on_stop.upper()
        return response_to(fault.event, crew.robot, crew.pilot.waits.policies)

    def _tell(self, fault: Fault, response: str) -> None:
        self._crew.say(f"{fault.event}: {fault}; response: {response}")
        self._crew.pilot.journal.response = response
        self._crew.pilot.journal.decide(fault.event, str(fault), response)

    def _log(self, fault: Fault) -> None:
        """Log what has ended the program; nothing that comes after that is logged."""
        if self._logged:
            return
        self._logged = True
        try:
            self._crew.pilot.journal.fail(fault.event)
        except Fault as error:
            self._crew.say(f"the fault is not in the log: {error}")
        self._leave()

    def _leave_untouched(self, fault: Fault) -> None:
        """End where no vehicle was known to be the robot's: none is told anything."""
        self._crew.say("was told nothing: nobody knew yet whether the vehicle is the robot's")
        if not isinstance(fault, Ordered):
            return
        if self._crew.desk.log.steps[:-1]:
            fault.receipt.refuse("its vehicle was not known yet, and was told nothing")
        else:
            fault.receipt.confirm("nothing had begun")

    def _await_link(self) -> bool:
        """Stay with a vehicle that is out of reach: once it is heard again, it can be given orders.

        That lasts while others work, or for some time, and then until its motors are off.

        Returns:
            Whether nothing is left to do; else it is heard, and does nothing about its link by itself.

        Raises:
            Fault: somebody has ordered something, or wants all to stop, or a pilot has taken it over.
        """
        crew, clock = self._crew, self._crew.desk.clock
        if crew.link is None:
            return True
        # A stop from before the link was lost is not one that ends the listening.
        stopped = crew.desk.stop.is_set()
        limit, told = listening(clock), False
        until = clock.now() + limit
        try:
            while crew.link.listening and not crew.desk.abandon.is_set():
                heard = self._is_heard(crew.link, again=not told)
                if heard and not told:
                    answers, mode = crew.watch.accept(), crew.vehicle.state().mode
                    crew.say(f"is heard again, in mode {mode}: orders are obeyed")
                    if not answers:
                        return False
                elif not heard:
                    crew.watch.lose()
                    crew.obedience.refuse_all("its link is lost")
                told, crew.obedience.hands_off = heard, not heard
                if crew.desk.stop.is_set() and not stopped:
                    if heard:
                        raise Stopped()
                    return True
                until = clock.now() + limit if heard else until
                others_work = self._lose()
                over = clock.now() > until and not others_work
                if over or (heard and not crew.vehicle.state().armed):
                    return True
                crew.link.wait(lambda: None, clock.patience(0.0, GLANCE_SECONDS))
            return True
        finally:
            crew.obedience.hands_off = False
            crew.watch.find()

    def _is_heard(self, link: Link, *, again: bool) -> bool:
        """Return whether a vehicle is heard; `again`: a heartbeat shows in which mode it is by now."""
        return link.since("HEARTBEAT") < lately(link.clock) if again else is_heard(link)

    def _tell_undone(self, fault: Fault, response: str) -> None:
        why = f"{response} cannot be carried out: {fault}"
        self._crew.pilot.journal.decide(fault.event, why, NOTHING)
        self._crew.say(f"cannot carry out {response}: {fault}; take over by hand")

    def _give_up(self, fault: Fault, response: str) -> int:
        """Leave a vehicle as it is; return the exit code, which tells where nobody knows that it stopped."""
        crew = self._crew
        crew.pilot.journal.decide(fault.event, f"{response} cannot be carried out: {fault}", NOTHING)
        if fault.event == TAKEN_OVER or self._acts_by_itself():
            crew.say(f"{fault}")
            self._stand_back()
            return FAILED
        crew.say(f"cannot carry out {response}: {fault}; take over by hand")
        if crew.vehicle.state().armed:
            crew.say("heartbeats end now: the vehicle does what it does about a lost link")
        return LINK

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
        holds = self._crew.vehicle.state().mode == modes.HOLD
        self._crew.say(f"{'holds' if holds else 'is left as it is, and watched'}; interrupt to end")
        while not self._crew.desk.stop.is_set():
            self._crew.vehicle.rest(WATCH_SECONDS)

    def _leave_it_holding(self) -> None:
        """Have a vehicle that was stopped stay where it is when nobody talks to it any more.

        Raises:
            Fault: somebody has ordered something meanwhile, or has taken over, or the link is lost.
        """
        try:
            self._crew.vehicle.answer_lost_link(HOLD)
        except Refused as refusal:
            self._crew.say(f"{refusal}: it may not stay where it is when this program has ended")

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
        while crew.vehicle.state().armed and not crew.desk.abandon.is_set():
            self._let_time_pass(crew.link)
            crew.obedience.refuse_all("somebody else has the vehicle")
            if crew.desk.stop.is_set() and not told:
                told = True
                crew.say(KEPT_UP)

    def _let_time_pass(self, link: Link) -> None:
        """Wait a little, on and on: whoever has a vehicle that is no longer heard may still fly it."""
        crew = self._crew
        try:
            link.wait(lambda: None, crew.desk.clock.patience(0.0, WATCH_SECONDS))
        except Fault as lost:
            crew.watch.lose()
            crew.say(f"{lost}: heartbeats go on, since somebody else has it")
