"""A robot that is driven by hand: a thread moves the sticks, the engine asks how far it is."""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence
from math import inf

from mmrs_core.behaviour.program import DEVICE_ACTION, Action, Move
from mmrs_core.contributions.execution import Fault, RobotState
from mmrs_core.contributions.vehicles import Live, VehicleInput
from mmrs_core.errors import UnreachableError
from mmrs_core.scene import Position
from mmrs_mavlink.links.link import Link
from mmrs_mavlink.plugin.context import VehicleContext
from mmrs_mavlink.plugin.manual.autopilot import DEPTH_HOLD, SURFACE, StickAutopilot
from mmrs_mavlink.plugin.manual.goals import carry_out, goal_of
from mmrs_mavlink.plugin.manual.route import Route, Ways
from mmrs_mavlink.plugin.manual.steering import StickSteering
from mmrs_mavlink.plugin.manual.troubles import LINK_PATIENCE, Troubles
from mmrs_mavlink.profiles import ARDUSUB
from mmrs_runtime import faults
from mmrs_runtime.controllers.box_entries import FIX_SECONDS, PROCESS, fix
from mmrs_runtime.controllers.state import State, status_of
from mmrs_runtime.controllers.vocabulary import Local
from mmrs_runtime.policies import NOTHING, OVERTAKES, response_to
from mmrs_runtime.vehicle import Vehicle

UNANSWERED = 60.0
"""Seconds of silence after which a commanded vehicle is no longer waited for."""

PERIOD = 0.1
"""Seconds from one message of the sticks to the next; ArduSub gives up after three."""

NEAR_THE_SURFACE = 0.4
"""A vehicle at less than this depth, in metres, has come up. MAVLink rounds depths to millimetres."""

RESTS, FINDS, STAYS = (NOTHING, "STOP_THRUST"), ("RETURN", "EMERGENCY_AREA"), ("HOLD", "CONTINUE")
OFF = (faults.MOTORS_OFF, faults.VEHICLE_RESTARTED)
OURS_NO_MORE = (faults.LINK_LOST, faults.TAKEN_OVER, *OFF)
"""Faults that leave a vehicle disarmed; and those after which it does not carry out its command."""

UNKNOWN = "its position is unknown since it surfaced: bring it home"


