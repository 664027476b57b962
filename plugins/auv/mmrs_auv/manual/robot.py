"""A robot that is driven by hand: a thread moves the sticks, the interpreter asks how far it is."""

from __future__ import annotations

import threading
from collections.abc import Callable
from math import degrees
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_auv.manual.goals import goal_of, refusals
from mmrs_auv.manual.helm import Goal, Helm, Sticks
from mmrs_auv.targets.moves import seconds_of
from mmrs_core.behaviour.program import Action, Move
from mmrs_core.contributions.backends import BackendInput, Live
from mmrs_core.contributions.execution import Fault, RobotState
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.contributions.wiring import Wired
from mmrs_core.errors import LinkLostError, UnsupportedError
from mmrs_core.flight import faults
from mmrs_core.flight.links.link import Link
from mmrs_core.flight.links.ports import split_system
from mmrs_core.flight.links.radios import Radios
from mmrs_core.flight.services.commands import command
from mmrs_core.mavlink.actions import DEVICE_ACTION
from mmrs_core.mavlink.backend.connection import FIRST_PORT, PORT_STEP, FollowingClock
from mmrs_core.mavlink.context import RobotContext, context_of

DEPTH_HOLD = 2
PERIOD = 0.1
"""Seconds from one message of the sticks to the next; ArduSub gives up after three."""

TOLD = (mavlink.MAVLINK_MSG_ID_ATTITUDE, mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT)
TOLD_EVERY = 100_000
"""Microseconds."""

NEEDED, STALE = ("ATTITUDE", "GLOBAL_POSITION_INT"), 2.0
"""What heading and depth are told by, and after how many seconds without they are not known any more."""

LINK_PATIENCE, FIRST_SIGN = 5.0, 60.0
INSISTING, PATIENCE = 12, 3.0
"""Times that something is asked for until it is done, and seconds between them."""

FULL_SPEED = "full-speed"


def connect(given: BackendInput) -> ManualRobot:
    """Return a robot at the end of its link.

    Raises:
        UnsupportedError: an option is unknown, the robot is no underwater vehicle, or it cannot be driven
            to do all of its program by hand; lists all of it.
        LinkLostError: the port cannot be opened.
    """
    unknown = sorted(set(given.options) - {FULL_SPEED})
    if unknown:
        raise UnsupportedError(f"option '{unknown[0]}': the backend has {FULL_SPEED}, metres per second")
    speed = _full_speed(given)
    if given.live is None:
        raise UnsupportedError("backend 'ardusub-manual': drives robots in real time; 'mmrs run' does that")
    types = {**given.types, given.type.name: given.type}
    input = TargetInput(given.program, types, given.robot_kinds, given.move_kinds)
    context = context_of(given.robot, input, geographic=False)
    found = list(refusals(context))
    if found:
        raise UnsupportedError(f"robot '{given.robot.id}': cannot be driven to do all of it by hand", found)
    return ManualRobot(context, _link(given, given.live), given.live, speed)


def _full_speed(given: BackendInput) -> float:
    said = given.options.get(FULL_SPEED)
    try:
        speed = given.type.capabilities[0].speed[1] if said is None else float(said)
    except ValueError as error:
        raise UnsupportedError(f"option '{FULL_SPEED}': '{said}' is no number") from error
    if not 0.05 <= speed <= 20.0:
        raise UnsupportedError(f"option '{FULL_SPEED}': {speed:g} m/s is no speed of an underwater vehicle")
    return speed


def _link(given: BackendInput, live: Live) -> Link:
    number = [robot.id for robot in given.program.robots].index(given.robot.id)
    usual = f"udpin:127.0.0.1:{FIRST_PORT + PORT_STEP * number}"
    try:
        url, system = split_system(live.links.get(given.robot.id, usual))
        return Radios(FollowingClock(live.clock)).open(url, system)
    except ValueError as error:
        raise UnsupportedError(f"link {error}") from error
    except faults.Fault as fault:
        raise LinkLostError(f"robot '{given.robot.id}': {fault}") from fault


