"""Looks, during every wait, for what should end it."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mmrs_runtime.clock import Clock
from mmrs_runtime.controllers.return_paths import Track
from mmrs_runtime.faults import (
    BATTERY_LOW,
    GROUND_LOST,
    LINK_LOST,
    MOTOR_FAILED,
    POSITION_LOST,
    TAKEN_OVER,
    VEHICLE_RESTARTED,
    DisplacedError,
    FaultError,
)
from mmrs_runtime.policies import COMES_DOWN, CONTINUE, LAND, UNDECLARED_AFTER, seconds_of

from ..program import Policy, Robot
from ..vehicles.failsafe_events import Signs
from .departures import Departures, switched
from .energy import Reserve
from .ground import WATCHED, Ground
from .motors import Motors
from .responding import STOP_THRUST
from .responses import NO_ESCAPE, lacks_escape, policy_for

if TYPE_CHECKING:
    from ..links.link import Link
    from ..vehicles.mavlink_vehicle import MavlinkVehicle

LEAST_SILENCE = 2.0
BEAT_SECONDS = 3.0
"""For how long a heartbeat tells the mode of a vehicle that was out of reach, and is waited for."""

ANYWHERE = frozenset({LAND, "SURFACE", STOP_THRUST})
"""Responses that need neither a position nor much energy."""

GROUND_ONLY = f"carries on after {VEHICLE_RESTARTED} before it sets out only; in motion it does {{}} then"
CRITICAL = ("critical", "emergency")
"""Vehicles' messages about nearly empty batteries; of others, policies know the better response."""

Decide = Callable[[str, str, str], None]


@dataclass(frozen=True, slots=True)
class _Watched:
    """What there is to look at once there is a vehicle."""

    link: Link
    vehicle: MavlinkVehicle
    signs: Signs
    departures: Departures
    ground: Ground
    motors: Motors