class ManualRobot(Vehicle):
    """A vehicle in depth hold, and the thread that moves its sticks."""

    def __init__(
        self, given: VehicleInput, context: VehicleContext, link: Link, live: Live, full_speed: float
    ) -> None:
        """Create for the robot; nothing is sent before it is to get ready."""
        self._ways = Ways(given, context)
        self._context, self._link, self._live = context, link, live
        self._steering = StickSteering(self._ways.home[0], self._ways.home[1], full_speed)
        self._route = Route(self._steering)
        self._lock = threading.RLock()
        self._ended = threading.Event()
        reserve, resumed = given.program.reserve, live.resumed
        self._autopilot = StickAutopilot(link, self._ended.is_set, reserve, under_way=resumed)
        self._policies = (*context.robot.policies, *given.policies)
        self._troubles = Troubles(self._autopilot, self._policies)
        self._box = live.black_box(given.robot.id)
        self._fixed, self._plan = -inf, given.program.fingerprint
        self._thread: threading.Thread | None = None
        self._own: Fault | None = None
        self._ready = self._released = self._lost = self._bears = False
        self._response = self._instead = ""
        self._answered: set[str] = set()
        self._busy_until: float | None = None
        self._action: Action | None = None

    def prepare(self, now: float) -> bool:
        """Begin to listen, go into depth hold and arm."""
        self.done, self.trouble = False, None
        about = {"link": "mavlink", "vehicle": ARDUSUB.vehicle, "confirms": False}
        self.note("start", {"plan": self._plan, "process": PROCESS, **about})
        self._thread = threading.Thread(target=self._drive, name="sticks", daemon=True)
        self._thread.start()
        return True

    def do(self, order: object, now: float, *, through: bool = False) -> None:
        """Begin a grounded movement or action."""
        self.done, self.trouble = False, None
        if not isinstance(order, Move):
            assert isinstance(order, Action)
            self._act(order)
            return
        with self._lock:
            goal = goal_of(order, self._steering, self._context, self._route.depth)
            self._busy_until, self._own = now, None
            if goal is not None:
                self._route.go((goal,), now)

    def _act(self, action: Action) -> None:
        """Begin a device action, as its device is wired; feedback goes to people."""
        if not action.is_a(DEVICE_ACTION):
            said = (action.name, *(f"{key}={value}" for key, value in action.parameters))
            self._live.say(" ".join(filter(None, said)))
            self.note("reported", {"name": action.name, **dict(action.parameters)})
            return
        with self._lock:
            self._action, self._own = action, None
        threading.Thread(target=self._do, args=(action,), name="device", daemon=True).start()

    def look(self, now: float) -> float:
        """Look for faults, and whether the last order has finished; the vehicle continues meanwhile."""
        with self._lock:
            found = self._troubles.lasting() or self._own
            self.trouble = self._hinders(found) if self._response and found is not None else found
            self.done = (self.trouble is None or self._bears) and self._has_finished(now)
            self._bears = False
            return now

    def _has_finished(self, now: float) -> bool:
        if self._response:
            return self._has_stopped(now)
        done = self._ready and self._route.reached and self._action is None
        return done and self._own is None and (self._busy_until is None or now >= self._busy_until)

    def bear(self, now: float) -> bool:
        """Continue although there is a fault that policies tolerate."""
        self._bears = True
        with self._lock:
            if self._troubles.lasting() is not None:
                self._troubles.bear()
            else:
                self._own = None
            return True

    def wait(self, now: float) -> None:
        """Hold the pose."""
        with self._lock:
            self._route.stay(self._route.depth)

    def state(self, now: float) -> RobotState:
        """Return where the robot is by reckoning, and its battery."""
        with self._lock:
            steering = self._steering
            charge = self._autopilot.charge()
            return RobotState(now, self._here(), steering.speed, steering.heading, None, charge)

    def respond(self, response: str, now: float) -> None:
        """Carry out a response, or surface where that is impossible; its fault is reported no more."""
        if self.trouble is not None:
            self._answered.add(self.trouble.which)
        self.done, self.trouble = False, None
        with self._lock:
            self._action = self._route.paused = None
            self._response, self._instead = response, ""
            blind = self._troubles.event == faults.POSITION_LOST
            if response in RESTS:
                self._released = response == NOTHING
                self._ended.set()
            elif response in STAYS:
                self._autopilot.rising = False
                self._route.stay(self._steering.depth)
            elif response in FINDS and blind:
                self._come_up(now, "its heading or depth is not known: it comes up")
            elif response in FINDS:
                self._find(response, now)
            else:
                self._come_up(now)

    @property
    def pauses(self) -> bool:
        """Return that it can halt in the middle of anything."""
        return True

    def pause(self, now: float) -> None:
        """Begin to halt."""
        with self._lock:
            self._route.pause()

    def resume(self, now: float) -> None:
        """Continue."""
        with self._lock:
            self._route.resume(now)

    def paused(self, now: float) -> bool:
        """Return whether the vehicle has halted."""
        return self._route.paused is not None and self._steering.reached and self._autopilot.armed

    def obeys(self, now: float) -> bool:
        """Return whether the vehicle carries out its last response."""
        if self._response in RESTS:
            return self._has_stopped(now)
        ours = self._troubles.event not in OURS_NO_MORE
        mode = SURFACE if self._autopilot.rising else DEPTH_HOLD
        return self.reachable(now) and ours and self._autopilot.mode == mode

    def watched(self, now: float) -> bool:
        """Return whether the vehicle holds by thrust, so that an operator must stay."""
        off = self._troubles.event in OFF
        return self._response in STAYS and not off and self._ready and self._autopilot.silent <= UNANSWERED

    def undone(self, now: float) -> str:
        """Return why it has stopped without carrying out its order."""
        if self._response not in RESTS and self._troubles.event in OFF:
            return f"it is disarmed ({self._troubles.event}): it surfaces if it is buoyant"
        return self._instead

    def reachable(self, now: float) -> bool:
        """Return whether the vehicle was received lately."""
        return not self._autopilot.is_silent(LINK_PATIENCE)

    @property
    def comes_home(self) -> bool:
        """Return that it knows the return path."""
        return True

    def recover(self, passed: Sequence[str], begun: str, now: float) -> bool:
        """Go back to where the last of the moves ended, round forbidden areas and obstacles."""
        self.done, self.trouble = False, None
        with self._lock:
            self._response, self._own = "", None
            self._answered.clear()
            if why := self.hindrance(passed, begun, now):
                self._own = Fault(faults.REFUSED, why)
            else:
                self._route.go(self._ways.back(passed, self._here()), now)
        return True

    def hindrance(self, passed: Sequence[str], begun: str, now: float) -> str:
        """Return why it cannot continue."""
        with self._lock:
            if self._lost:
                return UNKNOWN
            try:
                self._ways.back(passed, self._here())
            except UnreachableError as error:
                return f"no path is known back to where its program was broken off: {error}"
            return ""

    def away(self, now: float) -> str:
        """Return how far from home it is, by reckoning; empty at home."""
        return self._ways.away(self._steering.east, self._steering.north)

    def moves(self, now: float) -> bool:
        """Return whether the vehicle may move by thrust at any moment."""
        return self.reachable(now) and self._autopilot.armed

    def status(self) -> Mapping[str, object]:
        """Return what the vehicle has told last."""
        if not self._ready:
            return {}
        return status_of(self._reported(self._live.clock.now()))

    def note(self, kind: str, content: Mapping[str, object]) -> None:
        """Keep something in the black box."""
        if self._box is not None:
            self._box.write(kind, **content)

    def close(self) -> None:
        """Release the sticks, disarm unless the vehicle is under external control, and fall silent."""
        self._ended.set()
        if self._thread is not None:
            self._thread.join(10.0)
        self._link.close()
        if self._box is not None:
            self._box.close()

    def _drive(self) -> None:
        try:
            self._autopilot.get_ready(self._live.say)
            with self._lock:
                self._steering.depth = self._route.depth = self._autopilot.depth() or 0.0
                self._ready = True
            self._live.wake()
            while not self._ended.wait(self._link.clock.real(PERIOD)):
                self._tick()
        except faults.FaultError as fault:
            self._troubles.begin(Fault(fault.event, str(fault)))
        except faults.FAILURES as error:
            self._troubles.begin(Fault(faults.REFUSED, f"{type(error).__name__}: {error}"))
        finally:
            self._let_go()
            self._live.wake()

    def _tick(self) -> None:
        with self._lock:
            now, before = self._live.clock.now(), (self._troubles.event, self._steering.reached)
            self._troubles.look(now)
            self._steer(now, self._troubles.event)
            self._see_progress(now)
            changed = before != (self._troubles.event, self._steering.reached)
            if self._box is not None and now - self._fixed >= FIX_SECONDS:
                self._fixed = now
                fix(self._box, self._reported(now))
        if changed:
            self._live.wake()

    def _steer(self, now: float, trouble: str) -> None:
        """Move the sticks, unless the vehicle is under external control."""
        if trouble in (faults.TAKEN_OVER, *OFF) or not self._autopilot.armed:
            self._steering.drift(now)
        elif self._autopilot.rising:
            self._steering.drift(now)
            self._steering.depth = self._autopilot.depth() or 0.0
            self._autopilot.rise()
        elif self._autopilot.mode == SURFACE:
            self._steering.drift(now)
            self._autopilot.stay()
        elif not self._autopilot.knows:
            self._autopilot.move(self._steering.drift(now))
        else:
            heading, depth = self._autopilot.heading(), self._autopilot.depth()
            self._autopilot.move(self._steering.step(now, heading or 0.0, depth or 0.0))

    def _see_progress(self, now: float) -> None:
        if not self._steering.reached:
            if now > self._route.late_at and self._own is None:
                self._own = Fault(faults.NO_PROGRESS, "its goal is not reached in time", "SURFACE")
        elif not self._route.reached:
            self._route.go_on(now)
        elif self._response in FINDS and not self._autopilot.rising:
            self._come_up(now, self._instead)

    def _do(self, action: Action) -> None:
        found: Fault | None = None
        seconds = 0.0
        try:
            seconds = carry_out(action, self._context, self._autopilot)
        except faults.FaultError as fault:
            found = Fault(faults.DEVICE_SILENT, str(fault))
        with self._lock:
            if self._action is action:
                self._own, self._action = found, None
                self._busy_until = self._live.clock.now() + seconds
        self._live.wake()

    def _hinders(self, found: Fault) -> Fault | None:
        """Return what keeps the vehicle from carrying out its response."""
        if self._response == NOTHING:
            return None
        if found.which == faults.TAKEN_OVER or (found.which == faults.LINK_LOST and self._silent()):
            return found
        if found.which == faults.CRASHED and self._response != "SURFACE":
            return found
        if found.which in (faults.POSITION_LOST, faults.NO_PROGRESS) and self._response in FINDS:
            return Fault(found.which, found.reason, "SURFACE") if not self._autopilot.rising else None
        if found.which in OVERTAKES - self._answered and self._response not in RESTS:
            return found if response_to(found.which, self._policies) != "CONTINUE" else None
        return None

    def _has_stopped(self, now: float) -> bool:
        trouble = self._troubles.event
        driven = self._ready and self._thread is not None and self._thread.is_alive()
        if self._response == NOTHING or not driven or trouble in OFF:
            return True
        if self._autopilot.rising and now > self._route.late_at:
            self._instead = (
                f"it is not known to have come up: {self._steering.depth:.1f} m deep at the last message"
            )
            return True
        if trouble == faults.LINK_LOST:
            return False
        if self._autopilot.rising:
            return self._autopilot.knows_depth and self._steering.depth < NEAR_THE_SURFACE
        held = self._steering.reached or not self._autopilot.knows
        return self._response in STAYS and self._autopilot.mode == DEPTH_HOLD and held

    def _silent(self) -> bool:
        return self._autopilot.silent > UNANSWERED

    def _find(self, response: str, now: float) -> None:
        """Go round forbidden areas and obstacles to home or to an emergency area, then come up."""
        goals = self._ways.for_response(response, self._here())
        if goals:
            self._autopilot.rising = False
            self._route.go(goals, now)
        else:
            self._come_up(now, "no path there is known: it surfaces where it is")

    def _come_up(self, now: float, instead: str = "") -> None:
        self._route.come_up(now)
        self._instead = instead
        self._lost = self._autopilot.rising = True

    def _reported(self, now: float) -> State:
        """Return what the vehicle tells, as black boxes and people have it: places count from its home."""
        steering, (east, north, _) = self._steering, self._ways.home
        place = Local(steering.north - north, steering.east - east, -steering.depth)
        speed, heading, charge = steering.speed, steering.heading, self._autopilot.charge()
        armed = self._autopilot.armed
        return State(now, place, speed, heading, charge, self._autopilot.word(), armed=armed)

    def _here(self) -> Position:
        return (self._steering.east, self._steering.north, self._context.zero - self._steering.depth)

    def _let_go(self) -> None:
        """Let the sticks go; disarm where the robot is still ours and its mode is."""
        if self._released or not self._ready:
            return
        try:
            self._autopilot.let_go(at_once=self._response == "STOP_THRUST")
        except faults.FaultError as fault:
            self._live.say(f"could not be disarmed: {fault}")