class ManualRobot:
    """A vehicle in depth hold, and the thread that moves its sticks."""

    def __init__(self, context: RobotContext, link: Link, live: Live, full_speed: float) -> None:
        """Know the robot; nothing is sent before it is to get ready."""
        home = context.robot.home or (0.0, 0.0, 0.0)
        self._context, self._link, self._live = context, link, live
        self._helm = Helm(home[0], home[1], full_speed)
        self._lock = threading.RLock()
        self._ended = threading.Event()
        self._thread: threading.Thread | None = None
        self._fault: Fault | None = None
        self._ready = self._released = False
        self._busy_until: float | None = None
        self._depth = 0.0
        self._action: Action | None = None

    def prepare(self, now: float) -> None:
        """Begin to listen, go into depth hold and arm."""
        self._thread = threading.Thread(target=self._drive, name="sticks", daemon=True)
        self._thread.start()

    def begin(self, move: Move, now: float, *, through: bool = False) -> None:
        """Begin a movement."""
        with self._lock:
            goal = goal_of(move, self._helm, self._context, self._depth)
            self._busy_until = now
            if goal is not None:
                self._depth = goal.depth
                self._helm.aim(goal)

    def act(self, action: Action, now: float) -> None:
        """Begin a device action, as its device is wired; feedback goes to people."""
        with self._lock:
            if action.is_a(DEVICE_ACTION):
                self._action = action
            else:
                said = (action.name, *(f"{key}={value}" for key, value in action.parameters))
                self._live.say(" ".join(filter(None, said)))

    def finished(self, now: float) -> bool:
        """Return whether what was begun last has finished."""
        with self._lock:
            done = self._ready and self._helm.reached and self._action is None
            return done and (self._busy_until is None or now >= self._busy_until)

    def fault(self, now: float) -> Fault | None:
        """Return what went wrong."""
        return self._fault

    def next_event(self, now: float) -> float | None:
        """Nobody knows: the world goes on by itself."""
        return None

    def wait(self, now: float) -> None:
        """Hold the pose."""
        with self._lock:
            self._helm.aim(Goal(self._depth, self._helm.east, self._helm.north))

    def state(self, now: float) -> RobotState:
        """Return where the robot is by reckoning, and its battery."""
        with self._lock:
            helm, told = self._helm, self._link.latest("SYS_STATUS")
            place = (helm.east, helm.north, self._context.zero - helm.depth)
            left = told.battery_remaining if told is not None else -1
            return RobotState(now, place, helm.speed, helm.heading, None, left / 100.0 if left >= 0 else None)

    def stop(self, now: float, response: str = "HOLD") -> None:
        """Do what a response says: hold, go home, come up, or let go."""
        with self._lock:
            self._action = None
            home = self._context.robot.home or (0.0, 0.0, 0.0)
            if response in ("NOTHING", "STOP_THRUST"):
                self._released = response == "NOTHING"
                self._helm.rest()
                self._ended.set()
            elif response == "RETURN":
                self._helm.aim(Goal(self._depth, home[0], home[1]))
            elif response == "HOLD":
                self._helm.aim(Goal(self._depth, self._helm.east, self._helm.north))
            else:
                self._depth = 0.0
                self._helm.aim(Goal(0.0))

    def close(self) -> None:
        """Let the sticks go, disarm where nobody else has the vehicle, and fall silent."""
        self._ended.set()
        if self._thread is not None:
            self._thread.join(10.0)
        self._link.close()

    def _drive(self) -> None:
        try:
            self._get_ready()
            while not self._ended.wait(self._link.clock.real(PERIOD)):
                self._tick()
        except faults.Fault as fault:
            self._fault = Fault(fault.event, str(fault))
        finally:
            self._let_go()
            self._live.wake()

    def _get_ready(self) -> None:
        if not self._link.wait(lambda: self._link.component or self._ended.is_set(), FIRST_SIGN):
            raise faults.Fault(faults.LINK_LOST, "no vehicle is heard")
        for number in TOLD:
            command(self._link, mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, float(number), float(TOLD_EVERY))
        if not self._link.wait(lambda: None not in (self._heading(), self._depth_heard()), FIRST_SIGN):
            raise faults.Fault("SENSORS_SILENT", "the vehicle tells no heading and no depth")
        self._insist(self._in_depth_hold, mavlink.MAV_CMD_DO_SET_MODE, 1.0, float(DEPTH_HOLD))
        self._send(Sticks())
        self._insist(self._armed, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1.0)
        self._depth = self._depth_heard() or 0.0
        self._ready = True
        self._live.wake()

    def _insist(self, test: Callable[[], bool], number: int, *params: float) -> None:
        """Have a vehicle do what it takes some time after its start to do, and see that it does."""
        for left in reversed(range(INSISTING)):
            try:
                command(self._link, number, *params)
            except faults.Refused:
                if not left:
                    raise
            if self._link.wait(lambda: test() or self._ended.is_set(), PATIENCE):
                return
        raise faults.Refused(f"the vehicle does not do what command {number} asks for")

    def _tick(self) -> None:
        now = self._live.clock.now()
        if self._link.silent_for() > LINK_PATIENCE:
            raise faults.Fault(faults.LINK_LOST, f"not heard for {LINK_PATIENCE:g} s")
        if not self._in_depth_hold():
            raise faults.Fault("TAKEN_OVER", "somebody has changed the mode")
        if not self._armed():
            raise faults.Fault(faults.MOTORS_OFF, "somebody, or the vehicle itself, has disarmed it")
        age = max(map(self._link.since, NEEDED))
        if age > STALE > self._link.silent_for():
            raise faults.Fault(faults.POSITION_LOST, f"heading or depth was not told for {age:.1f} s")
        with self._lock:
            before = self._helm.reached
            sticks = self._helm.step(now, self._heading() or 0.0, self._depth_heard() or 0.0)
            action = self._action
            reached = self._helm.reached and not before
        self._send(sticks)
        if action is not None:
            self._do(action)
        if reached:
            self._live.wake()

    def _do(self, action: Action) -> None:
        wiring = self._context.wiring(action)
        if not isinstance(wiring, Wired):
            raise faults.Fault("DEVICE_SILENT", f"'{action.device}' is not wired for '{action.name}'")
        for number, params in ((wiring.command, wiring.params), *wiring.more):
            command(self._link, number, *params)
        seconds = seconds_of(action, self._context.type) if wiring.seconds is None else wiring.seconds
        with self._lock:
            self._busy_until, self._action = self._live.clock.now() + seconds, None

    def _let_go(self) -> None:
        """Let the sticks go; disarm where the robot is still ours and its mode is."""
        if self._released or not self._ready or not self._in_depth_hold():
            return
        try:
            self._send(Sticks())
            command(self._link, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0.0, tries=2)
        except faults.Fault as fault:
            self._live.say(f"could not be disarmed: {fault}")

    def _armed(self) -> bool:
        beat = self._link.latest("HEARTBEAT")
        return beat is not None and bool(beat.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)

    def _in_depth_hold(self) -> bool:
        beat = self._link.latest("HEARTBEAT")
        return beat is not None and beat.custom_mode == DEPTH_HOLD

    def _send(self, sticks: Sticks) -> None:
        self._link.send(manual_control(self._link.system, sticks))

    def _heading(self) -> float | None:
        told = self._link.latest("ATTITUDE")
        return None if told is None else degrees(told.yaw) % 360.0

    def _depth_heard(self) -> float | None:
        told = self._link.latest("GLOBAL_POSITION_INT")
        return None if told is None else max(0.0, -told.relative_alt * 1e-3)


def manual_control(system: int, sticks: Sticks) -> Any:
    """Return the message of the sticks as ArduSub takes it: z is from 0 to 1000, and rests at 500."""
    x, z, r = round(1000 * sticks.forward), round(500 + 500 * sticks.up), round(1000 * sticks.turn)
    return mavlink.MAVLink_manual_control_message(system, x, 0, z, r, 0)
