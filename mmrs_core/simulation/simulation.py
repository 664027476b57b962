"""The kinematic simulation: a backend that moves a robot as its kind and its moves' kinds say.

A robot follows the path of each move at the commanded speed, in the time that the move kind declares;
wind and current slow it down where it would have to be faster than it can. Its batteries fall by mean
power and time, faster in a climb and against the wind (`mmrs_core.simulation.legs`); on the ground, a
robot that flies takes nothing. Holding a position in more wind than the type states
(`RobotKind.position_hold`)
is a fault. An object of unknown position is taken to be where the robot looks for it. Where there are
surroundings, a robot that flies detects what lies below it whenever one of its devices does something.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import replace
from math import dist, hypot, inf
from operator import attrgetter
from pathlib import Path

from mmrs_core.behaviour.as_scene import robot_of
from mmrs_core.behaviour.program import BEHAVIOUR, DEVICE_ACTION, Action, Heading, Move
from mmrs_core.contributions.execution import Fault, RobotState, Sample
from mmrs_core.contributions.passages import Passages
from mmrs_core.contributions.rules import MoveKind, robot_kind_of
from mmrs_core.contributions.vehicles import VehicleFactory, VehicleInput
from mmrs_core.errors import InternalError, UsageError
from mmrs_core.planning.devices import figure
from mmrs_core.scene import DISTANCE, Position
from mmrs_core.scene.headings import bearing
from mmrs_core.scene.passing import Passage
from mmrs_core.scene.timing import STANDING, Push
from mmrs_core.simulation.battery import SLACK, SimulatedBattery
from mmrs_core.simulation.escape import Escapes
from mmrs_core.simulation.known import kinematics_of, move_kinds_of
from mmrs_core.simulation.legs import (
    STILL,
    Flow,
    Stretch,
    TimedLeg,
    cost,
    current,
    response_stretches,
    stretches,
    wind,
)
from mmrs_core.simulation.surroundings import sights_in
from mmrs_runtime.policies import in_precedence
from mmrs_runtime.sights import seen
from mmrs_runtime.vehicle import Vehicle

RECHARGE = (BEHAVIOUR, "Recharge")
STOP = (BEHAVIOUR, "Stop")
SURROUNDINGS = "surroundings"
_BEGIN = attrgetter("begin")


class SimulatedRobot(Vehicle):
    """A robot that exists only here.

    Attributes:
        notes: what the simulation took for granted.
    """

    def __init__(self, given: VehicleInput) -> None:
        """Put a robot at its home, with full batteries.

        Raises:
            UnsupportedError: if no plug-in provides its robot kind, or the kind of one of its moves or
                actions; lists them.
            UsageError: if an option other than ``surroundings`` is given.
            UnreadableError: if that is no such file.
        """
        for option in sorted(set(given.options) - {SURROUNDINGS}):
            raise UsageError(f"option '{option}': unknown; the simulation has no links, disk or clock")
        surroundings = given.options.get(SURROUNDINGS)
        self._sights = () if surroundings is None else sights_in(Path(surroundings))
        self._places: dict[str, Position] = {}
        self._given, self._robot = given, robot_of(given.robot, given.type, given.program.position_error)
        self._kinematics, self._kinds = kinematics_of(given), move_kinds_of(given)
        local = given.program.frame.is_local
        self._passages = Passages(given.robot, given.type, given.move_kinds, self._kinematics, local=local)
        policies = in_precedence(given.robot.policies, given.policies)
        self._escapes = Escapes(given, self._kinematics, self._robot.home)
        self._battery = SimulatedBattery(self._kinematics, self._escapes, policies)
        self.notes: list[str] = []
        self._wind, self._current = wind(given.environment), current(given.environment)
        self._grounded, self._stopped, self._halted = True, False, False
        self._passed: Passage | None = None
        self._facing: float | None = None
        self._push: Push | None = STANDING
        self._bears = False
        self._repeats: dict[str, tuple[float, float]] = {}
        self._move: Move | None = None
        self._fault: Fault | None = None
        home = self._robot.home
        self._legs = [TimedLeg(0.0, 0.0, home, home, (0.0, 0.0), self._battery.capacity, 0.0)]
        self._first = 0

    def do(self, order: object, now: float, *, through: bool = False) -> None:
        """Begin a grounded movement or action; a device that the type does not have stays silent."""
        self.done, self.trouble = False, None
        self._catch_up(now)
        if isinstance(order, Move):
            self._begin(order, now, through)
        elif isinstance(order, Action):
            self._act(order, now)
        else:
            raise InternalError(f"{order!r}: neither a move nor an action")

    def _begin(self, move: Move, now: float, through: bool) -> None:
        kind = self._kinds[move.id]
        if self._state not in kind.needs:
            needed = " or ".join(sorted(kind.needs))
            self._fault = Fault("STATE", f"{move.kind} '{move.id}' needs it {needed}, it is {self._state}")
            return
        self._move = move
        if kind.leaves in ("airborne", "moving"):
            self._grounded = False
        here = self._legs[-1].finish
        path = kind.path(move, here, self._given.robot.home)
        if path is None:
            self.notes.append(f"move '{move.id}': object taken to be where the robot looks for it")
            path = (here,)
        self._travel(move, kind, path, now, through)

    def _act(self, action: Action, now: float) -> None:
        seconds = 0.0
        if action.is_a(DEVICE_ACTION):
            device = self._given.type.devices.get(action.device)
            supported = device.actions.get(action.name) if device else None
            if supported is None:
                self._fault = Fault("DEVICE_SILENT", f"'{action.device}' does not do '{action.name}'")
                return
            seconds = supported.duration
            self._look(self._leg(now).position(now))
            self._repeat(action, now)
        self._stay(now, seconds)

    def wait(self, now: float) -> None:
        """Hold the pose; energy continues to fall."""
        self._catch_up(now)
        self._stay(now, inf)

    def look(self, now: float) -> float:
        """See what is wrong, and otherwise whether the movement or action has finished."""
        flow = self._flow()
        self.trouble = self._fault or self._battery.fault(self._leg(now), now, flow)
        if self.trouble is None or self._bears:
            self.done = self._has_finished(now)
        self._bears = False
        return self._next_event(now, flow)

    def bear(self, now: float) -> bool:
        """Tolerate the present trouble."""
        self._bears = True
        return True

    def _has_finished(self, now: float) -> bool:
        if self._legs[-1].end > now + SLACK:
            return False
        if self._move is not None:
            self._arrive(self._move)
            self._move = None
        return True

    def _next_event(self, now: float, flow: Flow) -> float:
        if self._fault is not None:
            return now
        if self._legs[-1].end <= now:
            return inf
        events = [self._legs[-1].end]
        for leg in self._legs[self._leg_index(now) :]:
            events += self._battery.events(leg, now, flow)
        return min([event for event in events if event > now], default=inf)

    def state(self, now: float) -> RobotState:
        """Return where the robot is."""
        leg = self._leg(now)
        speed = leg.speed if now < leg.end else 0.0
        return RobotState(
            now,
            leg.position(now),
            speed,
            leg.heading(now),
            self._battery.energy(leg.charge_at(now)),
            detected=frozenset(self._places),
            places=self._places,
        )

    def respond(self, response: str, now: float) -> None:
        """Carry out the response to a fault from where the robot is; only the first call counts."""
        if self._halted:
            return
        moving = self._leg(now).speed > 0.0
        self._catch_up(now)
        self._halted, self._move = True, None
        path = self._escapes.clear(response, self._legs[-1].finish)
        if self._legs[-1].charge_at(now) <= SLACK or len(path) < 2:
            return
        self._append(response_stretches(path, self._kinematics, self._flow(), moving=moving), now)
        self._cut_where_empty()

    def track(self) -> tuple[Sample, ...]:
        """Return the robot's track, in order of time."""
        samples: list[Sample] = []
        for leg in self._legs:
            end = leg.end if leg.end < inf else leg.begin
            for time, position in ((leg.begin, leg.start), (end, leg.finish)):
                sample = Sample(time, *position, self._battery.energy(leg.charge_at(time)))
                if not samples or samples[-1] != sample:
                    samples.append(sample)
        return tuple(samples)

    def _repeat(self, action: Action, now: float) -> None:
        """Begin to repeat an action in passing, or look at once at what it has shown since it began."""
        if action.device in self._repeats:
            since, every = self._repeats.pop(action.device)
            for leg in self._legs:
                if since < leg.end and leg.begin < now:
                    way = dist(leg.start, leg.finish)
                    for index in range(1, int(way / every) + 1):
                        share = index * every / way
                        self._look(leg.position(leg.begin + share * (leg.end - leg.begin)))
        every = figure(dict(action.parameters), DISTANCE) or 0.0
        if every > 0.0:
            self._repeats[action.device] = now, every

    def _look(self, place: Position) -> None:
        """Detect what lies below a place."""
        east, north, up = place
        surface = self._given.program.frame.surface
        for each in seen(self._sights, north, east, up - surface) if self._state == "airborne" else ():
            self._places[each.name] = (each.east, each.north, surface - each.depth)

    def _travel(
        self, move: Move, kind: MoveKind, path: tuple[Position, ...], now: float, through: bool
    ) -> None:
        kinematics = replace(self._passages.kinematics(move), facing=self._facing, push=self._push)
        rates = kinematics.rates(move.speed)
        turning = rates.turning(path[0], path[1], self._facing) if len(path) > 1 else 0.0
        ahead = self._passages.ahead(move, path, self._passed, self._push) if through else None
        seconds = kind.seconds(move, path, kinematics, self._robot.travel_mode).expected
        seconds -= turning + (self._passed.onward if self._passed is not None else 0.0)
        self._facing = self._passages.facing(move, path, self._facing) if ahead is None else None
        self._push = self._passages.push(move, path, self._push)
        if ahead is not None:
            seconds -= ahead.saved
        self._passed = ahead
        found = stretches(path, rates, max(0.0, seconds), kinematics, flow=self._flow())
        if not found:
            self._fault = Fault("WIND", "too strong to make headway")
            return
        if turning > 0.0:
            found = (Stretch(path[0], path[0], turning, 1.0), *found)
        self._append(found, now, move.heading, free=move.is_a(RECHARGE))
        if all(bearing(each.start, each.finish) is None for each in found):
            self._hold_against_wind(sum(each.seconds for each in found))

    def _append(
        self, found: tuple[Stretch, ...], now: float, look: Heading | None = None, *, free: bool = False
    ) -> None:
        self._first = len(self._legs)
        begin = now
        for each in found:
            last = self._legs[-1]
            heading = None if look is None else look.seen_from(each.finish)
            if heading is None:
                heading = bearing(each.start, each.finish)
            goal = last.headings[1] if heading is None else heading
            first = last.headings[1] if each.start == each.finish else goal
            rate = 0.0 if free or self._costs_nothing() else each.rate
            charge = last.charge_at(last.end if last.end < inf else begin)
            end = begin + each.seconds
            self._legs.append(TimedLeg(begin, end, each.start, each.finish, (first, goal), charge, rate))
            begin = end

    def _stay(self, now: float, seconds: float) -> None:
        here = self._legs[-1].finish
        rate = cost(here, here, seconds, self._kinematics, self._flow())
        self._append((Stretch(here, here, seconds, rate),), now)
        self._passed = None
        self._hold_against_wind(seconds)

    def _arrive(self, move: Move) -> None:
        if self._kinds[move.id].leaves == "grounded":
            self._grounded = True
        if move.is_a(STOP):
            self._stopped = True
        if move.is_a(RECHARGE):
            last = self._legs[-1]
            full, faces = self._battery.capacity, (last.headings[1], last.headings[1])
            self._legs.append(TimedLeg(last.end, last.end, last.finish, last.finish, faces, full, 0.0))

    def _catch_up(self, now: float) -> None:
        """End what is going on at this time, or fill the time since it ended; what was wrong is over."""
        self._fault = None
        while len(self._legs) > 1 and self._legs[-1].begin > now:
            self._legs.pop()
        last = self._legs[-1]
        if last.end > now:
            self._legs[-1] = last.until(now)
        elif last.end < now:
            here = last.finish
            self._append((Stretch(here, here, now - last.end, 1.0),), last.end)

    def _leg_index(self, now: float) -> int:
        last = len(self._legs) - 1
        if self._legs[last].begin <= now:
            return last
        return max(0, bisect_right(self._legs, now, lo=min(self._first, last), key=_BEGIN) - 1)

    def _leg(self, now: float) -> TimedLeg:
        return self._legs[self._leg_index(now)]

    @property
    def _state(self) -> str:
        if not self._kinematics.launches:
            return "moving"
        return "grounded" if self._grounded else "airborne"

    def _flow(self) -> Flow:
        """Return the velocity of what the robot moves in: the air, the water, or neither."""
        if self._kinematics.launches:
            return STILL if self._grounded else self._wind
        surface = self._given.program.frame.surface
        dives = self._kinematics.floor < surface >= self._kinematics.ceiling
        in_water = dives or self._legs[-1].finish[2] < surface
        return self._current if in_water else STILL

    def _costs_nothing(self) -> bool:
        return self._stopped or (self._kinematics.launches and self._grounded)

    def _hold_against_wind(self, seconds: float) -> None:
        kind = robot_kind_of(self._given.type, self._given.robot_kinds)
        limit = self._given.type.part.attributes.get(kind.position_hold) if kind is not None else None
        flow = hypot(*self._flow())
        if isinstance(limit, int | float) and self._kinematics.launches and seconds > 0.0 and flow > limit:
            self._fault = Fault("WIND", f"{flow:g} m/s, but the robot holds its position up to {limit:g} m/s")

    def _cut_where_empty(self) -> None:
        for index in range(self._first, len(self._legs)):
            if self._legs[index].empty_at < self._legs[index].end:
                self._legs[index:] = [self._legs[index].until(self._legs[index].empty_at)]
                return


SIMULATION = VehicleFactory(
    name="simulation",
    description="moves robots in simulated time, without dynamics",
    connect=SimulatedRobot,
    simulated=True,
)