class Watch:
    """Raises what ends a robot's program: a lost link, a pilot, and the events of policies.

    Attributes:
        current: the policies of the wait that the robot is in.
        track: the positions that the robot has passed in this sortie.
        decide: called with decisions that do not end the program: event, reason, response.
        say: reports messages of the robot to the operator.
        moving: whether the robot is in motion; one that stands on the ground may restart.
    """

    def __init__(self, robot: Robot, clock: Clock) -> None:
        """Watch for nothing until there is a vehicle."""
        self.current: Callable[[], Sequence[Policy]] = lambda: ()
        self.track: Callable[[], Track] = lambda: ()
        self.decide: Decide = lambda event, why, response: None
        self.say: Callable[[str], None] = lambda line: None
        self.moving = True
        self._robot = robot
        self._clock = clock
        self._reserve = Reserve(robot)
        self._watched: _Watched | None = None
        self._events: frozenset[str] | None = None
        self._hands_off = self._out_of_reach = False
        self._response = self._untold = ""
        self._anew = False
        self._since: dict[str, float] = {}
        self._borne: set[str] = set()

    def begin(self, link: Link, vehicle: MavlinkVehicle) -> None:
        """Watch link and vehicle."""
        profile = self._robot.profile
        signs = Signs(vehicle.telemetry, jumps=profile.watches_jumps, flies=profile.flies)
        departures = Departures(link, vehicle, signs, self._answers)
        motors = Motors(vehicle, profile)
        self._watched = _Watched(link, vehicle, signs, departures, Ground(link), motors)
        vehicle.insist(self._insists)

    def forewarn(self) -> None:
        """Report, before the robot moves, policies that do not apply, or not yet."""
        if policy_for(VEHICLE_RESTARTED, self._robot).response == CONTINUE:
            self.say(GROUND_ONLY.format(self._robot.profile.down))
        if lacks_escape(self._robot):
            self.say(NO_ESCAPE)
        if self._watched is not None and (missing := self._watched.ground.missing(self._robot)):
            self.say(missing)

    def relax(self, handled: Collection[str], response: str) -> None:
        """Watch for less from now on: the robot already responds to an event.

        Args:
            handled: the events that it has responded to.
            response: its response; what would prevent or end that is still watched for,
                and always the link, and external control.
        """
        watched = {POSITION_LOST, VEHICLE_RESTARTED, MOTOR_FAILED}
        if response not in COMES_DOWN:
            watched |= {BATTERY_LOW, GROUND_LOST}
        self._events = frozenset(watched - set(handled))
        self._response = response

    def let_go(self) -> None:
        """Watch only the link from now on: the vehicle is under external control."""
        self._events, self._hands_off = frozenset(), True

    def answers_alone(self) -> bool:
        """Return whether a vehicle whose link is restored has answered the loss with its failsafe.

        One that received messages all the time has not, and continues its last command.

        Raises:
            FaultError: a pilot has it, as far as is known, or its mode is unknown.
        """
        if self._watched is None:
            return True
        self._out_of_reach = self._hands_off = True
        try:
            return self._accept(self._watched)
        finally:
            self._out_of_reach = self._hands_off = False

    def _accept(self, watched: _Watched) -> bool:
        """Return whether a failsafe of the vehicle is active, and leave it active."""
        link, vehicle, answers = watched.link, watched.vehicle, True
        limit = self._clock.patience(BEAT_SECONDS, 1.0)
        if not link.wait(lambda: link.since("HEARTBEAT") < limit, limit):
            raise FaultError(LINK_LOST, "no heartbeat is received from it")
        if vehicle.telemetry.mode() not in vehicle.modes_alone and vehicle.telemetry.armed():
            answers = watched.departures.find(moving=self.moving) is not None
        vehicle.accept_own_modes()
        return answers

    def tighten(self) -> None:
        """Watch for everything again: the robot continues its program."""
        self._events, self._response = None, ""
        self._hands_off = False
        self.renew()

    def renew(self) -> None:
        """Forget what was: the vehicle is set up, or has another battery."""
        self._since.clear()
        self._borne.clear()
        self._anew = False
        self._reserve.begin()
        if self._watched is not None:
            self._watched.signs.renew()
            self._watched.motors.renew()
            self._watched.departures.taken = False

    @property
    def restarted(self) -> bool:
        """Return whether the vehicle has restarted since `renew`."""
        return self._anew or (self._watched is not None and self._watched.signs.restarted)

    @property
    def looking(self) -> bool:
        """Return whether it looks for the cause of a change of mode, while nothing may be sent."""
        return self._watched is not None and self._watched.departures.looking

    @property
    def taken(self) -> bool:
        """Return whether it has found that a pilot has taken over."""
        return self._watched is not None and self._watched.departures.taken

    def check(self) -> None:
        """Raise what should end a wait.

        Raises:
            FaultError: something should.
        """
        watched = self._watched
        if watched is None:
            return
        watched.vehicle.reports.renew()
        if self.looking:
            return
        self._check_link(watched.link)
        if self._hands_off:
            return
        # Whoever has the vehicle goes before all policies, also where both are seen at once.
        if (departure := watched.departures.find(moving=self.moving)) is not None:
            self._answer(*departure, watched)
        if self._response != STOP_THRUST:
            watched.motors.check(moving=self.moving)
        for event, why in watched.signs.seen(moving=self.moving):
            # A place that has leapt is wrong at once, and may stay so.
            self._weigh(event, why, at_once=event == POSITION_LOST and watched.signs.leapt)
        self._check_fallen(watched.signs)
        self._weigh(BATTERY_LOW, self._low(watched.vehicle))
        self._check_ground(watched.ground)

    def _check_fallen(self, signs: Signs) -> None:
        """Stop the motors of a vehicle that does not fly any more, whatever else it is to do about that.

        Raises:
            FaultError: it lies on the ground, or cannot stop falling.
        """
        borne = policy_for(MOTOR_FAILED, self._robot, self.current()).response == CONTINUE
        why = signs.fallen(in_air=not borne)
        if why and self._response != STOP_THRUST:
            raise FaultError(MOTOR_FAILED, why, STOP_THRUST)

    def _check_ground(self, ground: Ground) -> None:
        for line in (news := ground.news()):
            self.say(line)
        if news:
            self.decide(GROUND_LOST, news[0], WATCHED)
        policy = policy_for(GROUND_LOST, self._robot, self.current())
        why = ground.silence(policy)
        if not why:
            self._borne.discard(GROUND_LOST)
        elif GROUND_LOST not in self._borne and self._watches(GROUND_LOST):
            self._judge(GROUND_LOST, why, policy)

    def _low(self, vehicle: MavlinkVehicle) -> str:
        response = policy_for(BATTERY_LOW, self._robot, self.current()).response
        state = vehicle.state()
        low = self._reserve.low(state, response, self.track())
        if (untold := self._reserve.untold) != self._untold:
            self._untold = untold
            if untold:
                self.say(untold)
                self.decide(BATTERY_LOW, untold, WATCHED)
        return low or (vehicle.telemetry.battery_trouble() if state.armed and self.moving else "")

    def _weigh(self, event: str, why: str, *, at_once: bool = False) -> None:
        """Raise a fault for what has lasted long enough, or counts at once, and must not be tolerated."""
        if not why:
            self._since.pop(event, None)
            self._borne.discard(event)
            return
        if event in self._borne or not self._watches(event):
            return
        policy = policy_for(event, self._robot, self.current())
        limit = seconds_of(policy)
        since = self._since.setdefault(event, self._clock.now())
        if at_once or self._clock.now() - since >= limit:
            self._judge(event, why, policy)

    def _judge(self, event: str, why: str, policy: Policy) -> None:
        """Raise a fault, or record that it is tolerated."""
        if event == VEHICLE_RESTARTED:
            self._note_restart()
        if policy.response != CONTINUE:
            raise FaultError(event, why)
        self._borne.add(event)
        self.decide(event, why, CONTINUE)

    def _watches(self, event: str) -> bool:
        return self._events is None or event in self._events

    def _check_link(self, link: Link) -> None:
        policy = policy_for(LINK_LOST, self._robot, self.current())
        if self._out_of_reach or policy.response == CONTINUE:
            return
        limit = seconds_of(policy)
        silent = link.silent_for()
        if silent > self._clock.patience(limit, LEAST_SILENCE):
            why = f" ({link.trouble})" if link.trouble else ""
            if not self._hands_off:
                given = max(limit, UNDECLARED_AFTER[LINK_LOST])
                link.give_up(self._clock.patience(given, LEAST_SILENCE) + silent)
            raise FaultError(LINK_LOST, f"the vehicle has been silent for {silent:.0f} s{why}")

    def _answer(self, event: str, said: str, watched: _Watched) -> None:
        """Answer, as policies define, what the vehicle has answered by leaving its mode.

        If the robot tolerates that, or does the same already, the vehicle is brought back, if that makes
        sense; one that was out of reach, or stands still where it may restart, is left alone.

        Raises:
            FaultError: what is to be answered, or DisplacedError.
        """
        vehicle = watched.vehicle
        why = switched(event, said, vehicle.state().mode)
        if event == VEHICLE_RESTARTED:
            self._note_restart()
            if not self.moving:
                vehicle.take_back()
                return
        if self._answers(event):
            watched.departures.taken_back = self._clock.now()
            # Nothing explains its mode a second time, to an order that comes before the answer.
            vehicle.accept_mode()
            raise FaultError(event, why)
        if event == VEHICLE_RESTARTED:
            watched.motors.check_stands(said)
        elif hindrance := self._hindrance(event, said, vehicle):
            raise FaultError(event, f"{why}; {hindrance}", LAND)
        self._take_back(event, why, watched.departures)
        raise DisplacedError(event, why)

    def _note_restart(self) -> None:
        """Take a restart for known, which explains no other mode after this; the vehicle is to be set up."""
        self._anew = True
        if self._watched is not None:
            self._watched.signs.renew()

    def _insists(self, fault: FaultError) -> bool:
        """Return whether a vehicle that leaves its commanded mode is commanded again."""
        assert self._watched is not None
        vehicle, departures = self._watched.vehicle, self._watched.departures
        event, said = fault.event, vehicle.telemetry.announcements.of_this_mode
        if event == TAKEN_OVER or self._answers(event):
            return False
        why = said(event, departures.taken_back)
        if not why or self._hindrance(event, why, vehicle):
            return False
        self._take_back(event, f"{why}; {fault}", departures)
        return True

    def _take_back(self, event: str, why: str, departures: Departures) -> None:
        goes_on = self._response or CONTINUE
        departures.taken_back = self._clock.now()
        self.decide(event, why, goes_on)
        self.say(f"takes its vehicle back, {goes_on} continues: {event}: {why}")

    def _hindrance(self, event: str, said: str, vehicle: MavlinkVehicle) -> str:
        """Return why a vehicle with an active failsafe is not brought back; empty if it is.

        Args:
            event: that it answers.
            said: its message about that.
            vehicle: it.
        """
        if self._response in ANYWHERE:
            return ""
        if vehicle.telemetry.position_trouble():
            return "without a position it cannot be taken back"
        if event != BATTERY_LOW or not any(word in said.lower() for word in CRITICAL):
            return ""
        short = self._reserve.short(vehicle.state(), self._response, self.track())
        return f"it is not taken back: {short}" if short else ""

    def check_hands(self, event: str) -> None:
        """Check, right before the vehicle is commanded to respond, that no pilot has just taken control.

        Args:
            event: that is responded to; a mode in which the vehicle's failsafe answers it is not a pilot's.

        Raises:
            FaultError: one has.
        """
        if event == LINK_LOST:
            self.answers_alone()
        elif self._watched is not None:
            self._watched.departures.check(event, moving=self.moving)

    def _answers(self, event: str) -> bool:
        """Return whether the robot is to answer an event that happens now."""
        borne = policy_for(event, self._robot, self.current()).response == CONTINUE
        return self._watches(event) and not borne
